"""Copies of photographs count once, and photographs from a tripod each."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from calibgui.app.photographs.copies import disable_copies
from calibgui.dataset import CornerSet, View, ViewStatus
from calibgui.engine.arrays import Array
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.detection import find_corners
from calibgui.engine.images.rendering import render_view
from tests.engine import scenes
from tests.photographs import BOARD, CAMERA, draw_poses


def list_copies(*images: tuple[str, Array]) -> dict[str, str]:
    """Return the reasons of the views that `disable_copies` disables, by their images."""
    xy = BOARD.points()
    views = [
        View(name, ViewStatus.FOUND, points=Observation(uv, xy[: len(uv)])) for name, uv in images
    ]
    found = disable_copies(CornerSet(CAMERA.size, tuple(views))).views
    return {view.image: view.reason for view in found if not view.enabled}


@pytest.fixture(scope="module")
def seen() -> list[Array]:
    """The exact corners of some poses."""
    return [view.uv for view in scenes.seen(CAMERA, draw_poses(), BOARD).views]


def test_an_exact_copy_of_any_name_counts_once(seen: list[Array]) -> None:
    again = ("b/x.jpg", seen[0].copy()), ("a/3.png", seen[1].copy())
    found = list_copies(("a/1.png", seen[0]), ("a/2.png", seen[1]), *again)
    assert found == {
        "b/x.jpg": "A copy of a/1.png, which counts once.",
        "a/3.png": "A copy of 2.png, which counts once.",
    }


@pytest.mark.parametrize("quality", [50, 90])
def test_a_photograph_that_is_stored_again_counts_once(quality: int, seen: list[Array]) -> None:
    photograph = render_view(CAMERA, draw_poses()[0], BOARD, blur=0.7, noise=1.5, seed=1)
    kept, stored = (locate_corners(p) for p in (photograph, store_as_jpeg(photograph, quality)))
    assert not np.array_equal(kept, stored)
    for copy in ("a/1.jpg", "a/1.JPEG", "a/1.webp"):
        found = list_copies((copy, stored), ("a/1.png", kept), ("a/2.png", seen[1]))
        assert list(found) == [copy]
        assert found[copy].startswith("Looks like a copy of the .png file of the same name")


def test_photographs_from_a_tripod_count_each(seen: list[Array]) -> None:
    noise = 1e-4 * np.random.default_rng(3).standard_normal(seen[0].shape)
    burst = [seen[0], seen[0] + noise, seen[1]]
    for names in (
        ("a/1.png", "a/2.png", "a/3.png"),
        ("a/1 (1).jpg", "a/1 (2).jpg", "a/1.jpg"),
        ("a/1.png", "b/1.jpg", "a/2.png"),  # the same numbers in two folders
        ("frame.0001", "frame.0002", "frame.0003"),
    ):
        assert list_copies(*zip(names, burst, strict=True)) == {}


def test_photographs_of_one_name_that_show_another_pose_count_each(seen: list[Array]) -> None:
    assert list_copies(("1.png", seen[0]), ("1.jpg", seen[1]), ("1.tif", seen[2])) == {}
    assert list_copies(("1.png", seen[0]), ("1.jpg", seen[0] + 0.2)) == {}


@pytest.fixture(scope="module")
def photographs() -> list[NDArray[np.uint8]]:
    """A pose that was photographed three times from a tripod."""
    pose = draw_poses()[0]
    return [render_view(CAMERA, pose, BOARD, blur=0.7, noise=2.0, seed=k) for k in range(3)]


def list_copies_by_noise(*images: tuple[str, NDArray[np.uint8]]) -> dict[str, str]:
    """Return what `list_copies` does, for corners that are located with their covariances."""
    views = [
        View(name, ViewStatus.FOUND, corners=find_corners(photograph, BOARD.grid_size))
        for name, photograph in images
    ]
    found = disable_copies(CornerSet(CAMERA.size, tuple(views), BOARD)).views
    return {view.image: view.reason for view in found if not view.enabled}


def draw_on(photograph: NDArray[np.uint8], level: int) -> NDArray[np.uint8]:
    """Return a copy with a circle around a corner."""
    x, y = locate_corners(photograph)[20].astype(int).tolist()
    return np.asarray(cv2.circle(photograph.copy(), (x, y), 12, level, 2), dtype=np.uint8)


def test_a_copy_that_was_drawn_on_counts_once(photographs: list[NDArray[np.uint8]]) -> None:
    first, second, third = photographs
    edited = [draw_on(first, 255), store_as_jpeg(draw_on(first, 0), 95)]
    found = list_copies_by_noise(
        ("a.png", first), ("b.png", second), ("x.png", edited[0]), ("y.jpg", edited[1])
    )
    assert set(found) == {"x.png", "y.jpg"}
    assert all(reason.startswith("Looks like a copy of a.png") for reason in found.values())
    found = list_copies_by_noise(("a.jpg", edited[1]), ("b.png", second), ("c/x.png", first))
    assert list(found) == ["a.jpg"]
    assert "copy of x.png," in found["a.jpg"]
    assert list_copies_by_noise(("a.png", first), ("b.png", second), ("c.png", third)) == {}


def test_a_copy_counts_that_shows_more_corners(photographs: list[NDArray[np.uint8]]) -> None:
    first, second, _ = photographs
    covered = first.copy()
    covered[: int(locate_corners(first)[0, 1]) + 3] = 120
    found = list_copies_by_noise(("a.png", covered), ("b.png", first), ("c.png", second))
    assert list(found) == ["a.png"]


def locate_corners(photograph: NDArray[np.uint8]) -> Array:
    """Return the corners of the board in a photograph, as `BOARD.points` numbers them."""
    corners = find_corners(photograph, BOARD.grid_size)
    assert len(corners) == len(BOARD.points())
    return corners.uv


def store_as_jpeg(photograph: NDArray[np.uint8], quality: int) -> NDArray[np.uint8]:
    """Return what a JPEG of some quality keeps."""
    stored = cv2.imencode(".jpg", photograph, [cv2.IMWRITE_JPEG_QUALITY, quality])[1]
    return np.asarray(cv2.imdecode(stored, cv2.IMREAD_GRAYSCALE), dtype=np.uint8)

"""What may be a marker, against OpenCV's drawing and reading of markers."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
import pytest

from calibgui.engine import arrays, opencv
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard
from calibgui.engine.detection.charuco.marker_candidates import MarkerCandidates
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from tests.engine.conftest import Scene
from tests.scenes.perspective import photograph_pattern
from tests.scenes.without_board import draw_without_board

NAMES = ["DICT_4X4_50", "DICT_5X5_250", "DICT_6X6_50", "DICT_7X7_1000", "DICT_ARUCO_ORIGINAL"]


def page(name: str, blur: float, noise: float) -> arrays.GreyImage:
    """Twelve markers of a dictionary, seen obliquely and turned."""
    cells = [opencv.draw_marker_cells(name, k) for k in range(3, 15)]
    side = 8 * len(cells[0])
    sheet = np.full((4 * side, 5 * side), 220, np.uint8)
    for k, dark in enumerate(cells):
        v, u = (k // 4 * 5 + 1) * side // 4, (k % 4 * 5 + 1) * side // 4
        marker = np.where(np.rot90(dark, k), 40, 220).astype(np.uint8)
        sheet[v : v + side, u : u + side] = np.kron(marker, np.ones((8, 8), np.uint8))
    corners = np.array([(0, 0), (5 * side, 0), (5 * side, 4 * side), (0, 4 * side)], np.float32)
    seen = np.array([(60, 40), (560, 90), (600, 420), (30, 450)], np.float32)
    H = cv2.getPerspectiveTransform(corners, seen)
    image = cv2.warpPerspective(sheet, H, (640, 480), borderValue=(220,))
    image = cv2.GaussianBlur(image, (0, 0), blur)
    rng = np.random.default_rng(0)
    return np.clip(np.rint(image + noise * rng.normal(size=image.shape)), 0, 255).astype(np.uint8)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(("blur", "noise"), [(0.5, 2.0), (1.5, 6.0)])
def test_what_opencv_reads_fits_its_dictionary(name: str, blur: float, noise: float) -> None:
    image = page(name, blur, noise)
    read = len(opencv.detect_markers(image, name)[0])
    assert read >= 10
    candidates = MarkerCandidates(image, opencv.detect_dark_quads(image))
    assert candidates.count_fitting(name) >= read
    others = [other for other in NAMES if other[:8] != name[:8]]
    assert all(candidates.count_fitting(other) <= 2 for other in others)


@pytest.mark.parametrize("seed", range(6))
def test_no_marker_is_read_where_nothing_fits(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Not even among the hundreds of bricks of one of these images."""
    read: list[str] = []
    monkeypatch.setattr(opencv, "detect_markers", lambda _, name: read.append(name))
    with pytest.raises(NoBoardError):
        find_corners(draw_without_board(seed), None, pattern=Charuco())
    assert not read


@pytest.mark.parametrize("is_inverted", [False, True])
def test_most_are_found_quickly_dark_and_bright(is_inverted: bool) -> None:
    image = page(NAMES[0], 0.7, 2.0)
    seen = 255 - image if is_inverted else image
    candidates = MarkerCandidates(seen, opencv.detect_dark_quads(seen, is_quick=True))
    assert candidates.count_fitting(NAMES[0], is_inverted) >= 10
    assert candidates.count_fitting(NAMES[0], not is_inverted) <= 2


@pytest.fixture
def read(monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, ...]]:
    """Shapes of the images in which OpenCV reads markers."""
    shapes = []
    markers = opencv.detect_markers

    def detect(image: arrays.GreyImage, name: str) -> opencv.DetectedMarkers:
        shapes.append(image.shape)
        return markers(image, name)

    monkeypatch.setattr(opencv, "detect_markers", detect)
    return shapes


def test_large_images_without_markers_are_read_at_their_coarsest_size_only(
    read: list[tuple[int, ...]],
) -> None:
    image = np.random.default_rng(0).integers(0, 256, (1200, 1800)).astype(np.uint8)
    with pytest.raises(NoBoardError):
        find_corners(image, pattern=Charuco(NAMES[0]))
    assert set(read) == {(600, 900)}


@pytest.mark.parametrize("is_inverted", [False, True])
def test_markers_that_show_at_full_size_only_are_read(
    is_inverted: bool, read: list[tuple[int, ...]]
) -> None:
    """The full size is read only about them, as textures beside them may take minutes."""
    small = Scene(Board(5, 8, 20.0, Charuco(NAMES[0], 0.7, False)), distance=900.0).image()
    image = np.full((1300, 1700), small[0, 0], np.uint8)
    image[200:950, 300:1300] = small
    corners = find_corners(255 - image if is_inverted else image, pattern=Charuco(NAMES[0]))
    assert len(corners) > 30
    assert max(height * width for height, width in read) < small.size


@pytest.mark.parametrize("name", NAMES)
def test_numbers_and_corners_are_those_that_opencv_reads(name: str) -> None:
    image = page(name, 0.5, 2.0)
    numbers, corners = MarkerCandidates(image, opencv.detect_dark_quads(image)).read_fitting(name)
    expected, places, _ = opencv.detect_markers(image, name)
    at = dict(zip(numbers.tolist(), corners, strict=True))
    assert len(at) == len(numbers) >= len(expected)
    for number, quad in zip(expected.tolist(), places, strict=True):
        assert np.abs(at[number] - quad).max() < 3


def test_markers_that_fit_by_chance_are_not_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """A halftone has thousands of dark parts; of 4 x 4 cells some are always like a marker's. Those
    of a sample that lie far apart do not make all of the image be searched either."""
    read: list[str] = []
    searched: list[int] = []
    search = opencv.detect_dark_quads

    def detect(image: arrays.GreyImage, *how: Any, **more: Any) -> arrays.Array:
        searched.append(image.size)
        return search(image, *how, **more)

    monkeypatch.setattr(opencv, "detect_dark_quads", detect)
    monkeypatch.setattr(opencv, "detect_markers", lambda _, name: read.append(name))
    with pytest.raises(NoBoardError):
        find_corners(draw_without_board(17, (3000, 4000), 2.5), None, pattern=Charuco())
    assert not read
    assert max(searched) <= 750 * 1000


def test_outlines_are_looked_for_once_to_refuse_a_stated_board(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What OpenCV could not read of the stated dictionary is what others may be read in."""
    searched: list[str] = []
    for name in ("detect_markers", "detect_dark_quads"):
        search = getattr(opencv, name)

        def detect(*image: Any, search: Any = search, name: str = name, **how: Any) -> Any:
            searched.append(name)
            return search(*image, **how)

        monkeypatch.setattr(opencv, name, detect)
    with pytest.raises(NoBoardError, match="No ChArUco"):
        find_corners(draw_without_board(0), (5, 8), pattern=Charuco(NAMES[0], 0.7, False))
    assert searched == 2 * ["detect_markers"]  # dark and bright


def test_tags_of_another_kind_of_board_are_not_read_to_tell_what_is_there(
    read: list[tuple[int, ...]],
) -> None:
    """OpenCV would compare each with the hundreds of its dictionary."""
    board = Board(8, 10, 20.0, TaggedCheckerboard("t36h11", 1, 2, from_top=True))
    image = photograph_pattern((1000, 750), board, 0.7, 0.8)
    with pytest.raises(NoBoardError, match="No ChArUco"):
        find_corners(image, (7, 10), pattern=Charuco(NAMES[0], 0.75, False))
    assert len(read) == 2  # of the stated dictionary, dark and bright

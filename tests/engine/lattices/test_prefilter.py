"""The prefilter tells boards from what has other edges."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from calibgui.engine.boards.board import Board
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.detection.checkerboard import board_refinement
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.lattices import board_ends, prefilter
from calibgui.engine.lattices.prefilter import MAX_SPREAD
from tests.engine.conftest import Scene
from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions
from tests.scenes.without_board import draw_without_board


@pytest.mark.parametrize(
    "conditions",
    [
        {"ink": 0.08, "blur": 0.15 * 30},
        {"ink": -0.08, "blur": 0.15 * 30},
        {"square": 8.0, "noise": 20.0},
        {"square": 45.0, "tilt": 70.0},
        {"distortion": 0.5, "square": 38.0},
        {"light": 1.0, "gamma": 2.2, "blur": 0.7, "blur_end": 4.0},
    ],
)
def test_boards_are_plausible(conditions: dict[str, Any]) -> None:
    scene = draw(Conditions(**conditions, parts=2), 0)
    image = scene.photograph(0)
    first, next_ = (
        np.rint(np.mean(scene.uv[:2, k : k + 2], axis=(0, 1))).astype(int) for k in (0, 1)
    )
    dark = bool(scene.clean[*first[::-1]] < scene.clean[*next_[::-1]])
    assert prefilter.is_plausible(Lattice(scene.uv, dark), image)


@pytest.mark.parametrize(
    ("pitch", "radius", "blur"),
    [(15.8, 0.38, 1.0), (21.1, 0.36, 1.7), (19.9, 0.49, 1.6), (10.0, 0.38, 0.5)],
)
def test_the_edges_of_discs_bulge(pitch: float, radius: float, blur: float) -> None:
    v, u = np.mgrid[:320, :480]
    x, y = (0.96 * u + 0.28 * v) / pitch, (0.96 * v - 0.28 * u) / pitch
    distance = np.hypot(x % 1 - 0.5, y % 1 - 0.5) - radius
    image = 40 + 180 / (1 + np.exp(1.7 * distance * pitch / blur))
    with pytest.raises(NoBoardError):
        find_corners(image)


def test_scattered_corners_are_no_board() -> None:
    """As a lattice winds through a halftone, many places off."""
    row, col = np.indices((24, 24))
    uv = 20.0 * np.stack([col, row], axis=-1) + 20
    image = np.where((row + col) % 2 == 0, 40, 200).repeat(20, axis=0).repeat(20, axis=1)
    whole = Lattice(uv, dark=True)
    assert "scattered" not in prefilter.find_early_objection(whole, image)
    winding = whole.select(abs(row - col) < 3)
    assert "scattered" in prefilter.find_early_objection(winding, image)
    few = whole.select((row == col) & (row < 20))
    assert "scattered" not in prefilter.find_early_objection(few, image)


@pytest.mark.parametrize("seed", [80, 8, 17])
def test_a_picture_printed_in_dots_is_no_board(seed: int) -> None:
    with pytest.raises(NoBoardError):
        find_corners(draw_without_board(seed))


@pytest.mark.parametrize("seed", [62, 89, 98, 116, 179, 188, 197, 3878])
def test_nor_is_the_part_of_it_where_dots_are_squares(seed: int) -> None:
    with pytest.raises(NoBoardError):
        find_corners(draw_without_board(seed))


def have_same_spread(spreads: NDArray[np.float64]) -> bool:
    return prefilter.have_same_spread(spreads, MAX_SPREAD)


def test_the_squares_of_one_print_spread_alike() -> None:
    rng = np.random.default_rng(0)
    spreads = 0.06 + rng.normal(0, 0.01, (100, 2))
    spreads[rng.random(100) < 0.3] = np.nan
    assert have_same_spread(spreads)
    assert have_same_spread(spreads + np.array([0.03, 0.0]))  # sharpened in one direction
    assert not have_same_spread(spreads + np.linspace(-0.1, 0.1, 100)[:, None])  # dots that grow
    assert not have_same_spread(spreads + np.array([0.1, 0.0]))  # stripes that are shifted
    assert have_same_spread(np.full((100, 2), np.nan))


@pytest.mark.parametrize(("height", "passes"), [(12.0, True), (40.0, False)])
def test_small_squares_spread_alike_as_far_as_pixels_tell(height: float, passes: bool) -> None:
    """A good board of squares of 12 px, filtered by medians, was refused by 0.01 px."""
    spreads = -0.04 + 0.008 * np.where(np.arange(60) % 2, 1, -1)[:, None] * np.ones(2)
    assert prefilter._is_spread_of_ink(spreads, height) == passes


def test_a_board_is_found_where_light_blinds_the_camera_to_one_side() -> None:
    scene = draw(Conditions(square=24.0, blur=3.0, parts=2), 402)
    levels = np.clip(scene.clean * np.linspace(1, 2.2, 480)[:, None], 0, 400)
    image = np.clip(gaussian_filter(levels, 1.0), 0, 255).astype(np.uint8)
    assert len(find_corners(image).uv) == 54


def photograph_crop(margin: float) -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
    """A board cut off `margin` squares outside of its outermost corners, and these corners."""
    scene = draw(Conditions(tilt=0.0, turn=0.0, shift=0.0, parts=2, noise=1.0), 0)
    low, high = (
        np.rint(edge).astype(int) for edge in (scene.uv.min(axis=(0, 1)), scene.uv.max(axis=(0, 1)))
    )
    reach = round(margin * 30)
    crop = scene.photograph(0)[low[1] - reach : high[1] + reach, low[0] - reach : high[0] + reach]
    return crop, scene.uv - (low - reach)


def test_a_board_that_stands_alone_overrules_the_guards(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where all of it is seen, not where the image ends before the board does."""
    monkeypatch.setattr(prefilter, "_judge_edges", lambda *_: "its squares differ in size")
    for margin, is_whole in ((1.9, True), (0.7, False)):
        image, uv = photograph_crop(margin)
        for dark in (True, False):
            objection = prefilter.find_objection(Lattice(uv, dark), image)
            if is_right := dark == bool(image[uv_of_first_square(uv)] < 120):
                assert bool(objection) != is_whole
            assert objection or is_right


def uv_of_first_square(uv: NDArray[np.float64]) -> tuple[int, int]:
    """The row and the column of the pixel in the middle of the square before the first corner."""
    u, v = np.rint(uv[0, 0] - (uv[1, 1] - uv[0, 0]) / 2).astype(int)
    return v, u


@pytest.mark.parametrize("is_inverted", [False, True])
@pytest.mark.parametrize(
    ("diameter", "blur"), [(0.92, 4.0), (0.98, 1.0), (0.8, 8.0), (1.0, 8.0), (1.05, 9.0)]
)
def test_a_grid_of_circles_that_stands_alone_does_not(
    diameter: float, blur: float, is_inverted: bool
) -> None:
    """Where circles of every second place nearly touch a board has its corners."""
    v, u = np.mgrid[:480, :640]
    image = np.full(v.shape, 210.0)
    for row, col in np.argwhere(np.indices((8, 11)).sum(axis=0) % 2 == 0):
        distance = np.hypot(u - 120 - 40 * col, v - 110 - 40 * row)
        image[distance < diameter * 40 / np.sqrt(2)] = 40.0
    image = gaussian_filter(255 - image if is_inverted else image, blur)
    n, m = np.meshgrid(np.arange(1, 11), np.arange(1, 8))
    uv = np.stack([100.0 + 40 * n, 90.0 + 40 * m], axis=-1)
    assert board_ends.stands_alone(Lattice(uv, not is_inverted), image)
    with pytest.raises(NoBoardError):
        find_corners(image.astype(np.uint8))


def test_ink_and_a_halo_to_one_side_are_no_harm_to_a_board_that_stands_alone() -> None:
    scene = draw(Conditions(ink=0.06, distortion=0.3, square=32.0, parts=2), 0)
    before = np.roll(scene.clean, 2, axis=1)
    levels = np.clip(scene.clean + 0.8 * (scene.clean - before), 0, 255)
    assert len(find_corners(np.rint(levels).astype(np.uint8))) == 54


@pytest.mark.parametrize("ink", [-0.06, 0.06])
def test_nor_are_ink_and_marks_in_its_squares(ink: float) -> None:
    for seed in (0, 3, 5):
        scene = draw(Conditions(ink=ink, square=32.0, marks=True, parts=2), seed)
        assert len(find_corners(scene.photograph(seed))) == 54


def test_nor_are_the_pixels_of_a_screen_before_which_something_lies() -> None:
    scene = draw(Conditions(square=32.0, tilt=10.0, occluder="object", parts=2), 2)
    v, u = np.mgrid[:480, :640]
    beat = np.sin(0.5 * u + 0.3 * v) + np.sin(0.3 * u - 0.5 * v)
    image = np.clip(np.rint(scene.clean * (1 + 0.12 * beat)), 0, 255).astype(np.uint8)
    found = find_corners(image).uv
    nearest = [np.linalg.norm(found - uv, axis=1).min() for uv in scene.uv[scene.visible]]
    assert max(nearest) < 1.0


@pytest.mark.parametrize("shift", [0.15, 0.2, 0.3])
def test_a_board_whose_rows_are_shifted_is_none_though_it_stands_alone(shift: float) -> None:
    v, u = np.mgrid[:480, :640]
    row = np.floor((v - 80) / 40)
    col = np.floor((u - 100) / 40 + shift * (row % 2))
    on_board = (row >= 0) & (row < 8) & (col >= 0) & (col < 11)
    image = np.where(on_board & ((row + col) % 2 == 0), 40.0, 210.0)
    with pytest.raises(NoBoardError):
        find_corners(gaussian_filter(image, 2.0).astype(np.uint8))


@pytest.mark.parametrize(("seed", "says"), [(2, "too ragged"), (8, "printed dots")])
def test_the_message_names_the_rule_by_which_the_search_refused(seed: int, says: str) -> None:
    with pytest.raises(NoBoardError, match=says) as caught:
        find_corners(draw_without_board(seed))
    assert "circles" not in caught.value.hint
    assert ("state its number of inner corners" in caught.value.hint) == (says == "printed dots")


def draw_heated(seed: int) -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
    """A board of 6 x 8 inner corners as thermal cameras show them: squares of uneven sizes and
    temperatures, blurred; and where its corners lie but for the squares' unevenness, px."""
    rng = np.random.default_rng(seed)
    image = np.full((512, 640), 100.0)
    image[96:416, 120:520] = 150.0
    for row, col in np.argwhere(np.indices((7, 9)).sum(axis=0) % 2 == 0):
        top, bottom, left, right = np.rint(40 * rng.normal(0, 0.1, 4)).astype(int)
        v, u = 116 + 40 * row, 140 + 40 * col
        image[v - top : v + 40 + bottom, u - left : u + 40 + right] = 60 + rng.normal(0, 8)
    image = gaussian_filter(image, rng.uniform(2.4, 5.6)) + rng.normal(0, 1.5, image.shape)
    n, m = np.meshgrid(np.arange(8), np.arange(6))
    uv = np.stack([179.5 + 40 * n, 155.5 + 40 * m], axis=-1).reshape(-1, 2)
    return np.clip(image, 0, 255).astype(np.uint8), uv


def test_uneven_squares_are_no_harm_to_a_board_of_the_stated_size() -> None:
    refused = 0
    for seed in range(12):
        image, uv = draw_heated(seed)
        try:
            find_corners(image)
        except NoBoardError as error:
            refused += "printed dots" in str(error)
            corners = find_corners(image, (6, 8))
            distance = np.linalg.norm(corners.uv[:, None] - uv, axis=2).min(axis=1)
            assert distance.max() < 12  # of squares of 40 px
            with pytest.raises(NoBoardError):
                find_corners(image, (5, 9))
    assert refused > 1


@pytest.mark.parametrize("seed", range(8, 45, 9))
def test_a_picture_in_dots_is_not_the_stated_board_either(seed: int) -> None:
    for grid_size in ((4, 5), (6, 9), (7, 10)):
        with pytest.raises(NoBoardError):
            find_corners(draw_without_board(seed), grid_size)


def test_who_photographs_a_part_of_a_grid_of_circles_is_told_of_circles_first() -> None:
    board = Board(9, 12, 26.0, Circles(diameter=0.6))
    image = Scene(board, rvec=(0.3, 0.2, 0.1), distance=160.0).image()
    with pytest.raises(NoBoardError) as caught:
        find_corners(image)
    assert caught.value.hint.startswith("For a grid of circles, or a board")


def test_the_message_names_the_test_that_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        board_refinement, "find_objection", lambda *_, **__: "its squares differ in size"
    )
    with pytest.raises(NoBoardError, match=r"6 x 9 inner corners .*: its squares differ in size"):
        find_corners(draw(Conditions(parts=2), 0).photograph(0))

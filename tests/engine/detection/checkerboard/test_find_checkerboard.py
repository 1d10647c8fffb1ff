"""The whole line, from an image to numbered corners, against drawn and real boards."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from calibgui.engine.boards.board import Board
from calibgui.engine.boards.pattern import Pattern, Symmetry
from calibgui.engine.boards.puzzleboard import PuzzleBoard
from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard
from calibgui.engine.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.detection.checkerboard import board_refinement
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from calibgui.engine.features.corners import Corners
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.geometry import Pose, rotation_from_vector
from calibgui.engine.images import render_view
from calibgui.engine.images.reading import read_image
from tests.scenes.checkerboards import draw as draw_scene
from tests.scenes.conditions import Conditions
from tests.scenes.perspective import photograph_pattern
from tests.scenes.troubles import TROUBLES
from tests.scenes.without_board import draw_without_board


def truth_of(corners: Corners, uv: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    return np.asarray(uv[corners.grid[:, 0], corners.grid[:, 1]])


@pytest.mark.parametrize("given_size", [True, False])
@pytest.mark.parametrize(
    "scene",
    [
        {},
        {"turn": 35.0, "tilt": (0.3, 0.2)},
        {"step": 12.0, "turn": 10.0},
        {"blur": 4.0},
        {"noise": 12.0},
        {"barrel": 0.5, "step": 60.0, "turn": 8.0},
        {"size": (1280, 960), "step": 80.0, "turn": -20.0},
        {"levels": (100.0, 125.0), "noise": 1.0},
    ],
)
def test_finds_every_corner_in_its_place(
    draw: Any, scene: dict[str, Any], given_size: bool
) -> None:
    drawn = draw(**scene)
    corners = find_corners(drawn.image, (6, 9) if given_size else None)
    assert corners.shape == (6, 9)
    assert corners.complete
    assert not corners.relative
    assert corners.ambiguity is Symmetry.NONE
    error = corners.uv - truth_of(corners, drawn.uv)
    noise = scene.get("noise", 0.0) / (np.diff(scene.get("levels", (40.0, 210.0)))[0])
    assert np.abs(error).max() < 0.05 + 2 * noise
    assert np.abs(corners.estimate - corners.uv).max() < 4


@pytest.mark.parametrize(
    ("shape", "rvec", "tvec"),
    [
        ((3, 6), [0.66, 0.42, -0.11], [-53.0, -39.0, 76.0]),
        ((3, 6), [-0.12, 0.33, -0.02], [-105.0, -33.0, 96.0]),
        ((4, 5), [-0.72, 0.09, -0.95], [-37.0, -31.0, 104.0]),
    ],
)
def test_few_squares_near_a_fisheye_are_all_found(
    shape: tuple[int, int], rvec: list[float], tvec: list[float]
) -> None:
    """No corner lies there where those beside it expect it."""
    fisheye = [230.0, 230.0, 320.0, 240.0, 0.0, 0.0, 0.0, 0.0]
    camera = Camera((640, 480), fisheye, "kannala-brandt")
    pose, board = Pose(np.array(rvec), np.array(tvec)), Board(*shape, 180 / (shape[1] + 1))
    corners = find_corners(render_view(camera, pose, board, blur=0.6, noise=1.0))
    assert corners.shape == shape and corners.complete
    truth = project_points(board.points()[:, :2], camera, pose)
    assert np.linalg.norm(corners.uv[:, None] - truth, axis=2).min(axis=1).max() < 0.5


@pytest.mark.parametrize("given_size", [True, False])
@pytest.mark.parametrize("grid_size", [(3, 3), (3, 4)])
@pytest.mark.parametrize("step", [8.0, 30.0, 90.0])
def test_the_smallest_boards_are_found(
    draw: Any, step: float, grid_size: tuple[int, int], given_size: bool
) -> None:
    """Of the smallest squares the board is so small that noise has corners of its own around."""
    drawn = draw(grid_size, step=step, turn=20.0, tilt=(0.2, 0.1), barrel=0.2, noise=2.0)
    corners = find_corners(drawn.image, grid_size if given_size else None)
    assert corners.shape == grid_size
    assert corners.complete
    distance = np.linalg.norm(corners.uv[:, None] - drawn.uv.reshape(-1, 2), axis=2)
    assert distance.min(axis=1).max() < 0.1
    assert sorted(distance.argmin(axis=1)) == list(range(len(corners)))


@settings(max_examples=25)
@given(
    turn=st.floats(-180, 180),
    tilt=st.tuples(st.floats(-0.2, 0.2), st.floats(-0.2, 0.2)),
    rows=st.integers(3, 6),
    more=st.integers(0, 2),
)
def test_numbering_is_right_handed_from_a_dark_square(
    draw: Any, turn: float, tilt: tuple[float, float], rows: int, more: int
) -> None:
    cols = max(rows + more, 4)
    drawn = draw((rows, cols), (320, 240), step=22.0, turn=turn, tilt=tilt)
    corners = find_corners(drawn.image)
    assert corners.complete
    assert corners.shape == (rows, cols)
    uv = corners.uv.reshape(*corners.shape, 2)
    right, down = uv[0, 1] - uv[0, 0], uv[1, 0] - uv[0, 0]
    assert right[0] * down[1] - right[1] * down[0] > 0
    u, v = np.rint(uv[0, 0] - (right + down) / 4).astype(int)
    assert drawn.image[v, u] < 100
    if (rows + cols) % 2:
        np.testing.assert_allclose(corners.uv, truth_of(corners, drawn.uv), atol=0.3)


@pytest.mark.parametrize("quiet", [0, 1, 30])
@pytest.mark.parametrize("grid_size", [(3, 4), (6, 9)])
@pytest.mark.parametrize("square", [8, 9, 20, 33])
def test_boards_that_a_program_drew_pixel_by_pixel(
    square: int, grid_size: tuple[int, int], quiet: int
) -> None:
    """Without noise or blur: corners lie between pixels that are equally strong."""
    v, u = np.mgrid[: (grid_size[0] + 1) * square, : (grid_size[1] + 1) * square] // square
    drawn = np.pad(np.where((u + v) % 2, 255, 0), quiet, constant_values=255)
    image = np.full((480, 640), 128, dtype=np.uint8)
    image[50 : 50 + drawn.shape[0], 90 : 90 + drawn.shape[1]] = drawn
    corners = find_corners(image)
    assert corners.shape == grid_size
    assert corners.complete
    at = (corners.uv + 0.5 - quiet - [90, 50]) / square
    np.testing.assert_allclose(at, np.rint(at), atol=0.02 / square)


@pytest.mark.parametrize(
    ("grid_size", "expected"),
    [
        ((6, 9), Symmetry.NONE),
        ((5, 7), Symmetry.HALF_TURN),
        ((6, 8), Symmetry.HALF_TURN),
        ((5, 5), Symmetry.HALF_TURN),
        ((6, 6), Symmetry.QUARTER_TURN),
    ],
)
def test_says_when_the_pattern_hides_its_origin(
    draw: Any, grid_size: tuple[int, int], expected: Symmetry
) -> None:
    assert find_corners(draw(grid_size).image).ambiguity is expected


def test_a_turned_board_takes_the_stated_layout(draw: Any) -> None:
    drawn = draw((6, 9), turn=90.0, step=36.0)
    assert find_corners(drawn.image, (6, 9)).shape == (6, 9)
    assert find_corners(drawn.image, (9, 6)).shape == (9, 6)


def test_a_wrong_size_is_answered_with_the_right_one(draw: Any) -> None:
    image = draw((6, 8)).image
    for wrong in ((5, 8), (7, 9), (6, 7), (8, 8)):
        with pytest.raises(NoBoardError, match="6 x 8 inner corners"):
            find_corners(image, wrong)


def test_a_wrong_size_of_a_marked_board_is_answered_too(draw: Any) -> None:
    drawn = draw((6, 8))
    marked = drawn.uv[[0, 0, -1, -1], [0, -1, -1, 0]]
    with pytest.raises(NoBoardError, match="This board has 6 x 8 inner corners, not 7 x 11"):
        find_corners(drawn.image, (7, 11), marked)
    with pytest.raises(NoBoardError, match="7 x 11 inner corners fits the four marked points"):
        find_corners(np.full_like(drawn.image, 120), (7, 11), marked)


def two_boards(draw: Any) -> NDArray[np.uint8]:
    """A 5 x 7 board on the left, a 4 x 6 one on the right, in 800 x 400 pixels."""
    left, right = draw((5, 7), (400, 400), turn=4.0), draw((4, 6), (400, 400))
    return np.hstack([left.image, right.image])


def test_the_stated_board_is_chosen_else_the_largest_and_the_others_are_told(draw: Any) -> None:
    image = two_boards(draw)
    for grid_size, shape, other in ((None, (5, 7), (4, 6)), ((4, 6), (4, 6), (5, 7))):
        corners = find_corners(image, grid_size)
        assert corners.shape == shape
        (seen,) = corners.others
        assert seen.shape == other
        assert (seen.outline.mean(axis=0)[0] > 400) == (other == (4, 6))
    with pytest.raises(NoBoardError, match="5 x 7, 4 x 6 inner corners, not 8 x 9"):
        find_corners(image, (8, 9))


def test_a_reflection_is_not_preferred_to_the_board(draw: Any) -> None:
    """As in a polished floor: upside down, fainter, and a little larger here."""
    board = draw((5, 7), (400, 300), step=30.0).image
    reflection = draw((5, 7), (400, 300), step=31.0, levels=(50.0, 110.0)).image[::-1]
    for above, below in ((board, reflection), (reflection, board)):
        (other,) = find_corners(np.vstack([above, below])).others
        assert (other.outline.mean(axis=0)[1] > 300) == (below is reflection)


@pytest.mark.parametrize("step", [32.0, 40.0, 48.0, 60.0])
def test_the_stated_board_is_found_on_a_chequered_cloth(draw: Any, step: float) -> None:
    grid_size = draw((6, 9), step=30.0, turn=0.0)
    cloth = draw((20, 28), step=step, turn=17.0, levels=(90.0, 160.0), noise=1.0)
    image = cloth.image.copy()
    (left, top), (right, bottom) = (grid_size.uv[k, k].round().astype(int) for k in (0, -1))
    around = np.s_[top - 60 : bottom + 60, left - 60 : right + 60]
    image[around] = grid_size.image[around]
    corners = find_corners(image, (6, 9))
    assert corners.complete
    np.testing.assert_allclose(corners.uv, grid_size.uv.reshape(-1, 2), atol=0.02)


def test_a_stated_board_of_much_smaller_squares_is_searched_for(draw: Any) -> None:
    large = draw((4, 5), (1280, 960), step=150.0, shift=(-250.0, 0.0))
    small = draw((6, 9), (320, 320), step=14.0, turn=10.0)
    image = large.image.copy()
    image[600:920, 940:1260] = small.image
    corners = find_corners(image, (6, 9))
    assert corners.shape == (6, 9)
    assert corners.complete
    assert [seen.shape for seen in corners.others] == [(4, 5)]


def test_a_small_picture_of_a_board_is_not_preferred_to_the_board(draw: Any) -> None:
    """As on a screen that shows what the camera sees, with some corners more."""
    image = draw((5, 7), (640, 400), step=40.0, shift=(-120.0, 0.0)).image.copy()
    image[:200, 470:] = draw((6, 8), (170, 200), step=12.0, turn=5.0).image
    corners = find_corners(image)
    assert corners.shape == (5, 7)
    assert [seen.shape for seen in corners.others] == [(6, 8)]


def test_a_part_too_large_for_the_stated_board_is_told_as_a_part(draw: Any) -> None:
    image = draw((6, 9), shift=(190.0, 0.0)).image
    with pytest.raises(NoBoardError, match="at least 6 x 8 inner corners, not 4 x 5"):
        find_corners(image, (4, 5))


def test_a_part_that_shows_two_ends_has_its_place(draw: Any) -> None:
    drawn = draw((6, 9), shift=(190.0, 0.0))
    corners = find_corners(drawn.image, (6, 9))
    assert not corners.relative
    middle = draw((6, 9), step=90.0)  # only the middle is in view
    assert find_corners(middle.image, (6, 9)).relative


def test_part_of_a_board_is_returned_as_part(draw: Any) -> None:
    drawn = draw((6, 9), shift=(190.0, 0.0))
    visible = (drawn.uv[..., 0] < 634).sum()
    corners = find_corners(drawn.image, (6, 9))
    assert not corners.complete
    assert len(corners) == visible
    np.testing.assert_allclose(corners.uv, truth_of(corners, drawn.uv), atol=0.3)


@pytest.mark.parametrize("quarters", range(4))
def test_a_smaller_board_is_remarked_on_where_its_squares_go_on(draw: Any, quarters: int) -> None:
    """The corners of one border line are covered, so that the rest was taken for the board."""
    scene = draw((6, 9), turn=10.0)
    image = scene.image.copy()
    for u, v in np.rint(np.rot90(scene.uv, quarters)[0]).astype(int):
        image[v - 9 : v + 10, u - 9 : u + 10] = 125
    size = ("5 x 9", "6 x 8")[quarters % 2]
    corners = find_corners(image)
    assert corners.remark.startswith(f"Beyond the {size} corners taken here, a line of squares")
    assert "if it has 6 x 9 corners" in corners.remark
    assert not find_corners(image, (6, 9)).remark
    assert not find_corners(scene.image).remark


@pytest.mark.parametrize("seed", [5006, 5007])
def test_print_in_the_margin_is_not_taken_for_squares(seed: int) -> None:
    """A code, text and a ruler alternate as squares do, but are not filled as evenly."""
    assert not find_corners(TROUBLES["printed margin"](seed).image).remark


def test_nine_corners_of_a_board_are_a_part(draw: Any) -> None:
    drawn = draw((6, 9), step=80.0, shift=(400.0, 265.0))
    visible = ((drawn.uv < (634, 474)) & (drawn.uv > 5)).all(axis=2)
    assert visible.sum() == 9
    for stated in ((6, 9), None):
        corners = find_corners(drawn.image, stated)
        distance = np.linalg.norm(corners.uv[:, None] - drawn.uv[visible], axis=2).min(axis=1)
        assert len(corners) == 9
        assert distance.max() < 0.1


@pytest.mark.parametrize("kind", ["black", "noise", "ramp", "stripes", "fine checkers", "discs"])
def test_no_board_is_said_not_imagined(kind: str) -> None:
    rng = np.random.default_rng(5)
    v, u = np.mgrid[:240, :320]
    image = {
        "black": np.zeros((240, 320)),
        "noise": rng.uniform(0, 255, (240, 320)),
        "ramp": (u + v) / 3.0,
        "stripes": 255.0 * (u // 8 % 2),
        "fine checkers": 255.0 * ((u + v) % 2),
        "discs": 255.0 * (np.hypot(u % 40 - 20, v % 40 - 20) < 12),
    }[kind]
    with pytest.raises(NoBoardError) as caught:
        find_corners(image.astype(np.uint8))
    assert caught.value.hint


def test_a_board_without_a_saddle_point_is_refused() -> None:
    overlapping = draw_scene(Conditions(ink=0.08, parts=2), 0).photograph(0)
    assert find_corners(overlapping).shape == (6, 9)
    with pytest.raises(NoBoardError):
        find_corners(overlapping, method="saddle")


def test_ragged_corners_of_a_houndstooth_are_no_board() -> None:
    with pytest.raises(NoBoardError):
        find_corners(draw_without_board(556))


@pytest.mark.parametrize(
    ("pattern", "grid_size", "match"),
    [
        (PuzzleBoard((50, 101)), None, "7 x 10 inner corners"),
        (TaggedCheckerboard("t36h11", 1, 2, True), (6, 9), "7 x 10 inner corners, not 6 x 9"),
    ],
)
def test_what_every_level_shows_is_verified_once(
    pattern: Pattern, grid_size: tuple[int, int] | None, match: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """To a search for a checkerboard a PuzzleBoard's edges are too ragged, and a checkerboard with
    tags is of another size than is stated, in each size of the image."""
    verified: list[int] = []
    refine = board_refinement.refine_board
    monkeypatch.setattr(
        board_refinement,
        "refine_board",
        lambda *args, **named: verified.append(1) or refine(*args, **named),
    )
    image = photograph_pattern((1600, 1200), Board(7, 10, 26.0, pattern), 0.7, 1.0)
    with pytest.raises(NoBoardError, match=match):
        find_corners(image, grid_size)
    assert len(verified) == 1


@pytest.mark.parametrize("dtype", [np.uint16, np.float32, np.float64])
def test_grey_levels_of_any_depth(draw: Any, dtype: Any) -> None:
    drawn = draw()
    scale = 200 if dtype is np.uint16 else 1 / 255
    deep = (drawn.image * np.float64(scale)).astype(dtype)
    np.testing.assert_allclose(find_corners(deep).uv, find_corners(drawn.image).uv, atol=2e-3)


def test_marked_points_choose_between_boards_and_origins(draw: Any) -> None:
    image, right = two_boards(draw), draw((4, 6), (400, 400))
    ends = right.uv[[0, 0, -1, -1], [0, -1, -1, 0]] + np.array([400.0, 0.0])
    for first in (0, 2):
        roi = np.roll(ends, -first, axis=0) + np.array([3.0, -4.0])
        corners = find_corners(image, roi=roi)
        assert corners.shape == (4, 6)
        assert np.linalg.norm(corners.uv[0] - ends[first]) < 1
    assert find_corners(image).shape == (5, 7)


def test_marked_points_guide_to_a_board_too_damaged_to_find(draw: Any) -> None:
    drawn = draw((6, 9), tilt=(0.1, 0.05), noise=3.0)
    image = drawn.image.copy()
    for col in (1, 3, 5, 7):  # broad strips hide every other column of corners
        u = int(drawn.uv[:, col, 0].mean())
        image[:, u - 16 : u + 17] = 128
    with pytest.raises(NoBoardError):
        find_corners(image, (6, 9))
    ends = drawn.uv[[0, 0, -1, -1], [0, -1, -1, 0]]
    corners = find_corners(image, (6, 9), roi=ends)
    assert set(corners.grid[:, 1]) == {0, 2, 4, 6, 8}
    np.testing.assert_allclose(corners.uv, truth_of(corners, drawn.uv), atol=0.5)


@pytest.mark.parametrize("share", [0.2, 0.35])
@pytest.mark.parametrize("level", [40, 128, 210])
def test_marked_points_guide_past_corners_that_are_blotted_out(
    draw: Any, share: float, level: int
) -> None:
    for seed in range(2):
        rng = np.random.default_rng(seed)
        drawn = draw((6, 9), tilt=(0.1, 0.05), noise=3.0, turn=7.0 * seed)
        hidden = np.zeros((6, 9), np.bool_)
        hidden.flat[rng.permutation(54)[: int(54 * share)]] = True
        image = drawn.image.copy()
        v, u = np.indices(image.shape)
        for corner in drawn.uv[hidden]:
            image[np.hypot(u - corner[0], v - corner[1]) < 15] = level
        roi = drawn.uv[[0, 0, -1, -1], [0, -1, -1, 0]] + rng.uniform(-4, 4, (4, 2))
        corners = find_corners(image, (6, 9), roi=roi)
        assert not hidden[corners.grid[:, 0], corners.grid[:, 1]].any()
        assert len(corners) >= 0.9 * np.count_nonzero(~hidden)
        np.testing.assert_allclose(corners.uv, truth_of(corners, drawn.uv), atol=0.05)


def test_arguments_without_sense_are_refused(draw: Any) -> None:
    image = draw().image
    with pytest.raises(ValueError, match="method"):
        find_corners(image, method="magic")
    with pytest.raises(ValueError, match="grey levels"):
        find_corners(np.zeros((40, 40, 4)))
    with pytest.raises(ValueError, match="inner corners"):
        find_corners(image, (1, 9))
    with pytest.raises(ValueError, match="convex"):
        find_corners(image, roi=[(0, 0), (9, 9), (0, 9), (9, 0)])
    with pytest.raises(ValueError, match="finite"):
        find_corners(np.full((40, 40), np.nan))


@pytest.mark.data
@pytest.mark.parametrize(
    ("folder", "pattern", "grid_size", "least"),
    [
        ("gopro_udacity_wide", "GOPR*.jpg", (6, 8), 35),
        ("udacity_carnd_9x6_partial", "*.jpg", (6, 9), 18),
        ("phone_iphonex", "*.jpg", (6, 8), 6),
    ],
)
def test_other_cameras(
    data_dir: Path, folder: str, pattern: str, grid_size: tuple[int, int], least: int
) -> None:
    full = 0
    for path in sorted((data_dir / folder).glob(pattern)):
        corners = find_corners(read_image(path).pixels)
        full += corners.shape == grid_size and corners.complete
    assert full >= least


def test_a_wide_gap_is_filled_line_by_line() -> None:
    scene = draw_scene(Conditions(grid_size=(5, 18), square=28.0, tilt=10.0, turn=0.0, parts=2), 1)
    col = np.indices((5, 18))[1]
    ends = Lattice(scene.uv, dark=True).select((col < 2) | (col > 15))
    board = board_refinement.refine_board(scene.photograph(1), ends, "edges")
    assert isinstance(board, board_refinement.RefinedBoard)
    assert len(board) == 90


ENDOSCOPE = Camera((640, 480), [520.0, 522.0, 318.0, 242.0, 0.34, 0.29, 0.0, 0.0, 0.0, 0.0])


@pytest.mark.parametrize("seed", [2, 13, 48, 103])
def test_a_board_that_the_lens_cuts_is_a_part_of_the_stated_one(seed: int) -> None:
    """The black around what an endoscope lights is not where the board ends."""
    rng = np.random.default_rng(seed)
    board = Board(10, 13, 3.0)
    middle = board.points().mean(axis=0)
    rvec = np.append(rng.uniform(-0.7, 0.7, 2), rng.uniform(-0.6, 0.6))
    away = np.append(rng.uniform(-9, 9, 2), rng.uniform(30, 40))
    pose = Pose(rvec, away - rotation_from_vector(rvec)[:, :2] @ middle)
    image = render_view(ENDOSCOPE, pose, board, blur=0.7, noise=1.0, seed=seed)
    v, u = np.mgrid[:480, :640]
    image[np.hypot(u - 320, v - 240) > 215] = 8
    corners = find_corners(image, board.grid_size)
    assert corners.shape == board.grid_size
    assert 20 < len(corners) < 130
    truth = project_points(board.points(), ENDOSCOPE, pose)
    assert np.linalg.norm(corners.uv[:, None] - truth, axis=2).min(axis=1).max() < 0.5

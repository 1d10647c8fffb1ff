"""Checkerboards with AprilTags in dark squares: rendered truth, and photographs of a fisheye."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from calibgui.engine.boards.board import Board
from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.detection.apriltags import find_tagged_checkerboard
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from calibgui.engine.images.reading import read_image
from calibgui.engine.lattices import pyramid_search
from tests.engine.conftest import Scene
from tests.engine.detection.apriltags.test_april_grid import CAMERA, FISHEYE, assert_at_bound
from tests.scenes.perspective import photograph_board, photograph_pattern

BOARD = Scene(
    Board(10, 14, 16.0, TaggedCheckerboard("t25h7", 2, 4, False)), camera=CAMERA, distance=300.0
)
FROM_TOP = Scene(
    Board(6, 9, 24.0, TaggedCheckerboard("t36h11", 1, 2, True)), camera=CAMERA, distance=260.0
)


@pytest.mark.parametrize("inverted", [False, True], ids=["", "inverted"])
@pytest.mark.parametrize("scene", [BOARD, FROM_TOP], ids=["25h7", "36h11"])
def test_all_is_inferred(scene: Scene, inverted: bool) -> None:
    image = scene.image()
    corners = find_corners(255 - image if inverted else image, pattern=TaggedCheckerboard())
    assert corners.pattern == scene.board.pattern
    assert corners.shape == scene.board.grid_size
    assert len(corners) >= 0.98 * scene.board.rows * scene.board.cols
    assert_at_bound(scene, corners, (0.8, 1.3))


@pytest.mark.parametrize("exposure", [1.0, 1.3], ids=["", "overexposed"])
def test_light_that_strays_is_told(exposure: float) -> None:
    """With the board's gradients of light alone chi2 was 7.7 and 8.0."""
    light = exposure * FROM_TOP.image().astype(np.float64)
    light = 0.85 * light + 0.15 * cv2.GaussianBlur(light, (0, 0), 8.0)
    image = np.clip(np.rint(light), 0, 255).astype(np.uint8)
    corners = find_corners(image, FROM_TOP.board.grid_size, pattern=FROM_TOP.board.pattern)
    assert corners.complete
    assert_at_bound(FROM_TOP, corners, (0.5, 1.4))


def test_a_narrow_border_is_not_read_as_a_wide_one() -> None:
    """With cells of another size some of its tags can be read, and their cells disturb corners."""
    scene = Scene(
        Board(8, 10, 20.0, TaggedCheckerboard("t25h7", 1, 2, False)), camera=CAMERA, distance=300.0
    )
    corners = find_corners(scene.image(), pattern=TaggedCheckerboard())
    assert corners.pattern == scene.board.pattern
    assert corners.complete
    assert_at_bound(scene, corners, (0.7, 1.4))


def test_tags_between_corners_do_not_hide_the_board() -> None:
    """Where something covers a part of the board, no corner can be spared beside the tags."""
    scene = Scene(
        Board(8, 10, 20.0, TaggedCheckerboard("t25h7", 1, 2, False)), camera=CAMERA, distance=330.0
    )
    image = scene.image(blur=1.2, noise=4.0)
    image[150:210, 260:330] = 128
    corners = find_corners(image, pattern=TaggedCheckerboard())
    assert corners.shape == scene.board.grid_size
    assert len(corners) >= 64
    assert_at_bound(scene, corners, (0.7, 1.4))


def test_blurred_tags_draw_no_corner_aside() -> None:
    """Their cells are 1.5 px wide here and begin as far from the edges."""
    board = Board(10, 13, 20.0, TaggedCheckerboard("t25h7", 1, 4, False))
    scene = Scene(board, camera=CAMERA, rvec=(0.3, 0.2, 0.1), distance=480.0)
    corners = find_corners(scene.image(blur=1.4, noise=1.0), pattern=TaggedCheckerboard())
    assert corners.complete
    assert np.linalg.norm(scene.error(corners), axis=1).max() < 0.03
    assert_at_bound(scene, corners, (0.7, 1.4))


def test_squares_that_a_fisheye_makes_narrow() -> None:
    """Towards the border of the image they look less like those in the middle."""
    scene = Scene(
        Board(14, 16, 20.0, TaggedCheckerboard("t25h7", 2, 4, False)),
        camera=FISHEYE,
        rvec=(-0.4, -0.6, 0.1),
        distance=110.0,
        aside=(90.0, 40.0),
    )
    corners = find_corners(scene.image(blur=0.8), pattern=TaggedCheckerboard())
    assert len(corners) >= 149
    assert_at_bound(scene, corners, (0.7, 1.5))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scene", "blur", "noise"),
    [
        (BOARD, 1.2, 2.0),
        (BOARD, 0.7, 15.0),
        (replace(BOARD, rvec=(1.05, 0.1, 0.3)), 0.7, 2.0),
    ],
    ids=["blurred", "noisy", "tilted"],
)
def test_hard_conditions(scene: Scene, blur: float, noise: float) -> None:
    corners = find_corners(scene.image(blur, noise), pattern=TaggedCheckerboard())
    assert len(corners) >= 135
    assert_at_bound(scene, corners, (0.7, 1.4))


def test_parts_have_the_ids_of_the_whole() -> None:
    scene = replace(BOARD, rvec=(0.3, -0.2, 2.6), distance=230.0, aside=(60.0, 40.0))
    image = scene.image()
    image[200:260, 300:380] = 128
    corners = find_corners(image, (10, 14), pattern=TaggedCheckerboard())
    assert 40 < len(corners) < 140
    assert_at_bound(scene, corners, (0.7, 1.4))


@pytest.mark.parametrize(
    ("stated", "grid_size"),
    [
        (TaggedCheckerboard("t36h11"), None),
        (TaggedCheckerboard(from_top=True), None),
        (TaggedCheckerboard(), (10, 22)),
        (TaggedCheckerboard(), (5, 14)),
    ],
)
def test_another_board_is_refused(
    stated: TaggedCheckerboard, grid_size: tuple[int, int] | None
) -> None:
    with pytest.raises(NoBoardError, match="no tags"):
        find_corners(BOARD.image(), grid_size, pattern=stated)


def test_a_plain_checkerboard_is_refused() -> None:
    with pytest.raises(NoBoardError, match="no tags"):
        find_corners(Scene(Board(5, 8, 20.0), camera=CAMERA).image(), pattern=TaggedCheckerboard())


def test_a_frame_beside_the_outermost_corners() -> None:
    """Seen from aside, squares are small where it leaves only a quarter of one in white."""
    scene = replace(BOARD, rvec=(1.05, 0.1, 0.3))
    corners = find_corners(_draw_frame(scene, 0.3), pattern=TaggedCheckerboard())
    assert len(corners) >= 138
    assert_at_bound(scene, corners, (0.7, 1.5))


def _draw_frame(scene: Scene, gap: float) -> NDArray[np.uint8]:
    """A photograph of a board with a dark frame around it, `gap` squares from its corners."""
    rows, cols = scene.board.grid_size
    along = np.linspace(0, 1, 40, endpoint=False)[:, None]
    ends = np.array([(0, 0), (cols - 1, 0), (cols - 1, rows - 1), (0, rows - 1)])
    ends = ends + gap * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    outline = np.concatenate([a + (b - a) * along for a, b in pairwise([*ends, ends[0]])])
    uv = project_points(scene.board.square * outline, scene.camera, scene.pose)
    parts, image = 8, scene.image()
    inside = np.zeros([parts * side for side in image.shape], np.uint8)
    cv2.fillPoly(inside, [np.rint((uv + 0.5) * parts * 16 - 8).astype(np.int32)], 255, shift=4)
    size = image.shape[::-1]
    share = cv2.GaussianBlur(cv2.resize(inside, size, interpolation=cv2.INTER_AREA), (0, 0), 0.6)
    return np.asarray(np.rint(30 + (image - 30.0) * (share / 255.0)), dtype=np.uint8)


@pytest.mark.data
def test_photographs_of_a_fisheye(data_dir: Path) -> None:
    """BabelCalib's: corners found by Deltille, numbered row by row from the upper left one.

    Beyond the outermost corners a frame begins within a third of a square and draws Deltille's
    corners aside by up to a pixel, visibly: only those inside are compared. Of the others, too, a
    tenth are off where squares are narrow. Where the two differ, a third finder agrees with ours.
    """
    stored_count = located = compared = near = differing = nearer = 0
    for file in sorted((data_dir / "babelcalib_ov_plane" / "corners" / "test").glob("*.orpc")):
        image = read_image(file.with_suffix(".png")).pixels
        corners = find_corners(image, pattern=TaggedCheckerboard())
        assert corners.pattern == TaggedCheckerboard("t25h7", 2, 4, False)
        assert corners.shape == (22, 22)
        rows = [line.split(",") for line in file.read_text().splitlines() if line[0].isdigit()]
        stored = np.full((22, 22, 2), np.nan)
        stored.reshape(-1, 2)[[int(row[1]) for row in rows]] = [
            (float(row[3]), float(row[4])) for row in rows
        ]
        mine = np.full((22, 22, 2), np.nan)
        mine[tuple(corners.grid.T)] = corners.uv
        off = np.linalg.norm(mine - stored, axis=2)
        assert np.nanmax(off) < 3
        stored_count += np.count_nonzero(np.isfinite(stored[..., 0]))
        located += np.count_nonzero(np.isfinite(off))
        inside = off[1:-1, 1:-1]
        compared += np.count_nonzero(np.isfinite(inside))
        near += np.count_nonzero(inside < 0.3)
        apart = off >= 0.3
        start = ((mine + stored) / 2)[apart][:, None].astype(np.float32)
        third = cv2.cornerSubPix(image, start, (3, 3), (-1, -1), (3, 100, 1e-4))[:, 0]
        to_mine, to_stored = (np.linalg.norm(third - uv[apart], axis=1) for uv in (mine, stored))
        differing += len(third)
        nearer += np.count_nonzero(to_mine < to_stored)
    assert located > 0.995 * stored_count
    assert near > 0.95 * compared
    assert nearer > 0.97 * differing


@pytest.mark.parametrize("step", [2, 6])
@pytest.mark.parametrize("is_inverted", [False, True])
def test_a_board_of_hundreds_of_corners(step: int, is_inverted: bool) -> None:
    """Tags in its middle show that it is one; half of that is hidden."""
    board = Board(21, 23, 20.0, TaggedCheckerboard("t36h11", 1, step, True))
    image = photograph_pattern((1200, 1100), board, 0.9, 0.7)
    image[550:700, 400:800] = 205
    corners = find_corners(255 - image if is_inverted else image, pattern=TaggedCheckerboard())
    assert len(corners) > 400
    assert corners.pattern == board.pattern


@pytest.mark.parametrize(
    ("stated", "grid_size"),
    [(TaggedCheckerboard(), None), (FROM_TOP.board.pattern, FROM_TOP.board.grid_size)],
)
def test_a_large_lattice_without_tags_is_neither_grown_nor_read(
    stated: TaggedCheckerboard, grid_size: tuple[int, int] | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In the "stripes" of 12 megapixels one of 2100 corners took five times as long as a board."""
    image = photograph_board((640, 480), (21, 29), 14.0, 0.8)
    monkeypatch.setattr(pyramid_search, "grow_lattice", lambda *_: pytest.fail("it was grown"))
    monkeypatch.setattr(
        find_tagged_checkerboard, "_identify_board", lambda *_: pytest.fail("it was read")
    )
    with pytest.raises(NoBoardError, match="no tags"):
        find_corners(image, grid_size, pattern=stated)


def test_a_stated_board_is_found_in_a_corner_of_a_floor_that_goes_on_from_it() -> None:
    """The middle of their lattice, which is as large as twenty boards, has no tags."""
    pattern, pitch = TaggedCheckerboard("t36h11", 1, 2, True), 20
    row, col = np.indices((36, 48))
    is_dark = (row + col) % 2 == 1 - int(pattern.is_first_square_dark((8, 10)))
    drawing = np.kron(np.where(is_dark, 45, 205), np.ones((pitch, pitch)))
    x, y = (np.arange(-1, end, 1 / pitch) + 0.5 / pitch for end in (10, 8))
    XY = np.stack(np.meshgrid(x, y), axis=-1)
    slopes = np.broadcast_to(np.eye(2) / pitch, (*XY.shape[:2], 2, 2))
    ink, _ = pattern.draw((8, 10)).compute_ink_share(XY, slopes)
    drawing[2 * pitch : 11 * pitch, 2 * pitch : 13 * pitch] = 205 - 160 * ink
    image = np.rint(cv2.GaussianBlur(drawing, (0, 0), 0.8)).astype(np.uint8)
    corners = find_corners(image, (8, 10), pattern=pattern)
    expected = pitch * (corners.grid[:, ::-1] + 3) - 0.5
    assert len(corners) == 80
    assert np.abs(corners.uv - expected).max() < 0.1


def test_the_negative_is_made_once_and_for_boards_without_dark_tags(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made: list[int] = []
    invert = find_tagged_checkerboard.invert_levels
    monkeypatch.setattr(
        find_tagged_checkerboard, "invert_levels", lambda grey: made.append(1) or invert(grey)
    )
    find_corners(FROM_TOP.image(), pattern=TaggedCheckerboard())
    assert not made
    two = np.full((480, 1280), 205, np.uint8)
    two[:, :640] = photograph_board((640, 480), (7, 9), 30.0, 0.8)
    two[:, 640:] = photograph_board((640, 480), (5, 6), 40.0, 0.8)
    with pytest.raises(NoBoardError):
        find_corners(two, pattern=TaggedCheckerboard())
    assert len(made) == 1

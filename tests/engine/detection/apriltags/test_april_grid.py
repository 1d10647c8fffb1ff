"""AprilGrids against rendered truth."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.boards.april_grid import AprilGrid, TagLayout
from calibgui.engine.boards.apriltags import load_family
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.checkerboard import CHECKERBOARD
from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.detection.apriltags import find_april_grid, grid_tags, tag_outlines
from calibgui.engine.detection.apriltags.outline_model import (
    OutlineModel,
    accumulate_normal_equations,
)
from calibgui.engine.detection.apriltags.tag_gap import fit_gap, measure_gap
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import CalibrationError, NoBoardError, UnknownPartError
from calibgui.engine.features.corners import Corners
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.images.sampling import make_mesh
from tests.engine.conftest import Scene
from tests.scenes.perspective import photograph_pattern

CAMERA = Camera((640, 480), [560.0, 562.0, 322.0, 238.0, 0.1, 0.02, 0.0, 1e-4, 0.0, 0.0])
WIDE = Camera((640, 480), [300.0, 300.0, 320.0, 240.0, 0.35, 0.1, 0.0, 0.0, 0.0, 0.0])
FISHEYE = Camera((640, 480), [230.0, 230.0, 320.0, 240.0, 0.0, 0.0, 0.0, 0.0], "kannala-brandt")
KALIBR = Scene(
    Board(8, 10, 20.0, AprilGrid("t36h11", 0.3, 2, False)), camera=CAMERA, distance=300.0
)
BARE = replace(
    KALIBR, board=replace(KALIBR.board, pattern=AprilGrid("t36h11", 0.3, 2, False, False))
)
"""The same without the small dark squares."""
OTHERS = [
    Board(6, 8, 25.0, AprilGrid("t25h9", 0.25, 2, True)),
    Board(8, 6, 25.0, AprilGrid("t16h5", 0.3, 1, False)),
    Board(8, 8, 22.0, AprilGrid("t25h7", 0.2, 2, False)),
    Board(6, 8, 25.0, AprilGrid("t25h9", 0.25, 2, True, False)),
    Board(8, 6, 25.0, AprilGrid("t16h5", 0.3, 1, False, False)),
]


def assert_at_bound(
    scene: Scene, corners: Corners, chi2: tuple[float, float] = (0.0, np.inf)
) -> float:
    """Check corners against the truth: none wrong, their covariances honest. Return chi2/dof."""
    error = scene.error(corners)
    assert corners.cov is not None
    sigma = np.sqrt(corners.cov[:, [0, 1], [0, 1]])
    assert np.abs(error / sigma).max() < 6
    found = np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error).mean() / 2
    assert chi2[0] < found < chi2[1]
    return float(found)


@pytest.mark.parametrize("inverted", [False, True], ids=["", "inverted"])
def test_all_is_inferred(inverted: bool) -> None:
    image = KALIBR.image()
    corners = find_corners(255 - image if inverted else image, pattern=AprilGrid())
    assert corners.shape == (8, 10)
    assert corners.complete
    assert np.sqrt(np.mean(KALIBR.error(corners) ** 2)) < 0.008
    assert_at_bound(KALIBR, corners, (0.8, 1.3))
    seen = corners.pattern
    assert isinstance(seen, AprilGrid)
    assert (seen.family, seen.border, seen.from_top) == ("t36h11", 2, False)
    assert seen.spacing == pytest.approx(0.3, abs=0.001)


@pytest.mark.parametrize("grid_size", [(4, 4), (8, 6)])
@pytest.mark.parametrize("gap", [0.3, 2 / 7])
def test_a_lens_does_not_widen_the_gap(grid_size: tuple[int, int], gap: float) -> None:
    """A gap that is off by a hundredth makes a calibration doubt the board."""
    board = Board(*grid_size, 20.0, AprilGrid(spacing=gap))
    scene = Scene(board, camera=FISHEYE, rvec=(0.4, -0.2, 0.1), distance=75.0, aside=(30.0, 10.0))
    grid = np.indices(grid_size).reshape(2, -1).T
    points = board.points() @ rotation_from_vector(np.array(scene.rvec))[:, :2].T
    uv = pixels_from_rays(points + scene.pose.tvec, FISHEYE)
    rough = measure_gap(uv.reshape(*grid_size, 2), 1.0)
    assert abs(rough - gap) > 0.005
    assert fit_gap(grid, uv, rough) == pytest.approx(gap, abs=3e-4)


@pytest.mark.parametrize("gap", [0.99, 1.0])
def test_noise_makes_no_gap_wider_than_an_april_grid_has(gap: float) -> None:
    grid = np.indices((6, 8)).reshape(2, -1).T
    tag, corner = np.divmod(grid[:, ::-1], 2)
    uv = 30.0 * ((1 + gap) * tag + corner)
    noisy = uv + np.random.default_rng(0).normal(0, 0.02, uv.shape)
    assert fit_gap(grid, noisy, gap) == pytest.approx(gap, abs=2e-3)


@pytest.mark.parametrize("corners", [[(0, 0), (0, 1), (1, 0), (1, 1)], [(0, 0), (0, 1), (0, 2)]])
def test_corners_that_do_not_tell_the_gap_leave_it(corners: list[tuple[int, int]]) -> None:
    grid = np.array(corners)
    assert fit_gap(grid, 30.0 * grid[:, ::-1], 0.3) == 0.3


@pytest.mark.parametrize("corner_squares", [True, False])
def test_a_narrow_border_is_not_read_as_a_wide_one(corner_squares: bool) -> None:
    """With cells of another size some of its tags can be read as well."""
    pattern = AprilGrid("t36h11", 0.3, 1, False, corner_squares)
    image = photograph_pattern((640, 480), Board(8, 10, 1.0, pattern), 0.8, 0.8)
    corners = find_corners(image, pattern=AprilGrid())
    assert corners.complete
    seen = corners.pattern
    assert isinstance(seen, AprilGrid)
    assert (seen.family, seen.border) == ("t36h11", 1)
    assert seen.spacing == pytest.approx(0.3, abs=0.001)


@pytest.mark.parametrize("cell", [10, 30])
def test_tags_are_read_whose_borders_are_broad(cell: int) -> None:
    """What is in the middle of their borders is far from the paper."""
    board = Board(8, 6, 1.0, AprilGrid("t36h11", 0.3, 2, False, True))
    print_ = board.pattern.draw(board.grid_size)
    left, top, right, bottom = print_.extent
    step = 1 / (10 * cell)
    XY = make_mesh(
        np.arange(left - 0.5, right + 0.5, step), np.arange(top - 0.5, bottom + 0.5, step)
    )
    ink, _ = print_.compute_ink_share(XY, np.broadcast_to(step * np.eye(2), (*XY.shape, 2)))
    image = np.rint(cv2.GaussianBlur(230.0 - 190.0 * ink, (0, 0), 0.7)).astype(np.uint8)
    corners = find_corners(image, (8, 6), pattern=AprilGrid())
    assert corners.complete
    truth = (board.points() - [left - 0.5, top - 0.5]) / step
    assert np.allclose(np.sort(corners.uv, axis=0), np.sort(truth, axis=0), atol=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("board", OTHERS, ids=["25h9", "16h5", "25h7", "bare 25h9", "bare 16h5"])
def test_other_families_orders_and_gaps(board: Board) -> None:
    scene = Scene(board, camera=CAMERA, distance=300.0)
    corners = find_corners(scene.image(), pattern=AprilGrid())
    assert corners.shape == board.grid_size
    assert corners.complete
    assert_at_bound(scene, corners, (0.7, 1.4))
    seen, stated = corners.pattern, board.pattern
    assert isinstance(seen, AprilGrid)
    assert isinstance(stated, AprilGrid)
    assert seen.spacing == pytest.approx(stated.spacing, abs=0.001)
    assert replace(seen, spacing=stated.spacing) == replace(
        stated, corner_squares=stated.corner_squares is not False
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scene", "blur", "noise", "least"),
    [
        (KALIBR, 1.6, 2.0, 70),
        (KALIBR, 0.7, 15.0, 78),
        (KALIBR, 2.0, 15.0, 76),
        (replace(KALIBR, rvec=(1.05, 0.1, 0.3)), 0.7, 2.0, 74),
        (replace(KALIBR, distance=500.0), 0.7, 2.0, 78),
        (BARE, 0.4, 2.0, 78),
        (BARE, 2.0, 2.0, 40),
        (BARE, 0.7, 15.0, 78),
        (replace(BARE, rvec=(1.05, 0.1, 0.3)), 0.7, 2.0, 74),
        (replace(BARE, distance=500.0), 0.7, 2.0, 78),
        (replace(BARE, camera=WIDE, distance=150.0), 0.7, 2.0, 74),
    ],
    ids=[
        "blurred",
        "noisy",
        "blurred and noisy",
        "tilted",
        "far",
        "bare, sharp",
        "bare, blurred",
        "bare, noisy",
        "bare, tilted",
        "bare, far",
        "bare, fisheye",
    ],
)
def test_hard_conditions(scene: Scene, blur: float, noise: float, least: int) -> None:
    chi2 = []
    for seed in range(3):  # that of one image scatters by up to 0.17
        corners = find_corners(scene.image(blur, noise, seed), pattern=AprilGrid())
        assert len(corners) >= least
        chi2.append(assert_at_bound(scene, corners))
    assert 0.7 < np.mean(chi2) < 1.4


@pytest.mark.parametrize("inverted", [False, True], ids=["", "inverted"])
def test_tags_alone_have_their_corners_where_their_edges_meet(inverted: bool) -> None:
    image = BARE.image()
    corners = find_corners(255 - image if inverted else image, pattern=AprilGrid())
    assert corners.complete
    assert len(corners) == 80
    assert np.sqrt(np.mean(BARE.error(corners) ** 2)) < 0.009
    assert_at_bound(BARE, corners, (0.8, 1.3))
    seen = corners.pattern
    assert isinstance(seen, AprilGrid)
    assert seen.corner_squares is False
    assert seen.spacing == pytest.approx(0.3, abs=0.001)


def cover_tags(image: GreyImage, shown: tuple[int, ...]) -> GreyImage:
    """Cover all tags of `KALIBR` but a few with paper."""
    covered = image.copy()
    corners = find_corners(image, pattern=AprilGrid())
    squares = TagLayout(5, False).locate_squares(np.arange(20)) + np.array([3, 0])
    for number in set(range(20)) - set(shown):
        quad = corners.uv[(corners.grid // 2 == squares[number]).all(axis=1)]
        (u0, v0), (u1, v1) = quad.min(axis=0).astype(int) + 1, quad.max(axis=0).astype(int)
        covered[v0:v1, u0:u1] = 235
    return covered


def test_tags_far_apart_do_not_tell_how_long_a_row_is() -> None:
    """Tags 3, 15 and 16 agree on rows of 7 tags with wide gaps as well as on those of 5."""
    image = cover_tags(KALIBR.image(), (3, 15, 16))
    with pytest.raises(NoBoardError, match="No AprilGrid"):
        find_corners(image, pattern=AprilGrid())
    corners = find_corners(image, (8, 10), pattern=AprilGrid())
    assert len(corners) == 12
    assert_at_bound(KALIBR, corners, (0.5, 2.0))


@pytest.mark.parametrize("exchanged", [2, 8])
def test_tags_in_other_places_than_their_numbers_say_are_no_board(exchanged: int) -> None:
    """Two that were glued on wrongly are left out; of a sheet of tags some agree by chance."""
    numbers = np.arange(20)
    numbers[6 : 6 + exchanged] = np.roll(numbers[6 : 6 + exchanged], 1)
    tags = np.pad(load_family("t36h11").cells[numbers], ((0, 0), (4, 4), (4, 4)))
    tags[:, 2:12, 2:12] |= np.pad(np.zeros((6, 6), bool), 2, constant_values=True)
    sheet = np.block([[tags[5 * row + col] for col in range(5)] for row in range(4)])
    ink = np.kron(np.pad(sheet, 4), np.ones((8, 8), np.uint8))
    image = cv2.GaussianBlur(np.where(ink, 40, 220).astype(np.uint8), (0, 0), 1.0)
    if exchanged == 2:
        assert len(find_corners(image, pattern=AprilGrid())) == 4 * (20 - exchanged)
    else:
        with pytest.raises(NoBoardError, match="No AprilGrid"):
            find_corners(image, pattern=AprilGrid())


def test_blur_does_not_move_the_corners_of_tags_alone_outwards() -> None:
    for blur in (0.4, 2.0):
        corners = find_corners(BARE.image(blur, noise=0.3), pattern=AprilGrid())
        sides = np.where(corners.grid % 2 == 0, -1, 1)[:, ::-1]
        R = rotation_from_vector(np.array(BARE.rvec))
        outwards = sides @ R[:2, :2].T
        moved = np.sum(BARE.error(corners) * outwards, axis=1) / np.linalg.norm(outwards, axis=1)
        assert abs(moved.mean()) < 0.007


@pytest.mark.parametrize("angle", [0.0, 40.0, 130.0])
def test_motion_does_not_draw_corners_of_tags_alone_aside(angle: float) -> None:
    """Motion along a diagonal of the tags blurs two corners of each more than the others."""
    way = np.linspace(-2.5, 2.5, 300)[:, None] * [
        np.cos(np.radians(angle)),
        np.sin(np.radians(angle)),
    ]
    edges = np.arange(-5.0, 6.0) - 0.5
    kernel, *_ = np.histogram2d(way[:, 1], way[:, 0], bins=(edges, edges))
    moved = cv2.filter2D(BARE.image(0.7, noise=0.0).astype(np.float64), -1, kernel / len(way))
    noise = np.random.default_rng(3).standard_normal(moved.shape)
    image = np.clip(np.rint(moved + 2 * noise), 0, 255).astype(np.uint8)
    assert_at_bound(BARE, find_corners(image, pattern=AprilGrid()), (0.4, 1.6))


@pytest.mark.parametrize(
    ("camera", "rows", "cols", "distance"),
    [(CAMERA, 4, 4, 260.0), (CAMERA, 4, 6, 170.0), (WIDE, 4, 6, 140.0), (WIDE, 8, 10, 130.0)],
    ids=["4 tags", "6 tags", "6 tags, fisheye", "20 tags, fisheye"],
)
def test_edges_of_tags_are_bent_by_the_lens(
    camera: Camera, rows: int, cols: int, distance: float
) -> None:
    """Few tags tell little of the lens, and many do not say all of it."""
    board = replace(BARE.board, rows=rows, cols=cols)
    scene = replace(BARE, board=board, camera=camera, distance=distance)
    corners = find_corners(scene.image(), pattern=AprilGrid())
    assert len(corners.uv) >= 0.9 * rows * cols
    assert_at_bound(scene, corners, (0.5, 1.8))


def test_a_tag_of_which_a_corner_is_covered_counts_little() -> None:
    """Its edges tell where its corners are, but not as its whole outline would."""
    image = BARE.image()
    whole = find_corners(image, pattern=AprilGrid())
    at = whole.uv[(whole.grid == (3, 4)).all(axis=1)][0].astype(int)
    image[at[1] - 6 : at[1] + 6, at[0] - 6 : at[0] + 6] = 128
    corners = find_corners(image, pattern=AprilGrid())
    assert_at_bound(BARE, corners, (0.7, 1.4))
    assert corners.cov is not None
    sigma = np.sqrt(np.trace(corners.cov, axis1=1, axis2=2) / 2)
    of_tag = (corners.grid // 2 == (1, 2)).all(axis=1)
    assert (sigma[of_tag] > 8 * np.median(sigma)).all()
    assert np.abs(BARE.error(corners)[of_tag]).max() < 0.2


def test_a_tag_that_is_covered_is_left_out() -> None:
    image = BARE.image()
    whole = find_corners(image, pattern=AprilGrid())
    of_tag = (whole.grid // 2 == (1, 2)).all(axis=1)
    low, high = whole.uv[of_tag].min(axis=0).astype(int), whole.uv[of_tag].max(axis=0).astype(int)
    image[low[1] - 3 : high[1] + 3, low[0] - 3 : (low[0] + high[0]) // 2] = 128
    corners = find_corners(image, pattern=AprilGrid())
    assert 72 <= len(corners) < 80
    assert not (corners.grid == (3, 4)).all(axis=1).any()
    assert_at_bound(BARE, corners, (0.7, 1.4))


@pytest.mark.parametrize("level", [170, 220])
def test_what_covers_a_border_is_not_its_edge(level: int) -> None:
    """The outline of the tag below fits with it nearly as well, but a corner lay 1 px aside."""
    image = BARE.image(noise=5.0)
    whole = find_corners(image, pattern=AprilGrid())
    upper, lower = (
        whole.uv[(whole.grid == corner).all(axis=1)][0].astype(int) for corner in ((2, 9), (3, 9))
    )
    part = image[upper[1] - 12 : lower[1] - 1, min(upper[0], lower[0]) - 3 : upper[0] + 14]
    part[...] = np.clip(np.random.default_rng(1).normal(level, 5, part.shape), 0, 255)
    corners = find_corners(image, pattern=AprilGrid())
    assert len(corners) >= 76
    assert corners.cov is not None
    sigma = np.sqrt(np.trace(corners.cov, axis1=1, axis2=2) / 2)
    assert (np.linalg.norm(BARE.error(corners), axis=1) < 5 * sigma).all()


@pytest.mark.parametrize("soft", [0.5, 3.0])
def test_a_hard_shadow_leaves_tags_alone_their_corners(soft: float) -> None:
    """Those within it have a quarter of the contrast; those that its edge crosses are read by the
    steps between their cells, and their outlines followed by the levels beside them."""
    image = BARE.image()
    v, u = np.indices(image.shape)
    lit = 1 / (1 + np.exp(-np.clip((u + 0.4 * v - 430) / soft, -50, 50)))
    corners = find_corners((image * (0.25 + 0.75 * lit)).astype(np.uint8), pattern=AprilGrid())
    assert len(corners) >= 74 and corners.cov is not None
    error = BARE.error(corners)
    assert np.abs(error).max() < 1.5
    sigma = np.sqrt(np.trace(corners.cov, axis1=1, axis2=2) / 2)
    assert (np.linalg.norm(error, axis=1) < 5 * sigma).all()


def test_parts_have_the_ids_of_the_whole() -> None:
    """The lower left tags are the first, so that a part without them shows where it belongs once
    the size is known."""
    scene = replace(KALIBR, rvec=(0.3, -0.2, 2.6), distance=230.0, aside=(60.0, 40.0))
    image = scene.image()
    image[200:280, 300:400] = 128
    corners = find_corners(image, (8, 10), pattern=AprilGrid())
    assert 20 < len(corners) < 80
    assert_at_bound(scene, corners, (0.7, 1.4))


@pytest.mark.parametrize(
    ("stated", "grid_size", "says"),
    [
        (AprilGrid("t25h9"), None, "AprilGrid of t36h11"),
        (AprilGrid(border=1), None, "borders of 2|too few corners"),
        (AprilGrid(from_top=True), None, "bottom row up"),
        (AprilGrid(spacing=0.2), None, "0.300 of their side"),
        (AprilGrid(corner_squares=False), None, "with dark squares between the tags"),
        (AprilGrid(), (8, 8), "exactly 5 columns"),
        (AprilGrid(), (6, 10), "at least 4 rows"),
    ],
)
def test_what_is_wrongly_stated_is_told(
    stated: AprilGrid, grid_size: tuple[int, int] | None, says: str
) -> None:
    with pytest.raises(NoBoardError, match=says):
        find_corners(KALIBR.image(), grid_size, pattern=stated)


@pytest.mark.parametrize("blur", [0.8, 1.2])
def test_corners_of_tags_alone_know_what_jpeg_does_to_them(blur: float) -> None:
    """JPEG makes errors of neighbouring pixels alike."""
    _, data = cv2.imencode(".jpg", BARE.image(blur, noise=2.0), [cv2.IMWRITE_JPEG_QUALITY, 20])
    corners = find_corners(cv2.imdecode(data, cv2.IMREAD_GRAYSCALE), pattern=AprilGrid())
    assert_at_bound(BARE, corners, (0.5, 1.8))


def test_sharp_edges_are_not_taken_for_errors_in_common() -> None:
    """Interpolated between pixels they differ from line to line."""
    corners = find_corners(BARE.image(0.3, noise=0.3), pattern=AprilGrid())
    assert_at_bound(BARE, corners, (0.5, 1.8))


@pytest.mark.parametrize("noise", [20, 25])
def test_noise_makes_no_dark_squares_of_paper(noise: int) -> None:
    """Corners that were looked for at such squares lay up to 4 px off."""
    light = BARE.image(0.7, noise=0.0).astype(np.float64)
    noisy = light + noise * np.random.default_rng(1).standard_normal(light.shape)
    corners = find_corners(np.clip(np.rint(noisy), 0, 255).astype(np.uint8), pattern=AprilGrid())
    assert isinstance(corners.pattern, AprilGrid) and not corners.pattern.corner_squares
    assert len(corners) > 70 and np.abs(BARE.error(corners)).max() < 0.6


def test_missing_small_squares_are_told() -> None:
    with pytest.raises(NoBoardError, match="without dark squares between the tags"):
        find_corners(BARE.image(), pattern=AprilGrid(corner_squares=True))


def test_no_grid() -> None:
    noise = np.random.default_rng(0).integers(0, 255, (300, 400)).astype(np.uint8)
    checkerboard = Scene(Board(5, 8, 20.0), camera=CAMERA).image()
    for image in (noise, np.full((100, 100), 9, np.uint8), checkerboard):
        with pytest.raises(NoBoardError, match="No AprilGrid"):
            find_corners(image, pattern=AprilGrid())


def test_a_grid_is_no_checkerboard() -> None:
    with pytest.raises(NoBoardError):
        find_corners(KALIBR.image(), pattern=CHECKERBOARD)


@pytest.mark.slow
@pytest.mark.parametrize("kind", [np.uint16, np.float32])
def test_other_levels(kind: type) -> None:
    corners = find_corners(KALIBR.image().astype(kind) * 3, pattern=AprilGrid())
    assert corners.complete


def test_tags_farther_apart_than_they_are_wide_are_no_april_grid() -> None:
    for gap in (0.3, 0.98, 1.02, 1.1):
        row, col = np.indices((4, 6))
        uv = 50 * np.stack([each // 2 * (1 + gap) + each % 2 for each in (col, row)], axis=-1)
        if gap > 1.05:
            with pytest.raises(NoBoardError, match="too far apart"):
                measure_gap(uv, 0.9)
        else:
            assert measure_gap(uv, 0.9) == pytest.approx(min(gap, 1.0))


def test_a_gap_as_wide_as_the_tags_is_told_without_small_squares() -> None:
    """With them the board is a checkerboard with tags in every second row and column."""
    bare = replace(KALIBR, board=Board(6, 8, 14.0, AprilGrid("t36h11", 1.0, 2, False, False)))
    corners = find_corners(bare.image(), pattern=AprilGrid())
    assert corners.complete
    assert np.abs(bare.error(corners)).max() < 0.1
    assert isinstance(corners.pattern, AprilGrid)
    assert corners.pattern.spacing == pytest.approx(1.0, abs=0.001)
    board = Board(6, 8, 14.0, TaggedCheckerboard("t36h11", 2, 2, False))
    with pytest.raises(NoBoardError, match="too far apart"):
        find_corners(replace(KALIBR, board=board).image(), pattern=AprilGrid())
    with pytest.raises(CalibrationError, match="a checkerboard with tags"):
        AprilGrid("t36h11", 1.0, 2, False, True).draw((6, 8))


def test_corners_that_are_predicted_badly_are_looked_for_where_the_others_expect_them() -> None:
    """Those of a tag that was read beside one of which a corner was far off."""
    board = KALIBR.board
    truth = project_points(board.points(), KALIBR.camera, KALIBR.pose).reshape(8, 10, 2)
    predicted = truth.copy()
    predicted[2:4, 4:6] += [6.0, 2.0]
    lattice = Lattice(predicted, dark=True)
    refined = find_april_grid._refine_corners(KALIBR.image(), lattice, 0.3, 0.2)
    assert np.abs(refined.uv - truth).max() < 0.5


@pytest.mark.parametrize("distance", [300.0, 350.0])
def test_corners_between_narrow_gaps_are_as_sure_as_they_are_right(distance: float) -> None:
    """In a gap of 3 to 4 px hardly more pixels are read at a corner than it has unknowns."""
    board = Board(8, 10, 20.0, AprilGrid("t36h11", 0.1, 1, False))
    scene = replace(KALIBR, board=board, rvec=(0.3, 0.2, 0.1), distance=distance)
    corners = find_corners(scene.image(), board.grid_size, pattern=AprilGrid())
    assert len(corners) >= 74
    assert_at_bound(scene, corners, (0.5, 1.3))


@pytest.mark.parametrize("squares", [None, True])
def test_gaps_that_are_blurred_away_are_told(squares: bool | None) -> None:
    """Their small squares are no paper, and the corners beside them lie a pixel aside."""
    board = Board(8, 10, 20.0, AprilGrid("t36h11", 0.1, 1, False))
    scene = replace(KALIBR, board=board, rvec=(0.3, 0.2, 0.1), distance=220.0)
    with pytest.raises(UnknownPartError, match="so narrow in this image"):
        find_corners(scene.image(blur=2.5), pattern=AprilGrid(corner_squares=squares))


@pytest.mark.parametrize("squares", [False, True])
def test_corners_beside_blurred_gaps_are_as_unsure_as_they_are_wrong(squares: bool) -> None:
    board = Board(8, 10, 20.0, AprilGrid("t36h11", 0.2, 1, False, squares))
    scene = replace(KALIBR, board=board, rvec=(0.3, 0.2, 0.1), distance=250.0)
    corners = find_corners(scene.image(blur=2.5), pattern=AprilGrid())
    assert len(corners) == 80
    assert corners.cov is not None
    error = scene.error(corners)
    assert np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error).mean() / 2 < 2.5


def test_noise_moves_no_corners_of_tags_without_small_squares() -> None:
    """It has saddle points beside the corners of large tags, which are none themselves."""
    pattern = AprilGrid("t36h11", 0.3, 2, True, False)
    scene = Scene(Board(4, 4, 80.0, pattern), CAMERA, (0.2, -0.3, 0.3), 322.0)
    image = scene.image(noise=0.0)
    rng = np.random.default_rng(1)
    uv = project_points(scene.board.points(), CAMERA, scene.pose).reshape(4, 4, 2)
    quads = uv[:2, :2].reshape(1, 4, 2)[:, [0, 1, 3, 2]]
    for _ in range(60):
        noisy = np.clip(np.rint(image + rng.normal(0, 2, image.shape)), 0, 255).astype(np.uint8)
        near = quads + rng.uniform(-1, 1, quads.shape)
        assert np.abs(grid_tags._refine_quads(noisy, near) - quads).max() < 2


@pytest.mark.parametrize(("noise", "most"), [(2.0, 2), (10.0, 4)])
def test_few_steps_lead_to_outlines(
    noise: float, most: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each sums up over all pixels beside the edges, which takes as long as all else of the fit."""
    taken = []

    def count(image: GreyImage, model: OutlineModel, is_sharp: bool) -> Array:
        taken.append(len(model.corners))
        return accumulate_normal_equations(image, model, is_sharp)

    monkeypatch.setattr(tag_outlines, "accumulate_normal_equations", count)
    corners = find_corners(BARE.image(noise=noise), pattern=AprilGrid())
    assert_at_bound(BARE, corners, (0.7, 1.4))
    assert sum(taken) <= most * taken[0]


def test_a_gap_measured_wider_than_a_tag_is_no_error_of_the_pattern() -> None:
    """Of a checkerboard with tags in every second row and column it may be 1.0004."""
    board = Board(8, 10, 20.0, TaggedCheckerboard("t36h11", 1, 2, from_top=True))
    image = photograph_pattern((640, 480), board, 0.7, 0.8)
    with pytest.raises(NoBoardError):
        find_corners(image, pattern=AprilGrid())


@pytest.mark.parametrize("known", ["nothing", "its size", "its size and first tag"])
@pytest.mark.parametrize(
    ("grid_size", "first", "from_top", "corner_squares"),
    [
        ((8, 10), 20, False, True),
        ((8, 10), 100, True, True),
        ((8, 10), 20, True, False),
        ((6, 12), 18, False, False),
        ((6, 12), 480, False, True),
    ],
)
def test_a_second_board_is_told_by_its_first_tag(
    grid_size: tuple[int, int], first: int, from_top: bool, corner_squares: bool, known: str
) -> None:
    pattern = AprilGrid("t36h11", 0.3, 2, from_top, corner_squares, first)
    scene = replace(KALIBR, board=Board(*grid_size, 20.0, pattern))
    size = None if known == "nothing" else grid_size
    stated = AprilGrid(first_tag=first if "first" in known else None)
    corners = find_corners(scene.image(), size, pattern=stated)
    assert corners.shape == grid_size
    assert corners.complete
    assert isinstance(corners.pattern, AprilGrid)
    assert corners.pattern.first_tag == first
    assert_at_bound(scene, corners)


def test_rows_need_not_begin_with_a_multiple_of_their_length() -> None:
    pattern = AprilGrid("t36h11", 0.3, 2, False, True, 33)
    scene = replace(KALIBR, board=Board(8, 10, 20.0, pattern))
    corners = find_corners(scene.image(), pattern=AprilGrid(first_tag=33))
    assert corners.shape == (8, 10)
    assert_at_bound(scene, corners)


def test_a_part_of_a_board_does_not_begin_with_its_lowest_tag() -> None:
    """The lowest rows are covered, or not in the image."""
    whole = find_corners(KALIBR.image(), pattern=AprilGrid())
    end = int(whole.uv[whole.grid[:, 0] == 6, 1].min())
    for image, grid_size in (
        (cover_tags(KALIBR.image(), tuple(range(5, 20))), None),
        (cover_tags(KALIBR.image(), tuple(range(10, 20))), (8, 10)),
        (KALIBR.image()[:end], None),
    ):
        corners = find_corners(image, grid_size, pattern=AprilGrid())
        assert isinstance(corners.pattern, AprilGrid)
        assert corners.pattern.first_tag is None
        assert corners.shape == (8, 10)
        assert corners.grid[:, 0].min() == 0


def test_a_board_of_another_first_tag_is_told() -> None:
    pattern = AprilGrid("t36h11", 0.3, 2, False, True, 20)
    image = replace(KALIBR, board=Board(8, 10, 20.0, pattern)).image()
    with pytest.raises(NoBoardError, match="no number below 20"):
        find_corners(image, (8, 10), pattern=AprilGrid(first_tag=0))
    with pytest.raises(CalibrationError, match="cannot have the number -1"):
        AprilGrid(first_tag=-1)


@pytest.mark.parametrize(
    ("turn", "from_top", "corner_squares"),
    [(1, False, True), (1, True, False), (2, False, False), (2, True, True), (3, False, True)],
)
def test_tags_that_are_turned_on_the_board_are_read(
    turn: int, from_top: bool, corner_squares: bool
) -> None:
    """OpenCV's tags are turned by a half; along columns counted ones by a quarter."""
    pattern = AprilGrid("t36h11", 0.3, 2, from_top, corner_squares, None, turn)
    scene = replace(KALIBR, board=Board(6, 8, 24.0, pattern))
    corners = find_corners(scene.image(), pattern=AprilGrid())
    assert corners.shape == (6, 8)
    assert corners.complete
    assert isinstance(corners.pattern, AprilGrid)
    assert (corners.pattern.tag_turn, corners.pattern.from_top) == (turn, from_top)
    assert_at_bound(scene, corners)


def test_a_row_of_turned_tags_is_no_board_of_one_column() -> None:
    pattern = AprilGrid("t36h11", 0.3, 2, False, True, None, 1)
    scene = replace(KALIBR, board=Board(8, 10, 20.0, pattern))
    one_row = cover_tags(scene.image(), tuple(range(5, 10)))
    with pytest.raises(NoBoardError):
        find_corners(one_row, pattern=AprilGrid())
    corners = find_corners(one_row, (8, 10), pattern=AprilGrid(from_top=False))
    assert_at_bound(scene, corners)
    with pytest.raises(NoBoardError, match="each tag turned by 90 degrees"):
        find_corners(scene.image(), (10, 8), pattern=AprilGrid())
    with pytest.raises(NoBoardError, match="each tag turned by 90 degrees"):
        find_corners(scene.image(), (8, 10), pattern=AprilGrid(tag_turn=0))
    with pytest.raises(CalibrationError, match="turned by 4 quarters"):
        AprilGrid(tag_turn=4)

"""Grids of circles against rendered truth; the bias of their centres."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from calibgui.engine.arrays import Array, GreyImage, GridSize
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.boards.pattern import Symmetry
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.detection.circles import ellipse_fit, measurement
from calibgui.engine.detection.circles.circle_map import fit_circle_map
from calibgui.engine.detection.circles.continuation import find_continuation
from calibgui.engine.detection.circles.ellipse_fit import EllipseFit
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import CalibrationError, NoBoardError
from calibgui.engine.features.corners import Corners
from tests.engine.conftest import CAMERA, Scene
from tests.scenes.marked_circles import MarkedCircles
from tests.scenes.without_board import draw_without_board

NO_LENS = Camera(CAMERA.size, [*CAMERA.params[:4], *np.zeros(6)])
BENT = Camera(CAMERA.size, [*CAMERA.params[:4], 0.25, 0.02, 0.0, 0.0, 0.0, 0.0])
WIDE = Camera(CAMERA.size, [340.0, 340.0, 500.0, 370.0, 0.35, 0.1, 0.0, 0.0, 0.0, 0.0])
STEEP = (1.0, 0.1, 0.1)


@pytest.mark.parametrize("camera", [NO_LENS, BENT], ids=["no lens", "strong lens"])
@pytest.mark.parametrize(
    ("pattern", "grid_size", "rvec"),
    [
        (Circles(False, 0.6), (7, 9), STEEP),
        (Circles(True, 0.9), (11, 4), (-0.9, 0.2, 0.2)),
    ],
)
def test_the_bias_of_the_centres_is_corrected(
    camera: Camera, pattern: Circles, grid_size: tuple[int, int], rvec: tuple[float, float, float]
) -> None:
    """Of a large image without noise nothing but the grey levels' rounding is left."""
    scene = Scene(Board(*grid_size, 16.0, pattern), camera, rvec, distance=260.0)
    corners = find_corners(scene.image(noise=0.0), grid_size, pattern=Circles(pattern.asymmetric))
    assert corners.complete
    error = scene.error(corners)
    assert np.sqrt(np.mean(error**2)) < 0.005
    assert abs(error.mean(axis=0)).max() < 0.002
    seen = corners.pattern
    assert isinstance(seen, Circles)
    assert seen.diameter == pytest.approx(pattern.diameter, abs=0.005)
    # Left as they are, the ellipses' centres are off many times as far.
    xy = pattern.locate_points(corners.grid.astype(float))
    bias = fit_circle_map(xy, corners.uv).compute_centre_bias(
        xy, np.full(len(xy), seen.diameter / 2)
    )
    assert np.sqrt(np.mean((error + bias) ** 2)) > 10 * np.sqrt(np.mean(error**2))


def test_few_circles_tell_the_bias_under_a_mild_lens() -> None:
    """It grows with the tilt, so that a part of it that is left makes the focal length wrong."""
    scene = Scene(Board(7, 3, 30.0, Circles(True, 0.7)), rvec=(0.6, 0.3, 0.2), distance=310.0)
    corners = find_corners(scene.image(noise=1.0), (7, 3), pattern=Circles(True))
    assert corners.complete and corners.cov is not None
    error = scene.error(corners)
    assert np.sqrt(np.mean(error**2)) < 0.004
    chi2 = np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error) / 2
    assert 0.5 < np.mean(chi2) < 1.6


@pytest.mark.parametrize(
    ("pattern", "grid_size"), [(Circles(False, 0.5), (7, 9)), (Circles(True, 0.6), (11, 4))]
)
def test_centres_are_right_near_a_wide_angle_lens(
    pattern: Circles, grid_size: tuple[int, int]
) -> None:
    scene = Scene(Board(*grid_size, 16.0, pattern), WIDE, rvec=(0.15, 0.1, 0.1), distance=85.0)
    corners = find_corners(scene.image(noise=1.0), grid_size, pattern=Circles(pattern.asymmetric))
    assert corners.complete and corners.cov is not None
    error = scene.error(corners)
    assert np.abs(error).max() < 0.02
    chi2 = np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error) / 2
    assert np.mean(chi2) < 1.4


def test_covariances_are_honest() -> None:
    pattern = Circles(False, 0.5)
    scene = Scene(Board(7, 9, 16.0, pattern))
    chi2 = []
    for seed in range(3):
        corners = find_corners(scene.image(noise=5.0, seed=seed), (7, 9), pattern=pattern)
        assert corners.cov is not None
        error = scene.error(corners)
        chi2.append(np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error).mean() / 2)
    assert 0.8 < np.mean(chi2) < 1.25


@pytest.mark.parametrize(
    ("pattern", "grid_size", "aside"),
    [(Circles(True, 0.8), (11, 4), (0.0, -40.0)), (Circles(False, 0.5), (7, 9), (-90.0, -70.0))],
)
def test_circles_that_the_border_cuts_do_not_move_the_others(
    pattern: Circles, grid_size: GridSize, aside: tuple[float, float]
) -> None:
    scene = Scene(Board(*grid_size, 16.0, pattern), rvec=(0.5, 0.3, 0.4), aside=aside)
    corners = find_corners(scene.image(), grid_size, pattern=Circles(pattern.asymmetric))
    assert 0 < len(corners.rejected) < 5
    assert corners.cov is not None
    error = scene.error(corners)
    chi2 = np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error) / 2
    assert np.mean(chi2) < 1.4
    assert chi2.max() < 12


def test_discs_whose_blur_ran_away_do_not_tilt_the_light() -> None:
    """Tilt blurs one side of the grid more than its discs are large."""
    u, v = np.meshgrid(np.arange(7) * 40.0, np.arange(5) * 40.0)
    unknowns = np.zeros((35, 8))
    unknowns[:, 0], unknowns[:, 1], unknowns[:, 7] = u.ravel(), v.ravel(), -90.0
    unknowns[:, [2, 4]], unknowns[:, 5] = 1 / 5.0**2, 2.0
    unknowns[:, 6] = 120.0 + 0.05 * unknowns[:, 0]
    lost = unknowns[:, 0] > 180.0
    unknowns[lost, 5], unknowns[lost, 6] = 9.0, 40.0
    steps = np.tile(40.0 * np.eye(2), (35, 1, 1))
    beside = ellipse_fit._find_neighbours(unknowns[:, :2], steps, np.eye(2))
    gradient = ellipse_fit._estimate_gradient(unknowns[:, 6], unknowns, beside)
    np.testing.assert_allclose(gradient[~lost], np.tile([0.05, 0.0], (25, 1)), atol=1e-6)


@pytest.mark.parametrize("asymmetric", [False, True])
@pytest.mark.parametrize("light", ["shadow", "lamp"])
def test_light_that_no_quadratic_describes_draws_no_circles_aside(
    light: str, asymmetric: bool
) -> None:
    """Only circles that the edge of the shadow crosses are off, and say so."""
    pattern, grid_size = (
        (Circles(True, 0.7), (9, 4)) if asymmetric else (Circles(False, 0.45), (6, 8))
    )
    scene = Scene(Board(*grid_size, 24.0, pattern), _SMALL, (0.3, 0.2, 0.1), distance=500.0)
    image = scene.image(noise=1.0)
    v, u = np.indices(image.shape)
    middle = np.array(image.shape[::-1]) / 2
    across = u - middle[0] + 0.4 * (v - middle[1])
    lit = 1 / (1 + (np.hypot(u - middle[0] + 60, v - middle[1]) / 90) ** 2)
    if light == "shadow":
        lit = 0.5 + 0.5 / (1 + np.exp(-np.clip(across, -50, 50)))
    corners = find_corners(np.rint(image * lit).astype(np.uint8), grid_size, pattern=pattern)
    assert len(corners) >= 0.75 * grid_size[0] * grid_size[1] and corners.cov is not None
    error = scene.error(corners)
    off = np.linalg.norm(error, axis=1)
    assert np.median(off) < 0.038  # 0.040 to 0.106 with a quadratic
    square = np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error)
    assert not ((off > 0.3) & (square > 25)).any()


@pytest.mark.parametrize("blur", [1.2, 1.7, 2.5])
@pytest.mark.parametrize(
    ("pattern", "grid_size", "distance"),
    [(Circles(True, 0.45), (7, 4), 330.0), (Circles(False, 0.35), (5, 7), 250.0)],
)
def test_circles_smaller_than_their_blur_are_refused_rather_than_misplaced(
    pattern: Circles, grid_size: GridSize, distance: float, blur: float
) -> None:
    camera = Camera((480, 360), [430.0, 431.0, 240.0, 180.0, 0.1, 0.02, 0.0, 1e-4, 0.0, 0.0])
    scene = Scene(Board(*grid_size, 16.0, pattern), camera, (0.8, 0.1, 0.2), distance)
    image = scene.image(blur=blur)
    if blur > 1.5:
        with pytest.raises(NoBoardError, match="too small for how blurred"):
            find_corners(image, grid_size, pattern=Circles(pattern.asymmetric))
        return
    corners = find_corners(image, grid_size, pattern=Circles(pattern.asymmetric))
    assert corners.complete
    assert np.abs(scene.error(corners)).max() < 0.03


@pytest.mark.parametrize(
    ("grid_size", "turn"), [((7, 4), 0.0), ((7, 4), 1.7), ((7, 4), 3.1), ((3, 6), 3.1)]
)
def test_an_unique_origin_is_found(grid_size: GridSize, turn: float) -> None:
    """A shift of the middle one of three rows is no bend of the lens."""
    pattern = Circles(True, 0.8)
    scene = Scene(Board(*grid_size, 20.0, pattern), rvec=(0.2, 0.1, turn), distance=600.0)
    corners = find_corners(scene.image(), grid_size, pattern=pattern)
    assert corners.ambiguity is Symmetry.NONE
    assert np.abs(scene.error(corners)).max() < 0.03


@pytest.mark.parametrize(
    ("pattern", "grid_size", "ambiguity"),
    [
        (Circles(), (5, 7), Symmetry.HALF_TURN),
        (Circles(), (5, 5), Symmetry.QUARTER_TURN),
        (Circles(True), (11, 4), Symmetry.NONE),
        (Circles(True), (6, 4), Symmetry.HALF_TURN),
    ],
)
def test_turns_that_cannot_be_told(
    pattern: Circles, grid_size: tuple[int, int], ambiguity: Symmetry
) -> None:
    assert pattern.symmetry(grid_size) is ambiguity
    grid = np.indices(grid_size).reshape(2, -1).T.astype(float)
    places = pattern.locate_points(grid)
    turned = places.max(axis=0) - places
    same = {tuple(p) for p in turned.tolist()} == {tuple(p) for p in places.tolist()}
    assert same == (ambiguity is not Symmetry.NONE)


def test_ambiguous_grid_is_upright_or_starts_where_marked() -> None:
    pattern = Circles(False, 0.5)
    scene = Scene(Board(5, 7, 20.0, pattern), rvec=(0.2, 0.1, 3.0))
    image = scene.image()
    upright = find_corners(image, (5, 7), pattern=pattern)
    assert upright.ambiguity is Symmetry.HALF_TURN
    by_place = {tuple(g): uv for g, uv in zip(upright.grid.tolist(), upright.uv, strict=True)}
    assert by_place[0, 6][0] > by_place[0, 0][0]
    truth = scene.error(upright) * 0 + upright.uv - scene.error(upright)  # where truth has them
    marked = truth[[0, 6, 34, 28]]
    marked = marked.mean(axis=0) + 1.1 * (marked - marked.mean(axis=0))
    corners = find_corners(image, (5, 7), marked, pattern=pattern)
    assert np.abs(scene.error(corners)).max() < 0.03


def test_dark_paper_and_16_bits() -> None:
    pattern = Circles(False, 0.5)
    image = Scene(Board(5, 7, 20.0, pattern)).image()
    dark = find_corners(255 - image, (5, 7), pattern=pattern)
    deep = find_corners(image.astype(np.uint16) * 200, (5, 7), pattern=pattern)
    np.testing.assert_allclose(dark.uv, deep.uv, atol=1e-3)


@pytest.mark.parametrize("pattern", [Circles(), Circles(asymmetric=True)])
def test_nothing_else_is_a_grid(pattern: Circles) -> None:
    rng = np.random.default_rng(0)
    squares = Scene(Board(6, 8, 20.0)).image()
    noise = rng.integers(0, 255, (300, 400)).astype(np.uint8)
    for image in (noise, squares, np.zeros((200, 200), np.uint8)):
        with pytest.raises(NoBoardError):
            find_corners(image, (6, 4), pattern=pattern)


def test_square_spots_are_not_circles() -> None:
    image = np.full((480, 640), 220, np.uint8)
    for i in range(5):
        for j in range(7):
            image[60 + 70 * i : 90 + 70 * i, 80 + 70 * j : 110 + 70 * j] = 30
    with pytest.raises(NoBoardError):
        find_corners(image, (5, 7), pattern=Circles())


def test_a_sample_of_many_spots_tells_that_they_are_no_circles(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    counts = []
    fit = ellipse_fit.fit_ellipses

    def count(image: GreyImage, uv: Array, *rest: Any) -> EllipseFit:
        counts.append(len(uv))
        return fit(image, uv, *rest)

    monkeypatch.setattr(ellipse_fit, "fit_ellipses", count)
    with pytest.raises(NoBoardError, match="ellipses do not describe"):
        find_corners(draw_without_board(3), pattern=Circles(asymmetric=True))
    assert counts == [40]
    counts.clear()
    scene = Scene(Board(9, 12, 20.0, Circles(False, 0.5)), distance=500.0)
    assert find_corners(scene.image(), pattern=Circles()).complete
    assert counts == [40, 108]


def test_fits_end_where_there_are_no_discs(monkeypatch: pytest.MonkeyPatch) -> None:
    """In 12 megapixels they take three times as long as to find a grid."""
    image = np.tile(draw_without_board(3)[:60, :60], (8, 10))
    v, u = np.indices((7, 9)).reshape(2, -1)
    uv = np.column_stack([60.0 + 60 * u, 60.0 + 50 * v])
    steps = np.tile(np.diag([60.0, 50.0]), (len(uv), 1, 1))
    paper = np.array([(0.5, 0.5), (-0.5, 0.5), (0.5, -0.5), (-0.5, -0.5)])
    taken = []
    take_step = ellipse_fit._take_step
    monkeypatch.setattr(
        ellipse_fit, "_take_step", lambda *a: taken.append(len(a[1])) or take_step(*a)
    )
    fit = ellipse_fit.fit_ellipses(image, uv, steps, 0.5, paper, np.eye(2))
    assert taken == [63] * 3
    assert np.median(fit.misfit) > 0.3


@pytest.mark.parametrize("are_bright", [False, True])
@pytest.mark.parametrize(
    ("pattern", "grid_size"), [(Circles(False, 0.5), (6, 8)), (Circles(True, 0.7), (9, 4))]
)
def test_faint_circles_are_found(pattern: Circles, grid_size: GridSize, are_bright: bool) -> None:
    """A few grey levels of contrast, beside something bright, as in the infrared."""
    scene = Scene(Board(*grid_size, 24.0, pattern), _SMALL, (0.3, 0.2, 0.1), distance=450.0)
    ink = scene.image(noise=0.0).astype(np.float64)
    ink = 1 - (ink - ink.min()) / np.ptp(ink)
    v, u = np.indices(ink.shape)
    levels = 60 + 8 * (ink if are_bright else -ink) + 0.005 * u + 80.0 * (np.hypot(u, v) < 50)
    noisy = levels + np.random.default_rng(0).normal(0, 1.0, ink.shape)
    image = np.clip(np.rint(noisy), 0, 255).astype(np.uint8)
    for size in (grid_size, None):
        corners = find_corners(image, size, pattern=Circles(pattern.asymmetric))
        assert corners.complete and corners.shape == grid_size and corners.cov is not None
        error = scene.error(corners)
        chi2 = np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error) / 2
        assert np.abs(error).max() < 0.4 and 0.6 < np.mean(chi2) < 1.6


def test_what_is_wrongly_stated_is_told() -> None:
    image = Scene(Board(5, 7, 20.0, Circles(False, 0.5))).image()
    with pytest.raises(NoBoardError, match=r"measure 0\.50 of their distance, not 0\.70"):
        find_corners(image, (5, 7), pattern=Circles(False, 0.7))
    for grid_size in ((6, 7), (4, 7), (5, 5)):
        with pytest.raises(NoBoardError, match=r"No grid of . x . circles was found, but one of 5"):
            find_corners(image, grid_size, pattern=Circles())
    with pytest.raises(CalibrationError, match="touch"):
        Circles(False, 1.2)


@pytest.mark.parametrize(
    ("asymmetric", "grid_size"), [(False, (5, 7)), (True, (7, 4)), (True, (6, 5))]
)
def test_the_number_of_circles_may_be_left_out(
    asymmetric: bool, grid_size: tuple[int, int]
) -> None:
    pattern = Circles(asymmetric, 0.6)
    image = Scene(Board(*grid_size, 20.0, pattern), rvec=(0.3, 0.4, 0.2)).image()
    stated, counted = (
        find_corners(image, grid_size, pattern=pattern),
        find_corners(image, None, pattern=pattern),
    )
    assert counted.shape == grid_size
    np.testing.assert_array_equal(counted.uv, stated.uv)


def test_images_together_tell_the_diameter() -> None:
    seen = [Circles(False, d) for d in (0.49, 0.5, 0.53)]
    assert Circles().complete_from(seen) == Circles(False, 0.5)
    assert Circles(False, 0.6).complete_from(seen) == Circles(False, 0.6)


_SMALL = Camera((640, 480), [560.0, 562.0, 322.0, 238.0, 0.1, 0.02, 0.0, 1e-4, 0.0, 0.0])


def _show_marked(
    marks: set[tuple[int, int]], turn: float, *, mark: float = 0.8, grid_size: GridSize = (7, 7)
) -> Scene:
    pattern = MarkedCircles(False, 0.45, frozenset(marks), mark)
    return Scene(Board(*grid_size, 26.0, pattern), _SMALL, (0.3, -0.2, turn), 400.0)


@pytest.mark.parametrize(("turn", "mark"), [(0.1, 0.6), (1.7, 0.25), (3.3, 0.95)])
def test_a_circle_of_another_size_marks_the_origin(turn: float, mark: float) -> None:
    scene = _show_marked({(0, 0)}, turn, mark=mark)
    corners = find_corners(scene.image(), pattern=Circles())
    assert corners.complete
    assert corners.ambiguity is Symmetry.NONE
    assert np.abs(scene.error(corners)).max() < 0.05
    assert isinstance(corners.pattern, Circles)
    assert corners.pattern.diameter == pytest.approx(0.45, abs=0.01)


def test_marks_that_a_turn_leaves_in_place_leave_it_open() -> None:
    image = _show_marked({(0, 0), (6, 6)}, 0.1).image()
    corners = find_corners(image, (7, 7), pattern=Circles())
    assert corners.complete
    assert corners.ambiguity is Symmetry.HALF_TURN


def test_marks_number_all_pictures_alike() -> None:
    """Wherever the marks stand, as in the middle of some robots' boards."""
    marks = {(3, 3), (3, 4), (3, 5), (4, 3)}
    offsets = []
    for turn in (0.1, 1.7, 3.3):
        scene = _show_marked(marks, turn)
        corners = find_corners(scene.image(), (7, 7), pattern=Circles())
        assert corners.ambiguity is Symmetry.NONE
        truth = corners.uv - scene.error(corners)
        nearest = np.linalg.norm(corners.uv[:, None] - truth, axis=2).argmin(axis=1)
        offsets.append(nearest)
    assert np.array_equal(offsets[0], offsets[1]) and np.array_equal(offsets[0], offsets[2])


def test_a_hidden_circle_might_be_a_mark() -> None:
    scene = _show_marked({(0, 0), (0, 3)}, 0.1)
    image = scene.image()
    whole = find_corners(image, (7, 7), pattern=Circles())
    assert whole.ambiguity is Symmetry.NONE
    u, v = np.rint(whole.uv[20]).astype(int)
    image[v - 9 : v + 10, u - 9 : u + 1] = 200  # paper over half of it
    corners = find_corners(image, (7, 7), pattern=Circles())
    assert len(corners.rejected) == 1
    assert corners.ambiguity is Symmetry.QUARTER_TURN


def test_slender_spots_are_no_circles() -> None:
    """Their ellipses are askew and hard to fit, and must not turn into hyperbolas on the way."""
    rng = np.random.default_rng(3)
    v, u = np.indices((260, 360))
    image = np.full(u.shape, 220.0)
    for row, col in np.ndindex(7, 10):
        x, y = u - 40 - 30 * col - rng.normal(0, 0.3), v - 40 - 30 * row
        along, across = (x + y) / np.sqrt(2), (x - y) / np.sqrt(2)
        rho = np.hypot(along / (13 * rng.uniform(0.8, 1.2)), across / (2 * rng.uniform(0.8, 1.2)))
        image -= 190 * np.clip(3 * (1 - rho) + 0.5, 0, 1)
    noisy = image + rng.normal(0, 10, image.shape)
    with pytest.raises(NoBoardError, match="is not trusted"):
        find_corners(noisy.clip(0, 255).astype(np.uint8), (7, 10), pattern=Circles())


def test_small_circles_are_found_in_a_large_picture() -> None:
    scene = Scene(Board(7, 10, 20.0, Circles(False, 0.5)), distance=1200.0)
    image = np.pad(scene.image(), ((900, 900), (1200, 1200)), mode="edge")
    corners = find_corners(image, pattern=Circles())
    assert corners.complete
    assert np.abs(scene.error(corners) - [1200, 900]).max() < 0.2


def _show_near_fisheye(lens: Array, board: Board, rvec: Array, distance: float) -> Scene:
    """Return a scene of which a part of the board lies outside of the image."""
    camera = Camera((640, 480), [lens[0], lens[0], 322.0, 238.0, *lens[1:], 0.0, 0.0, 0.0, 0.0])
    return Scene(board, camera, (rvec[0], rvec[1], rvec[2]), distance)


def test_marks_and_a_cut_corner_leave_the_rest_of_a_grid_under_a_fisheye() -> None:
    marks = frozenset({(3, 3), (3, 4), (3, 5), (4, 3)})
    board = Board(6, 7, 26.0, MarkedCircles(False, 0.45, marks, 0.65))
    rvec = np.array([-0.126, 0.1975, 0.9717])
    scene = _show_near_fisheye(np.array([389.0, 0.287, 0.0775]), board, rvec, 130.5)
    corners = find_corners(scene.image(), pattern=Circles())
    assert corners.shape == (6, 7) and len(corners) == 38 and not corners.relative
    missing = set(np.ndindex(6, 7)) - set(map(tuple, corners.grid.tolist()))
    assert missing == {(0, 0), (4, 6), (5, 5), (5, 6)}


def test_a_part_of_a_grid_under_a_fisheye_is_no_whole() -> None:
    """Two circles of its last column are seen, and the image's border cuts both."""
    marks = frozenset({(4, 4), (3, 4), (3, 5), (3, 6)})
    board = Board(7, 9, 26.0, MarkedCircles(False, 0.45, marks, 0.95))
    rvec = np.array([-0.579, -0.2457, -1.989])
    scene = _show_near_fisheye(np.array([260.7, 0.327, 0.0173]), board, rvec, 95.5)
    image = scene.image()
    corners = find_corners(image, pattern=Circles())
    assert corners.relative and corners.remark
    placed = find_corners(image, (7, 9), pattern=Circles())
    assert len(placed) == 52 and not placed.relative
    turned = replace(placed, grid=[6, 8] - placed.grid)
    assert min(np.abs(scene.error(each)).max() for each in (placed, turned)) < 0.2


@pytest.mark.parametrize(
    ("pattern", "grid_size"), [(Circles(False, 0.45), (4, 7)), (Circles(True, 0.7), (7, 4))]
)
@pytest.mark.parametrize(
    "covered", [{(2, 2)}, {(0, 1)}, {(0, 0), (3, 3)}], ids=["inside", "at the border", "corners"]
)
def test_circles_beside_covered_ones_keep_their_numbers(
    pattern: Circles, grid_size: GridSize, covered: set[tuple[int, int]]
) -> None:
    scene = Scene(Board(*grid_size, 26.0, pattern), _SMALL, (0.3, 0.2, 0.1), distance=500.0)
    image = scene.image()
    whole = find_corners(image, grid_size, pattern=pattern).uv.reshape(*grid_size, 2)
    for place in covered:
        u, v = np.rint(whole[place]).astype(int)
        image[v - 12 : v + 13, u - 9 : u + 15] = 150  # a finger
    for size in (grid_size, None):
        corners = find_corners(image, size, pattern=Circles(pattern.asymmetric))
        assert corners.shape == grid_size and not corners.relative
        assert set(map(tuple, corners.grid.tolist())) == set(np.ndindex(grid_size)) - covered
        assert np.abs(scene.error(corners)).max() < 0.05


@pytest.mark.parametrize(
    ("pattern", "grid_size"), [(Circles(False, 0.45), (6, 8)), (Circles(True, 0.7), (9, 4))]
)
def test_a_dot_of_paint_over_a_circle_is_not_taken_for_it(
    pattern: Circles, grid_size: GridSize
) -> None:
    """Its edge is as good as the circle's, and its size may be that of a mark."""
    scene = Scene(Board(*grid_size, 24.0, pattern), _SMALL, (0.3, 0.2, 0.1), distance=500.0)
    image = scene.image()
    whole = find_corners(image, grid_size, pattern=pattern)
    place = np.array((2, 1))
    u, v = whole.uv[(whole.grid == place).all(axis=1)][0] + [2.2, -1.5]
    rows, cols = np.indices(image.shape)
    share = np.clip(10.5 - np.hypot(cols - u, rows - v), 0, 1)
    painted = np.rint(image * (1 - share) + 90 * share).astype(np.uint8)
    corners = find_corners(painted, grid_size, pattern=Circles(pattern.asymmetric))
    assert not (corners.grid == place).all(axis=1).any()
    assert len(corners) == len(whole) - 1
    assert corners.cov is not None and np.sqrt(corners.cov[:, 0, 0].max()) < 0.02
    assert np.abs(scene.error(corners)).max() < 0.05


def test_a_circle_drawn_aside_says_so_and_no_other_does() -> None:
    xy = np.indices((6, 8)).reshape(2, -1).T.astype(np.float64)
    uv = 40 * xy + 0.01 * np.random.default_rng(2).standard_normal(xy.shape)
    uv[20] += [0.3, -0.3]
    covariance = np.tile(1e-4 * np.eye(2), (48, 1, 1))
    sigma = np.sqrt(measurement._widen_covariances(xy, uv, covariance)[:, 0, 0])
    assert 0.2 < sigma[20] < 0.6
    assert np.delete(sigma, 20).max() < 0.015


def test_a_covered_circle_might_be_the_mark() -> None:
    scene = _show_marked({(0, 0)}, 0.1)
    image = scene.image()
    whole = find_corners(image, (7, 7), pattern=Circles())
    assert whole.ambiguity is Symmetry.NONE
    u, v = np.rint(whole.uv[0]).astype(int)
    image[v - 20 : v + 21, u - 17 : u + 24] = 150
    corners = find_corners(image, pattern=Circles())
    assert len(corners) == 48
    assert corners.ambiguity is Symmetry.QUARTER_TURN


def test_it_is_said_that_a_grid_may_go_on_outside_of_the_picture() -> None:
    pattern = Circles(False, 0.45)
    whole = Scene(Board(5, 9, 20.0, pattern), _SMALL, distance=400.0)
    assert not find_corners(whole.image(), pattern=pattern).remark
    image = whole.image()
    cut = image[:, : int(find_corners(image, (5, 9), pattern=pattern).uv[:, 0].max()) - 30]
    corners = find_corners(np.ascontiguousarray(cut), pattern=pattern)
    assert corners.shape == (5, 8) and corners.relative
    assert "ends before the next row or column" in corners.remark
    for size, roi in (((5, 8), None), (None, corners.roi)):
        told = find_corners(np.ascontiguousarray(cut), size, roi, pattern=pattern)
        assert not told.remark and not told.relative


@pytest.mark.parametrize("pattern", [Circles(False, 0.45), Circles(True, 0.7)])
def test_whole_grids_are_told_from_parts_on_each_side(pattern: Circles) -> None:
    image = Scene(Board(7, 6, 26.0, pattern), _SMALL, distance=500.0).image()
    centres = find_corners(image, (7, 6), pattern=pattern).uv.reshape(7, 6, 2)
    whole = find_continuation(centres, image, asymmetric=pattern.asymmetric)
    assert not (whole.is_seen or whole.is_open or whole.has_discs or whole.is_shaded)
    assert all(whole.ends) and not any(whole.leaves)
    for part in (centres[2:], centres[:-2], centres[:, 1:], centres[:, :-1]):
        seen = find_continuation(part, image, asymmetric=pattern.asymmetric)
        assert np.count_nonzero(seen.goes_on) == 1 and np.count_nonzero(seen.ends) == 3
        assert seen.has_discs and not (seen.is_open or seen.is_shaded or any(seen.leaves))


def _photograph_screen(scene: Scene, seed: int, depth: float) -> GreyImage:
    """Photograph circles on a screen whose pixels, seen as lines between them that are darker by
    `depth`, beat with the camera's."""
    rng = np.random.default_rng([seed, 77])
    image = scene.image(noise=0.0).astype(np.float64)
    v, u = np.indices(image.shape)
    beat, lines = np.zeros(image.shape), np.ones(image.shape)
    turn, pitch = rng.uniform(0, np.pi), rng.uniform(2.2, 7.0)
    for angle in (turn, turn + np.pi / 2):
        along = np.cos(angle) * u + np.sin(angle) * v
        beat += np.sin(2 * np.pi * along / rng.uniform(8, 24) + rng.uniform(0, 6))
        off = abs(along / pitch - np.rint(along / pitch))
        lines *= 1 - depth * np.clip(1.5 - 6 * off, 0, 1)
    image = image * (1 + 0.1 * beat) * lines + rng.normal(0, 2, image.shape)
    return np.clip(np.rint(image), 0, 255).astype(np.uint8)


def test_covariances_on_a_screen_are_honest() -> None:
    """Beats draw each circle aside, by several times as much as noise."""
    square = []
    for seed in range(4):
        scene = Scene(Board(7, 9, 20.0, Circles(False, 0.5)), distance=360.0)
        corners = find_corners(_photograph_screen(scene, seed, 0.0), (7, 9), pattern=Circles())
        error = scene.error(corners)
        square.append(np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error) / 2)
    assert 0.6 < np.mean(square) < 1.6


def test_the_pixels_of_a_screen_do_not_hide_the_grid() -> None:
    """They tear the circles apart in an image that is not smoothed; whether what is found there can
    be measured is said by the test that refuses it, and by the covariances."""
    square, reasons = [], []
    for seed in range(6):
        scene = Scene(Board(7, 9, 20.0, Circles(False, 0.5)), distance=360.0)
        image = _photograph_screen(scene, seed, 0.25)
        try:
            corners = find_corners(image, (7, 9), pattern=Circles())
        except NoBoardError as refused:
            reasons.append(str(refused))
            continue
        assert corners.complete and corners.cov is not None
        error = scene.error(corners)
        square.append(np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error) / 2)
    assert all("ellipses do not describe the edges" in reason for reason in reasons)
    assert len(square) >= 2 and np.mean(square) < 1.4


def test_specks_between_the_pixels_of_a_screen_do_not_hide_the_grid() -> None:
    """They are more than the circles, and of a size with them, in all copies but the coarsest."""
    scene = Scene(Board(11, 4, 20.0, Circles(True, 0.8)), rvec=(-0.3, 0.25, 0.6), distance=360.0)
    corners = find_corners(_photograph_screen(scene, 3, 0.15), (11, 4), pattern=Circles(True))
    assert corners.complete
    assert np.abs(scene.error(corners)).max() < 0.3


def test_a_circle_that_no_search_has_found_is_seen_in_its_gap() -> None:
    image = Scene(Board(7, 6, 26.0, Circles(False, 0.45)), _SMALL, distance=500.0).image()
    centres = find_corners(image, (7, 6), pattern=Circles()).uv.reshape(7, 6, 2)
    known = centres.copy()
    known[3, 2] = known[6, 5] = np.nan
    assert np.abs(find_continuation(known, image, asymmetric=False).centres - centres).max() < 1.0
    u, v = np.rint(centres[3, 2]).astype(int)
    image[v - 25 : v + 26, u - 25 : u + 26] = 120
    seen = find_continuation(known, image, asymmetric=False).centres
    assert np.isnan(seen[3, 2]).all() and np.isfinite(seen[6, 5]).all()


def test_spots_beside_a_grid_do_not_turn_it() -> None:
    """With 3 more in the next row, 13 x 3 circles are 6 x 7 but for a few that are covered."""
    scene = Scene(Board(13, 3, 20.0, Circles(True, 0.8)), rvec=(0.1, 0.1, 0.0), distance=400.0)
    image = scene.image()
    v, u = np.indices(image.shape)
    paper, faint = [(0, 0), (1, 2)], [(13, 0), (13, 1), (13, 2)]
    for places, level, radius in ((paper, image.max() - 10, 16), (faint, image.max() - 50, 8)):
        at = scene.board.points(np.array(places))
        for centre in project_points(at, scene.camera, scene.pose):
            image[np.hypot(u - centre[0], v - centre[1]) < radius] = level
    assert find_corners(image, pattern=Circles(asymmetric=True)).shape == (13, 3)


def _photograph_part(
    cols: int, rows: int = 6, *, asymmetric: bool = False
) -> tuple[Scene, GreyImage]:
    """Photograph the first columns and the last rows of 6 x 8 circles, or 6 x 4 asymmetric ones of
    which `cols` counts those of every second row.

    Returns:
        The scene, and the image, which is cut at the right and, if `rows` < 6, on top.
    """
    pattern = Circles(asymmetric, 0.8 if asymmetric else 0.45)
    board = Board(6, 4 if asymmetric else 8, 26.0, pattern)
    scene = Scene(board, _SMALL, (0.1, 0.1, 0.0), 500.0)
    ends = np.array([(cols - 0.5, 2.5), (3.5, 5.5 - rows)]) * board.square
    right, top = np.diag(project_points(ends, scene.camera, scene.pose))
    image = scene.image()[max(int(top), 0) if rows < 6 else 0 :, : int(right) if cols < 8 else None]
    return scene, np.ascontiguousarray(image)


def _place_on_lattice(scene: Scene, image: GreyImage, corners: Corners) -> Array:
    """Return the places (n, 2) on the board, pitches, at which the circles found truly are."""
    full = scene.image()
    top = full.shape[0] - image.shape[0]
    uv = project_points(scene.board.points(), scene.camera, scene.pose) - [0, top]
    distance = np.linalg.norm(corners.uv[:, None] - uv, axis=2)
    assert distance.min(axis=1).max() < 0.1
    return np.asarray(scene.board.points()[distance.argmin(axis=1), :2] / scene.board.square)


@pytest.mark.parametrize(
    ("cols", "rows", "asymmetric"),
    [(5, 6, False), (8, 4, False), (7, 5, False), (5, 6, True), (6, 6, True), (5, 5, True)],
)
def test_a_part_of_a_grid_of_stated_size_is_placed(cols: int, rows: int, asymmetric: bool) -> None:
    scene, image = _photograph_part(cols, rows, asymmetric=asymmetric)
    corners = find_corners(image, scene.board.grid_size, pattern=Circles(asymmetric))
    assert len(corners) >= cols * rows / (2 if asymmetric else 1) - 2 and not corners.relative
    true = _place_on_lattice(scene, image, corners)
    seen = scene.board.pattern.locate_points(corners.grid.astype(float))
    turned = scene.board.points().max(axis=0)[:2] / scene.board.square - seen
    assert any(np.abs(each - true).max() < 1e-6 for each in (seen, turned))


def test_a_part_that_may_have_several_places_says_so() -> None:
    """Of 5 x 5 circles in a corner the rows may be the columns."""
    scene, image = _photograph_part(5, 5)
    _check_relative(scene, image, find_corners(image, (6, 8), pattern=Circles()))


def _check_relative(scene: Scene, image: GreyImage, corners: Corners) -> None:
    """Check that a part is said to have several places, and is in one of them."""
    assert corners.relative and "which of the board's rows and columns" in corners.remark
    true = _place_on_lattice(scene, image, corners)
    seen = scene.board.pattern.locate_points(corners.grid.astype(float))
    moves = [
        true - seen @ np.array([(c, -s), (s, c)]) for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1))
    ]
    assert min(np.ptp(move, axis=0).max() for move in moves) < 1e-6


def test_what_is_covered_is_no_end_of_a_part() -> None:
    """The image cuts two columns, and a hand covers the first."""
    scene, image = _photograph_part(6)
    first = scene.board.points()[::8]
    for u, v in np.rint(project_points(first, scene.camera, scene.pose)).astype(int):
        image[max(v - 30, 0) : v + 31, max(u - 20, 0) : u + 16] = 90
    _check_relative(scene, image, find_corners(image, (6, 8), pattern=Circles()))


def test_a_line_that_the_image_should_show_is_not_put_down_to_a_cover() -> None:
    """On this side white paper lies over it, and on the other the board ends in the dark."""
    scene = Scene(Board(6, 8, 26.0, Circles(False, 0.45)), _SMALL, (0.1, 0.1, 0.0), 500.0)
    image = scene.image()
    uv = project_points(scene.board.points(), scene.camera, scene.pose).reshape(6, 8, 2)
    light = np.median(image[uv[2, 3, 1].astype(int) - 20])
    image[:, : int(uv[:, 0, 0].max()) + 12] = light
    image[:, int(uv[:, -1, 0].max()) + 18 :] = 40
    with pytest.raises(NoBoardError, match="but one of 6 x 7"):
        find_corners(image, (6, 8), pattern=Circles())


def test_a_bright_ground_beside_a_dark_board_is_no_further_line() -> None:
    """The image ends before it shows what lies beyond the places of the next circles."""
    scene = Scene(Board(6, 8, 26.0, Circles(False, 0.45)), _SMALL, (0.1, 0.1, 0.0), 500.0)
    image = 255 - scene.image()
    uv = project_points(scene.board.points(), scene.camera, scene.pose).reshape(6, 8, 2)
    step = uv[:, 1, 0] - uv[:, 0, 0]
    left = int((uv[:, 0, 0] - 0.7 * step).min())
    image[:, :left] = image.max()
    cut = np.ascontiguousarray(image[:, int((uv[:, 0, 0] - 1.2 * step).min()) :])
    assert find_corners(cut, (6, 8), pattern=Circles()).complete


def test_a_part_that_is_seen_to_go_on_is_no_part_of_a_grid() -> None:
    """Of more dots than a grid of that size has, those that the search takes fill a part of it."""
    with pytest.raises(NoBoardError):
        find_corners(draw_without_board(61071), (6, 9), pattern=Circles())

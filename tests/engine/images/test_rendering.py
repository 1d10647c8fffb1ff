"""The renderer against point sampling, symmetry and projected corners."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from scipy.special import erf

from calibgui.engine.arrays import Array
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.printed_pattern import average_unit_step
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.images.rendering import Appearance, compute_irradiance, render_view

Lattice = tuple[int, int]
"""Two Fibonacci numbers in succession but one, the number of points first."""

BOARD = Board(4, 5, 25.0)
STRONG = Camera((160, 120), [160.0, 166.0, 84.0, 57.0, 0.27, 0.2, -0.1, 2e-3, -3e-3, 0.5])
PLAIN = Appearance(black=0.0, white=200.0, background=100.0)
TILTED = Pose([0.5, -0.35, 0.2], [-45.0, -40.0, 190.0])


def colour(uv: Array, camera: Camera, pose: Pose, board: Board) -> Array:
    """What a point of the image sees under `PLAIN`, written from eq. 9 and geometry alone."""
    fx, fy, cx, cy, k1, k2, k3, p1, p2, p3 = camera.params
    x, y = (uv[..., 0] - cx) / fx, (uv[..., 1] - cy) / fy
    r2 = x**2 + y**2
    rho, q = k1 * r2 + k2 * r2**2 + k3 * r2**3, 1 + p3 * r2
    ray = np.stack(
        [
            x * (1 + rho) + q * (p1 * (r2 + 2 * x**2) + 2 * p2 * x * y),
            y * (1 + rho) + q * (2 * p1 * x * y + p2 * (r2 + 2 * y**2)),
            np.ones_like(x),
        ],
        axis=-1,
    )
    R = Rotation.from_rotvec(np.array(pose.rvec)).as_matrix()
    origin = -R.T @ pose.tvec
    direction = ray @ R
    board_shape = origin[:2] - direction[..., :2] / direction[..., 2:] * origin[2]
    column, row = np.floor(np.moveaxis(board_shape / board.square, -1, 0))
    on_sheet = (column >= -2) & (column < board.cols + 1) & (row >= -2) & (row < board.rows + 1)
    on_board = (column >= -1) & (column < board.cols) & (row >= -1) & (row < board.rows)
    black = on_board & ((column + row) % 2 == 0)
    return np.where(black, 0.0, np.where(on_sheet, 200.0, 100.0))


def point_sampled(uv: Array, camera: Camera, pose: Pose, board: Board, lattice: Lattice) -> Array:
    """Means (...) over the pixels at `uv` of `colour` on a Fibonacci lattice: even everywhere."""
    n, step = lattice
    i = np.arange(n)
    samples = np.stack([(i + 0.5) / n, (i * step % n + 0.5) / n], axis=1) - 0.5
    return sum((colour(uv + e, camera, pose, board) for e in samples), np.zeros(uv.shape[:-1])) / n


def test_agrees_with_point_sampling() -> None:
    uv = np.stack(np.meshgrid(*map(np.arange, STRONG.size)), axis=-1)
    brute = point_sampled(uv, STRONG, TILTED, BOARD, (987, 610))
    error = compute_irradiance(STRONG, TILTED, BOARD, appearance=PLAIN) - brute
    # What remains is the lattice's: four times the points halve it.
    assert np.abs(error).max() < 2.0
    assert np.sqrt(np.mean(error**2)) < 0.1


@pytest.mark.parametrize(
    "rvec",
    [[0.5, -0.35, 0.2], [0.0, 0.0, 0.0], [0.0, 0.0, np.pi / 4], [-0.9, 0.1, 0.03]],
    ids=["tilted", "frontal", "diamond", "steep"],
)
def test_corners_are_where_the_geometry_says(rvec: list[float]) -> None:
    """Shift of each corner that best explains the difference from point sampling.

    Rendering with the principal point moved gives the derivative by a shift of the image.
    """
    R = Rotation.from_rotvec(rvec).as_matrix()
    pose = Pose(rvec, np.array([3.3, -2.1, 230.0]) - R[:, :2] @ [50.0, 37.5])
    corners = np.rint(_corners(STRONG, pose, BOARD)).astype(int)
    windows = corners[:, None] + np.indices((9, 9)).reshape(2, -1).T - 4
    sampled = point_sampled(windows, STRONG, pose, BOARD, (4181, 2584))

    def levels(du: float = 0.0, dv: float = 0.0) -> Array:
        camera = Camera(STRONG.size, STRONG.params + np.array([0, 0, du, dv, 0, 0, 0, 0, 0, 0]))
        image = compute_irradiance(camera, pose, BOARD, appearance=PLAIN)
        return image[windows[..., 1], windows[..., 0]]

    error = levels() - sampled
    h = 0.05
    slopes = np.stack([levels(h) - levels(-h), levels(0, h) - levels(0, -h)], axis=-1) / (2 * h)
    shifts = np.stack([np.linalg.lstsq(J, e)[0] for J, e in zip(slopes, error, strict=True)])
    assert np.abs(shifts).max() < 0.001


def _corners(camera: Camera, pose: Pose, board: Board) -> Array:
    grid_size = np.c_[board.points(), np.zeros(board.rows * board.cols)]
    points = Rotation.from_rotvec(np.array(pose.rvec)).apply(grid_size) + pose.tvec
    return pixels_from_rays(points, camera)


def test_a_frontal_view_is_point_symmetric_about_a_corner() -> None:
    # An ideal camera looks square at the board along corner (1, 2), at the pixel array's centre.
    camera = Camera((121, 91), [500.0, 500.0, 60.0, 45.0, 0, 0, 0, 0, 0, 0])
    turn = Pose([0.0, 0.0, 0.3], Rotation.from_rotvec([0, 0, 0.3]).apply([-50.0, -25.0, 1000.0]))
    window = compute_irradiance(camera, turn, BOARD)[30:61, 45:76]
    np.testing.assert_allclose(window, window[::-1, ::-1], atol=1e-9)


def test_levels_sum_to_areas() -> None:
    # 4 px a mm: the paper of 8 x 7 squares covers (8 * 7) 10^2 px, half of its 6 x 5 squares black.
    camera = Camera((120, 110), [400.0, 400.0, 59.5, 54.5, 0, 0, 0, 0, 0, 0])
    board = Board(4, 5, 2.5)
    for angle in (0.0, 0.4):
        R = Rotation.from_rotvec([0, 0, angle]).as_matrix()
        pose = Pose([0.0, 0.0, angle], np.array([0.03, 0.01, 100.0]) - R[:, :2] @ [5.0, 3.75])
        levels = compute_irradiance(camera, pose, board, appearance=PLAIN)
        expected = 100.0 * (levels.size + 56 * 100) - 200.0 * 15 * 100
        assert levels.sum() == pytest.approx(expected, rel=1e-6)


def test_the_square_outside_the_first_corner_is_black() -> None:
    corners = _corners(STRONG, TILTED, BOARD).reshape(4, 5, 2)
    image = render_view(STRONG, TILTED, BOARD)
    outside = 1.5 * corners[0, 0] - 0.5 * corners[1, 1]
    beside = (corners[0, 0] + corners[1, 1]) / 2 + [corners[0, 1, 0] - corners[0, 0, 0], 0.0]
    assert image[*np.rint(outside[::-1]).astype(int)] == 30
    assert image[*np.rint(beside[::-1]).astype(int)] == 220


def test_blur_has_no_edge_effect_and_keeps_the_mean() -> None:
    blurred = compute_irradiance(STRONG, TILTED, BOARD, blur=1.5)
    bigger = Camera((180, 140), STRONG.params + np.array([0, 0, 10, 10, 0, 0, 0, 0, 0, 0]))
    around = compute_irradiance(bigger, TILTED, BOARD, blur=1.5)[10:130, 10:170]
    np.testing.assert_allclose(blurred, around, atol=1e-9)


@pytest.mark.parametrize(("blur", "within"), [(0.5, 2.0), (1.0, 0.5), (2.0, 0.2)])
@pytest.mark.parametrize("turn", [0.0, 0.04, 0.3])
def test_blur_is_gaussian_before_the_pixel_integrates_it(
    blur: float, within: float, turn: float
) -> None:
    camera = Camera((81, 61), [200.0, 200.0, 40.3, 30.2, 0, 0, 0, 0, 0, 0])
    # The edge of the column of corners that the axis meets, 40 px from any other.
    middle = Rotation.from_rotvec([0, 0, turn]).apply([-25.0, -37.5, 0.0])
    pose = Pose([0.0, 0.0, turn], middle + np.array([0.0, 0.0, 125.0]))
    levels = compute_irradiance(camera, pose, BOARD, blur=blur, appearance=PLAIN)
    nodes, weights = np.polynomial.legendre.leggauss(8)
    part = np.stack(np.meshgrid(nodes / 2, nodes / 2), axis=-1).reshape(-1, 2)
    uv = np.stack(np.meshgrid(np.arange(30, 51), np.arange(27, 34)), axis=-1)
    distance = (uv[..., None, :] + part - camera.params[2:4]) @ [np.cos(turn), np.sin(turn)]
    share = erf(distance / (np.sqrt(2) * blur)) @ np.outer(weights, weights).ravel() / 4
    rising = np.sign(levels[30, 50] - levels[30, 30])
    np.testing.assert_allclose(levels[27:34, 30:51], 100 + rising * 100 * share, atol=within)


def test_noise_is_repeatable_and_of_the_given_size() -> None:
    first, again = (render_view(STRONG, TILTED, BOARD, noise=2.0, seed=5) for _ in range(2))
    np.testing.assert_array_equal(first, again)
    assert np.any(first != render_view(STRONG, TILTED, BOARD, noise=2.0, seed=6))
    deviation = np.std(first - compute_irradiance(STRONG, TILTED, BOARD))
    assert deviation == pytest.approx(np.hypot(2.0, 12**-0.5), rel=0.02)


def test_light_and_gamma() -> None:
    look = Appearance(quiet_zone=100.0, shading=(0.2, -0.1), gamma=2.0)
    away = Pose(np.zeros(3), [60.0, 0.0, 100.0])  # only the white margin fills the view
    levels = compute_irradiance(
        Camera((101, 51), [300.0, 300, 50, 25, 0, 0, 0, 0, 0, 0]), away, BOARD, appearance=look
    )
    assert levels[25, 50] == pytest.approx(255 * (220 / 255) ** 0.5)
    assert levels[25, 100] == pytest.approx(255 * (220 * (1 + 0.2 * 50 / 101) / 255) ** 0.5)
    assert levels[50, 50] == pytest.approx(255 * (220 * (1 - 0.1 * 25 / 51) / 255) ** 0.5)


def test_nothing_is_seen_behind_the_camera() -> None:
    behind = Pose(np.zeros(3), [-50.0, -40.0, -190.0])
    assert np.all(render_view(STRONG, behind, BOARD) == 120)


@pytest.mark.parametrize("tvec", [[0.0, 0.0, 0.0], [10.0, 20.0, 0.0], [0.0, 0.0, np.nan]])
def test_a_board_through_the_camera_is_refused(tvec: list[float]) -> None:
    with pytest.raises(CalibrationError, match="edge-on"):
        render_view(STRONG, Pose(np.zeros(3), tvec), BOARD)


@given(st.floats(-3, 3), st.floats(0, 2), st.floats(0, 2))
def test_step_is_the_mean_over_the_pixel(X: float, A: float, B: float) -> None:
    e = (np.arange(2000) + 0.5) / 2000 - 0.5
    if max(A, B) < 1e-9:
        return
    # Mean along the longer width in closed form, along the other by the midpoint rule.
    inner = X + min(A, B) * e
    mean = np.mean(np.clip(inner / max(A, B) + 0.5, 0, 1))
    value = average_unit_step(np.array(X), np.array(A), np.array(B))
    assert float(value) == pytest.approx(float(mean), abs=1e-5)

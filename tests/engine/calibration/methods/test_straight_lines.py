"""Rows and columns as lines, and the fit of a correction to them, against SciPy."""

from __future__ import annotations

import numpy as np
import pytest
import scipy

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.calibration.methods import straight_lines
from calibgui.engine.calibration.methods.straight_lines import IDENTITY, LineFit, Lines
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.errors import CalibrationError
from tests.engine.scenes import BOARD, brown, scene

Q = np.array([0.05, -0.03, 0.11, 0.02, 1.1])
VIEWS = scene(brown(), 2, seed=4).noisy(0.3, np.random.default_rng(1))


def normalised(lines: Lines) -> Array:
    return (lines.uv - np.array([319.5, 239.5])) / 400.0


def test_every_row_and_column_of_a_view_is_a_line() -> None:
    lines = straight_lines.collect_lines(VIEWS)
    assert lines.mask.sum(axis=1).tolist() == [*[12] * 9, *[9] * 12] * 2
    first_row = VIEWS[0].uv[BOARD.points()[:, 1] == 0]
    np.testing.assert_array_equal(lines.uv[0], first_row)


def test_rows_of_fewer_than_four_points_are_left_out() -> None:
    xy = BOARD.points()
    keep = (xy[:, 1] > 0) | (xy[:, 0] < 3 * 30.0)  # three points of the first row
    lines = straight_lines.collect_lines([Observation(VIEWS[0].uv[keep], xy[keep])])
    assert sorted(lines.mask.sum(axis=1)) == [8] * 9 + [9] * 3 + [12] * 8


def test_measured_places_on_the_board_may_scatter() -> None:
    rng = np.random.default_rng(0)
    views = [Observation(uv, xy + rng.normal(0, 0.2, xy.shape)) for uv, xy, _ in VIEWS]
    expected = straight_lines.collect_lines(VIEWS)
    found = straight_lines.collect_lines(views)
    np.testing.assert_array_equal(found.mask, expected.mask)


def test_offset_rows_of_circles_are_lines_of_their_own() -> None:
    xy = Board(11, 4, 20.0, Circles(asymmetric=True)).points()
    lines = straight_lines.collect_lines([Observation(xy * [1.0, 1.1] + 50.0, xy)])
    rows = {tuple(np.unique(np.round(uv[:, 1], 6))) for uv in lines.uv[lines.mask.sum(axis=1) == 4]}
    assert len(rows) == 11
    assert all(len(row) == 1 for row in rows)


def test_a_board_without_four_corners_in_a_row_is_refused() -> None:
    x, y = np.meshgrid([0.0, 30.0, 60.0], [0.0, 30.0, 60.0])
    xy = np.column_stack([x.ravel(), y.ravel()])
    with pytest.raises(CalibrationError, match="No view shows 4 corners in a row"):
        straight_lines.collect_lines([Observation(xy + 100.0, xy)])


def test_the_derivative_of_the_correction() -> None:
    d = np.random.default_rng(0).uniform(-0.7, 0.7, (20, 2))
    _, A = straight_lines.correct_points(d, Q)
    for i, step in enumerate(1e-6 * np.eye(2)):
        ahead, behind = (straight_lines.correct_points(d + s, Q)[0] for s in (step, -step))
        np.testing.assert_allclose(A[..., i], (ahead - behind) / 2e-6, atol=1e-9)


def test_distances_are_those_in_the_measured_image() -> None:
    """The curve that becomes a line is traced point by point; points are set off from it."""
    phi, rho = 0.4, 0.35
    along = np.linspace(-0.5, 0.5, 2001)
    line = np.outer(along, [np.cos(phi), np.sin(phi)]) + rho * np.array([-np.sin(phi), np.cos(phi)])
    curve = np.array(
        [
            scipy.optimize.fsolve(
                lambda d, n=n: straight_lines.correct_points(d, Q)[0] - n, n, xtol=1e-13
            )
            for n in line
        ]
    )
    rng = np.random.default_rng(2)
    points = curve[rng.integers(200, 1800, 12)] + rng.normal(0, 1e-3, (12, 2))
    _, nearest = scipy.spatial.cKDTree(curve).query(points)
    tangent = curve[nearest + 1] - curve[nearest - 1]
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    off = points - curve[nearest]
    true = np.abs(tangent[:, 0] * off[:, 1] - tangent[:, 1] * off[:, 0])
    e = straight_lines.measure_distances(points[None], Q, np.array([[phi, rho]]))
    np.testing.assert_allclose(np.abs(e[0]), true, rtol=2e-3)


def test_the_nearest_line_is_the_first_singular_vector() -> None:
    lines = straight_lines.collect_lines(VIEWS)
    d = normalised(lines)
    found = straight_lines.fit_each_line(d, lines.mask, IDENTITY)
    for (phi, rho), points, mask in zip(found, d, lines.mask, strict=True):
        centred = points[mask > 0] - points[mask > 0].mean(axis=0)
        direction = np.linalg.svd(centred)[2][0]
        assert abs(direction @ [-np.sin(phi), np.cos(phi)]) < 1e-12
        distances = points[mask > 0] @ [-np.sin(phi), np.cos(phi)] - rho
        assert abs(distances.mean()) < 1e-12


def solve_all_at_once(lines: Lines, free: IntArray, start: LineFit) -> tuple[Array, Array]:
    """The same minimum over lines and parameters together, by SciPy, and its covariance."""
    d, is_point = normalised(lines), lines.mask > 0

    def measure(p: Array) -> Array:
        q = IDENTITY.copy()
        q[free] = p[: len(free)]
        return straight_lines.measure_distances(d, q, p[len(free) :].reshape(-1, 2))[is_point]

    p = np.concatenate([start.q[free], start.line.ravel()])
    found = scipy.optimize.least_squares(
        measure, p * (1 + 1e-4), jac="3-point", xtol=1e-14, ftol=1e-14, gtol=1e-14, x_scale="jac"
    )
    variance = np.sum(found.fun**2) / (len(found.fun) - len(found.x))
    P = len(free)
    return found.x[:P], np.linalg.inv(found.jac.T @ found.jac)[:P, :P] * variance


@pytest.mark.parametrize("free", [[2], [0, 1, 2, 4], [0, 1, 2, 3]])
def test_minimum_and_covariance_are_those_of_all_unknowns_together(free: list[int]) -> None:
    lines = straight_lines.collect_lines(VIEWS[:1])
    places = np.array(free)
    fit = straight_lines.solve_lines(normalised(lines), lines.mask, IDENTITY, np.array([2]))
    fit = straight_lines.solve_lines(normalised(lines), lines.mask, fit.q, places)
    assert fit.converged
    expected, covariance = solve_all_at_once(lines, places, fit)
    sigma = np.sqrt(np.diag(covariance))
    np.testing.assert_allclose((fit.q[places] - expected) / sigma, 0, atol=1e-4)
    np.testing.assert_allclose((fit.covariance - covariance) / np.outer(sigma, sigma), 0, atol=1e-4)


def test_a_step_that_folds_the_image_is_not_taken() -> None:
    """From a strong correction of the wrong sign, whose full step leads beyond the fold."""
    lines = straight_lines.collect_lines(VIEWS)
    d = normalised(lines)
    folding = np.array([0.0, 0.0, -5.0, 0.0, 1.0])
    fitted = straight_lines.fit_each_line(d, lines.mask, IDENTITY)
    assert np.isinf(straight_lines.measure_distances(d, folding, fitted)).any()
    start = np.array([0.0, 0.0, -0.4, 0.0, 1.0])
    fit = straight_lines.solve_lines(d, lines.mask, start, np.array([2]))
    direct = straight_lines.solve_lines(d, lines.mask, IDENTITY, np.array([2]))
    assert fit.converged
    assert fit.q[2] == pytest.approx(direct.q[2], rel=1e-6)


def test_parameters_without_effect_are_not_determined() -> None:
    lines = straight_lines.collect_lines(VIEWS)
    d = normalised(lines)
    assert straight_lines.solve_lines(d, lines.mask, IDENTITY, np.array([2])).is_determined
    centre_only = straight_lines.solve_lines(d, lines.mask, IDENTITY, np.array([0, 1]))
    assert not centre_only.is_determined

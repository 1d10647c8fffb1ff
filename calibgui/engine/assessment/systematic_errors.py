"""Score tests: how much of the residuals a named cause would explain, without solving again.

Residuals that are not noise have a cause: a bent board, another lens, a moving camera. To
calibrate with each of them in turn would be slow, and for most there is no such calibration. A
score test needs the residuals and their derivatives at the solution only.

A cause adds columns X to the derivatives, with coefficients that are 0 if it is absent. At the
minimum, where J^T r = 0 for the parameters that were fitted, one Gauss-Newton step on all
parameters together lowers the cost by

    T = b^T N^+ b,     b = X^T r,     N = X^T X - X^T J (J^T J)^-1 J^T X

(Rao 1948). If the residuals are noise, T / sigma^2 is chi-squared with m = rank N
degrees of freedom, whatever the columns are; with sigma^2 taken from what X leaves,
F = (T / m) / ((r^T r - T) / (nu - m)) has Fisher's distribution. The share of
r^T r that the cause explains is counted beyond what noise gives to any m columns.

Causes shared by all views (a board, a lens) are further columns of the camera's in the
arrow-shaped normal equations. Causes that each view has of its own (a board that bends anew, a
camera that moves while its rows are read) are eliminated with the view's pose; the camera's few
parameters are left out of N there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, IntArray, Size
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.board_shape.parametrisation import (
    index_board_points,
    make_basis,
    make_board_shape_problem,
)
from calibgui.engine.calibration.observations import Observation, Observations, slice_views
from calibgui.engine.calibration.problem import (
    find_free_parameters,
    make_state,
    prepare_observations,
)
from calibgui.engine.calibration.refinement.residuals import (
    Linearised,
    State,
    accumulate_normal_equations,
    compute_image_residuals,
    linearise_residuals,
)
from calibgui.engine.calibration.refinement.schur import NormalEquations, eliminate_poses
from calibgui.engine.calibration.result import Calibration, Cost
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import MODELS

LENS_CELLS = 8
"""Number of cells, along the image's longer side, of the displacement that a lens may cause."""
_KNOT_SPACING = 1 / 16
"""Distance of the knots between which rows are shifted, over the image's longer side."""
_KNOTS = np.arange(-16, 17)
"""Knots along the rows, counted from the board's mean row."""
_MIN_EIGENVALUE = 1e-9
"""Eigenvalue of normal equations of unit diagonal, below which a direction is undetermined."""


class LinearisedFit(NamedTuple):
    """A calibration as the tests need it: residuals, and their derivatives at its solution."""

    camera: Camera
    state: State
    observations: Observations
    free: IntArray
    """(P,) indices of the camera's estimated parameters."""

    def linearise(self, views: slice) -> Linearised:
        """Compute whitened residuals of the views in the image, with derivatives."""
        return linearise_residuals(
            self.state, self.observations, views, MODELS[self.camera.model], Cost.IMAGE, 1.0
        )

    def get_weight(self, views: slice) -> Array:
        """Return the matrices (k, N, 2, 2) that whiten the views' residuals; zero for padding."""
        part = self.observations.select_views(views)
        if part.whitening is not None:
            return part.whitening
        return part.mask[..., None, None] * np.eye(2)

    def predict_corners(self, views: slice) -> Array:
        """Return the corners (k, N, 2) that the calibration predicts, px.

        Columns that depend on the place in the image must take it from here: the measured place
        holds the noise that the columns are tested against.
        """
        state, part = self.state.select_views(views), self.observations.select_views(views)
        return part.uv + compute_image_residuals(state, part, MODELS[self.camera.model]).residual

    def weigh_views(self, sigma: Array) -> LinearisedFit:
        """Return the fit with every view's residuals divided by its standard deviation (K,)."""
        whitening = self.get_weight(slice(0, len(sigma))) / sigma[:, None, None, None]
        return self._replace(observations=replace(self.observations, whitening=whitening))

    @property
    def degrees_of_freedom(self) -> int:
        """Number nu of residual coordinates beyond that of the fitted unknowns."""
        return 2 * self.observations.count - len(self.free) - 6 * len(self.state.R)


def prepare_fit(calibration: Calibration, views: Sequence[Observation]) -> LinearisedFit:
    """Prepare a calibration and the views that it was made from for the tests."""
    observations = prepare_observations(calibration, views)
    if calibration.cost is Cost.PAPER:  # its board is stretched, see ``refinement/residuals.py``
        fx, fy = calibration.camera.focal
        stretched = observations.xy * np.array([1.0, fx / fy])
        observations = replace(observations, xy=stretched)
    return LinearisedFit(
        calibration.camera,
        make_state(calibration.camera, calibration.poses),
        observations,
        find_free_parameters(calibration),
    )


class Explanation(NamedTuple):
    """The part of the residuals that a cause explains."""

    probability: float
    """Probability that noise explains as much; 1 where there are too few corners to tell."""
    share: float
    """Share of r^T r, beyond what noise gives to any columns."""


def judge_explanation(T: float, rank: int, cost: float, freedom: int) -> Explanation:
    """Judge the T of `rank` columns against r^T r = `cost` with `freedom` degrees of freedom."""
    rest = freedom - rank
    if rest < 1 or rank < 1 or not cost > 0:
        return Explanation(1.0, 0.0)
    variance = max(cost - T, 0.0) / rest
    ratio = T / rank / max(variance, 1e-300)
    probability = float(scipy.special.fdtrc(rank, rest, ratio))
    return Explanation(probability, max(T - rank * variance, 0.0) / cost)


def explain_by_board_shape(fit: LinearisedFit, model: BoardShapeModel) -> Explanation:
    """Explain the residuals by a board of another shape."""
    flat, index = index_board_points(fit.observations)
    B = make_basis(model, flat)
    Q = B.shape[2]
    places = fit.observations.xy  # already off the plane on a board whose shape was estimated
    points = np.zeros((len(flat), places.shape[-1]))
    points[index] = places
    problem = make_board_shape_problem(
        fit.observations,
        fit.camera.model,
        fit.free,
        points,
        index,
        B,
        np.zeros((Q, Q)),
    )
    state = fit.state._replace(params=np.append(fit.state.params, np.zeros(Q)))
    return _test_shared_columns(problem(state), fit)


def explain_by_lens(fit: LinearisedFit) -> Explanation:
    """Explain the residuals by a smooth displacement of the image, the same in all views."""

    def extended(_: State, views: slice) -> Linearised:
        linear = fit.linearise(views)
        weight = fit.get_weight(views)
        hats = _evaluate_hats(fit.predict_corners(views), fit.camera.size)[..., None, :]
        columns = np.concatenate([weight[..., :1] * hats, weight[..., 1:] * hats], axis=-1)
        return linear._replace(
            by_params=np.concatenate([linear.by_params[..., fit.free], columns], axis=-1)
        )

    count = len(fit.free) + 2 * _evaluate_hats(np.zeros(2), fit.camera.size).shape[-1]
    return _test_shared_columns(
        accumulate_normal_equations(extended, fit.state, np.arange(count)), fit
    )


def explain_by_focus(fit: LinearisedFit) -> Explanation:
    """Explain the residuals by a focal length of each view's own."""

    def columns(_: Linearised, weight: Array, views: slice) -> Array:
        return np.asarray(weight @ (fit.predict_corners(views) - fit.camera.centre)[..., None])

    return _test_view_columns(fit, columns)


def explain_by_bending(fit: LinearisedFit) -> Explanation:
    """Explain the residuals by a board that bends anew in each view, quadratically."""
    xy = fit.observations.xy[..., :2]
    places = xy[fit.observations.mask > 0]
    low, high = places.min(axis=0), places.max(axis=0)

    def columns(linear: Linearised, _: Array, views: slice) -> Array:
        x, y = np.moveaxis((2 * xy[views] - low - high) / (high - low), -1, 0)
        by_height = linear.by_pose[..., 3:] @ fit.state.R[views, None, :, 2:]
        return by_height * np.stack([x * x, x * y, y * y], axis=-1)[..., None, :]

    return _test_view_columns(fit, columns)


def explain_by_rows(fit: LinearisedFit) -> Explanation:
    """Explain the residuals by a steady motion while the rows are read: a rolling shutter's."""

    def columns(linear: Linearised, _: Array, views: slice) -> Array:
        return linear.by_pose * _measure_rows(fit, views)[..., None, None]

    return _test_view_columns(fit, columns)


def explain_by_lines(fit: LinearisedFit) -> Explanation:
    """Explain the residuals by a shift along the rows that wanders from row to row in each view."""

    def columns(_: Linearised, weight: Array, views: slice) -> Array:
        rows = _measure_rows(fit, views)[..., None]
        hats = np.maximum(1 - np.abs(rows / _KNOT_SPACING - _KNOTS), 0.0)
        return np.asarray(weight[..., :1] * hats[..., None, :])

    return _test_view_columns(fit, columns)


def _measure_rows(fit: LinearisedFit, views: slice) -> Array:
    """Return the rows (k, N) of corners from their view's mean, over the image's longer side."""
    row = fit.predict_corners(views)[..., 1] / max(fit.camera.size)
    return np.asarray(row - row.mean(axis=1, keepdims=True))


def _test_shared_columns(normal: NormalEquations, fit: LinearisedFit) -> Explanation:
    """Test the shared columns that follow the camera's own in the normal equations."""
    # Columns that no corner depends on would be divided by 0.
    used = np.diag(normal.U) > 0
    S, g, *_ = eliminate_poses(normal)
    S, g = S[np.ix_(used, used)], g[used]
    unit = 1 / np.sqrt(np.diag(normal.U)[used])
    S, g = S * np.outer(unit, unit), g * unit
    P = int(used[: len(fit.free)].sum())
    T_all, rank_all = _compute_reduction(S, g)
    T_own, rank_own = _compute_reduction(S[:P, :P], g[:P])
    return judge_explanation(
        T_all - T_own, rank_all - rank_own, normal.cost, fit.degrees_of_freedom
    )


def _compute_reduction(N: Array, b: Array) -> tuple[float, int]:
    """Return b^T N^+ b and the rank of N."""
    values, vectors = np.linalg.eigh(N)
    good = values > _MIN_EIGENVALUE
    return float(np.sum((b @ vectors[:, good]) ** 2 / values[good])), int(good.sum())


def _test_view_columns(
    fit: LinearisedFit, columns: Callable[[Linearised, Array, slice], Array]
) -> Explanation:
    """Test columns that each view has of its own.

    Args:
        fit: the calibration.
        columns: function that returns the columns (k, N, 2, m) of some views from the fit's
            derivatives, the weights (k, N, 2, 2) and the slice of these views.
    """
    T, rank, cost = 0.0, 0, 0.0
    for views in slice_views(len(fit.state.R)):
        linear = fit.linearise(views)
        k = len(linear.residual)
        X = columns(linear, fit.get_weight(views), views)
        Jp, X = (M.reshape(k, -1, M.shape[-1]) for M in (linear.by_pose, X))
        # Columns that no corner depends on would be divided by 0.
        Jp, X = (M / np.maximum(np.linalg.norm(M, axis=1, keepdims=True), 1e-12) for M in (Jp, X))
        Q = np.linalg.qr(Jp)[0]
        X = X - Q @ (np.swapaxes(Q, 1, 2) @ X)
        N, b = np.swapaxes(X, 1, 2) @ X, np.swapaxes(X, 1, 2) @ linear.residual.reshape(k, -1, 1)
        for T_view, rank_view in map(_compute_reduction, N, b[..., 0]):
            T, rank = T + T_view, rank + rank_view
        cost += float(np.sum(linear.residual**2))
    return judge_explanation(T, rank, cost, fit.degrees_of_freedom)


def _evaluate_hats(uv: Array, size: Size) -> Array:
    """Evaluate bilinear hat functions (..., M) on a mesh over the image, at pixels (..., 2)."""
    cells = [max(1, round(LENS_CELLS * n / max(size))) for n in size]
    along = []
    for axis, (n, count) in enumerate(zip(size, cells, strict=True)):
        place = np.clip(uv[..., axis] / (n - 1), 0, 1) * count
        along.append(np.maximum(1 - np.abs(place[..., None] - np.arange(count + 1)), 0.0))
    hats = along[0][..., :, None] * along[1][..., None, :]
    return hats.reshape(*uv.shape[:-1], -1)

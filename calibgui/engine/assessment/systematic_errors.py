"""What a named cause would explain of the residuals, without solving again.

A cause adds columns X to the derivatives, with coefficients that are 0 if it is absent. At the
minimum, where J^T r = 0 for the parameters that were fitted, one Gauss-Newton step on all
parameters together lowers the cost by

    T = b^T N^+ b,     b = X^T r,     N = X^T X - X^T J (J^T J)^-1 J^T X

(Rao's score test). If the residuals are noise, T / sigma^2 is chi-squared with m = rank N
degrees of freedom, whatever the cause looks like; with sigma^2 taken from what X leaves,
F = (T / m) / ((r^T r - T) / (nu - m)) has Fisher's distribution. The share of
r^T r that the cause explains is counted beyond what noise gives to any m columns.

Causes shared by all views (a plate, a lens) are further columns of the camera's in the
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
from calibgui.engine.calibration.board_shape.estimate import basis, board_shape_problem, corners_of
from calibgui.engine.calibration.observations import Observation, Observations, chunks
from calibgui.engine.calibration.problem import free_parameters, measured, state_of
from calibgui.engine.calibration.refinement.normal_equations import linearised
from calibgui.engine.calibration.refinement.residuals import Linearised, State, image_residual
from calibgui.engine.calibration.refinement.schur import NormalEquations, normal_equations, schur
from calibgui.engine.calibration.result import Calibration, Cost
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import MODELS

CELLS = 8
"""Cells along the image's longer side of the displacements that a lens is allowed."""
_LINES = 1 / 16
"""Distance of the knots between which rows are shifted, in the image's longer side."""
_KNOTS = np.arange(-16, 17)
"""Of rows counted from the board's mean."""
_RANK = 1e-9


class Fitted(NamedTuple):
    """A calibration as the tests need it: the residuals and their derivatives at its solution."""

    camera: Camera
    state: State
    observations: Observations
    free: IntArray
    """(P,) indices of the camera's estimated parameters."""

    def linear(self, views: slice) -> Linearised:
        """Whitened residuals of some views in the image, with derivatives."""
        return linearised(
            self.state, self.observations, views, MODELS[self.camera.model], Cost.IMAGE, 1.0
        )

    def weight(self, views: slice) -> Array:
        """(k, N, 2, 2) what whitens the residuals of some views; zero for padding."""
        part = self.observations.part(views)
        if part.whitening is not None:
            return part.whitening
        return part.mask[..., None, None] * np.eye(2)

    def predicted(self, views: slice) -> Array:
        """(k, N, 2) corners as the calibration predicts them, px.

        Where columns depend on the place in the image it must be this one: with the measured
        place they would hold its noise, which is what they are to be tested against.
        """
        state, part = self.state.part(views), self.observations.part(views)
        return part.uv + image_residual(state, part, MODELS[self.camera.model]).residual

    def weighted(self, sigma: Array) -> Fitted:
        """The same with every view's residuals over its standard deviation (K,)."""
        whitening = self.weight(slice(0, len(sigma))) / sigma[:, None, None, None]
        return self._replace(observations=replace(self.observations, whitening=whitening))

    @property
    def freedom(self) -> int:
        """nu, residual coordinates beyond the fitted unknowns."""
        return 2 * self.observations.count - len(self.free) - 6 * len(self.state.R)


def fitted(calibration: Calibration, views: Sequence[Observation]) -> Fitted:
    """The calibration with the views that it was made from."""
    observations = measured(calibration, views)
    if calibration.cost is Cost.PAPER:  # its plate is stretched, see ``stage_two.py``
        fx, fy = calibration.camera.focal
        stretched = observations.xy * np.array([1.0, fx / fy])
        observations = replace(observations, xy=stretched)
    return Fitted(
        calibration.camera,
        state_of(calibration.camera, calibration.poses),
        observations,
        free_parameters(calibration),
    )


class Explained(NamedTuple):
    """What a cause explains of the residuals."""

    probability: float
    """Of noise explaining as much; 1 where there are too few corners to tell."""
    share: float
    """Of r^T r, beyond what noise gives to any columns."""


def explained(T: float, rank: int, cost: float, freedom: int) -> Explained:
    """T of m columns, judged against all that is left, r^T r with nu degrees of freedom."""
    rest = freedom - rank
    if rest < 1 or rank < 1 or not cost > 0:
        return Explained(1.0, 0.0)
    variance = max(cost - T, 0.0) / rest
    ratio = T / rank / max(variance, 1e-300)
    probability = float(scipy.special.fdtrc(rank, rest, ratio))
    return Explained(probability, max(T - rank * variance, 0.0) / cost)


def by_board_shape(fit: Fitted, model: BoardShapeModel) -> Explained:
    """By a plate of another shape."""
    flat, index = corners_of(fit.observations)
    B = basis(model, flat)
    Q = B.shape[2]
    places = fit.observations.xy  # already off the plane on a plate that was estimated
    points = np.zeros((len(flat), places.shape[-1]))
    points[index] = places
    problem = board_shape_problem(
        fit.observations,
        fit.camera.model,
        fit.free,
        points,
        index,
        B,
        np.zeros((Q, Q)),
    )
    state = fit.state._replace(params=np.append(fit.state.params, np.zeros(Q)))
    return _shared(problem(state), fit)


def by_lens(fit: Fitted) -> Explained:
    """By any smooth displacement of the image, the same in all views."""

    def extended(_: State, views: slice) -> Linearised:
        linear = fit.linear(views)
        weight = fit.weight(views)
        hats = _hats(fit.predicted(views), fit.camera.size)[..., None, :]
        columns = np.concatenate([weight[..., :1] * hats, weight[..., 1:] * hats], axis=-1)
        return linear._replace(
            by_params=np.concatenate([linear.by_params[..., fit.free], columns], axis=-1)
        )

    count = len(fit.free) + 2 * _hats(np.zeros(2), fit.camera.size).shape[-1]
    return _shared(normal_equations(extended, fit.state, np.arange(count)), fit)


def by_focus(fit: Fitted) -> Explained:
    """By a focal length of each view's own."""

    def columns(_: Linearised, weight: Array, views: slice) -> Array:
        return np.asarray(weight @ (fit.predicted(views) - fit.camera.centre)[..., None])

    return _own(fit, columns)


def by_bending(fit: Fitted) -> Explained:
    """By corners that lie off the plate, quadratic over it, another way in each view."""
    xy = fit.observations.xy[..., :2]
    places = xy[fit.observations.mask > 0]
    low, high = places.min(axis=0), places.max(axis=0)

    def columns(linear: Linearised, _: Array, views: slice) -> Array:
        x, y = np.moveaxis((2 * xy[views] - low - high) / (high - low), -1, 0)
        by_height = linear.by_pose[..., 3:] @ fit.state.R[views, None, :, 2:]
        return by_height * np.stack([x * x, x * y, y * y], axis=-1)[..., None, :]

    return _own(fit, columns)


def by_rows(fit: Fitted) -> Explained:
    """By a motion of each view's own, steady while the rows are read: a rolling shutter's."""

    def columns(linear: Linearised, _: Array, views: slice) -> Array:
        return linear.by_pose * _rows(fit, views)[..., None, None]

    return _own(fit, columns)


def by_lines(fit: Fitted) -> Explained:
    """By a shift along the rows that wanders from row to row, another in each view."""

    def columns(_: Linearised, weight: Array, views: slice) -> Array:
        rows = _rows(fit, views)[..., None]
        hats = np.maximum(1 - np.abs(rows / _LINES - _KNOTS), 0.0)
        return np.asarray(weight[..., :1] * hats[..., None, :])

    return _own(fit, columns)


def _rows(fit: Fitted, views: slice) -> Array:
    """(k, N) rows of some views' corners from their mean, over the image's longer side."""
    row = fit.predicted(views)[..., 1] / max(fit.camera.size)
    return np.asarray(row - row.mean(axis=1, keepdims=True))


def _shared(normal: NormalEquations, fit: Fitted) -> Explained:
    """The score test of the shared columns after the camera's own."""
    # Columns that no corner depends on would be divided by 0.
    used = np.diag(normal.U) > 0
    S, g, *_ = schur(normal)
    S, g = S[np.ix_(used, used)], g[used]
    unit = 1 / np.sqrt(np.diag(normal.U)[used])
    S, g = S * np.outer(unit, unit), g * unit
    P = int(used[: len(fit.free)].sum())
    T_all, rank_all = _reduction(S, g)
    T_own, rank_own = _reduction(S[:P, :P], g[:P])
    return explained(T_all - T_own, rank_all - rank_own, normal.cost, fit.freedom)


def _reduction(N: Array, b: Array) -> tuple[float, int]:
    """b^T N^+ b and the rank of N."""
    values, vectors = np.linalg.eigh(N)
    good = values > _RANK
    return float(np.sum((b @ vectors[:, good]) ** 2 / values[good])), int(good.sum())


def _own(fit: Fitted, columns: Callable[[Linearised, Array, slice], Array]) -> Explained:
    """The score test of columns that each view has of its own.

    Args:
        fit: what they are to explain.
        columns: their derivatives (k, N, 2, m), from the fit's own at some views, the weights
            (k, N, 2, 2) there, and the views.
    """
    T, rank, cost = 0.0, 0, 0.0
    for views in chunks(len(fit.state.R)):
        linear = fit.linear(views)
        k = len(linear.residual)
        X = columns(linear, fit.weight(views), views)
        Jp, X = (M.reshape(k, -1, M.shape[-1]) for M in (linear.by_pose, X))
        # Columns that no corner depends on would be divided by 0.
        Jp, X = (M / np.maximum(np.linalg.norm(M, axis=1, keepdims=True), 1e-12) for M in (Jp, X))
        Q = np.linalg.qr(Jp)[0]
        X = X - Q @ (np.swapaxes(Q, 1, 2) @ X)
        N, b = np.swapaxes(X, 1, 2) @ X, np.swapaxes(X, 1, 2) @ linear.residual.reshape(k, -1, 1)
        for one in map(_reduction, N, b[..., 0]):
            T, rank = T + one[0], rank + one[1]
        cost += float(np.sum(linear.residual**2))
    return explained(T, rank, cost, fit.freedom)


def _hats(uv: Array, size: Size) -> Array:
    """(..., M) bilinear hat functions on a mesh over the image, at pixels (..., 2)."""
    cells = [max(1, round(CELLS * n / max(size))) for n in size]
    along = []
    for axis, (n, count) in enumerate(zip(size, cells, strict=True)):
        place = np.clip(uv[..., axis] / (n - 1), 0, 1) * count
        along.append(np.maximum(1 - np.abs(place[..., None] - np.arange(count + 1)), 0.0))
    hats = along[0][..., :, None] * along[1][..., None, :]
    return hats.reshape(*uv.shape[:-1], -1)

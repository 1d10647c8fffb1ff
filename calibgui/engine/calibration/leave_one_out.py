"""Leave-one-out: each view as a calibration would predict it unseen, from its one solve.

The residuals of a calibration flatter it, because it was fitted to them. To leave out one view
after the other and fit again (Stone 1974) tells how well it predicts, and takes as many solves as
there are views. The normal equations of the one solve tell the same, but for terms of the second
order (Cook 1977, for single rows; here all rows of a view leave together).

Let e be the whitened residuals of a view (predicted minus measured), A and B their derivatives by
what all views share (camera, and the board's shape where it is estimated) and by the view's pose.
The pose is fitted again in any case: with the projection P onto what B leaves, A' = P A and
e' = P e. Let C be the inverse of the sum of A'^T A' over all views, with the stiffness of a board's
prior. Without view k the minimum for the others is off by

    d = (C^-1 - A'^T A')^-1 A'^T e' = C A'^T q,     q = (I - A' C A'^T)^-1 e',

and q = e' + A' d is what is left of the view under the camera that has not seen it, its pose fitted
to it. With C = L L^T and d = L m, m solves (I - L^T A'^T A' L) m = L^T A'^T e'. Of the 26
photographs of ``bouguet_calib_example`` the root mean square of q is that of 26 calibrations again
to four digits.
Where a lens model leaves errors far above the corners' noise, the step is too small to follow them:
2 % of the error for the paper's model on a wide lens.

It does not measure an error that all views share, as that of a board which is not flat.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, IntArray, freeze
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration.board_shape.deviations import make_deviations
from calibgui.engine.calibration.board_shape.estimate import allow_deviations, recall_variances
from calibgui.engine.calibration.board_shape.parametrisation import index_board_points
from calibgui.engine.calibration.board_shape.uncertainty import state_variance_prior
from calibgui.engine.calibration.observations import (
    Observation,
    Observations,
    pack_observations,
    slice_views,
)
from calibgui.engine.calibration.problem import (
    find_free_parameters,
    make_state,
    recover_arguments,
    weigh_and_place,
)
from calibgui.engine.calibration.refinement.residuals import State, compute_image_residuals
from calibgui.engine.calibration.result import Calibration, DegenerateError

_MIN_LEFT = 1e-6
"""Part of a direction's information that the other views hold, below which they do not determine
the camera: a plausibility limit."""


@dataclass(frozen=True, eq=False, slots=True)
class LeftOut:
    """The views of a calibration, each as the others predict it."""

    by_view: Array
    """(K,) RMS length of every view's residuals under the camera without it, px."""
    lengths: Array
    """(n,) lengths of all corners' residuals so, px, one view after the other."""

    def __post_init__(self) -> None:
        freeze(self, "by_view", "lengths")

    @property
    def held_out(self) -> float:
        """RMS length of the residuals of unseen views, px."""
        return float(np.sqrt(np.mean(self.lengths**2)))


def leave_views_out(calibration: Calibration, views: Sequence[Observation]) -> LeftOut:
    """Predict each view of a calibration from the others.

    Args:
        calibration: a calibration by the image cost, with the board as drawn, as held, or of a
            shape that it estimates.
        views: the views that it was made from.

    Raises:
        DegenerateError: if the camera is not determined without one of the views.
    """
    drawn = pack_observations(views)
    observations, state = (
        weigh_and_place(calibration, drawn),
        make_state(calibration.camera, calibration.poses),
    )
    basis, index, stiffness = _describe_board(calibration, drawn)
    free = find_free_parameters(calibration)
    parts = list(_iterate_views(state, observations, calibration, free, basis, index))
    P = len(free)
    information = sum((A.T @ A for A, *_ in parts), start=np.zeros((P + len(stiffness),) * 2))
    information[P:, P:] += stiffness
    root = _find_root(information)
    lengths = []
    for k, (A, e, whitening) in enumerate(parts):
        try:
            q = _leave_out(A @ root, e)
        except np.linalg.LinAlgError:
            raise DegenerateError(
                f"Without view {k + 1} the others do not determine the camera.",
                "Add views with the board tilted in different directions.",
            ) from None
        raw = np.linalg.solve(whitening, q.reshape(-1, 2, 1))[..., 0]
        lengths.append(np.linalg.norm(raw, axis=1))
    by_view = np.array([np.sqrt(np.mean(each**2)) for each in lengths])
    return LeftOut(by_view, np.concatenate(lengths))


def _find_root(information: Array) -> Array:
    """Find L (S, R) with L L^T = C, the pseudoinverse of the information (S, S)."""
    unit = 1 / np.sqrt(np.maximum(np.diag(information), np.finfo(float).tiny))
    values, vectors = np.linalg.eigh(information * np.outer(unit, unit))
    known = values > len(values) * np.finfo(float).eps * values[-1]
    return unit[:, None] * vectors[:, known] / np.sqrt(values[known])


def _leave_out(AL: Array, e: Array) -> Array:
    """Find q (2n,) of a view from A' L (2n, R) and e' (2n,).

    Of the equal systems with A' L on either side it solves the smaller one. Raises LinAlgError if
    the other views hold next to nothing of a direction.
    """
    is_tall = AL.shape[0] > AL.shape[1]
    product = AL.T @ AL if is_tall else AL @ AL.T
    np.linalg.cholesky((1 - _MIN_LEFT) * np.eye(len(product)) - product)
    rest = np.eye(len(product)) - product
    if is_tall:
        return np.asarray(e + AL @ np.linalg.solve(rest, AL.T @ e), np.float64)
    return np.asarray(np.linalg.solve(rest, e), np.float64)


def _describe_board(
    calibration: Calibration, drawn: Observations
) -> tuple[Array | None, IntArray, Array]:
    """Return the basis (n, 3, Q) of an estimated board shape, the corners' indices (K, N) among the
    n points, and the stiffness (Q, Q) of its prior; None and (0, 0) if no shape is estimated."""
    points, index = index_board_points(drawn)
    shape, arguments = calibration.board_shape, recover_arguments(calibration)
    if shape is None or not isinstance(arguments["board_shape"], BoardShapeModel):
        return None, index, np.zeros((0, 0))
    variances = _find_variances(shape, arguments["prior"])
    allowed = allow_deviations(shape.model, points, variances)
    return allowed.B, index, allowed.make_stiffness(calibration.noise**2)


def _find_variances(shape: BoardShape, prior: BoardShapePrior | None) -> Array:
    """Find the variances (3,), mm^2, of the deviations by kind that a shape was estimated with."""
    if prior is None:
        return recall_variances(shape)
    return state_variance_prior(shape.nominal, make_deviations(shape.nominal).kind, prior).expected


def _iterate_views(
    state: State,
    observations: Observations,
    calibration: Calibration,
    free: IntArray,
    basis: Array | None,
    index: IntArray,
) -> Iterator[tuple[Array, Array, Array]]:
    """Yield A' (2n, S), e' (2n,) and the whitening (n, 2, 2) of each view's n corners."""
    for views in slice_views(len(state.R)):
        part = observations.select_views(views)
        linear = compute_image_residuals(state.select_views(views), part, calibration.camera.model)
        shared = linear.by_params[..., free]
        if basis is not None:
            by_corner = linear.by_pose[..., 3:] @ state.R[views, None]
            shared = np.concatenate([shared, by_corner @ basis[index[views]]], axis=-1)
        for k, mask in enumerate(part.mask > 0):
            W = np.broadcast_to(np.eye(2), (int(mask.sum()), 2, 2))
            if part.whitening is not None:
                W = part.whitening[k, mask]
            stacked = (shared[k, mask], linear.residual[k, mask, :, None], linear.by_pose[k, mask])
            whole = (W @ np.concatenate(stacked, axis=-1)).reshape(2 * len(W), -1)
            Q = np.linalg.qr(whole[:, -6:])[0]
            left = whole[:, :-6] - Q @ (Q.T @ whole[:, :-6])
            yield left[:, :-1], left[:, -1], W

"""Single views determine what Stage I estimates from them more or less well (paper 4.2, Table 1).

A view's corners x are corrected by xp, yp and k1 and mapped onto the reference points x' by a
homography (eq. 31 and 33). Moving the principal point is nearly the same as tilting the board, so
that one view tells the two apart by little. Two measures show by how little:

- the standard deviations of the view's own xp, yp, k1, sqrt(diag(S / (2n - 11) (J^T J)^-1)), with
  S the sum of squares of eq. 34 over n corners, and J its Jacobian by all 11 unknowns;
- the residual that is left if other values of xp, yp, k1 are held and only the homography is
  fitted again.

Neither knows of errors that all corners of a view share, those of the lens model and of the board.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.calibration import Observation, StageOne
from calibgui.engine.geometry import apply_homography, fit_homography, paper_from_array


@dataclass(frozen=True, eq=False, slots=True)
class StageOneEvidence:
    """The evidence of the corners of each of K views about xp, yp and k1."""

    sd: Array
    """(K, 3) standard deviations of the view's own xp, yp (px) and k1 (px^-2)."""
    held_rms: Array
    """(K,) root mean square residual with other values held, reference px."""


def examine_stage_one(result: Result, held: Array) -> StageOneEvidence:
    """Examine how far each view of `result` determines its xp, yp and k1.

    Args:
        result: calibration of K views.
        held: (K, 3) values of xp, yp (px) and k1 (px^-2) to hold, in the paper's frame.
    """
    rows = zip(result.observations(), result.calibration.stage_one, held, strict=True)
    found = [_examine_view(result, *row) for row in rows]
    return StageOneEvidence(
        sd=np.array([sd for sd, _ in found]), held_rms=np.array([rms for _, rms in found])
    )


def _examine_view(
    result: Result, view: Observation, row: StageOne, held: Array
) -> tuple[Array, float]:
    """Return (3,) standard deviations of a view's xp, yp, k1, and its rms with `held` held.

    Lengths are divided by the points' spread, as k1 is 1e-7 px^-2.
    """
    xy = paper_from_array(view.uv, result.calibration.camera.size)
    reference = result.calibration.reference_scale * (view.xy - view.xy.mean(axis=0))
    spread, goal_spread = _measure_spread(xy), _measure_spread(reference)
    units = np.array([spread, spread, spread**-2])
    x, goal = xy / spread, reference / goal_spread

    own = np.array([row.xp, row.yp, row.k1]) / units
    start = np.concatenate([_fit_homography(own, x, goal), own])
    fit = scipy.optimize.least_squares(_register, start, method="lm", args=(x, goal))
    J = np.asarray(fit.jac, dtype=np.float64)
    variance = 2 * fit.cost / (goal.size - len(start))
    sd = np.sqrt(variance * np.diag(np.linalg.inv(J.T @ J))[-3:])
    left = _compute_residual(_fit_homography(held / units, x, goal), held / units, x, goal)
    return sd * units, goal_spread * float(np.sqrt(np.sum(left**2) / len(x)))


def _measure_spread(points: Array) -> float:
    return float(np.sqrt(np.mean(np.sum(points**2, axis=1))))


def _fit_homography(centre_and_k1: Array, x: Array, goal: Array) -> Array:
    """Return (8,) the homography that registers points corrected by xp, yp, k1 best (eq. 34)."""
    start = fit_homography(_correct(centre_and_k1, x), goal, np.ones(len(x))).ravel()[:8]
    fit = scipy.optimize.least_squares(
        _compute_residual, start, method="lm", args=(centre_and_k1, x, goal)
    )
    return np.asarray(fit.x)


def _register(unknowns: Array, x: Array, goal: Array) -> Array:
    """Return (2n,) residuals by all 11 unknowns: the homography, then xp, yp, k1."""
    return _compute_residual(unknowns[:8], unknowns[8:], x, goal)


def _compute_residual(homography: Array, centre_and_k1: Array, x: Array, goal: Array) -> Array:
    """Return (2n,) registered minus reference points (eq. 33)."""
    H = np.append(homography, 1.0).reshape(3, 3)
    return (apply_homography(H, _correct(centre_and_k1, x)) - goal).ravel()


def _correct(centre_and_k1: Array, x: Array) -> Array:
    """Return (n, 2) corrected points, measured from the principal point (eq. 31)."""
    offset = x - centre_and_k1[:2]
    return offset * (1 + centre_and_k1[2] * np.sum(offset**2, axis=1, keepdims=True))

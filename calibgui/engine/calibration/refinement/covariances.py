"""Covariances of the estimates, and the parameters that the data leave undetermined.

With independent residuals of standard deviation sigma, estimated by
sigma^2 = r^T r / (2N - P - 6K), the covariance of all unknowns is sigma^2 (J^T J)^-1. In the
blocks of ``schur.py`` (Triggs et al. 2000)

    cov(shared)  = sigma^2 S^-1
    cov(pose k)  = sigma^2 (Vk^-1 + Vk^-1 Wk^T S^-1 Wk Vk^-1).

Where a prior Q is part of U (``prior.py``), the corners determine only P - tr(S^-1 Q) of the shared
parameters, the number that counts in sigma^2, and sigma^2 S^-1 is what corners and prior know
together, the prior with the corners' sigma.

The paper's own standard deviations (Tables 2 and 3) are sqrt(diag((2 J^T J)^-1)), without
sigma: they tell how well the reference grid, not the corners' noise, determines a value.

A parameter is undetermined if S has lost its rank in it, or if its standard deviation is
larger than any use of the parameter tolerates. Rank is judged on U^-1/2 S U^-1/2, S scaled
by the parameters' own diagonal, whose eigenvalues lie between 0 and 1: the part of the
information on a combination of parameters that is left once the poses have been fitted as
well. Poor sets of views and long lenses reach 1e-7; only rounding makes it 1e-14.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array
from calibgui.engine.boards.shape import BoardShape
from calibgui.engine.calibration.observations import Observations, slice_views
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution
from calibgui.engine.calibration.refinement.residuals import BoardMotion, State
from calibgui.engine.calibration.refinement.schur import (
    NormalEquations,
    Reduced,
    eliminate_poses,
    find_pairs,
)
from calibgui.engine.calibration.result import Calibration, Undetermined
from calibgui.engine.geometry import frames, rotations

_MIN_INFORMATION = 1e-12
"""Information left, from 0 to 1, below which a combination of parameters is lost in rounding."""
_MIN_CERTAIN_INFORMATION = 1e-7
"""Information left, estimated from below, from which rounding errors in it do not matter."""
_MIN_SHARE = 0.2
"""Share of a lost combination's length from which a parameter is named as undetermined."""


class Precision(NamedTuple):
    """The precision with which the corners' noise lets the camera be known."""

    variance: float
    """sigma^2 of one residual coordinate."""
    shared: Array
    """(P, P) covariance of the free shared parameters."""
    undetermined: tuple[Undetermined, ...]
    """Parameters whose standard deviations are not to be believed."""
    reduced: Reduced
    """The normal equations of the shared parameters."""


class Estimate(NamedTuple):
    """A solution with its covariances."""

    solution: Solution
    state: State
    """Camera and poses, without the unknowns of a board shape."""
    observations: Observations
    """The views, with the corners where the estimated board has them."""
    sigma2: float
    """Variance of one residual coordinate, in the cost's px^2."""
    camera_covariance: Array
    """(P, P) covariance of the camera's free parameters."""
    pose_covariances: Array
    """(K, 6, 6) covariances of the solver's local (w, tau)."""
    noise_covariance: Array
    """(P, P) covariance of the camera's free parameters from the corners' noise alone."""
    undetermined: tuple[Undetermined, ...] = ()
    """Parameters whose standard deviations are not to be believed."""
    board_shape: BoardShape | None = None
    shape_unknowns: float = 0.0
    """Number of unknowns of an estimated board shape that the views know of."""
    board_motion: BoardMotion | None = None
    """Motion of the corners of an estimated board with the camera's parameters."""
    board_shape_error: float = 0.0
    """See ``Calibration.board_shape_error``."""
    lens_error: float = 0.0
    """See ``Calibration.lens_error``."""
    overdispersion: float = 0.0
    """See ``Calibration.overdispersion``."""


def estimate_variance(cost: float, corners: int, unknowns: float) -> float:
    """Estimate sigma^2, the variance of one residual coordinate; NaN without redundancy."""
    freedom = 2 * corners - unknowns
    return cost / freedom if freedom > 0 else float("nan")


def decompose_information(reduced: Reduced) -> tuple[Array, Array]:
    """Return eigenvalues (P,), ascending, and eigenvectors (P, P) of the scaled information."""
    values, vectors = np.linalg.eigh(reduced.scaled)
    return values, vectors


def measure_precision(
    normal: NormalEquations, names: tuple[str, ...], corners: int, tolerated: Array
) -> Precision:
    """Measure how well the views determine the camera.

    Args:
        normal: the normal equations at the solution.
        names: (P,) names of the free parameters.
        corners: number of corners in all views.
        tolerated: (P,) standard deviations beyond which a parameter counts as undetermined.
    """
    reduced = eliminate_poses(normal)
    inverse, left = invert_information(reduced)
    fitted = float(len(names))
    if normal.prior is not None:
        fitted -= float(inverse[normal.prior.coords] @ normal.prior.data)
    sigma2 = estimate_variance(normal.cost, corners, fitted + normal.pose.size)
    shared = sigma2 * inverse
    is_lost = np.zeros(len(names), dtype=bool)
    if left < _MIN_INFORMATION:
        values, vectors = decompose_information(reduced)
        is_lost = np.sqrt((vectors[:, values < _MIN_INFORMATION] ** 2).sum(axis=1)) > _MIN_SHARE
    is_unused = np.diag(normal.U) <= 0
    is_imprecise = np.sqrt(np.diag(shared)) > tolerated
    undetermined = tuple(
        Undetermined(name, reason)
        for i, name in enumerate(names)
        if (
            reason := ("no corner depends on it" if is_unused[i] else "")
            or ("it can be traded for the boards' poses" if is_lost[i] else "")
            or ("the corners' noise leaves it open" if is_imprecise[i] else "")
        )
    )
    return Precision(sigma2, shared, undetermined, reduced)


def invert_information(reduced: Reduced) -> tuple[Array, float]:
    """Invert S (P, P) without the combinations that are lost, and measure the information left.

    The information left is the least eigenvalue of the scaled S. Where the inverse's norm shows
    that no combination is lost, it is estimated by that, which makes it at most twice the root of P
    times too small: for hundreds of parameters eigenvalues take ten times as long.
    """
    pairs, unit = find_pairs(reduced.S), reduced.unit
    inverse, left = _invert_scaled(reduced.scale_block(pairs.coupled))
    if pairs.coupled is None:
        inverse *= unit
        inverse *= unit[:, None]
        return inverse, left
    inverse *= unit[pairs.coupled]
    inverse *= unit[pairs.coupled, None]
    whole = np.zeros_like(reduced.S)
    whole[np.ix_(pairs.coupled, pairs.coupled)] = inverse
    pairs.fill_in(whole)
    # Twice the larger entry on the diagonal of a 2 x 2 inverse bounds its larger eigenvalue.
    return whole, min(left, float(np.min(unit[pairs.alone] ** 2 / (2 * pairs.diagonal))))


def _invert_scaled(scaled: Array) -> tuple[Array, float]:
    """Invert S or a block of it, scaled, as `invert_information`."""
    if not len(scaled):
        return scaled, 1.0
    lapack = scipy.linalg.lapack
    factor, failed = lapack.dpotrf(scaled.T)
    if not failed:
        lower = lapack.dpotri(factor, overwrite_c=True)[0].T  # zero above the diagonal
        inverse = lower + lower.T
        inverse.flat[:: len(inverse) + 1] /= 2
        left = 1 / float(np.linalg.norm(inverse))
        if left > _MIN_CERTAIN_INFORMATION:
            return inverse, left
    values, vectors = np.linalg.eigh(scaled)
    kept = values > _MIN_INFORMATION
    return vectors[:, kept] / values[kept] @ vectors[:, kept].T, float(values[0])


def make_estimate(solution: Solution, observations: Observations, precision: Precision) -> Estimate:
    """Make the estimate of a solution whose board has the shape that it was given."""
    sigma2, camera, undetermined, reduced = precision
    poses = compute_pose_covariances(reduced, camera, sigma2)
    return Estimate(
        solution, solution.state, observations, sigma2, camera, poses, camera, undetermined
    )


def compute_pose_covariances(reduced: Reduced, shared: Array, sigma2: float) -> Array:
    """Compute the covariances (K, 6, 6) of the solver's local (w, tau), rad and mm.

    Args:
        reduced: the normal equations of the shared parameters at the solution.
        shared: (P, P) covariance of the free shared parameters.
        sigma2: variance of one residual coordinate.
    """
    roots, W = reduced.roots, reduced.W
    is_touched = W.any(axis=(0, 2))
    if not is_touched.all():  # the coefficients that no corner touches do not act on poses
        W, shared = W[:, is_touched], shared[np.ix_(is_touched, is_touched)]
    inverse = np.swapaxes(roots, 1, 2) @ roots
    found = sigma2 * inverse
    for views in slice_views(len(found)):
        G = inverse[views] @ np.swapaxes(W[views], 1, 2)
        carried = np.tensordot(G, shared, axes=1)  # one product for all views
        found[views] += carried @ np.swapaxes(G, 1, 2)
    return found


def convert_pose_covariances(local: Array, rvecs: Array) -> Array:
    """Convert covariances (K, 6, 6) of the solver's local (w, tau) to those of (rvec, tvec).

    Args:
        local: the covariances, rad and mm.
        rvecs: (K, 3) rotation vectors of the poses.
    """
    J = np.zeros((len(rvecs), 6, 6))
    J[:, :3, :3] = rotations.compute_inverse_left_jacobian(rvecs)
    J[:, 3:, 3:] = np.eye(3)
    return np.asarray(J @ local @ np.swapaxes(J, 1, 2))


def compute_correlations(covariance: Array) -> Array:
    """Return the correlations of a covariance (P, P); NaN for parameters that were held."""
    sd = np.sqrt(np.diag(covariance))
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(covariance / np.outer(sd, sd))


def make_paper_table(calibration: Calibration) -> tuple[Array, Array, Array]:
    """Make the paper's Table 2: ten intrinsics in its units and two kinds of standard deviations.

    Returns:
        Values, standard deviations as ``Calibration.sigma`` and the paper's
        sqrt(diag((2 J^T J)^-1)), each (10,) in the order of ``frames.PAPER_NAMES``.
    """
    camera = calibration.camera
    values, J = frames.paper_from_intrinsics(camera.params, camera.size)
    sigma, by_noise = (
        np.sqrt(np.diag(J @ covariance @ J.T))
        for covariance in (calibration.covariance, calibration.noise_covariance)
    )
    return values, sigma, by_noise / (np.sqrt(2) * calibration.noise)

"""Covariances of the estimates, and what the data leave undetermined.

With independent residuals of standard deviation sigma, estimated by
sigma^2 = r^T r / (2N - P - 6K), the covariance of all unknowns is sigma^2 (J^T J)^-1. In the
blocks of ``arrow.py``

    cov(shared)  = sigma^2 S^-1
    cov(pose k)  = sigma^2 (Vk^-1 + Vk^-1 Wk^T S^-1 Wk Vk^-1).

The paper's own standard deviations (Tables 2 and 3) are sqrt(diag((2 J^T J)^-1)), without
sigma: they answer how well the reference grid, not the corners' noise, determines a value.

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
from calibgui.engine.calibration.observations import chunks
from calibgui.engine.calibration.refinement.schur import NormalEquations, Reduced, schur
from calibgui.engine.calibration.result import Calibration, Undetermined
from calibgui.engine.geometry import frames, rotations

_RANK = 1e-12
"""Information left below which a combination is lost in rounding."""
_CLEAR = 1e-6
"""Pivots of Cholesky's factorisation above which nothing is."""
_SHARE = 0.2
"""Of the undetermined combination's length that a parameter must contribute to be named."""


class Precision(NamedTuple):
    """What the corners' noise leaves open."""

    variance: float
    """sigma^2 of one residual coordinate."""
    shared: Array
    """(P, P) covariance of the free shared parameters."""
    undetermined: tuple[Undetermined, ...]


def variance(cost: float, corners: int, unknowns: int) -> float:
    """sigma^2, the variance of one residual coordinate; NaN without redundancy."""
    freedom = 2 * corners - unknowns
    return cost / freedom if freedom > 0 else float("nan")


def information_left(reduced: Reduced) -> tuple[Array, Array]:
    """Eigenvalues (P,), ascending, and eigenvectors (P, P) of the scaled Schur complement."""
    values, vectors = np.linalg.eigh(reduced.scaled)
    return values, vectors


def precision(
    normal: NormalEquations, names: tuple[str, ...], corners: int, tolerated: Array
) -> Precision:
    """How well the views determine the camera.

    Args:
        normal: at the solution.
        names: (P,) of the free parameters.
        corners: number of corners in all views.
        tolerated: (P,) standard deviations beyond which a parameter counts as undetermined.
    """
    sigma2 = variance(normal.cost, corners, len(names) + normal.pose.size)
    reduced = schur(normal)
    shared = shared_covariance(reduced, sigma2)
    values, vectors = information_left(reduced)
    lost = np.sqrt((vectors[:, values < _RANK] ** 2).sum(axis=1)) > _SHARE
    blank = np.diag(normal.U) <= 0
    vague = np.sqrt(np.diag(shared)) > tolerated
    undetermined = tuple(
        Undetermined(name, reason)
        for i, name in enumerate(names)
        if (
            reason := ("no corner depends on it" if blank[i] else "")
            or ("it can be traded for the boards' poses" if lost[i] else "")
            or ("the corners' noise leaves it open" if vague[i] else "")
        )
    )
    return Precision(sigma2, shared, undetermined)


def shared_covariance(reduced: Reduced, sigma2: float) -> Array:
    """(P, P) covariance of the free shared parameters, without the combinations that are lost."""
    return sigma2 * shared_inverse(reduced)[0]


def shared_inverse(reduced: Reduced) -> tuple[Array, float]:
    """S^-1 (P, P) without the combinations that are lost, and the information that is left.

    The second is the least eigenvalue of S scaled, or where Cholesky's factorisation shows that
    all is well an estimate by the inverse's norm, at most the root of P times too small:
    for hundreds of parameters eigenvalues take ten times as long.
    """
    lapack = scipy.linalg.lapack
    empty = not len(reduced.unit)
    factor, failed = ([], 1) if empty else lapack.dpotrf(reduced.scaled.T, overwrite_a=True)
    if not failed and (np.diag(factor) ** 2 > _CLEAR).all():
        lower = lapack.dpotri(factor, overwrite_c=True)[0].T  # zero above the diagonal
        inverse = lower + lower.T
        inverse[np.diag_indices_from(inverse)] /= 2
        left = 1 / float(np.linalg.norm(inverse))
    else:
        values, vectors = information_left(reduced)
        kept = values > _RANK
        inverse = vectors[:, kept] / values[kept] @ vectors[:, kept].T
        left = float(values.min(initial=1.0))
    inverse *= reduced.unit
    inverse *= reduced.unit[:, None]
    return inverse, left


def pose_covariances(normal: NormalEquations, shared: Array, rvecs: Array, sigma2: float) -> Array:
    """(K, 6, 6) covariances of (rvec, tvec), rad and mm.

    Args:
        normal: at the solution.
        shared: (P, P) covariance of the free shared parameters.
        rvecs: (K, 3) rotation vectors of the poses.
        sigma2: variance of one residual coordinate.
    """
    local = np.asarray(np.linalg.inv(normal.V))
    for views in chunks(len(local)):
        G = local[views] @ np.swapaxes(normal.W[views], 1, 2)
        carried = np.tensordot(G, shared, axes=1)  # one product for all views
        local[views] = sigma2 * local[views] + carried @ np.swapaxes(G, 1, 2)
    J = pose_by_local(rvecs)
    return J @ local @ np.swapaxes(J, 1, 2)


def pose_by_local(rvecs: Array) -> Array:
    """(K, 6, 6) derivatives of (rvec, tvec) by the solver's local (w, tau), for rvecs (K, 3)."""
    J = np.zeros((len(rvecs), 6, 6))
    J[:, :3, :3] = rotations.rvec_by_local(rvecs)
    J[:, 3:, 3:] = np.eye(3)
    return J


def correlations(covariance: Array) -> Array:
    """Correlation matrix; NaN in rows of parameters that were held."""
    sd = np.sqrt(np.diag(covariance))
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(covariance / np.outer(sd, sd))


def paper_table(calibration: Calibration) -> tuple[Array, Array, Array]:
    """Table 2: the ten intrinsics in the paper's units, their one-sigma values and its SDs.

    Returns:
        Values, honest standard deviations sigma sqrt(diag((J^T J)^-1)) and the paper's
        sqrt(diag((2 J^T J)^-1)), each (10,) in the order of ``frames.PAPER_NAMES``.
    """
    camera = calibration.camera
    values, J = frames.paper_intrinsics(camera.params, camera.size)
    honest = np.sqrt(np.diag(J @ calibration.covariance @ J.T))
    return values, honest, honest / (np.sqrt(2) * calibration.noise)

"""Stage I: each view registered on the reference plane by itself (paper 4.2).

One view alone gives a first estimate of the lens: the centre and first coefficient of the
correction with which a homography maps its corners best to the board's grid. No other view, and no
focal length, is needed.

Unknowns of a view, z_r = (xp, yp, k1, a11, a21, a12, a22, d1, d2, c1, c2). With
dx = x - xp, dy = y - yp, r2 = dx^2 + dy^2 the corrected point is (eq. 31)

    psi1 = x + k1 r2 dx,      psi2 = y + k1 r2 dy

and the registered one (eq. 33), with P = c1 (psi1 - xp) + c2 (psi2 - yp) + 1,

    xi1 = (a11 psi1 + a12 psi2 + d1) / P,    xi2 = (a21 psi1 + a22 psi2 + d2) / P.

Levenberg-Marquardt (Marquardt 1963) minimises the sum of |xi - x'|^2 (eq. 34) from the DLT
homography and xp = yp = k1 = 0. The Jacobian is appendix B's, with a term
that its (B1) leaves out because P depends on xp and yp as well:

    d xi/dxp = [(a.1 - xi c1) dpsi1/dxp + (a.2 - xi c2) dpsi2/dxp + xi c1] / P   (yp: + xi c2).

All views iterate together as one batch, each with its own damping. Lengths are divided by
the spread of the points, without which k1 (1e-7 px^-2) would ruin the normal equations.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, IntArray
from calibgui.engine.calibration.refinement.schur import invert_roots
from calibgui.engine.geometry import homography
from calibgui.engine.kernels import with_kernel

_MAX_ITERATIONS = 50
"""Number of accepted and rejected steps together, at most."""
_TOLERANCE = 1e-10
"""Decrease of the cost that the linear model predicts, relative to the cost, below which the
iteration has converged."""
_MAX_DAMPING = 1e8
"""Damping, relative to the diagonal of J^T J, beyond which a view is given up."""
_MIN_INFORMATION = 1e-12
"""Eigenvalue of J^T J, relative to the largest, below which a combination of unknowns is open."""


@dataclass(frozen=True, eq=False, slots=True)
class StageOneRegistration:
    """Stage I of K views, in the paper's frame and units."""

    centre: Array
    """(K, 2) xp, yp, px."""
    k1: Array
    """(K,) px^-2."""
    forward: Array
    """(K, 3, 3) forward homographies (eq. 13): corrected image from the principal point to
    reference px."""
    spread: Array
    """(K, 3) standard deviations of xp, yp, k1."""
    rms: Array
    """(K,) root mean square length of the residual, reference px."""
    iterations: IntArray
    """(K,) number of iterations."""
    converged: BoolArray
    """(K,) true if the iteration converged."""


def register_views(xy: Array, reference: Array, mask: Array) -> StageOneRegistration:
    """Register every view on the reference plane.

    Args:
        xy: (K, N, 2) measured corners in the paper's frame, px.
        reference: (K, N, 2) the same corners x', y' on the reference plane, reference px.
        mask: (K, N) factor of each corner's residual: 1 for a corner, 0 for padding.
    """
    count = mask.sum(axis=1)
    s, s_ref = (
        np.sqrt((mask[:, None] @ points**2).sum(axis=(1, 2)) / count) for points in (xy, reference)
    )
    x, goal = xy / s[:, None, None], reference / s_ref[:, None, None]

    H = homography.fit_homography(x, goal, mask)
    z = np.zeros((len(x), 11))
    z[:, 3:] = H.reshape(-1, 9)[:, [0, 3, 1, 4, 2, 5, 6, 7]]  # in the order of z_r
    z, products, iterations, converged = minimise_registration(
        z, x, goal, mask, _MAX_ITERATIONS, _TOLERANCE, _MAX_DAMPING
    )
    normal, cost = products[:, :11, :11], products[:, 11, 11]

    xp, yp, k1, a11, a21, a12, a22, d1, d2, c1, c2 = z.T
    one, ratio = np.ones_like(xp), s_ref / s
    forward = np.array(
        [
            [a11 * ratio, a12 * ratio, (d1 + a11 * xp + a12 * yp) * s_ref],  # eq. 32
            [a21 * ratio, a22 * ratio, (d2 + a21 * xp + a22 * yp) * s_ref],
            [c1 / s, c2 / s, one],
        ]
    ).transpose(2, 0, 1)
    variance = cost / np.maximum(2 * count - 11, 1)
    inverse = np.diagonal(_invert_information(normal), axis1=1, axis2=2)
    spread = np.sqrt(variance[:, None] * inverse[:, :3])
    units = np.stack([s, s, s**-2], axis=1)
    return StageOneRegistration(
        centre=z[:, :2] * s[:, None],
        k1=k1 / s**2,
        forward=forward,
        spread=spread * units,
        rms=s_ref * np.sqrt(cost / count),
        iterations=iterations,
        converged=converged,
    )


def _invert_information(normal: Array) -> Array:
    """Return the inverses of J^T J (K, 11, 11), without the combinations that are open.

    Few corners or no perspective leave xp, yp, k1 open. Eigenvalues, which tell, take five times as
    long as inverses, whose norms show where none is that small.
    """
    try:
        roots = invert_roots(normal)
        inverse = np.swapaxes(roots, 1, 2) @ roots
    except np.linalg.LinAlgError:  # one is not positive definite, but for rounding errors
        inverse = np.full_like(normal, np.inf)
    ratio = 1 / (np.linalg.norm(normal, axis=(1, 2)) * np.linalg.norm(inverse, axis=(1, 2)))
    poor = ~(ratio > _MIN_INFORMATION)
    if poor.any():
        inverse[poor] = np.linalg.pinv(normal[poor], rcond=_MIN_INFORMATION, hermitian=True)
    return inverse


def measure_registration_error(first: StageOneRegistration, xy: Array, reference: Array) -> Array:
    """Return (K, N) the distance |xi - x'| between corners and grid after Stage I, reference px.

    Args:
        first: Stage I of these views.
        xy: (K, N, 2) as for `register_views`.
        reference: (K, N, 2) as for `register_views`.
    """
    d = xy - first.centre[:, None]
    corrected = d * (1 + first.k1[:, None, None] * np.sum(d**2, axis=-1, keepdims=True))
    return np.linalg.norm(
        homography.apply_homography(first.forward, corrected) - reference, axis=-1
    )


def register_points(z: Array, x: Array) -> tuple[Array, Array]:
    """Return xi of eq. 33 and its Jacobian.

    Args:
        z: (K, 11) unknowns z_r.
        x: (K, N, 2) measured points, paper's frame.

    Returns:
        (K, N, 2) registered points, (K, N, 2, 11) derivatives.
    """
    xp, yp, k1, a11, a21, a12, a22, d1, d2, c1, c2 = z.T[..., None]
    dx, dy = x[..., 0] - xp, x[..., 1] - yp
    r2 = dx**2 + dy**2
    psi1, psi2 = x[..., 0] + k1 * r2 * dx, x[..., 1] + k1 * r2 * dy
    P = c1 * (psi1 - xp) + c2 * (psi2 - yp) + 1
    xi1 = (a11 * psi1 + a12 * psi2 + d1) / P
    xi2 = (a21 * psi1 + a22 * psi2 + d2) / P

    psi_by = np.stack(  # (K, N, psi, by xp yp k1), eq. B2
        [
            np.stack([-k1 * (r2 + 2 * dx**2), -2 * k1 * dx * dy, r2 * dx], axis=-1),
            np.stack([-2 * k1 * dx * dy, -k1 * (r2 + 2 * dy**2), r2 * dy], axis=-1),
        ],
        axis=-2,
    )
    J = np.zeros((*x.shape, 11))
    for i, (xi, a1, a2) in enumerate(((xi1, a11, a12), (xi2, a21, a22))):
        by_psi = np.stack([a1 - xi * c1, a2 - xi * c2], axis=-1)
        J[..., i, :3] = (by_psi[..., None, :] @ psi_by)[..., 0, :]
        J[..., i, 0] += xi * c1
        J[..., i, 1] += xi * c2
        J[..., i, 3 + i] = psi1
        J[..., i, 5 + i] = psi2
        J[..., i, 7 + i] = 1.0
        J[..., i, 9] = -xi * (psi1 - xp)
        J[..., i, 10] = -xi * (psi2 - yp)
    return np.stack([xi1, xi2], axis=-1), J / P[..., None, None]


@with_kernel("stage_one", "minimise_registration")
def minimise_registration(
    z: Array,
    x: Array,
    goal: Array,
    mask: Array,
    max_iterations: int,
    tolerance: float,
    max_damping: float,
) -> tuple[Array, Array, IntArray, BoolArray]:
    """Minimise |xi - x'|^2 by Levenberg-Marquardt, all views as one batch.

    Args:
        z: (K, 11) unknowns to start from.
        x: (K, N, 2) measured points.
        goal: (K, N, 2) points to register them on.
        mask: (K, N) factors of the residuals.
        max_iterations: number of accepted and rejected steps, at most.
        tolerance: predicted decrease, relative to the cost, that has converged.
        max_damping: damping beyond which a view is given up.

    Returns:
        (K, 11) unknowns at the minimum, (K, 12, 12) products of the columns [J r] there, (K,)
        number of iterations, (K,) true if it converged.
    """
    z, K = z.copy(), len(z)
    damping = np.full(K, 1e-3)
    iterations = np.zeros(K, dtype=np.int64)
    converged = np.zeros(K, dtype=bool)
    active = np.arange(K)
    products = _sum_products(z, x, goal, mask)
    for _ in range(max_iterations):
        normal, gradient = products[active, :11, :11], products[active, :11, 11]
        cost = products[active, 11, 11]
        diagonal = np.diagonal(normal, axis1=1, axis2=2)
        damped = normal + (damping[active, None] * diagonal + 1e-14)[:, :, None] * np.eye(11)
        step = np.linalg.solve(damped, -gradient[..., None])[..., 0]
        predicted = -np.einsum("ki,ki->k", step, gradient)
        done = predicted <= tolerance * cost + 1e-28
        converged[active[done]] = True
        active, step = active[~done], step[~done]
        if active.size == 0:
            break
        trial = z[active] + step
        new = _sum_products(trial, x[active], goal[active], mask[active])
        iterations[active] += 1
        better = new[:, 11, 11] < products[active, 11, 11]
        won = active[better]
        z[won], products[won] = trial[better], new[better]
        damping[won] = np.maximum(damping[won] / 10, 1e-12)
        damping[active[~better]] *= 10
        active = active[damping[active] <= max_damping]
    return z, products, iterations, converged


def _sum_products(z: Array, x: Array, goal: Array, mask: Array) -> Array:
    """Return (K, 12, 12) products of the columns [J r] of each view."""
    with np.errstate(all="ignore"):  # a wild trial step overflows and is rejected by its cost
        xi, J = register_points(z, x)
        columns = np.concatenate([J, (xi - goal)[..., None]], axis=-1) * mask[..., None, None]
        columns = columns.reshape(len(z), -1, 12)
        return np.swapaxes(columns, 1, 2) @ columns

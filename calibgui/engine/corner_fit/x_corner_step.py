"""The Gauss-Newton step of the fit of crossing edges, at all corners of a board at once.

The light's gradients are taken from the whole board (`board_priors`), or they are unknowns of every
corner, too (`light_gradients`).

**Blur.** What tells the blurs of a corner's two edges apart is mostly the camera's, and one corner
would otherwise take up what the model leaves out. A camera's blur, and that of a motion, is one for
the neighbourhood of every corner: with the covariance Sigma = s^2 I + D of its spread, D symmetric
and free of trace, the edge with normal n_i is blurred by s_i^2 = s^2 + n_i^T D n_i. The size s
varies with the focus over the board; the anisotropy D is taken to be one, and is the least-squares
solution of

    s_1^2 - s_2^2 = n_1^T D n_1 - n_2^T D n_2

over all corners. The difference of a corner's blurs is held near it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, IntArray, compute_median
from calibgui.engine.corner_fit.x_corner_model import (
    BLUR,
    MIN_BLUR,
    RHO,
    THETA,
    UNKNOWNS,
    C,
    XCornerModel,
    compute_normals,
)

_MAX_RHO = 0.95
"""Largest correlation rho of the two edges."""
_RHO_SIGMA = 0.3
"""Standard deviation of rho around that of a blur alike in all directions."""
_BLUR_DIFFERENCE_SIGMA = 0.03
"""Standard deviation of the difference of a corner's two blurs around what the board shows,
blurs."""
DAMPING = 1e-9, 1e-15
"""What is added to the diagonal of the normal equations, over its own entries, and the least that
one counts as for that, over the largest one: an edge may have no pixel. Entries by the edges'
directions grow with the cube of the arms: what is added over the largest one would hold the grey
levels of large squares where they are."""
_ORDER = np.arange(UNKNOWNS + 1)
"""Columns of the normal equations that a step takes, the residual last ..."""
_LIT_ORDER = np.r_[:UNKNOWNS, UNKNOWNS + 1 : UNKNOWNS + 5, UNKNOWNS]
"""... and where the light's gradients are unknowns, too."""


def take_step(model: XCornerModel, products: Array) -> tuple[XCornerModel, Array, Array]:
    """Take one Gauss-Newton step.

    Args:
        model: at n corners.
        products: (n, 10, 10), or more that are not used, see `accumulate_normal_equations`.

    Returns:
        The model after it, the part (n, 2, 2) of the equations' inverse for c, and the mean square
        (n,) of what is left unexplained.
    """
    unknowns, inverse, square = _apply_limits(model.unknowns, products, _ORDER)
    return replace(model, unknowns=unknowns), inverse, square


def take_lit_step(model: XCornerModel, products: Array) -> tuple[XCornerModel, Array, Array]:
    """Take one step, as `take_step`, that changes the gradients gm and ga of every corner as well,
    given the `products` (n, 14, 14)."""
    x = np.column_stack([model.unknowns, model.level_gradient, model.contrast_gradient])
    x, inverse, square = _apply_limits(x, products, _LIT_ORDER)
    level, contrast = x[:, UNKNOWNS : UNKNOWNS + 2], x[:, UNKNOWNS + 2 :]
    lit = replace(model, unknowns=x[:, :UNKNOWNS], level_gradient=level, contrast_gradient=contrast)
    return lit, inverse, square


def _apply_limits(unknowns: Array, products: Array, order: IntArray) -> tuple[Array, Array, Array]:
    """Return `_step_unknowns` within the limits in use."""
    return _step_unknowns(
        unknowns,
        products,
        order,
        *DAMPING,
        _RHO_SIGMA,
        _BLUR_DIFFERENCE_SIGMA,
        _MAX_RHO,
        MIN_BLUR,
    )


@kernels.with_kernel("x_corner_step", "step_unknowns")
def _step_unknowns(
    unknowns: Array,
    products: Array,
    order: IntArray,
    damping: float,
    least_entry: float,
    rho_sigma: float,
    blur_difference_sigma: float,
    max_rho: float,
    min_blur: float,
) -> tuple[Array, Array, Array]:
    """Take one Gauss-Newton step from the `unknowns` (n, m), the nine of the model and, it may be,
    others after them.

    Args:
        unknowns: of every corner.
        products: (n, k, k) of columns among which are [J r].
        order: (m + 1,) the numbers of these.
        damping: what is added to the diagonal of the equations, over its own entries.
        least_entry: least that these count as, over the largest one.
        rho_sigma: standard deviation of rho around that of an isotropic blur.
        blur_difference_sigma: standard deviation of the blurs' difference around what the board
            shows, blurs.
        max_rho: largest rho.
        min_blur: least blur, px.

    Returns:
        The unknowns (n, m) after it, the part (n, 2, 2) of the equations' inverse for c, and the
        mean square (n,) of what is left unexplained.
    """
    m = unknowns.shape[1]
    products = products[:, order[:, None], order]
    N, g = products[:, :m, :m].copy(), products[:, :m, m].copy()
    squares = products[:, m, m]
    count = np.maximum(N[:, 6, 6], 1.0)  # the derivative by m is 1; there may be no pixel
    normals, blurs = compute_normals(unknowns[THETA]), unknowns[BLUR]
    # In a sharp image few pixels depend on rho: it stays near that of an isotropic blur.
    weight = squares / count / rho_sigma**2
    N[:, 8, 8] += weight
    g[:, 8] += weight * (np.sum(normals[:, 0] * normals[:, 1], axis=1) - unknowns[RHO])
    difference = np.array([1.0, -1.0])  # by the blurs
    variance = blur_difference_sigma**2 * np.mean(blurs**2, axis=1)
    weight = compute_median(squares / count) / variance
    N[:, 4:6, 4:6] += weight[:, None, None] * np.outer(difference, difference)
    lack = estimate_blur_difference(normals, blurs) - blurs @ difference
    g[BLUR] += (weight * lack)[:, None] * difference

    entries = np.einsum("nkk->nk", N)
    largest = entries.max(axis=1, keepdims=True) + 1e-300
    added = damping * np.maximum(entries, least_entry * largest)
    inverse = np.linalg.inv(N + added[..., None] * np.eye(m))
    step = np.einsum("nij,nj->ni", inverse, g)
    square = np.maximum(squares - np.sum(step * g, axis=1), 0.0) / np.maximum(count - m, 1)
    return unknowns + _limit_step(step, unknowns, max_rho, min_blur), inverse[:, :2, :2], square


def _limit_step(step: Array, x: Array, max_rho: float, min_blur: float) -> Array:
    """Limit a Gauss-Newton step (n, m) from `x` (n, m) to where the linear model may hold."""
    limited = np.array(step)
    limited[C] = np.clip(step[C], -1.0, 1.0)
    limited[THETA] = np.clip(step[THETA], -0.1, 0.1)
    s, rho = x[BLUR], x[RHO]
    limited[BLUR] = np.clip(step[BLUR], np.maximum(-s / 3, min_blur - s), s / 2)
    limited[RHO] = np.clip(step[RHO], -max_rho - rho, max_rho - rho)
    return limited


def estimate_blur_difference(normals: Array, blurs: Array) -> Array:
    """Estimate the difference s_1 - s_2 (n,) px that one anisotropy gives the corners of a board.

    Args:
        normals: (n, 2, 2) unit normals n_1, n_2 of the edges.
        blurs: (n, 2) s_1, s_2 as they were measured, px.
    """
    x, y = np.moveaxis(normals, -1, 0)
    # n^T D n = D_uu (x^2 - y^2) + 2 D_uv x y
    by_edge = np.stack([x**2 - y**2, 2 * x * y], axis=-1)
    by_corner = by_edge[:, 0] - by_edge[:, 1]
    squares = blurs[:, 0] ** 2 - blurs[:, 1] ** 2
    D = np.linalg.lstsq(by_corner, squares)[0]
    return np.asarray(by_corner @ D / blurs.sum(axis=1))

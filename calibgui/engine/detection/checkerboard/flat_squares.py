"""What the squares around a corner, away from their edges, say of the light.

The gradients gm and ga (`x_corner_model`) pull at a corner the more the longer its arms are. Near
the edges they are hard to tell from a displacement, and the board as a whole says little of them
where the light varies from square to square. Away from the edges nothing depends on the corner, and
the grey level is plainly

    I(q) = m + gm.q + p' (a + ga.q),        p' = p G = +-1,

so that all that is left of the squares' quarters around the corner tells m, a, gm and ga. Their
pixels, far more than those near the edges, are read as means over cells of k x k of them, which
miss none of it: light hardly varies over a cell.

What lies on a square, or ends there, such as a finger or a shadow, is no gradient. Where the model
leaves more unexplained than noise does, its products count the less.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, GreyImage, IntArray
from calibgui.engine.detection.checkerboard.x_corner_model import (
    UNKNOWNS,
    A,
    C,
    M,
    XCornerModel,
)

_CELLS_PER_ARM = 6
"""Number of cells along an arm."""
_MIN_CELLS = 12
"""Least number of cells from which something is read: the light has six unknowns."""
_LIGHT = 6
"""Number of columns by the light's unknowns: 1, p', q, p' q; the residual follows."""
_COLUMNS = np.r_[6, 7, UNKNOWNS + 1 : UNKNOWNS + 5, UNKNOWNS]
"""Places of these columns among those of the normal equations."""
_DAMPING = 1e-12
"""Part of their largest entry that the diagonal of the light's equations is raised by: a corner may
have all its cells on one side."""
_HALF_DIAGONAL = 0.5**0.5
"""Distance of a cell's corners from its centre, cells."""


def read_flat_squares(image: GreyImage, model: XCornerModel, noise: Array) -> Array:
    """Read what lies between the edges, as products like those of the edges' pixels.

    Args:
        image: (h, w) grey levels.
        model: at n corners of plain squares.
        noise: (n,) square of the noise, grey levels^2.

    Returns:
        (n, 14, 14) the products, to be added to those of `accumulate_normal_equations` of the same
        model; 0 by all unknowns but m, a, gm and ga.
    """
    side = np.maximum(model.arm.min(axis=1) // _CELLS_PER_ARM, 1).astype(np.int64)
    light = np.column_stack(
        [model.unknowns[M], model.unknowns[A], model.level_gradient, model.contrast_gradient]
    )
    sums, cells = _sum_cells(
        image, model.unknowns[C].copy(), model.find_support().pack(), model.sign, light, side
    )
    products = np.zeros((len(sums), UNKNOWNS + 5, UNKNOWNS + 5))
    told = np.flatnonzero(cells >= _MIN_CELLS)
    if not len(told):
        return products
    N, g = sums[told, :_LIGHT, :_LIGHT], sums[told, :_LIGHT, _LIGHT]
    damped = N + _DAMPING * N.max(axis=(1, 2))[:, None, None] * np.eye(_LIGHT)
    solution = np.linalg.solve(damped, g[..., None])[..., 0]
    unexplained = sums[told, _LIGHT, _LIGHT] - np.sum(solution * g, axis=1)
    square = unexplained / (cells[told] - _LIGHT)
    weight = np.minimum(noise[told] / np.maximum(square, 1e-300), 1.0)
    block = np.ix_(told, _COLUMNS, _COLUMNS)
    products[block] = weight[:, None, None] * sums[told]
    return products


@kernels.with_kernel("flat_squares", "sum_cells")
def _sum_cells(
    image: GreyImage, uv: Array, bands: Array, sign: Array, light: Array, side: IntArray
) -> tuple[Array, IntArray]:
    """Sum the products of the columns 1, p', q, p' q and the residual over the cells between the
    edges, times the pixels of a cell.

    Args:
        image: (h, w) grey levels.
        uv: (n, 2) the corners, px.
        bands: (n, 2, 7) of their edges, see `EdgeSupport.pack`.
        sign: (n,) p.
        light: (n, 6) m, a, gm and ga.
        side: (n,) number of pixels along a cell.

    Returns:
        (n, 7, 7) the sums, and (n,) the numbers of cells.
    """
    sums, cells = np.zeros((len(uv), _LIGHT + 1, _LIGHT + 1)), np.zeros(len(uv), np.int64)
    limit = np.array(image.shape[::-1]) - 1
    for i, k in enumerate(side):
        tangent, normal = bands[i, :, 0:2], bands[i, :, 2:4]
        curvature, arm, width = bands[i, :, 4:].T
        middle = np.rint(uv[i]).astype(np.int64)
        reach = int(np.ceil((abs(tangent) * arm[:, None]).sum(axis=0).max() / k))
        steps = np.arange(-reach, reach + 1) * k
        first = middle + np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
        q = first + (k - 1) / 2 - uv[i]
        s, d = q @ tangent.T, q @ normal.T
        d -= curvature / 2 * s * s
        is_flat = (abs(s) <= arm).all(axis=1) & (abs(d) > width + _HALF_DIAGONAL * k).all(axis=1)
        is_flat &= (first >= 1).all(axis=1) & (first + k <= limit).all(axis=1)
        q, first = q[is_flat], first[is_flat]
        cells[i] = len(q)
        pattern = sign[i] * np.sign(d[is_flat]).prod(axis=1)
        inside = first[:, None, None] + np.stack(np.meshgrid(*[np.arange(k)] * 2), axis=-1)
        grey = image[inside[..., 1], inside[..., 0]].mean(axis=(1, 2), dtype=np.float64)
        J = np.column_stack([np.ones(len(q)), pattern, q, pattern[:, None] * q])
        J = np.column_stack([J, grey - J @ light[i]])
        sums[i] = J.T @ J * k * k
    return sums, cells

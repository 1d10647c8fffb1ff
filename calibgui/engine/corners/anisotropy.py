"""How much the blurs of a corner's two edges differ, from the whole board.

A camera's blur, and that of a motion, is one for the neighbourhood of every corner: with the
covariance Sigma = s^2 I + D of its spread, D symmetric and free of trace, the edge with normal n_i
is blurred by s_i^2 = s^2 + n_i^T D n_i. The size s varies with the focus over the board; the
anisotropy D is taken to be one, and is the least-squares solution of

    s_1^2 - s_2^2 = n_1^T D n_1 - n_2^T D n_2

over all corners.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.types import Array


def difference(normals: Array, blurs: Array) -> Array:
    """(n,) the difference s_1 - s_2 that the corners of a board have in common, px.

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

"""The region of interest: four points at the board's outermost corners (paper 4.1, figure 6).

The points bound the search. If the board is too damaged to be found there, they still say where
it is: the homography H that takes the unit square to them,

    (u, v, 1) ~ H (s, t, 1),

places the M x N corners at (s, t) = (n / (N - 1), m / (M - 1)), near enough for the refinement
to find the real ones unless the lens distorts strongly.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, BoolArray, GridSize
from calibgui.engine.features.lattice import Lattice

_MARGIN = 0.08
"""Distance that corners may lie outside the marked points, over the size of the region."""


def check_outline(points: npt.ArrayLike) -> Array:
    """Check four marked points (4, 2) px and order them in the sense from u to v, the first first.

    Raises:
        ValueError: they do not bound a convex quadrilateral.
    """
    quad = np.array(points, dtype=np.float64)
    if quad.shape != (4, 2) or not np.isfinite(quad).all():
        raise ValueError("a region of interest is four points (u, v)")
    edge = np.roll(quad, -1, axis=0) - quad
    after = np.roll(edge, -1, axis=0)
    turn = edge[:, 0] * after[:, 1] - edge[:, 1] * after[:, 0]
    if (turn < 0).all():
        return quad[[0, 3, 2, 1]]
    if (turn > 0).all():
        return quad
    raise ValueError("the four points must go once around a convex region, none on a side")


def enlarge_outline(quad: Array) -> Array:
    """Enlarge `quad` (4, 2) px about its centre, so that corners at the marks are inside."""
    centre = quad.mean(axis=0)
    return centre + (1 + 2 * _MARGIN) * (quad - centre)


def are_inside(outline: Array, uv: Array) -> BoolArray:
    """Return a mask (n,) of the points `uv` (n, 2) that lie inside the convex `outline` (m, 2)."""
    edge = np.roll(outline, -1, axis=0) - outline
    to = uv[:, None] - outline
    side = edge[:, 0] * to[..., 1] - edge[:, 1] * to[..., 0]
    return np.asarray((side >= 0).all(axis=1) | (side <= 0).all(axis=1))


def guess_lattices(quad: Array, grid_size: GridSize) -> list[Lattice]:
    """Place a board's corners by the homography of its four outermost ones, `quad` (4, 2) px.

    Returns:
        Both ways to lay rows and columns, one if there are as many. Their first squares are
        called dark; which of them are is left to be tried.
    """
    sizes = [grid_size] if grid_size[0] == grid_size[1] else [grid_size, grid_size[::-1]]
    H = _solve_square_homography(quad)
    lattices = []
    for rows, cols in sizes:
        t, s = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, 1, cols), indexing="ij")
        q = np.stack([s, t, np.ones_like(s)], axis=-1) @ H.T
        lattices.append(Lattice(q[..., :2] / q[..., 2:], dark=True))
    return lattices


def _solve_square_homography(quad: Array) -> Array:
    """Return the (3, 3) homography that takes (0,0), (1,0), (1,1), (0,1) to the points of `quad`
    (4, 2), in closed form (Heckbert 1989)."""
    p0, p1, p2, p3 = quad
    d1, d2, d3 = p1 - p2, p3 - p2, p0 - p1 + p2 - p3
    g, h = np.linalg.solve(np.column_stack([d1, d2]), d3)
    return np.column_stack(
        [np.append(p1 - p0 + g * p1, g), np.append(p3 - p0 + h * p3, h), np.append(p0, 1.0)]
    )


def find_outline(lattice: Lattice) -> Array:
    """Return the (4, 2) px outline of a lattice: its four corners, or what there is nearest to
    them by rows and columns."""
    cells = np.argwhere(lattice.found)
    uv = lattice.uv[cells[:, 0], cells[:, 1]]
    rows, cols = np.array(lattice.shape) - 1
    ends = np.array([(0, 0), (0, cols), (rows, cols), (rows, 0)])
    nearest = np.argmin(np.abs(cells[:, None] - ends).sum(axis=2), axis=0)
    return np.asarray(uv[nearest])


def starts_at(lattice: Lattice, point: Array) -> bool:
    """Return whether the first of a lattice's four corners is that nearest to `point` (2,) px."""
    return int(np.argmin(np.linalg.norm(find_outline(lattice) - point, axis=1))) == 0

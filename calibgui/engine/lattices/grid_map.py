"""The map from the cells of a plane grid to the image: homography, radial lens, smooth residual.

A detector knows the places of some points of a grid in the image and needs to predict the others,
or the map's derivatives at every point, before any camera is known. The map is the sum of three
parts, each for what the former leaves:

    uv = u(H (col, row)) + p(col, row).

**Homography and radial lens** (`RadialHomography`). The homography H takes the cell (col, row) to
the ideal point e, px from the lens's centre c. Wide-angle lenses bend straight lines so much that
polynomials of the cell follow badly; three coefficients of a radial lens follow most of it, from
the point d = u - c in the image by

    e = k d,   k = 1 / (1 + l1 r + l2 r^2 + l3 r^3),   r = |d|^2.

With l1 alone (the division model: Fitzgibbon 2001) (d, 1 / k) is linear in (|u|^2, u, v, 1), and so
is the cell,

    (col, row, 1) ~ M (|u|^2, u, v, 1),

which is solved like a homography's equations. With A = H^-1, of columns a1 to a3, M consists of
m0 = l1 a3, m1 = a1 - 2 cu m0, m2 = a2 - 2 cv m0 and

    m3 = (1 / l1 - |c|^2) m0 - cu m1 - cv m2,

three equations that give c and l1. From there Gauss-Newton steps lead to the least squares of the
distances in the image, all coefficients free. The lens is kept only if it explains most of what the
homography alone leaves.

A fisheye sees beyond 90 degrees from its axis. There 1 / k is negative, e lies on the other side of
c, and w, the last of H (col, row, 1), is negative as well: with the sign of H chosen so that it is
positive on the axis' side, that of w tells which of the two points that e may stand for is seen.

**Smooth residual**. What the lens bends otherwise is small and smooth: a polynomial p of low degree
in column and row. `GridMap` fits it to a lattice with gaps and reaches over these, where a corner
has no neighbours left to predict it. `compute_polynomial_terms` also serves those that need its
derivatives: the polynomials over a checkerboard (``checkerboard/board_priors.py``) and over a grid
of circles (``circles/circle_map.py``).

None of this measures a camera: centre and coefficients of the lens take up whatever fits.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.geometry import homography

_MIN_RELATIVE_MISFIT = 0.005
"""Rms distance of points from their homography, over that from their mean, below which no lens is
fitted."""
_MAX_MISFIT_RATIO = 0.5
"""Greatest ratio of the rms distance that a lens leaves to that without one at which it is kept."""
MIN_LENS_POINTS = 16
"""Least number of points that a lens of three coefficients is fitted to."""
_MIN_EXACT_POINTS = 9
"""The same of exact points: the corners of the smallest board."""
_MIN_EXACT_MISFIT = 0.0007
"""The misfit of exact points below which no lens is fitted, as `_MIN_RELATIVE_MISFIT`. With 0.0001
corners are no better."""
_MAX_LENS_POINTS = 400
"""Number of points, spread over the grid, that a lens is fitted to."""
_COEFFICIENTS = 3
"""Number of the lens's coefficients l1 to l3."""
_GAUSS_NEWTON_STEPS = 3
"""Number of steps from the closed solution to the least squares."""
_INVERSION_STEPS = 5
"""Number of Newton's steps from an ideal point to the point in the image."""
_DAMPING = 1e-13
"""What is added to the diagonal of equations, over its sum."""
_MIN_POINTS_OF_DEGREE = np.array([(1, 16), (2, 20), (3, 26), (4, 45)])
"""Degrees of a lattice's smooth residual, and the least number of corners for each; with fewer than
16 it is constant."""


@dataclass(frozen=True, eq=False, slots=True)
class RadialHomography:
    """A homography seen through a radial lens."""

    H: Array
    """(3, 3) from cells (col, row) to ideal points, px from the centre; its sign is such that w,
    the last coordinate, is positive up to 90 degrees from the lens's axis, negative beyond."""
    centre: Array
    """(2,) centre of the lens, px."""
    coefficients: Array
    """(3,) l1 to l3 of the lens, 1/px^2, 1/px^4 and 1/px^6; all 0 if there is no lens."""

    def locate(self, cells: Array) -> Array:
        """Compute positions (n, 2) px of the cells (n, 2) = (col, row)."""
        return _locate_cells(self.H, self.centre, self.coefficients, cells, _INVERSION_STEPS)

    def distort(self, e: Array, w: Array) -> Array:
        """Compute positions (n, 2) px of ideal points.

        Args:
            e: (n, 2) px from the centre.
            w: (n,) their last coordinates, negative where they lie beyond 90 degrees.
        """
        return self.centre + self._invert_lens(e, w)

    def differentiate(self, cells: Array) -> tuple[Array, Array]:
        """Compute first and second derivatives (n, 2, 2) of `locate` by column and by row.

        The first axis after n is that of the cell, the last that of the image.
        """
        return _differentiate_map(self.H, self.coefficients, cells, _INVERSION_STEPS)

    def differentiate_lens(self, e: Array, w: Array) -> tuple[Array, Array]:
        """Compute D' (n, 2, 2) and D'' (n, 2, 2, 2) of `distort` by the ideal points `e` (n, 2) of
        last coordinates `w` (n,).

        Those of its inverse e = E(d) = k d are, with k' and k'' by r,

            E_i,j = k 1_ij + 2 k' d_i d_j
            E_i,jk = 4 k'' d_i d_j d_k + 2 k' (1_ij d_k + 1_ik d_j + 1_jk d_i),

        1_ij being 1 where i = j and else 0. From E(D(e)) = e follow D' = E'^-1 and
        D'' = -D' E''(D', D').
        """
        return _differentiate_lens(self._invert_lens(e, w), self.coefficients)

    def _invert_lens(self, e: Array, w: Array) -> Array:
        """Compute d (n, 2) px from the centre, where it shows ideal points: `_invert_lens`."""
        if not self.coefficients.any():
            return e
        return _invert_lens(e, w, self.coefficients, _INVERSION_STEPS)


@kernels.with_kernel("grid_map", "locate_cells")
def _locate_cells(H: Array, centre: Array, coefficients: Array, cells: Array, steps: int) -> Array:
    """Compute positions (n, 2) px of cells (n, 2) by the map of `RadialHomography`, the lens
    inverted in so many `steps`."""
    e = homography.apply_homography(H, cells)
    if coefficients.any():
        e = _invert_lens(e, _compute_last(H, cells), coefficients, steps)
    return np.asarray(centre + e)


@kernels.with_kernel("grid_map", "differentiate_map")
def _differentiate_map(
    H: Array, coefficients: Array, cells: Array, steps: int
) -> tuple[Array, Array]:
    """Compute `RadialHomography.differentiate`, the lens inverted in so many `steps`.

    With e = a / w, a and w linear in the cell, e' = (a' - e w') / w and e'' = -2 e' w' / w.
    Through the lens u' = D' e' and u'' = D' e'' + D''(e', e').
    """
    e, last = homography.apply_homography(H, cells), _compute_last(H, cells)
    w = last[:, None, None]
    e1 = (H[:2, :2].T - e[:, None] * H[2, :2, None]) / w
    e2 = -2 * e1 * H[2, :2, None] / w
    if not coefficients.any():
        return e1, e2
    D1, D2 = _differentiate_lens(_invert_lens(e, last, coefficients, steps), coefficients)
    second = np.einsum("nijk,naj,nak->nai", D2, e1, e1)
    return np.einsum("nij,naj->nai", D1, e1), np.einsum("nij,naj->nai", D1, e2) + second


def _compute_last(H: Array, cells: Array) -> Array:
    """Compute w (n,), the last coordinates of the ideal points of cells (n, 2) = (col, row)."""
    return np.asarray(cells @ H[2, :2] + H[2, 2])


def _differentiate_lens(d: Array, coefficients: Array) -> tuple[Array, Array]:
    """Compute `RadialHomography.differentiate_lens` where the lens shows `d` (n, 2) px."""
    k, by_r, by_r2 = _compute_scale(np.sum(d * d, axis=1), coefficients)
    one = np.eye(2)
    first = k[:, None, None] * one + 2 * by_r[:, None, None] * d[:, :, None] * d[:, None]
    mixed = one[:, :, None] * d[:, None, None]
    mixed = mixed + mixed.transpose(0, 1, 3, 2) + mixed.transpose(0, 3, 1, 2)
    cubic = np.einsum("ni,nj,nk->nijk", d, d, d)
    second = 4 * by_r2[:, None, None, None] * cubic + 2 * by_r[:, None, None, None] * mixed
    D1 = np.asarray(np.linalg.inv(first), dtype=np.float64)
    D2 = -np.einsum("nil,nlab,naj,nbk->nijk", D1, second, D1, D1, optimize=True)
    return D1, np.asarray(D2)


@kernels.with_kernel("grid_map", "invert_lens")
def _invert_lens(e: Array, w: Array, coefficients: Array, steps: int) -> Array:
    """Compute d (n, 2) px from the centre, where a lens shows the ideal points `e` (n, 2) of last
    coordinates `w` (n,).

    Newton's steps on |d| = |e| / k lead there from where l1 alone would show them. Beyond 90
    degrees, which only l1 < 0 reaches, |e| counts as negative, as k is.
    """
    l1, l2, l3 = coefficients
    far = np.linalg.norm(e, axis=1)
    beyond = (w < 0) & (l1 < 0)
    far[beyond] *= -1
    root = 1 + np.sqrt(np.maximum(1 - 4 * l1 * far**2, 0.0))
    x = 2 * far / root
    x[beyond] = root[beyond] / (2 * l1 * far[beyond])
    with np.errstate(all="ignore"):  # beyond where the lens reaches
        for _ in range(steps):
            r = x * x
            inverse = 1 + r * (l1 + r * (l2 + r * l3))
            slope = 2 * x * (l1 + r * (2 * l2 + r * 3 * l3))
            x = x - (x - far * inverse) / (1 - far * slope)
    return np.asarray(e * (x / np.where(far == 0, 1.0, far))[:, None])


def _compute_scale(r: Array, coefficients: Array) -> tuple[Array, Array, Array]:
    """Compute k and its first and second derivatives by r, each (n,)."""
    l1, l2, l3 = coefficients
    inverse = 1 + r * (l1 + r * (l2 + r * l3))
    by_r, by_r2 = l1 + r * (2 * l2 + r * 3 * l3), 2 * l2 + 6 * l3 * r
    k = 1 / inverse
    return k, -by_r * k**2, (2 * by_r**2 * k - by_r2) * k**2


def fit_radial_homography(
    cells: Array, uv: Array, are_exact: bool = False, is_start: bool = False
) -> RadialHomography:
    """Fit a homography, with a radial lens if that leaves much less.

    Args:
        cells: (n, 2) = (col, row).
        uv: (n, 2) px, where they are seen.
        are_exact: whether they are known to a fraction of a pixel, so that a lens is worth its time
            for less misfit and with fewer points. Of fewer than 16 it has one coefficient.
        is_start: whether one coefficient is enough of any points, as the map will be refined.
    """
    least, relative = (
        (_MIN_EXACT_POINTS, _MIN_EXACT_MISFIT)
        if are_exact
        else (MIN_LENS_POINTS, _MIN_RELATIVE_MISFIT)
    )
    steps = 0 if is_start or len(uv) < MIN_LENS_POINTS else _GAUSS_NEWTON_STEPS
    return RadialHomography(
        *_fit_map(
            cells,
            uv,
            least,
            relative,
            _MAX_MISFIT_RATIO,
            _MAX_LENS_POINTS,
            steps,
            _INVERSION_STEPS,
            _DAMPING,
        )
    )


@kernels.with_kernel("grid_map", "fit_map")
def _fit_map(
    cells: Array,
    uv: Array,
    min_points: int,
    min_misfit: float,
    max_ratio: float,
    max_points: int,
    steps: int,
    inversion_steps: int,
    damping: float,
) -> tuple[Array, Array, Array]:
    """Fit the map of `fit_radial_homography`.

    Args:
        cells: (n, 2) = (col, row).
        uv: (n, 2) px.
        min_points: least number of points that a lens is fitted to.
        min_misfit: misfit without a lens, over the spread of the points, that one is fitted for.
        max_ratio: of the misfit with a lens to that without at which the lens is kept.
        max_points: number of points, spread over the grid, that a lens is fitted to.
        steps: of Gauss and Newton from the closed solution; 0 for that itself.
        inversion_steps: of Newton to invert the lens.
        damping: what is added to the diagonal of equations, over its sum.

    Returns:
        The homography, the lens's centre and its coefficients, as `RadialHomography`.
    """
    plain = fit_plain_homography(cells, uv)
    without = plain.H, plain.centre, plain.coefficients
    misfit = _rms(_locate_cells(*without, cells, inversion_steps) - uv)
    if len(uv) < min_points or misfit < min_misfit * _rms(uv - uv.mean(axis=0)):
        return without
    count = min(len(uv), max_points)
    chosen = np.arange(count) * (len(uv) - 1) // (count - 1)
    (x, mean, scale), (u, origin, unit) = _normalise(cells[chosen]), _normalise(uv[chosen])
    try:
        inverse = _solve_division_model(x, u, damping)
        bent = (_refine_lens(x, u, inverse, steps, damping) if steps else inverse).invert(u)
    except np.linalg.LinAlgError:
        return without
    # Not finite is not better.
    seen = _locate_cells(bent.H, bent.centre, bent.coefficients, x, inversion_steps)
    if not unit * _rms(seen - u) < max_ratio * misfit:
        return without
    to_normal = np.diag([1 / scale, 1 / scale, 1.0])
    to_normal[:2, 2] = -mean / scale
    return (
        np.diag([unit, unit, 1.0]) @ bent.H @ to_normal,
        origin + unit * bent.centre,
        bent.coefficients / unit ** np.arange(2.0, 2 * _COEFFICIENTS + 1, 2),
    )


def fit_plain_homography(cells: Array, uv: Array) -> RadialHomography:
    """Fit a homography without a lens to cells (n, 2) = (col, row) seen at `uv` (n, 2) px."""
    H = homography.fit_homography(cells, uv, np.ones(len(uv)))
    return RadialHomography(H, np.zeros(2), np.zeros(_COEFFICIENTS))


def _solve_division_model(x: Array, u: Array, damping: float) -> InverseRadialHomography:
    """Solve for the lens with one coefficient in closed form (Fitzgibbon 2001).

    Args:
        x: (n, 2) cells, normalised.
        u: (n, 2) their positions, normalised.
        damping: as in `_fit_map`.

    Raises:
        numpy.linalg.LinAlgError: the equations have no solution.
    """
    lifted = np.column_stack([np.sum(u * u, axis=1), u, np.ones(len(u))])
    S, Sx, Sy, Sq = (
        (lifted * factor[:, None]).T @ lifted
        for factor in (np.ones(len(x)), x[:, 0], x[:, 1], np.sum(x * x, axis=1))
    )
    # For a given third row of M the others follow: it is an eigenvector, as in the equations of a
    # homography (Hartley 1997).
    inverse = np.linalg.inv(S + damping * np.trace(S) * np.eye(4))
    third = np.linalg.eigh(Sq - Sx @ inverse @ Sx - Sy @ inverse @ Sy)[1][:, 0]
    M = np.stack([inverse @ Sx @ third, inverse @ Sy @ third, third])
    a, *minus_centre = np.linalg.solve(M[:, :3], M[:, 3])
    centre = -np.array(minus_centre)
    l1 = 1 / (a + centre @ centre)
    A = np.column_stack([M[:, 1:3] + 2 * np.outer(M[:, 0], centre), M[:, 0] / l1])
    return InverseRadialHomography(A, centre, np.array([l1, 0.0, 0.0]))


def _refine_lens(
    x: Array, u: Array, start: InverseRadialHomography, steps: int, damping: float
) -> InverseRadialHomography:
    """Refine a map of cells `x` (n, 2) by least squares of the distances from `u` (n, 2), both
    normalised, in so many `steps`.

    The cell that a point u shows is compared with the given one; its derivative by u takes the
    difference to the image.

    Raises:
        numpy.linalg.LinAlgError: the equations become singular; or what it returns is not finite.
    """
    inverse = start._replace(A=start.A / np.linalg.norm(start.A))
    for _ in range(steps):
        cell, by_u, J = inverse.differentiate(u)
        both = np.linalg.solve(by_u, np.concatenate([J, (cell - x)[..., None]], axis=2))
        inverse = inverse.take_step(
            both[..., :-1].reshape(2 * len(x), -1), both[..., -1].ravel(), damping
        )
    return inverse


class InverseRadialHomography(NamedTuple):
    """The cells that points show: q / w, (q, w) = A v, v = (d, 1 / k)."""

    A: Array
    """(3, 3)"""
    centre: Array
    """(2,) of the lens."""
    bend: Array
    """(k,) l1 to l3, and more where these do not reach."""

    def differentiate(self, u: Array) -> tuple[Array, Array, Array]:
        """Compute the cells (n, 2) of points `u` (n, 2), and their derivatives by these (n, 2, 2)
        and by the parameters (n, 2, 11 + k): A row by row, centre, bend."""
        A, k = self.A, np.arange(1, len(self.bend) + 1)
        d = u - self.centre
        r = np.sum(d * d, axis=1)
        powers = r[:, None] ** k
        slope = (r[:, None] ** (k - 1) * k) @ self.bend
        v = np.column_stack([d, 1 + powers @ self.bend])
        q = v @ A.T
        w = q[:, 2:]
        cell = q[:, :2] / w
        # The derivatives of the cell q / w are those of q less the cell times those of w, over w.
        rows = (A[:2] - cell[..., None] * A[2]) / w[..., None]
        by_u = rows[..., :2] + 2 * rows[..., 2:] * (slope[:, None] * d)[:, None]
        by_A = np.zeros((len(u), 2, 3, 3))
        by_A[:, 0, 0] = by_A[:, 1, 1] = v / w
        by_A[:, :, 2] = -cell[..., None] * (v / w)[:, None]
        by_bend = rows[..., 2:] * powers[:, None]
        return cell, by_u, np.concatenate([by_A.reshape(-1, 2, 9), -by_u, by_bend], axis=2)

    def take_step(self, J: Array, off: Array, damping: float = _DAMPING) -> InverseRadialHomography:
        """Take one Gauss-Newton step against the residuals `off` (m,) with derivatives (m, 14).

        Raises:
            numpy.linalg.LinAlgError: the equations are singular.
        """
        N = J.T @ J
        step = np.linalg.solve(N + damping * np.trace(N) * np.eye(len(N)), J.T @ off)
        return InverseRadialHomography(
            self.A - step[:9].reshape(3, 3), self.centre - step[9:11], self.bend - step[11:]
        )

    def invert(self, u: Array) -> RadialHomography:
        """Return the map to the image; `u` (n, 2) are points that are seen."""
        d = u - self.centre
        k = np.arange(1, _COEFFICIENTS + 1)
        v = np.column_stack([d, 1 + np.sum(d * d, axis=1)[:, None] ** k @ self.bend])
        # What is seen of a board lies on one side of its plane's horizon: there w is positive.
        side = 1.0 if 2 * np.count_nonzero(v @ self.A[2] > 0) >= len(u) else -1.0
        H = np.asarray(np.linalg.inv(self.A * side), dtype=np.float64)
        return RadialHomography(H, self.centre, self.bend)


def invert_radial_homography(seen: RadialHomography) -> InverseRadialHomography:
    """Return the inverse of a map to the image, A of norm 1."""
    A = np.linalg.inv(seen.H)
    return InverseRadialHomography(A / np.linalg.norm(A), seen.centre, seen.coefficients)


def _normalise(points: Array) -> tuple[Array, Array, float]:
    """Shift and scale points (n, 2) to zero mean and unit rms, and return both as they were."""
    mean = points.mean(axis=0)
    spread = _rms(points - mean)
    return (points - mean) / spread, mean, spread


def _rms(offset: Array) -> float:
    """Compute the root mean square of all coordinates."""
    return float(np.sqrt(np.mean(offset**2)))


@dataclass(frozen=True, eq=False, slots=True)
class GridMap:
    """The positions of a lattice's cells: a radial homography and a smooth residual."""

    homography: RadialHomography
    centre: Array
    """(2,) mean (row, col) of the cells, from which the residual's polynomial counts."""
    half: Array
    """(2,) half extent (row, col) of the cells, the unit in which it counts."""
    powers: IntArray
    """(terms, 2) powers of row and column."""
    coefficients: Array
    """(terms, 2) px."""

    def locate(self, cells: Array) -> Array:
        """Compute positions (n, 2) px of the cells (n, 2) = (row, col), found or not."""
        residual = _compute_terms(cells, self.centre, self.half, self.powers) @ self.coefficients
        return self.homography.locate(cells[:, ::-1]) + residual


def fit_grid_map(lattice: Lattice, *, are_exact: bool = False) -> GridMap:
    """Fit the map to the corners of a lattice, see `fit_cells`."""
    cells = np.argwhere(lattice.found).astype(np.float64)
    return fit_cells(cells, lattice.uv[lattice.found], are_exact=are_exact)


def fit_cells(cells: Array, uv: Array, *, are_exact: bool = False) -> GridMap:
    """Fit the map to the cells (n, 2) = (row, col), whole or not, seen at `uv` (n, 2) px, which may
    be exact as for `fit_radial_homography`."""
    flat = fit_radial_homography(cells[:, ::-1], uv, are_exact)
    residual = _prepare_residual(cells.tobytes())
    coefficients = residual.inverse @ (uv - flat.locate(cells[:, ::-1]))
    return GridMap(flat, residual.centre, residual.half, residual.powers, coefficients)


class _Residual(NamedTuple):
    """The terms that fit the smooth residual of a lattice of n cells, wherever they are."""

    centre: Array
    half: Array
    powers: IntArray
    """As in `GridMap`."""
    inverse: Array
    """(terms, n) from positions to the least-squares solution, that of least norm where the cells
    do not tell powers apart."""


@lru_cache(maxsize=8)
def _prepare_residual(cells: bytes) -> _Residual:
    """Prepare the fit to cells (n, 2) = (row, col); it is kept, since the lattices that an image is
    verified by, and most images of a set, have the same."""
    at = np.frombuffer(cells).reshape(-1, 2)
    carried = _MIN_POINTS_OF_DEGREE[_MIN_POINTS_OF_DEGREE[:, 1] <= len(at), 0]
    degree = int(carried.max(initial=0))
    powers = np.argwhere(np.ones((degree + 1, degree + 1)))
    powers = powers[powers.sum(axis=1) <= degree]
    centre = at.mean(axis=0)
    half = np.maximum(np.ptp(at, axis=0) / 2, 1.0)
    terms = _compute_terms(at, centre, half, powers)
    least = np.finfo(np.float64).eps * max(terms.shape)
    inverse = np.asarray(np.linalg.pinv(terms, rcond=least), dtype=np.float64)
    return _Residual(centre, half, powers, inverse)


def _compute_terms(cells: Array, centre: Array, half: Array, powers: IntArray) -> Array:
    """Compute the terms (n, terms) of a lattice's polynomial."""
    x = (cells - centre) / half
    table = np.ones((len(x), 2, int(powers.max()) + 1))
    for k in range(1, table.shape[2]):
        table[..., k] = table[..., k - 1] * x
    return compute_polynomial_terms(table, powers, half)


def compute_polynomial_terms(
    table: Array, powers: IntArray, unit: Array, order: tuple[int, int] = (0, 0)
) -> Array:
    """Compute the terms x1^p1 x2^p2 of a polynomial in two coordinates, or their derivatives.

    Args:
        table: (n, 2, degrees) powers 0, 1, ... of both coordinates, in their units.
        powers: (terms, 2) p1 and p2.
        unit: (2,) lengths in which the coordinates count.
        order: number of derivatives by either coordinate.

    Returns:
        (n, terms)
    """
    terms = np.ones((len(table), len(powers)))
    for axis in (0, 1):
        power, factor = powers[:, axis], np.ones(len(powers))
        for _ in range(order[axis]):
            factor, power = factor * power / unit[axis], np.maximum(power - 1, 0)
        terms *= factor * table[:, axis, power]
    return terms

"""A plane lattice in perspective, through a lens that bends it or not.

Perspective takes the cell (col, row) to the ideal point e from the lens's centre c, a homography H.
Where wide-angle lenses bend what is straight by much, polynomials of the cell follow badly; a few
coefficients of a radial lens do most of it, from the point d = u - c in the image by

    e = k d,   k = 1 / (1 + l1 r + l2 r^2 + l3 r^3),   r = |d|^2.

With l1 alone (the division model: Fitzgibbon 2001) (d, 1 / k) is linear in (|u|^2, u, v, 1), and so
is the cell,

    (col, row, 1) ~ M (|u|^2, u, v, 1),

which is solved like a homography's equations. With A = H^-1, of columns a1 to a3, M consists of
m0 = l1 a3, m1 = a1 - 2 cu m0, m2 = a2 - 2 cv m0 and

    m3 = (1 / l1 - |c|^2) m0 - cu m1 - cv m2,

three equations that give c and l1. From there Gauss-Newton steps lead to the least squares of the
distances in the image, all coefficients free.

Where the board as a whole expects its corners.

The positions of a plane lattice are those of its perspective P (`perspective`) plus what the lens
has bent otherwise, a polynomial p of low degree in column and row:

    uv = P(col, row) + p(col, row).

It reaches over gaps, where a corner has no neighbours left to predict it.

The way from the plate to the image, and from the images of circles to those of their centres.

The centre of the ellipse that a circle is seen as is not the image of the circle's centre.
Let f map the plate to the image. A homography H takes the dual conic of the circle of centre x,
radius r,

    C* = x x^T - r^2 diag(1, 1, 0)    (x homogeneous)    to    H C* H^T,

and with p = H x and h1, h2 the first columns of H the ellipse's centre is

    c = (p p_3 - r^2 (h1 h1_3 + h2 h2_3)) / (p_3^2 - r^2 (h1_3^2 + h2_3^2)),

which is p / p_3 only if h1_3 = h2_3 = 0, for a plate parallel to the image. A lens adds its own
part. Whatever f, the circle x + r n maps to f(x) + r J n + r^2/2 n^T f'' n + ..., n a unit
vector, and seen through J^-1, with g = J^-1 f'', the last term moves the curve along its normal
n by r^2/2 n.g(n, n). The part of this that is like a shift t.n, its first harmonic, gives

    t_i = r^2/8 (sum_j g_i,jj + 2 sum_j g_j,ij),    c - f(x) = J t + O(r^4),

as the mean of n_i n_j n_k n_l is (d_ij d_kl + d_ik d_jl + d_il d_jk) / 8. For a homography this is
the leading term of the exact expression. Both are used: the homography exactly, and what the lens
adds to it by the second derivatives of the lens (`corners.perspective`), where it bends much, and
of a polynomial over the plate for the rest, small and smooth. Everything is fitted to the board's
own centres, so that no calibration is needed first.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.detection.lattice import Lattice
from calibgui.engine.geometry import homography

_BENT = 0.005
"""Rms distance of corners from their homography beyond which a lens is looked for, over that from
their mean."""
_BETTER = 0.5
"""Part of that distance that a lens must leave at most."""
_ENOUGH = 16
"""Corners from which on a lens may be told."""
_MOST = 400
"""Corners, spread over the lattice, that a lens is fitted to."""
_COEFFICIENTS = 3
_STEPS = 3
"""Of Gauss-Newton."""
_NEWTON = 5
"""Steps in which the point in the image is found from the ideal one."""
_DAMPING = 1e-13
"""What is added to the diagonal of equations, over its sum."""


@dataclass(frozen=True, eq=False, slots=True)
class Perspective:
    """Of a lattice's cells."""

    H: Array
    """(3, 3) ideal points from (col, row), px from the centre."""
    centre: Array
    """(2,) of the lens, px."""
    bend: Array
    """(3,) l1 to l3 of the lens, by powers of px^2; 0 where it bends nothing."""

    def at(self, cells: Array) -> Array:
        """(n, 2) px of the cells (n, 2) = (col, row)."""
        return self.seen(homography.apply(self.H, cells))

    def seen(self, e: Array) -> Array:
        """(n, 2) px of ideal points (n, 2)."""
        return self.centre + (self._bent(e) if self.bend.any() else e)

    def derivatives(self, cells: Array) -> tuple[Array, Array]:
        """First and second derivatives (n, 2, 2) of `at` by column and by row.

        With e = a / w, a and w linear in the cell, e' = (a' - e w') / w and e'' = -2 e' w' / w.
        Through the lens u' = D' e' and u'' = D' e'' + D''(e', e').
        """
        H = self.H
        e = homography.apply(H, cells)
        w = (cells @ H[2, :2] + H[2, 2])[:, None, None]
        e1 = (H[:2, :2].T - e[:, None] * H[2, :2, None]) / w
        e2 = -2 * e1 * H[2, :2, None] / w
        if not self.bend.any():
            return e1, e2
        D1, D2 = self.bending(e)
        second = np.einsum("nijk,naj,nak->nai", D2, e1, e1)
        return np.einsum("nij,naj->nai", D1, e1), np.einsum("nij,naj->nai", D1, e2) + second

    def bending(self, e: Array) -> tuple[Array, Array]:
        """Derivatives D' (n, 2, 2) and D'' (n, 2, 2, 2) of `seen` by the ideal points `e` (n, 2).

        Those of its inverse e = E(d) = k d are, with k' and k'' by r,

            E_i,j = k 1_ij + 2 k' d_i d_j
            E_i,jk = 4 k'' d_i d_j d_k + 2 k' (1_ij d_k + 1_ik d_j + 1_jk d_i),

        1_ij being 1 where i = j and else 0. From E(D(e)) = e follow D' = E'^-1 and
        D'' = -D' E''(D', D').
        """
        d = self._bent(e) if self.bend.any() else e
        k, by_r, by_r2 = _scale(np.sum(d * d, axis=1), self.bend)
        one = np.eye(2)
        first = k[:, None, None] * one + 2 * by_r[:, None, None] * d[:, :, None] * d[:, None]
        mixed = one[:, :, None] * d[:, None, None]
        mixed = mixed + mixed.transpose(0, 1, 3, 2) + mixed.transpose(0, 3, 1, 2)
        cubic = np.einsum("ni,nj,nk->nijk", d, d, d)
        second = 4 * by_r2[:, None, None, None] * cubic + 2 * by_r[:, None, None, None] * mixed
        D1 = np.asarray(np.linalg.inv(first), dtype=np.float64)
        D2 = -np.einsum("nil,nlab,naj,nbk->nijk", D1, second, D1, D1, optimize=True)
        return D1, np.asarray(D2)

    def _bent(self, e: Array) -> Array:
        """Points (n, 2) px from the centre where the lens shows the ideal points (n, 2).

        Newton's steps on |d| = |e| / k lead there from where l1 alone would show them.
        """
        far = np.linalg.norm(e, axis=1)
        l1, l2, l3 = self.bend
        x = 2 * far / (1 + np.sqrt(np.maximum(1 - 4 * l1 * far**2, 0.0)))
        with np.errstate(all="ignore"):  # beyond where the lens reaches
            for _ in range(_NEWTON):
                r = x * x
                inverse = 1 + r * (l1 + r * (l2 + r * l3))
                slope = 2 * x * (l1 + r * (2 * l2 + r * 3 * l3))
                x = x - (x - far * inverse) / (1 - far * slope)
        return np.asarray(e * (x / np.maximum(far, 1e-300))[:, None])


def _scale(r: Array, bend: Array) -> tuple[Array, Array, Array]:
    """k and its first and second derivatives by r, each (n,)."""
    l1, l2, l3 = bend
    inverse = 1 + r * (l1 + r * (l2 + r * l3))
    by_r, by_r2 = l1 + r * (2 * l2 + r * 3 * l3), 2 * l2 + 6 * l3 * r
    k = 1 / inverse
    return k, -by_r * k**2, (2 * by_r**2 * k - by_r2) * k**2


def fit_perspective(cells: Array, uv: Array) -> Perspective:
    """The perspective of cells (n, 2) = (col, row) seen at `uv` (n, 2) px; with a lens only if that
    leaves much less."""
    none = np.zeros(_COEFFICIENTS)
    plain = Perspective(homography.fit_homography(cells, uv, np.ones(len(uv))), np.zeros(2), none)
    left = _rms(plain.at(cells) - uv)
    if len(uv) < _ENOUGH or left < _BENT * _rms(uv - uv.mean(axis=0)):
        return plain
    some = np.linspace(0, len(uv) - 1, min(len(uv), _MOST)).astype(np.int64)
    (x, mean, scale), (u, origin, unit) = _normalised(cells[some]), _normalised(uv[some])
    bent = _by_division(x, u)
    bent = None if bent is None else _nearest(x, u, bent)
    # Not finite is not better.
    if bent is None or not unit * _rms(bent.at(x) - u) < _BETTER * left:
        return plain
    to_normal = np.diag([1 / scale, 1 / scale, 1.0])
    to_normal[:2, 2] = -mean / scale
    return Perspective(
        np.diag([unit, unit, 1.0]) @ bent.H @ to_normal,
        origin + unit * bent.centre,
        bent.bend / unit ** np.arange(2.0, 2 * _COEFFICIENTS + 1, 2),
    )


def _by_division(x: Array, u: Array) -> Perspective | None:
    """The closed solution with one coefficient, if there is one, points (n, 2) normalised."""
    lifted = np.column_stack([np.sum(u * u, axis=1), u, np.ones(len(u))])
    S, Sx, Sy, Sq = (
        (lifted * factor[:, None]).T @ lifted
        for factor in (np.ones(len(x)), x[:, 0], x[:, 1], np.sum(x * x, axis=1))
    )
    # For a given third row of M the others follow: it is an eigenvector, as in `homography.dlt`.
    inverse = np.linalg.inv(S + _DAMPING * np.trace(S) * np.eye(4))
    third = np.linalg.eigh(Sq - Sx @ inverse @ Sx - Sy @ inverse @ Sy)[1][:, 0]
    M = np.stack([inverse @ Sx @ third, inverse @ Sy @ third, third])
    try:
        a, *minus_centre = np.linalg.solve(M[:, :3], M[:, 3])
        centre = -np.array(minus_centre)
        l1 = 1 / (a + centre @ centre)
        A = np.column_stack([M[:, 1:3] + 2 * np.outer(M[:, 0], centre), M[:, 0] / l1])
        return Perspective(np.linalg.inv(A), centre, np.array([l1, 0.0, 0.0]))
    except np.linalg.LinAlgError:
        return None


def _nearest(x: Array, u: Array, start: Perspective) -> Perspective | None:
    """The perspective nearest to points `u` (n, 2), from one that is near; both normalised; None if
    the steps lead nowhere.

    The cell q / w, (q, w) = A v, v = (d, 1 / k), is compared with its own; its derivative by u
    takes the difference to the image.
    """
    A, centre, bend = np.linalg.inv(start.H), start.centre, start.bend
    A /= np.linalg.norm(A)
    n, k = len(x), np.arange(1, _COEFFICIENTS + 1)
    for _ in range(_STEPS):
        d = u - centre
        r = np.sum(d * d, axis=1)
        powers = r[:, None] ** k
        slope = (r[:, None] ** (k - 1) * k) @ bend
        v = np.column_stack([d, 1 + powers @ bend])
        q = v @ A.T
        w = q[:, 2:]
        cell = q[:, :2] / w
        # The derivatives of the cell q / w are those of q less the cell times those of w, over w.
        rows = (A[:2] - cell[..., None] * A[2]) / w[..., None]
        by_u = rows[..., :2] + 2 * rows[..., 2:] * (slope[:, None] * d)[:, None]
        by_A = np.zeros((n, 2, 3, 3))
        by_A[:, 0, 0] = by_A[:, 1, 1] = v / w
        by_A[:, :, 2] = -cell[..., None] * (v / w)[:, None]
        by_bend = rows[..., 2:] * powers[:, None]
        J = np.concatenate([by_A.reshape(n, 2, 9), -by_u, by_bend], axis=2)
        try:
            J, off = np.linalg.solve(by_u, J), np.linalg.solve(by_u, (cell - x)[..., None])
            flat = J.reshape(2 * n, -1)
            N = flat.T @ flat
            step = np.linalg.solve(
                N + _DAMPING * np.trace(N) * np.eye(len(N)), flat.T @ off.ravel()
            )
        except np.linalg.LinAlgError:
            return None
        A = A - step[:9].reshape(3, 3)
        centre, bend = centre - step[9:11], bend - step[11:]
    return Perspective(np.linalg.inv(A), centre, bend)


def _normalised(points: Array) -> tuple[Array, Array, float]:
    """Points (n, 2) of zero mean and unit spread, and both as they were."""
    mean = points.mean(axis=0)
    spread = _rms(points - mean)
    return (points - mean) / spread, mean, spread


def _rms(offset: Array) -> float:
    return float(np.sqrt(np.mean(offset**2)))


_DEGREES = np.array([(1, 16), (2, 20), (3, 26), (4, 45)])
"""Degree of the polynomial, and the corners from which on it is used."""


@dataclass(frozen=True, eq=False, slots=True)
class GridMap:
    """A lattice's smooth positions."""

    flat: Perspective
    centre: Array
    half: Array
    """(2,) the cells (row, col) that the polynomial counts from and in."""
    powers: IntArray
    """(terms, 2) of row and column."""
    coefficients: Array
    """(terms, 2) px."""

    def at(self, cells: Array) -> Array:
        """Positions (n, 2) px of the cells (n, 2) = (row, col), found or not."""
        bent = _basis(cells, self.centre, self.half, self.powers) @ self.coefficients
        return self.flat.at(cells[:, ::-1]) + bent


def fit_grid_map(lattice: Lattice) -> GridMap:
    """The sheet through the corners of `lattice`."""
    cells = np.argwhere(lattice.found).astype(np.float64)
    uv = lattice.uv[lattice.found]
    flat = fit_perspective(cells[:, ::-1], uv)
    degree = int(_DEGREES[_DEGREES[:, 1] <= len(cells), 0].max(initial=0))
    powers = np.argwhere(np.ones((degree + 1, degree + 1)))
    powers = powers[powers.sum(axis=1) <= degree]
    centre = cells.mean(axis=0)
    half = np.maximum(np.ptp(cells, axis=0) / 2, 1.0)
    basis = _basis(cells, centre, half, powers)
    # Of powers that the cells do not tell apart the least-squares solution of least norm.
    coefficients = np.linalg.lstsq(basis, uv - flat.at(cells[:, ::-1]))[0]
    return GridMap(flat, centre, half, powers, np.asarray(coefficients, dtype=np.float64))


def _basis(cells: Array, centre: Array, half: Array, powers: IntArray) -> Array:
    """(n, terms) the polynomial's terms."""
    x = np.polynomial.polynomial.polyvander((cells - centre) / half, int(powers.max()))
    return np.asarray(x[:, 0, powers[:, 0]] * x[:, 1, powers[:, 1]])


_HIGHEST = 5
"""Degree of the polynomial that a grid of many points carries."""
_POWERS = np.array([(k - j, j) for k in range(_HIGHEST + 1) for j in range(k + 1)])
"""Of X and Y in the polynomial's terms, by degree."""


@dataclass(frozen=True, eq=False, slots=True)
class CircleMap:
    """f, from the plate (pitches) to the image: a perspective and what the lens adds to it."""

    flat: Perspective
    middle: Array
    """(2,) of the plate"""
    unit: float
    """Length in which the polynomial counts, pitches."""
    terms: Array
    """(21, 2) of the polynomial, px; 0 where the points do not carry it."""

    def at(self, xy: Array) -> Array:
        """(n, 2) px."""
        return self.flat.at(xy) + self._basis(xy, (0, 0)) @ self.terms

    def jacobian(self, xy: Array) -> Array:
        """(n, 2, 2) px per pitch, columns by X and by Y."""
        return self.flat.derivatives(xy)[0].transpose(0, 2, 1) + np.stack(
            [self._basis(xy, order) @ self.terms for order in ((1, 0), (0, 1))], axis=2
        )

    def bias(self, xy: Array, radius: float) -> Array:
        """(n, 2) px from the images of the points (n, 2) to the centres of the ellipses around
        them, of circles of `radius` pitches."""
        H = self.flat.H
        h1, h2 = H[:, 0], H[:, 1]
        p = np.column_stack([xy, np.ones(len(xy))]) @ H.T
        r2 = radius**2
        centre = p[:, :2] * p[:, 2:] - r2 * (h1[:2] * h1[2] + h2[:2] * h2[2])
        centre /= p[:, 2:] ** 2 - r2 * (h1[2] ** 2 + h2[2] ** 2)
        e = p[:, :2] / p[:, 2:]
        of_H = self.flat.seen(centre) - self.flat.seen(e)
        by_xy = (H[:2, :2] - e[..., None] * H[2, :2]) / p[:, 2:, None]
        second = np.einsum("nijk,nja,nkb->niab", self.flat.bending(e)[1], by_xy, by_xy)
        for a, b, order in ((0, 0, (2, 0)), (0, 1, (1, 1)), (1, 0, (1, 1)), (1, 1, (0, 2))):
            second[:, :, a, b] += self._basis(xy, order) @ self.terms
        J = self.jacobian(xy)
        g = np.linalg.solve(J, second.reshape(-1, 2, 4)).reshape(-1, 2, 2, 2)
        t = r2 / 8 * (np.einsum("nijj->ni", g) + 2 * np.einsum("njij->ni", g))
        return np.asarray(of_H + (J @ t[..., None])[..., 0])

    def _basis(self, xy: Array, order: tuple[int, int]) -> Array:
        """(n, 21) terms, differentiated."""
        columns = np.ones((len(xy), len(_POWERS)))
        for axis in (0, 1):
            x, power = (xy[:, axis] - self.middle[axis]) / self.unit, _POWERS[:, axis]
            factor = np.ones(len(power))
            for _ in range(order[axis]):
                factor, power = factor * power / self.unit, np.maximum(power - 1, 0)
            columns *= factor * x[:, None] ** power
        return columns


def fit_circle_map(xy: Array, uv: Array) -> CircleMap:
    """f through the points `xy` (n, 2) of the plate, pitches, and their images `uv` (n, 2) px."""
    middle, unit = (xy.min(axis=0) + xy.max(axis=0)) / 2, float(np.ptp(xy, axis=0).max()) / 2
    flat = CircleMap(fit_perspective(xy, uv), middle, unit, np.zeros((len(_POWERS), 2)))
    degrees = _POWERS.sum(axis=1)
    # The highest degree with half as many points again as terms; below 3, a lens has no effect.
    carried = [k for k in range(3, _HIGHEST + 1) if 1.5 * np.count_nonzero(degrees <= k) <= len(xy)]
    if not carried:
        return flat
    count = np.count_nonzero(degrees <= carried[-1])
    terms = np.zeros((len(_POWERS), 2))
    basis = flat._basis(xy, (0, 0))[:, :count]
    terms[:count] = np.linalg.lstsq(basis, uv - flat.at(xy), rcond=1e-6)[0]
    return replace(flat, terms=terms)

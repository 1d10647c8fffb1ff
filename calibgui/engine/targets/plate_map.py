"""The way from the plate to the image, and from the images of circles to those of their centres.

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

from calibgui.engine.corners.perspective import Perspective, fitted
from calibgui.engine.types import Array

_HIGHEST = 5
"""Degree of the polynomial that a grid of many points carries."""
_POWERS = np.array([(k - j, j) for k in range(_HIGHEST + 1) for j in range(k + 1)])
"""Of X and Y in the polynomial's terms, by degree."""


@dataclass(frozen=True, eq=False, slots=True)
class PlateMap:
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


def plate_map(xy: Array, uv: Array) -> PlateMap:
    """f through the points `xy` (n, 2) of the plate, pitches, and their images `uv` (n, 2) px."""
    middle, unit = (xy.min(axis=0) + xy.max(axis=0)) / 2, float(np.ptp(xy, axis=0).max()) / 2
    flat = PlateMap(fitted(xy, uv), middle, unit, np.zeros((len(_POWERS), 2)))
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

"""The map from a grid of circles to the image, and the bias of the circles' centres.

The centre of the ellipse that a circle is seen as is not the image of the circle's centre. The
difference is known once the map f from the board to the image is. Like every grid's (`grid_map`) f
consists of a homography, a radial lens and a smooth residual, a polynomial over the board;
everything is fitted to the board's own centres, so that no calibration is needed first.

A homography H takes the dual conic of the circle of centre x, radius r,

    C* = x x^T - r^2 diag(1, 1, 0)    (x homogeneous)    to    H C* H^T,

and with p = H x and h1, h2 the first columns of H the ellipse's centre is

    c = (p p_3 - r^2 (h1 h1_3 + h2 h2_3)) / (p_3^2 - r^2 (h1_3^2 + h2_3^2)),

which is p / p_3 only if h1_3 = h2_3 = 0, for a board parallel to the image. A lens adds its own
part. Whatever f, the circle x + r n maps to f(x) + r J n + r^2/2 n^T f'' n + ..., n a unit
vector, and seen through J^-1, with g = J^-1 f'', the last term moves the curve along its normal
n by r^2/2 n.g(n, n). The part of this that is like a shift t.n, its first harmonic, gives

    t_i = r^2/8 (sum_j g_i,jj + 2 sum_j g_j,ij),    c - f(x) = J t + O(r^4),

as the mean of n_i n_j n_k n_l is (d_ij d_kl + d_ik d_jl + d_il d_jk) / 8. For a homography this is
the leading term of the exact expression. Both are used: the homography exactly, and what the lens
adds to it by the second derivatives of the radial lens and of the residual.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.lattices.grid_map import (
    RadialHomography,
    compute_polynomial_terms,
    fit_radial_homography,
)

_MIN_DEGREE, _MAX_DEGREE = 3, 5
"""Degrees of the residual's polynomial: below 3 a lens has no effect."""
_POWERS = np.array([(k - j, j) for k in range(_MAX_DEGREE + 1) for j in range(k + 1)])
"""(21, 2) powers of X and Y in the polynomial's terms, by degree."""
_QUADRATIC_TERMS = 6
"""Number of its terms up to degree 2."""
_PARAMETERS = 10
"""Number of parameters of a homography and a radial lens."""
_MIN_POINTS_PER_TERM = 1.5
"""Least number of points over that of terms at which a degree is used."""
_RANK_TOLERANCE = 1e-6
"""Singular values of the terms, over the largest, below which they count as 0."""


@dataclass(frozen=True, eq=False, slots=True)
class CircleMap:
    """f, from the board (pitches) to the image: a radial homography and a smooth residual."""

    homography: RadialHomography
    centre: Array
    """(2,) point of the board from which the polynomial counts, pitches."""
    unit: float
    """Length in which the polynomial counts, pitches."""
    coefficients: Array
    """(21, 2) of the polynomial, px; 0 for the degrees that the points do not determine."""

    @property
    def parameters(self) -> int:
        """Number of parameters that were fitted: those of the polynomial, whose terms up to degree
        2 say as much as the homography and the lens, or else those of these."""
        return max(2 * int(np.count_nonzero(self.coefficients.any(axis=1))), _PARAMETERS)

    def compute_leverages(self, xy: Array) -> Array:
        """Compute how much of its own deviation the map follows at each of the points `xy` (n, 2)
        that it was fitted to: (n,) 0 to 1, those of its polynomial, or of one of degree 2."""
        count = max(int(np.count_nonzero(self.coefficients.any(axis=1))), _QUADRATIC_TERMS)
        basis = np.linalg.svd(self._compute_terms(xy, (0, 0))[:, :count], full_matrices=False)
        is_told = basis.S > _RANK_TOLERANCE * basis.S[0]
        return np.asarray(np.sum(basis.U[:, is_told] ** 2, axis=1))

    def locate(self, xy: Array) -> Array:
        """Compute positions (n, 2) px of points (n, 2) of the board, pitches."""
        return self.homography.locate(xy) + self._compute_terms(xy, (0, 0)) @ self.coefficients

    def differentiate(self, xy: Array) -> Array:
        """Compute the Jacobian (n, 2, 2) of `locate`, px per pitch, columns by X and by Y."""
        return self.homography.differentiate(xy)[0].transpose(0, 2, 1) + np.stack(
            [self._compute_terms(xy, order) @ self.coefficients for order in ((1, 0), (0, 1))],
            axis=2,
        )

    def compute_centre_bias(self, xy: Array, radii: Array) -> Array:
        """Compute the way from the images of circles' centres to the centres of their ellipses.

        Args:
            xy: (n, 2) the circles' centres, pitches.
            radii: (n,) of the circles, pitches.

        Returns:
            (n, 2) px.
        """
        H = self.homography.H
        h1, h2 = H[:, 0], H[:, 1]
        p = np.column_stack([xy, np.ones(len(xy))]) @ H.T
        r2 = radii[:, None] ** 2
        centre = p[:, :2] * p[:, 2:] - r2 * (h1[:2] * h1[2] + h2[:2] * h2[2])
        centre /= p[:, 2:] ** 2 - r2 * (h1[2] ** 2 + h2[2] ** 2)
        e, w = p[:, :2] / p[:, 2:], p[:, 2]
        by_homography = self.homography.distort(centre, w) - self.homography.distort(e, w)
        by_xy = (H[:2, :2] - e[..., None] * H[2, :2]) / p[:, 2:, None]
        by_lens = self.homography.differentiate_lens(e, w)[1]
        second = np.einsum("nijk,nja,nkb->niab", by_lens, by_xy, by_xy)
        for a, b, order in ((0, 0, (2, 0)), (0, 1, (1, 1)), (1, 0, (1, 1)), (1, 1, (0, 2))):
            second[:, :, a, b] += self._compute_terms(xy, order) @ self.coefficients
        J = self.differentiate(xy)
        g = np.linalg.solve(J, second.reshape(-1, 2, 4)).reshape(-1, 2, 2, 2)
        t = r2 / 8 * (np.einsum("nijj->ni", g) + 2 * np.einsum("njij->ni", g))
        return np.asarray(by_homography + (J @ t[..., None])[..., 0])

    def _compute_terms(self, xy: Array, order: tuple[int, int]) -> Array:
        """Compute the polynomial's terms (n, 21), differentiated `order` times by X and by Y."""
        x = (xy - self.centre) / self.unit
        table = x[..., None] ** np.arange(_MAX_DEGREE + 1)
        return compute_polynomial_terms(table, _POWERS, np.full(2, self.unit), order)


def fit_circle_map(xy: Array, uv: Array, are_exact: bool = False) -> CircleMap:
    """Fit f to points of the board and their images.

    Args:
        xy: (n, 2) pitches.
        uv: (n, 2) px.
        are_exact: whether `uv` are known to a fraction of a pixel, so that a lens is worth fitting
            that bends little. What few circles leave of it to the polynomial, of low degree then,
            makes the centres' bias 2 % too small, and with it the focal length wrong.
    """
    centre, unit = (xy.min(axis=0) + xy.max(axis=0)) / 2, float(np.ptp(xy, axis=0).max()) / 2
    flat = CircleMap(
        fit_radial_homography(xy, uv, are_exact), centre, unit, np.zeros((len(_POWERS), 2))
    )
    degrees = _POWERS.sum(axis=1)
    carried = [
        k
        for k in range(_MIN_DEGREE, _MAX_DEGREE + 1)
        if _MIN_POINTS_PER_TERM * np.count_nonzero(degrees <= k) <= len(xy)
    ]
    if not carried:
        return flat
    count = np.count_nonzero(degrees <= carried[-1])
    coefficients = np.zeros((len(_POWERS), 2))
    terms = flat._compute_terms(xy, (0, 0))[:, :count]
    residual = uv - flat.locate(xy)
    coefficients[:count] = np.linalg.lstsq(terms, residual, rcond=_RANK_TOLERANCE)[0]
    return replace(flat, coefficients=coefficients)

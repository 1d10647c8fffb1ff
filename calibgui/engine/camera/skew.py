"""Lens models on the plane z = 1 with a skew: columns of pixels not at right angles to rows.

The skew is Bouguet's alpha_c, u = cx + fx (x + skew y). With S = [1 skew; 0 1] and (x, y) the
measured point without it,

    d = S (x, y),      dd/dn = S d(x, y)/dn,      dd/dskew = (y, 0),
    (x, y) = S^-1 d,   dn/dd = dn/d(x, y) S^-1,   dn/dskew = -dn/dx d2.

It is held at 0 unless freed, since sensors have none.
"""

from __future__ import annotations

from abc import abstractmethod

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.plane import PlaneLens, PlanePoints


class SkewedLens(PlaneLens):
    """A lens model whose last coefficient is the skew."""

    held = ("skew",)

    @abstractmethod
    def correct_unskewed(self, xy: Array, k: Array) -> PlanePoints:
        """Map measured points without skew to ideal points; k are the other coefficients."""

    @abstractmethod
    def distort_unskewed(self, n: Array, k: Array) -> PlanePoints:
        """Map ideal points to measured points without skew; k are the other coefficients."""

    def correct(self, d: Array, k: Array) -> PlanePoints:
        """Map measured to ideal points."""
        inverse = np.array([[1.0, -k[-1]], [0.0, 1.0]])
        n, by_xy, by_k = self.correct_unskewed(d @ inverse.T, k[:-1])
        by_skew = -by_xy[..., :1] * d[..., 1:, None]
        return PlanePoints(n, by_xy @ inverse, np.concatenate([by_k, by_skew], axis=-1))

    def distort(self, n: Array, k: Array) -> PlanePoints:
        """Map ideal to measured points."""
        S = np.array([[1.0, k[-1]], [0.0, 1.0]])
        xy, by_n, by_k = self.distort_unskewed(n, k[:-1])
        by_skew = xy[..., 1:, None] * np.array([[1.0], [0.0]])
        return PlanePoints(xy @ S.T, S @ by_n, np.concatenate([S @ by_k, by_skew], axis=-1))

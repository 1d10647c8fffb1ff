"""The thin-prism model of OpenCV: the rational model with terms of a lens that is not centred.

It is OpenCV's CALIB_THIN_PRISM_MODEL (Weng, Cohen and Herniou 1992): an element that is tilted acts
as the lens with a thin prism before it. To the measured point of ``rational.py``, s = x^2 + y^2, it
adds

    (s1 s + s2 s^2,  s3 s + s4 s^2),

whose derivatives by x and y are 2 (s1 + 2 s2 s) (x, y) in the first row and 2 (s3 + 2 s4 s) (x, y)
in the second, and by s1, s2 (s, 0) and (s^2, 0), by s3, s4 (0, s) and (0, s^2).

Together p2 = -s1 make 2 p2 (x^2, x y), which is a rotation of the camera with a shift of its
centre, and p1 = -s3 likewise: only a lens with strong radial distortion tells the four apart.

OpenCV's model of 14 coefficients tilts the sensor as well (CALIB_TILTED_MODEL). It is left out:
but for distortion a tilted sensor is a camera that is rotated about its pinhole, with other focal
lengths and another centre, so that tilt, poses and these would be badly determined together.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.models.rational import Rational
from calibgui.engine.camera.plane import PlanePoints


class ThinPrism(Rational):
    """The model with OpenCV's k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4, and skew."""

    title = "Rational with thin prism (OpenCV)"
    names = (*Rational.names[:-1], "s1", "s2", "s3", "s4", "skew")
    powers = (*Rational.powers[:-1], 1, 3, 1, 3, 0)
    asymmetric = ("p1", "p2", "s1", "s2", "s3", "s4", "skew")

    def distort_unskewed(self, n: Array, k: Array) -> PlanePoints:
        """Map ideal points to measured points without skew; NaN from the pole on."""
        points, by_point, by_k = super().distort_unskewed(n, k[:8])
        s1, s2, s3, s4 = k[8:]
        s = np.sum(n * n, axis=-1)
        by_prism = np.zeros((*n.shape, 4))
        by_prism[..., 0, 0] = by_prism[..., 1, 2] = s
        by_prism[..., 0, 1] = by_prism[..., 1, 3] = s * s
        slope = 2 * np.stack([s1 + 2 * s2 * s, s3 + 2 * s4 * s], axis=-1)
        return PlanePoints(
            points + by_prism @ k[8:],
            by_point + slope[..., None] * n[..., None, :],
            np.concatenate([by_k, by_prism], axis=-1),
        )

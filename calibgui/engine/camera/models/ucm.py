"""The unified camera model: one coefficient, closed-form both ways (Geyer and Daniilidis 2000).

It describes mirrors with a single viewpoint exactly and many fisheye lenses well. In the form that
does not lose the focal length at its limits (Usenko, Demmel and Cremers 2018)

    d = (X, Y) / (alpha |(X, Y, Z)| + (1 - alpha) Z),

which is the extended model (``eucm.py``, with its limits) for beta = 1. Mei's form of it,
d = gamma (X, Y) / (Z + xi |r|), has alpha = xi / (1 + xi) and focal lengths of 1 + xi times these.

Geyer, C., Daniilidis, K. (2000). A unifying theory for central panoramic systems. ECCV.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.model import Lens, LensProjection, LensUnprojection, Trials
from calibgui.engine.camera.models.eucm import ExtendedUnified


class Unified(Lens):
    """The unified model with the coefficient alpha."""

    title = "Unified, UCM (fisheye, mirrors)"
    names = ("alpha",)
    powers = (0,)
    defaults = (0.5,)
    conversion_starts = Trials("alpha", (0.0, 0.5))

    def project(self, rays: Array, k: Array) -> LensProjection:
        """Map rays to image points."""
        d, by_ray, by_k = ExtendedUnified().project(rays, np.array([k[0], 1.0]))
        return LensProjection(d, by_ray, by_k[..., :1])

    def unproject(self, d: Array, k: Array) -> LensUnprojection:
        """Map image points to rays of length 1."""
        rays, by_point, by_k = ExtendedUnified().unproject(d, np.array([k[0], 1.0]))
        return LensUnprojection(rays, by_point, by_k[..., :1])

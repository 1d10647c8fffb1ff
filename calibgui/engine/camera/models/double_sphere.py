"""The double sphere model: closed-form both ways (Usenko, Demmel and Cremers 2018).

Basalt (ds) and Kalibr (ds-none) use it, for lenses of more than 180 degrees. A ray is projected
onto a unit sphere, then onto one that is shifted by xi along the axis, and that point is projected
as in the unified model. With zeta = xi |r| + Z

    d = (X, Y) / (alpha sqrt(X^2 + Y^2 + zeta^2) + (1 - alpha) zeta).

It is the unified model (``ucm.py``) of the ray (X, Y, zeta), so that derivatives follow by the
chain rule (``camera.shifted_sphere``), and so does the way back. The unified model is xi = 0. Where
one of the spheres is hardly needed xi and alpha are determined together only.

Limits: those of the unified model for (X, Y, zeta), and |r| + xi Z > 0, which excludes something
for xi > 1 only. The paper's Z > -w2 |r|, which Basalt tests, ends some degrees before: there the
point on the second sphere is looked at from the centre of the first, as if it lay on that.

Usenko, V., Demmel, N., Cremers, D. (2018). The double sphere camera model. 3DV.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.model import Lens, LensProjection, LensUnprojection, Trials
from calibgui.engine.camera.models.eucm import lift
from calibgui.engine.camera.models.ucm import Unified
from calibgui.engine.camera.shifted_sphere import differentiate_shift, shift_rays, unshift_rays
from calibgui.engine.camera.tangent import invert_projection


class DoubleSphere(Lens):
    """The double sphere model with the coefficients xi, alpha."""

    title = "Double sphere (Basalt, Kalibr)"
    names = ("xi", "alpha")
    powers = (0, 0)
    defaults = (0.0, 0.5)
    valley = Trials("xi", (-0.5, -0.3, -0.1, 0.1, 0.3, 0.5))  # alpha does nearly the same
    conversion_starts = Trials("xi", (-0.3, 0.0, 0.3))

    def project(self, rays: Array, k: Array) -> LensProjection:
        """Map rays to image points."""
        shifted, length = shift_rays(rays, k[0])
        return differentiate_shift(Unified().project(shifted, k[1:]), rays, length, k[0])

    def unproject(self, d: Array, k: Array) -> LensUnprojection:
        """Map image points to rays of length 1."""
        m = lift(d, k[1], 1.0)
        rays = unshift_rays(np.concatenate([d, m[..., None]], axis=-1), k[0])
        return invert_projection(rays, self.project(rays, k))

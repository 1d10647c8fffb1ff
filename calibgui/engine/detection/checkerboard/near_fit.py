"""The edge fit at corners beside which something lies, of what is seen near them.

A finger, the edge of a shadow, a spot of glare or a tag may lie over a part of the squares around a
corner that is itself as clear as any. Fitted to half a square each way such a corner leaves more
unexplained than others; where it does not near by, that fit is taken. So it is where the paper is
bent and the edges with it.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import BoolArray, GreyImage
from calibgui.engine.detection.checkerboard import x_corner_fit
from calibgui.engine.detection.checkerboard.near_priors import NearPriors
from calibgui.engine.detection.checkerboard.x_corner_fit import XCornerFit, replace_fits
from calibgui.engine.detection.lattice import Lattice

_MIN_ARM = 2.0
"""Least way along its edges that a corner is fitted to, px: a shorter one lies within the blur.
With 3 a quarter of the outermost corners of framed boards that are seen from aside were lost, and
those left had no smaller errors."""
_MIN_CORNERS = 16
"""Least number of corners that are fitted near only: their geometry comes from all of them."""


def fit_near(
    image: GreyImage,
    lattice: Lattice,
    plain: float,
    fit: XCornerFit,
    suspect: BoolArray,
) -> XCornerFit:
    """Return the fit with the suspect corners (n,) fitted to what is plain around them only, where
    that is enough.

    Args:
        image: (h, w) grey levels.
        lattice: the corners.
        plain: how far from the corners is looked, squares.
        fit: at all n corners.
        suspect: (n,) those that are fitted again.
    """
    found = lattice.found
    large = plain * lattice.spacing() > _MIN_ARM
    if np.count_nonzero(found & large) < _MIN_CORNERS:
        return fit
    places = np.argwhere(found & large)[:, ::-1].astype(np.float64)
    near = x_corner_fit.fit_x_corners(
        image, lattice.select(large), priors=NearPriors(places, 2 * plain)
    )
    return replace_fits(fit, near, large[found], suspect[large[found]])

"""The corners of a checkerboard with tags, from their places in its lattice.

The corners are refined and verified like those of a checkerboard, but what is looked at is plain
only near the edges: in a square with a tag its border. Beyond the outermost corners the print may
end, or a frame begin, within less than half a square. The edges are therefore fitted twice, all
along and only near the corner; the second fit is taken on the outermost lines, and where the first
leaves more unexplained than it does elsewhere.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import BoolArray, GreyImage
from calibgui.engine.detection.apriltags.near_priors import NearPriors
from calibgui.engine.detection.charuco.corners_between_markers import (
    refine_corners,
    require_enough_corners,
)
from calibgui.engine.detection.checkerboard import verification, x_corner_fit
from calibgui.engine.detection.checkerboard.thresholds import THRESHOLDS
from calibgui.engine.detection.checkerboard.x_corner_fit import XCornerFit, replace_fits
from calibgui.engine.detection.corners import RejectedCorner
from calibgui.engine.detection.detector_io import list_rejected_corners
from calibgui.engine.detection.lattice import Lattice

_TEMPLATE_REACH = 1.5
"""Ratio of the part of a square that the typical corner may be taken from to the part that is
plain: its samples lie in the inner two thirds of that part."""
_MAX_ROUNDS = 8
"""Number of times that the corners beside those found are tried."""
_MIN_ARM = 2.0
"""Least way along its edges that a corner is fitted to, px: a shorter one lies within the blur.
With 3 a quarter of the outermost corners of framed boards that are seen from aside were lost, and
those left had no smaller errors."""
_MIN_CORNERS = 16
"""Least number of corners that are fitted near only: their geometry comes from all of them."""


def refine_tagged_corners(
    image: GreyImage, predicted: Lattice, plain: float
) -> tuple[Lattice, list[RejectedCorner]]:
    """Move corners to their saddle points, verify them, and try the places beside them.

    Args:
        image: (h, w) grey levels.
        predicted: the lattice of the whole board, with the corners seen.
        plain: how far from its edges a square is of one colour, squares.

    Raises:
        NoBoardError: if too few corners are left.
    """
    reach = _TEMPLATE_REACH * plain
    lattice, rejected = refine_corners(image, predicted, reach)
    for _ in range(_MAX_ROUNDS):
        more, lost = refine_corners(image, lattice, reach)
        if len(more) <= len(lattice):
            break
        lattice, rejected = more, lost
    return lattice, rejected


def fit_tagged_corners(
    image: GreyImage, lattice: Lattice, plain: float
) -> tuple[Lattice, XCornerFit, list[RejectedCorner]]:
    """Fit the model of two crossing edges, leaving out the corners that it does not describe.

    Args:
        image: (h, w) grey levels.
        lattice: the corners, in the lattice of the whole board.
        plain: how far from its edges a square is of one colour, squares.

    Returns:
        The corners that the model describes, their fit, and the others.

    Raises:
        NoBoardError: if too few corners are left.
    """
    rejected: list[RejectedCorner] = []
    limit = THRESHOLDS.verification.suspect_relative_residual
    while True:
        require_enough_corners(lattice)
        found = lattice.found
        outermost = np.ones(lattice.shape, dtype=np.bool_)
        outermost[1:-1, 1:-1] = False
        fit = x_corner_fit.fit_x_corners(image, lattice, plain)
        suspect = outermost[found] | (fit.residual > limit * np.median(fit.residual))
        fit = _fit_again_near(image, lattice, plain, fit, suspect)
        good = verification.find_described_corners(fit, lattice)
        if good.all():
            return lattice, fit, rejected
        rejected += list_rejected_corners(lattice.uv[found][~good], "not two crossing edges")
        found[found] = good
        lattice = lattice.select(found)


def _fit_again_near(
    image: GreyImage, lattice: Lattice, plain: float, fit: XCornerFit, suspect: BoolArray
) -> XCornerFit:
    """Return the fit with the suspect corners (n,) fitted to what is plain around them only, where
    that is enough."""
    found = lattice.found
    large = plain * lattice.spacing() > _MIN_ARM
    if np.count_nonzero(found & large) < _MIN_CORNERS:
        return fit
    places = np.argwhere(found & large)[:, ::-1].astype(np.float64)
    near = x_corner_fit.fit_x_corners(
        image, lattice.select(large), priors=NearPriors(places, 2 * plain)
    )
    return replace_fits(fit, near, large[found], suspect[large[found]])

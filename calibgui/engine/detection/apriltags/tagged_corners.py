"""The corners of a checkerboard with tags, from their places in its lattice.

The corners are refined and verified like those of a checkerboard, but what is looked at is plain
only near the edges: in a square with a tag its border. That tells enough of contrast and blur to
take the tags out of the image (`tag_removal`), and what is fitted in the end is a plain
checkerboard: blurred cells of tags would draw the corners of small squares aside.

Beyond the outermost corners the print may end, or a frame begin, within less than half a square.
The edges are therefore fitted twice, all along and only near the corner; the second fit is taken on
the outermost lines, and where the first leaves more unexplained than it does elsewhere.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import GreyImage
from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard
from calibgui.engine.detection.apriltags.tag_removal import remove_tags
from calibgui.engine.detection.charuco.corners_between_markers import (
    refine_corners,
    require_enough_corners,
)
from calibgui.engine.detection.checkerboard import verification, x_corner_fit
from calibgui.engine.detection.checkerboard.near_fit import fit_near
from calibgui.engine.detection.checkerboard.x_corner_fit import XCornerFit
from calibgui.engine.detection.corners import RejectedCorner
from calibgui.engine.detection.detector_io import list_rejected_corners
from calibgui.engine.detection.lattice import Lattice

_TEMPLATE_REACH = 1.5
"""Ratio of the part of a square that the typical corner may be taken from to the part that is
plain: its samples lie in the inner two thirds of that part."""
_MAX_ROUNDS = 8
"""Number of times that the corners beside those found are tried."""
_REMOVALS = 2
"""Number of times that tags are removed as the corners were fitted last: a third moved no corner of
rendered boards of blurred tags by a tenth of its error."""
_NEAR = 0.25
"""Distance from suspect corners beyond which nothing is looked at, squares."""


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
    image: GreyImage, lattice: Lattice, pattern: TaggedCheckerboard, plain: float
) -> tuple[Lattice, XCornerFit, list[RejectedCorner]]:
    """Fit the model of two crossing edges, leaving out the corners that it does not describe.

    Args:
        image: (h, w) grey levels.
        lattice: the corners, in the lattice of the whole board.
        pattern: what is printed; its family, border and step are known.
        plain: how far from its edges a square is of one colour, squares.

    Returns:
        The corners that the model describes, their fit, and the others.

    Raises:
        NoBoardError: if too few corners are left.
    """
    rejected: list[RejectedCorner] = []
    while True:
        require_enough_corners(lattice)
        found = lattice.found
        outermost = np.ones(lattice.shape, dtype=np.bool_)
        outermost[1:-1, 1:-1] = False
        fit = x_corner_fit.fit_x_corners(image, lattice, plain, own_light=False)
        for _ in range(_REMOVALS):
            bare = remove_tags(image, lattice, fit, pattern)
            fit = x_corner_fit.fit_x_corners(bare, lattice, own_light=False)
        suspect = outermost[found] | verification.find_suspect_corners(fit.residual)
        fit = fit_near(bare, lattice, _NEAR, fit, suspect, own_light=False)
        good = verification.find_described_corners(fit, lattice)
        if good.all():
            return lattice, fit, rejected
        rejected += list_rejected_corners(lattice.uv[found][~good], "not two crossing edges")
        found[found] = good
        lattice = lattice.select(found)

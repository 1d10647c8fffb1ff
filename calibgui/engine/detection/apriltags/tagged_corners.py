"""The corners of a checkerboard with tags, from their places in its lattice.

The corners are refined and verified like those of a checkerboard, but what is looked at is plain
only near the edges: in a square with a tag its border. That tells enough of contrast and blur to
take the tags out of the image (`marker_subtraction`), and what is fitted in the end is a plain
checkerboard: blurred cells of tags would draw the corners of small squares aside.

Beyond the outermost corners the print may end, or a frame begin, within less than half a square.
The edges are therefore fitted twice, all along and only near the corner; the second fit is taken on
the outermost lines, and where the first leaves more unexplained than it does elsewhere.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import GreyImage, GridSize
from calibgui.engine.boards.apriltags import load_family
from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard
from calibgui.engine.corner_fit import verification
from calibgui.engine.corner_fit.robust_fit import NEAR, fit_near
from calibgui.engine.corner_fit.x_corner_fit import XCornerFit
from calibgui.engine.detection.charuco.corners_between_markers import (
    refine_and_extend_corners,
    require_enough_corners,
)
from calibgui.engine.detection.charuco.marker_subtraction import Marks, fit_without_marks
from calibgui.engine.detection.detector_io import list_rejected_corners
from calibgui.engine.features.corners import RejectedCorner
from calibgui.engine.features.lattice import Lattice

_TEMPLATE_REACH = 1.5
"""Ratio of the part of a square that the typical corner may be taken from to the part that is
plain: its samples lie in the inner two thirds of that part."""


def refine_tagged_corners(
    image: GreyImage, predicted: Lattice, bare_reach: float
) -> tuple[Lattice, list[RejectedCorner]]:
    """Move corners to their saddle points, verify them, and try the places beside them; see
    `refine_and_extend_corners`."""
    return refine_and_extend_corners(image, predicted, _TEMPLATE_REACH * bare_reach)


def fit_tagged_corners(
    image: GreyImage, lattice: Lattice, pattern: TaggedCheckerboard, bare_reach: float
) -> tuple[Lattice, XCornerFit, list[RejectedCorner]]:
    """Fit the model of two crossing edges, leaving out the corners that it does not describe.

    Args:
        image: (h, w) grey levels.
        lattice: the corners, in the lattice of the whole board.
        pattern: what is printed; its family, border and step are known.
        bare_reach: how far from its edges a square is of one colour, squares.

    Returns:
        The corners that the model describes, their fit, and the others.

    Raises:
        NoBoardError: if too few corners are left.
    """
    rejected: list[RejectedCorner] = []
    tags = list_tags(pattern, lattice.shape)
    while True:
        require_enough_corners(lattice)
        found = lattice.found
        outermost = np.ones(lattice.shape, dtype=np.bool_)
        outermost[1:-1, 1:-1] = False
        fit, bare = fit_without_marks(image, lattice, tags, bare_reach)
        near = bare_reach if bare is image else NEAR
        suspect = outermost[found] | verification.find_suspect_corners(fit.residual)
        fit = fit_near(bare, lattice, near, fit, suspect)
        good = verification.find_described_corners(fit, lattice)
        if good.all():
            return lattice, fit, rejected
        rejected += list_rejected_corners(lattice.uv[found][~good], "not two crossing edges")
        found[found] = good
        lattice = lattice.select(found)


def list_tags(pattern: TaggedCheckerboard, grid_size: GridSize) -> Marks:
    """List the tags that are printed in the squares of a board; its family, border and step are
    known."""
    family, border = str(pattern.family), pattern.border or 1
    squares = pattern.locate_tags(grid_size)
    bright = ~load_family(family).cells[: len(squares)]
    bright = np.pad(bright, ((0, 0), (border, border), (border, border)))
    return Marks(squares[: len(bright)], bright, margin=0.0)

"""Detection: from an image to corners with covariances, whatever board it shows.

`find_corners` finds the board and returns `Corners`: positions, covariances and places on the
board, with the corners that were rejected and why. `look_for_marks` tells whether a checkerboard
may bear `Marks` that another detector reads. `find_usable_covariances` tells which covariances a
corner can be weighed with, whoever located it. `METHODS` names the methods, `MIN_LINES` the least
number of rows and of columns of a checkerboard, and `check_outline` checks a region of interest.
The other functions are steps of the checkerboard detector, for those who
draw or compare them: `find_saddles` and `classify_saddles` find X-junctions in a small image,
`refine_saddles` moves estimates to saddle points. Detection knows no camera model and no solver.
"""

from __future__ import annotations

from calibgui.engine.detection.checkerboard.find_checkerboard import METHODS
from calibgui.engine.detection.checkerboard.saddle import refine_saddles
from calibgui.engine.detection.checkerboard.x_junctions import classify_saddles, find_saddles
from calibgui.engine.detection.corners import (
    Corners,
    OtherBoard,
    RejectedCorner,
    find_usable_covariances,
)
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.detection.lattice import MIN_LINES
from calibgui.engine.detection.printed_marks import Marks, look_for_marks
from calibgui.engine.detection.region_of_interest import check_outline

__all__ = [
    "METHODS",
    "MIN_LINES",
    "Corners",
    "Marks",
    "OtherBoard",
    "RejectedCorner",
    "check_outline",
    "classify_saddles",
    "find_corners",
    "find_saddles",
    "find_usable_covariances",
    "look_for_marks",
    "refine_saddles",
]

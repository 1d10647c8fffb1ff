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

from typing import TYPE_CHECKING

from calibgui.engine.faces import load_on_demand

if TYPE_CHECKING:
    from calibgui.engine.detection.checkerboard.saddle import refine_saddles as refine_saddles
    from calibgui.engine.detection.checkerboard.x_junctions import (
        classify_saddles as classify_saddles,
        find_saddles as find_saddles,
    )
    from calibgui.engine.detection.corners import (
        METHODS as METHODS,
        Corners as Corners,
        OtherBoard as OtherBoard,
        RejectedCorner as RejectedCorner,
        find_usable_covariances as find_usable_covariances,
    )
    from calibgui.engine.detection.find_corners import find_corners as find_corners
    from calibgui.engine.detection.lattice import MIN_LINES as MIN_LINES
    from calibgui.engine.detection.printed_marks import (
        Marks as Marks,
        look_for_marks as look_for_marks,
    )
    from calibgui.engine.detection.region_of_interest import check_outline as check_outline

load_on_demand(
    __name__,
    {
        "checkerboard.saddle": ["refine_saddles"],
        "checkerboard.x_junctions": ["classify_saddles", "find_saddles"],
        "corners": [
            "METHODS",
            "Corners",
            "OtherBoard",
            "RejectedCorner",
            "find_usable_covariances",
        ],
        "find_corners": ["find_corners"],
        "lattice": ["MIN_LINES"],
        "printed_marks": ["Marks", "look_for_marks"],
        "region_of_interest": ["check_outline"],
    },
)

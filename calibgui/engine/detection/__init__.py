"""Detection: from an image to the corners of the board that it shows, one way for each kind.

`find_corners` finds the board and returns its corners: positions, covariances and places on the
board, with the corners that were rejected and why. `look_for_marks` tells whether a checkerboard
may bear `Marks` that another detector reads. Detection knows no camera model and no solver.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from calibgui.engine.faces import load_on_demand

if TYPE_CHECKING:
    from calibgui.engine.detection.find_corners import find_corners as find_corners
    from calibgui.engine.detection.printed_marks import (
        Marks as Marks,
        look_for_marks as look_for_marks,
    )

load_on_demand(
    __name__,
    {
        "find_corners": ["find_corners"],
        "printed_marks": ["Marks", "look_for_marks"],
    },
)

"""Features: what a patch of pixels tells by itself, and the records of corners found.

A patch tells whether two edges cross in it (`harris`, `corner_template`), where they do so
(`saddle`), how wide and how straight its edges are (`edge_profiles`, `edge_intensity`) and how
large its noise is (`pixel_noise`); nothing is fitted to more than one corner. `Corners` are what a
detector returns, with their places on the board, located by one of the `METHODS`, and with each
`RejectedCorner` and `OtherBoard`. `find_usable_covariances` tells which covariances a corner can be
weighed with, whoever located it. `MIN_LINES` is the least number of rows and of columns of a
board. `refine_saddles` moves estimates to saddle points.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from calibgui.engine.faces import load_on_demand

if TYPE_CHECKING:
    from calibgui.engine.features.corners import (
        METHODS as METHODS,
        Corners as Corners,
        OtherBoard as OtherBoard,
        RejectedCorner as RejectedCorner,
        find_usable_covariances as find_usable_covariances,
    )
    from calibgui.engine.features.lattice import MIN_LINES as MIN_LINES
    from calibgui.engine.features.saddle import refine_saddles as refine_saddles

load_on_demand(
    __name__,
    {
        "corners": [
            "METHODS",
            "Corners",
            "OtherBoard",
            "RejectedCorner",
            "find_usable_covariances",
        ],
        "lattice": ["MIN_LINES"],
        "saddle": ["refine_saddles"],
    },
)

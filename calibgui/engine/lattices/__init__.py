"""Lattices: from points to rows and columns, and whether these may be a board.

In reading order: `pyramid_search` goes through the levels of the image; in each `x_junctions` finds
points where four squares may meet, `neighbour_graph` joins them to lattices, `prefilter` drops
those that cannot be boards and `lattice_growth` extends the others. `grid_map` maps a lattice to
the image smoothly. `board_ends` tells where a board ends, `board_separation` takes boards that were
joined apart, and `a_contrario` tells what chance could have made. `numbering` gives corners their
rows and columns.

Lengths on the board are in squares or, what is the same, in steps of the lattice, so that they do
not depend on the size of the board in the image. Unless a limit says otherwise its value is a
plausibility limit; a limit that images without a board fixed names their kind in
``tests.scenes.without_board``. `python -m tests.benchmarks.corners` counts the boards found under
each of its conditions and those seen where there is none.

The face is for those who draw or compare the steps: `find_saddles` and `classify_saddles` find
X-junctions in a small image; and `check_outline` checks a region of interest. `LIKE_DOTS` is the
reason to refuse a lattice that a stated size overrules.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from calibgui.engine.faces import load_on_demand

if TYPE_CHECKING:
    from calibgui.engine.lattices.prefilter import LIKE_DOTS as LIKE_DOTS
    from calibgui.engine.lattices.region_of_interest import check_outline as check_outline
    from calibgui.engine.lattices.x_junctions import (
        classify_saddles as classify_saddles,
        find_saddles as find_saddles,
    )

load_on_demand(
    __name__,
    {
        "prefilter": ["LIKE_DOTS"],
        "region_of_interest": ["check_outline"],
        "x_junctions": ["classify_saddles", "find_saddles"],
    },
)

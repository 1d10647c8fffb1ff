"""Locating the corners of a checkerboard.

`find_corners` runs the whole line: candidates (`junctions`), lattices (`links`, `lattice`,
`growth`), coarse to fine (`finder`) or in a marked region (`roi`), refinement (`settle` by
`saddle`, `edges`) and acceptance (`verify`, `appearance`) of each board (`located`), numbering
(`ordering`), first estimates as the paper has them (`harris`).
"""

from calibgui.engine.corners.extract import find_corners
from calibgui.engine.corners.located import METHODS

__all__ = ["METHODS", "find_corners"]

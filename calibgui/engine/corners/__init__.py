"""Locating the corners of a checkerboard.

`find_corners` runs the whole line: candidates (`junctions`), lattices (`lattice`, `growth`),
coarse to fine (`finder`) or in a marked region (`roi`), first estimates (`harris`), refinement
(`saddle`), acceptance (`verify`), numbering (`ordering`).
"""

from calibgui.engine.corners.extract import METHODS, find_corners

__all__ = ["METHODS", "find_corners"]

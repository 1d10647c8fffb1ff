"""From an image to corners with covariances, whatever board it shows."""

from __future__ import annotations

from calibgui.engine.detection.checkerboard.find_checkerboard import METHODS
from calibgui.engine.detection.checkerboard.saddle import refine_saddles
from calibgui.engine.detection.checkerboard.x_junctions import classify, find_saddles
from calibgui.engine.detection.corners import Corners, OtherBoard, RejectedCorner
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.detection.lattice import MIN_LINES
from calibgui.engine.detection.region_of_interest import outline

__all__ = [
    "METHODS",
    "MIN_LINES",
    "Corners",
    "OtherBoard",
    "RejectedCorner",
    "classify",
    "find_corners",
    "find_saddles",
    "outline",
    "refine_saddles",
    "saddle",
]

"""A finding: something that is wrong with a calibration and matters to who uses it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Cause(StrEnum):
    """The causes that a finding can name."""

    WRONG_FRAME = "wrong-frame"
    HELD_VALUE = "held-value"
    MISPLACED_CORNERS = "misplaced-corners"
    LENS = "lens"
    BOARD_SHAPE = "board-shape"
    FOCUS = "focus"
    BENDING_BOARD = "bending-board"
    ROLLING_SHUTTER = "rolling-shutter"
    LINE_JITTER = "line-jitter"
    MIXED_VIEWS = "mixed-views"
    """Photographs of two cameras, zooms or boards; the evidence seldom tells which."""
    DISAGREEMENT = "views-disagree"
    """The views disagree about the camera, and the evidence singles no cause out."""
    BLUR = "blur"
    FEW_VIEWS = "few-views"


@dataclass(frozen=True, slots=True)
class Finding:
    """Something that is wrong with a calibration and matters to who uses it."""

    cause: Cause
    """The cause that the evidence singles out."""
    message: str
    """A sentence that says what is wrong."""
    evidence: str
    """A sentence with the figures that show it."""
    remedy: str
    """A sentence that says what to do."""
    harm: float
    """Error of pixels that it causes, px: at the image's edge, or rms where that is what is known.
    """
    views: tuple[int, ...] = ()
    """Indices of the views that it is found in; none if it is in all of them."""

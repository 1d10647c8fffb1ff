"""The numbers by which the detector of ChArUco boards accepts and rejects, in one record.

They are plausibility limits: no benchmark has fixed them. ``tests/engine/detection/charuco``
exercises the detector. Corners themselves pass or fail by the tests of the checkerboard detector.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class CharucoThresholds:
    """The thresholds of the detector of ChArUco boards."""

    max_border_error_share: float = 0.35
    """Greatest number of bright cells in a marker's border over the number of its inner cells:
    OpenCV's."""
    min_markers: int = 3
    """Least number of markers that agree on a board."""
    min_markers_if_stated: int = 2
    """Least number of markers that agree on a board of stated size and have a corner between them:
    OpenCV's."""
    max_marker_distances: tuple[int, ...] = (2, 6)
    """Greatest distance along either axis of markers that are compared with each other, squares;
    the second where those within the first agree with several layouts."""
    min_marker_side: float = 0.2
    """Least side of a marker, squares."""
    max_pair_disagreement: float = 0.25
    """Greatest difference between a pair's distance in the image and on the board, over the number
    of squares between them."""
    max_side_difference: float = 0.1
    """Greatest difference of the measured side of a marker from the stated one, squares."""
    max_placing_distance: float = 0.8
    """Greatest distance of a corner from the centre of the nearest marker that was read,
    squares."""
    min_deciding_corners: int = 3
    """Least number by which the corners of one colour of the first square must outnumber those of
    the other, where the markers agree with both."""
    min_corners: int = 6
    """Least number of corners of a board, in at least two rows and two columns."""


CHARUCO_THRESHOLDS = CharucoThresholds()
"""The thresholds in use."""

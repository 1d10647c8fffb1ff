"""Redetection: what a calibrated camera tells about images that were searched without it.

Once the camera is known, `redetect_corners` finds corners that the detectors missed, because the
camera tells where they must be. `label_corners` and `align_board_turns` number the corners of
symmetric boards alike in all views, because all views must agree about the board's deviations from
its drawing. The other functions are the steps between: `calibrate_on_nominal_board` before the
labels, `apply_labels` and `carry_labels` after them.
"""

from __future__ import annotations

from calibgui.engine.redetection.labelling import (
    CornerLabels,
    align_board_turns,
    apply_labels,
    calibrate_on_nominal_board,
    carry_labels,
    carry_places,
    find_upside_down_views,
    has_open_labels,
    label_corners,
)
from calibgui.engine.redetection.redetect_corners import are_edges_bent, redetect_corners

__all__ = [
    "CornerLabels",
    "align_board_turns",
    "apply_labels",
    "are_edges_bent",
    "calibrate_on_nominal_board",
    "carry_labels",
    "carry_places",
    "find_upside_down_views",
    "has_open_labels",
    "label_corners",
    "redetect_corners",
]

"""Redetection: what a calibrated camera tells about images that were searched without it.

Once the camera is known, `redetect_corners` finds corners that the detectors missed, because the
camera tells where they must be. `label_corners` and `align_board_turns` number the corners of
symmetric boards alike in all views, because all views must agree about the board's deviations from
its drawing. The other functions are the steps between: `calibrate_on_nominal_board` before the
labels, `apply_labels` and `carry_labels` after them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from calibgui.engine.faces import load_on_demand

if TYPE_CHECKING:
    from calibgui.engine.redetection.labelling import (
        CornerLabels as CornerLabels,
        align_board_turns as align_board_turns,
        apply_labels as apply_labels,
        calibrate_on_nominal_board as calibrate_on_nominal_board,
        carry_labels as carry_labels,
        carry_places as carry_places,
        find_upside_down_views as find_upside_down_views,
        has_open_labels as has_open_labels,
        label_corners as label_corners,
    )
    from calibgui.engine.redetection.redetect_corners import (
        are_edges_bent as are_edges_bent,
        redetect_corners as redetect_corners,
    )

load_on_demand(
    __name__,
    {
        "labelling": [
            "CornerLabels",
            "align_board_turns",
            "apply_labels",
            "calibrate_on_nominal_board",
            "carry_labels",
            "carry_places",
            "find_upside_down_views",
            "has_open_labels",
            "label_corners",
        ],
        "redetect_corners": ["are_edges_bent", "redetect_corners"],
    },
)

"""How far a calibration is to be trusted: residuals, outliers, unseen views, comparison."""

from __future__ import annotations

from calibgui.engine.assessment.comparison import Difference, compare_cameras
from calibgui.engine.assessment.cross_validation import (
    BoardShapeChoice,
    Bootstrap,
    CrossValidation,
    bootstrap,
    choose_board_shape,
    cross_validate,
)
from calibgui.engine.assessment.noise_test import NoiseReport, examine
from calibgui.engine.assessment.outliers import screen
from calibgui.engine.assessment.residual_statistics import (
    Histogram,
    Summary,
    component_histogram,
    length_histogram,
    stacked,
    summarise,
)
from calibgui.engine.assessment.view_weights import calibrate_weighted

__all__ = [
    "BoardShapeChoice",
    "Bootstrap",
    "CrossValidation",
    "Difference",
    "Histogram",
    "NoiseReport",
    "Summary",
    "bootstrap",
    "calibrate_weighted",
    "choose_board_shape",
    "compare_cameras",
    "component_histogram",
    "cross_validate",
    "examine",
    "length_histogram",
    "screen",
    "stacked",
    "summarise",
]

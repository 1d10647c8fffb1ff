"""Assessment of a calibration: residuals, outliers, errors on unseen views, comparison.

`judge_calibration` says what a calibration is worth and what makes it better, `list_findings` what
is wrong with it and matters, the most harmful first; `find_explanation` picks the one of them that
explains residuals which are not noise.
`summarise_residuals` states how well the model fits, `check_residuals` whether what is left is
noise or has a cause, `separate_error_sources` how many pixels lens, board, single views and noise
contribute; `screen_outliers` leaves wrong corners out, `calibrate_weighted` weighs views
by their noise; `cross_validate` and `bootstrap_views` measure errors without trusting the model,
`choose_board_shape` and `choose_lens` recommend models of board and lens by them; `compare_methods`
tries all methods of calibration side by side; `compare_cameras` maps the difference of two
calibrations over the image, `measure_drift` says whether their uncertainties explain it, and
`fit_series` describes a camera that varies with zoom or temperature; `check_calibration` says
whether a stored camera is still good for new pictures.
"""

from __future__ import annotations

from calibgui.engine.assessment.calibration_check import (
    CONFIDENCE,
    DEFAULT_LIMIT,
    CalibrationCheck,
    CheckedView,
    CheckVerdict,
    Weakness,
    check_calibration,
)
from calibgui.engine.assessment.comparison import CameraDifference, compare_cameras
from calibgui.engine.assessment.cross_validation import (
    BoardShapeChoice,
    Bootstrap,
    CrossValidation,
    Fold,
    bootstrap_views,
    choose_board_shape,
    cross_validate,
)
from calibgui.engine.assessment.drift import (
    SIGNIFICANCE,
    Drift,
    UncertainCamera,
    choose_covariance,
    measure_drift,
)
from calibgui.engine.assessment.error_sources import ErrorSources, separate_error_sources
from calibgui.engine.assessment.finding import (
    REMEDY_OF_LENS,
    Action,
    ActionKind,
    Cause,
    Finding,
    find_explanation,
)
from calibgui.engine.assessment.findings import list_findings
from calibgui.engine.assessment.fleet_spread import (
    MIN_FLEET,
    OUTLIER_Z,
    FleetSpread,
    measure_fleet_spread,
)
from calibgui.engine.assessment.lens_choice import (
    CANDIDATES,
    SIMPLEST_MODEL,
    LensChoice,
    choose_lens,
    choose_lens_stepwise,
)
from calibgui.engine.assessment.lens_trial import LensTrial
from calibgui.engine.assessment.method_comparison import (
    Distortion,
    LineTrial,
    MethodComparison,
    MethodTrial,
    compare_methods,
    measure_radial_shift,
)
from calibgui.engine.assessment.outliers import Rejection, Screening, screen_outliers
from calibgui.engine.assessment.residual_checks import NoiseCheck, NoiseReport, check_residuals
from calibgui.engine.assessment.residual_statistics import (
    Histogram,
    ResidualSummary,
    make_component_histogram,
    make_length_histogram,
    stack_residuals,
    summarise_residuals,
)
from calibgui.engine.assessment.series import MIN_SETTINGS, SPLINE, Series, Setting, fit_series
from calibgui.engine.assessment.verdict import Grade, PixelError, Verdict, judge_calibration
from calibgui.engine.assessment.view_weights import calibrate_weighted

__all__ = [
    "CANDIDATES",
    "CONFIDENCE",
    "DEFAULT_LIMIT",
    "MIN_FLEET",
    "MIN_SETTINGS",
    "OUTLIER_Z",
    "REMEDY_OF_LENS",
    "SIGNIFICANCE",
    "SIMPLEST_MODEL",
    "SPLINE",
    "Action",
    "ActionKind",
    "BoardShapeChoice",
    "Bootstrap",
    "CalibrationCheck",
    "CameraDifference",
    "Cause",
    "CheckVerdict",
    "CheckedView",
    "CrossValidation",
    "Distortion",
    "Drift",
    "ErrorSources",
    "Finding",
    "FleetSpread",
    "Fold",
    "Grade",
    "Histogram",
    "LensChoice",
    "LensTrial",
    "LineTrial",
    "MethodComparison",
    "MethodTrial",
    "NoiseCheck",
    "NoiseReport",
    "PixelError",
    "Rejection",
    "ResidualSummary",
    "Screening",
    "Series",
    "Setting",
    "UncertainCamera",
    "Verdict",
    "Weakness",
    "bootstrap_views",
    "calibrate_weighted",
    "check_calibration",
    "check_residuals",
    "choose_board_shape",
    "choose_covariance",
    "choose_lens",
    "choose_lens_stepwise",
    "compare_cameras",
    "compare_methods",
    "cross_validate",
    "find_explanation",
    "fit_series",
    "judge_calibration",
    "list_findings",
    "make_component_histogram",
    "make_length_histogram",
    "measure_drift",
    "measure_fleet_spread",
    "measure_radial_shift",
    "screen_outliers",
    "separate_error_sources",
    "stack_residuals",
    "summarise_residuals",
]

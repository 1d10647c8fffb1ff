"""Assessment of a calibration: residuals, outliers, errors on unseen views, comparison.

`judge_calibration` says what a calibration is worth and what makes it better, `list_findings` what
is wrong with it and matters, the most harmful first; `find_explanation` picks the one of them that
explains residuals which are not noise.
`summarise_residuals` states how well the model fits, `check_residuals` whether what is left is
noise or has a cause, `measure_repeatability` how far corners scatter where nothing moves,
`separate_error_sources` how many pixels lens, board, single views and noise
contribute; `screen_outliers` leaves wrong corners out, `calibrate_weighted` weighs views
by their noise; `cross_validate` and `bootstrap_views` measure errors without trusting the model,
`choose_board_shape` and `choose_lens` recommend models of board and lens by them; `compare_methods`
tries all methods of calibration side by side; `compare_cameras` maps the difference of two
calibrations over the image, `measure_drift` says whether their uncertainties explain it, and
`fit_series` describes a camera that varies with zoom or temperature; `check_calibration` says
whether a stored camera is still good for new pictures.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from calibgui.engine.faces import load_on_demand

if TYPE_CHECKING:
    from calibgui.engine.assessment.changes.calibration_check import (
        CONFIDENCE as CONFIDENCE,
        DEFAULT_LIMIT as DEFAULT_LIMIT,
        CalibrationCheck as CalibrationCheck,
        CheckedView as CheckedView,
        CheckVerdict as CheckVerdict,
        Weakness as Weakness,
        check_calibration as check_calibration,
    )
    from calibgui.engine.assessment.changes.comparison import (
        CameraDifference as CameraDifference,
        compare_cameras as compare_cameras,
    )
    from calibgui.engine.assessment.choices.board_shape_choice import (
        BoardShapeChoice as BoardShapeChoice,
        choose_board_shape as choose_board_shape,
    )
    from calibgui.engine.assessment.choices.cross_validation import (
        Bootstrap as Bootstrap,
        CrossValidation as CrossValidation,
        Fold as Fold,
        bootstrap_views as bootstrap_views,
        cross_validate as cross_validate,
    )
    from calibgui.engine.assessment.changes.drift import (
        SIGNIFICANCE as SIGNIFICANCE,
        Drift as Drift,
        UncertainCamera as UncertainCamera,
        choose_covariance as choose_covariance,
        measure_drift as measure_drift,
    )
    from calibgui.engine.assessment.residuals.error_sources import (
        ErrorSources as ErrorSources,
        separate_error_sources as separate_error_sources,
    )
    from calibgui.engine.assessment.action import (
        AUTO as AUTO,
        Action as Action,
        ActionKind as ActionKind,
        Change as Change,
    )
    from calibgui.engine.assessment.finding import (
        MIN_GAIN_TO_ACT as MIN_GAIN_TO_ACT,
        MIN_HARM_PX as MIN_HARM_PX,
        REMEDY_OF_LENS as REMEDY_OF_LENS,
        Cause as Cause,
        Finding as Finding,
        find_explanation as find_explanation,
    )
    from calibgui.engine.assessment.causes.findings import list_findings as list_findings
    from calibgui.engine.assessment.changes.fleet_spread import (
        MIN_FLEET as MIN_FLEET,
        OUTLIER_Z as OUTLIER_Z,
        FleetSpread as FleetSpread,
        measure_fleet_spread as measure_fleet_spread,
    )
    from calibgui.engine.assessment.choices.lens_choice import (
        CANDIDATES as CANDIDATES,
        SIMPLEST_MODEL as SIMPLEST_MODEL,
        LensChoice as LensChoice,
        choose_lens as choose_lens,
        choose_lens_stepwise as choose_lens_stepwise,
    )
    from calibgui.engine.assessment.choices.lens_trial import LensTrial as LensTrial
    from calibgui.engine.assessment.choices.method_comparison import (
        Distortion as Distortion,
        LineTrial as LineTrial,
        MethodComparison as MethodComparison,
        MethodTrial as MethodTrial,
        compare_methods as compare_methods,
        measure_radial_shift as measure_radial_shift,
    )
    from calibgui.engine.assessment.residuals.outliers import (
        Rejection as Rejection,
        Screening as Screening,
        screen_outliers as screen_outliers,
    )
    from calibgui.engine.assessment.changes.repeatability import (
        Repeatability as Repeatability,
        measure_repeatability as measure_repeatability,
    )
    from calibgui.engine.assessment.residuals.residual_checks import (
        FAR_OFF as FAR_OFF,
        NoiseCheck as NoiseCheck,
        NoiseReport as NoiseReport,
        check_residuals as check_residuals,
    )
    from calibgui.engine.assessment.residuals.residual_statistics import (
        Histogram as Histogram,
        ResidualSummary as ResidualSummary,
        make_component_histogram as make_component_histogram,
        make_length_histogram as make_length_histogram,
        stack_residuals as stack_residuals,
        summarise_residuals as summarise_residuals,
    )
    from calibgui.engine.assessment.changes.length_uncertainty import (
        LengthUncertainty as LengthUncertainty,
        estimate_length_uncertainty as estimate_length_uncertainty,
    )
    from calibgui.engine.assessment.changes.series import (
        MIN_SETTINGS as MIN_SETTINGS,
        SPLINE as SPLINE,
        Series as Series,
        Setting as Setting,
        fit_series as fit_series,
    )
    from calibgui.engine.assessment.verdict import (
        MIN_VIEWS_TO_BE_GOOD as MIN_VIEWS_TO_BE_GOOD,
        Grade as Grade,
        PixelError as PixelError,
        Verdict as Verdict,
        judge_calibration as judge_calibration,
    )
    from calibgui.engine.assessment.residuals.view_weights import (
        calibrate_weighted as calibrate_weighted,
    )

load_on_demand(
    __name__,
    {
        "changes.calibration_check": [
            "CONFIDENCE",
            "DEFAULT_LIMIT",
            "CalibrationCheck",
            "CheckedView",
            "CheckVerdict",
            "Weakness",
            "check_calibration",
        ],
        "changes.comparison": ["CameraDifference", "compare_cameras"],
        "choices.board_shape_choice": ["BoardShapeChoice", "choose_board_shape"],
        "choices.cross_validation": [
            "Bootstrap",
            "CrossValidation",
            "Fold",
            "bootstrap_views",
            "cross_validate",
        ],
        "changes.drift": [
            "SIGNIFICANCE",
            "Drift",
            "UncertainCamera",
            "choose_covariance",
            "measure_drift",
        ],
        "residuals.error_sources": ["ErrorSources", "separate_error_sources"],
        "action": ["AUTO", "Action", "ActionKind", "Change"],
        "finding": [
            "MIN_GAIN_TO_ACT",
            "MIN_HARM_PX",
            "REMEDY_OF_LENS",
            "Cause",
            "Finding",
            "find_explanation",
        ],
        "causes.findings": ["list_findings"],
        "changes.fleet_spread": ["MIN_FLEET", "OUTLIER_Z", "FleetSpread", "measure_fleet_spread"],
        "choices.lens_choice": [
            "CANDIDATES",
            "SIMPLEST_MODEL",
            "LensChoice",
            "choose_lens",
            "choose_lens_stepwise",
        ],
        "choices.lens_trial": ["LensTrial"],
        "choices.method_comparison": [
            "Distortion",
            "LineTrial",
            "MethodComparison",
            "MethodTrial",
            "compare_methods",
            "measure_radial_shift",
        ],
        "residuals.outliers": ["Rejection", "Screening", "screen_outliers"],
        "changes.repeatability": ["Repeatability", "measure_repeatability"],
        "residuals.residual_checks": ["FAR_OFF", "NoiseCheck", "NoiseReport", "check_residuals"],
        "residuals.residual_statistics": [
            "Histogram",
            "ResidualSummary",
            "make_component_histogram",
            "make_length_histogram",
            "stack_residuals",
            "summarise_residuals",
        ],
        "changes.length_uncertainty": ["LengthUncertainty", "estimate_length_uncertainty"],
        "changes.series": ["MIN_SETTINGS", "SPLINE", "Series", "Setting", "fit_series"],
        "verdict": ["MIN_VIEWS_TO_BE_GOOD", "Grade", "PixelError", "Verdict", "judge_calibration"],
        "residuals.view_weights": ["calibrate_weighted"],
    },
)

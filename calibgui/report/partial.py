"""Partial calibrations in words: the assumptions, and what is determined all the same."""

from __future__ import annotations

import numpy as np

from calibgui.engine.calibration import Calibration, Diagnosis
from calibgui.report.numbers import format_with_sigma


def describe_assumptions(diagnosis: Diagnosis) -> str:
    """Describe what was assumed of the quantities that the views leave open."""
    if not diagnosis.assumptions:
        return (
            "Nothing had to be assumed, but what is said of focal length and principal point "
            "rests on the lens's distortion alone."
        )
    lengths = [a for a in diagnosis.assumptions if a.name[0] in "fc"]
    zero = [a.name for a in diagnosis.assumptions if a not in lengths]
    listed = [f"{a.name} = {format_with_sigma(a.value, a.sigma)}" for a in lengths]
    listed += [f"{', '.join(zero)} = 0"] if zero else []
    follows = "The other focal length and the coefficients go with it. "
    return (
        f"Assumed, as of an ordinary camera: {', '.join(listed)}. "
        + follows * is_scale_assumed(diagnosis)
        + "Every ± includes what this may be off by; what has a small ± is determined."
    )


def describe_aspect_ratio(calibration: Calibration) -> str:
    """Describe the aspect ratio, which is known although the focal length is assumed."""
    return (
        f"Determined all the same: fy/fx = {format_with_sigma(*compute_aspect_ratio(calibration))},"
        " and of the lens what has a small ± in the paper's units."
    )


def compute_aspect_ratio(calibration: Calibration) -> tuple[float, float]:
    """Compute fy/fx and its standard deviation."""
    fx, fy = calibration.camera.focal
    J = np.array([-fy / fx, 1.0]) / fx
    return float(fy / fx), float(np.sqrt(J @ calibration.covariance[:2, :2] @ J))


def is_scale_assumed(diagnosis: Diagnosis | None) -> bool:
    """Return whether the focal length is assumed, and all that goes with it."""
    return diagnosis is not None and any(a.name in ("fx", "fy") for a in diagnosis.assumptions)

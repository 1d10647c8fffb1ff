"""A camera whose zoom, focus or temperature varies: its parameters as functions of a scalar.

Calibrations at m settings s_i give parameters c_i with covariances C_i. Two kinds of functions
pass between them:

- **polynomials** of degree n in the scalar, alike for all parameters, by generalised least squares

      minimise over B    sum_i (c_i - B t_i)^T C_i^-1 (c_i - B t_i),    t_i = (1, s_i, ..., s_i^n),

  which average over the settings, and so are known better than any one of them;
- the **monotone spline** (Fritsch and Butland 1984), which passes through every c_i, does not
  overshoot, and is as uncertain as the settings beside it.

Which of them describes the camera is asked of unseen settings: each but the first and the last is
left out in turn, and the camera that the others predict there is compared with the measured one in
projected pixels (``comparison.py``), as single parameters trade against each other. The simplest
whose error is nearly the least is taken. Its covariance is widened by

    X = mean over unseen settings of (c - c_i)^T (C + C_i)^-1 (c - c_i) / P,

where that is more than 1: what the function misses between settings is part of its uncertainty.
Nothing is said beyond the first and the last setting.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.assessment.changes.comparison import compare_cameras
from calibgui.engine.assessment.changes.drift import UncertainCamera
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError

MIN_SETTINGS = 3
"""Least number of settings of a series: one of them can be left out."""
SPLINE = "spline"
"""Name of the monotone spline among the functions."""
_MAX_DEGREE = 6
"""Highest degree of a polynomial."""
_MAX_ERROR_OF_SIMPLE, _MIN_GAIN_PX = 1.05, 1e-3
"""Ratio to the least error on unseen settings, and difference from it, px, up to which a simpler
function is taken."""
_STEP = 1e-3
"""Step of the spline's derivatives by its knots, in the standard deviations of these."""


class Setting(NamedTuple):
    """A calibration at one value of the scalar."""

    value: float
    known: UncertainCamera


@dataclass(frozen=True, eq=False, slots=True)
class Series:
    """A camera as a function of a scalar."""

    settings: tuple[Setting, ...]
    """The calibrations, by ascending values."""
    function: str
    """Name of the function: "degree 0", ..., or "spline"."""
    errors: dict[str, float]
    """Error of each function on unseen settings, px rms over image and settings; the chosen one's
    is nearly the least."""
    inflation: float
    """Factor X, at least 1, on the covariances that the function has by itself."""

    def predict(self, value: float) -> UncertainCamera:
        """Return the camera at a value of the scalar, with its covariance.

        Raises:
            CalibrationError: if the value lies outside of the settings.
        """
        first, last = self.settings[0].value, self.settings[-1].value
        if not first <= value <= last:
            raise CalibrationError(
                f"{value:g} lies outside of the series, which reaches from {first:g} to {last:g}.",
                "Choose a value between, or calibrate at this one.",
            )
        found = _predict(self.function, self.settings, value)
        return found._replace(covariance=self.inflation * found.covariance)


def fit_series(settings: Sequence[Setting]) -> Series:
    """Fit functions of the scalar to calibrations, and choose one by unseen settings.

    Args:
        settings: at least three, at different values, of one lens model and image size and with
            the same parameters held.

    Raises:
        CalibrationError: if they are not.
    """
    ordered = tuple(sorted(settings, key=lambda setting: setting.value))
    _check_settings(ordered)
    names = [f"degree {n}" for n in range(min(_MAX_DEGREE, len(ordered) - 2) + 1)] + [SPLINE]
    errors, inflations = {}, {}
    for name in names:
        errors[name], inflations[name] = _leave_settings_out(name, ordered)
    least = min(errors.values())
    if not np.isfinite(least):
        raise CalibrationError(
            "The cameras of the series have too little in common to be compared.",
            "Check that all results are of the same camera and lens.",
        )
    enough = _MAX_ERROR_OF_SIMPLE * least + _MIN_GAIN_PX
    chosen = next(name for name in names if errors[name] <= enough)
    return Series(ordered, chosen, errors, max(inflations[chosen], 1.0))


def _check_settings(settings: Sequence[Setting]) -> None:
    """Refuse settings that no function of the setting describes."""
    if len(settings) < MIN_SETTINGS:
        raise CalibrationError(
            f"{len(settings)} settings do not show how the camera varies.",
            f"Calibrate it at {MIN_SETTINGS} different settings or more.",
        )
    values = [setting.value for setting in settings]
    if repeated := {f"{a:g}" for a, b in pairwise(values) if a == b}:
        raise CalibrationError(
            f"Several results are at {', '.join(sorted(repeated))}.",
            "Give each a value of its own, or calibrate their photographs together.",
        )
    cameras = [setting.known.camera for setting in settings]
    if len({camera.size for camera in cameras}) > 1:
        raise CalibrationError(
            "The images of the results have different sizes.",
            "Calibrate all settings at one resolution.",
        )
    if len({camera.model for camera in cameras}) > 1:
        listed = ", ".join(sorted({camera.model for camera in cameras}))
        raise CalibrationError(
            f"The results have different lens models: {listed}.",
            "Calibrate all settings with one lens model.",
        )
    if len({tuple(_find_free(setting)) for setting in settings}) > 1:
        raise CalibrationError(
            "Different parameters are held in the results.",
            "Calibrate all settings with the same ones free.",
        )


def _find_free(setting: Setting) -> IntArray:
    """Return the indices of the parameters that are estimated."""
    return np.flatnonzero(np.diag(setting.known.covariance) > 0)


def _predict(function: str, settings: Sequence[Setting], value: float) -> UncertainCamera:
    """Predict the camera at a value, with the covariance that the function has by itself."""
    free, camera = _find_free(settings[0]), settings[0].known.camera
    values = np.array([setting.value for setting in settings])
    c = np.array([setting.known.camera.params for setting in settings])
    C = np.array([setting.known.covariance[np.ix_(free, free)] for setting in settings])
    if function == SPLINE:
        found, covariance = _evaluate_spline(values, c[:, free], C, value)
    else:
        degree = int(function.rpartition(" ")[2])
        found, covariance = _evaluate_polynomial(values, c[:, free], C, degree, value)
    params, whole = c.mean(axis=0), np.zeros((c.shape[1], c.shape[1]))
    params[free], whole[np.ix_(free, free)] = found, covariance
    return UncertainCamera(Camera(camera.size, params, camera.model), whole)


def _evaluate_polynomial(
    values: Array, c: Array, C: Array, degree: int, value: float
) -> tuple[Array, Array]:
    """Return the parameters (P,) of the polynomials at a value, and their covariance."""
    P = c.shape[1]
    middle, half = (values[0] + values[-1]) / 2, (values[-1] - values[0]) / 2
    t = np.vander((values - middle) / half, degree + 1, increasing=True)
    unit = np.sqrt(np.diagonal(C, axis1=1, axis2=2)).min(axis=0)
    weights = np.linalg.inv(C / np.outer(unit, unit))
    N = np.einsum("ia,ib,ipq->apbq", t, t, weights).reshape(P * (degree + 1), -1)
    right = np.einsum("ia,ipq,iq->ap", t, weights, c / unit).ravel()
    at = np.kron(((value - middle) / half) ** np.arange(degree + 1), np.eye(P))
    inverse = np.linalg.inv(N)
    return unit * (at @ inverse @ right), np.outer(unit, unit) * (at @ inverse @ at.T)


def _evaluate_spline(values: Array, c: Array, C: Array, value: float) -> tuple[Array, Array]:
    """Return the parameters (P,) of the monotone splines at a value, and their covariance."""

    def evaluate(knots: Array) -> Array:
        return np.asarray(scipy.interpolate.PchipInterpolator(values, knots)(value))

    found, steps = evaluate(c), _STEP * np.sqrt(np.diagonal(C, axis1=1, axis2=2))
    by_knot = np.empty_like(c)
    for i, step in enumerate(steps):
        moved = c.copy()
        moved[i] += step
        by_knot[i] = (evaluate(moved) - found) / step
    return found, np.einsum("ip,ipq,iq->pq", by_knot, C, by_knot)


def _leave_settings_out(function: str, settings: Sequence[Setting]) -> tuple[float, float]:
    """Measure a function's error on unseen settings: px rms, and X of the module's docstring."""
    free = _find_free(settings[0])
    squares, normalised = [], []
    for i in range(1, len(settings) - 1):
        value, known = settings[i]
        found = _predict(function, [*settings[:i], *settings[i + 1 :]], value)
        try:
            squares.append(compare_cameras(known.camera, found.camera).rms ** 2)
        except CalibrationError:  # too far apart to have anything in common
            squares.append(np.inf)
        miss = (found.camera.params - known.camera.params)[free]
        both = (found.covariance + known.covariance)[np.ix_(free, free)]
        normalised.append(float(miss @ np.linalg.solve(both, miss)) / len(free))
    return float(np.sqrt(np.mean(squares))), float(np.mean(normalised))

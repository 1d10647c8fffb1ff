"""The sentence on what a synthetic check proves: of the method, and of the camera and board models.

The estimates z from renderings of a known camera z0 are off by noise alone if the method is right:
(z - z0)^T C^-1 (z - z0) follows chi-square of as many degrees of freedom as parameters are
estimated, where C is the covariance that the method states. The synthetic residuals are what noise
leaves if camera and board are just as the result says; the variance of the real ones over theirs
follows Fisher's F then.

Passing does not prove that the camera is right: errors that camera and poses took up leave no
residuals, and an error of all squares alike is rendered like everything else.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from calibgui.app.calibrating.synthetic import SyntheticCheck, count_freedom
from calibgui.dataset import Result
from calibgui.engine.assessment import summarise_residuals
from calibgui.report.comparison import compare_parameters

_MAX_FALSE_ALARM_RATE = 1e-3
"""Rate at which either check fails although all is well, as everywhere in the assessment."""


@dataclass(frozen=True, slots=True)
class SyntheticVerdict:
    """The outcome of both checks; each chance is that of a larger deviation by noise alone."""

    parameter_chance: float
    """Chance of the estimates' deviation; NaN if the method states no covariance."""
    worst_name: str
    """Parameter that is missed by most of its standard deviation; empty if none is estimated."""
    worst_sigmas: float
    """Its deviation over its standard deviation."""
    residual_chance: float
    """Chance of the real residuals' variance over the synthetic ones'."""
    real_rms: float
    """Root mean square length of the real residuals, px."""
    synthetic_rms: float
    """Root mean square length of the synthetic residuals, px."""

    @property
    def is_method_right(self) -> bool:
        """Return whether the camera was found again, as far as noise lets it be."""
        return not self.parameter_chance < _MAX_FALSE_ALARM_RATE

    @property
    def is_model_right(self) -> bool:
        """Return whether the real residuals are no larger than noise makes them."""
        return self.residual_chance >= _MAX_FALSE_ALARM_RATE


def judge_synthetic_check(check: SyntheticCheck) -> SyntheticVerdict:
    """Judge a check for which the corners had the noise that was found (`measure_corner_noise`)."""
    rows = [
        (abs(row.change) / row.sigma_b, row.name)
        for row in compare_parameters(check.real.calibration, check.synthetic.calibration)
        if row.sigma_b > 0
    ]
    worst, name = max(rows, default=(0.0, ""))
    real, synthetic = (_measure_variance(result) for result in (check.real, check.synthetic))
    chance = scipy.special.fdtrc(
        count_freedom(check.real), count_freedom(check.synthetic), real / max(synthetic, 1e-300)
    )
    return SyntheticVerdict(
        _find_parameter_chance(check),
        name,
        worst,
        float(chance),
        summarise_residuals(check.real.calibration.residuals).rms,
        summarise_residuals(check.synthetic.calibration.residuals).rms,
    )


def _find_parameter_chance(check: SyntheticCheck) -> float:
    """Return the chance of a larger deviation of the estimates from what was rendered."""
    found = check.synthetic.calibration
    free = np.flatnonzero(found.sigma > 0)
    covariance = found.covariance[np.ix_(free, free)]
    if not len(free) or not np.isfinite(covariance).all():
        return float("nan")
    # In units of sigma the covariance is well conditioned whatever the parameters' units.
    unit = found.sigma[free]
    off = (found.camera.params - check.real.calibration.camera.params)[free] / unit
    distance = off @ np.linalg.solve(covariance / np.outer(unit, unit), off)
    return float(scipy.special.chdtrc(len(free), distance))


def _measure_variance(result: Result) -> float:
    """Return the residuals' variance per degree of freedom, px^2."""
    squares = sum(float(np.sum(view.image**2)) for view in result.calibration.residuals)
    return squares / count_freedom(result)


def describe_synthetic_verdict(check: SyntheticCheck, verdict: SyntheticVerdict) -> str:
    """Say in plain sentences what the check proves, beginning with the outcome."""
    if not verdict.is_method_right:
        return (
            f"Failed: from pictures of this very camera, with {check.noise:.3f} px of noise, the "
            f"method misses it by more than noise explains ({verdict.worst_name} by "
            f"{verdict.worst_sigmas:.1f} σ). Do not trust the estimates or their ± here."
        )
    worst = f"{verdict.worst_name} is farthest off, by {verdict.worst_sigmas:.1f} σ"
    if verdict.is_model_right:
        return (
            f"Passed: from pictures of this very camera, with the {check.noise:.3f} px of noise "
            f"that was found, the method finds it again ({worst}), and the real residuals are no "
            "larger than that noise leaves."
        )
    ratio = verdict.real_rms / verdict.synthetic_rms
    return (
        f"Failed: the real residuals are {ratio:.2g} times what noise alone leaves "
        f"({verdict.real_rms:.3f} instead of {verdict.synthetic_rms:.3f} px RMS), so camera or "
        f"board is not as this result assumes. The method passed: it finds this camera again "
        f"({worst})."
    )

"""Calibration with every view weighed by the noise that is found in it.

The noise of a view is estimated from the residuals of the last calibration
(``residual_checks.estimate_view_sigma``), relative to the covariances that its corners came with:
iteratively reweighted least squares with one weight a view. A few repetitions suffice.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from calibgui.engine.arrays import Array, Size
from calibgui.engine.assessment.residuals.residual_checks import estimate_view_sigma
from calibgui.engine.assessment.residuals.systematic_errors import prepare_fit
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.calibration.score_tests import LinearisedFit

_REWEIGHTINGS = 3
"""Number of calibrations with weights from the one before."""


def calibrate_weighted(
    views: Sequence[Observation | tuple[Array, Array]], size: Size, **settings: Any
) -> tuple[Calibration, list[Observation]]:
    """Calibrate with every view weighed by the noise that is found in it.

    Args:
        views, size, settings: as for ``calibrate``, with the cost "image".

    Returns:
        The calibration, and the views with the covariances that it used, px^2.

    Raises:
        CalibrationError, DegenerateError, Cancelled: as ``calibrate``.
    """
    used = [Observation(*view) for view in views]
    result = calibrate(used, size, **settings)
    for _ in range(_REWEIGHTINGS):
        fit = prepare_fit(result, used)
        sigma = estimate_view_sigma(fit.linearise(slice(0, len(used))).residual, fit)
        used = _weight_views(used, fit, sigma)
        result = calibrate(used, size, **settings)
    return result, used


def _weight_views(
    views: Sequence[Observation], fit: LinearisedFit, sigma: Array
) -> list[Observation]:
    """Return the views with their covariances scaled by their standard deviations (K,)."""
    weight = fit.get_weight(slice(0, len(views)))
    weighed = []
    for k, view in enumerate(views):
        W = weight[k, fit.observations.corners_of(k)]
        weighed.append(view._replace(cov=sigma[k] ** 2 * np.linalg.inv(np.swapaxes(W, 1, 2) @ W)))
    return weighed

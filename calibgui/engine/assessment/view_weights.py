"""Calibration with every view weighed by the noise that is found in it.

The noise of a view is what the last calibration leaves of it (``noise.view_sigma``), over the
covariances that its corners came with; a few rounds settle it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from calibgui.engine.arrays import Array, Size
from calibgui.engine.assessment.noise_test import view_sigma
from calibgui.engine.assessment.systematic_errors import Fitted, fitted
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration

_ROUNDS = 3
"""Of weighing the views by what the last weights left."""


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
    for _ in range(_ROUNDS):
        fit = fitted(result, used)
        sigma = view_sigma(fit.linear(slice(0, len(used))).residual, fit)
        used = _weighted(used, fit, sigma)
        result = calibrate(used, size, **settings)
    return result, used


def _weighted(views: Sequence[Observation], fit: Fitted, sigma: Array) -> list[Observation]:
    """The views with covariances that make up for their standard deviations (K,)."""
    weight = fit.weight(slice(0, len(views)))
    weighed = []
    for k, view in enumerate(views):
        W = weight[k, fit.observations.view(k)]
        weighed.append(view._replace(cov=sigma[k] ** 2 * np.linalg.inv(np.swapaxes(W, 1, 2) @ W)))
    return weighed

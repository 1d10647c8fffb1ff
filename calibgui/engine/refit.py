"""The same camera in another program's lens model.

The paper corrects measured points, most programs distort ideal ones; neither's coefficients
express the other. The other model is therefore calibrated on the same corners, and compared
with the original: a pixel's ray under the first camera is imaged by the second, and the
distance from where it came from is the refit's error there. Where corners were seen the two
agree to a fraction of the corners' noise; beyond them both extrapolate.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.engine.calibrate import calibrate
from calibgui.engine.projection import pixels, rays
from calibgui.engine.types import Array, Calibration, Camera, Observation

_STEPS = 64
"""Samples along either side of the image."""


@dataclass(frozen=True, eq=False, slots=True)
class Refit:
    """A calibration in another model, and how far it is from the original."""

    calibration: Calibration
    largest_error: float
    """Over the whole image, px; NaN where a pixel has no ray or the ray no image."""
    covered_error: float
    """Over the places where corners were seen, px."""


def refit(views: Sequence[Observation], original: Calibration, model: str = "opencv") -> Refit:
    """Calibrate another lens model on the same corners.

    Args:
        views: the observations that `original` was calibrated from.
        original: the calibration to express.
        model: a key of ``lens.MODELS``.

    Raises:
        CalibrationError: as ``calibrate``.
    """
    pinhole = ("fx", "fy", "cx", "cy")
    held = {n: v for n, v in original.settings["fixed"].items() if n in pinhole}
    calibration = calibrate(views, original.camera.size, model=model, fix=held)
    w, h = original.camera.size
    whole: Array = np.stack(
        np.meshgrid(np.linspace(0, w - 1, _STEPS), np.linspace(0, h - 1, _STEPS)), axis=-1
    )
    seen = np.concatenate([view.uv for view in views])
    return Refit(
        calibration,
        float(displacement(original.camera, calibration.camera, whole).max()),
        float(displacement(original.camera, calibration.camera, seen).max()),
    )


def displacement(a: Camera, b: Camera, uv: Array) -> Array:
    """(...) distance, px, between pixels uv (..., 2) and where b images their rays under a."""
    return np.linalg.norm(pixels(rays(uv, a), b) - uv, axis=-1)

"""The same camera in another program's lens model.

The paper corrects measured points, most programs distort ideal ones; neither's coefficients
express the other. The other model is therefore calibrated on the same corners, and compared
with the original: a pixel's ray under the first camera is imaged by the second, and the
distance from where it came from is the refit's error there. Where corners were seen the two
agree to a fraction of the corners' noise; beyond them both extrapolate.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels, rays
from calibgui.engine.images.sampling import mesh

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


def refit(
    views: Sequence[Observation | tuple[Array, Array]], original: Calibration, model: str = "opencv"
) -> Refit:
    """Calibrate another lens model on the same corners.

    Args:
        views: the observations that `original` was calibrated from.
        original: the calibration to express.
        model: a key of ``lens.MODELS``.

    Raises:
        CalibrationError, DegenerateError: as ``calibrate``.
    """
    held = _held(original.settings["fixed"])
    board_shape = original.board_shape or BoardShapeModel.NOMINAL
    calibration = calibrate(
        views, original.camera.size, model=model, fix=held, board_shape=board_shape
    )
    w, h = original.camera.size
    whole = mesh(np.linspace(0, w - 1, _STEPS), np.linspace(0, h - 1, _STEPS))
    seen = np.concatenate([Observation(*view).uv for view in views])
    return Refit(
        calibration,
        float(displacement(original.camera, calibration.camera, whole).max()),
        float(displacement(original.camera, calibration.camera, seen).max()),
    )


def _held(fixed: Mapping[str, float]) -> dict[str, float]:
    """What of the original's held parameters the refit holds as well.

    The pinhole parameters mean the same in every model. Lens coefficients do not, but the
    inverse of a map without decentering has none, and that of a map without distortion
    has none either.
    """
    held = {name: fixed[name] for name in ("fx", "fy", "cx", "cy") if name in fixed}
    without = {name for name, value in fixed.items() if value == 0}
    if without >= {"p1", "p2"}:
        held |= dict.fromkeys(("p1", "p2"), 0.0)
        if without >= {"k1", "k2", "k3"}:
            held |= dict.fromkeys(("k1", "k2", "k3"), 0.0)
    return held


def displacement(a: Camera, b: Camera, uv: Array) -> Array:
    """(...) distance, px, between pixels uv (..., 2) and where b images their rays under a."""
    return np.linalg.norm(pixels(rays(uv, a), b) - uv, axis=-1)

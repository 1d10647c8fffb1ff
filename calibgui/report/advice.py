"""What to photograph to improve a calibration.

It follows from what the views leave out: regions of the sensor, tilts and their directions,
distances (``coverage``).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from calibgui.dataset.result import Result
from calibgui.engine.arrays import Array
from calibgui.engine.calibration import Calibration
from calibgui.report.coverage import attitudes, density

_TILTED = np.deg2rad(15)
"""A board tilted less adds little to the focal length."""
_FEW_VIEWS = 8
_DISTANCES = 1.3
"""Farthest over nearest board that counts as different distances."""
_REGIONS = (
    ("upper left", "top", "upper right"),
    ("left", "middle", "right"),
    ("lower left", "bottom", "lower right"),
)


def wanted(result: Result) -> list[str]:
    """What to do, each as the end of a sentence; nothing if the views cover everything."""
    calibration, observations = result.calibration, result.observations()
    attitude = attitudes(calibration, observations)
    uv = np.concatenate([view.uv for view in observations])
    texts = [
        *_empty_regions(uv, calibration),
        *_missing_tilts(attitude.tilt, attitude.direction),
    ]
    if attitude.distance.max() < _DISTANCES * attitude.distance.min():
        texts.append("hold the board at different distances: all views have nearly the same")
    if len(observations) < _FEW_VIEWS:
        texts.append(
            f"take more views: {len(observations)} leave little to average and to check against"
        )
    return texts


def _empty_regions(uv: Array, calibration: Calibration) -> Iterator[str]:
    """Ninths of the sensor of which more than half saw no corner."""
    cells = density(uv, calibration.camera.size) == 0
    rows, cols = cells.shape
    empty = cells.reshape(3, rows // 3, 3, cols // 3).mean(axis=(1, 3)) > 0.5
    names = [_REGIONS[i][j] for i, j in np.argwhere(empty)]
    if names:
        yield (
            f"bring the board into the image's {_joined(names)}, where few or no corners were "
            "seen: the lens correction is extrapolated there"
        )


def _missing_tilts(tilt: Array, direction: Array) -> Iterator[str]:
    """Of tilts (K,) from the sensor and their directions (K,), rad."""
    tilted = direction[tilt > _TILTED]
    if len(tilted) < 3:
        yield (
            "tilt the board by 30 to 45 degrees in at least three views: "
            f"the largest tilt is {np.rad2deg(tilt.max()):.0f} degrees, and without tilt "
            "focal length and distance cannot be told apart"
        )
        return
    # Opposite tilts count as one axis: doubling the angle folds them together.
    axes = np.abs(np.exp(2j * tilted).mean())
    if axes > 0.9:
        yield "tilt the board about another axis too: all tilts are about the same one"


def _joined(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"

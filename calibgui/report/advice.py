"""Advice on what to photograph to improve a calibration.

It follows from what the views leave out: regions of the sensor, tilts and their directions,
distances (``coverage``).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from calibgui.dataset import Result
from calibgui.dataset.sensor_coverage import count_corners_per_cell
from calibgui.engine.arrays import Array
from calibgui.engine.calibration import Calibration
from calibgui.report.coverage import measure_attitudes
from calibgui.report.names import join_words

_MIN_TILT = np.deg2rad(15)
"""Tilt, rad, below which a view adds little to the focal length."""
_MIN_VIEWS = 8
"""Number of views below which more are advised."""
_MIN_DISTANCE_RATIO = 1.3
"""Ratio of the farthest to the nearest distance, below which all count as the same."""
_MIN_EXTENT = 1 / 3
"""Part of the image's width or height that a board takes, below which it is too far away: the views
`calibgui views --next` asks for take 0.45 and more."""
_REGION_NAMES = (
    ("upper left", "top", "upper right"),
    ("left", "middle", "right"),
    ("lower left", "bottom", "lower right"),
)
"""Names of the ninths of the image, row by row."""


def advise_photographs(result: Result) -> list[str]:
    """List what to photograph, each as the end of a sentence; empty if nothing is left out."""
    calibration, observations = result.calibration, result.observations()
    attitude = measure_attitudes(calibration, observations)
    uv = np.concatenate([view.uv for view in observations])
    texts = [
        *_advise_nearness([view.uv for view in observations], calibration),
        *_advise_regions(uv, calibration),
        *_advise_tilts(attitude.tilt, attitude.direction),
    ]
    if attitude.distance.max() < _MIN_DISTANCE_RATIO * attitude.distance.min():
        texts.append("hold the board at different distances: all views have nearly the same")
    if len(observations) < _MIN_VIEWS:
        texts.append(
            f"take more views: {len(observations)} leave little to average and to check against"
        )
    return texts


def _advise_nearness(views: Sequence[Array], calibration: Calibration) -> Iterator[str]:
    """Advise on boards whose corners (n, 2), px, take a small part of the image in every view."""
    extent = max(float((np.ptp(uv, axis=0) / calibration.camera.size).max()) for uv in views)
    if extent < _MIN_EXTENT:
        yield (
            "hold the board nearer, so that it fills half of the image or more: it takes at most "
            f"{100 * extent:.0f} % of its width or height"
        )


def _advise_regions(uv: Array, calibration: Calibration) -> Iterator[str]:
    """Advise on ninths of the sensor in which more than half of the cells saw no corner."""
    cells = count_corners_per_cell(uv, calibration.camera.size) == 0
    rows, cols = cells.shape
    empty = cells.reshape(3, rows // 3, 3, cols // 3).mean(axis=(1, 3)) > 0.5
    names = [_REGION_NAMES[i][j] for i, j in np.argwhere(empty)]
    if names:
        yield (
            f"bring the board into the image's {join_words(names)}, where few or no corners were "
            "seen: the lens correction is extrapolated there"
        )


def _advise_tilts(tilt: Array, direction: Array) -> Iterator[str]:
    """Advise on tilts (K,) against the sensor and their directions (K,), rad."""
    tilted = direction[tilt > _MIN_TILT]
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

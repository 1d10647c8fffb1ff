"""Photographs that a program has stored upside down or mirrored, told from those of another camera.

Turned by half a turn or mirrored, an image has its principal point on the other side of its middle.
So some photographs that were turned and the others look like those of two cameras; and two cameras
of one make, of which each has its principal point somewhere near the middle, look turned to some
degree. What tells is a calibration with the views turned back: if they were turned it leaves no
more than a calibration of each kind by itself, which has a camera and a board of its own.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import BoolArray
from calibgui.engine.assessment.causes.harm import Case
from calibgui.engine.assessment.residuals.residual_statistics import summarise_residuals
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.problem import recover_image_arguments
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.errors import CalibrationError

_TURNS = {
    (-1, -1): ("upside down", "turn them by 180 degrees"),
    (-1, 1): ("mirrored left to right", "mirror them left to right"),
    (1, -1): ("mirrored top to bottom", "mirror them top to bottom"),
}
"""Ways in which a program may have turned what the camera wrote, by the signs of the coordinates:
how the images stand, and what turns them back."""
_MAX_RMS_IF_TURNED = 1.2
"""RMS residual with the odd views turned back, over what a camera of their own would
leave to the first order, up to which they were turned: with no unknowns more. They leave half of
the squares at most that such a camera explains."""
_MAX_NOISE_IF_TURNED = 1.1
"""Noise with the odd views turned back, over that of each kind calibrated by itself, up to which
they were turned. In five real sets that were parted at random it was at most 1.07, of two real
stereo cameras 1.2 and 1.6."""
_MAX_RMS_ALIKE = 1.05
"""RMS residual over the least one, up to which another of these ways is as likely: a lens in the
middle of the image is the same when it is turned and when it is mirrored."""


class Turn(NamedTuple):
    """A way in which some photographs are turned against the others."""

    how: str
    """Way in which the photographs stand, such as "upside down"."""
    remedy: str
    """The instruction that turns them back."""
    rms: float
    """RMS residual with them turned back, px."""


def find_turn(case: Case, is_odd: BoolArray, left: float) -> Turn | None:
    """Find out whether the views of one kind (K,) are turned against the others; None if not.

    Args:
        case: the calibration of all views.
        is_odd: the views of the kind with fewer views.
        left: RMS residual that a camera of each kind's own would leave to the first order, px.
    """
    found = {turn: _calibrate_turned(case, is_odd, turn) for turn in _TURNS}
    rms = {
        turn: summarise_residuals(turned.residuals).rms
        for turn, turned in found.items()
        if turned is not None
    }
    if not rms:
        return None
    best = min(rms, key=lambda turn: rms[turn])
    # Where little is to be explained, nearly all would be left of it if nothing were wrong.
    half = float(np.sqrt((left**2 + case.rms**2) / 2))
    turned = found[best]
    if turned is None or rms[best] >= min(_MAX_RMS_IF_TURNED * left, half):
        return None
    if turned.noise > _MAX_NOISE_IF_TURNED * _measure_noise_apart(case, is_odd):
        return None
    alike = [_TURNS[turn] for turn, each in rms.items() if each < _MAX_RMS_ALIKE * rms[best]]
    how, back = (" or ".join(words) for words in zip(*alike, strict=True))
    return Turn(how, f"{back[:1].upper()}{back[1:]}", rms[best])


def _calibrate_turned(
    case: Case, is_turned: BoolArray, turn: tuple[int, int]
) -> Calibration | None:
    """Calibrate with some views (K,) turned by half a turn or mirrored; None if they are no views
    of a camera then.

    A board that is seen in a mirror is numbered from its other side.
    """
    last = np.array(case.calibration.camera.size) - 1
    sign = np.array(turn)
    side = np.array([sign.prod(), 1])
    return _calibrate(
        case,
        [
            Observation(np.where(sign < 0, last - view[0], view[0]), view[1] * side, *view[2:])
            if turned
            else view
            for view, turned in zip(case.views, is_turned, strict=True)
        ],
    )


def _measure_noise_apart(case: Case, is_odd: BoolArray) -> float:
    """Measure the noise with each kind calibrated by itself, px; infinite if one of them is too
    few views for that."""
    variance = count = 0.0
    for kind in (is_odd, ~is_odd):
        views = [view for view, chosen in zip(case.views, kind, strict=True) if chosen]
        apart = _calibrate(case, views)
        if apart is None:
            return np.inf
        corners = sum(len(view.uv) for view in views)
        variance, count = variance + corners * apart.noise**2, count + corners
    return float(np.sqrt(variance / count))


def _calibrate(case: Case, views: list[Observation]) -> Calibration | None:
    """Calibrate some views with the settings of the case; None if they determine no camera."""
    settings = recover_image_arguments(case.calibration) | {"model_errors": False}
    try:
        return calibrate(views, case.calibration.camera.size, **settings)
    except CalibrationError:
        return None

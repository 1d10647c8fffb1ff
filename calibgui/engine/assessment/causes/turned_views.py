"""Photographs that a program has stored upside down or mirrored, told from those of another camera.

Few of them among many stand out one by one: a camera that has not seen the photograph
(``calibration/leave_one_out.py``) predicts it far better once it is turned back. So photographs are
asked about before any cause is sought in all of them. Under a lens in the middle of the image this
is not to be told, and does no harm.

Where they are as many as the others, the views part in two kinds (``mixed_views.py``). Turned by
half a turn or mirrored, an image has its principal point on the other side of its middle. So some
photographs that were turned and the others look like those of two cameras; and two cameras of one
make, of which each has its principal point somewhere near the middle, look turned to some degree.
What tells is a calibration with the views turned back: if they were turned it leaves no more than a
calibration of each kind by itself, which has a camera and a board of its own.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, Size
from calibgui.engine.assessment.causes.case import Case
from calibgui.engine.assessment.choices.cross_validation import resect_views
from calibgui.engine.assessment.finding import MIN_VIEWS_TO_JUDGE
from calibgui.engine.assessment.residuals.residual_statistics import summarise_residuals
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.leave_one_out import leave_views_out
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.problem import recover_image_arguments
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.errors import CalibrationError

_UPSIDE_DOWN = (-1, -1)
"""The half turn, by the signs of the coordinates."""
_TURNS = {
    _UPSIDE_DOWN: ("upside down", "turn them by 180 degrees"),
    (-1, 1): ("mirrored left to right", "mirror them left to right"),
    (1, -1): ("mirrored top to bottom", "mirror them top to bottom"),
}
"""Ways in which a program may have turned what the camera wrote, by the signs of the coordinates:
how the images stand, and what turns them back."""
_MAX_RMS_IF_TURNED = 1.2
"""RMS residual with the odd views turned back, over what a camera of their own would
leave to the first order, up to which they were turned: with no unknowns more. They leave half of
the squares at most that such a camera explains. One that is turned by itself is predicted worse
than most by more than this, and worse than turned back by more than its square: of 60 subsets of
five real sets of clean photographs none was."""
_MAX_NOISE_IF_TURNED = 1.1
"""Noise with the odd views turned back, over that of each kind calibrated by itself, up to which
they were turned. In five real sets that were parted at random it was at most 1.07, of two real
stereo cameras 1.2 and 1.6."""
_MAX_RMS_ALIKE = 1.05
"""RMS residual over the least one, up to which another of these ways is as likely: a lens in the
middle of the image is the same when it is turned and when it is mirrored."""


class TurnedViews(NamedTuple):
    """Photographs that are upside down against the others."""

    views: tuple[int, ...]
    """Their indices."""
    before: float
    """RMS residual as they are under a camera that has not seen them, px, of the worst."""
    after: float
    """RMS residual of that photograph turned back, px."""


def find_turned_views(case: Case) -> TurnedViews | None:
    """Find photographs that are upside down against all others; None if there are none, or too few
    others to tell.

    Mirrored ones are not sought: a board that is bent looks better in a mirror, too.
    """
    calibration = case.calibration
    if len(case.views) < MIN_VIEWS_TO_JUDGE:
        return None
    try:
        unseen = leave_views_out(calibration, case.views)
    except CalibrationError:
        return None
    found: list[tuple[float, float, int]] = []
    suspects = np.flatnonzero(unseen.by_view > _MAX_RMS_IF_TURNED * np.median(unseen.by_view))
    for k in suspects.tolist():
        case.check()
        before = float(unseen.by_view[k])
        after = _predict_turned_back(calibration, unseen.moves[k], case.views[k])
        if before > _MAX_RMS_IF_TURNED**2 * after:
            found.append((before, after, k))
    if not found:
        return None
    turned = tuple(sorted(k for *_, k in found))
    rest = _calibrate(case, [view for k, view in enumerate(case.views) if k not in turned])
    if rest is None or _MAX_RMS_IF_TURNED * summarise_residuals(rest.residuals).rms > case.rms:
        return None  # the others are as poor by themselves: what is wrong is wrong with all
    before, after, _ = max(found)
    return TurnedViews(turned, before, after)


def _predict_turned_back(calibration: Calibration, move: Array, view: Observation) -> float:
    """Return the RMS residual, px, of a view turned by half a turn under the camera without it,
    which is the calibration's moved (P,), with its pose fitted; infinite if there is none."""
    try:
        camera = replace(calibration.camera, params=calibration.camera.params + move)
        turned = _turn_back(view, _UPSIDE_DOWN, camera.size)
        (residuals,) = resect_views(replace(calibration, camera=camera), [turned])
    except CalibrationError:
        return np.inf
    return residuals.rms


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
    of a camera then."""
    size = case.calibration.camera.size
    return _calibrate(
        case,
        [
            _turn_back(view, turn, size) if turned else view
            for view, turned in zip(case.views, is_turned, strict=True)
        ],
    )


def _turn_back(view: Observation, turn: tuple[int, int], size: Size) -> Observation:
    """Return a view of images of a size whose image is turned by half a turn or mirrored.

    A board that is seen in a mirror is numbered from its other side.
    """
    sign, last = np.array(turn), np.array(size) - 1
    side = np.array([sign.prod(), 1])
    return Observation(np.where(sign < 0, last - view[0], view[0]), view[1] * side, *view[2:])


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

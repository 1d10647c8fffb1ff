"""Outliers found, named and left out, before they spoil a calibration.

Least squares believes every corner. Three passes decide which to believe, each on what the
one before left:

1. By view. A grid that no homography with a radial lens fits (rows taken for columns, corners
   of something else) leaves a Stage I residual out of all proportion; a board numbered against
   the others' turning sense is told by the sign of its homography.
2. By corner in its view. Stage I is repeated with Cauchy weights w = 1 / (1 + (e / c s)^2),
   s the median residual's scale, which bound the influence of any corner. What stays beyond
   `_GROSS` s is set aside for the first solve of the next pass.
3. By corner in the joint solution. With sigma from the median of the residuals' lengths
   (for a Rayleigh distribution sigma = median / sqrt(2 ln 2)), the corners within `_FINE`
   sigma are kept, those set aside before among them, and the solve is repeated until nothing
   changes. Of good Gaussian corners it takes one in fifty thousand.

A view that loses more than a third of its corners is left out whole.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, Size
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.initialisation.stage_one import prealign, registration_error
from calibgui.engine.calibration.initialisation.start import facing, reference_points
from calibgui.engine.calibration.observations import (
    REFERENCE_PITCH,
    Observation,
    Observations,
    pack,
    pitch,
    view_names,
)
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.geometry.frames import paper_from_array

_CAUCHY = 2.0
"""c, in units of s."""
_ROUNDS = 6
_GROSS = 8.0
_FINE = 4.65
"""exp(-4.65^2 / 2) = 2e-5 of good corners."""
_HOPELESS = 10.0
"""Stage I scale, relative to the median view's, beyond which a view is no view of the board."""
_SOLVES = 20
_SHARE = 1 / 3
"""Of a view's corners, beyond which the whole view is left out."""
_RAYLEIGH = float(np.sqrt(2 * np.log(2)))
"""Median of a Rayleigh distribution, in units of its parameter."""


@dataclass(frozen=True, slots=True)
class Rejected:
    """Corners of one view that are left out, and why."""

    view: int
    corners: tuple[int, ...]
    """Their places among the view's corners; all of them where the view is left out."""
    whole: bool
    reason: str


@dataclass(frozen=True, eq=False, slots=True)
class Screening:
    """Which corners to believe, and the calibration from them."""

    kept: tuple[BoolArray, ...]
    """Of each view (n,) whether a corner is kept; nowhere true for views left out."""
    rejected: tuple[Rejected, ...]
    calibration: Calibration
    """From the kept corners of the views that keep any, in their order."""


def screen(
    views: Sequence[Observation | tuple[Array, Array]],
    size: Size,
    *,
    names: Sequence[str] | None = None,
    **settings: Any,
) -> Screening:
    """Leave outliers out and calibrate.

    Args:
        views: as for ``calibrate``.
        size: of the images, px.
        names: of the views, for messages.
        settings: passed on to ``calibrate``.

    Raises:
        CalibrationError: as ``calibrate``.
    """
    names = names or view_names(len(views))
    given = [Observation(*view) for view in views]
    kept = [np.ones(len(view.uv), dtype=bool) for view in given]
    reasons = dict(_by_stage_one(given, names, size, kept))
    _leave_out_poor(kept, reasons)
    # Whom to believe is asked of the flat plate and the image, whatever is estimated then.
    plain: dict[str, Any] = {
        name: settings[name] for name in ("fix", "free", "model") if name in settings
    }
    for _ in range(_SOLVES):
        if not _by_residual(_calibrated(given, size, names, kept, plain), given, kept):
            break
        _leave_out_poor(kept, reasons)
    calibration = _calibrated(given, size, names, kept, settings)
    return Screening(tuple(kept), tuple(_listed(kept, reasons)), calibration)


def _calibrated(
    given: Sequence[Observation],
    size: Size,
    names: Sequence[str],
    kept: Sequence[BoolArray],
    settings: dict[str, Any],
) -> Calibration:
    used = [k for k, good in enumerate(kept) if good.any()]
    parts = [_part(given[k], kept[k]) for k in used]
    return calibrate(parts, size, names=[names[k] for k in used], **settings)


def _by_stage_one(
    given: Sequence[Observation], names: Sequence[str], size: Size, kept: list[BoolArray]
) -> Iterator[tuple[int, str]]:
    """Set gross errors aside in `kept`; the views to leave out, with the reason."""
    observations = pack(given, names)
    sign, mask = facing(observations), observations.mask
    xy = paper_from_array(observations.uv, size)
    reference = reference_points(observations, REFERENCE_PITCH / pitch(observations), sign)
    weight = mask
    for _ in range(_ROUNDS):
        first = prealign(xy, reference, weight)
        error = registration_error(first, xy, reference)
        s = _scale(error, observations)
        weight = mask / np.sqrt(1 + (error / (_CAUCHY * s[:, None])) ** 2)
    usual = float(np.median(s))
    most = 1.0 if sign[s <= _HOPELESS * usual].sum() >= 0 else -1.0
    for k, good in enumerate(kept):
        good &= error[k, observations.view(k)] <= _GROSS * max(s[k], usual)
        if s[k] > _HOPELESS * usual:
            yield k, "no camera sees a flat board like this: its corners are misnumbered"
        elif sign[k] != most:
            yield k, "its corners are numbered mirrored against the other views'"


def _scale(error: Array, observations: Observations) -> Array:
    """(K,) robust scale s of each view's residual lengths."""
    padded = np.where(observations.mask > 0, error, np.nan)
    return np.maximum(np.nanmedian(padded, axis=1) / _RAYLEIGH, 1e-9)


def _by_residual(
    calibration: Calibration, given: Sequence[Observation], kept: list[BoolArray]
) -> bool:
    """Keep the corners within the noise of the prediction; whether that changed any."""
    used = [k for k, good in enumerate(kept) if good.any()]
    lengths = [
        np.linalg.norm(given[k].uv - project_points(given[k].xy, calibration.camera, pose), axis=1)
        / _expected(given[k], calibration.model_error)
        for k, pose in zip(used, calibration.poses, strict=True)
    ]
    believed = np.concatenate([length[kept[k]] for k, length in zip(used, lengths, strict=True)])
    # Perfect data leave rounding only, of which the largest is no outlier.
    limit = max(_FINE * float(np.median(believed)) / _RAYLEIGH, 1e-6)
    changed = False
    for k, length in zip(used, lengths, strict=True):
        changed |= bool((kept[k] != (length <= limit)).any())
        kept[k][:] = length <= limit
    return changed


def _expected(view: Observation, model_error: float) -> Array | float:
    """(n,) standard deviations of the corners, px; 1 where nothing tells them apart."""
    if view.cov is None:
        return 1.0
    return np.sqrt(np.trace(view.cov, axis1=1, axis2=2) / 2 + model_error**2)


def _leave_out_poor(kept: list[BoolArray], reasons: dict[int, str]) -> None:
    """Leave out views that have lost too many corners; clear the marks of those left out."""
    for k, good in enumerate(kept):
        lost = np.count_nonzero(~good)
        if k not in reasons and lost > _SHARE * len(good):
            reasons[k] = f"{lost} of its {len(good)} corners do not fit"
        if k in reasons:
            good[:] = False


def _part(view: Observation, kept: BoolArray) -> Observation:
    cov = None if view.cov is None else view.cov[kept]
    return Observation(view.uv[kept], view.xy[kept], cov)


def _listed(kept: Sequence[BoolArray], reasons: dict[int, str]) -> list[Rejected]:
    listed = []
    for k, good in enumerate(kept):
        corners = tuple(np.flatnonzero(~good).tolist())
        if k in reasons:
            listed.append(Rejected(k, corners, True, reasons[k]))
        elif corners:
            reason = "farther from the fitted camera's prediction than noise reaches"
            listed.append(Rejected(k, corners, False, reason))
    return listed

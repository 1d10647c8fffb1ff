"""Screening: outliers are found, named and left out before they spoil a calibration.

Least squares trusts every corner, and one wrong corner moves the camera. Three passes decide
which corners to trust, each on what the one before left:

1. View by view. A grid that no homography with a radial lens fits (rows taken for columns,
   corners of something else) leaves a Stage I residual out of all proportion; a board that is
   numbered mirrored against the others shows by the sign of its homography.
2. Corner by corner in its view. Stage I is repeated with Cauchy weights
   w = 1 / (1 + (e / c s)^2), s the median residual's scale, which bound the influence of any
   corner (iteratively reweighted least squares, Holland and Welsch 1977). Corners that stay
   beyond `_MAX_GROSS_RESIDUAL` s are set aside for the first solve of the next pass.
3. Corner by corner in the joint solution. With sigma from the median of the residuals' lengths
   (for a Rayleigh distribution sigma = median / sqrt(2 ln 2)), the corners within
   `MAX_RESIDUAL_IN_SIGMA` sigma are kept, those set aside before among them, and the solve is
   repeated until nothing changes. It rejects one good Gaussian corner in fifty thousand.

A view that loses more than a third of its corners is left out whole. Beside a view that does not
belong to the others good ones lose as many, as it draws the camera: so once nothing changes, those
left out are asked again how they fit the others' camera, with their own poses.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, Size
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.initialisation.stage_one import (
    measure_registration_error,
    register_views,
)
from calibgui.engine.calibration.initialisation.start import compute_reference_points, find_facing
from calibgui.engine.calibration.methods import find_method
from calibgui.engine.calibration.methods.method import start_from_calibration
from calibgui.engine.calibration.observations import (
    REFERENCE_PITCH,
    Observation,
    Observations,
    measure_pitch,
    name_views,
    pack_observations,
)
from calibgui.engine.calibration.resection import estimate_poses, refine_poses
from calibgui.engine.calibration.result import DEFAULT_METHOD, Calibration, Cost
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.frames import paper_from_array
from calibgui.engine.geometry.rotations import rotation_from_vector

_CAUCHY_SCALE = 2.0
"""Scale c of the Cauchy weights, in units of s."""
_REWEIGHTINGS = 6
"""Number of registrations in Stage I, each with the weights of the one before."""
_MAX_GROSS_RESIDUAL = 8.0
"""Stage I residual, in units of s, beyond which a corner is set aside."""
MAX_RESIDUAL_IN_SIGMA = 4.65
"""Residual, in sigma, beyond which a corner is rejected: exp(-4.65^2 / 2) = 2e-5 of good ones."""
MAX_VIEW_SCALE = 10.0
"""Stage I scale, relative to the median view's, beyond which a view is no view of the board."""
_MAX_SOLVES = 20
"""Number of joint solves after which screening ends even if corners still change."""
MAX_LOST_SHARE = 1 / 3
"""Share of a view's corners that are rejected, beyond which the whole view is left out."""
_LOST = "corners do not fit"
"""End of the reason why a view is left out that has lost too many corners."""
RAYLEIGH_MEDIAN = float(np.sqrt(2 * np.log(2)))
"""Median of a Rayleigh distribution, in units of its parameter."""


@dataclass(frozen=True, slots=True)
class Rejection:
    """Corners of one view that are left out, and why."""

    view: int
    """Index of the view."""
    corners: tuple[int, ...]
    """Indices of the corners in the view; all of them where the view is left out."""
    is_whole_view: bool
    """True if the view is left out whole."""
    reason: str
    """Reason, as a clause that follows a colon."""


@dataclass(frozen=True, eq=False, slots=True)
class Screening:
    """The corners that are trusted, and the calibration from them."""

    kept: tuple[BoolArray, ...]
    """(n,) for each view, true where a corner is kept; nowhere for views that are left out."""
    rejected: tuple[Rejection, ...]
    """Rejected corners, view by view."""
    calibration: Calibration
    """Calibration from the kept corners of the views that keep any, in their order."""

    def select_kept(self, views: Sequence[Observation]) -> list[Observation]:
        """Return the views that keep any corners, with those that are kept."""
        return [
            select_corners(view, kept)
            for view, kept in zip(views, self.kept, strict=True)
            if kept.any()
        ]


def screen_outliers(
    views: Sequence[Observation | tuple[Array, Array]],
    size: Size,
    *,
    names: Sequence[str] | None = None,
    **settings: Any,
) -> Screening:
    """Leave outliers out and calibrate.

    Args:
        views: corners and board points of each view, as for ``calibrate``.
        size: width and height of the images, px.
        names: names of the views, for messages.
        settings: further arguments of ``calibrate``.

    Raises:
        CalibrationError: as ``calibrate``.
    """
    names = names or name_views(len(views))
    given = [Observation(*view) for view in views]
    kept = [np.ones(len(view.uv), dtype=bool) for view in given]
    reasons = dict(_screen_by_stage_one(given, names, size, kept))
    _leave_out_poor_views(kept, reasons)
    # Screening assumes a flat board and the image cost, whatever is estimated afterwards.
    nominal: dict[str, Any] = {"model_errors": False} | {
        name: settings[name] for name in ("fix", "free", "model") if name in settings
    }
    asked: set[int] = set()
    found: Calibration | None = None
    before: list[int] = []
    for _ in range(_MAX_SOLVES):
        how = nominal | _start_from(found, before, kept)
        found, before = _calibrate_kept(given, size, names, kept, how), _list_used(kept)
        if not _screen_by_residual(found, given, kept):
            lost = [k for k, why in reasons.items() if k not in asked and why.endswith(_LOST)]
            asked.update(lost)
            if not _take_back_views(found, given, kept, reasons, lost):
                break
        _leave_out_poor_views(kept, reasons)
    if settings.get("method", DEFAULT_METHOD) == DEFAULT_METHOD:
        settings |= _start_from(found, before, kept)
    calibration = _calibrate_kept(given, size, names, kept, settings)
    return Screening(tuple(kept), tuple(_list_rejections(kept, reasons)), calibration)


def _calibrate_kept(
    given: Sequence[Observation],
    size: Size,
    names: Sequence[str],
    kept: Sequence[BoolArray],
    settings: dict[str, Any],
) -> Calibration:
    """Calibrate from the kept corners of the views that keep any."""
    used = _list_used(kept)
    parts = [select_corners(given[k], kept[k]) for k in used]
    return calibrate(parts, size, names=[names[k] for k in used], **settings)


def _list_used(kept: Sequence[BoolArray]) -> list[int]:
    """List the views that keep any corners."""
    return [k for k, good in enumerate(kept) if good.any()]


def _start_from(
    found: Calibration | None, before: Sequence[int], kept: Sequence[BoolArray]
) -> dict[str, Any]:
    """Return the method that starts from what was found of the views `before`, as an argument of
    `calibrate`; none if there was nothing, or if one of the views was not among them."""
    used = _list_used(kept)
    if found is None or not set(used).issubset(before):
        return {}
    places = [list(before).index(k) for k in used]
    return {"method": start_from_calibration(find_method(DEFAULT_METHOD), found, places)}


def _screen_by_stage_one(
    given: Sequence[Observation], names: Sequence[str], size: Size, kept: list[BoolArray]
) -> Iterator[tuple[int, str]]:
    """Set gross errors aside in `kept`, and yield the views to leave out, with the reason."""
    observations = pack_observations(given, names)
    sign, mask = find_facing(observations), observations.mask
    xy = paper_from_array(observations.uv, size)
    reference = compute_reference_points(
        observations, REFERENCE_PITCH / measure_pitch(observations), sign
    )
    weight = mask
    for _ in range(_REWEIGHTINGS):
        first = register_views(xy, reference, weight)
        error = measure_registration_error(first, xy, reference)
        s = _estimate_scale(error, observations)
        weight = mask / np.sqrt(1 + (error / (_CAUCHY_SCALE * s[:, None])) ** 2)
    usual = float(np.median(s))
    most = 1.0 if sign[s <= MAX_VIEW_SCALE * usual].sum() >= 0 else -1.0
    for k, good in enumerate(kept):
        good &= error[k, observations.corners_of(k)] <= _MAX_GROSS_RESIDUAL * max(s[k], usual)
        if s[k] > MAX_VIEW_SCALE * usual:
            yield k, "no camera sees a flat board like this: its corners are misnumbered"
        elif sign[k] != most:
            yield k, "its corners are numbered mirrored against the other views'"


def _estimate_scale(error: Array, observations: Observations) -> Array:
    """Estimate the robust scale s (K,) of each view's residual lengths."""
    padded = np.where(observations.mask > 0, error, np.nan)
    return np.maximum(np.nanmedian(padded, axis=1) / RAYLEIGH_MEDIAN, 1e-9)


def estimate_coordinate_sigma(lengths: Array) -> float:
    """Estimate the standard deviation of a residual's coordinate from the lengths (n,).

    It follows from their median, which outliers hardly move.
    """
    return float(np.median(lengths)) / RAYLEIGH_MEDIAN


def _screen_by_residual(
    calibration: Calibration, given: Sequence[Observation], kept: list[BoolArray]
) -> bool:
    """Keep the corners within the noise of the prediction, and return whether that changed any."""
    used = _list_used(kept)
    turns = rotation_from_vector(np.array([pose.rvec for pose in calibration.poses]))
    places = np.array([pose.tvec for pose in calibration.poses])
    lengths = _measure_lengths(calibration, [given[k] for k in used], turns, places)
    limit = _find_limit([length[kept[k]] for k, length in zip(used, lengths, strict=True)])
    changed = False
    for k, length in zip(used, lengths, strict=True):
        changed |= bool((kept[k] != (length <= limit)).any())
        kept[k][:] = length <= limit
    return changed


def _take_back_views(
    calibration: Calibration,
    given: Sequence[Observation],
    kept: list[BoolArray],
    reasons: dict[int, str],
    lost: Sequence[int],
) -> bool:
    """Keep what fits of views that were left out and are no worse than others under the camera, and
    return whether there are any."""
    if not lost:
        return False
    views = [given[k] for k in lost]
    observations = pack_observations(views)
    try:
        start = estimate_poses(calibration.camera, observations)
        state = refine_poses(start, observations, calibration.camera.model, Cost.IMAGE)
    except CalibrationError:
        return False
    used = [select_corners(given[k], good) for k, good in enumerate(kept) if good.any()]
    misses = [np.linalg.norm(view.image, axis=1) for view in calibration.residuals]
    error = calibration.model_error
    limit = _find_limit(
        [m / predict_coordinate_sigma(view, error) for m, view in zip(misses, used, strict=True)]
    )
    lengths = _measure_lengths(calibration, views, state.R, state.T)
    for k, length in zip(lost, lengths, strict=True):
        if np.count_nonzero(length > limit) <= MAX_LOST_SHARE * len(length):
            kept[k][:] = length <= limit
            del reasons[k]
    return any(k not in reasons for k in lost)


def _measure_lengths(
    calibration: Calibration, views: Sequence[Observation], R: Array, T: Array
) -> list[Array]:
    """Measure how far corners are from their predictions, in standard deviations, for boards that
    are turned by R (K, 3, 3) and placed at T (K, 3)."""
    placed = [view.xy @ turn[:, :2].T + at for view, turn, at in zip(views, R, T, strict=True)]
    predicted = pixels_from_rays(np.concatenate(placed), calibration.camera)
    parts = np.split(predicted, np.cumsum([len(points) for points in placed])[:-1])
    error = calibration.model_error
    return [
        np.linalg.norm(view.uv - uv, axis=1) / predict_coordinate_sigma(view, error)
        for view, uv in zip(views, parts, strict=True)
    ]


def _find_limit(trusted: Sequence[Array]) -> float:
    """Find the length up to which a corner is within the noise of those that are trusted."""
    # Perfect data leave rounding only, of which the largest is no outlier.
    sigma = estimate_coordinate_sigma(np.concatenate(trusted))
    return max(MAX_RESIDUAL_IN_SIGMA * sigma, 1e-6)


def predict_coordinate_sigma(view: Observation, model_error: float) -> Array | float:
    """Predict the standard deviations (n,) of residuals' coordinates, px, from the covariances.

    Args:
        view: the corners; where they have no covariances all are taken for equally precise, by 1.
        model_error: ``Calibration.model_error``, px.
    """
    if view.cov is None:
        return 1.0
    return np.sqrt(np.trace(view.cov, axis1=1, axis2=2) / 2 + model_error**2)


def _leave_out_poor_views(kept: list[BoolArray], reasons: dict[int, str]) -> None:
    """Leave out views that have lost too many corners; clear the marks of those left out."""
    for k, good in enumerate(kept):
        lost = np.count_nonzero(~good)
        if k not in reasons and lost > MAX_LOST_SHARE * len(good):
            reasons[k] = f"{lost} of its {len(good)} {_LOST}"
        if k in reasons:
            good[:] = False


def select_corners(view: Observation, kept: BoolArray) -> Observation:
    """Return the view with the corners only that are `kept` (n,)."""
    cov = None if view.cov is None else view.cov[kept]
    return Observation(view.uv[kept], view.xy[kept], cov)


def _list_rejections(kept: Sequence[BoolArray], reasons: dict[int, str]) -> list[Rejection]:
    """List the rejected corners, view by view, with the reasons."""
    listed = []
    for k, good in enumerate(kept):
        corners = tuple(np.flatnonzero(~good).tolist())
        if k in reasons:
            listed.append(Rejection(k, corners, True, reasons[k]))
        elif corners:
            reason = "farther from the fitted camera's prediction than noise reaches"
            listed.append(Rejection(k, corners, False, reason))
    return listed

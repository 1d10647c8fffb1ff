"""Is a stored calibration still good for its camera? One or a few pictures of a board tell.

With the camera held and only the poses free, the residuals of new pictures show that something is
off, but not what: a bent board leaves residuals that the camera has nothing to do with, and poses
hide most of what a changed camera does. So the change itself is estimated (``camera_change.py``),
as a displacement B c of the image, beside board and poses. Corners far beyond the noise are left
out.

The change at the corners is B c less the rotation of the camera that comes closest to it, since
every new pose undoes that. Its root mean square s and standard deviation, with C the covariance of
c after the pictures and A = mean of B'^T B' over the corners, B' = B less rotations, are

    s^2 = c^T A c,    sigma^2 = trace(A C).

It is above a limit L if s - 2 sigma > L, and below if s + 2 sigma <= L. It does not measure what
lies beyond the corners, nor the board's size, which one picture of one board never shows.

On 2700 synthetic checks of unchanged cameras (two lens models; 1, 2 and 4 views; boards flat or
bowed by 1 or 2 mm on 330 mm) there was one false alarm, and shift and scale scattered as their
standard deviations say. Photographs need the `overdispersion` that their calibration found: without
it one of ten checks with two or three of the paper's images was a false alarm, with it none of 128;
of a lens that its model follows poorly (a GoPro with Kannala and Brandt's) it was 6 of 128.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, freeze
from calibgui.engine.assessment.changes.camera_change import (
    MIN_NOISE,
    RADIAL,
    SCALE,
    SHIFT,
    CameraChange,
    factor_covariance,
    fit_camera_change,
)
from calibgui.engine.assessment.residuals.outliers import (
    MAX_LOST_SHARE,
    MAX_RESIDUAL_IN_SIGMA,
    MAX_VIEW_SCALE,
    RAYLEIGH_MEDIAN,
)
from calibgui.engine.calibration.observations import (
    Observation,
    Observations,
    name_views,
    pack_observations,
)
from calibgui.engine.calibration.refinement.levenberg_marquardt import StartError
from calibgui.engine.calibration.refinement.residuals import compute_image_residuals
from calibgui.engine.calibration.resection import estimate_poses, refine_poses
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.engine.uncertainty.projection_uncertainty import compute_sensitivity

DEFAULT_LIMIT = 0.5
"""Change of the camera from which it counts as changed, px rms."""
CONFIDENCE = 2.0
"""Number of standard deviations by which the change must be above or below the limit."""
_MAX_ROUNDS = 20
"""Number of times that corners are chosen anew."""
_MIN_CORNERS = 12
"""Number of corners that a view needs: poses and change leave nothing of fewer to judge by."""


class CheckVerdict(StrEnum):
    """The answer that the pictures give about a stored calibration."""

    STILL_GOOD = "still good"
    HAS_CHANGED = "has changed"
    CANNOT_TELL = "cannot tell"


class Weakness(StrEnum):
    """The kind of change that the pictures know least about."""

    SHIFT = "shift"
    SCALE = "scale"
    DISTORTION = "distortion"


@dataclass(frozen=True, slots=True)
class CheckedView:
    """A view of the check: the corners that were used, and those that were left out."""

    rms: float
    """Root mean square length of its residuals, only the pose free, px; NaN if it was left out."""
    used: int
    """Number of corners that were used; 0 if the view was left out."""
    left_out: int
    """Number of corners that were left out."""
    reason: str = ""
    """Reason why the view was left out, as a clause that follows a colon; empty if it was not."""


@dataclass(frozen=True, eq=False, slots=True)
class CalibrationCheck:
    """A stored calibration against new pictures."""

    limit: float
    """Limit of the change, px."""
    rms: float
    """Root mean square length of the residuals with only the poses free, px."""
    sigma_x: float
    """Standard deviation of these residuals along u, px."""
    sigma_y: float
    """Standard deviation of these residuals along v, px."""
    count: int
    """Number of corners."""
    noise: float
    """Standard deviation of one coordinate of what change, board and poses together leave, px."""
    change: float
    """Displacement of the corners by the camera's change, rotation taken out, px rms."""
    change_sigma: float
    """Its standard deviation, px."""
    whole_change: float
    """Displacement of the corners before the rotation is taken out, px rms."""
    shift: Array
    """(2,) shift of the image, px."""
    shift_sigma: Array
    """(2,) its standard deviations, px."""
    scale: float
    """Change of the image's scale, and so of the focal lengths, relative."""
    scale_sigma: float
    """Its standard deviation."""
    bend: float
    """Largest deviation of the board from a plane, mm."""
    bend_sigma: float
    """Its standard deviation, mm."""
    weakness: Weakness
    """The kind of change that contributes most to `change_sigma`."""
    has_covariance: bool
    """True if the stored parameters' own errors were taken into account."""
    views: tuple[CheckedView, ...]
    """The views, in the order in which they were given."""

    def __post_init__(self) -> None:
        freeze(self, "shift", "shift_sigma")

    @property
    def verdict(self) -> CheckVerdict:
        """The answer whether the calibration is still good, by `limit` and `CONFIDENCE`."""
        if self.change + CONFIDENCE * self.change_sigma <= self.limit:
            return CheckVerdict.STILL_GOOD
        if self.change - CONFIDENCE * self.change_sigma > self.limit:
            return CheckVerdict.HAS_CHANGED
        return CheckVerdict.CANNOT_TELL


def check_calibration(
    camera: Camera,
    views: Sequence[Observation],
    covariance: Array | None = None,
    limit: float = DEFAULT_LIMIT,
    names: Sequence[str] | None = None,
    overdispersion: float = 0.0,
) -> CalibrationCheck:
    """Check whether a stored camera still explains views of a flat board.

    Args:
        camera: the stored camera.
        views: new views of one board, taken with it.
        covariance: (P, P) covariance of its parameters; None if it is not known, and whatever the
            stored camera is off then counts as a change.
        limit: change from which the camera counts as changed, px rms.
        names: names of the views, for messages.
        overdispersion: the stored calibration's, `Calibration.overdispersion`; 0 if there is none.

    Raises:
        CalibrationError: if no view can be used; the message says why.
    """
    names = list(names or name_views(len(views)))
    given = [Observation(*view)._replace(cov=None) for view in views]
    kept = [np.asarray(np.isfinite(rays_from_pixels(view.uv, camera)).all(-1)) for view in given]
    reasons: dict[int, str] = {}
    _leave_out_views(kept, reasons, "many of its corners lie where the lens model has no ray")
    _leave_out_impossible_views(camera, given, kept, reasons)
    root = factor_covariance(covariance)
    for _ in range(_MAX_ROUNDS):
        used = [k for k, good in enumerate(kept) if good.any()]
        if not used:
            _refuse_all(names, reasons)
        packed = pack_observations(
            [Observation(given[k].uv[kept[k]], given[k].xy[kept[k]]) for k in used],
            [names[k] for k in used],
        )
        try:
            fit = fit_camera_change(camera, packed, root, max(overdispersion, 1.0))
        except StartError as error:
            raise CalibrationError(
                "No camera near the stored one images the board as the pictures show it.",
                "Check that the file is of this camera, and the board's rows and columns.",
            ) from error
        if not _screen_corners(fit, kept, used):
            break
        _leave_out_views(kept, reasons, "too many of its corners do not fit")
    return _summarise(fit, camera, packed, limit, covariance is not None, kept, used, reasons)


def _screen_corners(fit: CameraChange, kept: Sequence[BoolArray], used: Sequence[int]) -> bool:
    """Take corners far beyond the noise out of `kept`, and return whether there were any.

    Of each view the worst go first, down to half of the worst: they have moved the pose, and so the
    residuals of good corners beside them.
    """
    lengths = [
        np.linalg.norm(fit.left[i, : np.count_nonzero(kept[k])], axis=1) for i, k in enumerate(used)
    ]
    sigma = float(np.median(np.concatenate(lengths))) / RAYLEIGH_MEDIAN
    limit = MAX_RESIDUAL_IN_SIGMA * max(sigma, MIN_NOISE)
    changed = False
    for length, k in zip(lengths, used, strict=True):
        wrong = length > max(limit, length.max() / 2)
        kept[k][np.flatnonzero(kept[k])[wrong]] = False
        changed |= bool(wrong.any())
    return changed


def _leave_out_views(kept: Sequence[BoolArray], reasons: dict[int, str], reason: str) -> None:
    """Leave out views of which too few corners are kept."""
    for k, good in enumerate(kept):
        if k in reasons:
            continue
        if len(good) < _MIN_CORNERS:
            reasons[k] = f"it has {len(good)} corners, and {_MIN_CORNERS} are needed"
        elif good.mean() < 1 - MAX_LOST_SHARE or good.sum() < _MIN_CORNERS:
            reasons[k] = reason
        if k in reasons:
            good[:] = False


def _leave_out_impossible_views(
    camera: Camera,
    given: Sequence[Observation],
    kept: Sequence[BoolArray],
    reasons: dict[int, str],
) -> None:
    """Leave out views that no pose explains, or worse by far than those of the median view."""
    scales = {}
    for k, good in enumerate(kept):
        if good.any():
            scales[k] = _resect_alone(camera, Observation(given[k].uv[good], given[k].xy[good]))
    finite = [scale for scale in scales.values() if np.isfinite(scale)]
    limit = MAX_VIEW_SCALE * max(float(np.median(finite or [0.0])), MIN_NOISE)
    for k, scale in scales.items():
        if not scale <= limit:
            reasons[k] = "the stored camera does not see a flat board like this"
            kept[k][:] = False


def _resect_alone(camera: Camera, view: Observation) -> float:
    """Return the median length of a view's residuals, px; infinite if no pose explains it."""
    try:
        alone = pack_observations([view])
        start = estimate_poses(camera, alone)
        state = refine_poses(start, alone, camera.model, Cost.IMAGE)
    except (CalibrationError, np.linalg.LinAlgError):
        return np.inf
    residual = compute_image_residuals(state, alone, camera.model).residual
    return float(np.median(np.linalg.norm(residual[0], axis=1)))


def _refuse_all(names: Sequence[str], reasons: dict[int, str]) -> None:
    """Raise a CalibrationError that says why no view can be used."""
    listed = "; ".join(f"{names[k]}: {reason}" for k, reason in sorted(reasons.items()))
    raise CalibrationError(
        f"None of the pictures can be used to check the camera: {listed or 'there are none'}.",
        "Check that the file is of this camera and lens, and take pictures that show the whole "
        "board.",
    )


def _summarise(
    fit: CameraChange,
    camera: Camera,
    packed: Observations,
    limit: float,
    has_covariance: bool,
    kept: Sequence[BoolArray],
    used: Sequence[int],
    reasons: dict[int, str],
) -> CalibrationCheck:
    """Return what the fit says of camera, board and views."""
    places = packed.mask > 0
    B, e = fit.patterns[places], fit.poses_only[places]
    by_turn = compute_sensitivity(camera, packed.uv[places], np.inf)[1][..., :3].reshape(-1, 3)
    own = np.linalg.qr(by_turn)[0]
    flat = B.reshape(len(by_turn), -1)
    beyond = flat - own @ (own.T @ flat)
    A = beyond.T @ beyond / len(B)
    parts = np.diag(A) * np.diag(fit.covariance)
    shares = {
        Weakness.SHIFT: parts[SHIFT].sum(),
        Weakness.SCALE: parts[SCALE],
        Weakness.DISTORTION: parts[RADIAL].sum(),
    }
    half = float(np.hypot(*camera.size)) / 2
    sigma = np.sqrt(np.diag(fit.covariance))
    checked = []
    for k, good in enumerate(kept):
        n = int(np.count_nonzero(good))
        own_rms = np.nan
        if n:
            own_rms = float(
                np.sqrt(np.mean(np.sum(fit.poses_only[used.index(k), :n] ** 2, axis=1)))
            )
        checked.append(CheckedView(own_rms, n, len(good) - n, reasons.get(k, "")))
    return CalibrationCheck(
        limit=limit,
        rms=float(np.sqrt(np.mean(np.sum(e**2, axis=1)))),
        sigma_x=float(e[:, 0].std()),
        sigma_y=float(e[:, 1].std()),
        count=packed.count,
        noise=fit.noise,
        change=float(np.sqrt(fit.c @ A @ fit.c)),
        change_sigma=float(np.sqrt(np.trace(A @ fit.covariance))),
        whole_change=float(np.sqrt(np.sum((flat @ fit.c) ** 2) / len(B))),
        shift=half * fit.c[SHIFT],
        shift_sigma=half * sigma[SHIFT],
        scale=float(fit.c[SCALE]),
        scale_sigma=float(sigma[SCALE]),
        bend=fit.bend,
        bend_sigma=fit.bend_sigma,
        weakness=max(shares, key=lambda name: float(shares[name])),
        has_covariance=has_covariance,
        views=tuple(checked),
    )

"""The views' corners as arrays that all solvers share, and the checks that they must pass.

Views may be partial, so their numbers of corners differ. They are padded to the longest
with copies of their first corner and a mask of 0, which costs some arithmetic on zeros and
buys dense linear algebra over all views at once.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import scipy

from calibgui.engine.arrays import Array, BoolArray, IntArray, compute_median
from calibgui.engine.errors import CalibrationError


class Observation(NamedTuple):
    """The corners of one view. A plain tuple (uv, xy) serves as well."""

    uv: Array
    """(n, 2) measured corners, px."""
    xy: Array
    """(n, 2) the same corners on the board, mm."""
    cov: Array | None = None
    """(n, 2, 2) covariance of uv, px^2; equal and isotropic if None. Residuals larger than it
    are put down to the model, alike for all corners (``refinement/whitening.py``)."""


REFERENCE_PITCH = 30.0
"""Side dx' of a square on the virtual reference image, reference px (the paper's choice)."""

_MAX_PITCH_VIEWS = 25
"""Number of views that the board's pitch is measured in."""
VIEWS_PER_CHUNK = 64
"""Number of views worked on together: their arrays still fit the processor's cache."""
_MAX_UV, _MAX_XY = 1e7, 1e9
"""Largest coordinates, px and mm: no image and no board is larger."""
_MIN_EXTENT = 1e-9
"""Extent of a board below which all its corners count as one place, mm."""
_BEGINS, _ENDS = [0, 0, 1], [1, 2, 2]
"""Numbers of the points through which the lines lead that may hold all others."""
_POINTS_THAT_TELL = 12
"""Number of points, spread over all, that mostly show that no line holds all points but one."""
_MAX_ASYMMETRY = 1e-6
"""Largest difference of a covariance from its transpose, over its standard deviations: what is
beyond rounding to six digits is an error of whoever stated it."""
_MIN_VARIANCE = 1e-100
"""Variance of a corner below which its covariance cannot be inverted, px^2."""


@dataclass(frozen=True, eq=False, slots=True)
class Observations:
    """K views of up to N corners each."""

    uv: Array
    """(K, N, 2) measured corners, px."""
    xy: Array
    """(K, N, 2) corners on the board, mm; (K, N, 3) where the board is not flat."""
    mask: Array
    """(K, N) 1 for a corner, 0 for padding."""
    cov: Array | None = None
    """(K, N, 2, 2) covariances of uv, px^2, where they are given."""
    whitening: Array | None = None
    """(K, N, 2, 2) factors that whiten the residuals (``refinement/whitening.py``); None for 1."""
    tau2: float = 0.0
    """Variance of the models' own errors that the whitening allows for, px^2."""

    @property
    def count(self) -> int:
        """Number of corners in all views."""
        return int(self.mask.sum())

    @property
    def is_unweighted(self) -> bool:
        """True if there is no padding and all corners weigh 1."""
        return self.whitening is None and bool(self.mask.all())

    def select_views(self, views: slice | IntArray | BoolArray) -> Observations:
        """Return the observations of some of the views."""
        cov, whitening = (a if a is None else a[views] for a in (self.cov, self.whitening))
        return Observations(
            self.uv[views], self.xy[views], self.mask[views], cov, whitening, self.tau2
        )

    def corners_of(self, k: int) -> slice:
        """Return the slice of the second axis that holds the corners of view k, without padding."""
        return slice(0, int(self.mask[k].sum()))


def pack_observations(
    views: Sequence[Observation | tuple[Array, Array]], names: Sequence[str] | None = None
) -> Observations:
    """Check the views and bring them into arrays.

    Args:
        views: (uv, xy) or (uv, xy, cov) of each view.
        names: names of the views for messages; numbers by default.

    Raises:
        CalibrationError: if there are no views, or if one cannot be used; the message names it.
            Shapes may disagree, a number not be finite or be too large, corners repeat, be fewer
            than four or lie on one line, or a covariance not be positive.
    """
    if len(views) == 0:
        raise CalibrationError(
            "There are no views to calibrate from.",
            "Photograph the board at least 3 times from different directions.",
        )
    names = names or name_views(len(views))
    if len(names) != len(views):
        raise ValueError(f"{len(names)} names do not name {len(views)} views")
    shaped = [make_observation(*view, name=name) for view, name in zip(views, names, strict=True)]
    # All or nothing: a mixture of weighted and unweighted views has no common noise level.
    cov = [view.cov for view in shaped if view.cov is not None]
    if cov and len(cov) < len(shaped):
        without = next(k for k, view in enumerate(shaped) if view.cov is None)
        raise CalibrationError(
            f"{names[without]} has no corner covariances but others do.",
            "Give covariances for every view or for none.",
        )
    counts = np.array([len(view.uv) for view in shaped])
    packed = Observations(
        uv=_pad([view.uv for view in shaped], counts),
        xy=_pad([view.xy for view in shaped], counts),
        mask=(np.arange(counts.max()) < counts[:, None]).astype(np.float64),
        cov=_pad(cov, counts) if cov else None,
    )
    for part in slice_views(len(shaped)):
        _check_images(packed.select_views(part), names[part])
    for k in group_equal_boards(packed)[0].tolist():
        _check_board(packed.xy[k, packed.corners_of(k)], names[k])
    return packed


def select_spread_views(views: Observations, count: int) -> Observations:
    """Select up to `count` views, spread evenly over all."""
    if len(views.uv) <= count:
        return views
    return views.select_views(np.unique(np.linspace(0, len(views.uv) - 1, count).astype(np.int64)))


def slice_views(count: int) -> list[slice]:
    """Divide `count` views into consecutive slices of `VIEWS_PER_CHUNK`."""
    return [
        slice(begin, min(begin + VIEWS_PER_CHUNK, count))
        for begin in range(0, count, VIEWS_PER_CHUNK)
    ]


def group_equal_boards(observations: Observations) -> tuple[IntArray, IntArray]:
    """Group the views that show the same corners of the board.

    Mostly all views show the whole board, so that work on the board's points is done once.

    Returns:
        Indices of the first view of each group, ascending, and (K,) the group of each view.
    """
    K = len(observations.xy)
    if (observations.mask == observations.mask[0]).all() and (
        observations.xy == observations.xy[0]
    ).all():
        return np.zeros(1, dtype=np.int64), np.zeros(K, dtype=np.int64)
    first_views: dict[bytes, int] = {}
    counts = observations.mask.sum(axis=1).astype(int).tolist()
    views = enumerate(zip(observations.xy, counts, strict=True))
    originals = [first_views.setdefault(xy[:n].tobytes(), k) for k, (xy, n) in views]
    first, group = np.unique(originals, return_inverse=True)
    return first, group


def name_views(count: int) -> list[str]:
    """Number views that have no names."""
    return [f"View {k + 1}" for k in range(count)]


def arrange_by_axis(points: Array) -> Array:
    """Return points (K, n, 2) by axis (2, K, n), whose limits are found 20 times as fast."""
    return np.array(np.moveaxis(points, -1, 0), order="C")


def measure_pitch(observations: Observations) -> float:
    """Measure the side of the board's squares, mm: the median distance of neighbouring corners.

    It is measured view by view, because views may give the same corner's place with different
    precision, and the least is taken, because a partly seen board can lack neighbours.
    """
    part = select_spread_views(observations, _MAX_PITCH_VIEWS)
    unlike = [part.xy[k, part.corners_of(k), :2] for k in group_equal_boards(part)[0].tolist()]
    nearest = [np.asarray(scipy.spatial.cKDTree(xy).query(xy, k=2)[0])[:, 1] for xy in unlike]
    return float(min(compute_median(distance) for distance in nearest))


def digest_views(views: Observations) -> tuple[str, ...]:
    """Return a digest of the measured corners of each view, by which it is recognised again."""
    return tuple(
        hashlib.sha256(uv[views.corners_of(k)].tobytes()).hexdigest()[:16]
        for k, uv in enumerate(views.uv)
    )


def make_observation(
    uv: npt.ArrayLike, xy: npt.ArrayLike, cov: npt.ArrayLike | None = None, *, name: str = "View"
) -> Observation:
    """Make the observation of a view, in float64.

    Args:
        uv: corners (n, 2) px, or (n, 1, 2) as OpenCV has them.
        xy: their places on the board (n, 2) mm, or (n, 3) with Z = 0.
        cov: covariances (n, 2, 2) of the corners, px^2, where they are known.
        name: name of the view for messages.

    Raises:
        CalibrationError: for shapes that do not match, and fewer than four corners.
    """
    uv, xy = (_drop_opencvs_axis(np.asarray(points, np.float64)) for points in (uv, xy))
    if xy.ndim == 2 and xy.shape[1] == 3:
        if xy[:, 2].any():
            raise CalibrationError(
                f"{name}: board points are not in one plane: some Z are not 0.",
                "Give the places on a flat board, (n, 2) or (n, 3) with Z = 0.",
            )
        xy = xy[:, :2]
    if uv.ndim != 2 or uv.shape[1:] != (2,) or xy.shape != uv.shape:
        raise CalibrationError(
            f"{name}: corners of shape {uv.shape} do not match board points of shape {xy.shape}.",
            "Both must have one row a corner, (n, 2) or as OpenCV has them, (n, 1, 2) and (n, 3).",
        )
    spread = None if cov is None else np.asarray(cov, np.float64)
    if spread is not None and spread.shape != (*uv.shape, 2):
        raise CalibrationError(
            f"{name}: covariances of shape {spread.shape} do not match {len(uv)} corners.",
            "They must be (n, 2, 2), px^2.",
        )
    if len(uv) < 4:
        raise CalibrationError(
            f"{name} has {len(uv)} corners; a view needs at least 4.", "Remove it."
        )
    return Observation(uv, xy, spread)


def _drop_opencvs_axis(points: Array) -> Array:
    """Return points (n, 1, d), as OpenCV's functions return and take them, as (n, d)."""
    return points[:, 0] if points.ndim == 3 and points.shape[1] == 1 else points


def _pad(rows: Sequence[Array], counts: IntArray) -> Array:
    """Pad rows (n, ...) of each view to (K, N, ...) with copies of the first row."""
    if (counts == counts[0]).all():
        return np.concatenate(rows).reshape(len(rows), *rows[0].shape)
    padded = np.empty((len(rows), counts.max(), *rows[0].shape[1:]))
    for k, given in enumerate(rows):
        padded[k, : len(given)] = given
        padded[k, len(given) :] = given[0]
    return padded


def _check_images(part: Observations, names: Sequence[str]) -> None:
    """Refuse views with corners that cannot be calibrated from, naming the first."""

    def require(good: BoolArray, what: str, hint: str) -> None:
        if not good.all():
            raise CalibrationError(f"{names[int(np.argmin(good))]}{what}", hint)

    corners = arrange_by_axis(part.uv)
    low, high = corners.min(axis=2), corners.max(axis=2)
    farthest_uv = np.maximum(high, -low).max(axis=0)
    farthest_xy = np.abs(part.xy).reshape(len(part.xy), -1).max(axis=1)
    finite = np.isfinite(farthest_uv + farthest_xy)
    if part.cov is not None:
        finite &= np.isfinite(part.cov).all(axis=(1, 2, 3))
    require(
        finite,
        " holds a corner that is not a finite number.",
        "Remove that corner or the view.",
    )
    require(
        farthest_uv < _MAX_UV,
        f" has a corner farther than {_MAX_UV:.0e} px from the image's origin.",
        "Remove that corner or the view.",
    )
    require(
        farthest_xy < _MAX_XY,
        f" names a board point farther than {_MAX_XY:.0e} mm from the board's origin.",
        "Give places on the board in mm.",
    )
    require(
        _are_in_general_position(corners, (high - low).max(axis=0), part.mask),
        *_describe_one_line("corners"),
    )
    if part.cov is not None:
        require(
            np.all(_are_symmetric(part.cov), axis=1),
            " has a corner covariance that is not symmetric.",
            "Leave the covariances out or correct them.",
        )
        require(
            np.all(_are_positive_definite(part.cov), axis=1),
            " has a corner covariance that is not positive definite.",
            "Leave the covariances out or correct them.",
        )


def _are_symmetric(cov: Array) -> BoolArray:
    """Return whether covariances (..., 2, 2) are symmetric, but for rounding."""
    difference = np.abs(cov[..., 0, 1] - cov[..., 1, 0])
    variances = np.abs(cov[..., 0, 0] * cov[..., 1, 1])
    return np.asarray(difference <= _MAX_ASYMMETRY * np.sqrt(variances))


def _are_positive_definite(cov: Array) -> BoolArray:
    """Return whether covariances (..., 2, 2) have eigenvalues above `_MIN_VARIANCE`.

    They are symmetric. As a quotient the smaller eigenvalue keeps its digits.
    """
    a, b, c = cov[..., 0, 0], cov[..., 1, 0], cov[..., 1, 1]
    larger = (a + c) / 2 + np.hypot((a - c) / 2, b)
    with np.errstate(divide="ignore", invalid="ignore"):  # of a covariance of 0
        smaller = (a * c - b * b) / larger
    return np.asarray((larger > 0) & (smaller > _MIN_VARIANCE))


def _check_board(xy: Array, name: str) -> None:
    """Refuse a view with board points (n, 2) that cannot be calibrated from."""
    points = arrange_by_axis(xy[None])
    extent = (points.max(axis=2) - points.min(axis=2)).max(axis=0)
    if extent[0] < _MIN_EXTENT:
        raise CalibrationError(
            f"{name}: all board points are at one place.", "Give places on the board in mm."
        )
    ordered = np.sort(np.ascontiguousarray(xy).view(np.complex128)[:, 0])
    if not (ordered[1:] != ordered[:-1]).all():
        raise CalibrationError(
            f"{name} names the same board point twice.", "Give each corner of the board once."
        )
    if not _are_in_general_position(points, extent, np.ones((1, len(xy)))).all():
        what, hint = _describe_one_line("board points")
        raise CalibrationError(f"{name}{what}", hint)


def _describe_one_line(points: str) -> tuple[str, str]:
    """Return message and hint for points on one line."""
    return (
        f": all {points}, or all but one, lie on one line.",
        "Use at least two corners from each of two rows.",
    )


def _are_in_general_position(points: Array, extent: Array, mask: Array) -> BoolArray:
    """Return (K,) whether at least two of the points (2, K, n) lie off every line.

    Without them there is no homography. The longer side of their rectangles is `extent` (K,).
    """
    # A line that holds all points but one holds two of the first three.
    begins, ends = points[..., _BEGINS], points[..., _ENDS]
    (X, Y), (x, y) = ends - begins, begins
    limit, offset = 1e-6 * extent[:, None] * np.hypot(X, Y), X * y - Y * x

    def are_two_off(views: slice | IntArray, step: int) -> BoolArray:
        by_x, by_y = points[:, views, None, ::step]
        area = X[views, :, None] * by_y - Y[views, :, None] * by_x - offset[views, :, None]
        off = (np.abs(area) > limit[views, :, None]) & (mask[views, None, ::step] > 0)
        return np.asarray((np.count_nonzero(off, axis=2) >= 2).all(axis=1))

    # Mostly a few of the points tell.
    good = are_two_off(slice(None), max(1, points.shape[2] // _POINTS_THAT_TELL))
    if not good.all():
        doubtful = np.flatnonzero(~good)
        good[doubtful] = are_two_off(doubtful, 1)
    return good

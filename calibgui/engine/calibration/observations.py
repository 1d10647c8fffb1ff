"""Targets, and what images show of them.

The views' corners as arrays that all the solvers share.

Views may be partial, so their corner counts differ. They are padded to the longest with
copies of their own first corner and a mask of 0, which costs some arithmetic on zeros and
buys dense linear algebra over all views at once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, BoolArray, IntArray
from calibgui.engine.errors import CalibrationError


class Observation(NamedTuple):
    """What one view contributes to a calibration. A plain tuple (uv, xy) serves as well."""

    uv: Array
    """(n, 2) measured corners, px."""
    xy: Array
    """(n, 2) the same corners on the plate, mm."""
    cov: Array | None = None
    """(n, 2, 2) covariance of uv, px^2; equal and isotropic if None. What the residuals have
    beyond it is put down to the model, alike for all corners (``estimation/weighting.py``)."""


REFERENCE_PITCH = 30.0
"""Side dx' of a square on the virtual reference image, reference px (the paper's choice)."""

_SAMPLED = 25
"""Views that the target's pitch is taken from."""
CHUNK = 64
"""Views worked on together: their arrays still fit the processor's cache."""
_FARTHEST_UV, _FARTHEST_XY = 1e7, 1e9
"""From the origin, px and mm: no image and no board is larger."""
_SMALLEST = 1e-9
"""Extent of a board, mm, below which there is none."""
_LEAST_VARIANCE = 1e-100
"""Of a corner, px^2: what is less cannot be inverted."""


@dataclass(frozen=True, eq=False, slots=True)
class Observations:
    """K views of up to N corners each."""

    uv: Array
    """(K, N, 2) measured corners, px."""
    xy: Array
    """(K, N, 2) corners on the plate, mm; (K, N, 3) where the plate is not flat."""
    mask: Array
    """(K, N) 1 for a corner, 0 for padding."""
    cov: Array | None = None
    """(K, N, 2, 2) covariances of uv, px^2, where they are given."""
    whitening: Array | None = None
    """(K, N, 2, 2) what residuals are multiplied with (``weighting.py``); nothing if None."""
    tau2: float = 0.0
    """What the whitening takes the model's own variance to be, px^2."""

    @property
    def count(self) -> int:
        """Number of corners in all views."""
        return int(self.mask.sum())

    @property
    def unweighted(self) -> bool:
        """Whether all places hold corners, and all of these weigh 1."""
        return self.whitening is None and bool(self.mask.all())

    def part(self, views: slice | IntArray | BoolArray) -> Observations:
        """Some of the views."""
        cov, whitening = (a if a is None else a[views] for a in (self.cov, self.whitening))
        return Observations(
            self.uv[views], self.xy[views], self.mask[views], cov, whitening, self.tau2
        )

    def view(self, k: int) -> slice:
        """The places of view k's corners along the second axis."""
        return slice(0, int(self.mask[k].sum()))


def pack(
    views: Sequence[Observation | tuple[Array, Array]], names: Sequence[str] | None = None
) -> Observations:
    """Check the views and bring them into arrays.

    Args:
        views: (uv, xy) or (uv, xy, cov) of each view.
        names: of the views, for messages; numbers by default.

    Raises:
        CalibrationError: naming the view, if shapes disagree, a number is not finite or too
            large, corners repeat, are fewer than four or lie on one line, or a covariance is not
            positive.
    """
    if len(views) == 0:
        raise CalibrationError(
            "There are no views to calibrate from.",
            "Photograph the board at least 3 times from different directions.",
        )
    names = names or view_names(len(views))
    if len(names) != len(views):
        raise ValueError(f"{len(names)} names do not name {len(views)} views")
    shaped = [_shaped(Observation(*view), name) for view, name in zip(views, names, strict=True)]
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
        uv=_padded([view.uv for view in shaped], counts),
        xy=_padded([view.xy for view in shaped], counts),
        mask=(np.arange(counts.max()) < counts[:, None]).astype(np.float64),
        cov=_padded(cov, counts) if cov else None,
    )
    for part in chunks(len(shaped)):
        _check_images(packed.part(part), names[part])
    for k in boards(packed)[0].tolist():
        _check_board(packed.xy[k, packed.view(k)], names[k])
    return packed


def chunks(count: int) -> list[slice]:
    """Consecutive slices of `count` views, `CHUNK` at a time."""
    return [slice(begin, min(begin + CHUNK, count)) for begin in range(0, count, CHUNK)]


def boards(observations: Observations) -> tuple[IntArray, IntArray]:
    """The first views of all that show the same corners, and which of these each view is like.

    Mostly all views show the whole board, and what is asked of one need not be asked of all.
    """
    K = len(observations.xy)
    if (observations.mask == observations.mask[0]).all() and (
        observations.xy == observations.xy[0]
    ).all():
        return np.zeros(1, dtype=np.int64), np.zeros(K, dtype=np.int64)
    first: dict[bytes, int] = {}
    counts = observations.mask.sum(axis=1).astype(int).tolist()
    views = enumerate(zip(observations.xy, counts, strict=True))
    like = [first.setdefault(xy[:n].tobytes(), k) for k, (xy, n) in views]
    firsts, which = np.unique(like, return_inverse=True)
    return firsts, which


def view_names(count: int) -> list[str]:
    """What views are called that have no names."""
    return [f"View {k + 1}" for k in range(count)]


def pitch(observations: Observations) -> float:
    """Side of the target's squares, mm: the median distance between neighbouring corners.

    View by view, because views may name the same corner's place with different precision, and
    the least of them, because a partly seen board can lack neighbours.
    """
    chosen = np.unique(np.linspace(0, len(observations.xy) - 1, _SAMPLED).astype(int))
    places = [observations.xy[k, observations.view(k), :2] for k in chosen.tolist()]
    unlike = {xy.tobytes(): xy for xy in places}.values()
    nearest = [np.asarray(scipy.spatial.cKDTree(xy).query(xy, k=2)[0])[:, 1] for xy in unlike]
    return float(min(np.median(distance) for distance in nearest))


def _shaped(view: Observation, name: str) -> Observation:
    uv, xy = (np.asarray(points, np.float64) for points in (view.uv, view.xy))
    if uv.ndim != 2 or uv.shape[1:] != (2,) or xy.shape != uv.shape:
        raise CalibrationError(
            f"{name}: corners of shape {uv.shape} do not match plate points of shape {xy.shape}.",
            "Both must be (n, 2), one row a corner.",
        )
    cov = None if view.cov is None else np.asarray(view.cov, np.float64)
    if cov is not None and cov.shape != (*uv.shape, 2):
        raise CalibrationError(
            f"{name}: covariances of shape {cov.shape} do not match {len(uv)} corners.",
            "They must be (n, 2, 2), px^2.",
        )
    if len(uv) < 4:
        raise CalibrationError(
            f"{name} has {len(uv)} corners; a view needs at least 4.", "Remove it."
        )
    return Observation(uv, xy, cov)


def _padded(rows: Sequence[Array], counts: IntArray) -> Array:
    """(K, N, ...) rows (n, ...) of each view, continued with copies of the first."""
    padded = np.empty((len(rows), counts.max(), *rows[0].shape[1:]))
    for k, given in enumerate(rows):
        padded[k, : len(given)] = given
        padded[k, len(given) :] = given[0]
    return padded


def _check_images(part: Observations, names: Sequence[str]) -> None:
    """Refuse views with corners that cannot be calibrated from, naming the first."""

    def insist(good: BoolArray, what: str, hint: str) -> None:
        if not good.all():
            raise CalibrationError(f"{names[int(np.argmin(good))]}{what}", hint)

    arrays = [part.uv, part.xy] if part.cov is None else [part.uv, part.xy, part.cov]
    finite = [np.isfinite(array).reshape(len(array), -1).all(axis=1) for array in arrays]
    insist(
        np.logical_and.reduce(finite),
        " holds a corner that is not a finite number.",
        "Remove that corner or the view.",
    )
    insist(
        np.abs(part.uv).max(axis=(1, 2)) < _FARTHEST_UV,
        f" has a corner farther than {_FARTHEST_UV:.0e} px from the image's origin.",
        "Remove that corner or the view.",
    )
    insist(
        np.abs(part.xy).max(axis=(1, 2)) < _FARTHEST_XY,
        f" names a plate point farther than {_FARTHEST_XY:.0e} mm from the plate's origin.",
        "Give places on the board in mm.",
    )
    insist(_in_general_position(part.uv, part.mask), *_on_one_line("corners"))
    if part.cov is not None:
        insist(
            np.all(np.linalg.eigvalsh(part.cov)[..., 0] > _LEAST_VARIANCE, axis=1),
            " has a corner covariance that is not positive definite.",
            "Leave the covariances out or correct them.",
        )


def _check_board(xy: Array, name: str) -> None:
    """Refuse a view with plate points (n, 2) that cannot be calibrated from."""
    if np.ptp(xy, axis=0).max() < _SMALLEST:
        raise CalibrationError(
            f"{name}: all plate points are at one place.", "Give places on the board in mm."
        )
    if not np.diff(np.sort(np.ascontiguousarray(xy).view(np.complex128)[:, 0])).all():
        raise CalibrationError(
            f"{name} names the same plate point twice.", "Give each corner of the board once."
        )
    if not _in_general_position(xy[None], np.ones((1, len(xy)))).all():
        what, hint = _on_one_line("plate points")
        raise CalibrationError(f"{name}{what}", hint)


def _on_one_line(points: str) -> tuple[str, str]:
    return (
        f": all {points}, or all but one, lie on one line.",
        "Use at least two corners from each of two rows.",
    )


def _in_general_position(points: Array, mask: Array) -> BoolArray:
    """(K,) whether at least two of the points (K, n, 2) lie off every line.

    Without them there is no homography.
    """
    tolerance = 1e-6 * np.ptp(points, axis=1).max(axis=1)
    x, y = np.array(np.moveaxis(points, -1, 0), order="C")
    good = np.ones(len(points), dtype=bool)
    # A line that holds all points but one holds two of the first three.
    for i, j in ((0, 1), (0, 2), (1, 2)):
        along = points[:, j] - points[:, i]
        X, Y = along.T[..., None]
        area = X * y - Y * x - (X[:, 0] * y[:, i] - Y[:, 0] * x[:, i])[:, None]
        limit = tolerance * np.linalg.norm(along, axis=1)
        off = (np.abs(area) > limit[:, None]) & (mask > 0)
        good &= np.count_nonzero(off, axis=1) >= 2
    return good

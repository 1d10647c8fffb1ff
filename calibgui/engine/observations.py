"""The views' corners as arrays that all the solvers share.

Views may be partial, so their corner counts differ. They are padded to the longest with
copies of their own first corner and a mask of 0, which costs some arithmetic on zeros and
buys dense linear algebra over all views at once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from calibgui.engine.errors import CalibrationError
from calibgui.engine.types import Array, Observation

REFERENCE_PITCH = 30.0
"""Side dx' of a square on the virtual reference image, reference px (the paper's choice)."""

_SAMPLED = 25
"""Views that the target's pitch is taken from."""


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

    def part(self, views: slice) -> Observations:
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
        CalibrationError: naming the view, if shapes disagree, a number is not finite, corners
            repeat, are fewer than four or lie on one line, or a covariance is not positive.
    """
    if not views:
        raise CalibrationError(
            "There are no views to calibrate from.",
            "Photograph the board at least 3 times from different directions.",
        )
    names = names or view_names(len(views))
    pairs = zip(views, names, strict=True)
    checked = [_checked(Observation(*view), name) for view, name in pairs]
    longest = max(len(view.uv) for view in checked)
    # All or nothing: a mixture of weighted and unweighted views has no common noise level.
    weighted = [view.cov is not None for view in checked]
    if any(weighted) and not all(weighted):
        raise CalibrationError(
            f"{names[weighted.index(False)]} has no corner covariances but others do.",
            "Give covariances for every view or for none.",
        )
    return Observations(
        uv=np.stack([_padded(view.uv, longest) for view in checked]),
        xy=np.stack([_padded(view.xy, longest) for view in checked]),
        mask=np.stack([np.arange(longest) < len(view.uv) for view in checked]).astype(np.float64),
        cov=_covariances(checked, longest) if all(weighted) else None,
    )


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
    nearest = [np.asarray(cKDTree(xy).query(xy, k=2)[0])[:, 1] for xy in places]
    return float(min(np.median(distance) for distance in nearest))


def _checked(view: Observation, name: str) -> Observation:
    uv, xy = (np.ascontiguousarray(points, np.float64) for points in (view.uv, view.xy))
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
    arrays = [uv, xy] if cov is None else [uv, xy, cov]
    if not all(np.isfinite(array).all() for array in arrays):
        raise CalibrationError(
            f"{name} holds a corner that is not a finite number.",
            "Remove that corner or the view.",
        )
    if len(uv) < 4:
        raise CalibrationError(
            f"{name} has {len(uv)} corners; a view needs at least 4.", "Remove it."
        )
    if not np.diff(np.sort(xy.view(np.complex128)[:, 0])).all():
        raise CalibrationError(
            f"{name} names the same plate point twice.", "Give each corner of the board once."
        )
    for points, what in ((uv, "corners"), (xy, "plate points")):
        if not _in_general_position(points):
            raise CalibrationError(
                f"{name}: all {what}, or all but one, lie on one line.",
                "Use at least two corners from each of two rows.",
            )
    if cov is not None and not (np.linalg.eigvalsh(cov)[:, 0] > 0).all():
        raise CalibrationError(
            f"{name} has a corner covariance that is not positive definite.",
            "Leave the covariances out or correct them.",
        )
    return Observation(uv, xy, cov)


def _in_general_position(points: Array) -> bool:
    """Whether at least two points (n, 2) lie off every line, as a homography needs."""
    tolerance = 1e-6 * np.ptp(points, axis=0).max()
    # A line that holds all points but one holds two of the first three.
    base, along = points[[0, 0, 1]], points[[1, 2, 2]] - points[[0, 0, 1]]
    (x, y), (dx, dy) = along.T[..., None], np.moveaxis(points - base[:, None], -1, 0)
    off = np.abs(x * dy - y * dx) > tolerance * np.hypot(x, y)
    return bool((off.sum(axis=1) >= 2).all())


def _covariances(views: list[Observation], length: int) -> Array:
    """(K, length, 2, 2), the unit matrix for padding."""
    cov = np.zeros((len(views), length, 2, 2)) + np.eye(2)
    for k, view in enumerate(views):
        cov[k, : len(view.uv)] = view.cov
    return cov


def _padded(rows: Array, length: int) -> Array:
    """`rows` continued to `length` with copies of the first row."""
    return np.concatenate([rows, np.repeat(rows[:1], length - len(rows), axis=0)])

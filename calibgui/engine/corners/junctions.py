"""X-junctions: points where two edges cross and the grey levels alternate around.

Near the crossing of two step edges the surface is a saddle, I ~ a sgn(d_1) sgn(d_2), so that
after a little smoothing the Hessian has one positive and one negative eigenvalue. Candidates
are the local maxima of its negated determinant

    R = Ixy^2 - Ixx Iyy,

which edges (one eigenvalue zero) and blobs (equal signs) leave at or below zero. A Newton step
to the point of zero gradient, -H^-1 grad I, places them between pixels.

Many textures have saddles. An X-junction is one whose grey levels on a circle around it change
side exactly four times, symmetric under a half turn. With angles counted from u towards v the
half circle crosses the mid level once downwards, at the angle A, and once upwards, at B: the
sector from A to B is dark. Neighbours on a board see the same two edges with A and B exchanged.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibgui.engine import kernels, opencv
from calibgui.engine.imaging.sampling import sample
from calibgui.engine.opencv import Image, Image32
from calibgui.engine.types import Array, BoolArray, IntArray

MAX_CANDIDATES = 3000
_FARTHEST = 1.5
"""Greatest distance of a saddle point from its pixel along either axis, px."""
_SAMPLES = 32
_ANGLES = 2 * np.pi * np.arange(_SAMPLES) / _SAMPLES
_CIRCLES = np.multiply.outer((3.0, 4.5, 7.0), np.column_stack([np.cos(_ANGLES), np.sin(_ANGLES)]))
"""Circles tried in turn, px: small squares first, then those that blur has rounded."""
_ASYMMETRY = 0.30
"""Greatest rms difference of opposite samples over the circle's contrast."""
_OFF_MIDDLE = 0.3
"""Greatest distance of the centre from the mid level, over the contrast."""
_NARROWEST = np.radians(12.0)
"""Least angle between the two edges."""


@dataclass(frozen=True, eq=False, slots=True)
class Saddles:
    """Candidate saddle points of one image, strongest first."""

    smooth: Image32
    """(h, w) the image that they were found in, slightly blurred."""
    uv: Array
    """(n, 2) px."""
    strength: Array
    """(n,) R, squared grey levels per px^4."""

    def under(self, mask: BoolArray) -> Saddles:
        """The saddles under a mask (n,)."""
        return Saddles(self.smooth, self.uv[mask], self.strength[mask])


@dataclass(frozen=True, eq=False, slots=True)
class Junctions:
    """X-junctions of one image."""

    uv: Array
    """(n, 2) px."""
    edges: Array
    """(n, 2) angles A < B < A + pi of the edges, rad from u towards v; dark from A to B."""
    contrast: Array
    """(n,) bright minus dark, grey levels."""

    def __len__(self) -> int:
        return len(self.uv)


def find_saddles(image: Image, floor: float) -> Saddles:
    """The strongest saddle points of `image` (h, w).

    Args:
        image: grey levels.
        floor: least contrast of a junction worth finding, grey levels.
    """
    g = opencv.smooth(image, 1.0)
    # A crossing of contrast c, smoothed by 1 px, has R = (c / pi)^2 where it is sharp.
    where = (_compiled_peaks if kernels.COMPILED else _peaks)(g, (0.1 * floor) ** 2)
    uv, strength = (_compiled_stationary if kernels.COMPILED else _stationary)(g, where)
    near = np.isfinite(strength)
    return Saddles(g, uv[near], strength[near])


def _stationary(g: Image32, where: IntArray) -> tuple[Array, Array]:
    """The points of zero gradient (n, 2) near pixels `where` (n,) of the image, and R there, NaN
    where they are not near."""
    v, u = np.divmod(where, g.shape[1])
    near = {(i, j): g[v + j, u + i].astype(np.float64) for i in (-1, 0, 1) for j in (-1, 0, 1)}
    gu, gv = ((near[i, j] - near[-i, -j]) / 2 for i, j in ((1, 0), (0, 1)))
    xx, yy = (near[i, j] - 2 * near[0, 0] + near[-i, -j] for i, j in ((1, 0), (0, 1)))
    xy = (near[1, 1] - near[1, -1] - near[-1, 1] + near[-1, -1]) / 4
    det = xy * xy - xx * yy
    du = (yy * gu - xy * gv) / det
    dv = (xx * gv - xy * gu) / det
    inside = np.maximum(abs(du), abs(dv)) < _FARTHEST
    return np.column_stack([u + du, v + dv]), np.where(inside, det, np.nan)


def _compiled_stationary(g: Image32, where: IntArray) -> tuple[Array, Array]:
    """`_stationary` by the compiled kernel."""
    from calibgui.engine.kernels import junctions

    return junctions.stationary(g, where, _FARTHEST)


def _peaks(g: Image32, least: float) -> IntArray:
    """(n,) flat indices of the strongest maxima of R in the image `g`, strongest first."""
    delta, central, second = [0.0, 1.0, 0.0], [-0.5, 0.0, 0.5], [1.0, -2.0, 1.0]
    Ixx = opencv.separable(g, second, delta)
    Iyy = opencv.separable(g, delta, second)
    Ixy = opencv.separable(g, central, central)
    R = Ixy * Ixy - Ixx * Iyy
    R[[0, -1]] = R[:, [0, -1]] = -np.inf
    peak = (opencv.dilate(R, 5) == R) & (least < R)
    peak[:2], peak[-2:], peak[:, :2], peak[:, -2:] = False, False, False, False
    where = np.flatnonzero(peak)
    order = np.argsort(-R.ravel()[where], kind="stable")
    return where[order[:MAX_CANDIDATES]]


def _compiled_peaks(g: Image32, least: float) -> IntArray:
    """`_peaks` by the compiled kernel."""
    from calibgui.engine.kernels import junctions

    return junctions.peaks(g, least, MAX_CANDIDATES)


def classify(smooth: Image32, uv: Array, floor: float) -> tuple[BoolArray, Junctions]:
    """Which of the points `uv` (n, 2) of the image are X-junctions of contrast `floor` or more.

    Returns:
        A mask (n,) and the junctions under it.
    """
    passed, found = (_compiled_rings if kernels.COMPILED else _rings)(smooth, uv, floor)
    return passed, Junctions(uv[passed], found[passed, :2], found[passed, 2])


def _rings(smooth: Image32, uv: Array, floor: float) -> tuple[BoolArray, Array]:
    """Which points (n,) pass the test on one of the circles, and (n, 3) A, B and contrast."""
    passed, found = np.zeros(len(uv), dtype=np.bool_), np.zeros((len(uv), 3))
    for circle in _CIRCLES:
        rest = np.flatnonzero(~passed)
        passed[rest], found[rest] = _ring(smooth, uv[rest], circle, floor)
    return passed, found


def _compiled_rings(smooth: Image32, uv: Array, floor: float) -> tuple[BoolArray, Array]:
    """`_rings` by the compiled kernel."""
    from calibgui.engine.kernels import junctions

    return junctions.rings(smooth, uv, _CIRCLES, floor, (_ASYMMETRY, _OFF_MIDDLE, _NARROWEST))


def _ring(smooth: Image32, uv: Array, circle: Array, floor: float) -> tuple[BoolArray, Array]:
    """The test on one circle (samples, 2): passed (n,) and (n, 3) A, B and contrast."""
    values = sample(smooth, uv[:, None] + circle)
    near, far = values[:, : _SAMPLES // 2], values[:, _SAMPLES // 2 :]
    half = (near + far) / 2
    low, high = half.min(axis=1), half.max(axis=1)
    contrast = high - low
    asymmetry = np.sqrt(np.mean((near - far) ** 2, axis=1))
    centre = sample(smooth, uv)
    middle = (low + high) / 2
    level = half - middle[:, None]
    after = np.roll(level, -1, axis=1)
    down, up = (level > 0) & (after <= 0), (level <= 0) & (after > 0)
    edges = np.stack([_crossing(level, after, down), _crossing(level, after, up)], axis=1)
    edges[:, 1] += np.pi * (edges[:, 1] < edges[:, 0])
    width = edges[:, 1] - edges[:, 0]
    passed = (
        (np.sum(down, axis=1) == 1)
        & (contrast > floor)
        & (asymmetry < _ASYMMETRY * contrast)
        & (abs(centre - middle) < _OFF_MIDDLE * contrast)
        & (width > _NARROWEST)
        & (width < np.pi - _NARROWEST)
    )
    return passed, np.column_stack([edges, contrast])


def _crossing(level: Array, after: Array, where: BoolArray) -> Array:
    """(n,) angle in [0, pi) at which each row crosses zero between a marked sample and the next."""
    k = np.argmax(where, axis=1)
    row = np.arange(len(level))
    a, b = level[row, k], after[row, k]
    step = np.divide(a, a - b, out=np.zeros_like(a), where=a != b)
    return np.asarray((k + step) * 2 * np.pi / _SAMPLES)

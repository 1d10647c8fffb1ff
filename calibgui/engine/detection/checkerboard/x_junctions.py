"""X-junctions: points where two edges cross and the grey levels alternate around.

Near the crossing of two step edges the surface is a saddle, I ~ a sgn(d_1) sgn(d_2), so that
after a little smoothing the Hessian has one positive and one negative eigenvalue. Candidates
are the local maxima of its negated determinant

    R = Ixy^2 - Ixx Iyy,

which edges (one eigenvalue zero) and blobs (equal signs) leave at or below zero. Newton steps
to the point of zero gradient, -H^-1 grad I, place them between pixels.

Many textures have saddles. An X-junction is one whose grey levels on a circle around it change
side exactly four times, symmetric under a half turn. With angles counted from u towards v the
half circle crosses the mid level once downwards, at the angle A, and once upwards, at B: the
sector from A to B is dark. Neighbours on a board see the same two edges with A and B exchanged.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from calibgui.engine import kernels, opencv
from calibgui.engine.arrays import Array, BoolArray, GreyImage, IntArray
from calibgui.engine.images.sampling import sample

MAX_CANDIDATES = 3000
_NEWTON = 3
"""Steps to a saddle point: one alone would fall short by a third between two pixels."""
_FARTHEST = 1.5
"""Greatest distance of a saddle point from its pixel along either axis, px."""
_SAMPLES = 32
_ANGLES = 2 * np.pi * np.arange(_SAMPLES) / _SAMPLES
_CIRCLES = np.multiply.outer((3.0, 4.5, 7.0), np.column_stack([np.cos(_ANGLES), np.sin(_ANGLES)]))
"""Circles tried in turn, px: small squares first, then those that blur has rounded."""
_ASYMMETRY = 0.30
"""Greatest rms difference of opposite samples over the circle's contrast."""
_NARROWEST = np.radians(12.0)
"""Least angle between the two edges."""


class Tolerance(NamedTuple):
    """In what is taken for a junction and for the edge between two."""

    off_middle: float
    """Greatest distance of the centre from the mid level, over the contrast."""
    along: float
    """Greatest angle between an edge and the way to the neighbour that it leads to, rad."""
    parallel: float
    """Greatest angle between the crossing edges of two neighbours, rad."""


CROSSED = Tolerance(0.3, np.radians(20.0), np.radians(25.0))
"""Where edges cross."""
PARTED = Tolerance(0.42, np.radians(26.0), np.radians(40.0))
"""Where squares overlap or part: all corners are bright or all dark in the middle, and edges pass
them by on the one side or, at their neighbours, on the other."""


@dataclass(frozen=True, eq=False, slots=True)
class Saddles:
    """Candidate saddle points of one image, strongest first."""

    smooth: GreyImage
    """(h, w) the image that they were found in, slightly blurred, in levels of its own."""
    floor: float
    """Least contrast of a junction worth finding, in these levels."""
    uv: Array
    """(n, 2) px."""

    def under(self, mask: BoolArray) -> Saddles:
        """The saddles under a mask (n,)."""
        return Saddles(self.smooth, self.floor, self.uv[mask])


@dataclass(frozen=True, eq=False, slots=True)
class Junctions:
    """X-junctions of one image."""

    uv: Array
    """(n, 2) px."""
    edges: Array
    """(n, 2) angles A < B < A + pi of the edges, rad from u towards v; dark from A to B."""
    contrast: Array
    """(n,) bright minus dark, levels of the smoothed image."""

    def __len__(self) -> int:
        return len(self.uv)


def find_saddles(image: GreyImage, floor: float) -> Saddles:
    """The strongest saddle points of `image` (h, w).

    Args:
        image: grey levels.
        floor: least contrast of a junction worth finding, grey levels.
    """
    g, levels = opencv.smooth(image, 1.0)
    floor = levels * floor
    # A crossing of contrast c, smoothed by 1 px, has R = (c / pi)^2 where it is sharp.
    where = (_compiled_peaks if kernels.COMPILED else _peaks)(g, (0.1 * floor) ** 2)
    uv, near = (_compiled_stationary if kernels.COMPILED else _stationary)(g, where)
    return Saddles(g, floor, uv[near])


def _stationary(g: GreyImage, where: IntArray) -> tuple[Array, BoolArray]:
    """The points of zero gradient (n, 2) of the image's saddles at pixels `where` (n,), and which
    of them are near."""
    pixel = np.column_stack(np.divmod(where, g.shape[1]))[:, ::-1].astype(np.float64)
    uv, near = pixel.copy(), np.ones(len(pixel), dtype=np.bool_)
    for _ in range(_NEWTON):
        moved = uv + _newton(g, uv)
        near &= (abs(moved - pixel) < _FARTHEST).all(axis=1)
        uv[near] = moved[near]
    return uv, near


def _newton(g: GreyImage, uv: Array) -> Array:
    """The step -H^-1 grad I (n, 2) from points `uv` (n, 2) of the image."""
    at = {(i, j): sample(g, uv + np.array([i, j])) for i in (-1, 0, 1) for j in (-1, 0, 1)}
    gu, gv = ((at[i, j] - at[-i, -j]) / 2 for i, j in ((1, 0), (0, 1)))
    xx, yy = (at[i, j] - 2 * at[0, 0] + at[-i, -j] for i, j in ((1, 0), (0, 1)))
    xy = (at[1, 1] - at[1, -1] - at[-1, 1] + at[-1, -1]) / 4
    step = np.column_stack([yy * gu - xy * gv, xx * gv - xy * gu])
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(step / (xy * xy - xx * yy)[:, None])


def _compiled_stationary(g: GreyImage, where: IntArray) -> tuple[Array, BoolArray]:
    """`_stationary` by the compiled kernel."""
    from calibgui.engine.kernels import x_junctions

    return x_junctions.stationary(g, where, _NEWTON, _FARTHEST)


def _peaks(g: GreyImage, least: float) -> IntArray:
    """(n,) flat indices of the strongest maxima of R in the image `g`, strongest first."""
    delta, central, second = [0.0, 1.0, 0.0], [-0.5, 0.0, 0.5], [1.0, -2.0, 1.0]
    Ixx = opencv.separable(g, second, delta)
    Iyy = opencv.separable(g, delta, second)
    Ixy = opencv.separable(g, central, central)
    R = Ixy * Ixy - Ixx * Iyy
    R[[0, -1]] = R[:, [0, -1]] = -np.inf
    around = np.ones((5, 5), dtype=np.bool_)
    before = np.arange(25).reshape(5, 5) < 12  # of equally great ones the first is the peak
    peak = (least < R) & (opencv.greatest(R, around) == R) & (opencv.greatest(R, before) < R)
    peak[:2], peak[-2:], peak[:, :2], peak[:, -2:] = False, False, False, False
    where = np.flatnonzero(peak)
    order = np.argsort(-R.ravel()[where], kind="stable")
    return where[order[:MAX_CANDIDATES]]


def _compiled_peaks(g: GreyImage, least: float) -> IntArray:
    """`_peaks` by the compiled kernel."""
    from calibgui.engine.kernels import x_junctions

    return x_junctions.peaks(g, least, MAX_CANDIDATES)


def classify(saddles: Saddles, tolerance: Tolerance = CROSSED) -> tuple[BoolArray, Junctions]:
    """Which of the `saddles` (n,) are X-junctions of no less contrast than is worth finding.

    Returns:
        A mask (n,) and the junctions under it.
    """
    rings = _compiled_rings if kernels.COMPILED else _rings
    passed, found = rings(saddles.smooth, saddles.uv, saddles.floor, tolerance.off_middle)
    return passed, Junctions(saddles.uv[passed], found[passed, :2], found[passed, 2])


def _rings(
    smooth: GreyImage, uv: Array, floor: float, off_middle: float
) -> tuple[BoolArray, Array]:
    """Which points (n,) pass the test on one of the circles, and (n, 3) A, B and contrast."""
    passed, found = np.zeros(len(uv), dtype=np.bool_), np.zeros((len(uv), 3))
    for circle in _CIRCLES:
        rest = np.flatnonzero(~passed)
        passed[rest], found[rest] = _ring(smooth, uv[rest], circle, floor, off_middle)
    return passed, found


def _compiled_rings(
    smooth: GreyImage, uv: Array, floor: float, off_middle: float
) -> tuple[BoolArray, Array]:
    """`_rings` by the compiled kernel."""
    from calibgui.engine.kernels import x_junctions

    return x_junctions.rings(smooth, uv, _CIRCLES, floor, (_ASYMMETRY, off_middle, _NARROWEST))


def _ring(
    smooth: GreyImage, uv: Array, circle: Array, floor: float, off_middle: float
) -> tuple[BoolArray, Array]:
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
        & (abs(centre - middle) < off_middle * contrast)
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

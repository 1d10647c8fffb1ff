"""X-junctions: points where two edges cross and the grey levels alternate around.

The inner corners of a checkerboard are such junctions, whatever the perspective and the lens. They
are found in two steps, a cheap one at every pixel and a careful one at few.

Near the crossing of two step edges the surface is a saddle, I ~ a sgn(d_1) sgn(d_2), so that
after a little smoothing the Hessian has one positive and one negative eigenvalue. Candidates
are the local maxima of its negated determinant

    R = Ixy^2 - Ixx Iyy,

which edges (one eigenvalue zero) and blobs (equal signs) leave at or below zero (the determinant
of the Hessian as a detector: Beaudet 1978). Newton steps to the point of zero gradient,
-H^-1 grad I, place them between pixels.

Many textures have saddles. An X-junction is one whose grey levels on a circle around it change
side exactly four times, symmetric under a half turn. With angles counted from u towards v the
half circle crosses the mid level once downwards, at the angle A, and once upwards, at B: the
sector from A to B is dark. Neighbours on a board see the same two edges with A and B exchanged.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibgui.engine import kernels, opencv
from calibgui.engine.arrays import Array, BoolArray, GreyImage, IntArray
from calibgui.engine.images.sampling import sample_image

MAX_CANDIDATES = 3000
"""Number of saddle points, the strongest, that are kept in a level."""
_MIN_SADDLE = 0.1
"""Least square root of the determinant R of a saddle point, over the least contrast of a
junction; a sharp crossing smoothed by 1 px has 1 / pi."""
_MAX_SHIFT = 1.5
"""Greatest distance of a saddle point from its pixel along either axis, px."""
_MAX_ASYMMETRY = 0.30
"""Greatest rms difference of opposite samples of a circle, over its contrast."""
_MIN_EDGE_ANGLE = float(np.radians(12.0))
"""Least angle between the two edges of a junction, rad."""
_SMOOTHING = 1.0
"""Standard deviation of the blur before derivatives are taken, px."""
_NEWTON_STEPS = 3
"""Number of Newton steps to a saddle point: one would fall short by a third between two pixels."""
_SAMPLES = 32
_ANGLES = 2 * np.pi * np.arange(_SAMPLES) / _SAMPLES
_CIRCLES = np.multiply.outer((3.0, 4.5, 7.0), np.column_stack([np.cos(_ANGLES), np.sin(_ANGLES)]))
"""(circles, samples, 2) offsets of the samples on the circles tried in turn, px: the smallest first
for small squares, then larger ones for corners that blur has rounded."""


@dataclass(frozen=True, slots=True, kw_only=True)
class JunctionTolerance:
    """Greatest deviations from an ideal X-junction and from the edge between two of them."""

    off_middle: float
    """Greatest difference of the centre from the mid grey level, over the contrast."""
    along: float
    """Greatest angle between an edge and the line to the neighbour that it leads to, rad."""
    parallel: float
    """Greatest angle between the crossing edges of two neighbours, rad."""


CROSSING_TOLERANCE = JunctionTolerance(
    off_middle=0.3, along=float(np.radians(20.0)), parallel=float(np.radians(25.0))
)
"""Tolerance where edges cross."""
PARTED_TOLERANCE = JunctionTolerance(
    off_middle=0.42, along=float(np.radians(26.0)), parallel=float(np.radians(40.0))
)
"""Tolerance where squares overlap or part: all corners are bright or all dark in the middle,
and edges pass them by on the one side or, at their neighbours, on the other."""


@dataclass(frozen=True, eq=False, slots=True)
class Saddles:
    """Candidate saddle points of one image, strongest first."""

    smooth: GreyImage
    """(h, w) the image that they were found in, slightly blurred, in levels of its own."""
    min_contrast: float
    """Least contrast of a junction worth finding, in these levels."""
    uv: Array
    """(n, 2) px."""

    def select(self, mask: BoolArray) -> Saddles:
        """Return the saddles under a mask (n,)."""
        return Saddles(self.smooth, self.min_contrast, self.uv[mask])


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


def find_saddles(image: GreyImage, min_contrast: float) -> Saddles:
    """Find the strongest saddle points of an image.

    Args:
        image: (h, w) grey levels.
        min_contrast: least contrast of a junction worth finding, grey levels.
    """
    smooth, levels = opencv.blur_image(image, _SMOOTHING)
    min_contrast = levels * min_contrast
    # A crossing of contrast c, smoothed by 1 px, has R = (c / pi)^2 where it is sharp.
    pixels = _find_peaks(smooth, (_MIN_SADDLE * min_contrast) ** 2, MAX_CANDIDATES)
    uv, is_near = _refine_stationary(smooth, pixels, _NEWTON_STEPS, _MAX_SHIFT)
    return Saddles(smooth, min_contrast, uv[is_near])


@kernels.with_kernel("x_junctions", "refine_stationary")
def _refine_stationary(
    smooth: GreyImage, pixels: IntArray, steps: int, max_shift: float
) -> tuple[Array, BoolArray]:
    """Move saddles from their pixels to the points of zero gradient.

    Args:
        smooth: (h, w) grey levels.
        pixels: (n,) flat indices of the saddles' pixels.
        steps: number of Newton steps.
        max_shift: greatest distance from the pixel along either axis, px.

    Returns:
        The points (n, 2) px, and which of them (n,) stayed near their pixels.
    """
    start = np.column_stack(np.divmod(pixels, smooth.shape[1]))[:, ::-1].astype(np.float64)
    uv, is_near = start.copy(), np.ones(len(start), dtype=np.bool_)
    for _ in range(steps):
        moved = uv + _compute_newton_step(smooth, uv)
        is_near &= (abs(moved - start) < max_shift).all(axis=1)
        uv[is_near] = moved[is_near]
    return uv, is_near


def _compute_newton_step(smooth: GreyImage, uv: Array) -> Array:
    """Compute the step -H^-1 grad I (n, 2) from points `uv` (n, 2) px of the image."""
    at = {
        (i, j): sample_image(smooth, uv + np.array([i, j])) for i in (-1, 0, 1) for j in (-1, 0, 1)
    }
    gu, gv = ((at[i, j] - at[-i, -j]) / 2 for i, j in ((1, 0), (0, 1)))
    xx, yy = (at[i, j] - 2 * at[0, 0] + at[-i, -j] for i, j in ((1, 0), (0, 1)))
    xy = (at[1, 1] - at[1, -1] - at[-1, 1] + at[-1, -1]) / 4
    step = np.column_stack([yy * gu - xy * gv, xx * gv - xy * gu])
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(step / (xy * xy - xx * yy)[:, None])


@kernels.with_kernel("x_junctions", "find_peaks")
def _find_peaks(smooth: GreyImage, min_determinant: float, max_count: int) -> IntArray:
    """Return (n,) flat indices of the strongest maxima of R, strongest first.

    Args:
        smooth: (h, w) grey levels.
        min_determinant: least R, squared grey levels.
        max_count: greatest number of maxima.
    """
    delta, central, second = [0.0, 1.0, 0.0], [-0.5, 0.0, 0.5], [1.0, -2.0, 1.0]
    Ixx = opencv.correlate_separable(smooth, second, delta)
    Iyy = opencv.correlate_separable(smooth, delta, second)
    Ixy = opencv.correlate_separable(smooth, central, central)
    R = Ixy * Ixy - Ixx * Iyy
    R[[0, -1]] = R[:, [0, -1]] = -np.inf
    around = np.ones((5, 5), dtype=np.bool_)
    before = np.arange(25).reshape(5, 5) < 12  # of equally great ones the first is the peak
    peak = (
        (min_determinant < R)
        & (opencv.dilate_image(R, around) == R)
        & (opencv.dilate_image(R, before) < R)
    )
    peak[:2], peak[-2:], peak[:, :2], peak[:, -2:] = False, False, False, False
    where = np.flatnonzero(peak)
    order = np.argsort(-R.ravel()[where], kind="stable")
    return where[order[:max_count]]


def classify_saddles(
    saddles: Saddles, tolerance: JunctionTolerance = CROSSING_TOLERANCE
) -> tuple[BoolArray, Junctions]:
    """Decide which of the `saddles` (n,) are X-junctions of sufficient contrast.

    Returns:
        A mask (n,) and the junctions under it.
    """
    passed, rings = _check_circles(
        saddles.smooth,
        saddles.uv,
        _CIRCLES,
        saddles.min_contrast,
        (_MAX_ASYMMETRY, tolerance.off_middle, _MIN_EDGE_ANGLE),
    )
    return passed, Junctions(saddles.uv[passed], rings[passed, :2], rings[passed, 2])


@kernels.with_kernel("x_junctions", "check_circles")
def _check_circles(
    smooth: GreyImage,
    uv: Array,
    circles: Array,
    min_contrast: float,
    limits: tuple[float, float, float],
) -> tuple[BoolArray, Array]:
    """Test points for junctions on circles in turn, until one passes.

    Args:
        smooth: (h, w) grey levels.
        uv: (n, 2) px.
        circles: (k, samples, 2) offsets of the samples, px.
        min_contrast: least contrast, grey levels.
        limits: greatest asymmetry and difference of the centre from the mid level, both over the
            contrast, and least angle between the edges, rad.

    Returns:
        Which points passed (n,), and for those that did the angles A, B and the contrast (n, 3).
    """
    passed, rings = np.zeros(len(uv), dtype=np.bool_), np.zeros((len(uv), 3))
    for circle in circles:
        rest = np.flatnonzero(~passed)
        passed[rest], rings[rest] = _check_circle(smooth, uv[rest], circle, min_contrast, limits)
    return passed, rings


def _check_circle(
    smooth: GreyImage,
    uv: Array,
    circle: Array,
    min_contrast: float,
    limits: tuple[float, float, float],
) -> tuple[BoolArray, Array]:
    """Test points on one circle (samples, 2): see `_check_circles`."""
    max_asymmetry, max_off_middle, min_angle = limits
    values = sample_image(smooth, uv[:, None] + circle)
    near, far = values[:, : _SAMPLES // 2], values[:, _SAMPLES // 2 :]
    half = (near + far) / 2
    low, high = half.min(axis=1), half.max(axis=1)
    contrast = high - low
    asymmetry = np.sqrt(np.mean((near - far) ** 2, axis=1))
    centre = sample_image(smooth, uv)
    middle = (low + high) / 2
    level = half - middle[:, None]
    after = np.roll(level, -1, axis=1)
    falls, rises = (level > 0) & (after <= 0), (level <= 0) & (after > 0)
    edges = np.stack(
        [_interpolate_angle(level, after, falls), _interpolate_angle(level, after, rises)], axis=1
    )
    edges[:, 1] += np.pi * (edges[:, 1] < edges[:, 0])
    angle = edges[:, 1] - edges[:, 0]
    passed = (
        (np.sum(falls, axis=1) == 1)
        & (contrast > min_contrast)
        & (asymmetry < max_asymmetry * contrast)
        & (abs(centre - middle) < max_off_middle * contrast)
        & (angle > min_angle)
        & (angle < np.pi - min_angle)
    )
    return passed, np.column_stack([edges, contrast])


def _interpolate_angle(level: Array, after: Array, where: BoolArray) -> Array:
    """Return (n,) angles in [0, pi) at which rows cross zero, between a marked sample and the
    next one.

    Args:
        level: (n, samples) grey levels less the mid level.
        after: (n, samples) levels of the next samples.
        where: (n, samples) mark of the sample before the crossing.
    """
    k = np.argmax(where, axis=1)
    row = np.arange(len(level))
    a, b = level[row, k], after[row, k]
    step = np.divide(a, a - b, out=np.zeros_like(a), where=a != b)
    return np.asarray((k + step) * 2 * np.pi / _SAMPLES)

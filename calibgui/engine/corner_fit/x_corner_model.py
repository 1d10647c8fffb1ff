"""The model of two blurred edges that cross, at many corners at once, and its normal equations.

Around a corner c the grey level is modelled by

    I(q) = m + gm.q + p (a + ga.q) G(d_1, d_2),

with q from c, G the blurred pattern of two crossing edges (``edge_intensity``), p = -1 where the
square (+, +) is dark and 1 where it is bright. Edge 1 runs along the row of corners, edge 2 along
the column; with its unit tangent t_i, its normal n_i towards the next row or column, its curvature
kappa_i and what that changes by along it, kappa_i', the distance of q from edge i is

    d_i = n_i.q - kappa_i (t_i.q)^2 / 2 - kappa_i' (t_i.q)^3 / 6.

The last term is small, and of no matter to c, but by way of m it would turn the edges.

Only pixels near the edges hold information on c, so only those within 2.3 blurs + 0.7 px of an edge
and half a square along it are read: the support of the edges (`EdgeSupport`). An edge that runs
more along u than v crosses each pixel column once: the pixels of its band are, column by column,
those around the row where it passes. (Else with u and v exchanged.) This gives rectangular arrays,
the same for all corners, of little more than the band itself; what lies outside the band or the
image, or in the band of the other edge before, is masked. So is the outermost line of pixels on
each side of the image, which cameras and programs that resample often leave dark or half filled.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.arrays import (
    Array,
    BoolArray,
    FloatImage,
    GreyImage,
    IntArray,
    compute_median,
)
from calibgui.engine.features.edge_intensity import (
    CrossingIntensity,
    Floats,
    Pair,
    compute_crossing,
    compute_spread_crossing,
)

_MAX_PIXELS_AT_ONCE = 16_000
"""Number of pixels fitted at once: what the processor's cache holds."""
MIN_BLUR = 0.3
"""Least blur, px: that of the pixel alone is 0.29."""
MAX_SHARP_BLUR = 0.6
"""Median blur below which the pixel's own shape matters, px."""
_BAND_BLURS, _BAND_MARGIN = 2.3, 0.7
"""Half width of an edge's band: blurs, and px in addition."""
_ENOUGH_PIXELS = 4096
"""Number of pixels that tell a corner's noise to 2 %."""
C, THETA, BLUR = np.s_[:, 0:2], np.s_[:, 2:4], np.s_[:, 4:6]
M, A, RHO, LIGHT = np.s_[:, 6], np.s_[:, 7], np.s_[:, 8], np.s_[:, 6:8]
"""Columns of the unknowns."""
UNKNOWNS = 9
"""Number of unknowns of a corner."""


@dataclass(frozen=True, eq=False, slots=True)
class EdgeSupport:
    """The bands of pixels to read along the two edges of n corners."""

    uv: Array
    """(n, 2) the corners, px."""
    tangent: Array
    """(n, 2, 2) unit tangents of edges 1 and 2."""
    normal: Array
    """(n, 2, 2) their unit normals."""
    curvature: Array
    """(n, 2) 1/px."""
    arm: Array
    """(n, 2) reach along the edges to both sides, px."""
    width: Array
    """(n, 2) reach across the edges to both sides, px."""

    def count_pixels(self, edge: int) -> int:
        """Count the pixels read per corner along an edge, masked ones included."""
        length, breadth = self._measure_extent(edge)
        return length * breadth

    def pack(self) -> Array:
        """Pack the bands (n, 2, 7): of each edge tangent, normal, curvature, arm and width."""
        lengths = np.stack([self.curvature, self.arm, self.width], axis=2)
        return np.concatenate([self.tangent, self.normal, lengths], axis=2)

    def read(self, image: GreyImage) -> tuple[IntArray, FloatImage, FloatImage]:
        """Read the bands in an image (h, w).

        Returns:
            Pixels (n, P, 2) as (u, v), their grey levels (n, P), and weights (n, P): 1 for pixels
            of the bands, 0 for the masked ones.
        """
        uv = np.concatenate([self._list_pixels(0), self._list_pixels(1)], axis=1)
        q = (uv - self.uv[:, None]).astype(np.float32)
        first = self.count_pixels(0)
        counts = self._contains(0, q)
        counts[:, first:] = ~counts[:, first:] & self._contains(1, q[:, first:])
        last = np.array(image.shape[::-1]) - 1
        inside = np.clip(uv, 1, last - 1)
        counts &= (inside == uv).all(axis=2)
        grey = image[inside[..., 1], inside[..., 0]].astype(np.float32)
        return uv, grey, counts.astype(np.float32)

    def _contains(self, edge: int, q: FloatImage) -> BoolArray:
        """Return which offsets `q` (n, k, 2) from the corner lie in the band of an edge."""
        frame = np.stack([self.tangent[:, edge], self.normal[:, edge]], axis=2)
        along = q @ frame.astype(np.float32)
        s, d = along[..., 0], along[..., 1]
        half = (self.curvature[:, edge, None] / 2).astype(np.float32)
        near = abs(d - half * s * s) <= self.width[:, edge, None].astype(np.float32)
        return np.asarray(near & (abs(s) <= self.arm[:, edge, None].astype(np.float32)))

    def _list_pixels(self, edge: int) -> IntArray:
        """List the pixels (n, k, 2) in and around the band of an edge, line by line across it."""
        length, breadth = self._measure_extent(edge)
        tangent = self.tangent[:, edge]
        flat = abs(tangent[:, 0]) >= abs(tangent[:, 1])
        main = np.where(flat, 0, 1)
        row = np.arange(len(main))
        start = np.rint(self.uv[row, main])
        x = start[:, None] + np.arange(length) - length // 2
        dx = x - self.uv[row, main][:, None]
        slope = tangent[row, 1 - main] / tangent[row, main]
        bend = (
            self.curvature[:, edge] * self.normal[:, edge][row, 1 - main] / tangent[row, main] ** 2
        )
        y = self.uv[row, 1 - main][:, None] + slope[:, None] * dx + bend[:, None] / 2 * dx * dx
        lines = np.rint(y)[:, :, None] + np.arange(breadth) - breadth // 2
        columns = np.broadcast_to(x[:, :, None], lines.shape)
        is_flat = flat[:, None, None]
        uv = np.stack(
            [np.where(is_flat, columns, lines), np.where(is_flat, lines, columns)], axis=-1
        )
        return uv.reshape(len(main), -1, 2).astype(np.int64)

    def bound_reach(self) -> int:
        """Bound the distance of pixels from their corner, px."""
        sagitta = abs(self.curvature) / 2 * self.arm**2
        return int(np.ceil((self.arm + self.width + sagitta).max())) + 1

    def _measure_extent(self, edge: int) -> tuple[int, int]:
        """Measure the number of lines along, and of pixels across, the largest band of an edge."""
        slant = np.max(abs(self.tangent[:, edge]), axis=1)
        along = np.max(self.arm[:, edge] * slant + self.width[:, edge])
        across = np.max(self.width[:, edge] / slant)
        return 2 * int(np.ceil(along)) + 1, 2 * int(np.ceil(across + 0.5)) + 1


@dataclass(frozen=True, eq=False, slots=True)
class XCornerModel:
    """The model at n corners."""

    unknowns: Array
    """(n, 9) c (2) px, directions of t_1 and t_2 rad, blurs s_1 and s_2 px, m and a grey levels,
    rho."""
    sign: Array
    """(n,) p."""
    square_height: Array
    """(n, 2) height of a square over edge 1 and over edge 2, px."""
    arm: Array
    """(n, 2) how far edges 1 and 2 are read to both sides, px."""
    plain_width: Array
    """(n, 2) how far across them the squares are of one colour, px."""
    curvature: Array
    """(n, 2) kappa_1, kappa_2, 1/px."""
    curvature_change: Array
    """(n, 2) kappa_1', kappa_2', 1/px^2."""
    ink_spread: Array
    """(n,) w, growth of the dark squares on every side, over the height of a square."""
    level_gradient: Array
    """(n, 2) gm, grey levels per px."""
    contrast_gradient: Array
    """(n, 2) ga, grey levels per px."""
    blur_gradient: Array
    """(n, 2, 2) gradients of s_1 and s_2, px per px."""
    height_gradient: Array
    """(n, 2, 2) gradients of the squares' heights as they count for the spread, px per px."""

    def select(self, index: IntArray) -> XCornerModel:
        """Select the model at the corners `index` (k,)."""
        return XCornerModel(*(getattr(self, field.name)[index] for field in fields(self)))

    def tangents(self) -> Array:
        """Compute (n, 2, 2) t_1 and t_2."""
        angle = self.unknowns[THETA]
        t = np.empty((len(angle), 2, 2))
        np.cos(angle, out=t[..., 0])
        np.sin(angle, out=t[..., 1])
        return t

    def normals(self) -> Array:
        """Compute (n, 2, 2) n_1 towards the next row and n_2 towards the next column."""
        return compute_normals(self.unknowns[THETA])

    def pixel_half_widths(self) -> Array | None:
        """Compute the half widths (n, 2) px of a pixel across edges 1 and 2; None if the blur is so
        large that its shape does not matter."""
        return np.asarray(abs(self.normals()).max(axis=2) / 2) if self.is_sharp() else None

    def is_sharp(self) -> bool:
        """Return whether the blur is so small that the pixel's shape matters."""
        return bool(compute_median(self.unknowns[BLUR].ravel()) < MAX_SHARP_BLUR)

    def compute_band_widths(self) -> Array:
        """Compute how far (n, 2) px the bands of edges 1 and 2 reach across them to both sides."""
        grown = abs(self.ink_spread)[:, None] * self.square_height
        width = _BAND_BLURS * self.unknowns[BLUR] + _BAND_MARGIN + grown
        return np.minimum(width, self.plain_width)

    def find_support(self) -> EdgeSupport:
        """Find the pixels to read."""
        return EdgeSupport(
            self.unknowns[C],
            self.tangents(),
            self.normals(),
            self.curvature,
            self.arm,
            self.compute_band_widths(),
        )


def compute_normals(theta: Array) -> Array:
    """Compute the normals (n, 2, 2) of edges of the directions `theta` (n, 2), as
    `XCornerModel.normals`."""
    cosine, sine = np.cos(theta), np.sin(theta)
    n = np.empty((len(theta), 2, 2))
    n[:, 0, 0], n[:, 0, 1] = -sine[:, 0], cosine[:, 0]
    n[:, 1, 0], n[:, 1, 1] = sine[:, 1], -cosine[:, 1]
    return n


@dataclass(frozen=True, eq=False, slots=True)
class _Window:
    """The pixels read around k corners."""

    pixels: IntArray
    """(k, P, 2) u, v."""
    grey: FloatImage
    """(k, P)"""
    counts: FloatImage
    """(k, P) 1 for pixels of the bands, 0 for others."""


@kernels.with_kernel("x_corner_model", "accumulate_normal_equations")
def accumulate_normal_equations(
    image: GreyImage, model: XCornerModel, odd: bool
) -> tuple[Array, Array]:
    """Accumulate the products of the columns [J r]: derivatives of the model by the unknowns, and
    the residual, what the model leaves unexplained.

    The pixels are read a few corners at a time and not kept: those of a board may take many times
    the memory of the image.

    Args:
        image: (h, w) grey levels.
        model: the model, whose own support is read.
        odd: whether the odd part of r is wanted too, and the columns of the derivatives by gm and
            ga, which follow r.

    Returns:
        (n, 10, 10), or (n, 14, 14), the products of each corner, and (n, 2) the sum of
        (r(q) - r(-q))^2 / 2 over pairs of pixels and their number, or (0, 2).
    """
    n, columns = len(model.unknowns), UNKNOWNS + (5 if odd else 1)
    N, differences = np.empty((n, columns, columns)), np.empty((n if odd else 0, 2))
    for index in _divide_corners(model):
        portion = model.select(index)
        window = _Window(*portion.find_support().read(image))
        J = _compute_columns(portion, window)
        if odd:
            differences[index] = _measure_odd_part(portion.unknowns[C], window, J[:, UNKNOWNS])
            J = np.concatenate([J, _compute_light_columns(portion, window, J)], axis=1)
        N[index] = J @ J.transpose(0, 2, 1)
    return N, differences


@kernels.with_kernel("x_corner_model", "accumulate_scores")
def accumulate_scores(image: GreyImage, model: XCornerModel) -> Array:
    """Accumulate what the lines of pixels across each edge say of its place.

    Each pixel pulls at edge i by its score, the residual times the derivative dI/dd_i. Lines of
    pixels run along u or v, whichever is more across the edge, and those that lie opposite each
    other about the corner, to the nearest half pixel, are taken together: what is even under
    point reflection, as a wrong shape of the blur, cancels.

    Args:
        image: (h, w) grey levels.
        model: the model at n corners, whose own support is read.

    Returns:
        (n, 2, 2, k) by edge: the sums of the scores, grey levels^2 per px, and those of the squares
        of dI/dd_i, which are their variances over that of independent noise; the lines in their
        order from the corner.
    """
    sums = np.zeros((len(model.unknowns), 2, 2, model.find_support().bound_reach() + 1))
    for index in _divide_corners(model):
        portion = model.select(index)
        window = _Window(*portion.find_support().read(image))
        J = _compute_columns(portion, window)
        normals, tangents = portion.normals(), portion.tangents()
        slopes = np.linalg.solve(normals.transpose(0, 2, 1), -J[:, C[1]])
        axis = np.argmax(abs(tangents), axis=2)
        middle = np.rint(2 * portion.unknowns[C]).astype(np.int64)
        line = abs(2 * window.pixels - middle[:, None]) // 2 * (window.counts > 0)[..., None]
        for i, edge in np.ndindex(len(index), 2):
            at, slope = line[i, :, axis[i, edge]], slopes[i, edge]
            np.add.at(sums[index[i], edge, 0], at, slope * J[i, UNKNOWNS])
            np.add.at(sums[index[i], edge, 1], at, slope**2)
    return sums


def _divide_corners(model: XCornerModel) -> list[IntArray]:
    """Divide the corners into portions whose bands are of about one size."""
    order = np.argsort(model.arm.sum(axis=1), kind="stable")
    largest = model.select(order[-1:]).find_support()
    total = len(order) * (largest.count_pixels(0) + largest.count_pixels(1))
    return np.array_split(order, np.clip(total // _MAX_PIXELS_AT_ONCE, 1, len(order)))


def _compute_columns(model: XCornerModel, window: _Window) -> Floats:
    """Compute the derivatives of the model by the unknowns, and the residual, (k, 10, P) in a
    window; 0 for pixels that do not count."""
    x, grey, counts = model.unknowns, window.grey, window.counts
    q = (window.pixels - x[C][:, None]).astype(np.float32)
    normals = model.normals().astype(np.float32)
    s1, s2 = _project(q, model.tangents())
    d1, d2 = _project(q, normals)
    kappa = (model.curvature / 2).astype(np.float32)
    change = (model.curvature_change / 6).astype(np.float32)
    d1 -= (kappa[:, :1] + change[:, :1] * s1) * s1 * s1
    d2 -= (kappa[:, 1:] + change[:, 1:] * s2) * s2 * s2
    sign = model.sign[:, None].astype(np.float32)
    G = _compute_intensity(model, q, (d1, d2))
    swing = sign * _extrapolate(x[A], model.contrast_gradient, q)
    level = _extrapolate(x[M], model.level_gradient, q)
    residual = (grey - level - swing * G.value) * counts
    swing = swing * counts
    by1, by2 = swing * G.by_distance[0], swing * G.by_distance[1]
    J = np.empty((len(x), UNKNOWNS + 1, grey.shape[1]), dtype=np.float32)
    for axis in (0, 1):
        J[:, axis] = -by1 * normals[:, :1, axis] - by2 * normals[:, 1:, axis]
    J[:, 2] = -by1 * s1  # t_1 turns n_1 away from itself,
    J[:, 3] = by2 * s2  # and n_2 towards it
    J[:, 4] = swing * G.by_blur[0]
    J[:, 5] = swing * G.by_blur[1]
    J[:, 6] = counts
    J[:, 7] = sign * counts * G.value
    J[:, 8] = swing * G.by_correlation
    J[:, 9] = residual
    return J


def _compute_light_columns(model: XCornerModel, window: _Window, columns: Floats) -> Floats:
    """Compute the derivatives (k, 4, P) of the model by gm and ga, from the other `columns`."""
    q = (window.pixels - model.unknowns[C][:, None]).astype(np.float32).transpose(0, 2, 1)
    return np.concatenate([q * columns[:, 6:7], q * columns[:, 7:8]], axis=1)


def _measure_odd_part(centre: Array, window: _Window, residual: Floats) -> Array:
    """Measure the odd part of the residual: (k, 2) the sum of (r(q) - r(-q))^2 / 2 over the pairs
    of pixels that lie opposite each other to the nearest half pixel, and their number. Of more
    pixels than tell the noise well, those on each 2nd, 4th, 8th... diagonal are compared."""
    k, side = len(centre), int(np.ptp(window.pixels, axis=1).max()) + 1
    row, counts = np.arange(k)[:, None], window.counts > 0
    corner = window.pixels.min(axis=1)[:, None]
    u, v = np.moveaxis(window.pixels - corner, 2, 0)
    square = np.full((k, side, side), np.nan)
    twice = np.rint(2 * centre).astype(np.int64)[:, None]
    excess = np.maximum(counts.sum(axis=1) / _ENOUGH_PIXELS, 1)
    every = 2 ** np.ceil(np.log2(excess)).astype(np.int64)
    diagonal = abs((2 * window.pixels - twice).sum(axis=2)) // 2  # the same for opposite ones
    counts &= diagonal % every[:, None] == 0
    square[np.broadcast_to(row, counts.shape)[counts], v[counts], u[counts]] = residual[counts]
    mirror = twice - window.pixels
    far = ((mirror < corner) | (mirror >= corner + side)).any(axis=2)
    mu, mv = np.moveaxis(np.clip(mirror - corner, 0, side - 1), 2, 0)
    difference = residual - square[row, mv, mu]
    apart = (mirror != window.pixels).any(axis=2)
    paired = counts & apart & ~far & np.isfinite(difference)
    both = np.stack([np.where(paired, difference**2 / 2, 0.0), paired], axis=2)
    return np.asarray(both.sum(axis=1) / 2)  # each pair was met twice


def _compute_intensity(model: XCornerModel, q: FloatImage, d: Pair) -> CrossingIntensity:
    """Compute G at the offsets `q` (n, P, 2) and the distances `d` from the corners' edges."""
    x = model.unknowns
    s1, s2 = (
        np.maximum(_extrapolate(x[BLUR][:, i], model.blur_gradient[:, i], q), MIN_BLUR)
        for i in (0, 1)
    )
    rho = x[RHO][:, None].astype(np.float32)
    half = model.pixel_half_widths()
    box = None
    if half is not None:
        h1, h2 = half.astype(np.float32).T[..., None]
        box = (h1, h2)
    if not model.ink_spread.any():
        return compute_crossing(d, (s1, s2), rho, box)
    growth = (model.sign * model.ink_spread)[:, None].astype(np.float32)
    w1, w2 = (
        growth * _extrapolate(model.square_height[:, i], model.height_gradient[:, i], q)
        for i in (0, 1)
    )
    return compute_spread_crossing(d, (s1, s2), rho, box, (w1, w2))


def _project(q: FloatImage, directions: Floats) -> tuple[FloatImage, FloatImage]:
    """Compute coordinates (n, P) of `q` (n, P, 2) along two directions (n, 2, 2)."""
    both = directions.astype(np.float32) @ q.transpose(0, 2, 1)
    return both[:, 0], both[:, 1]


def _extrapolate(value: Array, gradient: Array, q: FloatImage) -> FloatImage:
    """Compute `value` (n,) + `gradient` (n, 2) . q at `q` (n, P, 2); (n, 1) if it does not vary."""
    constant = value[:, None].astype(np.float32)
    if not gradient.any():
        return constant
    return constant + (q @ gradient[..., None].astype(np.float32))[..., 0]

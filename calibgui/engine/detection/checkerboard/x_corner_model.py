"""The model of two blurred edges that cross, at many corners at once, and its derivatives.

Around a corner c the grey level is modelled by

    I(q) = m + gm.q + p (a + ga.q) G(d_1, d_2),

with q from c, G the blurred pattern of two crossing edges (`pattern`), p = -1 where the square
(+, +) is dark and 1 where it is bright. Edge 1 runs along the row of corners, edge 2 along the
column; with its unit tangent t_i, its normal n_i towards the next row or column and its curvature
kappa_i, the distance of q from edge i is

    d_i = n_i.q - kappa_i (t_i.q)^2 / 2.

Only pixels near the edges know about c, so only those within 2.3 blurs + 0.7 px of an edge and
half a square along it are read. ``kernels.edges`` computes the same, compiled.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, GreyImage, IntArray
from calibgui.engine.arrays import FloatImage as Array32
from calibgui.engine.detection.checkerboard.edge_support import Bands
from calibgui.engine.detection.edge_intensity import Floats, Pair, Pattern, meeting, spread

_CHUNK = 16_000
"""Pixels fitted at once: what the processor's cache holds."""
SHARPEST = 0.3
"""Least blur, px: that of the pixel alone is 0.29."""
_SHARP = 0.6
"""Median blur below which the pixel's own shape matters, px."""
C, THETA, BLUR = np.s_[:, 0:2], np.s_[:, 2:4], np.s_[:, 4:6]
M, A, RHO = np.s_[:, 6], np.s_[:, 7], np.s_[:, 8]
"""Columns of the unknowns."""
UNKNOWNS = 9


@dataclass(frozen=True, eq=False, slots=True)
class Edges:
    """The model at n corners."""

    unknowns: Array
    """(n, 9) c (2) px, directions of t_1 and t_2 rad, blurs s_1 and s_2 px, m and a grey levels,
    rho."""
    sign: Array
    """(n,) p."""
    size: Array
    """(n, 2) height of a square over edge 1 and over edge 2, px."""
    arm: Array
    """(n, 2) how far edges 1 and 2 are read to both sides, px."""
    room: Array
    """(n, 2) how far across them the squares are of one colour, px."""
    curvature: Array
    """(n, 2) kappa_1, kappa_2, 1/px."""
    spread: Array
    """(n,) w, growth of the dark squares, over the size of a square."""
    level_gradient: Array
    """(n, 2) gm, grey levels per px."""
    contrast_gradient: Array
    """(n, 2) ga, grey levels per px."""
    blur_gradient: Array
    """(n, 2, 2) of s_1 and s_2, px per px."""
    size_gradient: Array
    """(n, 2, 2) of the squares' heights as they count for the spread, px per px."""

    def under(self, index: IntArray) -> Edges:
        """The model at some of the corners."""
        return Edges(*(getattr(self, field.name)[index] for field in fields(self)))

    def tangents(self) -> Array:
        """(n, 2, 2) t_1, t_2."""
        angle = self.unknowns[THETA]
        return np.stack([np.cos(angle), np.sin(angle)], axis=2)

    def normals(self) -> Array:
        """(n, 2, 2) n_1 towards the next row, n_2 towards the next column."""
        t = self.tangents()
        return np.stack([-t[..., 1], t[..., 0]], axis=2) * np.array([[1.0], [-1.0]])

    def box(self) -> Array | None:
        """(n, 2) half widths of a pixel across edges 1 and 2, px; None where the blur hides it."""
        if np.median(self.unknowns[BLUR]) >= _SHARP:
            return None
        return np.asarray(abs(self.normals()).max(axis=2) / 2)

    def bands(self) -> Bands:
        """The pixels to read."""
        grown = abs(self.spread)[:, None] * self.size
        width = np.minimum(2.3 * self.unknowns[BLUR] + 0.7 + grown, self.room)
        return Bands(
            self.unknowns[C], self.tangents(), self.normals(), self.curvature, self.arm, width
        )


@dataclass(frozen=True, eq=False, slots=True)
class _Window:
    """The pixels read around k corners."""

    pixels: IntArray
    """(k, P, 2) u, v."""
    grey: Array32
    """(k, P)"""
    counts: Array32
    """(k, P) 1 for pixels of the bands, 0 for others."""


def normal_equations(
    image: GreyImage, read: Edges, edges: Edges, odd: bool = False
) -> tuple[Array, Array]:
    """Products of the columns [J r]: derivatives of the model by the unknowns, and what it leaves
    unexplained.

    The pixels are read a few corners at a time and not kept: those of a board may take many times
    the memory of the image.

    Args:
        image: (h, w) grey levels.
        read: the model whose bands are read, near `edges`.
        edges: the model.
        odd: whether the odd part of r is wanted too.

    Returns:
        (n, 10, 10) the products of each corner, and (n, 2) the sum of (r(q) - r(-q))^2 / 2 over
        pairs of pixels and their number, or (0, 2).
    """
    if kernels.COMPILED:
        return _compiled(image, read, edges, odd)
    n = len(edges.unknowns)
    N, differences = np.empty((n, UNKNOWNS + 1, UNKNOWNS + 1)), np.empty((n if odd else 0, 2))
    for index in _portions(read):
        model, window = edges.under(index), _Window(*read.under(index).bands().read(image))
        J = _columns(model, window)
        N[index] = J @ J.transpose(0, 2, 1)
        if odd:
            differences[index] = _odd_part(model.unknowns[C], window, J[:, UNKNOWNS])
    return N, differences


def _compiled(image: GreyImage, read: Edges, edges: Edges, odd: bool) -> tuple[Array, Array]:
    """`normal_equations` by the compiled kernel."""
    from calibgui.engine.kernels import x_corner_fit as kernel

    x, n = edges.unknowns, len(edges.unknowns)
    near = np.column_stack(
        [
            edges.tangents().reshape(n, 4),
            edges.normals().reshape(n, 4),
            edges.curvature / 2,
            x[BLUR],
            edges.blur_gradient.reshape(n, 4),
            edges.size,
            edges.size_gradient.reshape(n, 4),
            x[M],
            edges.level_gradient,
            x[A],
            edges.contrast_gradient,
            x[RHO],
            edges.sign,
            edges.sign * edges.spread,
            np.zeros((n, 2)) if (box := edges.box()) is None else box,
        ]
    )
    bands = read.bands()
    lengths = np.stack([bands.curvature, bands.arm, bands.width], axis=2)
    packed = np.concatenate([bands.tangent, bands.normal, lengths], axis=2)
    uv, centre = (np.ascontiguousarray(model.unknowns[C]) for model in (read, edges))
    return kernel.products(image, uv, packed, centre, near, odd)


def _portions(read: Edges) -> list[IntArray]:
    """Corners whose bands are of about one size."""
    order = np.argsort(read.arm.sum(axis=1), kind="stable")
    largest = read.under(order[-1:]).bands()
    total = len(order) * (largest.pixels(0) + largest.pixels(1))
    return np.array_split(order, max(total // _CHUNK, 1))


def _columns(edges: Edges, window: _Window) -> Floats:
    """(k, 10, P) derivatives of the model by the unknowns and the grey levels not explained in a
    window of `edges`; 0 for pixels that do not count."""
    x, grey, counts = edges.unknowns, window.grey, window.counts
    q = (window.pixels - x[C][:, None]).astype(np.float32)
    normals = edges.normals().astype(np.float32)
    s1, s2 = _along(q, edges.tangents())
    d1, d2 = _along(q, normals)
    kappa = (edges.curvature / 2).astype(np.float32)
    d1 -= kappa[:, :1] * s1 * s1
    d2 -= kappa[:, 1:] * s2 * s2
    sign = edges.sign[:, None].astype(np.float32)
    G = _pattern(edges, q, (d1, d2))
    swing = sign * _linear(x[A], edges.contrast_gradient, q)
    level = _linear(x[M], edges.level_gradient, q)
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


def _odd_part(centre: Array, window: _Window, residual: Floats) -> Array:
    """(k, 2) sum of (r(q) - r(-q))^2 / 2 over the pairs of pixels that lie opposite each other
    to the nearest half pixel, and their number."""
    k, side = len(centre), int(np.ptp(window.pixels, axis=1).max()) + 1
    row, counts = np.arange(k)[:, None], window.counts > 0
    corner = window.pixels.min(axis=1)[:, None]
    u, v = np.moveaxis(window.pixels - corner, 2, 0)
    square = np.full((k, side, side), np.nan)
    square[np.broadcast_to(row, counts.shape)[counts], v[counts], u[counts]] = residual[counts]
    mirror = np.rint(2 * centre).astype(np.int64)[:, None] - window.pixels
    far = ((mirror < corner) | (mirror >= corner + side)).any(axis=2)
    mu, mv = np.moveaxis(np.clip(mirror - corner, 0, side - 1), 2, 0)
    difference = residual - square[row, mv, mu]
    apart = (mirror != window.pixels).any(axis=2)
    paired = counts & apart & ~far & np.isfinite(difference)
    both = np.stack([np.where(paired, difference**2 / 2, 0.0), paired], axis=2)
    return np.asarray(both.sum(axis=1) / 2)  # each pair was met twice


def _pattern(edges: Edges, q: Array32, d: Pair) -> Pattern:
    """G at the offsets `q` (n, P, 2) from the corners."""
    x = edges.unknowns
    s1, s2 = (
        np.maximum(_linear(x[BLUR][:, i], edges.blur_gradient[:, i], q), SHARPEST) for i in (0, 1)
    )
    rho = x[RHO][:, None].astype(np.float32)
    half = edges.box()
    box = None
    if half is not None:
        h1, h2 = half.astype(np.float32).T[..., None]
        box = (h1, h2)
    if not edges.spread.any():
        return meeting(d, (s1, s2), rho, box)
    growth = (edges.sign * edges.spread)[:, None].astype(np.float32)
    w1, w2 = (growth * _linear(edges.size[:, i], edges.size_gradient[:, i], q) for i in (0, 1))
    return spread(d, (s1, s2), rho, box, (w1, w2))


def _along(q: Array32, directions: Floats) -> tuple[Array32, Array32]:
    """Coordinates (n, P) of `q` (n, P, 2) along two directions (n, 2, 2)."""
    both = directions.astype(np.float32) @ q.transpose(0, 2, 1)
    return both[:, 0], both[:, 1]


def _linear(value: Array, gradient: Array, q: Array32) -> Array32:
    """`value` (n,) + `gradient` (n, 2) . q at `q` (n, P, 2), or (n, 1) where it does not vary."""
    constant = value[:, None].astype(np.float32)
    if not gradient.any():
        return constant
    return constant + (q @ gradient[..., None].astype(np.float32))[..., 0]

"""Corners at the physical limit: the two blurred edges fitted to the pixels.

Around a corner c the grey level is modelled by

    I(q) = m + gm.q + p (a + ga.q) G(d_1, d_2),

with q from c, G the blurred pattern of two crossing edges (`pattern`), p = -1 where the square
(+, +) is dark and 1 where it is bright. Edge 1 runs along the row of corners, edge 2 along the
column; with its unit tangent t_i, its normal n_i towards the next row or column and its curvature
kappa_i, the distance of q from edge i is

    d_i = n_i.q - kappa_i (t_i.q)^2 / 2.

The unknowns c, the edges' directions and blurs, m and a are found by Gauss-Newton steps, all
corners at once. Under point reflection about c the derivatives by c are odd, those by all other
unknowns even: they decouple, and the covariance of c is what it would be if the rest were known,
the Cramer-Rao bound

    cov c = noise^2 (sum of (grad I)(grad I)^T)^-1.

What is odd too and would not decouple - curvature and the light's gradients gm, ga - comes from
the whole board (`surroundings`), as does the spread w of the ink. Only pixels near the edges know
about c, so only those within 2.3 blurs + 0.7 px of an edge and half a square along it are read.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

from calibgui.engine.corners import profiles, surroundings
from calibgui.engine.corners.bands import Bands
from calibgui.engine.corners.lattice import Lattice, axes
from calibgui.engine.corners.pattern import Floats, Pair, Pattern, meeting, spread
from calibgui.engine.opencv import Image
from calibgui.engine.opencv import Image32 as Array32
from calibgui.engine.types import Array, IntArray

_CHUNK = 16_000
"""Pixels fitted at once: what the processor's cache holds."""
_LONGEST = 18.0
"""Longest arm that is read on a board of many corners, px."""
_ARMS = 4000.0
"""Sum of the longest arms of a board's corners, px: fewer corners may have longer ones."""
_NEAR = 9.0
"""Arm that is read for a first approximation, px."""
_SHARPEST = 0.3
"""Least blur, px: that of the pixel alone is 0.29."""
_SHARP = 0.6
"""Median blur below which the pixel's own shape matters, px."""
_LEAST_SPREAD, _MOST_SPREAD = 0.002, 0.2
"""Spreads that are told from none and that are believed, squares."""
_MOST_RHO = 0.95
_C, _THETA, _BLUR = np.s_[:, 0:2], np.s_[:, 2:4], np.s_[:, 4:6]
_M, _A, _RHO = np.s_[:, 6], np.s_[:, 7], np.s_[:, 8]
"""Columns of the unknowns."""
_UNKNOWNS = 9


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
    """(n, 2, 2) of the squares' heights, px per px."""

    def under(self, index: IntArray) -> Edges:
        """The model at some of the corners."""
        return Edges(*(getattr(self, field.name)[index] for field in fields(self)))

    def tangents(self) -> Array:
        """(n, 2, 2) t_1, t_2."""
        angle = self.unknowns[_THETA]
        return np.stack([np.cos(angle), np.sin(angle)], axis=2)

    def normals(self) -> Array:
        """(n, 2, 2) n_1 towards the next row, n_2 towards the next column."""
        t = self.tangents()
        return np.stack([-t[..., 1], t[..., 0]], axis=2) * np.array([[1.0], [-1.0]])

    def bands(self) -> Bands:
        """The pixels to read."""
        grown = abs(self.spread)[:, None] * self.size
        width = np.minimum(2.3 * self.unknowns[_BLUR] + 0.7 + grown, self.size / 2)
        return Bands(
            self.unknowns[_C], self.tangents(), self.normals(), self.curvature, self.arm, width
        )


@dataclass(frozen=True, eq=False, slots=True)
class Fit:
    """The edge model fitted at n corners."""

    edges: Edges
    covariance: Array
    """(n, 2, 2) of c, px^2."""
    residual: Array
    """(n,) standard deviation of what the model leaves unexplained, grey levels."""

    @property
    def uv(self) -> Array:
        """(n, 2) the corners, px."""
        return self.edges.unknowns[_C]

    @property
    def blur(self) -> Array:
        """(n,) root mean square of the edges' blurs, pixel included, px."""
        return np.sqrt(np.mean(self.edges.unknowns[_BLUR] ** 2, axis=1))

    @property
    def contrast(self) -> Array:
        """(n,) bright minus dark, grey levels."""
        return 2 * self.edges.unknowns[_A]


def fit(image: Image, lattice: Lattice) -> Fit:
    """Fit the edge model at every corner of `lattice`, whose positions are the start."""
    edges = _start(image, lattice)
    near = replace(edges, arm=np.minimum(edges.arm, _NEAR))
    first = _step(near, _read(image, near))
    edges = _surrounded(replace(edges, unknowns=first.edges.unknowns), lattice)
    windows = _read(image, edges)
    edges = _surrounded(_step(edges, windows).edges, lattice)
    return _step(edges, windows)


def _start(image: Image, lattice: Lattice) -> Edges:
    """Parameters from the lattice and from profiles across the edges."""
    found = lattice.found
    cells = np.argwhere(found)
    n = len(cells)
    steps = [step[found] for step in axes(lattice.uv)]
    right, down = steps
    length = np.column_stack([np.linalg.norm(step, axis=1) for step in steps])
    area = abs(right[:, 0] * down[:, 1] - right[:, 1] * down[:, 0])
    unknowns = np.zeros((n, _UNKNOWNS))
    unknowns[_C] = lattice.uv[found]
    unknowns[_THETA] = np.column_stack([np.arctan2(step[:, 1], step[:, 0]) for step in steps])
    edges = Edges(
        unknowns=unknowns,
        sign=np.where(lattice.dark ^ (cells.sum(axis=1) % 2 == 1), -1.0, 1.0),
        size=area[:, None] / length,
        arm=np.minimum(length / 2, max(_LONGEST, _ARMS / n)),
        curvature=surroundings.curvatures(lattice),
        spread=np.zeros(n),
        level_gradient=np.zeros((n, 2)),
        contrast_gradient=np.zeros((n, 2)),
        blur_gradient=np.zeros((n, 2, 2)),
        size_gradient=np.zeros((n, 2, 2)),
    )
    normals = edges.normals()
    seen = [
        profiles.across_edge(
            image, edges.unknowns[_C], steps[i], steps[1 - i], edges.size[:, i], edges.sign
        )
        for i in (0, 1)
    ]
    low, high = (
        np.mean([getattr(side, name) for side in seen], axis=0) for name in ("low", "high")
    )
    blur = np.median([side.blur for side in seen], axis=1)
    unknowns[_BLUR] = np.clip(blur, _SHARPEST, edges.size / 4)
    unknowns[_M], unknowns[_A] = (high + low) / 2, (high - low) / 2
    unknowns[_RHO] = np.sum(normals[:, 0] * normals[:, 1], axis=1)
    return replace(edges, spread=_common_spread(np.column_stack([side.spread for side in seen])))


def _common_spread(seen: Array) -> Array:
    """(n,) the board's spread from what every edge (n, 2) shows, 0 unless it is clear."""
    known = seen[np.isfinite(seen)]
    if len(known) < len(seen):  # fewer than half of the edges
        return np.zeros(len(seen))
    middle = float(np.median(known))
    error = 1.5 * float(np.median(abs(known - middle))) / np.sqrt(len(known) / 2)
    clear = _MOST_SPREAD > abs(middle) > max(3 * error, _LEAST_SPREAD)
    return np.full(len(seen), middle if clear else 0.0)


def _surrounded(edges: Edges, lattice: Lattice) -> Edges:
    """`edges` with curvature and gradients as their positions, levels and blurs now say."""
    uv = lattice.uv.copy()
    uv[lattice.found] = edges.unknowns[_C]
    moved = Lattice(uv, lattice.dark)
    x = edges.unknowns
    known = np.column_stack([x[_M], x[_A], x[_BLUR], edges.size])
    gradients = surroundings.gradients(moved, known)
    return replace(
        edges,
        curvature=surroundings.curvatures(moved),
        level_gradient=gradients[:, 0],
        contrast_gradient=gradients[:, 1],
        blur_gradient=gradients[:, 2:4],
        size_gradient=gradients[:, 4:6],
    )


@dataclass(frozen=True, eq=False, slots=True)
class _Window:
    """The pixels read around some of the corners."""

    index: IntArray
    """(k,) which corners."""
    pixels: IntArray
    """(k, P, 2) u, v."""
    grey: Array32
    """(k, P)"""
    counts: Array32
    """(k, P) 1 for pixels of the bands, 0 for others."""


def _read(image: Image, edges: Edges) -> list[_Window]:
    """The pixels of all corners, in portions of corners of about one size."""
    order = np.argsort(edges.arm.sum(axis=1), kind="stable")
    largest = edges.under(order[-1:]).bands()
    total = len(order) * (largest.pixels(0) + largest.pixels(1))
    portions = np.array_split(order, max(total // _CHUNK, 1))
    return [_Window(part, *edges.under(part).bands().read(image)) for part in portions]


def _step(edges: Edges, windows: list[_Window]) -> Fit:
    """The model after one Gauss-Newton step."""
    n = len(edges.unknowns)
    unknowns = edges.unknowns.copy()
    covariance, residual = np.empty((n, 2, 2)), np.empty(n)
    for window in windows:
        at = window.index
        r, J = _residual(edges.under(at), window)
        N = (J @ J.transpose(0, 2, 1)).astype(np.float64)
        largest = np.einsum("nkk->nk", N).max(axis=1) + 1e-300
        N += 1e-9 * largest[:, None, None] * np.eye(_UNKNOWNS)
        g = (J @ r[..., None]).astype(np.float64)
        step = np.asarray(np.linalg.solve(N, g)[..., 0])
        unknowns[at] += _bounded(step, unknowns[at])
        square = np.maximum(np.sum(r * r, axis=1) - np.sum(step * g[..., 0], axis=1), 0.0)
        square /= np.maximum(window.counts.sum(axis=1) - _UNKNOWNS, 1)
        covariance[at] = square[:, None, None] * np.linalg.inv(N)[:, :2, :2]
        residual[at] = np.sqrt(square)
    return Fit(replace(edges, unknowns=unknowns), covariance, residual)


def _residual(edges: Edges, window: _Window) -> tuple[Floats, Floats]:
    """Grey levels (k, P) not explained in a window of `edges`, and derivatives (k, 9, P) of the
    model by the unknowns; 0 for pixels that do not count."""
    x, grey, counts = edges.unknowns, window.grey, window.counts
    q = (window.pixels - x[_C][:, None]).astype(np.float32)
    normals = edges.normals().astype(np.float32)
    s1, s2 = _along(q, edges.tangents())
    d1, d2 = _along(q, normals)
    kappa = (edges.curvature / 2).astype(np.float32)
    d1 -= kappa[:, :1] * s1 * s1
    d2 -= kappa[:, 1:] * s2 * s2
    sign = edges.sign[:, None].astype(np.float32)
    G = _pattern(edges, q, (d1, d2))
    swing = sign * _linear(x[_A], edges.contrast_gradient, q)
    level = _linear(x[_M], edges.level_gradient, q)
    residual = (grey - level - swing * G.value) * counts
    swing = swing * counts
    by1, by2 = swing * G.by_distance[0], swing * G.by_distance[1]
    J = np.empty((len(x), _UNKNOWNS, grey.shape[1]), dtype=np.float32)
    for axis in (0, 1):
        J[:, axis] = -by1 * normals[:, :1, axis] - by2 * normals[:, 1:, axis]
    J[:, 2] = -by1 * s1  # t_1 turns n_1 away from itself,
    J[:, 3] = by2 * s2  # and n_2 towards it
    J[:, 4] = swing * G.by_blur[0]
    J[:, 5] = swing * G.by_blur[1]
    J[:, 6] = counts
    J[:, 7] = sign * counts * G.value
    J[:, 8] = swing * G.by_correlation
    return residual, J


def _pattern(edges: Edges, q: Array32, d: Pair) -> Pattern:
    """G at the offsets `q` (n, P, 2) from the corners."""
    x = edges.unknowns
    s1, s2 = (
        np.maximum(_linear(x[_BLUR][:, i], edges.blur_gradient[:, i], q), _SHARPEST) for i in (0, 1)
    )
    rho = x[_RHO][:, None].astype(np.float32)
    box = None
    if np.median(x[_BLUR]) < _SHARP:
        h = (abs(edges.normals()).max(axis=2) / 2).astype(np.float32)
        box = (h[:, :1], h[:, 1:])
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


def _bounded(step: Array, x: Array) -> Array:
    """A Gauss-Newton step (n, 9) kept where the linear model may hold."""
    bounded = np.array(step)
    bounded[_C] = np.clip(step[_C], -1.0, 1.0)
    bounded[_THETA] = np.clip(step[_THETA], -0.1, 0.1)
    s, rho = x[_BLUR], x[_RHO]
    bounded[_BLUR] = np.clip(step[_BLUR], np.maximum(-s / 3, _SHARPEST - s), s / 2)
    bounded[_RHO] = np.clip(step[_RHO], -_MOST_RHO - rho, _MOST_RHO - rho)
    return bounded

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
from calibgui.engine.corners.pattern import Pair, Pattern, meeting, spread
from calibgui.engine.opencv import Image
from calibgui.engine.types import Array, IntArray

_CHUNK = 50_000
"""Pixels fitted at once: what the processor's cache holds."""
_LONGEST = 18.0
"""Longest arm that is read, px."""
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
    for steps in (1, 1):
        edges = _surrounded(_solved(image, edges, steps).edges, lattice)
    return _solved(image, edges, 2)


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
        arm=np.minimum(length / 2, _LONGEST),
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


def _solved(image: Image, edges: Edges, steps: int) -> Fit:
    """The model after so many Gauss-Newton steps, in portions of corners of about one size."""
    order = np.argsort(edges.arm.sum(axis=1), kind="stable")
    largest = edges.under(order[-1:]).bands().pixels()
    portions = np.array_split(order, max(len(order) * largest // _CHUNK, 1))
    fits = [_gauss_newton(image, edges.under(portion), steps) for portion in portions]
    back = np.argsort(order)
    return Fit(
        replace(edges, unknowns=np.concatenate([f.edges.unknowns for f in fits])[back]),
        np.concatenate([f.covariance for f in fits])[back],
        np.concatenate([f.residual for f in fits])[back],
    )


def _gauss_newton(image: Image, edges: Edges, steps: int) -> Fit:
    """`steps` Gauss-Newton steps on one set of pixels."""
    pixels, grey, counts = edges.bands().read(image)
    used = counts.sum(axis=1)
    step = np.zeros_like(edges.unknowns)
    for _ in range(steps):
        residual, J = _residual(edges, pixels, grey)
        residual *= counts
        J *= counts[:, None]
        N = J @ J.transpose(0, 2, 1)
        largest = np.einsum("nkk->nk", N).max(axis=1) + 1e-300
        N += 1e-9 * largest[:, None, None] * np.eye(_UNKNOWNS)
        step = np.asarray(np.linalg.solve(N, J @ residual[..., None])[..., 0])
        edges = replace(edges, unknowns=edges.unknowns + _bounded(step, edges.unknowns))
    predicted = np.einsum("nkp,nk->np", J, step)
    square = np.sum((residual - predicted) ** 2, axis=1) / np.maximum(used - _UNKNOWNS, 1)
    covariance = square[:, None, None] * np.linalg.inv(N)[:, :2, :2]
    return Fit(edges, covariance, np.sqrt(square))


def _residual(edges: Edges, pixels: IntArray, grey: Array) -> tuple[Array, Array]:
    """Grey levels (n, P) not explained at `pixels` (n, P, 2), and derivatives (n, 9, P) of the
    model by the unknowns."""
    x = edges.unknowns
    q = pixels - x[_C][:, None]
    t, n = edges.tangents(), edges.normals()
    s = q @ t.transpose(0, 2, 1)
    d = q @ n.transpose(0, 2, 1) - edges.curvature[:, None] / 2 * s * s
    s1, s2, d1, d2 = s[..., 0], s[..., 1], d[..., 0], d[..., 1]
    G = _pattern(edges, q, (d1, d2))
    swing = edges.sign[:, None] * (x[_A][:, None] + _dot(q, edges.contrast_gradient))
    J = np.empty((len(x), _UNKNOWNS, grey.shape[1]))
    by1, by2 = swing * G.by_distance[0], swing * G.by_distance[1]
    for axis in (0, 1):
        J[:, axis] = -by1 * n[:, None, 0, axis] - by2 * n[:, None, 1, axis]
    J[:, 2] = -by1 * s1  # t_1 turns n_1 away from itself,
    J[:, 3] = by2 * s2  # and n_2 towards it
    J[:, 4] = swing * G.by_blur[0]
    J[:, 5] = swing * G.by_blur[1]
    J[:, 6] = 1.0
    J[:, 7] = edges.sign[:, None] * G.value
    J[:, 8] = swing * G.by_correlation
    model = x[_M][:, None] + _dot(q, edges.level_gradient) + swing * G.value
    return grey - model, J


def _pattern(edges: Edges, q: Array, d: Pair) -> Pattern:
    """G at the offsets `q` (n, P, 2) from the corners."""
    x = edges.unknowns
    s1, s2 = (
        np.maximum(x[_BLUR][:, i, None] + _dot(q, edges.blur_gradient[:, i]), _SHARPEST)
        for i in (0, 1)
    )
    rho = x[_RHO][:, None]
    box = None
    if np.median(x[_BLUR]) < _SHARP:
        h = abs(edges.normals()).max(axis=2) / 2
        box = (h[:, :1], h[:, 1:])
    if not edges.spread.any():
        return meeting(d, (s1, s2), rho, box)
    growth = (edges.sign * edges.spread)[:, None]
    w1, w2 = (
        growth * (edges.size[:, i, None] + _dot(q, edges.size_gradient[:, i])) for i in (0, 1)
    )
    return spread(d, (s1, s2), rho, box, (w1, w2))


def _dot(q: Array, gradient: Array) -> Array:
    """(n, P) of (n, P, 2) and (n, 2)."""
    return np.asarray((q @ gradient[..., None])[..., 0])


def _bounded(step: Array, x: Array) -> Array:
    """A Gauss-Newton step (n, 9) kept where the linear model may hold."""
    bounded = np.array(step)
    bounded[_C] = np.clip(step[_C], -1.0, 1.0)
    bounded[_THETA] = np.clip(step[_THETA], -0.1, 0.1)
    s, rho = x[_BLUR], x[_RHO]
    bounded[_BLUR] = np.clip(step[_BLUR], np.maximum(-s / 3, _SHARPEST - s), s / 2)
    bounded[_RHO] = np.clip(step[_RHO], -_MOST_RHO - rho, _MOST_RHO - rho)
    return bounded

"""Images of discs, located at the physical limit.

A disc's image is bounded by an ellipse (a conic, where no lens bends it). With q from its centre
c and S symmetric and positive definite

    rho = sqrt(q^T S q),    d = (1 - rho) rho / |S q|

is to first order the distance of q inside the curve rho = 1. Of an edge that bends inwards with
the curvature kappa = rho^2 det S / |S q|^3 a blur s leaves less, as if it were kappa s^2 / 2
farther in, and the blurred image is

    I(q) = m + gm.q + a E(d - kappa s^2 / 2),

E the blurred edge of ``corners/pattern.py``. The unknowns c, S (3), blur, m and a are found by
Gauss-Newton steps on the pixels near the edge, all circles at once. Under point reflection
about c the derivatives by c are odd and the others even, so that they decouple, and the
covariance of c is the Cramer-Rao bound noise^2 (sum of (grad I)(grad I)^T)^-1. The light's
gradient gm is odd too: it is taken from how m varies over the board.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.detection.edge_intensity import edge
from calibgui.engine.images.sampling import sample

_BANDS = (3.0, 2.3)
"""Half widths of the bands that are read, first and then, blurs."""
_STEPS = 6
_SHARPEST = 0.3
"""Least blur, px: that of the pixel alone is 0.29."""
_CHUNK = 400_000
"""Pixels fitted at once."""
_UNKNOWNS = 8
_C, _S = np.s_[:, 0:2], np.s_[:, 2:5]
_BLUR, _M, _A = np.s_[:, 5], np.s_[:, 6], np.s_[:, 7]
"""Columns of the unknowns; S as (uu, uv, vv)."""
_RAYS = 24
"""Directions in which an edge is looked for at the start."""
_SAMPLES = 49
_HEART = 0.3
"""Least rho of a pixel: nearer the centre the distance from the edge is not what d says."""
_INNERMOST = 0.2
"""Part of the way to the neighbour's disc that is surely ink, if there is any."""


@dataclass(frozen=True, eq=False, slots=True)
class Ellipses:
    """n images of discs."""

    unknowns: Array
    """(n, 8) c (2) px, S (3) 1/px^2, blur px, m and a grey levels."""
    covariance: Array
    """(n, 2, 2) of c, px^2."""
    residual: Array
    """(n,) standard deviation of what the model leaves unexplained, grey levels."""

    @property
    def uv(self) -> Array:
        """(n, 2) centres of the ellipses, px."""
        return self.unknowns[_C]

    @property
    def blur(self) -> Array:
        """(n,) px."""
        return self.unknowns[_BLUR]

    @property
    def contrast(self) -> Array:
        """(n,) of paper and disc, grey levels."""
        return 2 * abs(self.unknowns[_A])

    @property
    def spread(self) -> Array:
        """(n, 2, 2) S^-1: with the image J of a unit of the plate, radius^2 J J^T."""
        return np.asarray(np.linalg.inv(_matrix(self.unknowns[_S])), np.float64)


def fit(image: GreyImage, uv: Array, steps: Array, reach: float, beside: Array) -> Ellipses:
    """Fit the model at every disc.

    Args:
        image: (h, w) grey levels.
        uv: (n, 2) first estimates of the centres, good to a fraction of the radius, px.
        steps: (n, 2, 2) columns: images of a unit of the plate's X and Y there, px.
        reach: half the distance of neighbouring discs, in the same unit.
        beside: (k, 2) from a disc's centre to where there is paper around it.
    """
    x = _start(image, uv, steps, reach, beside)
    gradient = np.zeros_like(uv)
    for turn in range(_STEPS):
        done = _step(image, x, gradient, _BANDS[min(turn, 1)])
        x = done.unknowns
        gradient = _gradient(x)
    return done


def _start(image: GreyImage, uv: Array, steps: Array, reach: float, beside: Array) -> Array:
    """Unknowns from where the grey level, seen along rays, is half of paper's and disc's."""
    angle = 2 * np.pi * np.arange(_RAYS) / _RAYS
    ends = reach * np.stack([np.cos(angle), np.sin(angle)])
    along = (steps @ ends).transpose(0, 2, 1)
    share = np.linspace(0, 1, _SAMPLES)
    seen = sample(image, uv[:, None, None] + share[:, None] * along[:, :, None])
    ink = np.median(seen[..., share < _INNERMOST], axis=(1, 2))
    paper = np.median(sample(image, uv[:, None] + (steps @ beside.T).transpose(0, 2, 1)), axis=1)
    a, m = (ink - paper) / 2, (ink + paper) / 2
    inside = (seen - m[:, None, None]) * np.sign(a)[:, None, None] > 0
    radius = (inside.sum(axis=2) - 0.5) / (_SAMPLES - 1)
    points = radius[..., None] * along
    centre = points.mean(axis=1)
    q = points - centre[:, None]
    spread = 2 * (q.transpose(0, 2, 1) @ q) / _RAYS + 1e-3 * np.eye(2)
    S = np.asarray(np.linalg.inv(spread), np.float64)
    unknowns = np.empty((len(uv), _UNKNOWNS))
    unknowns[_C] = uv + centre
    unknowns[_S] = S[:, [0, 0, 1], [0, 1, 1]]
    unknowns[_BLUR], unknowns[_M], unknowns[_A] = 1.0, m, a
    return unknowns


def _step(image: GreyImage, x: Array, gradient: Array, band: float) -> Ellipses:
    """The model after one Gauss-Newton step on the pixels within `band` blurs of the edges."""
    n = len(x)
    half = int(np.ceil(np.sqrt(np.linalg.inv(_matrix(x[_S])).max()) + band * x[_BLUR].max() + 2))
    portion = max(_CHUNK // (2 * half + 1) ** 2, 1)
    parts = [
        _portion(image, x[i : i + portion], gradient[i : i + portion], band, half)
        for i in range(0, n, portion)
    ]
    return Ellipses(*(np.concatenate(part) for part in zip(*parts, strict=True)))


def _portion(
    image: GreyImage, x: Array, gradient: Array, band: float, half: int
) -> tuple[Array, Array, Array]:
    """Unknowns, covariances and residuals of some discs after a step."""
    grey, qu, qv, weight = _read(image, x, band, half)
    su, sv, rho, slope = _conic(x, qu, qv)
    bend = (x[:, 2] * x[:, 4] - x[:, 3] ** 2)[:, None] * (rho / slope) ** 2 / slope
    d = (1 - rho) * rho / slope - bend * x[_BLUR][:, None] ** 2 / 2
    box = np.maximum(abs(su), abs(sv)) / slope / 2
    E = edge(d, np.broadcast_to(x[_BLUR][:, None], d.shape), box)
    a = x[_A][:, None]
    light = gradient[:, :1] * qu + gradient[:, 1:] * qv
    r = (grey - x[_M][:, None] - light - a * E.value) * weight
    # On the edge, where E' is not 0, d changes with q^T S q like -1 / (2 |S q|) and moves with c.
    by_d = a * E.slope * weight
    J = np.stack(
        [
            by_d * su / slope,
            by_d * sv / slope,
            by_d * -(qu * qu) / (2 * slope),
            by_d * -(qu * qv) / slope,
            by_d * -(qv * qv) / (2 * slope),
            a * E.by_blur * weight,
            weight,
            weight * E.value,
        ],
        axis=1,
    )
    scale = np.sqrt(np.sum(J * J, axis=2)) + 1e-300
    J /= scale[..., None]
    N = J @ J.transpose(0, 2, 1) + 1e-12 * np.eye(_UNKNOWNS)
    g = (J @ r[..., None])[..., 0]
    move = np.linalg.solve(N, g[..., None])[..., 0]
    square = np.maximum(np.sum(r * r, axis=1) - np.sum(move * g, axis=1), 0.0)
    square /= np.maximum(weight.sum(axis=1) - _UNKNOWNS, 1)
    inverse = np.linalg.inv(N)[:, :2, :2] / (scale[:, :2, None] * scale[:, None, :2])
    moved = x + _bounded(move / scale, x)
    return moved, square[:, None, None] * inverse, np.sqrt(square)


def _read(image: GreyImage, x: Array, band: float, half: int) -> tuple[Array, Array, Array, Array]:
    """Grey levels (n, K) of the pixels near the edges, their offsets from the centres along u and
    v, and 1, or 0 where there are fewer."""
    offset = np.arange(-half, half + 1)
    at = np.rint(x[_C]).astype(np.int64)
    u, v = at[:, :1] + offset, at[:, 1:] + offset
    height, width = image.shape
    inside = ((v >= 0) & (v < height))[:, :, None] & ((u >= 0) & (u < width))[:, None]
    du, dv = (u - x[:, :1])[:, None], (v - x[:, 1:2])[:, :, None]
    _, _, rho, slope = _conic(x, *np.broadcast_arrays(du, dv))
    near = abs((1 - rho) * rho / slope) <= (band * x[_BLUR] + 0.7)[:, None, None]
    disc, row, col = np.nonzero(inside & near & (rho > _HEART))
    counts = np.bincount(disc, minlength=len(x))
    place = np.arange(len(disc)) - np.repeat(np.cumsum(counts) - counts, counts)
    grey, qu, qv, weight = (np.ones((len(x), counts.max(initial=1))) for _ in range(4))
    weight[np.arange(weight.shape[1]) >= counts[:, None]] = 0.0
    grey[disc, place] = image[v[disc, row], u[disc, col]]
    qu[disc, place], qv[disc, place] = du[disc, 0, col], dv[disc, row, 0]
    return grey, qu, qv, weight


def _conic(x: Array, qu: Array, qv: Array) -> tuple[Array, Array, Array, Array]:
    """S q along u and v, rho and |S q| at offsets (n, ...) from the centres."""
    uu, uv, vv = x[_S].T.reshape(3, -1, *[1] * (qu.ndim - 1))
    su, sv = uu * qu + uv * qv, uv * qu + vv * qv
    rho = np.sqrt(np.maximum(qu * su + qv * sv, 1e-12))
    return su, sv, rho, np.maximum(np.hypot(su, sv), 1e-12)


def _bounded(step: Array, x: Array) -> Array:
    """A step kept where the linear model may hold."""
    bounded = step.copy()
    bounded[_C] = np.clip(step[_C], -2.0, 2.0)
    bounded[_BLUR] = np.clip(
        step[_BLUR], np.maximum(-x[_BLUR] / 3, _SHARPEST - x[_BLUR]), x[_BLUR] / 2
    )
    # S may change by a part of itself, lest it lose its sign.
    limit = 0.3 * np.minimum(x[:, 2], x[:, 4])
    bounded[_S] = np.clip(step[_S], -limit[:, None], limit[:, None])
    return bounded


def _gradient(x: Array) -> Array:
    """(n, 2) gradient of the light m over the image, from a quadratic through all discs."""
    centre, unit = x[_C].mean(axis=0), np.ptp(x[_C], axis=0).max()
    u, v = ((x[_C] - centre) / unit).T
    one, zero = np.ones_like(u), np.zeros_like(u)
    terms = np.linalg.lstsq(np.column_stack([one, u, v, u * u, u * v, v * v]), x[_M], rcond=1e-9)[0]
    by_u = np.column_stack([zero, one, zero, 2 * u, v, zero]) @ terms
    by_v = np.column_stack([zero, zero, one, zero, u, 2 * v]) @ terms
    return np.column_stack([by_u, by_v]) / unit


def _matrix(S: Array) -> Array:
    """(n, 2, 2) of (n, 3)."""
    return S[:, [0, 1, 1, 2]].reshape(-1, 2, 2)

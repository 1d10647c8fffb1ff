"""Ellipses fitted to images of discs, at the Cramer-Rao bound.

A disc's image is bounded by an ellipse (a conic, where no lens bends it). It is fitted to the grey
levels of the pixels near its edge, by a model of the blurred edge, rather than to points found on
it: no threshold enters, and the covariance follows. With q from the ellipse's centre c and S
symmetric and positive definite

    rho = sqrt(q^T S q),    d = (1 - rho) rho / |S q|

is to first order the distance of q inside the curve rho = 1. Of an edge that bends inwards with
the curvature kappa = rho^2 det S / |S q|^3 a blur s leaves less, as if it were kappa s^2 / 2
farther in, and the blurred image is

    I(q) = (m + a E(d - kappa s^2 / 2)) (1 + g.q),

E the blurred edge of ``edge_intensity`` and g the gradient of the light over itself. The unknowns
c, S (3), blur, m and a are found by Gauss-Newton steps on the pixels near the edge, all circles at
once. Under point reflection about c the derivatives by c are odd and the others even, so that they
decouple, and the covariance of c is the Cramer-Rao bound noise^2 (sum of (grad I)(grad I)^T)^-1.
The light's gradient is odd too: m g is taken from how m varies from disc to disc. The blur moves
the pattern by -s^2 grad a / a, and it is moved back. Much out of focus, m and a are not fitted, but
read where discs and paper are flat (`defocus`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, BoolArray, GreyImage, IntArray
from calibgui.engine.corner_fit.x_corner_model import MIN_BLUR
from calibgui.engine.detection.circles.defocus import SeenLevels, estimate_rise, read_levels
from calibgui.engine.detection.circles.thresholds import CIRCLE_THRESHOLDS
from calibgui.engine.features.edge_intensity import compute_edge
from calibgui.engine.features.pixel_noise import (
    ROUNDING_VARIANCE,
    estimate_noise_at,
    find_readable,
)
from calibgui.engine.images.sampling import sample_image

_BAND_HALF_WIDTHS = (3.0, 2.3)
"""Half widths of the bands that are read, in the first step and in later ones, blurs."""
_GAUSS_NEWTON_STEPS = 6
"""Number of steps."""
_EVENNESS_STEP = 2
"""The one of them after which the ellipses are near enough to tell by what light they are seen."""
_HOPELESS_MISFIT = 0.6
"""Median of what is left unexplained then, over the contrast, with which the fits end: a disc whose
blur is not found yet has 0.5 at most, what is no disc 1.6 to 12."""
_MAX_RELATIVE_STEP = 0.3
"""Greatest change of S in one step, over itself."""
_MAX_PIXELS_AT_ONCE = 400_000
"""Number of pixels looked at at once."""
_UNKNOWNS = 8
"""Number of unknowns."""
_C, _S = np.s_[:, 0:2], np.s_[:, 2:5]
_BLUR, _M, _A = np.s_[:, 5], np.s_[:, 6], np.s_[:, 7]
"""Columns of the unknowns; S as (uu, uv, vv)."""
_FIXED_LEVELS = 6
"""Number of unknowns that are left where m and a are seen."""
_MIN_DEFOCUS = 1.5
"""Least blur that may be such that the edge's shape matters, px."""
_MIN_EXCESS = 0.02
"""Excess of the fitted contrast over the seen one at which the latter counts."""
_MAX_UNEVENNESS = 0.025
"""Loss of contrast beside a disc's middle up to which this shows the ink."""
_RAYS = 24
"""Number of directions in which the edge is sampled for the start."""
_SAMPLES = 49
"""Number of samples along each of them."""
_MIN_RHO = 0.3
"""Least rho of a pixel that is read: nearer the centre d approximates the distance badly."""
_MAX_NEIGHBOUR_ERROR = 0.3
"""Greatest distance of a disc's neighbour from its place, steps."""
_MIN_SINE = 1e-3
"""Least sine of the angle between the ways to a disc's neighbours."""
_LEAST_RISE = 0.02
"""Change of the light from disc to disc below which both sides count alike, or across a disc below
which it is not doubted, half contrasts."""
_PATCH_REACH = 3.0
"""Greatest distance of a pixel that the noise is read from, px."""
_INK_REACH = 0.2
"""Distance from the centre within which samples are ink, half distances of neighbours."""


@dataclass(frozen=True, eq=False, slots=True)
class EllipseFit:
    """Ellipses fitted to n images of discs."""

    unknowns: Array
    """(n, 8) c (2) px, S (3) 1/px^2, blur px, m and a grey levels."""
    covariance: Array
    """(n, 2, 2) of c, px^2."""
    residual: Array
    """(n,) standard deviation of what the model leaves unexplained, grey levels."""
    noise: Array
    """(n,) standard deviation of the noise from pixel to pixel on the paper beside, grey levels; 0
    where that is not told."""
    is_out_of_focus: bool = False
    """True if levels were read where the discs are flat, as their edges are none of a Gaussian
    blur."""

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
        """(n,) difference of paper and disc, grey levels."""
        return 2 * abs(self.unknowns[_A])

    @property
    def are_bright(self) -> bool:
        """True if most discs are brighter than the paper."""
        return bool(np.median(self.unknowns[_A]) > 0)

    @property
    def light(self) -> Array:
        """(n,) level of the brighter of disc and paper, grey levels."""
        return self.unknowns[_M] + abs(self.unknowns[_A])

    @property
    def misfit(self) -> Array:
        """(n,) standard deviation of what is left unexplained and is no noise, over the contrast.

        Of the noise no more is believed than leaves an edge to be seen: where textures are taken
        for discs it is their own roughness.
        """
        noise = np.minimum(self.noise, CIRCLE_THRESHOLDS.max_noise_share * self.contrast)
        return np.asarray(np.sqrt(np.maximum(self.residual**2 - noise**2, 0.0)) / self.contrast)

    @property
    def spread(self) -> Array:
        """(n, 2, 2) S^-1, px^2: radius^2 J J^T for the image J of a unit of the board."""
        return np.asarray(np.linalg.inv(_assemble_matrix(self.unknowns[_S])), np.float64)


def fit_ellipses(
    image: GreyImage, uv: Array, steps: Array, reach: float, paper: Array, neighbours: Array
) -> EllipseFit:
    """Fit the model at every disc.

    Args:
        image: (h, w) grey levels.
        uv: (n, 2) first estimates of the centres, good to a fraction of the radius, px.
        steps: (n, 2, 2) columns: images of a unit of the board's X and Y there, px.
        reach: half the distance of neighbouring discs, in the same unit.
        paper: (k, 2) displacements from a disc's centre to paper around it, in the same unit.
        neighbours: (2, 2) displacements to its neighbours on one side, in the same unit.
    """
    x = _estimate_start(image, uv, steps, reach, paper)
    start, beside = x, _find_neighbours(uv, steps, neighbours)
    gradient, is_even = np.zeros_like(uv), np.zeros(len(uv), dtype=bool)
    for step in range(_GAUSS_NEWTON_STEPS):
        fit = _take_step(image, x, gradient, _BAND_HALF_WIDTHS[min(step, 1)])
        x = fit.unknowns
        gradient = _estimate_gradient(x[_M], x, beside)
        if step == _EVENNESS_STEP:
            if np.median(fit.residual / fit.contrast) > _HOPELESS_MISFIT:
                break
            is_even = _find_evenly_lit(image, x, gradient)
        gradient[is_even] = 0.0
    rise = _estimate_gradient(x[_A], x, beside) / x[:, 7:]
    rise[is_even] = 0.0
    if (x[_BLUR] > _MIN_DEFOCUS).all():
        seen = read_levels(image, fit.uv, steps, reach, paper)
        if _is_out_of_focus(x, seen):
            rise = estimate_rise(seen, uv)
            fit = _fit_out_of_focus(image, start, seen, rise)
            x = fit.unknowns
    moved = x.copy()
    moved[_C] += x[_BLUR][:, None] ** 2 * rise
    on_paper = uv[:, None] + (steps @ paper.T).transpose(0, 2, 1)
    return replace(fit, unknowns=moved, noise=_estimate_noise(image, x, on_paper))


def _is_out_of_focus(x: Array, seen: SeenLevels) -> bool:
    """Return whether fits claim more contrast than is seen of discs that are flat in the middle."""
    excess = float(np.median(2 * x[_A] / seen.contrast)) - 1
    return excess > _MIN_EXCESS and seen.unevenness < _MAX_UNEVENNESS


def _fit_out_of_focus(image: GreyImage, x: Array, seen: SeenLevels, rise: Array) -> EllipseFit:
    """Fit the model from the start `x` (n, 8) with paper and ink as they are seen, in light of the
    gradient `rise` (n, 2) over itself, 1/px."""
    x = x.copy()
    x[_M], x[_A] = (seen.ink + seen.paper) / 2, seen.contrast / 2
    gradient = rise * x[:, 6:7]
    for step in range(_GAUSS_NEWTON_STEPS):
        fit = _take_step(image, x, gradient, _BAND_HALF_WIDTHS[min(step, 1)], _FIXED_LEVELS)
        x = fit.unknowns
    noise = _estimate_odd_noise(image, x, gradient)
    variance = np.maximum(noise**2, ROUNDING_VARIANCE)
    before = np.maximum(fit.residual**2, ROUNDING_VARIANCE)
    covariance = fit.covariance * (variance / before)[:, None, None]
    return replace(fit, covariance=covariance, is_out_of_focus=True)


def _estimate_odd_noise(image: GreyImage, x: Array, gradient: Array) -> Array:
    """Estimate the standard deviation (n,) of what the model leaves unexplained and differs from
    one pixel to that on the other side of the disc, grey levels: what does not, as an edge of
    another shape, moves no centre. The discs' blur is well above the pixel."""
    half = np.ceil(_find_extent(x, _BAND_HALF_WIDTHS[1])).astype(np.int64)
    limit = np.array(image.shape[::-1]) - 1
    variance = []
    for part in _list_portions(half):
        its = x[part]
        grey, qu, qv, weight = _read_bands(image, its, half[part], _BAND_HALF_WIDTHS[1], _MIN_RHO)
        opposite = np.rint(its[:, None, _C[1]] - np.stack([qu, qv], axis=2)).astype(np.int64)
        weight *= ((opposite >= 0) & (opposite <= limit)).all(axis=2)
        u, v = np.moveaxis(np.clip(opposite, 0, limit), 2, 0)
        own, other = (
            _differentiate_model(its, gradient[part], level, pu, pv, weight)[:, -1]
            for level, pu, pv in ((grey, qu, qv), (image[v, u], u - its[:, :1], v - its[:, 1:2]))
        )
        count = np.maximum(weight.sum(axis=1) - 2, 1)
        variance.append(np.sum((own - other) ** 2, axis=1) / 2 / count)
    return np.sqrt(np.concatenate(variance))


def _find_evenly_lit(image: GreyImage, x: Array, gradient: Array) -> BoolArray:
    """Find the discs (n,) True that even light describes better than the `gradient` (n, 2) that is
    seen from disc to disc: the edge of a shadow passes beside them."""
    is_even = np.zeros(len(x), dtype=bool)
    spread = np.linalg.inv(_assemble_matrix(x[_S]))
    across = np.sqrt(np.maximum(np.einsum("ni,nij,nj->n", gradient, spread, gradient), 0.0))
    doubtful = np.flatnonzero(across > _LEAST_RISE * abs(x[_A]))
    if len(doubtful):
        x, gradient = x[doubtful], gradient[doubtful]
        uneven, even = (
            _take_step(image, x, light, _BAND_HALF_WIDTHS[1]).residual
            for light in (gradient, np.zeros_like(gradient))
        )
        is_even[doubtful] = even < uneven
    return is_even


def _estimate_noise(image: GreyImage, x: Array, on_paper: Array) -> Array:
    """Estimate the noise (n,) beside discs of which places `on_paper` (n, k, 2) px lie around; 0
    where they are not all in the image, or the discs' edges so near as to be read with them."""
    q = on_paper - x[_C][:, None]
    _, _, rho, slope = _evaluate_conic(x, q[..., 0], q[..., 1])
    gap = ((rho - 1) * rho / slope).min(axis=1)
    is_told = find_readable(on_paper, image).all(axis=1)
    is_told &= gap > _PATCH_REACH + _BAND_HALF_WIDTHS[1] * x[_BLUR]
    noise = np.zeros(len(x))
    if is_told.any():
        noise[is_told] = estimate_noise_at(on_paper[is_told], image)
    return noise


def _estimate_start(image: GreyImage, uv: Array, steps: Array, reach: float, paper: Array) -> Array:
    """Estimate the unknowns (n, 8) from where the grey level along rays is midway between those of
    paper and disc."""
    angle = 2 * np.pi * np.arange(_RAYS) / _RAYS
    ends = reach * np.stack([np.cos(angle), np.sin(angle)])
    along = (steps @ ends).transpose(0, 2, 1)
    share = np.linspace(0, 1, _SAMPLES)
    seen = sample_image(image, uv[:, None, None] + share[:, None] * along[:, :, None])
    ink = np.median(seen[..., share < _INK_REACH], axis=(1, 2))
    on_paper = uv[:, None] + (steps @ paper.T).transpose(0, 2, 1)
    white = np.median(sample_image(image, on_paper), axis=1)
    a, m = (ink - white) / 2, (ink + white) / 2
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


def _take_step(
    image: GreyImage, x: Array, gradient: Array, band: float, free: int = _UNKNOWNS
) -> EllipseFit:
    """Take one Gauss-Newton step on the pixels within `band` blurs of the edges, by the first
    unknowns, `free` of them."""
    products = _sum_products(image, x, gradient, band, _MIN_RHO)
    N, g = products[:, :free, :free], products[:, :free, -1]
    count = products[:, 6, 6]
    scale = np.sqrt(np.einsum("nii->ni", N)) + 1e-300
    N = N / scale[:, :, None] / scale[:, None] + 1e-12 * np.eye(free)
    g = g / scale
    move = np.linalg.solve(N, g[..., None])[..., 0]
    square = np.maximum(products[:, -1, -1] - np.sum(move * g, axis=1), 0.0)
    square /= np.maximum(count - free, 1)
    with np.errstate(over="ignore"):  # of a disc without pixels, whose covariance is infinite
        inverse = np.linalg.inv(N)[:, :2, :2] / scale[:, :2, None] / scale[:, None, :2]
    step = np.zeros_like(x)
    step[:, :free] = move / scale
    moved = x + _limit_step(step, x)
    noise = np.maximum(square, ROUNDING_VARIANCE)
    return EllipseFit(moved, noise[:, None, None] * inverse, np.sqrt(square), np.zeros(len(x)))


@kernels.with_kernel("ellipse_fit", "sum_products")
def _sum_products(
    image: GreyImage, x: Array, gradient: Array, band: float, min_rho: float
) -> Array:
    """Sum the products of the model's derivatives, and of the residuals, over each disc's band.

    Args:
        image: (h, w) grey levels.
        x: (n, 8) unknowns.
        gradient: (n, 2) m g, grey levels per px.
        band: half width of the bands, blurs; their pixels are at most 0.7 px farther away.
        min_rho: least rho of a pixel.

    Returns:
        (n, 9, 9) the derivatives by the unknowns first, the residual last.
    """
    half = np.ceil(_find_extent(x, band)).astype(np.int64)
    products = []
    for part in _list_portions(half):
        band_of = _read_bands(image, x[part], half[part], band, min_rho)
        J = _differentiate_model(x[part], gradient[part], *band_of)
        products.append(J @ J.transpose(0, 2, 1))
    return np.concatenate(products)


def _list_portions(half: IntArray) -> list[slice]:
    """List portions of discs whose bands reach `half` (n,) px that are looked at at once."""
    portion = max(_MAX_PIXELS_AT_ONCE // (2 * int(half.max()) + 1) ** 2, 1)
    return [slice(i, i + portion) for i in range(0, len(half), portion)]


def _find_extent(x: Array, band: float) -> Array:
    """Find how far, px, the bands (n,) reach from the centres along u or v."""
    longest = np.linalg.inv(_assemble_matrix(x[_S])).max(axis=(1, 2))
    return np.asarray(np.sqrt(longest) + band * x[_BLUR] + 2)


def _differentiate_model(
    x: Array, gradient: Array, grey: Array, qu: Array, qv: Array, weight: Array
) -> Array:
    """Compute the derivatives by the unknowns, and the residuals, of pixels: (k, 9, K)."""
    su, sv, rho, slope = _evaluate_conic(x, qu, qv)
    bend = (x[:, 2] * x[:, 4] - x[:, 3] ** 2)[:, None] * (rho / slope) ** 2 / slope
    d = (1 - rho) * rho / slope - bend * x[_BLUR][:, None] ** 2 / 2
    box = np.maximum(abs(su), abs(sv)) / slope / 2
    E = compute_edge(d, np.broadcast_to(x[_BLUR][:, None], d.shape), box)
    a = x[_A][:, None]
    m = x[_M][:, None]
    rise = gradient[:, :1] * qu + gradient[:, 1:] * qv
    light = rise * (1 + a / np.maximum(np.maximum(m, abs(a)), 1.0) * E.value)
    r = (grey - m - a * E.value - light) * weight
    # On the edge, where E' is not 0, d changes with q^T S q like -1 / (2 |S q|) and moves with c.
    by_d = a * E.slope * weight
    return np.stack(
        [
            by_d * su / slope,
            by_d * sv / slope,
            by_d * -(qu * qu) / (2 * slope),
            by_d * -(qu * qv) / slope,
            by_d * -(qv * qv) / (2 * slope),
            a * E.by_blur * weight,
            weight,
            weight * E.value,
            r,
        ],
        axis=1,
    )


def _read_bands(
    image: GreyImage, x: Array, half: IntArray, band: float, min_rho: float
) -> tuple[Array, Array, Array, Array]:
    """Read the pixels near the edges, at most `half` (n,) px from the centres along u and v.

    Returns:
        Grey levels (n, K), offsets from the centres along u and v, and weights: 1, or 0 beyond the
        last pixel of a disc that has fewer than K.
    """
    offset = np.arange(-half.max(), half.max() + 1)
    is_own = abs(offset) <= half[:, None]
    at = np.rint(x[_C]).astype(np.int64)
    u, v = at[:, :1] + offset, at[:, 1:] + offset
    height, width = image.shape
    inside = (is_own & (v >= 0) & (v < height))[:, :, None]
    inside = inside & (is_own & (u >= 0) & (u < width))[:, None]
    du, dv = (u - x[:, :1])[:, None], (v - x[:, 1:2])[:, :, None]
    _, _, rho, slope = _evaluate_conic(x, *np.broadcast_arrays(du, dv))
    near = abs((1 - rho) * rho / slope) <= (band * x[_BLUR] + 0.7)[:, None, None]
    disc, row, col = np.nonzero(inside & near & (rho > min_rho))
    counts = np.bincount(disc, minlength=len(x))
    place = np.arange(len(disc)) - np.repeat(np.cumsum(counts) - counts, counts)
    grey, qu, qv, weight = (np.ones((len(x), counts.max(initial=1))) for _ in range(4))
    weight[np.arange(weight.shape[1]) >= counts[:, None]] = 0.0
    grey[disc, place] = image[v[disc, row], u[disc, col]]
    qu[disc, place], qv[disc, place] = du[disc, 0, col], dv[disc, row, 0]
    return grey, qu, qv, weight


def _evaluate_conic(x: Array, qu: Array, qv: Array) -> tuple[Array, Array, Array, Array]:
    """Compute S q along u and v, rho and |S q| at offsets (n, ...) from the centres."""
    uu, uv, vv = x[_S].T.reshape(3, -1, *[1] * (qu.ndim - 1))
    su, sv = uu * qu + uv * qv, uv * qu + vv * qv
    rho = np.sqrt(np.maximum(qu * su + qv * sv, 1e-12))
    return su, sv, rho, np.maximum(np.hypot(su, sv), 1e-12)


def _limit_step(step: Array, x: Array) -> Array:
    """Limit a step (n, 8) to where the linear model holds."""
    bounded = step.copy()
    bounded[_C] = np.clip(step[_C], -2.0, 2.0)
    bounded[_BLUR] = np.clip(
        step[_BLUR], np.maximum(-x[_BLUR] / 3, MIN_BLUR - x[_BLUR]), x[_BLUR] / 2
    )
    # S may change by a part of itself in every direction, lest it lose its sign: along the longer
    # axis of a slender ellipse it is much smaller than its entries.
    part = np.linalg.solve(_assemble_matrix(x[_S]), _assemble_matrix(step[_S]))
    half = np.einsum("nii->n", part) / 2
    most = abs(half) + np.sqrt(np.maximum(half**2 - np.linalg.det(part), 0.0))
    bounded[_S] = step[_S] * (_MAX_RELATIVE_STEP / np.maximum(most, _MAX_RELATIVE_STEP))[:, None]
    return bounded


def _find_neighbours(uv: Array, steps: Array, neighbours: Array) -> IntArray:
    """Find the discs next to each on either side along two directions, (n, 2, 2), -1 where there
    is none; the arguments are those of `fit_ellipses`."""
    ways = (steps @ neighbours.T).transpose(0, 2, 1)
    wanted = uv[:, None, None] + np.stack([ways, -ways], axis=2)
    distance, index = scipy.spatial.cKDTree(uv).query(wanted)
    limit = _MAX_NEIGHBOUR_ERROR * np.linalg.norm(ways, axis=2)[..., None]
    return np.where(distance < limit, index, -1)


def _estimate_gradient(values: Array, x: Array, beside: IntArray) -> Array:
    """Estimate the gradient (n, 2) over the image of `values` (n,) at each disc, grey levels per
    px, from those of the discs `beside` it, see `_find_neighbours`.

    Of the changes to either side along a direction the smaller counts more: the edge of a shadow
    passes between two discs, and discs that the image's border cuts, or that something covers, have
    an m of their own. Discs whose light is not told from their blur, which tilt makes so on one
    side of the grid, count only if most are such.
    """
    steepest = np.linalg.eigvalsh(_assemble_matrix(x[_S]))[:, -1]
    is_told = x[_BLUR] ** 2 * steepest < CIRCLE_THRESHOLDS.max_blur_over_axis**2
    if 2 * np.count_nonzero(is_told) < len(x):
        is_told[:] = True
    counts = (beside >= 0) & is_told[beside]
    sign = np.array([1.0, -1.0])
    along = sign[:, None] * (x[_C][beside] - x[_C][:, None, None])
    rise = sign * (values[beside] - values[:, None, None])
    least = _LEAST_RISE * float(np.median(abs(x[_A])))
    weight = counts / (rise**2 + least**2)
    total = weight.sum(axis=2) + 1e-300
    way = np.sum(weight[..., None] * along, axis=2) / total[..., None]
    slope = np.sum(weight * rise, axis=2) / total
    is_known = np.asarray(counts.any(axis=2))
    slope = _limit_slopes(slope, way, counts, beside)
    # Where there is no disc on either side, the light is taken to be even along that direction.
    other = way[:, ::-1, ::-1] * np.array([-1.0, 1.0])
    way = np.where(is_known[..., None], way, other)
    way[~is_known.any(axis=1)] = np.eye(2)
    slope = np.where(is_known, slope, 0.0)
    # Both ways may lead to one disc, where something covers the others: then nothing is told.
    (a, b), (c, d) = way.transpose(1, 2, 0)
    det = a * d - b * c
    is_told = abs(det) > _MIN_SINE * np.hypot(a, b) * np.hypot(c, d)
    across = np.stack(
        [d * slope[:, 0] - b * slope[:, 1], a * slope[:, 1] - c * slope[:, 0]], axis=1
    )
    return np.where(is_told[:, None], across, 0.0) / np.where(is_told, det, 1.0)[:, None]


def _limit_slopes(slope: Array, way: Array, counts: BoolArray, beside: IntArray) -> Array:
    """Limit the changes `slope` (n, 2) along `way` (n, 2, 2) px of discs that have a neighbour on
    one side only, at the grid's border, to those of the discs beside them: that neighbour may be
    cut or covered."""
    length = np.linalg.norm(way, axis=2) + 1e-300
    steepness = slope / length
    limited = slope.copy()
    for k in (0, 1):
        its = np.where(counts[:, 1 - k], steepness[beside[:, 1 - k], k], np.inf)
        its = np.column_stack([steepness[:, k], its])
        least = its[np.arange(len(its)), abs(its).argmin(axis=1)]
        is_one_sided = counts[:, k].sum(axis=1) == 1
        limited[is_one_sided, k] = (least * length[:, k])[is_one_sided]
    return limited


def _assemble_matrix(S: Array) -> Array:
    """Assemble symmetric matrices (n, 2, 2) from (n, 3) = (uu, uv, vv)."""
    return S[:, [0, 1, 1, 2]].reshape(-1, 2, 2)

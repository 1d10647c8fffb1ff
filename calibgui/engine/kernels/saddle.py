"""Saddle points of the weighted quadratic fit, compiled: see ``features.saddle``."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage
from calibgui.engine.kernels.common import (
    compiled,
    compiled_part,
    factor,
    make_read_only,
    substitute,
)

_POWERS = np.array([(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)])


@compiled_part
def _sum_moments(
    centre: float, origin: int, extent: int, sigma: float, weighted: Array, moments: Array
) -> None:
    """Fill in weights times powers 0 to 2 of each pixel along an axis, and their moments 0 to 4.

    From one pixel to the next the bell curve falls by a factor that itself falls by a constant one:
    that takes three exponentials, however many pixels there are.
    """
    h, x = 1 / sigma, (origin - centre) / sigma
    bell, factor, fall = np.exp(-0.5 * x * x), np.exp(-h * (x + h / 2)), np.exp(-h * h)
    m0 = m1 = m2 = m3 = m4 = 0.0
    for k in range(weighted.shape[1]):
        at = origin + k
        x = (at - centre) / sigma
        w = bell if 0 <= at < extent else 0.0
        bell *= factor
        factor *= fall
        w1, w2 = w * x, w * x * x
        weighted[0, k], weighted[1, k], weighted[2, k] = w, w1, w2
        m0, m1, m2, m3, m4 = m0 + w, m1 + w1, m2 + w2, m3 + w2 * x, m4 + w2 * x * x
    moments[0], moments[1], moments[2], moments[3], moments[4] = m0, m1, m2, m3, m4


@compiled_part
def _compute_step(
    image: GreyImage, u: float, v: float, sigma: float, work: tuple[Array, ...]
) -> tuple[float, float, bool]:
    """Compute the step to the fitted stationary point, at most sigma long, and whether that is a
    saddle."""
    weights_u, weights_v, moments_u, moments_v, N, fit = work
    height, width = image.shape
    if not (0 <= u <= width - 1 and 0 <= v <= height - 1):
        return 0.0, 0.0, False
    half = int(np.ceil(3 * sigma + 0.5))
    side, left, top = 2 * half + 1, int(np.rint(u)) - half, int(np.rint(v)) - half
    wu, wv = weights_u[:, :side], weights_v[:, :side]
    _sum_moments(u, left, width, sigma, wu, moments_u)
    _sum_moments(v, top, height, sigma, wv, moments_v)
    fit[:] = 0
    first, last = max(-left, 0), min(side, width - left)
    w0, w1, w2 = wu[0, first:], wu[1, first:], wu[2, first:]
    for k in range(max(-top, 0), min(side, height - top)):
        r0 = r1 = r2 = 0.0
        row = image[top + k, left + first :]
        for i in range(last - first):
            grey = float(row[i])
            r0 += grey * w0[i]
            r1 += grey * w1[i]
            r2 += grey * w2[i]
        fit[0] += wv[0, k] * r0
        fit[1] += wv[0, k] * r1
        fit[2] += wv[1, k] * r0
        fit[3] += wv[0, k] * r2
        fit[4] += wv[1, k] * r1
        fit[5] += wv[2, k] * r0
    for i in range(6):
        for j in range(6):
            p, q = _POWERS[i, 0] + _POWERS[j, 0], _POWERS[i, 1] + _POWERS[j, 1]
            N[i, j] = moments_u[p] * moments_v[q]
    factor(N)
    substitute(N, fit)
    d, e, a, b, c = fit[1], fit[2], fit[3], fit[4], fit[5]
    det = 4 * a * c - b * b
    if not det < 0:
        return 0.0, 0.0, False
    du, dv = (b * e - 2 * c * d) / det, (b * d - 2 * a * e) / det
    scale = sigma / max(np.sqrt(du * du + dv * dv), 1.0)
    return scale * du, scale * dv, True


@compiled
def _iterate(
    image: GreyImage,
    start: Array,
    sigma: Array,
    side: int,
    limit: Array,
    tolerance: float,
    most: int,
    uv: Array,
    good: BoolArray,
) -> None:
    """Fill in positions (n, 2), and True where one was found; weights reach over `side` pixels."""
    work = (
        np.empty((3, side)),
        np.empty((3, side)),
        np.empty(5),
        np.empty(5),
        np.empty((6, 6)),
        np.empty(6),
    )
    for i in range(start.shape[0]):
        u, v = start[i]
        for _ in range(most):
            du, dv, is_saddle = _compute_step(image, u, v, sigma[i], work)
            u, v = u + du, v + dv
            away = np.sqrt((u - start[i, 0]) ** 2 + (v - start[i, 1]) ** 2)
            if not is_saddle or not away <= limit[i]:
                break
            if np.sqrt(du * du + dv * dv) <= tolerance:
                good[i] = True
                uv[i, 0], uv[i, 1] = u, v
                break


def iterate(
    image: GreyImage, start: Array, sigma: Array, limit: Array, tolerance: float, most: int
) -> tuple[Array, BoolArray]:
    """Compute ``_iterate`` of the reference."""
    uv, good = start.copy(), np.zeros(len(start), dtype=np.bool_)
    side = 2 * int(np.ceil(3 * sigma.max(initial=0.0) + 0.5)) + 1
    _iterate(make_read_only(image), start, sigma, side, limit, tolerance, most, uv, good)
    return uv, good

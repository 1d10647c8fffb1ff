"""The sums of a fit of ellipses, compiled: see ``detection.circles.ellipse_fit``.

Most pixels around a disc are far from its edge. As |S q| is at most rho sqrt(l), l the larger
eigenvalue of S, those within w of the edge have |1 - rho| <= w sqrt(l): this is asked first, of
rho^2.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.kernels.common import (
    compiled,
    compiled_part,
    gram,
    make_contiguous,
    make_read_only,
)

_ROOT2, _ROOT_PI = np.sqrt(2.0), np.sqrt(np.pi)
_ROUNDING = 1e-9
"""Greatest error of rho^2 by rounding."""


@compiled_part
def _erf(x: float, bell: float) -> float:
    """Compute erf(x), given exp(-x^2), as ``edge_intensity``."""
    t = 1 / (1 + 0.3275911 * abs(x))
    tail = 1.421413741 + t * (-1.453152027 + t * 1.061405429)
    value = 1 - t * (0.254829592 + t * (-0.284496736 + t * tail)) * bell
    return value if x >= 0 else -value


@compiled_part
def _list_pixels(
    image: GreyImage, x: Array, half: int, near: float, min_rho: float, pixels: Array
) -> int:
    """List the pixels within `near` px of an edge, at most `half` px from its centre along u and v,
    in `pixels` (3, K) as grey level and offset from the centre along u and v; return their
    number."""
    height, width = image.shape
    uu, uv, vv = x[2], x[3], x[4]
    larger = (uu + vv) / 2 + np.sqrt(((uu - vv) / 2) ** 2 + uv * uv)
    around = near * np.sqrt(larger)
    least, most = max(1 - around, min_rho) ** 2 - _ROUNDING, (1 + around) ** 2 + _ROUNDING
    middle_u, middle_v = int(np.rint(x[0])), int(np.rint(x[1]))
    count = 0
    for v in range(max(middle_v - half, 0), min(middle_v + half + 1, height)):
        qv = v - x[1]
        for u in range(max(middle_u - half, 0), min(middle_u + half + 1, width)):
            qu = u - x[0]
            su, sv = uu * qu + uv * qv, uv * qu + vv * qv
            square = qu * su + qv * sv
            if square < least or square > most:
                continue
            rho = np.sqrt(max(square, 1e-12))
            slope = max(np.sqrt(su * su + sv * sv), 1e-12)
            if rho > min_rho and abs((1 - rho) * rho / slope) <= near:
                pixels[0, count], pixels[1, count], pixels[2, count] = image[v, u], qu, qv
                count += 1
    return count


@compiled_part
def _differentiate(x: Array, gradient: Array, pixels: Array, J: Array) -> None:
    """Fill J (9, K) with the derivatives by the unknowns and the residuals at `pixels`."""
    uu, uv, vv, blur, m, a = x[2], x[3], x[4], x[5], x[6], x[7]
    bend = (uu * vv - uv * uv) * blur * blur / 2
    share = a / max(m, abs(a), 1.0)
    for p in range(J.shape[1]):
        grey, qu, qv = pixels[0, p], pixels[1, p], pixels[2, p]
        su, sv = uu * qu + uv * qv, uv * qu + vv * qv
        rho = np.sqrt(max(qu * su + qv * sv, 1e-12))
        slope = max(np.sqrt(su * su + sv * sv), 1e-12)
        ratio = rho / slope
        d = (1 - rho) * ratio - bend * ratio * ratio / slope
        box = max(abs(su), abs(sv)) / slope / 2
        g = np.sqrt(max(blur * blur - box * box / 3, 0.01))
        left, right = (d + box) / (_ROOT2 * g), (d - box) / (_ROOT2 * g)
        bell_left, bell_right = np.exp(-left * left), np.exp(-right * right)
        erf_left, erf_right = _erf(left, bell_left), _erf(right, bell_right)
        fall = bell_left - bell_right
        value = (left * erf_left - right * erf_right + fall / _ROOT_PI) * (g / (_ROOT2 * box))
        by_d = a * (erf_left - erf_right) / (2 * box) / slope
        J[0, p], J[1, p] = by_d * su, by_d * sv
        J[2, p], J[3, p], J[4, p] = -by_d * qu * qu / 2, -by_d * qu * qv, -by_d * qv * qv / 2
        J[5, p] = a * fall * (_ROOT2 / _ROOT_PI / (2 * box) * (blur / g))
        J[6, p], J[7, p] = 1.0, value
        rise = gradient[0] * qu + gradient[1] * qv
        J[8, p] = grey - m - a * value - rise * (1 + share * value)


@compiled
def _sum_products(
    image: GreyImage, x: Array, gradient: Array, band: float, min_rho: float, out: Array
) -> None:
    """Fill `out` (n, 9, 9)."""
    pixels = np.empty((3, 0))
    for i in range(x.shape[0]):
        uu, uv, vv, blur = x[i, 2], x[i, 3], x[i, 4], x[i, 5]
        longest = max(uu, vv, -uv) / (uu * vv - uv * uv)  # of the entries of S^-1
        half = int(np.ceil(np.sqrt(longest) + band * blur + 2))
        most = min((2 * half + 1) ** 2, image.size)
        if pixels.shape[1] < most:
            pixels = np.empty((3, most))
        count = _list_pixels(image, x[i], half, band * blur + 0.7, min_rho, pixels)
        J = np.empty((9, count))
        _differentiate(x[i], gradient[i], pixels, J)
        gram(J, out[i])


def sum_products(image: GreyImage, x: Array, gradient: Array, band: float, min_rho: float) -> Array:
    """Compute ``detection.circles.ellipse_fit._sum_products``."""
    products = np.empty((len(x), 9, 9))
    _sum_products(
        make_read_only(image),
        make_contiguous(x),
        make_contiguous(gradient),
        band,
        min_rho,
        products,
    )
    return products

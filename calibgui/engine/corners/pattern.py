"""The blurred pattern of two crossing edges.

Where a Gaussian blur of standard deviation g meets a straight edge the grey level follows
erf(d / (sqrt(2) g)) from -1 to 1. A pixel then integrates over its square: across an edge of
normal n like a box of half width h = max |n| / 2 followed by a narrower one, which like all else
is counted as Gaussian. With F(d) = the integral of erf, the blurred edge is

    E(d) = (F(d + h) - F(d - h)) / (2 h),        s^2 = g^2 + h^2 / 3,

and s its blur, pixel included. Where s is well above the pixel the box is counted as Gaussian
too: E(d) = erf(d / (sqrt(2) s)).

Two crossing edges multiply if the blur is isotropic and they are perpendicular. Otherwise the
displacements of the two edges are correlated, and with Plackett's d Phi_2 / d rho = phi_2

    G(d_1, d_2) = E_1 E_2 + 4 phi(x_1) phi(x_2) (rho + rho^2 x_1 x_2 / 2 + ...),  x_i = d_i / s_i,

where rho = n_1.n_2 for isotropic blur. G is 1 in the squares (+, +) and (-, -).

If ink spread or blooming shrinks these two squares by w_i from edge i they become {d_i > w_i} and
{d_i < -w_i}: with e_i = E_i(d_i - w_i), f_i = E_i(d_i + w_i) and 2 phi(x_i) / s_i = E_i'

    2 G = e_1 e_2 + f_1 f_2 + (e_1 - f_1) + (e_2 - f_2) + rho s_1 s_2 (e_1' e_2' + f_1' f_2').

If it grows them, w_i < 0, the other two squares shrink: G(d_1, d_2; w) = -G(d_1, -d_2; -w).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.special import erf

from calibgui.engine.types import Array

_FINEST = 0.1
"""Least Gaussian part of a blur, px."""


class Pattern(NamedTuple):
    """G (n, P) and its derivatives by d_i, by s_i and by rho."""

    value: Array
    by_distance: tuple[Array, Array]
    by_blur: tuple[Array, Array]
    by_correlation: Array


class Edge(NamedTuple):
    """E(d) and its derivatives by d and by the blur, all (n, P)."""

    value: Array
    slope: Array
    by_blur: Array


Pair = tuple[Array, Array]
"""Something of edge 1 and of edge 2."""


def meeting(d: Pair, s: Pair, rho: Array, box: Pair | None) -> Pattern:
    """G at the distances `d` (n, P) from two edges of blurs `s`, correlated by `rho` (n, 1).

    Args:
        box: (n, 1) half widths h of the pixel across either edge; in the blur if None.
    """
    one, two = (edge(d[i], s[i], box and box[i]) for i in (0, 1))
    by_correlation = s[0] * s[1] * one.slope * two.slope
    x1x2 = (d[0] / s[0]) * (d[1] / s[1])
    return Pattern(
        one.value * two.value + by_correlation * (rho + rho * rho / 2 * x1x2),
        (one.slope * two.value, one.value * two.slope),
        (one.by_blur * two.value, one.value * two.by_blur),
        by_correlation,
    )


def spread(d: Pair, s: Pair, rho: Array, box: Pair | None, w: Pair) -> Pattern:
    """G where the squares (+, +) and (-, -) have shrunk by `w` (n, P) px on every side."""
    mirror = np.where(w[0][:, :1] < 0, -1.0, 1.0)
    shrunk = (d[0], mirror * d[1])
    e1, e2 = (edge(shrunk[i] - abs(w[i]), s[i], box and box[i]) for i in (0, 1))
    f1, f2 = (edge(shrunk[i] + abs(w[i]), s[i], box and box[i]) for i in (0, 1))
    by_correlation = s[0] * s[1] * (e1.slope * e2.slope + f1.slope * f2.slope) / 2
    half = 0.5 * mirror
    both = e1.value * e2.value + f1.value * f2.value
    alone = (e1.value - f1.value) + (e2.value - f2.value)
    return Pattern(
        half * (both + alone) + rho * by_correlation,
        (
            half * (e1.slope * (e2.value + 1) + f1.slope * (f2.value - 1)),
            0.5 * (e2.slope * (e1.value + 1) + f2.slope * (f1.value - 1)),
        ),
        (
            half * (e1.by_blur * (e2.value + 1) + f1.by_blur * (f2.value - 1)),
            half * (e2.by_blur * (e1.value + 1) + f2.by_blur * (f1.value - 1)),
        ),
        by_correlation,
    )


def edge(d: Array, s: Array, box: Array | None = None) -> Edge:
    """E at the distance `d` (n, P) from an edge of blur `s`, (n, P) or (n, 1)."""
    if box is None:
        x = d / (np.sqrt(2.0) * s)
        slope = np.exp(-x * x) * (np.sqrt(2.0 / np.pi) / s)
        return Edge(erf(x), slope, -d / s * slope)
    g = np.sqrt(np.maximum(s * s - box * box / 3, _FINEST**2))
    a, b = ((d + h) / (np.sqrt(2.0) * g) for h in (box, -box))
    erf_a, erf_b = erf(a), erf(b)
    exp_a, exp_b = np.exp(-a * a), np.exp(-b * b)
    rise = (exp_a - exp_b) / np.sqrt(np.pi)
    value = ((a * erf_a - b * erf_b) + rise) * (g / (np.sqrt(2.0) * box))
    slope = (erf_a - erf_b) / (2 * box)
    # dF/dg = sqrt(2 / pi) exp(-d^2 / 2 g^2) and dg/ds = s / g.
    by_blur = (exp_a - exp_b) * (np.sqrt(2.0 / np.pi) / (2 * box)) * (s / g)
    return Edge(value, slope, by_blur)

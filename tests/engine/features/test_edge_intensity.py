"""The blurred pattern against numerical integration and central differences."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter
from scipy.special import erf

from calibgui.engine.features.edge_intensity import (
    CrossingIntensity,
    Floats,
    compute_crossing,
    compute_edge,
    compute_spread_crossing,
)

D = np.linspace(-3, 3, 25)
D1, D2 = (grid.reshape(1, -1) for grid in np.meshgrid(D, D))


def column(value: float) -> Floats:
    return np.array([[value]])


def test_edge_is_the_error_function() -> None:
    np.testing.assert_allclose(
        compute_edge(D[None], column(0.8)).value[0], erf(D / 0.8 / 2**0.5), atol=2e-7
    )


def test_edge_of_a_sharp_pixel_is_a_ramp() -> None:
    ramp = np.clip(2 * D, -1, 1)
    value = compute_edge(D[None], column(0.31), column(0.5)).value[0]
    np.testing.assert_allclose(value, ramp, atol=0.17)
    np.testing.assert_allclose(value[abs(D) > 0.8], ramp[abs(D) > 0.8], atol=1e-6)


def pattern(
    kind: str, d1: Floats, d2: Floats, s1: float, s2: float, rho: float
) -> CrossingIntensity:
    s, r, box = (column(s1), column(s2)), column(rho), (column(0.4), column(0.5))
    if kind == "meeting":
        return compute_crossing((d1, d2), s, r, None)
    if kind == "sharp":
        return compute_crossing((d1, d2), s, r, box)
    w = 0.7 if kind == "shrunk" else -0.7
    return compute_spread_crossing((d1, d2), s, r, None, (column(w), column(1.2 * w)))


@pytest.mark.parametrize("kind", ["meeting", "sharp", "shrunk", "grown"])
def test_derivatives_against_central_differences(kind: str) -> None:
    h = 1e-4
    s1, s2 = 0.8, 1.1

    def by(**change: float) -> Any:
        # Uncorrelated: the derivative of the correction by distance and blur is left out.
        up, down = (
            pattern(
                kind,
                D1 + k * change.get("d1", 0),
                D2 + k * change.get("d2", 0),
                s1 + k * change.get("s1", 0),
                s2 + k * change.get("s2", 0),
                k * change.get("rho", 0),
            ).value
            for k in (h, -h)
        )
        return (up - down) / (2 * h)

    P = pattern(kind, D1, D2, s1, s2, 0.0)
    # erf itself is good to 1.5e-7, hence its differences over 2e-4 to 2e-3.
    np.testing.assert_allclose(P.by_distance[0], by(d1=1.0), atol=4e-3)
    np.testing.assert_allclose(P.by_distance[1], by(d2=1.0), atol=4e-3)
    np.testing.assert_allclose(P.by_blur[0], by(s1=1.0), atol=4e-3)
    np.testing.assert_allclose(P.by_blur[1], by(s2=1.0), atol=4e-3)
    np.testing.assert_allclose(P.by_correlation, by(rho=1.0), atol=1e-6)


@pytest.mark.parametrize("skew", [0.0, 0.5])
@pytest.mark.parametrize("w", [0.0, 1.5, -1.5])
def test_pattern_is_the_blurred_drawing(skew: float, w: float) -> None:
    """Against a finely drawn crossing, blurred numerically, of perpendicular and skewed edges."""
    fine, sigma = 0.05, 0.9
    u, v = np.meshgrid(np.arange(-8, 8, fine), np.arange(-8, 8, fine))
    n1, n2 = np.array([0.0, 1.0]), np.array([np.sqrt(1 - skew**2), skew])
    d1, d2 = (n[0] * u + n[1] * v for n in (n1, n2))
    a = abs(w)
    same, other = (
        ((d1 > a) & (sign * d2 > a)) | ((d1 < -a) & (sign * d2 < -a)) for sign in (1, -1)
    )
    drawn = 2.0 * same - 1 if w >= 0 else 1 - 2.0 * other
    blurred = gaussian_filter(drawn, sigma / fine)[::8, ::8]
    at = (d1[::8, ::8].reshape(1, -1), d2[::8, ::8].reshape(1, -1))
    s, rho = (column(sigma), column(sigma)), column(skew)
    if w == 0:
        model = compute_crossing(at, s, rho, None).value
    else:
        model = compute_spread_crossing(at, s, rho, None, (column(w), column(w))).value
    inner = (np.hypot(u, v) < 5)[::8, ::8].ravel()
    np.testing.assert_allclose(model[0][inner], blurred.ravel()[inner], atol=0.06)

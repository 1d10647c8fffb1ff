"""Rational lenses whose numerator and denominator nearly vanish together have all of their rays.

Calibrations with eight free coefficients end there. The quotient grows everywhere all the same.
"""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays, rays_from_pixels


def make_camera(seed: int) -> tuple[Camera, float]:
    """Make a camera, and the r at which both polynomials are least."""
    rng = np.random.default_rng(seed)
    where, least = rng.uniform(0.2, 0.45), 10.0 ** rng.uniform(-4, -2.5)
    s = np.polynomial.Polynomial([0.0, 1 / where**2])
    over = ((1 - s) ** 2 + least) * (1 + rng.uniform(-0.01, 0.01) * s)
    under = ((1 - s) ** 2 + least * (1 + np.sqrt(least) * rng.uniform(-0.5, 0.5))) * (1 + 0.01 * s)
    k = {f"k{n}": over.coef[n] / over.coef[0] for n in (1, 2, 3)}
    k |= {f"k{n + 3}": under.coef[n] / under.coef[0] for n in (1, 2, 3)}
    values = {"fx": 1800.0, "fy": 1810.0, "cx": 640.0, "cy": 480.0} | k
    names = ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6", "skew")
    return Camera((1296, 972), [values.get(name, 0.0) for name in names], "rational"), where


@pytest.mark.parametrize("seed", range(12))
def test_every_pixel_has_its_ray(seed: int) -> None:
    camera, where = make_camera(seed)
    r = np.linspace(0, 0.5, 20_001)
    rays = np.column_stack([r, np.zeros_like(r), np.ones_like(r)])
    u = pixels_from_rays(rays, camera)[:, 0]
    assert (np.diff(u) > 0).all(), "the lens of the test folds"
    angle = np.linspace(0, 2 * np.pi, 60)
    radius = np.linspace(where - 0.02, where + 0.02, 41)
    x, y = (np.outer(radius, each(angle)).ravel() for each in (np.cos, np.sin))
    seen = pixels_from_rays(np.column_stack([x, y, np.ones_like(x)]), camera)
    back = rays_from_pixels(seen, camera)
    np.testing.assert_allclose(back[:, :2] / back[:, 2:], np.column_stack([x, y]), atol=1e-8)

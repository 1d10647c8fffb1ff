"""Circles of whose edge a part is disturbed."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array, BoolArray
from calibgui.engine.detection.circles.arc_fit import ArcFit, fit_arcs

_CENTRE = np.array([40.3, 39.6])
_SPREAD = np.array([[225.0, 40.0], [40.0, 120.0]])


def _draw(light: Array, seed: int, covered: BoolArray | None = None) -> Array:
    """Draw a dark ellipse, blurred and noisy, in a `light` (80, 80), with what covers it."""
    side = (np.arange(80 * 4) + 0.5) / 4 - 0.5
    q = np.stack(np.meshgrid(side, side), axis=-1) - _CENTRE
    inside = np.einsum("...i,ij,...j", q, np.linalg.inv(_SPREAD), q) < 1
    ink = inside.reshape(80, 4, 80, 4).mean(axis=(1, 3))
    image = (200 - 150 * ink) * light
    if covered is not None:
        image[covered] = 120.0
    for axis in (0, 1):
        image = sum(np.roll(image, k, axis) * w for k, w in ((-1, 0.25), (0, 0.5), (1, 0.25)))
    noise = np.random.default_rng(seed).normal(0, 2.0, image.shape)
    return np.asarray(np.clip(np.rint(image + noise), 0, 255))


def _fit(image: Array) -> ArcFit:
    """Fit it from a start that is 0.6 px off."""
    start = _CENTRE[None] + np.array([0.5, -0.3])
    return fit_arcs(
        image.astype(np.uint8), start, _SPREAD[None], np.array([12.0]), 0.8, are_bright=False
    )


@pytest.mark.parametrize("dark", [1.0, 0.5, 0.125])
def test_a_shadow_across_it_does_not_draw_the_centre_aside(dark: float) -> None:
    v, u = np.indices((80, 80))
    square = []
    for seed in range(12):
        across = (u - 40) * np.cos(seed) + (v - 40) * np.sin(seed)
        fit = _fit(_draw(np.where(across > 3 - seed / 3, 1.0, dark), seed))
        assert fit.is_told.all()
        off = (fit.uv - _CENTRE)[0]
        assert np.hypot(*off) < 0.15
        square.append(off @ np.linalg.solve(fit.covariance[0], off) / 2)
    assert np.mean(square) < 2


def test_of_a_circle_that_is_half_covered_too_little_is_seen() -> None:
    u = np.indices((80, 80))[1]
    assert not _fit(_draw(np.ones((80, 80)), 0, covered=u > 40)).is_told.any()
    little = _fit(_draw(np.ones((80, 80)), 0, covered=u > 50))
    assert little.is_told.all() and np.hypot(*(little.uv - _CENTRE)[0]) < 0.15


def test_a_circle_of_another_size_is_none() -> None:
    fit = fit_arcs(
        _draw(np.ones((80, 80)), 0).astype(np.uint8),
        _CENTRE[None],
        1.5 * _SPREAD[None],
        np.array([12.0]),
        0.8,
        are_bright=False,
    )
    assert not fit.is_told.any()

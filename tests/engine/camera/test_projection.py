"""Pixels and rays: derivatives, round trips, and OpenCV on its own model."""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from calibgui.engine.arrays import Array
from calibgui.engine.camera.model import Lens
from calibgui.engine.camera.models import MODELS
from calibgui.engine.camera.models.brown_conrady import BrownConrady
from calibgui.engine.camera.projection import (
    Projected,
    lens_scale,
    pixels_from_rays,
    project,
    rays_and_slopes,
    rays_from_pixels,
    unproject,
)
from tests.engine.scenes import brown, central_differences, example, relative

Mapping = Callable[[Array, Array, Lens], Projected]
GRID = np.stack(np.meshgrid(np.linspace(0, 639, 9), np.linspace(0, 479, 7)), axis=-1)


@pytest.mark.parametrize("aspect", [1.0, 0.8])
@pytest.mark.parametrize("model", list(MODELS))
def test_derivatives_against_differences(model: str, aspect: float) -> None:
    lens, p = MODELS[model], np.array(example(model, aspect).params)
    n = unproject(GRID, p, lens).points
    # h is 3e-4 of the scales, short because the inverse bends sharply where it nears its fold;
    # that leaves 1e-10 of truncation, and 2e-9 of rounding in pixels.
    step = np.concatenate([np.full(4, 0.2), np.full(len(p) - 4, 3e-4)])
    for mapping, points, h in ((unproject, GRID, 0.2), (project, n, 3e-4)):
        mapped = mapping(points, p, lens)

        def at(e: Array, mapping: Mapping = mapping, points: Array = points) -> Array:
            return mapping(points + e, p, lens).points

        def by(q: Array, mapping: Mapping = mapping, points: Array = points) -> Array:
            return mapping(points, q, lens).points

        assert relative(mapped.by_point, central_differences(at, np.zeros(2), h)) < 1e-8
        numeric = central_differences(by, p, step)
        for i in range(len(p)):
            assert relative(mapped.by_params[..., i], numeric[..., i]) < 1e-8


@given(st.sampled_from(list(MODELS)), st.floats(0.7, 1.4))
def test_pixels_and_rays_are_inverse(model: str, aspect: float) -> None:
    camera = example(model, aspect)
    np.testing.assert_allclose(
        pixels_from_rays(rays_from_pixels(GRID, camera), camera), GRID, atol=1e-9
    )


@pytest.mark.parametrize("model", list(MODELS))
def test_rays_with_their_slope_are_those_of_normalise(model: str) -> None:
    camera = example(model, 0.9)
    expected = unproject(GRID, camera.params, MODELS[model])
    n, by_uv = rays_and_slopes(GRID, camera)
    np.testing.assert_allclose(n, expected.points, rtol=1e-15)
    np.testing.assert_allclose(by_uv, expected.by_point, rtol=1e-14)


def test_opencv_projects_alike() -> None:
    camera = brown(0.9)
    n = np.random.default_rng(0).uniform(-0.4, 0.4, size=(30, 2))
    expected = cv2.projectPoints(
        np.column_stack([n, np.ones(30)]),
        np.zeros(3),
        np.zeros(3),
        camera.matrix,
        np.array(camera.coefficients),
    )[0].reshape(-1, 2)
    np.testing.assert_allclose(pixels_from_rays(n, camera), expected, atol=1e-10)


def test_square_pixels_make_the_printed_radius_the_same() -> None:
    p = example("lucchese").params
    a = unproject(GRID, p, MODELS["lucchese"]).points
    b = unproject(GRID, p, MODELS["lucchese-pixels"]).points
    np.testing.assert_allclose(a, b, atol=1e-15)


def test_the_printed_radius_is_in_pixels() -> None:
    """Eq. 9 with k1 only, in pixels, against the model that measures d in fx along both axes."""
    p = np.array([650.0, 500.0, 310.0, 240.0, 0.2, 0, 0, 0, 0, 0])
    uv = np.array([600.0, 60.0])
    dx, dy = uv - p[2:4]
    r2 = dx**2 + dy**2
    psi = np.array([dx, dy]) * (1 + 0.2 / 650.0**2 * r2)
    got = unproject(uv, p, MODELS["lucchese-pixels"]).points
    np.testing.assert_allclose(got, psi / p[:2], atol=1e-15)


def test_lens_scale_is_linear_in_the_focal_lengths() -> None:
    f = np.array([650.0, 500.0])
    np.testing.assert_array_equal(lens_scale(BrownConrady(), f)[0], f)
    np.testing.assert_array_equal(lens_scale(MODELS["lucchese-pixels"], f)[0], [650.0, 650.0])

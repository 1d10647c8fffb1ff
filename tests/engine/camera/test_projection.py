"""Pixels and rays: derivatives, round trips, and OpenCV on its own model."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from calibgui.engine.arrays import Array
from calibgui.engine.camera.models import find_model
from calibgui.engine.camera.projection import (
    pixels_from_rays,
    project,
    rays_and_slopes,
    rays_from_pixels,
    unproject,
)
from tests.engine.scenes import LENSES, brown, central_differences, example, relative

GRID = np.stack(np.meshgrid(np.linspace(0, 639, 9), np.linspace(0, 479, 7)), axis=-1)


@pytest.mark.parametrize("aspect", [1.0, 0.8])
@pytest.mark.parametrize("model", list(LENSES))
def test_derivatives_against_differences(model: str, aspect: float) -> None:
    lens, p = find_model(model), np.array(example(model, aspect).params)
    rays = unproject(GRID, p, lens).rays
    # h is 3e-4 of the scales, short because the inverse bends sharply where it nears its fold;
    # that leaves 1e-10 of truncation, and 2e-9 of rounding in pixels.
    step = np.concatenate([np.full(4, 0.2), np.full(len(p) - 4, 3e-4)])

    def project_at(e: Array) -> Array:
        return project(rays + e, p, lens).points

    def unproject_at(e: Array) -> Array:
        return unproject(GRID + e, p, lens).rays

    projected, seen = project(rays, p, lens), unproject(GRID, p, lens)
    numeric = central_differences(project_at, np.zeros(3), 3e-4)
    assert relative(projected.by_ray, numeric) < 1e-8
    assert relative(seen.by_point, central_differences(unproject_at, np.zeros(2), 0.2)) < 1e-8
    by_params = central_differences(lambda q: project(rays, q, lens).points, p, step)
    back_by_params = central_differences(lambda q: unproject(GRID, q, lens).rays, p, step)
    for i in range(len(p)):
        assert relative(projected.by_params[..., i], by_params[..., i]) < 1e-8
        assert relative(seen.by_params[..., i], back_by_params[..., i]) < 1e-8


@pytest.mark.parametrize("model", list(LENSES))
def test_the_length_of_a_ray_does_not_matter(model: str) -> None:
    camera = example(model, 0.8)
    rays = rays_from_pixels(GRID, camera)
    np.testing.assert_allclose(np.linalg.norm(rays, axis=-1), 1.0, rtol=1e-14)
    projected = project(3.7 * rays, camera.params, find_model(model))
    np.testing.assert_allclose(projected.points, GRID, atol=1e-9)
    along = (projected.by_ray @ rays[..., None])[..., 0]
    np.testing.assert_allclose(along, 0.0, atol=1e-9)


@given(st.sampled_from(list(LENSES)), st.floats(0.7, 1.4))
def test_pixels_and_rays_are_inverse(model: str, aspect: float) -> None:
    camera = example(model, aspect)
    np.testing.assert_allclose(
        pixels_from_rays(rays_from_pixels(GRID, camera), camera), GRID, atol=1e-9
    )


@pytest.mark.parametrize("model", list(LENSES))
def test_the_short_forms_are_the_long_ones(model: str) -> None:
    camera = example(model, 0.9)
    lens = find_model(model)
    expected = unproject(GRID, camera.params, lens)
    rays, by_uv = rays_and_slopes(GRID, camera)
    np.testing.assert_allclose(rays, expected.rays, rtol=1e-15)
    np.testing.assert_allclose(by_uv, expected.by_point, rtol=1e-14, atol=1e-18)
    uv = pixels_from_rays(rays, camera)
    np.testing.assert_allclose(uv, project(rays, camera.params, lens).points, rtol=1e-15)


def test_opencv_projects_alike() -> None:
    camera = brown(0.9)
    n = np.random.default_rng(0).uniform(-0.4, 0.4, size=(30, 2))
    expected = cv2.projectPoints(
        np.column_stack([n, np.ones(30)]),
        np.zeros(3),
        np.zeros(3),
        camera.matrix,
        np.array(camera.coefficients[:5]),
    )[0].reshape(-1, 2)
    rays = np.column_stack([n, np.ones(30)])
    np.testing.assert_allclose(pixels_from_rays(rays, camera), expected, atol=1e-10)


def test_square_pixels_make_the_printed_radius_the_same() -> None:
    p = example("lucchese").params
    a = unproject(GRID, p, find_model("lucchese")).rays
    b = unproject(GRID, p, find_model("lucchese-pixels")).rays
    np.testing.assert_allclose(a, b, atol=1e-15)


def test_the_printed_radius_is_in_pixels() -> None:
    """Eq. 9 with k1 only, in pixels, against the model that measures d in fx along both axes."""
    p = np.array([650.0, 500.0, 310.0, 240.0, 0.2, 0, 0, 0, 0, 0])
    uv = np.array([600.0, 60.0])
    dx, dy = uv - p[2:4]
    r2 = dx**2 + dy**2
    psi = np.array([dx, dy]) * (1 + 0.2 / 650.0**2 * r2)
    x, y, z = unproject(uv, p, find_model("lucchese-pixels")).rays
    np.testing.assert_allclose([x / z, y / z], psi / p[:2], atol=1e-15)

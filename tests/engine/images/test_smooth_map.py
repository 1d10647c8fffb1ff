"""Interpolated maps against the map itself."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from calibgui.engine.arrays import Array, Size
from calibgui.engine.camera.distortion import distort_points
from calibgui.engine.images.smooth_map import MAP_TOLERANCE_PX, interpolate_map
from tests.engine.scenes import barrel

EVERYWHERE = np.full(2, -np.inf), np.full(2, np.inf)


def pixels(size: Size) -> Array:
    return np.stack(np.meshgrid(*map(np.arange, size)), axis=-1).astype(float)


def test_cubics_are_exact() -> None:
    def source(p: Array) -> Array:
        u, v = p[..., 0] / 100, p[..., 1] / 100
        return np.stack([u**3 - 2 * v**3 + u * v, 5 + u**2 * v], axis=-1)

    rows = interpolate_map((130, 77), source, *EVERYWHERE)
    np.testing.assert_allclose(rows(slice(0, 77)), source(pixels((130, 77))), atol=1e-12)


@given(st.integers(1, 200), st.integers(1, 150), st.floats(3, 300))
def test_error_is_within_the_tolerance(width: int, height: int, wavelength: float) -> None:
    def source(p: Array) -> Array:
        return p + 2 * np.sin(p[..., ::-1] / wavelength)

    rows = interpolate_map((width, height), source, *EVERYWHERE)(slice(0, height))
    assert rows.shape == (height, width, 2)
    assert np.abs(rows - source(pixels((width, height)))).max() < 1.5 * MAP_TOLERANCE_PX


def test_a_lens_needs_few_knots() -> None:
    evaluated = 0
    camera = barrel()

    def source(p: Array) -> Array:
        nonlocal evaluated
        evaluated += p.size // 2
        return distort_points(p, camera)

    rows = interpolate_map(camera.size, source, *EVERYWHERE)
    error = np.abs(rows(slice(100, 110)) - distort_points(pixels(camera.size)[100:110], camera))
    assert error.max() < MAP_TOLERANCE_PX
    assert evaluated < 640 * 480 / 20


def test_rows_do_not_depend_on_the_band() -> None:
    rows = interpolate_map((64, 50), lambda p: p + np.sin(p / 9), *EVERYWHERE)
    np.testing.assert_array_equal(rows(slice(0, 50))[7:31], rows(slice(7, 31)))


@pytest.mark.parametrize("radius", [20.0, 45.3, 200.0])
def test_the_edge_of_the_domain_is_kept(radius: float) -> None:
    def source(p: Array) -> Array:
        inside = np.hypot(p[..., 0] - 60, p[..., 1] - 50) < radius
        return np.where(inside[..., None], p * (1 + 1e-4 * p), np.nan)

    rows = interpolate_map((120, 100), source, *EVERYWHERE)(slice(0, 100))
    np.testing.assert_allclose(
        rows, source(pixels((120, 100))), atol=MAP_TOLERANCE_PX, equal_nan=True
    )


def test_only_what_is_wanted_is_solved() -> None:
    def source(p: Array) -> Array:
        return np.where(p > 80, p + np.sin(p), p)

    rows = interpolate_map((128, 128), source, np.zeros(2), np.full(2, 60.0))(slice(0, 128))
    np.testing.assert_allclose(rows[:61, :61], pixels((61, 61)), atol=1e-12)
    assert np.isnan(rows[100:, 100:]).all()


def test_a_cell_that_spans_the_rectangle_is_solved() -> None:
    rows = interpolate_map(
        (9, 9), lambda p: 1000 * (p - 4.25), np.full(2, -300.0), np.full(2, 300.0)
    )
    np.testing.assert_allclose(rows(slice(0, 9))[4, 4], [-250, -250], atol=1e-9)


def test_a_kink_costs_only_its_cells() -> None:
    evaluated = 0

    def source(p: Array) -> Array:
        nonlocal evaluated
        evaluated += p.size // 2
        return np.abs(p - 250.3)

    rows = interpolate_map((640, 480), source, *EVERYWHERE)(slice(0, 480))
    np.testing.assert_allclose(rows, np.abs(pixels((640, 480)) - 250.3), atol=1e-9)
    assert evaluated < 640 * 480 / 4

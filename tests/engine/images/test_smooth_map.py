"""Interpolated maps against the map itself."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from calibgui.engine.arrays import Array, Size
from calibgui.engine.camera.distortion import distort_points
from calibgui.engine.images.smooth_map import MAP_TOLERANCE_PX, Source, interpolate_map
from tests.engine.scenes import barrel

EVERYWHERE = np.full(2, -np.inf), np.full(2, np.inf)


def interpolated(size: Size, source: Source, low: Array, high: Array) -> Array:
    """The whole map (height, width, 2)."""
    rows = interpolate_map(size, source, low, high)
    return np.moveaxis(rows(slice(0, size[1])), 0, -1).astype(float)


def pixels(size: Size) -> Array:
    return np.stack(np.meshgrid(*map(np.arange, size)), axis=-1).astype(float)


def test_cubics_are_exact() -> None:
    def source(p: Array) -> Array:
        u, v = p[..., 0] / 100, p[..., 1] / 100
        return np.stack([u**3 - 2 * v**3 + u * v, 5 + u**2 * v], axis=-1)

    made = interpolated((130, 77), source, *EVERYWHERE)
    np.testing.assert_allclose(made, source(pixels((130, 77))), rtol=5e-7, atol=1e-6)


@given(st.integers(1, 200), st.integers(1, 150), st.floats(3, 300))
def test_error_is_within_the_tolerance(width: int, height: int, wavelength: float) -> None:
    def source(p: Array) -> Array:
        return p + 2 * np.sin(p[..., ::-1] / wavelength)

    rows = interpolated((width, height), source, *EVERYWHERE)
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
    made = np.moveaxis(rows(slice(100, 110)), 0, -1)
    error = np.abs(made - distort_points(pixels(camera.size)[100:110], camera))
    assert error.max() < MAP_TOLERANCE_PX
    assert evaluated < 640 * 480 / 20


def test_rows_do_not_depend_on_the_band() -> None:
    rows = interpolate_map((64, 50), lambda p: p + np.sin(p / 9), *EVERYWHERE)
    np.testing.assert_array_equal(rows(slice(0, 50))[:, 7:31], rows(slice(7, 31)))


@pytest.mark.parametrize("radius", [20.0, 45.3, 200.0])
def test_the_edge_of_the_domain_is_kept(radius: float) -> None:
    def source(p: Array) -> Array:
        inside = np.hypot(p[..., 0] - 60, p[..., 1] - 50) < radius
        return np.where(inside[..., None], p * (1 + 1e-4 * p), np.nan)

    rows = interpolated((120, 100), source, *EVERYWHERE)
    np.testing.assert_allclose(
        rows, source(pixels((120, 100))), atol=MAP_TOLERANCE_PX, equal_nan=True
    )


def test_only_what_is_wanted_is_solved() -> None:
    def source(p: Array) -> Array:
        return np.where(p > 80, p + np.sin(p), p)

    rows = interpolated((128, 128), source, np.zeros(2), np.full(2, 60.0))
    np.testing.assert_allclose(rows[:61, :61], pixels((61, 61)), atol=1e-5)
    assert np.isnan(rows[100:, 100:]).all()


def test_a_cell_that_spans_the_rectangle_is_solved() -> None:
    rows = interpolated((9, 9), lambda p: 1000 * (p - 4.25), np.full(2, -300.0), np.full(2, 300.0))
    np.testing.assert_allclose(rows[4, 4], [-250, -250], atol=1e-3)


def test_a_kink_costs_only_its_cells() -> None:
    evaluated = 0

    def source(p: Array) -> Array:
        nonlocal evaluated
        evaluated += p.size // 2
        return np.abs(p - 250.3)

    rows = interpolated((640, 480), source, *EVERYWHERE)
    np.testing.assert_allclose(rows, np.abs(pixels((640, 480)) - 250.3), atol=1e-4)
    assert evaluated < 640 * 480 / 4


def test_the_edge_of_the_domain_bulges_into_cells_without_a_sample() -> None:
    """A disc's top reaches 2 px over a row of knots between two of them: no pixel is lost."""

    def source(p: Array) -> Array:
        inside = np.hypot(p[..., 0] - 976, p[..., 1] - 698) <= 60.0
        return np.where(inside[..., None], p * (1 + 1e-5 * p), np.nan)

    size = (2048, 1536)
    made = interpolated(size, source, np.zeros(2), np.full(2, 5000.0))
    np.testing.assert_allclose(made, source(pixels(size)), atol=MAP_TOLERANCE_PX, equal_nan=True)


def test_the_edge_of_the_rectangle_bulges_into_cells_without_a_sample() -> None:
    """What is wanted is a disc whose top reaches 3 px over a row of knots, between two of them."""

    def source(p: Array) -> Array:
        r2 = (p[..., 0] - 2112) ** 2 + (p[..., 1] - 1536) ** 2
        return np.stack([r2 / 1000, np.zeros_like(r2)], axis=-1)

    high = np.array([643.0**2 / 1000, 1.0])
    rows_of = interpolate_map((4096, 3072), source, np.array([-1.0, -1.0]), high)
    at_top = np.stack(np.meshgrid(np.arange(4096.0), np.arange(885.0, 900.0)), axis=-1)
    exact = source(at_top)
    is_wanted = (exact <= high).all(axis=-1)
    made = np.moveaxis(rows_of(slice(885, 900)), 0, -1)
    assert is_wanted[10].any()
    np.testing.assert_allclose(made[is_wanted], exact[is_wanted], atol=MAP_TOLERANCE_PX)


def test_a_small_domain_does_not_fall_between_the_knots() -> None:
    def source(p: Array) -> Array:
        inside = np.hypot(p[..., 0] - 30, p[..., 1] - 90) < 20.0
        return np.where(inside[..., None], p, np.nan)

    made = interpolated((500, 300), source, *EVERYWHERE)
    np.testing.assert_allclose(
        made, source(pixels((500, 300))), atol=MAP_TOLERANCE_PX, equal_nan=True
    )

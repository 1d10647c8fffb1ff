"""The compiled lens models of rays in all directions against the readable ones."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine import kernels
from calibgui.engine.arrays import Array
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.observations import (
    Observation,
    Observations,
    pack_observations,
)
from calibgui.engine.calibration.refinement import residuals
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.refinement.schur import NormalEquations
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import MODELS
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.geometry.rotations import rotation_from_vector
from tests.engine.kernels.test_normal_equations import RAY_CAMERAS

pytest.importorskip("numba", reason="numba is not installed")

from calibgui.engine.kernels import ray_lenses
from calibgui.engine.kernels.cameras import find_rows, pack_camera
from tests.engine.kernels.conftest import make_callable

compute_angle, image_kannala_brandt, image_unified = map(
    make_callable,
    (ray_lenses.compute_angle, ray_lenses.image_kannala_brandt, ray_lenses.image_unified),
)


def make_points() -> Array:
    """(3, N) points on the axis, near it, at and beyond 90 degrees, mm."""
    degrees = np.array([0.0, 1e-9, 1e-3, 10.0, 44.0, 46.0, 80.0, 89.9999999, 90.0, 100.0, 110.0])
    theta, phi = np.deg2rad(degrees), 0.5 + np.arange(len(degrees))
    Z = np.where(degrees == 90, 0.0, np.cos(theta))
    length = np.linspace(20, 900, len(degrees))
    return length * np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), Z])


@pytest.mark.parametrize("model", RAY_CAMERAS)
def test_images_and_derivatives_are_the_readable_ones(model: str) -> None:
    image = image_kannala_brandt if model.startswith("kannala-brandt") else image_unified
    points, params = make_points(), RAY_CAMERAS[model].params
    N = points.shape[1]
    d, G, F = np.empty((2, N)), np.empty((6, N)), np.zeros((17, 2 * N))
    assert image(pack_camera(model, params).camera, points, d, G, np.empty((4, N)), F)

    expected = MODELS[model].project(points.T, params[4:])
    np.testing.assert_allclose(d.T, expected.points, atol=1e-14)
    slopes = expected.by_ray.reshape(N, 6) * np.linalg.norm(points, axis=0)[:, None]
    np.testing.assert_allclose(G.T * np.linalg.norm(points, axis=0)[:, None], slopes, atol=1e-13)
    rows = find_rows(model, np.arange(4, len(params)))
    by_k = F[rows].reshape(-1, 2, N) / params[:2, None]
    np.testing.assert_allclose(
        by_k, np.moveaxis(expected.by_coefficients, 0, -1).swapaxes(0, 1), rtol=1e-12, atol=1e-13
    )


def look_sideways(model: str) -> tuple[State, Observations]:
    """A board from 40 to 115 degrees off the axis, with 0.5 px of noise."""
    camera, xy = RAY_CAMERAS[model], Board(6, 7, 30.0).points()
    R = rotation_from_vector(np.array([[0.0, 1.2, 0.0]]))
    T = np.array([[80.0, -75.0, 100.0]])
    points = xy @ R[0, :, :2].T + T[0]
    assert points[:, 2].min() < -50
    uv = pixels_from_rays(points, camera)
    uv += np.random.default_rng(1).normal(0, 0.5, uv.shape)
    return State(np.array(camera.params), R, T), pack_observations([Observation(uv, xy)])


@pytest.mark.parametrize("model", RAY_CAMERAS)
def test_a_board_beyond_90_degrees_is_the_readable_one(
    model: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    state, observations = look_sideways(model)
    free = np.arange(len(state.params))

    def compute() -> tuple[NormalEquations, tuple[Array, Array]]:
        return (
            residuals.build_stage_two(observations, model, Cost.IMAGE, 1.0, free)(state),
            residuals.compute_residuals(state, observations, model, Cost.IMAGE),
        )

    compiled, ours = compute()
    monkeypatch.setattr(kernels, "COMPILED", False)
    readable, theirs = compute()
    for name in ("U", "W", "V", "shared", "pose", "cost"):
        truth = getattr(readable, name)
        assert np.isfinite(truth).all()
        np.testing.assert_allclose(
            getattr(compiled, name), truth, rtol=1e-9, atol=1e-11 * np.abs(truth).max()
        )
    for found, truth in zip(ours, theirs, strict=True):
        assert np.isfinite(truth).all()
        np.testing.assert_allclose(found, truth, atol=1e-10)


@pytest.mark.parametrize("model", RAY_CAMERAS)
def test_a_measured_corner_that_no_ray_reaches_leaves_its_view_to_the_readable_code(
    model: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    state, observations = look_sideways(model)
    uv = observations.uv.copy()
    uv[0, 3] = 1e5
    observations = replace(observations, uv=uv)
    seen, registered = residuals.compute_residuals(state, observations, model, Cost.IMAGE)
    monkeypatch.setattr(kernels, "COMPILED", False)
    truth = residuals.compute_residuals(state, observations, model, Cost.IMAGE)
    assert np.isnan(truth[1][0, 3]).all()
    np.testing.assert_allclose(seen, truth[0], atol=1e-9)
    np.testing.assert_allclose(registered, truth[1], atol=1e-9)


@pytest.mark.parametrize("model", RAY_CAMERAS)
def test_a_point_that_no_lens_sees_is_reported(model: str) -> None:
    image = image_kannala_brandt if model.startswith("kannala-brandt") else image_unified
    points = np.array([[0.0, 100.0], [0.0, 0.0], [-500.0, 500.0]])
    d, G, F = np.empty((2, 2)), np.empty((6, 2)), np.zeros((11, 4))
    camera = pack_camera(model, RAY_CAMERAS[model].params).camera
    assert not image(camera, points, d, G, np.empty((4, 2)), F)


def test_the_near_side_of_a_shifted_sphere_is_not_seen() -> None:
    """From outside of the sphere, xi > 1, rays up to acos(-1 / xi) = 109 degrees are seen."""
    d, G, F = np.empty((2, 1)), np.empty((6, 1)), np.zeros((11, 2))
    camera = pack_camera("double-sphere", np.array([450, 420, 310, 250, 3.07, 0.02])).camera
    for degrees, seen in ((108.0, True), (110.0, False)):
        theta = np.deg2rad(degrees)
        point = np.array([[np.sin(theta)], [0.0], [np.cos(theta)]])
        assert image_unified(camera, point, d, G, np.empty((4, 1)), F) == seen


def test_rays_beyond_the_fold_are_left_to_the_readable_code() -> None:
    """theta - theta^3 / 12 has its maximum at 2 rad, and the board lies beyond. Its corners have
    images, whose rays are those before the maximum and meet the board's plane elsewhere."""
    camera = Camera((640, 480), [450, 420, 310, 250, -1 / 12, 0, 0, 0], "kannala-brandt")
    xy = Board(3, 3, 30.0).points()
    state = State(np.array(camera.params), np.eye(3)[None], np.array([[300.0, 0.0, -250.0]]))
    uv = pixels_from_rays(np.column_stack([xy, np.zeros(9)]) + state.T, camera)
    observations = pack_observations([Observation(uv, xy)])
    seen, registered = residuals.compute_residuals(
        state, observations, "kannala-brandt", Cost.IMAGE
    )
    np.testing.assert_allclose(seen, 0.0, atol=1e-10)
    assert np.linalg.norm(registered, axis=-1).min() > 100


def test_the_angle_is_atan2() -> None:
    theta = np.linspace(1e-9, np.pi - 1e-9, 5001)
    found = [compute_angle(R, Z) for R, Z in zip(np.sin(theta), np.cos(theta), strict=True)]
    np.testing.assert_allclose(found, np.arctan2(np.sin(theta), np.cos(theta)), rtol=4e-16)
    assert compute_angle(2.0, 0.0) == np.pi / 2
    assert compute_angle(1e-100, 1.0) == 1e-100

"""The compiled normal equations against the readable ones."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine import kernels
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.observations import Observation, pack_observations
from calibgui.engine.calibration.refinement import residuals
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import list_parameter_names
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.geometry.rotations import rotation_from_vector

CAMERAS = {
    "lucchese": Camera((640, 480), [650, 600, 310, 250, 0.25, 0.06, -0.05, 1e-3, -2e-3, 0.4]),
    "pinhole": Camera((640, 480), [650, 600, 310, 250], "pinhole"),
    "brown-conrady-4": Camera(
        (640, 480), [650, 600, 310, 250, -0.25, 0.1, 1e-3, -2e-3, 0.03], "brown-conrady-4"
    ),
    "brown-conrady": Camera(
        (640, 480), [650, 600, 310, 250, -0.25, 0.1, 1e-3, -2e-3, -0.05, -0.02], "brown-conrady"
    ),
}


RAY_CAMERAS = {
    model: Camera((640, 480), [450, 420, 310, 250, *k], model)
    for model, k in {
        "kannala-brandt": (-0.05, 4e-3, -3e-3, 4e-4),
        "kannala-brandt-decentering": (-0.05, 4e-3, -3e-3, 4e-4, 4e-4, -7e-4),
        "ucm": (0.6,),
        "eucm": (0.6, 1.1),
        "double-sphere": (-0.2, 0.55),
    }.items()
}
"""Cameras that see boards in all directions."""
QUOTIENT_CAMERAS = {
    model: Camera((640, 480), [450, 420, 310, 250, *k], model)
    for model, k in {
        "rational": (0.4, -0.1, 1e-3, -2e-3, 0.02, 0.6, 0.1, 0.01, 0.03),
        "thin-prism": (
            *(0.4, -0.1, 1e-3, -2e-3, 0.02, 0.6, 0.1, -0.03),
            *(2e-3, -1e-3, -3e-3, 4e-4, -0.02),
        ),
    }.items()
}
COMPILED_CAMERAS = CAMERAS | RAY_CAMERAS | QUOTIENT_CAMERAS


def scene(model: str, weighted: bool) -> tuple[State, list[Observation]]:
    """Five partial views with 0.5 px of noise, and the state they were made with."""
    rng = np.random.default_rng(3)
    camera, board_shape = COMPILED_CAMERAS[model], Board(6, 7, 30.0).points()
    R = rotation_from_vector(rng.uniform(-0.5, 0.5, (5, 3)))
    T = (
        np.array([0.0, 0.0, 700.0])
        + rng.uniform(-20, 20, (5, 3))
        - R[..., :2] @ board_shape.mean(axis=0)
    )
    views = []
    for k in range(5):
        xy = board_shape[rng.permutation(len(board_shape))[: 20 + 4 * k]]
        point = xy @ R[k, :, :2].T + T[k]
        uv = pixels_from_rays(point, camera) + rng.normal(0, 0.5, xy.shape)
        root = rng.normal(size=(len(xy), 2, 2))
        cov = root @ np.swapaxes(root, 1, 2) + 0.1 * np.eye(2) if weighted else None
        views.append(Observation(uv, xy, cov))
    return State(np.array(camera.params), R, T), views


def test_the_kernels_know_these_models() -> None:
    assert kernels.POLYNOMIAL_LENSES.keys() == CAMERAS.keys()
    assert kernels.RAY_LENSES.keys() == RAY_CAMERAS.keys()
    assert kernels.QUOTIENT_LENSES.keys() == QUOTIENT_CAMERAS.keys()
    for model, places in kernels.COMPILED_LENSES.items():
        assert len(places) == len(list_parameter_names(model))


@pytest.mark.parametrize("model", COMPILED_CAMERAS)
@pytest.mark.parametrize("weighted", [False, True])
def test_the_compiled_sums_are_the_readable_ones(
    model: str, weighted: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    state, views = scene(model, weighted)
    free = np.array([i for i in range(len(list_parameter_names(model))) if i not in (3, 5)])
    arguments = (pack_observations(views), model, Cost.IMAGE, 1.0, free)
    compiled = residuals.build_stage_two(*arguments)(state)
    monkeypatch.setattr(kernels, "COMPILED", False)
    readable = residuals.build_stage_two(*arguments)(state)
    for name in ("U", "W", "V", "shared", "pose", "cost", "costs"):
        ours, truth = getattr(compiled, name), getattr(readable, name)
        # Newton's last step leaves the derivatives 1e-8 from the solution, the sums less.
        np.testing.assert_allclose(ours, truth, rtol=1e-7, atol=1e-9 * np.abs(truth).max())


@pytest.mark.parametrize("model", COMPILED_CAMERAS)
def test_the_compiled_derivatives_are_the_readable_ones(
    model: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    state, views = scene(model, weighted=True)
    observations = pack_observations(views)
    compiled = residuals.compute_image_residuals(state, observations, model)
    monkeypatch.setattr(kernels, "COMPILED", False)
    readable = residuals.compute_image_residuals(state, observations, model)
    for ours, truth in zip(compiled, readable, strict=True):
        np.testing.assert_allclose(ours, truth, rtol=1e-7, atol=1e-9 * np.abs(truth).max())


@pytest.mark.parametrize("model", QUOTIENT_CAMERAS)
def test_there_is_no_image_beyond_the_pole(model: str, monkeypatch: pytest.MonkeyPatch) -> None:
    state, views = scene(model, weighted=False)
    params = np.array(state.params)
    params[9:12] = -100.0, 0.0, 0.0  # D is 0 at 0.1 from the axis
    given = state._replace(params=params), pack_observations(views), model, Cost.IMAGE
    compiled = residuals.compute_misses(*given)
    monkeypatch.setattr(kernels, "COMPILED", False)
    readable = residuals.compute_misses(*given)
    assert np.isnan(readable).any() and np.isfinite(readable).any()
    np.testing.assert_allclose(compiled, readable)


@pytest.mark.parametrize("model", COMPILED_CAMERAS)
@pytest.mark.parametrize("flat", [True, False])
def test_the_compiled_residuals_are_the_readable_ones(
    model: str, flat: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    state, views = scene(model, weighted=False)
    observations = pack_observations(views)
    if not flat:
        height = np.random.default_rng(1).normal(0, 2, (*observations.mask.shape, 1))
        bent = np.concatenate([observations.xy, height], axis=-1)
        observations = replace(observations, xy=bent)
    compiled = residuals.compute_residuals(state, observations, model, Cost.IMAGE)
    alone = residuals.compute_misses(state, observations, model, Cost.IMAGE)
    np.testing.assert_array_equal(alone, compiled[0])
    monkeypatch.setattr(kernels, "COMPILED", False)
    readable = residuals.compute_residuals(state, observations, model, Cost.IMAGE)
    for ours, truth in zip(compiled, readable, strict=True):
        np.testing.assert_allclose(ours, truth, atol=1e-10)
    alone = residuals.compute_misses(state, observations, model, Cost.IMAGE)
    np.testing.assert_array_equal(alone, readable[0])


@pytest.mark.parametrize("model", CAMERAS)
def test_views_behind_the_camera_have_no_residuals(model: str) -> None:
    state, views = scene(model, weighted=False)
    turned = np.array([1.0, 1.0, -1.0]) ** (np.arange(5) == 2)[:, None]
    given = state._replace(T=state.T * turned), pack_observations(views), model, Cost.IMAGE
    for found in (*residuals.compute_residuals(*given), residuals.compute_misses(*given)):
        np.testing.assert_array_equal(np.isnan(found).any(axis=(1, 2)), np.arange(5) == 2)


@pytest.mark.parametrize("model", CAMERAS)
def test_a_board_behind_the_camera_costs_infinitely_much(model: str) -> None:
    state, views = scene(model, weighted=False)
    behind = state._replace(T=state.T * np.array([1.0, 1.0, -1.0]))
    normal = residuals.build_stage_two(
        pack_observations(views), model, Cost.IMAGE, 1.0, np.arange(4)
    )(behind)
    assert normal.cost == np.inf


def test_the_sums_do_not_depend_on_the_number_of_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    from calibgui.engine.kernels import common

    state, views = scene("lucchese", weighted=False)
    many = 60 * views
    wide = State(state.params, np.tile(state.R, (60, 1, 1)), np.tile(state.T, (60, 1)))
    normal_at = residuals.build_stage_two(
        pack_observations(many), "lucchese", Cost.IMAGE, 1.0, np.arange(9)
    )
    results = []
    for threads in (1, 2, 5):
        monkeypatch.setattr(common, "THREADS", threads)
        results.append(normal_at(wide))
    for other in results[1:]:
        for ours, theirs in zip(results[0], other, strict=True):
            np.testing.assert_array_equal(ours, theirs)

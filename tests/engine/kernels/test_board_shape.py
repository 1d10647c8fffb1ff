"""The compiled products of the board's corners against the readable ones."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.board_shape.parametrisation import (
    index_board_points,
    iterate_corner_products,
)
from calibgui.engine.calibration.observations import Observations, pack_observations
from calibgui.engine.calibration.refinement.residuals import (
    BoardMotion,
    State,
    compute_view_products,
)
from calibgui.engine.calibration.refinement.whitening import whiten_observations
from calibgui.engine.camera.models import list_parameter_names
from tests.engine.kernels.test_normal_equations import COMPILED_CAMERAS, scene


def choose_free(model: str) -> IntArray:
    """Some of the camera's parameters; the last is the skew of the models that have one."""
    last = len(list_parameter_names(model)) - 1
    return np.array([i for i in (0, 1, 2, 4, 6, last) if i <= last])


def together(parts: Iterator[tuple[slice, Array, Array, Array]]) -> tuple[Array, Array, Array]:
    """The products of all views at once."""
    _, A, D, total = zip(*parts, strict=True)
    return np.concatenate(A), np.concatenate(D), np.sum(total, axis=0)


def products(state: State, observations: Observations, model: str) -> tuple[Array, ...]:
    points, index = index_board_points(observations)
    free = choose_free(model)
    parts = iterate_corner_products(state, observations, model, free, index, len(points))
    return together(parts)


@pytest.mark.parametrize("model", COMPILED_CAMERAS)
@pytest.mark.parametrize("cov", [False, True])
def test_the_compiled_products_are_the_readable_ones(
    model: str, cov: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    state, views = scene(model, cov)
    observations = whiten_observations(pack_observations(views))
    compiled = products(state, observations, model)
    monkeypatch.setattr(kernels, "COMPILED", False)
    readable = products(state, observations, model)
    for ours, truth in zip(compiled, readable, strict=True):
        assert ours.shape == truth.shape
        np.testing.assert_allclose(ours, truth, rtol=1e-7, atol=1e-9 * np.abs(truth).max())


@pytest.mark.parametrize("model", COMPILED_CAMERAS)
@pytest.mark.parametrize("cov", [False, True])
def test_a_board_that_moves_gives_the_readable_products(
    model: str, cov: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    state, views = scene(model, cov)
    observations = whiten_observations(pack_observations(views))
    points, index = index_board_points(observations)
    free = choose_free(model)
    motion = np.random.default_rng(0).normal(size=(len(points), 3, len(free)))
    given = state, observations, model, free, BoardMotion(motion, index)
    compiled = compute_view_products(*given)
    monkeypatch.setattr(kernels, "COMPILED", False)
    readable = compute_view_products(*given)
    np.testing.assert_allclose(compiled, readable, rtol=1e-7, atol=1e-9 * np.abs(readable).max())


def test_the_sums_do_not_depend_on_the_number_of_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    from calibgui.engine.kernels import common

    state, views = scene("brown-conrady", weighted=False)
    many = pack_observations(60 * views)
    wide = State(state.params, np.tile(state.R, (60, 1, 1)), np.tile(state.T, (60, 1)))
    results = []
    for threads in (1, 2, 5):
        monkeypatch.setattr(common, "THREADS", threads)
        results.append(products(wide, many, "brown-conrady"))
    for other in results[1:]:
        for ours, theirs in zip(results[0], other, strict=True):
            np.testing.assert_array_equal(ours, theirs)

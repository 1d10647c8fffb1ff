"""The compiled normal equations of splined lenses against the readable ones."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.calibration.refinement.local_support import prepare_local_blocks
from calibgui.engine.calibration.refinement.whitening import whiten_observations
from calibgui.engine.camera.models.splined_stereographic import (
    SplinedStereographic,
    evaluate_surface,
    iterate_newton,
)
from calibgui.engine.kernels import common
from tests.engine.splined_scenes import make_splined_views

LENS = SplinedStereographic(9, 7, 200)
COUNT = 4 + len(LENS.names)
FREE = {
    "all but the first four": np.arange(4, COUNT),
    "some": np.delete(np.arange(COUNT), [1, 7, 20]),
    "the first four": np.arange(4),
    "none": np.arange(0),
}


@pytest.mark.parametrize("free", FREE)
@pytest.mark.parametrize("weighted", [False, True])
def test_the_compiled_sums_are_the_readable_ones(free: str, weighted: bool) -> None:
    state, observations = make_splined_views(LENS, 9, np.random.default_rng(1), weighted=weighted)
    if weighted:
        observations = whiten_observations(observations, 0.0)
    compiled = prepare_local_blocks.kernel(observations, LENS, FREE[free])(state)
    readable = prepare_local_blocks.reference(observations, LENS, FREE[free])(state)
    for ours, truth in zip(compiled, readable, strict=True):
        assert ours.shape == truth.shape
        if truth.size:
            np.testing.assert_allclose(ours, truth, atol=1e-11 * np.abs(truth).max())


def test_a_view_that_leaves_the_surface_costs_infinitely_much() -> None:
    state, observations = make_splined_views(LENS, 5, np.random.default_rng(1))
    state.T[2] = [0.0, 0.0, -500.0]
    for prepare in (prepare_local_blocks.kernel, prepare_local_blocks.reference):
        costs = prepare(observations, LENS, FREE["some"])(state)[-1]
        np.testing.assert_array_equal(np.isfinite(costs), np.arange(5) != 2)


def test_the_sums_do_not_depend_on_the_number_of_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    state, observations = make_splined_views(LENS, 4, np.random.default_rng(1))
    many = np.tile(np.arange(4), 80)
    state, observations = state.select_views(many), observations.select_views(many)
    results = []
    for threads in (1, 2, 5):
        monkeypatch.setattr(common, "THREADS", threads)
        results.append(prepare_local_blocks.kernel(observations, LENS, FREE["some"])(state))
    for other in results[1:]:
        for ours, theirs in zip(results[0], other, strict=True):
            np.testing.assert_array_equal(ours, theirs)


def test_the_compiled_surface_is_the_readable_one() -> None:
    rng = np.random.default_rng(2)
    k = rng.normal(0, 0.01, len(LENS.names))
    u = 1.1 * LENS.edge * rng.uniform(-1, 1, (40, 5, 2))
    u[0, 0], u[0, 1] = np.nan, LENS.edge
    compiled = evaluate_surface.kernel(LENS, u, k)
    readable = evaluate_surface.reference(LENS, u, k)
    assert 0 < np.isnan(compiled[0]).sum() < u.size
    for ours, truth in zip(compiled, readable, strict=True):
        np.testing.assert_allclose(ours, truth, atol=1e-14)


def test_the_compiled_iteration_is_the_readable_one() -> None:
    """Steps that have to be shortened, points that are not reached, and some without a value."""
    rng = np.random.default_rng(3)
    k = rng.normal(0, 0.15, len(LENS.names))
    u = LENS.edge * rng.uniform(-1, 1, (400, 2))
    d = u + rng.normal(0, 0.2, u.shape)
    u[7], u[8], d[9] = np.nan, 2 * LENS.edge, np.nan
    limits = np.array([60, 1e-6, 4e-15, 1e-13])
    before = u.copy()
    compiled = iterate_newton.kernel(LENS, u, d, k, limits)
    readable = iterate_newton.reference(LENS, u, d, k, limits)
    np.testing.assert_array_equal(u, before)
    reached = np.hypot(*readable[1].T) < 1e-13
    assert 200 < reached.sum() < 395
    np.testing.assert_array_equal(np.hypot(*compiled[1].T) < 1e-13, reached)
    for ours, truth in zip(compiled, readable, strict=True):
        np.testing.assert_allclose(ours[reached], truth[reached], atol=1e-11)
    assert not np.isfinite(compiled[1][[7, 8, 9]]).any()

"""The compiled normal equations of splined lenses against the readable ones."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.calibration.refinement.local_support import prepare_local_blocks
from calibgui.engine.calibration.refinement.whitening import whiten_observations
from calibgui.engine.camera.models.splined_stereographic import SplinedStereographic
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

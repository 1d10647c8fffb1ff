"""Mirrored poses: made by hand, in random problems, and distinguished from right ones."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import IntArray
from calibgui.engine.calibration.observations import Observations, pack_observations
from calibgui.engine.calibration.refinement import planar_pose_ambiguity, residuals
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution, minimise
from calibgui.engine.calibration.refinement.planar_pose_ambiguity import (
    correct_mirrored_poses,
    mirror_poses,
)
from calibgui.engine.calibration.refinement.residuals import NormalAt, State
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays
from tests.engine.calibration.refinement.test_residuals import truth_of
from tests.engine.random_problems import outcome
from tests.engine.scenes import VGA, Scene, scene

TELE = Camera(VGA, [2500.0, 2400.0, 330.0, 236.0, 0.4, 0.0, 0.0, 1e-3, -1e-3, 0.0])
FREE = np.arange(9)


def build_problem(views: Observations, free: IntArray) -> NormalAt:
    return residuals.build_stage_two(views, "lucchese", Cost.IMAGE, 1.0, free)


def build_registration(views: Observations, free: IntArray) -> NormalAt:
    return residuals.build_stage_two(views, "lucchese", Cost.REFERENCE, 1.0, free)


def solved(observations: Observations, start: State) -> Solution:
    data = float(np.sum(observations.uv**2))
    return minimise(build_problem(observations, FREE), start, FREE, observations.count, data)


def made() -> tuple[Scene, Observations]:
    """Slight tilts seen through a long lens, one of the boards partly and all off its origin."""
    true = scene(TELE, 12, seed=5, tilt=(8.0, 25.0))
    views = true.noisy(0.3, np.random.default_rng(0))
    views[4] = type(views[4])(views[4].uv[30:], views[4].xy[30:])
    return true, pack_observations(views)


def test_the_mirrored_board_looks_alike_from_afar() -> None:
    true, observations = made()
    state = truth_of(true)
    turned = mirror_poses(state, observations)
    np.testing.assert_allclose(turned.R @ turned.R.swapaxes(1, 2), [np.eye(3)] * 12, atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(turned.R), 1.0)
    back = mirror_poses(turned, observations)
    np.testing.assert_allclose(back.R, state.R, atol=1e-12)
    np.testing.assert_allclose(back.T, state.T, rtol=1e-10)

    def seen(pose: State) -> np.ndarray:
        """Images along the mean ray, without perspective about it."""
        point = observations.xy @ pose.R[..., :2].swapaxes(1, 2) + pose.T[:, None]
        places = observations.mask > 0
        return pixels_from_rays(point[places], TELE)

    moved = np.linalg.norm(seen(turned) - seen(state), axis=1)
    size = np.ptp(seen(state), axis=0).max()
    assert 1.0 < moved.max() < 0.05 * size


@pytest.mark.parametrize("wrong", [[4], [0, 7, 9]])
def test_mirrored_views_are_found_and_righted(wrong: list[int]) -> None:
    true, observations = made()
    best = solved(observations, truth_of(true))
    turned = mirror_poses(best.state, observations)
    R, T = best.state.R.copy(), best.state.T.copy()
    R[wrong], T[wrong] = turned.R[wrong], turned.T[wrong]
    caught = solved(observations, State(best.state.params, R, T))
    assert caught.normal.cost > 1.01 * best.normal.cost
    state = correct_mirrored_poses(build_problem, build_registration, observations, caught)
    assert state is not None
    again = solved(observations, state)
    assert again.normal.cost == pytest.approx(best.normal.cost, rel=1e-9)
    assert correct_mirrored_poses(build_problem, build_registration, observations, again) is None


def test_nothing_is_tried_where_perspective_is_plain(monkeypatch: pytest.MonkeyPatch) -> None:
    true = scene(Camera(VGA, [600.0, 600, 320, 240, 0.2, 0, 0, 0, 0, 0]), 8)
    observations = pack_observations(true.noisy(0.1, np.random.default_rng(0)))
    best = solved(observations, truth_of(true))
    monkeypatch.setattr(
        "calibgui.engine.calibration.refinement.levenberg_marquardt.minimise",
        lambda *_, **__: pytest.fail("tried"),
    )
    assert correct_mirrored_poses(build_problem, build_registration, observations, best) is None


def test_the_cost_of_a_mirrored_pose_is_known_before_it_is_refined() -> None:
    true, observations = made()
    best = solved(observations, truth_of(true))
    mirrored = mirror_poses(best.state, observations)
    start = build_problem(observations, np.arange(0))(mirrored)
    predicted = planar_pose_ambiguity._predict_costs(start)
    refined = planar_pose_ambiguity._refine_poses(build_problem, observations, mirrored)
    own_minimum = refined.normal.costs > 1.001 * best.normal.costs
    assert own_minimum.sum() >= 6  # from the others it goes back
    assert (start.costs > 1.2 * refined.normal.costs)[own_minimum].any()
    np.testing.assert_allclose(predicted[own_minimum], refined.normal.costs[own_minimum], rtol=0.1)


def test_a_pose_that_its_corners_leave_open_is_tried() -> None:
    true, observations = made()
    normal = build_problem(observations, np.arange(0))(truth_of(true))
    predicted = planar_pose_ambiguity._predict_costs(normal._replace(V=0 * normal.V))
    assert predicted.tolist() == [0.0] * 12
    lost = np.where(np.arange(12) == 3, np.inf, normal.costs)
    predicted = planar_pose_ambiguity._predict_costs(normal._replace(costs=lost))
    assert np.isnan(predicted).tolist() == (np.arange(12) == 3).tolist()


@pytest.mark.parametrize("seed", [363, 770, 1374])
def test_random_problems_that_a_mirrored_view_kept_from_the_minimum(seed: int) -> None:
    found = outcome(seed)
    assert found.reached, found.words

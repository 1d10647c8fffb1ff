"""Weng's two steps against the truth of synthetic scenes and maximum likelihood."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.methods.method import refine_by_bundle_adjustment
from calibgui.engine.calibration.methods.weng import WENG, make_map_to_paper
from calibgui.engine.calibration.result import Iteration, Status
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import find_model
from tests.engine.scenes import VGA, Scene, looking, seen

CENTRE = {"cx": 303.0, "cy": 243.0}
SMALL = Board(rows=6, cols=8, square=45.0)
TOGETHER = replace(WENG, refine=refine_by_bundle_adjustment)
"""The same unknowns without turns."""


def make_camera(k1: float) -> Camera:
    """A camera with the paper's five coefficients at work."""
    lens = [k1, 0, 3e-4, -5e-4, 0, 0, 0, 0, 1e-3, 0, 2e-3, 0, 0]
    return Camera(VGA, [650.0, 655.0, *CENTRE.values(), *lens], "thin-prism")


def make_scene(k1: float, count: int) -> Scene:
    camera, rng = make_camera(k1), np.random.default_rng(1)
    return seen(camera, [looking(camera, rng, (30, 50), board=SMALL) for _ in range(count)], SMALL)


def find_largest_miss(found: Camera, truth: Camera) -> float:
    """Largest relative error of the parameters that are not 0."""
    used = truth.params != 0
    return float(np.abs(found.params[used] / truth.params[used] - 1).max())


def test_turns_recover_their_own_model_where_the_centre_is_known() -> None:
    exact = make_scene(-0.3, 4)
    found = calibrate(exact.views, VGA, method=WENG, fix=CENTRE, max_iterations=200)
    assert found.status is Status.CONVERGED
    assert find_largest_miss(found.camera, exact.camera) < 1e-6


@pytest.mark.slow
def test_turns_recover_their_own_model_with_all_free_in_the_end() -> None:
    exact = make_scene(-0.25, 6)
    found = calibrate(exact.views, VGA, method=WENG, max_iterations=1500)
    assert find_largest_miss(found.camera, exact.camera) < 1e-6


def test_turns_end_where_all_unknowns_together_do() -> None:
    views = make_scene(-0.3, 4).noisy(0.1, np.random.default_rng(2))
    found = calibrate(views, VGA, method=WENG, fix=CENTRE)
    likely = calibrate(views, VGA, method=TOGETHER, fix=CENTRE)
    assert found.status is Status.CONVERGED
    free = likely.sigma > 0
    miss = (found.camera.params - likely.camera.params)[free] / likely.sigma[free]
    assert np.abs(miss).max() < 1e-2
    np.testing.assert_allclose(found.sigma, likely.sigma, rtol=1e-3)


def test_each_turn_is_an_iteration_and_lowers_the_cost() -> None:
    views = make_scene(-0.3, 4).noisy(0.1, np.random.default_rng(3))
    told: list[Iteration] = []

    def listen(iteration: Iteration) -> bool:
        told.append(iteration)
        return True

    found = calibrate(views, VGA, method=WENG, report=listen, max_iterations=12)
    costs = [iteration.cost for iteration in found.history]
    assert [iteration.index for iteration in told] == list(range(13))
    assert (np.diff(costs) < 0).all()


def test_a_stop_short_of_the_minimum_is_not_called_convergence() -> None:
    views = make_scene(-0.3, 4).noisy(0.1, np.random.default_rng(3))
    found = calibrate(views, VGA, method=WENG, max_iterations=10)
    likely = calibrate(views, VGA, method=TOGETHER)
    assert found.status is Status.MAX_ITERATIONS
    assert found.history[-1].cost > 1.001 * likely.history[-1].cost
    assert any("10 turns did not reach" in remark for remark in WENG.list_remarks(found))


def test_a_user_s_stop_keeps_the_last_turn() -> None:
    views = make_scene(-0.3, 4).views
    found = calibrate(views, VGA, method=WENG, report=lambda iteration: iteration.index < 3)
    assert found.status is Status.STOPPED
    assert len(found.history) == 4


def test_the_paper_s_coefficients_move_points_as_ours_do() -> None:
    """The paper's distortion written out, against the lens model."""
    camera = make_camera(-0.3)
    g1, g2, g3, g4 = make_map_to_paper() @ camera.params
    k1 = camera.params[4]
    n = np.random.default_rng(4).uniform(-0.5, 0.5, (50, 2))
    u, v = n.T
    du = (g1 + g3) * u**2 + g4 * u * v + g1 * v**2 + k1 * u * (u**2 + v**2)
    dv = g2 * u**2 + g3 * u * v + (g2 + g4) * v**2 + k1 * v * (u**2 + v**2)
    rays = np.column_stack([n, np.ones(50)])
    moved = find_model("thin-prism").project(rays, camera.params[4:]).points
    np.testing.assert_allclose(moved - n, np.stack([du, dv], axis=1), atol=1e-14)


def test_the_remarks_name_the_paper_s_coefficients() -> None:
    views = make_scene(-0.3, 4).noisy(0.1, np.random.default_rng(5))
    found = calibrate(views, VGA, method=WENG, fix=CENTRE)
    (remark,) = WENG.list_remarks(found)
    p1, p2, s1 = (found.camera.params[found.camera.names.index(n)] for n in ("p1", "p2", "s1"))
    assert f"g1 = {p2 + s1:.3g} ±" in remark
    sigma = 2 * found.sigma[found.camera.names.index("p1")]
    assert f"g4 = {2 * p1:.3g} ± {sigma:.2g}." in remark

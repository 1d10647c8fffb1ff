"""The solve of splined lenses: sums by local support, the prior, and mrcal's minimum."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from calibgui.engine import kernels
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement import (
    covariances,
    levenberg_marquardt,
    residuals,
)
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution, minimise
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.refinement.schur import (
    NormalEquations,
    Reduced,
    eliminate_poses,
)
from calibgui.engine.calibration.result import Cost, Status
from calibgui.engine.camera.models import find_model
from calibgui.engine.camera.models.splined_stereographic import SplinedStereographic
from calibgui.engine.geometry.rotations import rotation_from_vector, vector_from_rotation
from tests.engine.scenes import central_differences, relative
from tests.engine.splined_scenes import make_splined_views
from tests.formats.readers import in_other_python

MODEL = "splined-stereographic-9x7-140"
_FOUND = find_model(MODEL)
assert isinstance(_FOUND, SplinedStereographic)
LENS = _FOUND
FREE = np.arange(4, 4 + len(LENS.names))
BOARD = Board(6, 7, 30.0)
_MRCAL = """
import json, sys
import mrcal
import numpy as np

given = np.load(sys.argv[1])
boards, poses, intrinsics = given["boards"], given["poses"].copy(), given["params"][None].copy()
which = np.zeros((len(boards), 3), dtype=np.int32)
which[:, 0], which[:, 2] = np.arange(len(boards)), -1
found = mrcal.optimize(
    intrinsics, np.zeros((0, 6)), poses, np.zeros((0, 3)),
    np.concatenate([boards, np.ones((*boards.shape[:3], 1))], axis=-1), which, None, None,
    "LENSMODEL_SPLINED_STEREOGRAPHIC_order=3_Nx=9_Ny=7_fov_x_deg=140",
    imagersizes=np.array([[2000, 1500]], dtype=np.int32), calibration_object_spacing=30.0,
    do_optimize_intrinsics_core=False, do_optimize_calobject_warp=False,
    do_apply_regularization=True, do_apply_outlier_rejection=False)
x = found["x"]
print(json.dumps({"params": intrinsics[0].tolist(), "poses": poses.tolist(),
                  "total": float(x @ x), "corners": float(np.sum(x[:boards.size] ** 2))}))
"""


def make_problem(count: int, seed: int = 3) -> tuple[State, State, Observations]:
    """The truth, a start beside it, and the views."""
    rng = np.random.default_rng(seed)
    truth, observations = make_splined_views(LENS, count, rng, BOARD)
    k = np.zeros(len(truth.params))
    k[4:] = rng.normal(0, 0.002, len(LENS.names))
    turn = rotation_from_vector(rng.normal(0, 2e-3, (count, 3)))
    moved = truth.T + rng.normal(0, 0.5, truth.T.shape)
    return truth, State(truth.params + k, turn @ truth.R, moved), observations


def solve(start: State, observations: Observations, max_decrease: float = 1e-12) -> Solution:
    normal_at = residuals.build_stage_two(observations, MODEL, Cost.IMAGE, 1.0, FREE)
    square = float(np.sum(observations.uv**2))
    return minimise(normal_at, start, FREE, observations.count, square, max_decrease=max_decrease)


def test_the_sums_are_those_of_all_derivatives(monkeypatch: pytest.MonkeyPatch) -> None:
    _, state, observations = make_problem(8)
    free = np.delete(np.arange(len(state.params)), [2, 9, 30])

    def linearise(state: State, views: slice) -> residuals.Linearised:
        return residuals.linearise_residuals(state, observations, views, MODEL, Cost.IMAGE, 1.0)

    truth = residuals.accumulate_normal_equations(linearise, state, free)
    for compiled in (True, False):
        monkeypatch.setattr(kernels, "COMPILED", compiled and kernels.COMPILED)
        local = residuals.prepare_blocks(observations, MODEL, Cost.IMAGE, 1.0, free)(state)
        names = ("U", "W", "V", "shared", "pose", "costs")
        for name, ours in zip(names, local, strict=True):
            expected = getattr(truth, name)
            np.testing.assert_allclose(ours, expected, atol=1e-11 * np.abs(expected).max())


def test_the_gradient_is_that_of_the_total_cost() -> None:
    _, state, observations = make_problem(6)
    free = np.arange(2, 40)
    normal_at = residuals.build_stage_two(observations, MODEL, Cost.IMAGE, 1.0, free)

    def total(by_params: np.ndarray) -> np.ndarray:
        return np.array(normal_at(state.take_step(by_params, np.zeros((6, 6)), free)).total_cost)

    expected = central_differences(total, np.zeros(len(free)), 1e-4) / 2
    assert relative(normal_at(state).shared, expected) < 1e-7
    pull = state.params[4:] @ LENS.compute_stiffness(observations.count) @ state.params[4:]
    normal = normal_at(state)
    assert normal.prior_cost == pytest.approx(pull, rel=1e-12)
    assert normal.cost == pytest.approx(normal.costs.sum(), rel=1e-12)


def test_held_coefficients_are_not_pulled() -> None:
    """Of them the prior is a constant."""
    _, state, observations = make_problem(6)
    for free in (np.arange(4), np.arange(0)):
        normal = residuals.build_stage_two(observations, MODEL, Cost.IMAGE, 1.0, free)(state)
        blocks = residuals.prepare_blocks(observations, MODEL, Cost.IMAGE, 1.0, free)(state)
        np.testing.assert_array_equal(normal.U, blocks[0])
        np.testing.assert_array_equal(normal.shared, blocks[3])
        assert normal.total_cost == normal.cost


def test_kept_factors_lead_to_the_same_minimum(monkeypatch: pytest.MonkeyPatch) -> None:
    _, start, observations = make_problem(30)
    factored: list[float] = []

    def count_factors(normal: NormalEquations, damping: float) -> Reduced:
        factored.append(damping)
        return eliminate_poses(normal, damping)

    monkeypatch.setattr(levenberg_marquardt, "eliminate_poses", count_factors)
    kept, with_kept = solve(start, observations, 1e-17), len(factored)
    monkeypatch.setattr(levenberg_marquardt, "_MAX_DECREASE_TO_KEEP_LARGE_FACTORS", 0.0)
    fresh = solve(start, observations, 1e-17)
    assert kept.status is fresh.status is Status.CONVERGED
    assert 2 * with_kept < len(factored)
    assert with_kept < len(kept.history) <= len(fresh.history) + 2
    np.testing.assert_allclose(kept.state.params, fresh.state.params, atol=1e-8)
    np.testing.assert_allclose(kept.state.T, fresh.state.T, atol=1e-5)


def test_the_minimum_is_mrcals(tmp_path: Path) -> None:
    _, start, observations = make_problem(30)
    file = tmp_path / "given.npz"
    np.savez(
        file,
        boards=observations.uv.reshape(-1, BOARD.rows, BOARD.cols, 2),
        params=start.params,
        poses=np.column_stack([vector_from_rotation(start.R), start.T]),
    )
    theirs = in_other_python(_MRCAL, file, needs="import mrcal")
    solution = solve(start, observations)
    assert solution.status is Status.CONVERGED
    np.testing.assert_allclose(solution.state.params, theirs["params"], atol=1e-6)
    np.testing.assert_allclose(solution.state.T, np.array(theirs["poses"])[:, 3:], atol=1e-3)
    assert solution.normal.total_cost == pytest.approx(theirs["total"], rel=1e-9)
    assert solution.normal.cost == pytest.approx(theirs["corners"], rel=1e-6)
    assert solution.history[-1].cost == solution.normal.cost


def test_the_solve_returns_to_the_truth() -> None:
    """Up to a rotation of the camera, which the surface can take up: angles between rays stay."""
    truth, start, observations = make_problem(40)
    solution = solve(start, observations)
    assert solution.normal.cost / (2 * observations.count) == pytest.approx(0.01, rel=0.1)
    pixels = np.stack(np.meshgrid(np.linspace(400, 1600, 7), np.linspace(350, 1150, 5)), axis=-1)
    d = (pixels.reshape(-1, 2) - truth.params[2:4]) / truth.params[:2]
    before, after = (
        LENS.unproject_points(d, state.params[4:])[0] for state in (truth, solution.state)
    )
    left, _, right = np.linalg.svd(after.T @ before)
    assert np.abs(after @ (left @ right) - before).max() < 2e-4


def test_control_points_without_corners_are_determined() -> None:
    """Boards on the left only: the right of the surface stays at 0."""
    _, start, observations = make_problem(60)
    left = np.flatnonzero(observations.uv[..., 0].max(axis=1) < 1000)
    assert len(left) > 5
    solution = solve(start.select_views(left), observations.select_views(left))
    assert solution.status is Status.CONVERGED
    names = LENS.names
    found = covariances.measure_precision(
        solution.normal, names, observations.select_views(left).count, np.ones(len(names))
    )
    assert found.undetermined == ()
    # Each corner of 0.1 px counts, and each coefficient no more than the corners determine it.
    corners = 2 * observations.select_views(left).count
    deviation = np.sqrt(2 / (corners - 6 * len(left) - len(names)))
    assert found.variance == pytest.approx(0.01, rel=3 * deviation)
    touched = int(np.count_nonzero(solution.normal.W.any(axis=(0, 2))))
    assert touched == 2 * 7 * 6  # of nine columns of control points
    too_few = covariances.estimate_variance(solution.normal.cost, corners // 2, 6 * len(left))
    too_many = covariances.estimate_variance(
        solution.normal.cost, corners // 2, 6 * len(left) + touched
    )
    assert too_few < found.variance < too_many
    assert np.isfinite(found.shared).all()
    assert np.abs(solution.state.params[4:].reshape(7, 9, 2)[:, -2:]).max() < 1e-6

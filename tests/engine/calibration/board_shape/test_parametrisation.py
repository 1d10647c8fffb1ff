"""Boards that deviate from their drawing: derivatives, recovery, gauge, prior, refusals."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.shape import BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration.board_shape import parametrisation
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation, pack_observations
from calibgui.engine.calibration.problem import recover_arguments
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.rotations import rotation_from_vector

CAMERA = Camera((640, 480), [657, 655, 305, 243, 0.25, 0.06, -0.05, 1e-4, 3e-4, 0])
NOMINAL = np.unique(Board(6, 8, 30.0).points(), axis=0)
"""The corners in the order in which the engine numbers a board's."""
CENTRE = NOMINAL.mean(axis=0)
ACROSS = (NOMINAL - CENTRE) / np.abs(NOMINAL - CENTRE).max(axis=0)
"""The corners' places on the board, from -1 to 1 along either side."""
SIZE = CAMERA.size


def deviation(rms: float = 0.1, seed: int = 0) -> Array:
    """(n, 3) random deviations, mm, without motion, turn or scale."""
    G = parametrisation.make_gauge(NOMINAL)
    d = np.random.default_rng(seed).normal(size=3 * len(NOMINAL))
    d -= G @ (G.T @ d)
    return (d * rms / np.sqrt(np.mean(d**2))).reshape(-1, 3)


def photographed(d: Array, count: int, noise: float, seed: int = 1) -> list[Observation]:
    """Views of the board with deviations d, numbered as if it had none."""
    rng = np.random.default_rng(seed)
    true = np.column_stack([NOMINAL, np.zeros(len(NOMINAL))]) + d
    views: list[Observation] = []
    while len(views) < count:
        R = rotation_from_vector(rng.uniform(-0.6, 0.6, 3))
        T = [rng.uniform(-60, 60), rng.uniform(-40, 40), rng.uniform(500, 700)]
        point = true @ R.T + T - R[:, :2] @ CENTRE
        uv = pixels_from_rays(point, CAMERA)
        if ((uv > 0) & (uv < SIZE)).all():
            views.append(Observation(uv + rng.normal(0, noise, uv.shape), NOMINAL))
    return views


@pytest.mark.parametrize(
    "model", [BoardShapeModel.AFFINE, BoardShapeModel.BOW, BoardShapeModel.FREE]
)
def test_gradient_is_that_of_the_cost(model: BoardShapeModel) -> None:
    views = photographed(deviation(), 5, 0.2)
    views = [Observation(v.uv[k:], v.xy[k:]) for k, v in enumerate(views)]  # partial boards
    observations = pack_observations(views)
    points, index = parametrisation.index_board_points(observations)
    B = parametrisation.make_basis(model, points)
    Q = B.shape[2]
    stiffness = np.diag(np.linspace(0.5, 2.0, Q))
    free = np.arange(9)
    normal_at = parametrisation.make_board_shape_problem(
        observations, "lucchese", free, points, index, B, stiffness
    )
    fitted = calibrate(views, SIZE)
    rng = np.random.default_rng(2)
    state = State(
        np.append(fitted.camera.params, rng.normal(0, 0.05, Q)),
        rotation_from_vector(np.array([p.rvec for p in fitted.poses])),
        np.array([p.tvec for p in fitted.poses]),
    )
    normal = normal_at(state)
    chosen = np.unique(np.linspace(0, len(free) + Q - 1, 15).astype(int))
    for j in chosen:
        place = free[j] if j < len(free) else 10 + j - len(free)
        h = 1e-5 * max(1.0, abs(state.params[place]))
        costs = []
        for sign in (1, -1):
            params = state.params.copy()
            params[place] += sign * h
            costs.append(normal_at(state._replace(params=params)).cost)
        # Central differences: truncation h^2, and rounding of a cost of about 10 over h.
        slope = (costs[0] - costs[1]) / (4 * h)
        assert slope == pytest.approx(normal.shared[j], rel=1e-5, abs=1e-6)


def test_a_free_board_is_recovered_with_the_camera() -> None:
    d = deviation(0.1)
    views = photographed(d, 25, 0.03)
    nominal, free = calibrate(views, SIZE), calibrate(views, SIZE, board_shape="free")
    assert free.board_shape is not None
    assert np.sqrt(np.mean((free.board_shape.deviation - d) ** 2)) < 0.1 * 0.1  # 10 % of 0.1 mm
    assert free.noise == pytest.approx(0.03, rel=0.05)
    assert nominal.noise > 1.2 * free.noise
    z = (free.camera.params - CAMERA.params)[:9] / free.sigma[:9]
    assert np.abs(z).max() < 3.5
    scaled = (free.board_shape.deviation - d) / free.board_shape.sigma
    assert 0.85 < scaled.std() < 1.15


@pytest.mark.parametrize("model", [BoardShapeModel.AFFINE, BoardShapeModel.BOW])
def test_small_models_are_recovered_exactly_from_perfect_data(model: BoardShapeModel) -> None:
    d = parametrisation.make_basis(model, NOMINAL) @ np.array([0.004, -0.002])
    result = calibrate(photographed(d, 8, 0.0), SIZE, board_shape=model)
    assert result.board_shape is not None
    np.testing.assert_allclose(result.board_shape.deviation, d, atol=1e-8)
    np.testing.assert_allclose(result.camera.params, CAMERA.params, rtol=1e-7, atol=1e-8)


def test_deviations_have_no_motion_turn_or_scale() -> None:
    result = calibrate(photographed(deviation(), 8, 0.1), SIZE, board_shape="free")
    assert result.board_shape is not None
    assert (
        np.abs(parametrisation.make_gauge(NOMINAL).T @ result.board_shape.deviation.ravel()).max()
        < 1e-6  # mm: the prior of the deviations pulls at the scale by their square
    )


def test_a_held_board_shape_gives_the_camera_that_it_was_estimated_with() -> None:
    views = photographed(deviation(), 10, 0.1)
    estimated = calibrate(views, SIZE, board_shape="free")
    assert estimated.board_shape is not None
    held = calibrate(views, SIZE, board_shape=estimated.board_shape)
    assert [result.settings.is_board_shape_held for result in (estimated, held)] == [False, True]
    assert recover_arguments(held)["board_shape"] is held.board_shape
    assert recover_arguments(estimated)["board_shape"] is BoardShapeModel.FREE
    np.testing.assert_allclose(
        held.camera.params, estimated.camera.params, atol=1e-3 * estimated.sigma.max()
    )
    with pytest.raises(CalibrationError, match="does not have"):
        calibrate(
            [Observation(v.uv, v.xy * 1.1) for v in views], SIZE, board_shape=estimated.board_shape
        )


def test_a_tight_prior_is_the_nominal_board() -> None:
    views = photographed(deviation(), 4, 0.1)
    nominal = calibrate(views, SIZE)
    tight = calibrate(views, SIZE, board_shape="free", prior=BoardShapePrior(1e-6, 1e-6))
    np.testing.assert_allclose(
        tight.camera.params, nominal.camera.params, atol=1e-3 * nominal.sigma.max()
    )


def test_what_the_views_cannot_carry_is_refused() -> None:
    views = photographed(deviation(), 8, 0.1)
    with pytest.raises(CalibrationError, match="4 views cannot carry"):
        calibrate(views[:4], SIZE, board_shape="free")
    scarce = [views[0], *(Observation(v.uv[8:], v.xy[8:]) for v in views[1:])]
    with pytest.raises(CalibrationError, match="8 of the board's 48 corners"):
        calibrate(scarce, SIZE, board_shape="free")
    with pytest.raises(CalibrationError, match="flat board as it is drawn"):
        calibrate(views, SIZE, board_shape="bow", cost="reference")

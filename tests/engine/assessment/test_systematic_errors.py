"""What causes would explain, against calibrations that do explain it."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.assessment import systematic_errors
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration, Cost
from tests.engine.scenes import barrel, relative, scene

SIZE = barrel().size


def _cost(result: Calibration) -> float:
    return sum(float(np.sum(view.image**2)) for view in result.residuals)


def _stretched(count: int = 8) -> list[Observation]:
    """Views of a board that is 0.3 % wider than said, and bowed by its own lens."""
    views = scene(barrel(), count, 1).noisy(0.1, np.random.default_rng(2))
    return [Observation(view.uv, view.xy * np.array([0.997, 1.0])) for view in views]


@pytest.mark.parametrize("model", [BoardShapeModel.AFFINE, BoardShapeModel.BOW])
def test_a_board_shape_explains_what_estimating_it_gains(model: BoardShapeModel) -> None:
    views = _stretched()
    nominal, fitted = (
        calibrate(views, SIZE, board_shape=board_shape) for board_shape in ("nominal", model)
    )
    found = systematic_errors.explain_by_board_shape(
        systematic_errors.prepare_fit(nominal, views), model
    )
    gained = 1 - _cost(fitted) / _cost(nominal)
    two_columns = 2 / systematic_errors.prepare_fit(nominal, views).degrees_of_freedom
    assert found.share == pytest.approx(max(gained - two_columns, 0.0), abs=0.001)


def test_a_board_shape_that_was_estimated_explains_no_more() -> None:
    views = _stretched()
    for model in (BoardShapeModel.AFFINE, BoardShapeModel.FREE):
        result = calibrate(views, SIZE, board_shape=model)
        found = systematic_errors.explain_by_board_shape(
            systematic_errors.prepare_fit(result, views), model
        )
        assert found.probability > 0.5
        assert found.share == 0.0


def test_a_lens_explains_what_its_held_coefficients_would() -> None:
    views = scene(barrel(), 10, 1).noisy(0.1, np.random.default_rng(2))
    held, freed = calibrate(views, SIZE, fix=["k2", "k3"]), calibrate(views, SIZE)
    found = systematic_errors.explain_by_lens(systematic_errors.prepare_fit(held, views))
    assert found.share == pytest.approx(1 - _cost(freed) / _cost(held), abs=0.05)
    assert (
        systematic_errors.explain_by_lens(systematic_errors.prepare_fit(freed, views)).probability
        > 0.001
    )


@pytest.mark.parametrize("cost", list(Cost))
def test_every_cost_can_be_examined(cost: Cost) -> None:
    views = scene(barrel(), 8, 1).noisy(0.1, np.random.default_rng(2))
    fit = systematic_errors.prepare_fit(calibrate(views, SIZE, cost=cost), views)
    residual = fit.linearise(slice(0, 8)).residual
    assert np.sqrt(np.mean(residual**2)) == pytest.approx(0.1, rel=0.1)
    for test in (
        systematic_errors.explain_by_lens,
        systematic_errors.explain_by_rows,
        systematic_errors.explain_by_bending,
        systematic_errors.explain_by_lines,
    ):
        assert test(fit).probability > 0.001


def test_weights_divide_the_residuals() -> None:
    views = [v._replace(uv=v.uv[: 40 + k], xy=v.xy[: 40 + k]) for k, v in enumerate(_stretched(4))]
    fit = systematic_errors.prepare_fit(calibrate(views, SIZE, fix=["k2", "k3"]), views)
    sigma = np.array([1.0, 2.0, 4.0, 8.0])
    whole = slice(0, 4)
    plain, weighted = (f.linearise(whole).residual for f in (fit, fit.weigh_views(sigma)))
    assert relative(weighted * sigma[:, None, None], plain) < 1e-12
    assert np.array_equal(fit.predict_corners(whole), fit.weigh_views(sigma).predict_corners(whole))


def test_nothing_is_concluded_from_too_few_corners() -> None:
    found = systematic_errors.judge_explanation(5.0, rank=10, cost=10.0, freedom=10)
    assert found.probability == 1.0
    assert found.share == 0.0


@pytest.mark.slow
def test_probabilities_are_uniform_on_noise() -> None:
    found: list[list[float]] = []
    for seed in range(60):
        true = scene(barrel(), 6, seed)
        views = true.noisy(0.2, np.random.default_rng(seed))
        fit = systematic_errors.prepare_fit(calibrate(views, SIZE), views)
        found.append(
            [
                systematic_errors.explain_by_board_shape(fit, model).probability
                for model in list(BoardShapeModel)[1:]
            ]
            + [systematic_errors.explain_by_lens(fit).probability]
        )
    p: Array = np.array(found)
    assert ((p < 0.05).mean(axis=0) <= 0.15).all()  # 0.05 + 3.5 standard errors
    assert (np.abs((p < 0.5).mean(axis=0) - 0.5) < 0.23).all()

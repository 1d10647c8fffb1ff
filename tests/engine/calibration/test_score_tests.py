"""What lens and board would explain, against calibrations that do explain it and dense algebra."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.residuals.systematic_errors import prepare_fit
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration import score_tests
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.calibration.score_tests import LENS, Explanation, LinearisedFit, SharedCauses
from tests.engine.scenes import BOARD, barrel, looking, scene, seen, uneven

SIZE = barrel().size
FREE = BoardShapeModel.FREE


def _cost(result: Calibration) -> float:
    return sum(float(np.sum(view.image**2)) for view in result.residuals)


def _explain(fit: LinearisedFit, cause: str) -> Explanation:
    return SharedCauses(fit, [cause]).explain(cause)


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
    found = _explain(prepare_fit(nominal, views), model)
    gained = 1 - _cost(fitted) / _cost(nominal)
    two_columns = 2 / prepare_fit(nominal, views).degrees_of_freedom
    assert found.share == pytest.approx(max(gained - two_columns, 0.0), abs=0.001)


def test_a_board_shape_that_was_estimated_explains_no_more() -> None:
    views = _stretched()
    for model in (BoardShapeModel.AFFINE, BoardShapeModel.FREE):
        result = calibrate(views, SIZE, board_shape=model)
        found = _explain(prepare_fit(result, views), model)
        assert found.probability > 0.5
        assert found.share == 0.0


def test_no_causes_explain_nothing() -> None:
    views = scene(barrel(), 6, 1).noisy(0.1, np.random.default_rng(2))
    found = SharedCauses(prepare_fit(calibrate(views, SIZE), views), [])
    assert found.reduce_cost() == (0.0, 0)
    # Of residuals at the minimum the poses' columns leave all.
    assert found.cost_beside_views == pytest.approx(found.cost, rel=1e-6)


def test_a_lens_explains_what_its_held_coefficients_would() -> None:
    views = scene(barrel(), 10, 1).noisy(0.1, np.random.default_rng(2))
    held, freed = calibrate(views, SIZE, fix=["k2", "k3"]), calibrate(views, SIZE)
    found = _explain(prepare_fit(held, views), LENS)
    assert found.share == pytest.approx(1 - _cost(freed) / _cost(held), abs=0.05)
    assert _explain(prepare_fit(freed, views), LENS).probability > 0.001


def _dense_columns(fit: LinearisedFit, cause: str) -> Array:
    """(2KN, m) columns by finite differences of the predicted corners and by np.interp."""
    K = len(fit.state.R)
    whole = slice(0, K)
    predicted = fit.predict_corners(whole)
    weight = fit.get_weight(whole)
    if cause == LENS:
        w, h = SIZE
        columns = []
        for i in range(9):
            for j in range(7):  # 8 by 6 cells
                across = np.interp(predicted[..., 0], np.linspace(0, w - 1, 9), np.eye(9)[i])
                down = np.interp(predicted[..., 1], np.linspace(0, h - 1, 7), np.eye(7)[j])
                hat = across * down
                columns += [np.stack([hat, 0 * hat], -1), np.stack([0 * hat, hat], -1)]
    else:
        xy, step, columns = fit.observations.xy, 1e-3, []
        solid = np.concatenate([xy, np.zeros_like(xy[..., :1])], axis=-1)
        for place in np.unique(xy.reshape(-1, 2), axis=0):
            shown = (xy == place).all(axis=-1)
            for axis in np.eye(3):
                there, back = (
                    replace(
                        fit,
                        observations=replace(
                            fit.observations, xy=solid + sign * step * shown[..., None] * axis
                        ),
                    ).predict_corners(whole)
                    for sign in (1, -1)
                )
                columns.append((there - back) / (2 * step))
    X = np.stack(columns, axis=-1)
    return np.asarray(weight @ X).reshape(-1, X.shape[-1])


def _fit(r: Array, columns: Array) -> Array:
    """What of r, (n,) or (n, K), the columns follow, by least squares."""
    scale = np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
    return np.asarray(columns / scale @ np.linalg.lstsq(columns / scale, r, rcond=1e-7)[0])


def _cost_left(r: Array, columns: Array) -> float:
    """Sum of squares that the columns leave, by least squares."""
    return float(np.sum((r - _fit(r, columns)) ** 2))


def test_reductions_are_those_of_dense_least_squares() -> None:
    views = uneven(barrel(), BOARD, 5, 0.2)
    views = [Observation(v.uv[4 * k :], v.xy[4 * k :]) for k, v in enumerate(views)]
    fit = prepare_fit(calibrate(views, SIZE, fix=["k2", "k3"]), views)
    causes = SharedCauses(fit, [LENS, FREE])
    r, by_params, by_pose = fit.linearise(slice(0, 5))
    poses = np.zeros((5, r[0].size, 5, 6))
    for k in range(5):
        poses[k, :, k] = by_pose[k].reshape(-1, 6)
    own = np.hstack([by_params[..., fit.free].reshape(r.size, -1), poses.reshape(r.size, -1)])
    dense = {cause: _dense_columns(fit, cause) for cause in (LENS, FREE)}
    least = _cost_left(r.ravel(), own)
    assert causes.cost == pytest.approx(float(np.sum(r**2)), rel=1e-12)
    for chosen in ([LENS], [FREE], [LENS, FREE]):
        left = _cost_left(r.ravel(), np.hstack([own, *(dense[cause] for cause in chosen)]))
        T, _ = causes.reduce_cost(*chosen)
        assert T == pytest.approx(least - left, rel=2e-4)

    by_view = (np.eye(5)[:, None] * r.reshape(5, -1)[..., None]).reshape(-1, 5)
    for chosen in ([LENS], [FREE, LENS]):
        after = np.hstack([own, *(dense[cause] for cause in chosen[1:])])
        Q = by_view.T @ (_fit(by_view, np.hstack([after, dense[chosen[0]]])) - _fit(by_view, after))
        Q -= np.diag(np.diag(Q))
        expected = Q.sum() / np.sqrt(2 * np.sum(Q**2))
        assert causes.measure_agreement(*chosen) == pytest.approx(expected, rel=1e-3)


def test_views_do_not_agree_about_noise_that_is_larger_at_the_edges() -> None:
    for seed in range(4):
        rng, agreements = np.random.default_rng(seed), []
        for model in ("lucchese", "pinhole"):
            views = []
            for view in scene(barrel(), 12, seed).views:
                radius = np.linalg.norm(view.uv - np.array(SIZE) / 2, axis=1) / 400
                noise = (0.1 + radius**3)[:, None] * rng.normal(size=view.uv.shape)
                views.append(Observation(view.uv + noise, view.xy))
            causes = SharedCauses(prepare_fit(calibrate(views, SIZE, model=model), views), [LENS])
            assert causes.explain(LENS).probability < 1e-3, "taken for equal errors"
            agreements.append(causes.measure_agreement(LENS))
        assert agreements[0] < score_tests.MIN_AGREEMENT < agreements[1]


def test_what_a_cause_explains_beyond_another_is_judged_by_what_that_leaves() -> None:
    views = uneven(barrel(), BOARD, 12, 0.2)
    causes = SharedCauses(prepare_fit(calibrate(views, SIZE, model="pinhole"), views), [LENS, FREE])
    (T_lens, m_lens), (T, m) = causes.reduce_cost(LENS), causes.reduce_cost(LENS, FREE)
    expected = score_tests.judge_explanation(
        T - T_lens, m - m_lens, causes.cost - T_lens, causes.freedom - m_lens
    )
    assert causes.explain(FREE, LENS) == expected
    assert 0.5 < expected.share < 0.99  # the board is off, too
    assert causes.explain(FREE).share > 0.3  # and is blamed for the lens if judged alone


def test_nothing_is_concluded_from_too_few_corners() -> None:
    found = score_tests.judge_explanation(5.0, rank=10, cost=10.0, freedom=10)
    assert found.probability == 1.0
    assert found.share == 0.0


@pytest.mark.slow
def test_probabilities_are_uniform_on_noise() -> None:
    found: list[list[float]] = []
    for seed in range(60):
        true = scene(barrel(), 6, seed)
        views = true.noisy(0.2, np.random.default_rng(seed))
        fit = prepare_fit(calibrate(views, SIZE), views)
        found.append(
            [_explain(fit, model).probability for model in list(BoardShapeModel)[1:]]
            + [_explain(fit, LENS).probability]
        )
    p: Array = np.array(found)
    assert ((p < 0.05).mean(axis=0) <= 0.15).all()  # 0.05 + 3.5 standard errors
    assert (np.abs((p < 0.5).mean(axis=0) - 0.5) < 0.23).all()


@pytest.mark.parametrize("error", [0.0, 0.15])
def test_a_board_of_many_corners_takes_bounded_memory(error: float) -> None:
    """Its shape is then smooth, which explains all but noise of a print that is off smoothly."""
    board, rng = Board(30, 40, 7.0), np.random.default_rng(2)
    poses = [looking(barrel(), rng, board=board) for _ in range(5)]
    views = seen(barrel(), poses, board).noisy(0.1, rng)
    printed = views[0].xy + error * np.sin(views[0].xy[:, ::-1] / 30)
    views = [Observation(view.uv, printed) for view in views]
    fit = prepare_fit(calibrate(views, SIZE), views)
    causes = SharedCauses(fit, [FREE])
    assert causes.reduce_cost(FREE)[1] < 3 * score_tests.MAX_FREE_CORNERS < 3 * 30 * 40
    found = causes.explain(FREE)
    noise = 0.1**2 * causes.freedom / causes.cost
    assert found.share == pytest.approx(1 - noise, abs=0.03)
    assert (found.probability < 1e-9) == (error > 0)

"""Cross-validation, the choice of a board shape and the bootstrap, on scenes of known truth."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.assessment.changes.comparison import compare_cameras
from calibgui.engine.assessment.choices.cross_validation import (
    bootstrap_views,
    choose_board_shape,
    cross_validate,
)
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.methods import lucchese
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.errors import CalibrationError
from tests.engine.scenes import BOARD, TRUE_BOARD, barrel, looking, scene
from tests.faults.sets import project_corners

SIZE = barrel().size


def _views(count: int, seed: int = 0) -> list[Observation]:
    return scene(barrel(), count, seed).noisy(0.2, np.random.default_rng(seed))


def _on_wide_squares(count: int) -> list[Observation]:
    """Views of a board whose squares are 0.5 % wider than they are said to be."""
    return [
        Observation(view.uv, view.xy / np.array([1.005, 1.0]))
        for view in scene(barrel(), count).noisy(0.1, np.random.default_rng(3))
    ]


def test_every_view_is_held_out_once() -> None:
    found = cross_validate(_views(11), SIZE, folds=4)
    held_out = np.concatenate([fold.views for fold in found.folds])
    assert sorted(held_out.tolist()) == list(range(11))
    assert found.by_view.shape == (11,)
    pooled = np.sqrt(np.mean(found.by_view**2))  # all views have as many corners
    assert found.held_out == pytest.approx(pooled)


def test_a_fold_is_a_calibration_of_the_others() -> None:
    views = _views(9)
    fold = cross_validate(views, SIZE, folds=3, fix=["k3"]).folds[1]
    others = [view for k, view in enumerate(views) if k not in fold.views]
    assert np.array_equal(fold.camera.params, calibrate(others, SIZE, fix=["k3"]).camera.params)


@pytest.mark.parametrize("model", ["lucchese", "kannala-brandt"])
def test_folds_that_begin_at_a_calibration_end_where_others_do(
    model: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    views = _views(9)
    start = calibrate(views, SIZE, model=model)
    guessed = cross_validate(views, SIZE, 3, model=model)
    monkeypatch.setattr(lucchese, "initialise_stage_two", None)  # nothing is guessed
    begun = cross_validate(views, SIZE, 3, start, model=model)
    np.testing.assert_allclose(begun.by_view, guessed.by_view, rtol=1e-5)


def test_unseen_views_fit_worse() -> None:
    found = cross_validate(_views(10), SIZE)
    assert found.training < found.held_out < 1.1 * found.training


def test_the_same_answer_twice() -> None:
    first, second = (cross_validate(_views(8), SIZE, 4) for _ in range(2))
    assert first.held_out == second.held_out


@pytest.mark.parametrize("folds", [1, 5])
def test_folds_must_hold_views(folds: int) -> None:
    with pytest.raises(CalibrationError, match="folds"):
        cross_validate(_views(4), SIZE, folds)


def test_a_true_board_is_kept() -> None:
    choice = choose_board_shape(_views(10), SIZE)
    assert choice.model is BoardShapeModel.NOMINAL
    assert choice.chosen is choice.nominal
    assert "Keep the board as drawn" in choice.recommendation
    assert set(choice.validations) == set(BoardShapeModel)


def test_a_wrong_board_is_described_with_figures() -> None:
    choice = choose_board_shape(_on_wide_squares(10), SIZE)
    assert choice.model is BoardShapeModel.AFFINE
    error, nominal_error = (
        np.abs(result.camera.focal - barrel().focal).max()
        for result in (choice.chosen, choice.nominal)
    )
    assert error < 0.5 * nominal_error
    assert "deviates by" in choice.recommendation
    assert "moves fx by" in choice.recommendation


@pytest.mark.parametrize("shape", ["affine", "free"])
def test_shapes_end_where_their_cross_validation_does(shape: str) -> None:
    """The choice leads the fit of all views on to those of a fold, with the weights of all."""
    views = [  # two kinds of corners, all far better than the model: the weights matter
        view._replace(
            cov=np.where(np.arange(len(view.uv)) % 2, 1e-3, 4e-3)[:, None, None] * np.eye(2)
        )
        for view in _on_wide_squares(14)
    ]
    views[3] = Observation(*(array[:-6] for array in views[3]))  # a part of the board
    nominal = calibrate(views, SIZE)
    choice = choose_board_shape(views, SIZE, 2, nominal)
    assert choice.nominal is nominal
    alone = cross_validate(views, SIZE, 2, nominal, board_shape=shape)
    found = choice.validations[BoardShapeModel(shape)]
    np.testing.assert_allclose(found.by_view, alone.by_view, rtol=1e-3)
    assert found.training == pytest.approx(alone.training, rel=1e-4)
    assert found.held_out == pytest.approx(alone.held_out, rel=3e-4)


def test_no_board_shape_stands_in_for_a_lens_that_is_not_followed() -> None:
    choice = choose_board_shape(_views(10), SIZE, model="pinhole")
    assert choice.model is BoardShapeModel.NOMINAL
    assert choice.chosen is choice.nominal
    assert set(choice.validations) == {BoardShapeModel.NOMINAL}
    assert set(choice.refused) == set(BoardShapeModel) - {BoardShapeModel.NOMINAL}
    assert "The lens comes first" in choice.recommendation
    assert f"{choice.nominal.lens_error:.2g} px" in choice.recommendation


def test_a_board_far_from_flat_is_estimated_where_a_flat_one_leads_astray() -> None:
    """It is bowed by 14 % of its length, and some of its views do not determine a camera with a
    flat board."""
    angle = 0.58  # to both sides, on a cylinder
    rng = np.random.default_rng([5, 0])
    xy = BOARD.points()
    middle, half = (xy.min(axis=0) + xy.max(axis=0)) / 2, np.ptp(xy[:, 0]) / 2
    turn = (xy[:, 0] - middle[0]) / half * angle
    x, z = half / angle * np.sin(turn), half / angle * (np.cos(turn) - np.cos(angle))
    bowed = np.column_stack([middle[0] + x, xy[:, 1], z])
    views = [
        Observation(project_corners(barrel(), looking(barrel(), rng), bowed), xy) for _ in range(8)
    ]
    views = [view._replace(uv=view.uv + rng.normal(0, 0.05, view.uv.shape)) for view in views]
    choice = choose_board_shape(views, SIZE)
    assert choice.model is BoardShapeModel.FREE
    assert compare_cameras(barrel(), choice.nominal.camera, views=views).rms > 50
    assert compare_cameras(barrel(), choice.chosen.camera, views=views).rms < 0.2


def test_board_shapes_that_the_views_cannot_carry_are_named() -> None:
    choice = choose_board_shape(_views(5), SIZE)
    assert "needs 6" in choice.refused[BoardShapeModel.FREE]


@pytest.mark.slow
def test_bootstrap_confirms_the_sigma_of_good_data() -> None:
    found = bootstrap_views(_views(25), SIZE, draws=150)
    assert found.failed == 0
    assert np.isnan(found.ratio[9])  # p3 is held
    assert 0.8 < np.median(found.ratio[:9]) < 1.2


@pytest.mark.slow
def test_bootstrap_confirms_what_the_views_disagreement_says() -> None:
    """Errors that corners of a view share: the corners' noise alone would be too little."""
    rng = np.random.default_rng(5)
    views = [  # the board bends anew in every view
        Observation(view.uv + 0.4 * rng.normal(size=2) * np.sin(view.xy / 60), view.xy)
        for view in _views(25)
    ]
    found = bootstrap_views(views, SIZE, draws=60, prior=TRUE_BOARD)
    reported = calibrate(views, SIZE, prior=TRUE_BOARD)
    assert 0.7 < np.median(found.ratio[:9]) < 1.3
    assert np.median(found.sigma[:9] / reported.sigma_by_noise[:9]) > 1.3


def test_bootstrap_counts_draws_that_fail() -> None:
    found = bootstrap_views(_views(2), SIZE, draws=30)
    assert 0 < found.failed < 30  # the same view twice determines nothing
    assert len(found.params) == 30 - found.failed

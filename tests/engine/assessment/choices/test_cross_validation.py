"""Cross-validation and the bootstrap, on scenes of known truth."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.assessment.choices.cross_validation import (
    bootstrap_views,
    cross_validate,
)
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.methods import lucchese
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.errors import CalibrationError
from tests.engine.scenes import TRUE_BOARD, barrel, scene

SIZE = barrel().size


def _views(count: int, seed: int = 0) -> list[Observation]:
    return scene(barrel(), count, seed).noisy(0.2, np.random.default_rng(seed))


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


@pytest.mark.slow
def test_bootstrap_confirms_the_sigma_of_good_data() -> None:
    found = bootstrap_views(_views(25), SIZE, draws=80)
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
    found = bootstrap_views(views, SIZE, draws=40, prior=TRUE_BOARD)
    reported = calibrate(views, SIZE, prior=TRUE_BOARD)
    assert 0.7 < np.median(found.ratio[:9]) < 1.3
    assert np.median(found.sigma[:9] / reported.sigma_by_noise[:9]) > 1.3


def test_bootstrap_counts_draws_that_fail() -> None:
    found = bootstrap_views(_views(2), SIZE, draws=30)
    assert 0 < found.failed < 30  # the same view twice determines nothing
    assert len(found.params) == 30 - found.failed

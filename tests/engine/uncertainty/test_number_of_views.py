"""The number of views: predicted, grown and calibrated sets against each other."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.errors import CalibrationError
from calibgui.engine.uncertainty.number_of_views import QUANTITIES, study_number_of_views
from calibgui.engine.uncertainty.view_design import build_design
from tests.engine.scenes import TRUE_BOARD, barrel, brown, scene

SIZE = barrel().size


def _calibrated(count: int, noise: float = 0.2) -> tuple[Calibration, list[Observation]]:
    views = scene(barrel(), count, seed=1).noisy(noise, np.random.default_rng(2))
    return calibrate(views, SIZE, prior=TRUE_BOARD), views


def test_study_falls_with_the_number_of_views() -> None:
    whole, views = _calibrated(10)
    found = study_number_of_views(whole, views)
    assert found.counts.tolist() == list(range(2, 11))
    assert (np.diff(found.random[1:, 1], axis=0) < 0).all()
    assert (found.random[:, 0] <= found.random[:, 2]).all()
    assert (found.chosen[:-1, 2] < found.random[:-1, 1, 2]).all()
    assert found.chosen[-1] == pytest.approx(found.random[-1, 1])
    assert np.isnan(found.scatter).all()
    assert [len(members) for members in found.sets] == found.counts.tolist()


def test_chosen_sets_are_nearly_the_best() -> None:
    whole, views = _calibrated(9)
    choice = build_design(whole, views)
    for members in study_number_of_views(whole, views).sets[1:4]:
        sets = list(combinations(range(9), len(members)))
        every = np.zeros((len(sets), 9))
        np.put_along_axis(every, np.array(sets), 1.0, axis=1)
        grown = np.isin(np.arange(9), members).astype(float)
        assert choice.compute_loss(grown) <= 1.1 * choice.compute_loss(every).min()


def test_enough_is_where_the_curve_stays_below() -> None:
    whole, views = _calibrated(10)
    found = study_number_of_views(whole, views)
    middle = found.random[:, 1, QUANTITIES.index("focal length")]
    assert found.find_sufficient_count("focal length", float(middle[4]) * 1.001) == 6
    assert found.find_sufficient_count("focal length", 1e-9) is None
    assert found.find_sufficient_count("focal length", 1e9) == 2
    few, many = (
        found.find_sufficient_count("projection", float(found.random[5, 1, 2]), c)
        for c in (True, False)
    )
    assert few is not None
    assert many is not None
    assert few < many


@pytest.mark.slow
def test_calibrated_sets_scatter_as_predicted() -> None:
    whole, views = _calibrated(30)
    calls: list[tuple[int, int]] = []
    found = study_number_of_views(
        whole, views, solved=30, progress=lambda done, of: calls.append((done, of))
    )
    assert calls[-1] == (27, 27)
    some = (found.counts >= 6) & (found.counts <= 20)
    ratio = found.scatter[some] / found.random[some, 1, :2]
    assert 0.85 < np.median(ratio) < 1.15


@pytest.mark.slow
def test_every_calibrated_set_estimates_its_own_board_shape() -> None:
    """Sets that were given the board shape of all views would hardly scatter."""
    views = scene(barrel(), 12, seed=1).noisy(0.2, np.random.default_rng(2))
    found = study_number_of_views(calibrate(views, SIZE, board_shape="free"), views, solved=12)
    carried = found.counts[:-1] >= 6
    assert np.isnan(found.scatter[:-1][~carried]).all()
    ratio = found.scatter[:-1][carried] / found.random[:-1, 1, :2][carried]
    assert (ratio.mean(axis=0) > 0.85).all()


def test_too_few_views_for_a_study() -> None:
    whole, views = _calibrated(3)
    with pytest.raises(CalibrationError, match="too few"):
        study_number_of_views(whole, views[:2])


def test_another_lens_model() -> None:
    views = scene(brown(), 5, seed=1).noisy(0.2, np.random.default_rng(2))
    result = calibrate(views, SIZE, model="brown-conrady")
    assert study_number_of_views(result, views).chosen[-1, 2] < 1

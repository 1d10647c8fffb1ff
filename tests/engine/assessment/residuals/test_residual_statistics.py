"""Residual statistics on numbers whose statistics are known."""

from __future__ import annotations

import numpy as np
import pytest
import scipy

from calibgui.engine.assessment.residuals import residual_statistics
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.result import ViewResiduals
from tests.engine.scenes import barrel, scene

RNG = np.random.default_rng(0)


def test_summary_is_of_all_corners_of_all_views() -> None:
    a, b = RNG.normal(size=(30, 2)) * [0.1, 0.3], RNG.normal(size=(50, 2)) * [0.1, 0.3] + 0.05
    found = residual_statistics.summarise_residuals(
        [ViewResiduals(a, 2 * a), ViewResiduals(b, 2 * b)]
    )
    both = np.vstack([a, b])
    assert found.count == 80
    assert found.rms == pytest.approx(np.sqrt((both**2).sum(axis=1).mean()))
    assert (found.sigma_x, found.sigma_y) == pytest.approx(tuple(both.std(axis=0)))
    typical = (a.std(axis=0) + b.std(axis=0)) / 2  # the median of two
    assert (found.median_sigma_x, found.median_sigma_y) == pytest.approx(tuple(typical))
    length = 2 * np.hypot(*both.T)
    assert (found.reference_mean, found.reference_sd) == pytest.approx(
        (length.mean(), length.std())
    )


def test_corners_without_a_place_on_the_board_are_left_out() -> None:
    image, reference = RNG.normal(size=(2, 20, 2))
    reference[3:] = np.nan
    found = residual_statistics.summarise_residuals([ViewResiduals(image, reference)])
    assert found.reference_mean == pytest.approx(np.hypot(*reference[:3].T).mean())
    reference[:] = np.nan  # warnings are errors: nothing may be said of an empty mean
    found = residual_statistics.summarise_residuals([ViewResiduals(image, reference)])
    assert np.isnan([found.reference_mean, found.reference_sd]).all()
    assert found.count == 20


def test_component_histogram_finds_its_gaussian() -> None:
    values = RNG.normal(0.02, 0.1, size=200_000)
    found = residual_statistics.make_component_histogram(values)
    width = np.diff(found.edges)
    assert np.sum(found.density * width) == pytest.approx(1.0)
    assert found.edges[0] == -found.edges[-1]
    assert not found.is_rayleigh
    assert found.sd == found.scale == pytest.approx(0.1, rel=0.01)
    middle = (found.edges[1:] + found.edges[:-1]) / 2
    # A bin near the top holds 1e4 values: 1 % of noise, and its width blurs another.
    np.testing.assert_allclose(
        found.density, found.evaluate_density(middle), atol=0.04 * found.density.max()
    )


def test_length_histogram_finds_its_rayleigh() -> None:
    values = np.hypot(*RNG.normal(scale=0.1, size=(2, 200_000)))
    found = residual_statistics.make_length_histogram(values)
    assert found.is_rayleigh
    assert found.edges[0] == 0.0
    assert found.scale == pytest.approx(0.1, rel=0.01)
    assert found.mean == pytest.approx(0.1 * np.sqrt(np.pi / 2), rel=0.01)
    middle = (found.edges[1:] + found.edges[:-1]) / 2
    np.testing.assert_allclose(
        found.density, found.evaluate_density(middle), atol=0.04 * found.density.max()
    )
    assert found.evaluate_density(np.array([-1.0, 0.0])).tolist() == [0.0, 0.0]


@pytest.mark.parametrize("rayleigh", [False, True])
def test_fitted_densities_have_unit_area(rayleigh: bool) -> None:
    found = residual_statistics.Histogram(np.zeros(2), np.zeros(1), 0.0, 0.1, 0.1, rayleigh)
    x = np.linspace(-2, 2, 40_001)
    assert np.sum(found.evaluate_density(x)) * (x[1] - x[0]) == pytest.approx(1.0)


def test_no_spread_is_no_failure() -> None:
    assert residual_statistics.make_component_histogram(np.zeros(3)).sd == 0.0
    assert residual_statistics.make_length_histogram(np.zeros(3)).scale == 0.0


def test_residuals_that_are_none_are_left_out() -> None:
    values = np.array([1.0, np.nan, 2.0, 3.0])
    for histogram in (
        residual_statistics.make_component_histogram,
        residual_statistics.make_length_histogram,
    ):
        there = histogram(values[np.isfinite(values)])
        np.testing.assert_array_equal(histogram(values).density, there.density)
        assert histogram(values).scale == there.scale


def test_stacked_residuals_of_a_calibration() -> None:
    made = scene(barrel(), 4)
    found = calibrate(made.noisy(0.1, RNG), made.size)
    image = residual_statistics.stack_residuals(found, on_reference=False)
    assert (
        image.shape
        == residual_statistics.stack_residuals(found, on_reference=True).shape
        == (432, 2)
    )
    # 0.1 px of noise, of which the 33 unknowns absorb their share of 864 coordinates.
    assert image.std() == pytest.approx(0.1 * np.sqrt(1 - 33 / 864), rel=0.08)


def test_a_few_bad_corners_do_not_make_one_bar_of_all_others() -> None:
    rng = np.random.default_rng(3)
    residuals = np.concatenate([rng.normal(scale=0.1, size=(1000, 2)), [[9.0, -7.0], [-8.0, 5.0]]])
    for histogram in (
        residual_statistics.make_component_histogram(residuals[:, 0]),
        residual_statistics.make_component_histogram(residuals[:, 1]),
        residual_statistics.make_length_histogram(np.linalg.norm(residuals, axis=1)),
    ):
        assert histogram.outside == 2
        assert histogram.edges[-1] < 0.7
        area = histogram.density @ np.diff(histogram.edges)
        assert area == pytest.approx(1000 / 1002)


def test_a_histogram_holds_all_values_where_most_are_zero() -> None:
    values = np.array([0.0, 0.0, 0.0, 0.2])
    assert residual_statistics.make_component_histogram(values).outside == 0
    assert residual_statistics.make_length_histogram(values).outside == 0


@pytest.mark.parametrize("n", [30, 400, 20_000])
@pytest.mark.parametrize("tails", [3, 30, None])
def test_the_chance_of_a_fourth_moment_is_that_of_scipy(n: int, tails: int | None) -> None:
    rng = np.random.default_rng(n)
    values = rng.uniform(-1, 1, n) if tails is None else rng.standard_t(tails, n)
    expected = scipy.stats.kurtosistest(values).pvalue
    chance = residual_statistics.compute_kurtosis_chance(values)
    assert chance == pytest.approx(expected, rel=1e-9, abs=1e-300)

"""How far the solve reaches: a sample of ``tests.benchmarks.convergence``."""

from __future__ import annotations

import pytest

from tests.engine.random_problems import outcome

pytestmark = pytest.mark.slow


def test_random_problems_reach_the_minimum() -> None:
    outcomes = [outcome(seed) for seed in range(1000, 1030)]
    missed = [(result.seed, result.words) for result in outcomes if not result.reached]
    # Measured: 8 of 9,000, where several minima are equally good but for noise. That one in 20 is
    # missed is told as often as of 60 with one that may be missed.
    assert not missed


def test_a_mirrored_tilt_whose_right_one_the_wrong_camera_cannot_image_is_righted() -> None:
    found = outcome(203944)
    assert found.reached, found.words


def test_the_lower_of_two_lows_in_a_valley_is_found() -> None:
    """Four views at 1 px of noise, whose principal point and coefficients trade for each other."""
    found = outcome(6147)
    assert found.reached, found.words

"""How far corners go towards their places with gradients of light of their own."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.corner_fit.light_gradients import estimate_stray_light

COST = np.array([[4e-5, 1e-5], [1e-5, 2e-5]])
COUNT = 400


def draw_shifts(times: float) -> Array:
    """Draw shifts of a covariance `times` that of gradients which are not needed."""
    rng = np.random.default_rng(0)
    return rng.multivariate_normal(np.zeros(2), times * COST, COUNT)


def estimate(times: float, clipped: bool = False, n: int = COUNT) -> tuple[float, float]:
    """Estimate the share and how often the cost is added, from `n` corners that count."""
    usable = np.arange(COUNT) < n
    lost = np.broadcast_to(COST, (COUNT, 2, 2))
    share, added = estimate_stray_light(
        draw_shifts(times), lost, usable, np.full(COUNT, clipped, dtype=np.bool_)
    )
    assert np.ptp(added) == 0
    return share, float(added[0])


def test_gradients_of_the_board_are_kept_where_they_are_right() -> None:
    assert estimate(1.0) == (0.0, 0.0)
    assert estimate(0.45, clipped=True) == (0.0, 0.0)


def test_few_corners_tell_nothing() -> None:
    assert estimate(4.0, n=15) == (0.0, 0.0)


def test_corners_go_as_far_as_their_shifts_are_too_large() -> None:
    share, added = estimate(4.0)
    assert share == pytest.approx(0.75, abs=0.05)
    assert added == share


def test_light_in_clipped_squares_is_not_seen() -> None:
    share, added = estimate(4 * 0.45, clipped=True)
    assert share == pytest.approx(0.75, abs=0.05)
    assert added == pytest.approx(0.75 + 0.5 * 3 * 0.45, rel=0.2)

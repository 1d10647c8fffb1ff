"""What is seen beyond the lines of a grid of circles."""

from __future__ import annotations

import numpy as np

from calibgui.engine.detection.circles.continuation import _compute_medians


def test_medians_leave_out_what_is_not_seen() -> None:
    rng = np.random.default_rng(0)
    levels = rng.uniform(0, 255, (200, 4))
    levels[rng.random(levels.shape) < 0.4] = np.nan
    levels[np.isnan(levels).all(axis=1), 2] = 7.0
    np.testing.assert_array_equal(_compute_medians(levels), np.nanmedian(levels, axis=1))

"""A comparison of methods on one synthetic scene, for the tests of what shows it."""

from __future__ import annotations

from functools import cache
from unittest.mock import patch

import numpy as np

from calibgui.engine.assessment.choices import method_comparison
from calibgui.engine.assessment.choices.method_comparison import MethodComparison
from tests.engine.scenes import VGA, brown, scene

TRUTH = brown()
NOISE = 0.1
"""Standard deviation of the corners along each axis, px."""


_SLOW = ("weng", "zhang-alternation")
"""Names of methods that take hundreds of turns, without which a comparison is quick."""


@cache
def compare_on_a_scene() -> MethodComparison:
    """Compare all methods but the slow ones on six views of a lens of Bouguet's model."""
    views = scene(TRUTH, 6, seed=3).noisy(NOISE, np.random.default_rng(4))
    listed = method_comparison.list_compared_methods()
    few = {name: method for name, method in listed.items() if name not in _SLOW}
    with patch.object(method_comparison, "list_compared_methods", lambda: few):
        return method_comparison.compare_methods(views, VGA, folds=2)

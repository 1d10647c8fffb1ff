"""What is known of the shape of a board beforehand."""

from __future__ import annotations

import pytest

from calibgui.engine.boards.shape import BoardShapePrior
from calibgui.engine.errors import CalibrationError


@pytest.mark.parametrize("accuracy", [(0.0, 0.1), (0.1, -1.0), (float("nan"), 0.1)])
def test_standard_deviations_are_positive(accuracy: tuple[float, float]) -> None:
    with pytest.raises(CalibrationError, match="no standard deviations"):
        BoardShapePrior(*accuracy)

"""Lengths of a pattern are ratios to its pitch, and what is said of them is so, too."""

from __future__ import annotations

import pytest

from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.errors import CalibrationError


@pytest.mark.parametrize(
    ("asymmetric", "diameter", "below"), [(False, 12.0, "1.00"), (True, 1.5, "1.41")]
)
def test_a_diameter_is_a_ratio(asymmetric: bool, diameter: float, below: str) -> None:
    with pytest.raises(CalibrationError) as refused:
        Circles(asymmetric, diameter)
    assert f"diameter is {diameter:g} of the distance of their rows" in refused.value.message
    assert f"below {below}" in refused.value.message
    assert "ratio" in refused.value.hint and "diameter=12 / 20" in refused.value.hint
    assert Circles(diameter=12 / 20).diameter == 0.6


def test_a_marker_is_a_ratio() -> None:
    with pytest.raises(CalibrationError) as refused:
        Charuco(marker=30.0)
    assert "marker is 30 of the side of its square" in refused.value.message
    assert "ratio" in refused.value.hint and "marker=30 / 40" in refused.value.hint
    assert Charuco(marker=30 / 40).marker == 0.75

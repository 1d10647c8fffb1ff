"""Numbers in sentences have two digits and no power of ten that one would have to work out."""

from __future__ import annotations

import pytest

from calibgui.engine.numbers import format_two_digits


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.01, "0.010"),
        (0.0444, "0.044"),
        (0.99, "0.99"),
        (0.999, "1.0"),
        (9.94, "9.9"),
        (9.96, "10"),
        (271.3, "270"),
        (33_800.0, "34,000"),
        (float("inf"), "inf"),
    ],
)
def test_two_digits(value: float, text: str) -> None:
    assert format_two_digits(value) == text

"""Numbers are cut to what their uncertainty supports."""

from __future__ import annotations

import math

import pytest

from calibgui.report.numbers import format_count, format_with_sigma


@pytest.mark.parametrize(
    ("value", "sigma", "text"),
    [
        (657.2985, 0.1234, "657.30 ± 0.12"),
        (657.2985, 12.34, "657 ± 12"),
        (-0.0634, 0.0421, "-0.063 ± 0.042"),
        (0.0, 0.5, "0.00 ± 0.50"),
        (5.71e-7, 2.87e-8, "(5.71 ± 0.29)e-7"),
        (-2.06e-18, 4.58e-18, "(-2.1 ± 4.6)e-18"),
        (1234567.0, 1000.0, "(1.2346 ± 0.0010)e6"),
        (999.97, 0.0996, "999.97 ± 0.10"),
        (3.0, 0.0, "3"),
        (3.0, math.nan, "3"),
        (-0.001, 0.1, "0.00 ± 0.10"),
        (-1e-9, 0.1, "0.00 ± 0.10"),
        (-0.0, 0.0, "0"),
    ],
)
def test_digits_follow_sigma(value: float, sigma: float, text: str) -> None:
    assert format_with_sigma(value, sigma) == text


def test_counts_agree_with_their_noun() -> None:
    assert [format_count(n, "view") for n in (0, 1, 3900)] == ["0 views", "1 view", "3,900 views"]

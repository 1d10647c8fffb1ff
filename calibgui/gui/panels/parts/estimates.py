"""Columns of estimates, the same wherever a table shows any."""

from __future__ import annotations

from collections.abc import Iterable

from calibgui.gui.widgets.tables import Column, with_digits
from calibgui.report.numbers import format_with_sigma


def estimate_columns(
    title: str, values: Iterable[float], sigma: Iterable[float]
) -> tuple[Column, Column]:
    """A column of values ± 1σ, and a hidden one of σ alone for CSV."""
    values, sigma = [float(v) for v in values], [float(s) for s in sigma]
    texts = dict(zip(values, map(format_with_sigma, values, sigma), strict=True))
    return (
        Column(f"{title} ± 1σ", values, texts.__getitem__),
        Column("1σ", sigma, with_digits(2), hidden=True),
    )

"""Columns of estimates, the same wherever a table shows any."""

from __future__ import annotations

from collections.abc import Iterable

from calibgui.gui.tables import Column, number
from calibgui.report.numbers import with_sigma


def estimate_columns(
    title: str, values: Iterable[float], sigma: Iterable[float]
) -> tuple[Column, Column]:
    """A column of values ± 1σ, and a hidden one of σ alone for CSV."""
    values, sigma = [float(v) for v in values], [float(s) for s in sigma]
    texts = dict(zip(values, map(with_sigma, values, sigma), strict=True))
    return (
        Column(f"{title} ± 1σ", values, texts.__getitem__),
        Column("1σ", sigma, number(2), hidden=True),
    )

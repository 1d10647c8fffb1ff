"""Plots of a fleet as SVG in a page of HTML, in the page's colours, light and dark.

They are text of a few kilobytes each: matplotlib would take minutes for the pages of a thousand
cameras. Classes name what the page's style colours: ``bar``, ``mark``, ``good``, ``bad``, ``axis``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from html import escape
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array

_WIDTH, _HEIGHT = 300, 150
_LEFT, _RIGHT, _TOP, _BOTTOM = 56, 10, 20, 32
"""Margins around the axes, in units of the drawing."""
_MAX_BARS = 24
"""Largest number of bars of a histogram."""


class Measured(NamedTuple):
    """A value with its standard deviation at a time."""

    date: str
    """ISO date."""
    value: float
    sigma: float
    is_good: bool
    """True if it is drawn as good."""
    name: str
    """What it is of, which is shown under the cursor."""


@dataclass(frozen=True, slots=True)
class Histogram:
    """The distribution of values, laid out once for the pages of all cameras."""

    title: str
    """What the values are, with their unit."""
    low: float
    """Left end of the axis."""
    high: float
    """Right end of the axis."""
    parts: tuple[str, ...]
    """The bars and axes as SVG."""

    def draw(self, mark: float = math.nan) -> str:
        """Draw the histogram, with a value marked among the others unless it is not finite."""
        parts = list(self.parts)
        if math.isfinite(mark):
            x = _place_x(min(max(mark, self.low), self.high), self.low, self.high)
            parts.append(
                f'<line class="mark" x1="{x:.1f}" x2="{x:.1f}" y1="{_TOP}" '
                f'y2="{_HEIGHT - _BOTTOM}"><title>this camera: {mark:.6g}</title></line>'
            )
        return _wrap(self.title, parts)


def make_histogram(values: Sequence[float], title: str) -> Histogram | None:
    """Lay a histogram out; None if no value is finite.

    Outliers do not stretch it: values beyond are counted in a note, as are those that are unknown.
    """
    known = np.array([value for value in values if math.isfinite(value)])
    if not known.size:
        return None
    low, high = _choose_range(known)
    bins = min(_MAX_BARS, max(2 * math.isqrt(known.size), 4))
    counts, edges = np.histogram(known, bins, (low, high))
    highest, ends, step = int(counts.max()), edges.tolist(), (high - low) / bins
    parts = []
    for count, (left, right) in zip(counts.tolist(), pairwise(ends), strict=True):
        x, end = _place_x(left, low, high), _place_x(right, low, high)
        y = _place_y(count, 0, highest)
        if count:
            parts.append(
                f'<rect class="bar" x="{x:.1f}" y="{y:.1f}" width="{end - x - 1:.1f}" '
                f'height="{_HEIGHT - _BOTTOM - y:.1f}"><title>{count} from '
                f"{_format(left, step)} to {_format(right, step)}</title></rect>"
            )
    beyond = int(np.sum((known < low) | (known > high)))
    unknown = len(values) - known.size
    notes = [f"{beyond} beyond"] * bool(beyond) + [f"{unknown} unknown"] * bool(unknown)
    parts += _draw_axes(0, highest, ", ".join(notes)) + _label_ends(
        _format(low, step), _format(high, step)
    )
    return Histogram(title, low, high, tuple(parts))


def draw_history(points: Sequence[Measured], title: str) -> str:
    """Draw values with one standard deviation over time.

    Args:
        points: the values, by date.
        title: what they are, with their unit.
    """
    known = [one for one in points if math.isfinite(one.value)]
    times = [_read_time(one.date) for one in known]
    placed = [(t, one) for t, one in zip(times, known, strict=True) if t is not None]
    if len(placed) < 2:
        return ""
    sigma = [one.sigma if math.isfinite(one.sigma) else 0.0 for _, one in placed]
    low = min(one.value - s for (_, one), s in zip(placed, sigma, strict=True))
    high = max(one.value + s for (_, one), s in zip(placed, sigma, strict=True))
    low, high = _widen(low, high)
    first, last = _widen(placed[0][0], placed[-1][0])
    line = " ".join(
        f"{_place_x(t, first, last):.1f},{_place_y(one.value, low, high):.1f}" for t, one in placed
    )
    parts = [f'<polyline class="line" points="{line}"/>']
    for (t, one), s in zip(placed, sigma, strict=True):
        x = _place_x(t, first, last)
        top, end = _place_y(one.value + s, low, high), _place_y(one.value - s, low, high)
        colour = "good" if one.is_good else "bad"
        parts.append(
            f'<g class="{colour}"><title>{escape(one.name)}, {escape(one.date)}: {one.value:.6g} '
            f'± {one.sigma:.2g}</title><line x1="{x:.1f}" x2="{x:.1f}" y1="{top:.1f}" '
            f'y2="{end:.1f}"/><circle cx="{x:.1f}" cy="{_place_y(one.value, low, high):.1f}" '
            'r="3"/></g>'
        )
    parts += _draw_axes(low, high, "") + _label_ends(placed[0][1].date, placed[-1][1].date)
    return _wrap(title, parts)


def _choose_range(values: Array) -> tuple[float, float]:
    """Return limits that outliers do not stretch: the quartiles and five times their distance."""
    first, last = np.percentile(values, [25, 75])
    reach = 5 * (last - first)
    low, high = max(values.min(), first - reach), min(values.max(), last + reach)
    return (float(low), float(high)) if high > low else _widen(float(low), float(high))


def _widen(low: float, high: float) -> tuple[float, float]:
    """Return limits that are apart."""
    rim = 0.03 * (high - low) if high > low else max(abs(low), 1.0) * 1e-3
    return low - rim, high + rim


def _place_x(value: float, low: float, high: float) -> float:
    return _LEFT + (value - low) / (high - low) * (_WIDTH - _LEFT - _RIGHT)


def _place_y(value: float, low: float, high: float) -> float:
    return _HEIGHT - _BOTTOM - (value - low) / (high - low) * (_HEIGHT - _TOP - _BOTTOM)


def _format(value: float, step: float) -> str:
    """Format a value so that it differs from one that is a step away."""
    ratio = max(abs(value) / step, 1.0) if step > 0 else 1.0
    return f"{value:.{2 + math.ceil(math.log10(ratio))}g}"


def _draw_axes(low: float, high: float, note: str) -> list[str]:
    """Draw axes with the ends of the vertical one, and a note below."""
    floor, end = _HEIGHT - _BOTTOM, _WIDTH - _RIGHT
    ends = _format(low, high - low), _format(high, high - low)
    return [
        f'<path class="axis" d="M{_LEFT},{_TOP}V{floor}H{end}"/>',
        f'<text x="{_LEFT - 4}" y="{floor}" text-anchor="end">{ends[0]}</text>',
        f'<text x="{_LEFT - 4}" y="{_TOP + 8}" text-anchor="end">{ends[1]}</text>',
        f'<text x="{(_LEFT + end) / 2:g}" y="{_HEIGHT - 4}" text-anchor="middle">{note}</text>',
    ]


def _label_ends(left: str, right: str) -> list[str]:
    """Write the ends of the horizontal axis."""
    y = _HEIGHT - _BOTTOM + 12
    return [
        f'<text x="{_LEFT}" y="{y}">{escape(left)}</text>',
        f'<text x="{_WIDTH - _RIGHT}" y="{y}" text-anchor="end">{escape(right)}</text>',
    ]


def _wrap(title: str, parts: Sequence[str]) -> str:
    name = escape(title)
    return (
        f'<svg viewBox="0 0 {_WIDTH} {_HEIGHT}" width="{_WIDTH}" role="img" aria-label="{name}">'
        f'<text class="title" x="{_LEFT}" y="12">{name}</text>{"".join(parts)}</svg>'
    )


def _read_time(date: str) -> float | None:
    """Return a date as days; None if it is none."""
    try:
        return datetime.fromisoformat(date).timestamp() / 86400
    except ValueError:
        return None

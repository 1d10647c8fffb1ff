"""The figure of a comparison of methods of calibration, drawn with matplotlib."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure, SubFigure
from matplotlib.image import AxesImage
from matplotlib.ticker import FuncFormatter

from calibgui.engine.arrays import Array, BoolArray, Size
from calibgui.engine.assessment import MethodComparison
from calibgui.report.methods import MethodRow, format_length, list_method_rows

_COLUMNS = 5
"""Number of maps side by side."""
_MAP_INCHES = 2.1
"""Width of a map, inches."""
_BAR_INCHES = 0.24
"""Height of a bar with the space around it, inches."""
_SCALE_PX = (1e-3, 10.0)
"""Least and largest difference that colours tell apart, px; the scale is narrowed to what there
is."""
_MAX_BAR = 2.5
"""Length at which a bar is cut, as a multiple of the median method's."""
_CAMERA_COLOUR, _LINES_COLOUR = "tab:blue", "tab:orange"


class _Map(NamedTuple):
    """The distance of a method from the chosen camera over the image."""

    row: MethodRow
    """The method."""
    u: Array
    """(n,) columns, px."""
    v: Array
    """(m,) rows, px."""
    length: Array
    """(m, n) lengths, px."""
    region: BoolArray
    """(m, n) true where corners were seen."""


def draw_method_comparison(comparison: MethodComparison) -> Figure:
    """Draw where each method differs from the chosen camera, and its errors on unseen views."""
    rows = list_method_rows(comparison)
    maps = [_get_map(comparison, row) for row in rows if math.isfinite(row.difference_rms)]
    known = [row for row in rows if math.isfinite(row.unseen)]
    w, h = comparison.chosen.size
    map_height = math.ceil(len(maps) / _COLUMNS) * (_MAP_INCHES * h / w + 0.35) + 0.5
    bar_height = _BAR_INCHES * len(known) + 1.0
    figure = Figure(
        figsize=(_COLUMNS * _MAP_INCHES + 1.2, map_height + bar_height), layout="constrained"
    )
    parts = figure.subfigures(2, 1, height_ratios=(map_height, bar_height), squeeze=False)
    upper, lower = parts.ravel()
    _draw_maps(upper, maps, comparison.chosen.size)
    _draw_bars(lower.subplots(), known)
    return figure


def _get_map(comparison: MethodComparison, row: MethodRow) -> _Map:
    """Return the map of a method whose difference from the chosen camera is known."""
    if row.kind == "lines":
        lines = comparison.lines[row.name]
        return _Map(row, lines.u, lines.v, lines.length, lines.region)
    difference = comparison.trials[row.name].difference
    assert difference is not None  # its rms is known
    return _Map(row, difference.u, difference.v, difference.length, difference.region)


def _draw_maps(figure: SubFigure, maps: list[_Map], size: Size) -> None:
    """Draw the maps on one scale of colours."""
    figure.suptitle(
        "Difference from the chosen camera; figures: px rms where corners were seen (red outline)",
        fontsize=11,
    )
    grid = figure.subplots(math.ceil(len(maps) / _COLUMNS), _COLUMNS, squeeze=False)
    norm = _make_norm(maps)
    shown: AxesImage | None = None
    for axes, one in zip(grid.flat, maps, strict=False):
        shown = _draw_map(axes, one, norm, size)
    for axes in list(grid.flat)[len(maps) :]:
        axes.set_visible(False)
    if shown is not None:
        bar = figure.colorbar(shown, ax=grid, label="difference, px", shrink=0.9, extend="both")
        bar.ax.yaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))


def _make_norm(maps: list[_Map]) -> LogNorm:
    """Make the scale of colours: whole powers of ten around all differences where corners are."""
    lengths = np.concatenate([one.length[one.region] for one in maps])
    low, high = _SCALE_PX
    counted = lengths[(lengths > low) & (lengths < high)]
    if counted.size:
        least, largest = np.percentile(counted, [1, 99])
        low, high = 10.0 ** math.floor(math.log10(least)), 10.0 ** math.ceil(math.log10(largest))
    return LogNorm(low, max(high, 10 * low), clip=True)


def _draw_map(axes: Axes, one: _Map, norm: LogNorm, size: Size) -> AxesImage:
    """Draw how far a method's camera is from the chosen one, px, over the image."""
    w, h = size
    length = np.maximum(one.length, _SCALE_PX[0] / 10)  # logarithms need no zero, but keep NaN
    shown = axes.imshow(
        length,
        extent=(-0.5, w - 0.5, h - 0.5, -0.5),
        norm=norm,
        cmap="viridis",
        interpolation="bilinear",
    )
    if not one.region.all():
        outline = one.region.astype(float)
        axes.contour(one.u, one.v, outline, levels=[0.5], colors="red", linewidths=0.8)
    axes.set(xticks=[], yticks=[])
    axes.set_title(f"{one.row.name}  {format_length(one.row.difference_rms)}", fontsize=8)
    return shown


def _draw_bars(axes: Axes, rows: list[MethodRow]) -> None:
    """Draw the errors on unseen views, bars much longer than most cut."""
    errors = np.array([row.unseen for row in rows])
    if not len(rows):
        axes.set_axis_off()
        return
    reach = _MAX_BAR * float(np.median(errors))
    for place, row in enumerate(rows):
        colour = _LINES_COLOUR if row.kind == "lines" else _CAMERA_COLOUR
        length = min(row.unseen, reach)
        axes.barh(place, length, color=colour, height=0.7)
        cut = " ▸" * (row.unseen > reach)
        axes.text(length, place, f"{cut} {format_length(row.unseen)}", va="center", fontsize=8)
    for label, colour in (
        ("residuals of unseen views, poses fitted", _CAMERA_COLOUR),
        ("distances from straight lines in unseen views", _LINES_COLOUR),
    ):
        if any((row.kind == "lines") == (colour == _LINES_COLOUR) for row in rows):
            axes.barh(0, 0, color=colour, label=label)
    axes.set_yticks(range(len(rows)), [row.name for row in rows], fontsize=8)
    axes.set(xlabel="RMS on unseen views, px", xlim=(0, 1.12 * min(float(errors.max()), reach)))
    axes.invert_yaxis()
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(fontsize=8, loc="lower right")

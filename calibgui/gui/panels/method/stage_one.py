"""Stage I: Table 1 of all views, with figures 4 and 5 beside it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import PurePath
from typing import Any

import numpy as np
from PySide6.QtCore import QT_TRANSLATE_NOOP

from calibgui.app.calibrating.calibration import shorten_names
from calibgui.dataset import Result
from calibgui.engine.arrays import Array, BoolArray
from calibgui.engine.calibration import Cost, StageOne, evaluate_cosines_equation
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.parts.split import Split
from calibgui.gui.panels.services import Services
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.elided import elide_name
from calibgui.gui.widgets.plots import Plot
from calibgui.gui.widgets.tables import Column, Table, with_decimals

_OUTLYING = 3.0
"""Distances between the quartiles beyond them that mark a view (Tukey's "far out")."""
_SEARCHED = np.linspace(0.6, 1.4, 401)
"""Aspect ratios over which g(r) is drawn."""
_OPTIONAL = ("fy", "iterations")
"""Columns that a narrow table does without: fy is fx times the ratio."""
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")

_UNKNOWNS = 11
"""Of a view in Stage I: xp, yp, k1 and a homography."""
_TABLE_HEIGHT = 160
"""Least height of the table, px: some views, whatever the plots below it need."""


class StageOnePanel(Panel):
    """Shows what each view says of the camera by itself."""

    title = str(QT_TRANSLATE_NOOP("StageOnePanel", "Stage I"))
    purpose = str(
        QT_TRANSLATE_NOOP(
            "StageOnePanel", "What each view says of the camera by itself: the paper's first stage."
        )
    )

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self.table = Table()
        self.table.setMinimumHeight(_TABLE_HEIGHT)
        self.table.picked.connect(self._pick)
        self.table.hovered.connect(self._point_at)
        self.equation = Plot(self.tr("aspect ratio r"), self.tr("g(r)"))
        self.equation.setToolTip(
            self.tr(
                "The cosines' equation of the selected view: where it is zero, r = fy / fx.\n"
                "It has no value where the view's tilt does not determine it."
            )
        )
        self._curve = self.equation.plot()
        self._root = self.equation.plot(symbol="o", symbolSize=11, symbolBrush=None)
        self.aspects = Plot(self.tr("view"), self.tr("aspect ratio fy / fx"), counts=True)
        self.aspects.setToolTip(
            self.tr(
                "The root of each view. Views near fronto-parallel, or tilted about one axis,\n"
                "give none or a poor one: Stage II does not depend on them."
            )
        )
        self._line = self.aspects.plot(symbolSize=7)
        self._line.sigPointsClicked.connect(
            lambda _, points: self._pick(round(points[0].pos().x()) - 1)
        )
        self._current = self.aspects.plot(pen=None, symbol="o", symbolSize=13, symbolBrush=None)
        plots = Split(400, (self.equation, 1), (self.aspects, 1))
        self._fill_body(Split(640, (self.table, 3), (plots, 2)))

    def _refresh(self, result: Result) -> None:
        self._rows = tuple(result.calibration.stage_one)
        self._counts = [len(view.uv) for view in result.observations()]
        self._names = shorten_names(result.used)
        rows, colours = self._rows, theme.current()
        self.table.show_columns(self._list_columns(), self._outlying(rows))
        self._curve.setPen(theme.make_pen(colours.accent, width=2))
        self._line.setPen(theme.make_pen(colours.line))
        self._line.setSymbolBrush(colours.accent)
        self._line.setSymbolPen(None)
        for marks in (self._root, self._current):
            marks.setSymbolPen(theme.make_pen(colours.bad, width=2))
        aspects = np.array([row.aspect for row in rows])
        known = bool(np.isfinite(aspects).any())  # a line of no points at all has no extent
        self._line.setData(np.arange(1, len(rows) + 1) if known else [], aspects if known else [])
        self.aspects.area.show_numbers(known)
        self.aspects.set_title("" if known else self.tr("No view determines its aspect ratio."))

    def _select(self, k: int, corner: int) -> None:  # noqa: ARG002 - a view has one row
        self.table.select(k)
        self._show_equation(k)

    def _hover_view(self, k: int) -> None:
        self.table.hover(k)
        self._show_equation(k if k >= 0 else self._selected[0])

    def _show_equation(self, k: int) -> None:
        """Draw the equation of calibrated view k, of the first if k is -1, and mark its root."""
        assert self._result is not None
        is_paper = self._result.calibration.cost is Cost.PAPER
        row = self._rows[max(k, 0)]
        g = evaluate_cosines_equation(row.backward, _SEARCHED, is_paper)
        self._curve.setData(_SEARCHED, g, connect="finite")
        self.equation.area.show_numbers(bool(np.isfinite(g).any()))
        known = np.isfinite(row.aspect)
        self._root.setData([row.aspect] if known else [], [0.0] if known else [])
        self._current.setData([max(k, 0) + 1] if known else [], [row.aspect] if known else [])
        name = elide_name(self._names[max(k, 0)])
        self.equation.set_title(
            self.tr("{0}<br>r = {1:.4f}").format(name, row.aspect)
            if known
            else self.tr("{0}<br>r is not determined").format(name)
        )

    def _list_columns(self) -> list[Column]:
        rows, names = self._rows, self._names
        steps = self.tr("Steps")
        power = _power([row.k1 for row in rows])
        shown: tuple[tuple[str, str, Callable[[Any], str], str, str], ...] = (
            (
                "xp",
                "xp",
                with_decimals(1),
                "px",
                self.tr("Principal point right of the array's centre"),
            ),
            ("yp", "yp", with_decimals(1), "px", self.tr("Principal point above the centre")),
            (
                "k1",
                "k1",
                lambda k1: f"{k1 / 10.0**power:.2f}",
                "1/px²",
                self.tr("First radial coefficient"),
            ),
            (
                "fy/fx",
                "aspect",
                with_decimals(4),
                "",
                self.tr("Aspect ratio: root of the cosines' equation"),
            ),
            ("fx", "fx", with_decimals(0), "px", self.tr("Focal length")),
            ("fy", "fy", with_decimals(0), "px", self.tr("Focal length")),
            (steps, "iterations", str, "", self.tr("Iterations of Levenberg-Marquardt")),
            (
                "RMS",
                "rms",
                with_decimals(3),
                self.tr("px′"),
                self.tr("Residual on the reference plane; px′ are its pixels, 30 to a square"),
            ),
        )
        headings = {"k1": f"k1·10{str(-power).translate(_RAISED)}"}
        alike = len({PurePath(name).suffix for name in names}) == 1
        return [
            Column(self.tr("View"), names, (lambda name: PurePath(name).stem) if alike else str),
            *(
                Column(
                    t,
                    [getattr(r, name) for r in rows],
                    text,
                    tip,
                    heading=headings.get(t, ""),
                    optional=name in _OPTIONAL,
                    expendable=name == "fx",
                    unit=unit,
                )
                for t, name, text, unit, tip in shown
            ),
            Column(
                self.tr("σ"),
                [_measure_sigma(row, n) for row, n in zip(rows, self._counts, strict=False)],
                with_decimals(3),
                self.tr("Standard deviation of a coordinate, from RMS, corners and 11 unknowns"),
                unit=self.tr("px′"),
            ),
            Column(
                self.tr("Corners"),
                self._counts,
                tip=self.tr("Number of the view's corners"),
                heading="n",
            ),
        ]

    def _outlying(self, rows: Sequence[StageOne]) -> dict[int, str]:
        """Rows that differ much from the others, and in what."""
        marked: dict[int, list[str]] = {}
        for name in ("xp", "yp", "k1", "fx", "rms"):
            values = np.array([getattr(row, name) for row in rows])
            for k in np.flatnonzero(_are_far(values)).tolist() if np.isfinite(values).any() else ():
                marked.setdefault(k, []).append(name)
        for k, row in enumerate(rows):
            if not row.converged:
                marked.setdefault(k, []).append(self.tr("no convergence"))
        return {
            k: self.tr("Far from the other views: {0}").format(", ".join(names))
            for k, names in marked.items()
        }


def _measure_sigma(row: StageOne, corners: int) -> float:
    """Return the standard deviation of a coordinate on the reference plane, reference px.

    Stage I has 11 unknowns in a view: NaN where they take up all that was measured.
    """
    left = 2 * corners - _UNKNOWNS
    return row.rms * math.sqrt(corners / left) if left > 0 else math.nan


def _power(values: Sequence[float]) -> int:
    """The power of ten that brings most of `values` between 1 and 10."""
    size = np.abs(values)
    known = size[np.isfinite(size) & (size > 0)]
    return int(np.floor(np.log10(np.median(known)))) if known.size else 0


def _are_far(values: Array) -> BoolArray:
    """Return which values are far outside the quartiles of all."""
    low, high = np.nanquantile(values, [0.25, 0.75])
    reach = _OUTLYING * (high - low)
    return np.asarray((values < low - reach) | (values > high + reach))

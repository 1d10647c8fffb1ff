"""A plot draws on a view between two axes, under a title."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence

import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtGui import QTextOption
from PySide6.QtWidgets import QGraphicsGridLayout, QGraphicsItem, QSizePolicy

_MANY_DECADES = 4
"""Number of powers of ten beyond which there is room for these only; and their distance from 1, up
to which they are written as plain numbers."""
_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_GRID = 38
"""Opacity of the grid, of 255."""
_TITLE_HEIGHT = 30.0
"""Room of a title, two lines at most, px."""
MARGIN = 6.0
"""Around a plot, px: by so much the axes' names stand out of their axes."""
_ABOVE_IMAGES = 0.5
"""Height of the axes in the pile: an image, which lies at 0, would hide the grid."""


class Axis(pg.AxisItem):  # type: ignore[misc]  # pyqtgraph is not typed
    """An axis that, if it is logarithmic, has numbers at powers of ten, and few between them."""

    is_count = False
    """True if it counts something, so that nothing lies between whole numbers."""
    write_number: Callable[[float], str] | None = None
    """A function that writes the numbers, as dates for example; None for plain numbers."""

    def updateAutoSIPrefix(self) -> None:  # noqa: N802 - pyqtgraph's name
        """Draw the numbers anew, as pyqtgraph leaves it to this method when their range changes.

        No prefix of a unit is chosen, for which the label would be written at every change.
        """
        self.picture = None
        self.update()

    def tickSpacing(self, low: float, high: float, size: float) -> list[tuple[float, float]]:  # noqa: N802 - pyqtgraph's name
        levels = list(super().tickSpacing(low, high, size))
        whole = [(spacing, begin) for spacing, begin in levels if spacing >= 1]
        return (whole or [(1.0, 0.0)]) if self.is_count and levels else levels

    def tickStrings(self, values: list[float], scale: float, spacing: float) -> list[str]:  # noqa: N802 - pyqtgraph's name
        if self.write_number is None:
            return list(super().tickStrings(values, scale, spacing))
        return [self.write_number(value) for value in values]

    def logTickValues(  # noqa: N802 - pyqtgraph's name
        self, low: float, high: float, size: float, levels: list[tuple[float, list[float]]]
    ) -> list[tuple[float | None, list[float]]]:
        length = 10.0**high - 10.0**low
        if self._choose_leading(low, high) or length < sys.float_info.min:
            return list(super().logTickValues(low, high, size, levels))
        # A range without two numbers of a single digit: it is nearly linear.
        spacing = 10.0 ** math.floor(math.log10(length / 2))
        spacing *= 5 if length > 10 * spacing else 1  # two to ten numbers
        first, last = (math.floor(10.0**end / spacing) for end in (low, high))
        return [(spacing, [math.log10(k * spacing) for k in range(first + 1, last + 1)])]

    def _choose_leading(self, low: float, high: float) -> Sequence[int]:
        """Choose the leading digits of the numbers that are written between powers of ten.

        There are two numbers at least, or nothing can be read off between them; none is chosen
        where even all digits do not make two.
        """
        if high - low > _MANY_DECADES:
            return (1,)
        for digits in ((1, 2, 5), range(1, 10)):
            places = [
                power + math.log10(digit)
                for power in range(math.floor(low), math.ceil(high) + 1)
                for digit in digits
            ]
            if sum(low < place < high for place in places) >= 2:
                return digits
        return ()

    def logTickStrings(  # noqa: N802 - pyqtgraph's name
        self,
        values: list[float],
        scale: float,
        spacing: float,  # noqa: ARG002
    ) -> list[str]:
        low, high = sorted(self.range)
        if not (shown := self._choose_leading(low, high)):
            return [f"{10.0**value * scale:.6g}" for value in values]
        is_plain = low >= -_MANY_DECADES and high <= _MANY_DECADES
        texts = []
        for value in values:
            leading, power = f"{10.0**value * scale:.0e}".split("e")
            if int(leading) not in shown:
                texts.append("")
            elif is_plain:
                texts.append(f"{float(f'{leading}e{power}'):g}")
            else:
                factor = "" if leading == "1" else f"{leading}·"
                texts.append(f"{factor}10{str(int(power)).translate(_SUPERSCRIPTS)}")
        return texts


class PlotArea(pg.GraphicsWidget):  # type: ignore[misc]  # pyqtgraph is not typed
    """A view of the plotted items, its axes at the left and below, and a title above it.

    Pyqtgraph's own `PlotItem` has four axes and, even without a menu, the dozens of boxes of one;
    it takes twice as long to make.
    """

    VIEW_ROW = 1
    """Row of the view in the grid; columns from `AFTER` on are free."""
    AFTER = 2

    def __init__(self) -> None:
        super().__init__()
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.box = pg.ViewBox(enableMenu=False)
        self.left, self.bottom = Axis("left"), Axis("bottom")
        self.title = pg.LabelItem()
        centred = QTextOption(Qt.AlignmentFlag.AlignHCenter)
        self.title.item.document().setDefaultTextOption(centred)
        self.grid = QGraphicsGridLayout(self)
        self.grid.setContentsMargins(MARGIN, MARGIN, MARGIN, MARGIN)
        self.grid.setSpacing(0)
        self.grid.addItem(self.title, 0, 1)
        self.grid.addItem(self.box, self.VIEW_ROW, 1)
        for axis, place in ((self.left, (self.VIEW_ROW, 0)), (self.bottom, (self.VIEW_ROW + 1, 1))):
            axis.linkToView(self.box)
            axis.setZValue(_ABOVE_IMAGES)
            axis.setFlag(QGraphicsItem.GraphicsItemFlag.ItemNegativeZStacksBehindParent)
            axis.setGrid(_GRID)
            self.grid.addItem(axis, *place, Qt.AlignmentFlag(0))
        self.grid.setRowStretchFactor(self.VIEW_ROW, 1)
        self.grid.setColumnStretchFactor(1, 1)
        self._give_title(0.0)

    @property
    def axes(self) -> dict[str, Axis]:
        """The axes by their sides."""
        return {"left": self.left, "bottom": self.bottom}

    def set_title(self, text: str, colour: str) -> None:
        """Write a title, of two lines at most; it has no room if it is empty."""
        words = self.title.item
        words.setTextWidth(-1)
        self.title.setText(text, color=colour, size="10pt")
        words.setTextWidth(words.document().idealWidth())  # lines are centred in a width only
        self._give_title(_TITLE_HEIGHT if text else 0.0)

    def show_numbers(self, shown: bool) -> None:
        """Write numbers along the axes, or none where nothing is plotted that has any."""
        for axis in self.axes.values():
            axis.setTicks(None if shown else [])

    def show_grid(self, shown: bool) -> None:
        """Draw lines from the axes' numbers over the view, or none."""
        for axis in self.axes.values():
            axis.setGrid(_GRID if shown else False)

    def _give_title(self, height: float) -> None:
        self.title.setMaximumHeight(height)
        self.title.setVisible(height > 0)
        self.grid.setRowFixedHeight(0, height)

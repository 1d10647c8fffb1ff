"""Plots alike: labelled axes with units, the theme's colours, and a menu to save them."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QCoreApplication, QEvent, QPoint, QRectF, QSize, Qt
from PySide6.QtGui import (
    QAction,
    QColor,
    QContextMenuEvent,
    QGradient,
    QGuiApplication,
    QImage,
    QKeySequence,
    QLinearGradient,
    QMouseEvent,
    QPainter,
)
from PySide6.QtSvg import QSvgGenerator
from PySide6.QtWidgets import QMenu, QWidget

from calibgui.gui.widgets import theme
from calibgui.gui.widgets.actions import COPY_PICTURE
from calibgui.gui.widgets.glossary import explain
from calibgui.gui.widgets.save_names import ask_for_name

pg.setConfigOptions(antialias=True)

_MANY_DECADES = 4
"""Number of powers of ten beyond which there is room for these only; and their distance from 1, up
to which they are written as plain numbers."""
_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_LEAST_HEIGHT = 160
"""Height below which the numbers of an axis run into each other, px."""
_BAR_WIDTH = 14.0
"""Width of a bar of colours, px."""
_BAR_ROW, _BAR_COLUMN = 2, 5
"""Place of a bar of colours in a plot's grid: beside what is plotted."""
_STOPS = 33
"""Colours that a bar is blended from: with them it cannot be told from the map itself."""
_RIM = 8.0
"""Above axes that end with what they enclose: half a line for their topmost number, px."""


class Plot(pg.PlotWidget):  # type: ignore[misc]  # pyqtgraph is not typed
    """A plot whose axes say what they show.

    Args:
        x, y: what the axes show.
        x_unit, y_unit: their units; empty for a count or a ratio.
        square: whether a unit is as long on either axis.
    """

    def __init__(
        self,
        x: str,
        y: str,
        x_unit: str = "",
        y_unit: str = "",
        *,
        square: bool = False,
        parent: QWidget | None = None,
    ) -> None:
        axes = {name: _Axis(name) for name in ("left", "bottom", "right", "top")}
        super().__init__(parent, enableMenu=False, axisItems=axes)  # it has a menu of its own
        self._labels = _labels(x, y, x_unit, y_unit)
        self.colour_bar: ColourBar | None = None
        """What the colours mean, if they mean anything."""
        self._area: QRectF | None = None
        item = self.getPlotItem()
        item.getViewBox().sigResized.connect(self._make_room)
        for name in ("right", "top"):
            item.hideAxis(name)
        item.hideButtons()
        item.showGrid(x=True, y=True, alpha=0.15)
        item.getViewBox().setAspectLocked(square)
        self._menu = QMenu(self)
        for text, shortcut, does in (
            (self.tr("Show all"), None, self.show_all),
            (self.tr("Copy as image"), QKeySequence.StandardKey.Copy, self.copy),
            (self.tr("Save plot…"), None, self.ask_and_save),
        ):
            action = QAction(text, self)
            if shortcut is not None:
                action.setShortcut(shortcut)
                action.setShortcutContext(Qt.ShortcutContext.WidgetShortcut)
            action.triggered.connect(does)
            if shortcut is QKeySequence.StandardKey.Copy:
                action.setObjectName(COPY_PICTURE)
            self.addAction(action)
            self._menu.addAction(action)
        self._restyle()

    def minimumSizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        """Leave room for the text along the left axis, which would be cut off."""
        item = self.getPlotItem()
        text = math.ceil(item.getAxis("left").label.boundingRect().width())
        needed = text + math.ceil(item.getAxis("bottom").minimumHeight())
        return QSize(super().minimumSizeHint().width(), max(_LEAST_HEIGHT, needed))

    def set_labels(self, x: str, y: str, x_unit: str = "", y_unit: str = "") -> None:
        """Say anew what the axes show."""
        self._labels = _labels(x, y, x_unit, y_unit)
        self._restyle()

    def write_numbers(self, write: Callable[[float], str] | None) -> None:
        """Write the numbers below the plot by a function, as dates; by None as numbers."""
        axis = self.getPlotItem().getAxis("bottom")
        axis.write_number = write
        axis.picture = None  # which holds the texts as they were
        axis.update()

    def enclose(self, area: QRectF) -> None:
        """Show all of `area` of a square plot, with axes that end where it ends."""
        self._area = area
        self._make_room()
        self.getPlotItem().getViewBox().setRange(area, padding=0)

    def show_all(self) -> None:
        """Take back what was zoomed and moved; a double click does so too."""
        box = self.getPlotItem().getViewBox()
        if self._area is None:
            box.autoRange()
        else:
            box.setRange(self._area, padding=0)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        super().mouseDoubleClickEvent(event)
        if event.button() is Qt.MouseButton.LeftButton:
            self.show_all()
            event.accept()

    def _make_room(self) -> None:
        """Leave the room that the enclosed area cannot fill outside the axes."""
        if self._area is None:
            return
        item = self.getPlotItem()
        box, layout = item.getViewBox(), item.layout
        left, top, right, bottom = layout.getContentsMargins()
        width, height = box.width() + left + right, box.height() + top + bottom - _RIM
        scale = min(width / self._area.width(), height / self._area.height())
        across = max(width - scale * self._area.width(), 0.0) / 2
        below = max(height - scale * self._area.height(), 0.0)
        if abs(across - left) > 1 or abs(below - bottom) > 1:
            layout.setContentsMargins(across, _RIM, across, below)

    def set_title(self, text: str) -> None:
        """Say above the plot what it shows at present."""
        self.getPlotItem().setTitle(text, color=theme.current().text, size="10pt")

    def save(self, path: str | Path) -> None:
        """Write the plot as PNG or SVG, by the name's ending."""
        save_picture(self, path)

    def copy(self) -> None:
        """Put a picture of the plot on the clipboard."""
        QGuiApplication.clipboard().setPixmap(self.grab())

    def ask_and_save(self) -> None:
        """Let the user choose a file, then `save`."""
        ask_and_save_picture(self)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:  # noqa: N802 - Qt's name
        self._menu.popup(event.globalPos())
        event.accept()

    def changeEvent(self, event: QEvent) -> None:  # noqa: N802 - Qt's name
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and hasattr(self, "_menu"):
            self._restyle()

    def _restyle(self) -> None:
        colours = theme.current()
        self.setBackground(colours.base)
        for name, text in self._labels.items():
            axis = self.getPlotItem().getAxis(name)
            axis.setPen(colours.line)
            axis.setTextPen(colours.text)
            axis.setLabel(text, color=colours.text)
            axis.setToolTip(explain(text))
        self.updateGeometry()
        if self.colour_bar is not None:
            self.colour_bar.restyle()


class _Axis(pg.AxisItem):  # type: ignore[misc]  # pyqtgraph is not typed
    """An axis that, if it is logarithmic, has numbers at powers of ten, and few between them."""

    write_number: Callable[[float], str] | None = None
    """A function that writes the numbers, as dates for example; None for plain numbers."""

    def updateAutoSIPrefix(self) -> None:  # noqa: N802 - pyqtgraph's name
        """Choose no prefix of a unit, for which the label is written anew at every change."""

    def tickStrings(self, values: list[float], scale: float, spacing: float) -> list[str]:  # noqa: N802 - pyqtgraph's name
        if self.write_number is None:
            return list(super().tickStrings(values, scale, spacing))
        return [self.write_number(value) for value in values]

    def logTickStrings(  # noqa: N802 - pyqtgraph's name
        self,
        values: list[float],
        scale: float,
        spacing: float,  # noqa: ARG002
    ) -> list[str]:
        low, high = sorted(self.range)
        shown = (1,) if high - low > _MANY_DECADES else (1, 2, 5)
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


class ColourBar(pg.GraphicsWidget):  # type: ignore[misc]  # pyqtgraph is not typed
    """What the colours of a plot mean, beside it.

    Pyqtgraph's own bar is a whole plot with four axes and a menu, and takes as long to make as the
    plot that it belongs to.

    Args:
        plot: that the bar belongs to.
        quantity: what the colours show, with its unit.
        colours: the colour map.
        image: whose values are coloured, if they are one's.
    """

    def __init__(
        self, plot: Plot, quantity: str, colours: pg.ColorMap, image: pg.ImageItem | None = None
    ) -> None:
        super().__init__()
        self._quantity = quantity
        self._image = image
        self.levels = (0.0, 1.0)
        """Values of the lowest and of the highest colour."""
        self._gradient = QLinearGradient(0, 1, 0, 0)
        self._gradient.setCoordinateMode(QGradient.CoordinateMode.ObjectMode)
        for position in np.linspace(0, 1, _STOPS):
            self._gradient.setColorAt(position, colours.mapToQColor(position))
        if image is not None:
            image.setColorMap(colours)
        self.axis = _Axis("right")
        layout = plot.getPlotItem().layout
        # The right axis of the plot, which is not shown, has the columns before these.
        layout.setColumnFixedWidth(_BAR_COLUMN - 1, _BAR_WIDTH / 2)
        layout.setColumnFixedWidth(_BAR_COLUMN, _BAR_WIDTH)
        layout.addItem(self, _BAR_ROW, _BAR_COLUMN)
        layout.addItem(self.axis, _BAR_ROW, _BAR_COLUMN + 1)
        plot.colour_bar = self
        self.restyle()

    def set_levels(self, low: float, high: float) -> None:
        """Give the lowest and the highest colour these values, in the image as well."""
        self.levels = (low, high)
        self.axis.setRange(low, high)
        if self._image is not None:
            self._image.setLevels(self.levels)

    def set_quantity(self, quantity: str) -> None:
        """Say anew what the colours show, with its unit."""
        self._quantity = quantity
        self.restyle()

    def restyle(self) -> None:
        """Take the theme's colours."""
        colours = theme.current()
        self.axis.setPen(colours.line)
        self.axis.setTextPen(colours.text)
        self.axis.setLabel(self._quantity, color=colours.text)
        self.axis.setToolTip(explain(self._quantity))
        self.setToolTip(explain(self._quantity))
        self.update()

    def paint(self, painter: QPainter, *_: object) -> None:
        """Draw the colours, the lowest at the bottom."""
        painter.setPen(QColor(theme.current().line))
        painter.setBrush(self._gradient)
        painter.drawRect(self.rect())


def save_picture(widget: QWidget, path: str | Path) -> None:
    """Write what `widget` shows as SVG, or as PNG of twice its size, by the name's ending."""
    if str(path).lower().endswith(".svg"):
        drawing = QSvgGenerator()
        drawing.setFileName(str(path))
        drawing.setSize(widget.size())
        drawing.setViewBox(widget.rect())
        _render(widget, drawing)
        return
    image = QImage(widget.size() * 2, QImage.Format.Format_RGB32)
    image.setDevicePixelRatio(2)
    _render(widget, image)
    image.save(str(path))


def offer_picture(widget: QWidget) -> None:
    """Give a drawn widget a context menu that copies and saves what it shows."""
    translate = QCoreApplication.translate
    copy = QAction(translate("plots", "Copy as image"), widget)
    copy.setObjectName(COPY_PICTURE)
    copy.setShortcut(QKeySequence.StandardKey.Copy)
    copy.setShortcutContext(Qt.ShortcutContext.WidgetShortcut)
    copy.triggered.connect(lambda: QGuiApplication.clipboard().setPixmap(widget.grab()))
    save = QAction(translate("plots", "Save plot…"), widget)
    save.triggered.connect(lambda: ask_and_save_picture(widget))
    widget.addActions([copy, save])
    widget.setContextMenuPolicy(Qt.ContextMenuPolicy.ActionsContextMenu)


def ask_and_save_picture(widget: QWidget) -> None:
    """Let the user choose a file, then `save_picture`."""
    translate = QCoreApplication.translate
    path = ask_for_name(
        widget,
        translate("plots", "Save plot"),
        "",
        translate("plots", "PNG image (*.png);;SVG drawing (*.svg)"),
    )
    if path is not None:
        save_picture(widget, path)


def _render(widget: QWidget, device: QImage | QSvgGenerator) -> None:
    painter = QPainter(device)
    QWidget.render(widget, painter, QPoint())  # a view of a scene has a "render" of its own
    painter.end()


def _labels(x: str, y: str, x_unit: str, y_unit: str) -> dict[str, str]:
    return {"bottom": _with_unit(x, x_unit), "left": _with_unit(y, y_unit)}


def _with_unit(name: str, unit: str) -> str:
    return f"{name} [{unit}]" if unit else name

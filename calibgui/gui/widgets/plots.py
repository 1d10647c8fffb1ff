"""Plots alike: labelled axes with units, the theme's colours, and a menu to save them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, cast

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QCoreApplication, QPoint, QRectF, QSize, Qt
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
    QResizeEvent,
)
from PySide6.QtSvg import QSvgGenerator
from PySide6.QtWidgets import QMenu, QSizePolicy, QWidget

from calibgui.engine.arrays import Array
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.actions import COPY_PICTURE
from calibgui.gui.widgets.focus_ring import FocusRing
from calibgui.gui.widgets.glossary import explain
from calibgui.gui.widgets.plot_area import MARGIN, Axis, PlotArea
from calibgui.gui.widgets.save_names import ask_for_name

pg.setConfigOptions(antialias=True)

_LEAST_HEIGHT = 160
"""Height below which the numbers of an axis run into each other, px."""
_BAR_WIDTH = 14.0
"""Width of a bar of colours, px."""
_STOPS = 33
"""Colours that a bar is blended from: with them it cannot be told from the map itself."""
_RIM = 8.0
"""Above axes that end with what they enclose: half a line for their topmost number, px."""


class Plot(pg.GraphicsView):  # type: ignore[misc]  # pyqtgraph is not typed
    """A plot whose axes say what they show.

    Args:
        x, y: what the axes show.
        x_unit, y_unit: their units; empty for a count or a ratio.
        square: whether a unit is as long on either axis.
        logarithmic: whether the left axis shows powers of ten at equal distances.
        counts: whether the lower axis counts something, as views.
    """

    _enclosed: QRectF | None = None
    _wanted_height = 0
    """Height that the enclosed area takes at the plot's width, px."""

    def __init__(
        self,
        x: str,
        y: str,
        x_unit: str = "",
        y_unit: str = "",
        *,
        square: bool = False,
        logarithmic: bool = False,
        counts: bool = False,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        FocusRing(self)
        self.area = PlotArea()
        self.setCentralItem(self.area)
        self._labels = _labels(x, y, x_unit, y_unit)
        self.colour_bar: ColourBar | None = None
        """What the colours mean, if they mean anything."""
        self.box.sigResized.connect(self._make_room)
        self.box.setAspectLocked(square)
        self._is_logarithmic = logarithmic
        self.area.left.setLogMode(logarithmic)
        self.area.bottom.is_count = counts
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
        theme.follow(self._restyle)

    @property
    def box(self) -> pg.ViewBox:
        """The view of what is plotted."""
        return self.area.box

    def plot(self, *values: Sequence[float] | Array, **style: Any) -> pg.PlotDataItem:
        """Plot values as pyqtgraph's ``PlotDataItem`` does, and return the item."""
        item = pg.PlotDataItem(*values, **style)
        item.setLogMode(False, self._is_logarithmic)
        self.addItem(item)
        return item

    def addItem(self, item: pg.GraphicsObject) -> None:  # noqa: N802 - pyqtgraph's name
        """Plot an item of pyqtgraph's."""
        self.box.addItem(item)

    def removeItem(self, item: pg.GraphicsObject) -> None:  # noqa: N802 - pyqtgraph's name
        """Take an item out of the plot."""
        self.box.removeItem(item)

    def clear(self) -> None:
        """Take all items out of the plot."""
        self.box.clear()

    def minimumSizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        """Leave room for the text along the upright axes, which would be cut off."""
        needed = self._find_upright_length() + self.area.bottom.minimumHeight() + 2 * MARGIN
        return QSize(super().minimumSizeHint().width(), max(_LEAST_HEIGHT, math.ceil(needed)))

    def sizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        """Ask for the height that the enclosed area takes."""
        hint = super().sizeHint()
        return hint if self._enclosed is None else QSize(hint.width(), self._wanted_height)

    def _find_upright_length(self) -> float:
        """Return the length of the longest text along an upright axis, px."""
        upright = [self.area.left] + ([self.colour_bar.axis] if self.colour_bar else [])
        return max(axis.label.boundingRect().width() for axis in upright)

    def set_labels(self, x: str, y: str, x_unit: str = "", y_unit: str = "") -> None:
        """Say anew what the axes show."""
        labels = _labels(x, y, x_unit, y_unit)
        if labels != self._labels:
            self._labels = labels
            self._restyle()

    def write_numbers(self, write: Callable[[float], str] | None) -> None:
        """Write the numbers below the plot by a function, as dates; by None as numbers."""
        axis = self.area.bottom
        axis.write_number = write
        axis.picture = None  # which holds the texts as they were
        axis.update()

    def enclose(self, area: QRectF) -> None:
        """Show all of `area` of a square plot, with axes that end where it ends.

        The plot becomes no higher than that takes at its width: what stands below it stays close.
        """
        self._enclosed = area
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Maximum)
        self._make_room()
        self.box.setRange(area, padding=0)

    def show_all(self) -> None:
        """Take back what was zoomed and moved; a double click does so too."""
        if self._enclosed is None:
            self.box.autoRange()
        else:
            self.box.setRange(self._enclosed, padding=0)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        super().mouseDoubleClickEvent(event)
        if event.button() is Qt.MouseButton.LeftButton:
            self.show_all()
            event.accept()

    def _make_room(self) -> None:
        """Leave the room that the enclosed area cannot fill outside the axes."""
        if self._enclosed is None:
            return
        box, grid = self.box, self.area.grid
        margins = cast(tuple[float, float, float, float], grid.getContentsMargins())
        left, top, right, bottom = margins
        width = box.width() + left + right - 2 * MARGIN
        height = box.height() + top + bottom - _RIM - MARGIN
        scale = min(width / self._enclosed.width(), height / self._enclosed.height())
        across = MARGIN + max(width - scale * self._enclosed.width(), 0.0) / 2
        shown = scale * self._enclosed.height()
        above = max(_RIM, (self._find_upright_length() - shown) / 2)  # texts are longer than axes
        below = MARGIN + max(height + _RIM - above - shown, 0.0)
        if max(abs(across - left), abs(above - top), abs(below - bottom)) > 1:
            grid.setContentsMargins(across, above, across, below)
        full = width / self._enclosed.width() * self._enclosed.height() + above - _RIM
        wanted = math.ceil(self.height() - height + full)
        if wanted != self._wanted_height:
            self._wanted_height = wanted
            self.updateGeometry()

    def resizeEvent(self, event: QResizeEvent | None) -> None:  # noqa: N802 - Qt's name
        if self._enclosed is not None and not self.closed:
            # The margins of a wider plot would leave no room.
            self.area.grid.setContentsMargins(MARGIN, _RIM, MARGIN, MARGIN)
        super().resizeEvent(event)

    def set_title(self, text: str) -> None:
        """Say above the plot what it shows at present."""
        self.area.set_title(text, theme.current().text)

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

    def _restyle(self) -> None:
        colours = theme.current()
        self.setBackground(colours.base)
        self.setAccessibleName(f"{self._labels['left']}, {self._labels['bottom']}")
        for name, text in self._labels.items():
            axis = self.area.axes[name]
            axis.setPen(theme.make_pen(colours.line))
            axis.setTextPen(colours.text)
            axis.setLabel(text, color=colours.text)
            axis.resizeEvent()  # which places the label in the middle
            axis.setToolTip(explain(text))
        self.updateGeometry()
        if self.colour_bar is not None:
            self.colour_bar.restyle()


class ColourBar(pg.GraphicsWidget):  # type: ignore[misc]  # pyqtgraph is not typed
    """A bar beside a plot that tells what its colours mean.

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
        self._plot = plot
        self._quantity = quantity
        self._image = image
        self.levels = (0.0, 1.0)
        """Values of the lowest and of the highest colour."""
        self._gradient = QLinearGradient(0, 1, 0, 0)
        self._gradient.setCoordinateMode(QGradient.CoordinateMode.ObjectMode)
        places = np.linspace(0, 1, _STOPS)
        for place, colour in zip(places, colours.map(places, mode="qcolor"), strict=True):
            self._gradient.setColorAt(place, colour)
        if image is not None:
            image.setColorMap(colours)
        self.axis = Axis("right")
        grid = plot.area.grid
        grid.setColumnFixedWidth(PlotArea.AFTER, _BAR_WIDTH / 2)
        grid.setColumnFixedWidth(PlotArea.AFTER + 1, _BAR_WIDTH)
        grid.addItem(self, PlotArea.VIEW_ROW, PlotArea.AFTER + 1)
        grid.addItem(self.axis, PlotArea.VIEW_ROW, PlotArea.AFTER + 2)
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
        self.axis.setPen(theme.make_pen(colours.line))
        self.axis.setTextPen(colours.text)
        self.axis.setLabel(self._quantity, color=colours.text)
        self.axis.setToolTip(explain(self._quantity))
        if self._quantity:
            self._plot.setAccessibleName(self._quantity)
        self.setToolTip(explain(self._quantity))
        self._plot.updateGeometry()
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

"""Ten thousands of points in a plot, whose groups have colours and symbols of their own."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, cast

import numpy as np
import pyqtgraph as pg
import shiboken6
from pyqtgraph.graphicsItems.ScatterPlotItem import Symbols
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPixmap
from PySide6.QtWidgets import QStyleOptionGraphicsItem, QWidget

from calibgui.engine.arrays import Array

_REACH = 8.0
"""Distance from a point within which a click means it, px of the screen."""
_PER_ROW = 256
"""Symbols side by side on the sheet that they are copied from; a pixmap is at most 32,767 wide."""


class PointCloud(pg.GraphicsObject):  # type: ignore[misc]  # pyqtgraph is not typed
    """Draws groups of points, each in its colour and with its symbol.

    pyqtgraph's own item is slow to fill and has one style for all, or one to be told for every
    point. This one draws each style's symbol once and copies it to the points that have it.

    Args:
        size: diameter of a symbol, px of the screen.
    """

    def __init__(self, size: float) -> None:
        super().__init__()
        self._size = size
        self._styles: list[tuple[QColor, str]] = []
        """The different styles."""
        self._points = np.zeros((0, 2))
        self._extent = np.zeros(2), np.zeros(2)
        """(2,) least and largest coordinates, if there are points."""
        self._places = np.zeros((0, 2), dtype=np.intp)
        """The group of each point, and its place there."""
        self._stamps = np.zeros(0, dtype=np.intp)
        """The style of each point."""
        self._sheet: QPixmap | None = None
        """The symbols of all styles, as they are copied; None until they are needed."""

    def show_points(self, groups: Sequence[Array], styles: Sequence[tuple[QColor, str]]) -> None:
        """Show other points.

        Args:
            groups: points (n, 2) of each group; those that are not finite are left out.
            styles: colour of each group, and its symbol by pyqtgraph's name.
        """
        self.prepareGeometryChange()
        points = np.concatenate(groups) if groups else np.zeros((0, 2))
        counts = np.array([len(group) for group in groups], dtype=np.intp)
        numbers = np.repeat(np.arange(len(groups)), counts)
        within = np.arange(len(points)) - np.repeat(np.cumsum(counts) - counts, counts)
        known = np.isfinite(points).all(axis=1)
        self._points = points[known]
        if len(self._points):
            self._extent = self._points.min(axis=0), self._points.max(axis=0)
        self._places = np.stack([numbers, within], axis=1)[known]
        different: dict[tuple[int, str], int] = {}
        stamps = [
            different.setdefault((colour.rgba(), symbol), len(different))
            for colour, symbol in styles
        ]
        self._stamps = np.array(stamps, dtype=np.intp)[self._places[:, 0]]
        self._styles = [(QColor.fromRgba(colour), symbol) for colour, symbol in different]
        self._sheet = None
        self.informViewBoundsChanged()
        self.update()

    def getData(self) -> tuple[Array, Array]:  # noqa: N802 - as of pyqtgraph's items
        """Return u and v of all points."""
        return self._points[:, 0], self._points[:, 1]

    def find_point(self, place: QPointF) -> tuple[int, int] | None:
        """Return the group of the point at a place of the scene, and its place in the group.

        None where no point is near.
        """
        box = self.getViewBox()
        if box is None or not len(self._points):
            return None
        at, pixel = box.mapSceneToView(place), np.array(box.viewPixelSize())
        distance = np.linalg.norm((self._points - [at.x(), at.y()]) / pixel, axis=1)
        nearest = int(distance.argmin())
        group, within = self._places[nearest].tolist()
        return (group, within) if distance[nearest] < _REACH else None

    def dataBounds(  # noqa: N802 - pyqtgraph's name
        self,
        ax: int,
        frac: float = 1.0,  # noqa: ARG002 - all points are to be seen
        orthoRange: object = None,  # noqa: ARG002
    ) -> tuple[float, float] | tuple[None, None]:
        """Return the least and the largest coordinate along axis 0 or 1."""
        if not len(self._points):
            return None, None
        least, most = self._extent
        return float(least[ax]), float(most[ax])

    def pixelPadding(self) -> float:  # noqa: N802 - pyqtgraph's name
        """Return the room that symbols take around the points, px."""
        return self._size / 2

    def boundingRect(self) -> QRectF:  # noqa: N802 - Qt's name
        if not len(self._points):
            return QRectF()
        least, most = self._extent
        vectors = self.pixelVectors()
        pads = (0.0 if vector is None else self._size * vector.length() for vector in vectors)
        across, along = pads
        return QRectF(*least, *(most - least)).adjusted(-across, -along, across, along)

    def viewTransformChanged(self) -> None:  # noqa: N802 - pyqtgraph's name
        """Take the room that the symbols have in the new view."""
        self.prepareGeometryChange()
        super().viewTransformChanged()

    def paint(
        self,
        painter: QPainter,
        option: QStyleOptionGraphicsItem,  # noqa: ARG002 - Qt's signature
        widget: QWidget | None = None,  # noqa: ARG002
    ) -> None:
        ratio = painter.device().devicePixelRatioF()
        side = math.ceil(self._size * ratio) + 2
        if not len(self._points):
            return
        if self._sheet is None or self._sheet.devicePixelRatio() != ratio:
            self._sheet = self._draw_sheet(side, ratio)
        to = painter.transform()
        u, v = self._points.T
        at = np.stack(
            [to.m11() * u + to.m21() * v + to.dx(), to.m12() * u + to.m22() * v + to.dy()], axis=1
        )
        row, column = np.divmod(self._stamps, _PER_ROW)
        painter.resetTransform()
        draw_stamps(painter, at, self._sheet, side * np.stack([column, row], axis=1), side)

    def _draw_sheet(self, side: int, ratio: float) -> QPixmap:
        """Draw the symbol of each style in a square of `side` px, row by row."""
        rows = math.ceil(len(self._styles) / _PER_ROW)
        sheet = QPixmap(min(len(self._styles), _PER_ROW) * side, rows * side)
        sheet.fill(Qt.GlobalColor.transparent)
        painter = QPainter(sheet)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for k, (colour, symbol) in enumerate(self._styles):
            row, column = divmod(k, _PER_ROW)
            painter.resetTransform()
            painter.translate((column + 0.5) * side, (row + 0.5) * side)
            painter.scale(self._size * ratio, self._size * ratio)
            painter.fillPath(Symbols[symbol], colour)
        painter.end()
        sheet.setDevicePixelRatio(ratio)
        return sheet


def draw_stamps(painter: QPainter, at: Array, sheet: QPixmap, source: Array, side: int) -> None:
    """Copy squares of a sheet to places in the painter's coordinates.

    Args:
        painter: that draws.
        at: (n, 2) middles of the copies; finite.
        sheet: picture that holds the squares; its device pixel ratio tells their size when drawn.
        source: (n, 2), or (2,) for all, left upper corners of the squares, pixels of the sheet.
            Squares must lie on it: Qt does not check.
        side: of the squares, pixels of the sheet.
    """
    # The fields of QPainter::PixmapFragment: place, source, its size, scale, rotation, opacity.
    stamps = np.empty((len(at), 10))
    stamps[:, :2], stamps[:, 2:4] = at, source
    stamps[:, 4:] = [side, side, *[1 / sheet.devicePixelRatio()] * 2, 0, 1]
    if len(stamps):
        first = cast(Any, shiboken6.wrapInstance(stamps.ctypes.data, QPainter.PixmapFragment))
        painter.drawPixmapFragments(first, len(stamps), sheet)

"""Residuals as points coloured by view (figures 10 and 15)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import Qt, Signal

from calibgui.engine.arrays import Array
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.plots import Plot
from calibgui.gui.widgets.point_cloud import PointCloud


class ResidualScatter(Plot):
    """The residuals of all views about the origin."""

    picked = Signal(int, int)
    """The view and the corner whose point was clicked."""

    def __init__(self) -> None:
        super().__init__("", "", square=True)
        self._points: Sequence[Array] = ()
        self._views: Sequence[int] = ()
        self._cloud = PointCloud(size=4)
        self.addItem(self._cloud)
        self._view = pg.ScatterPlotItem(size=6)
        self._ring = pg.ScatterPlotItem(size=15, brush=None)
        for z, item in enumerate((self._view, self._ring), start=10):
            item.setZValue(z)
            self.addItem(item)
        self.scene().sigMouseClicked.connect(self._clicked)

    def show_residuals(
        self, points: Sequence[Array], views: Sequence[int], x: str, y: str, unit: str
    ) -> None:
        """Show the residuals (n, 2) of each view.

        Args:
            points: the residuals.
            views: the index by which each view has its colour (see `theme.view_colour`).
            x, y, unit: what the axes show.
        """
        self._points, self._views = points, views
        styles = [(theme.view_colour(k), theme.view_symbol(k)) for k in views]
        self._cloud.show_points(points, styles)
        self.set_labels(x, y, unit, unit)
        self.select(-1)
        self.box.autoRange()

    def select(self, view: int, corner: int = -1) -> None:
        """Bring a view's points to the front and ring one of them; -1 for none."""
        text = theme.current().text
        points = self._points[view] if view >= 0 else np.zeros((0, 2))
        brush = theme.view_colour(self._views[view]) if view >= 0 else None
        self._view.setData(*points.T, brush=brush, pen=theme.make_pen(text))
        chosen = points[corner : corner + 1] if corner >= 0 else points[:0]
        self._ring.setData(*chosen.T, pen=theme.make_pen(text, width=2))

    def _clicked(self, event: pg.GraphicsScene.mouseEvents.MouseClickEvent) -> None:
        if event.button() is Qt.MouseButton.LeftButton:
            found = self._cloud.find_point(event.scenePos())
            if found is not None:
                self.picked.emit(*found)

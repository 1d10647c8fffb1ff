"""A point for each view, in the view's colour."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import Qt, Signal

from calibgui.engine.arrays import Array
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.plots import Plot
from calibgui.gui.widgets.point_cloud import PointCloud


class ViewScatter(Plot):
    """A plot of a quantity of each view against another; a ring marks one view.

    Args:
        x, y, x_unit, y_unit, square, counts: as for `Plot`.
    """

    picked = Signal(int)
    """The view whose point was clicked."""

    def __init__(
        self,
        x: str,
        y: str,
        x_unit: str = "",
        y_unit: str = "",
        *,
        square: bool = False,
        counts: bool = False,
    ) -> None:
        super().__init__(x, y, x_unit, y_unit, square=square, counts=counts)
        self.points = np.zeros((0, 2))
        """(n, 2) points of the views."""
        self._cloud = PointCloud(size=10)
        self._ring = pg.ScatterPlotItem(size=17, brush=None)
        self.addItem(self._cloud)
        self.addItem(self._ring)
        self.scene().sigMouseClicked.connect(self._clicked)

    def show_views(self, points: Array, views: Sequence[int]) -> None:
        """Show the points (n, 2) of views; by their indices `views` they have their colours."""
        self.points = points
        self._cloud.show_points(list(points[:, None]), [(theme.view_colour(k), "o") for k in views])

    def ring_view(self, k: int) -> None:
        """Mark the k-th view; none if it is negative."""
        self._ring.setData(*self.points[k : k + 1].T if k >= 0 else ([], []))
        self._ring.setPen(theme.make_pen(theme.current().text, width=2))

    def _clicked(self, event: pg.GraphicsScene.mouseEvents.MouseClickEvent) -> None:
        if event.button() is Qt.MouseButton.LeftButton:
            found = self._cloud.find_point(event.scenePos())
            if found is not None:
                self.picked.emit(found[0])

"""Residuals of all corners, coloured by view (figure 10), and the views' RMS beside them."""

from __future__ import annotations

from collections import defaultdict

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QT_TRANSLATE_NOOP, Qt, Signal
from PySide6.QtWidgets import QVBoxLayout, QWidget

from calibgui.engine.statistics import summarise
from calibgui.engine.types import Array
from calibgui.formats.result import Result
from calibgui.gui import theme
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.plane import PlaneChoice
from calibgui.gui.panels.split import Split
from calibgui.gui.panels.view_errors import ViewErrors
from calibgui.gui.plots import Plot

_REACH = 8.0
"""Distance from a point within which a click means it, px of the screen."""


class ResidualsPanel(Panel):
    """What the calibration leaves unexplained; a click on it shows where in the images it is."""

    title = str(QT_TRANSLATE_NOOP("ResidualsPanel", "Residuals"))
    icon = "residuals"

    excluded = Signal(tuple)
    """Indices in `Result.views` of views that the user wants out of the calibration."""

    def __init__(self) -> None:
        super().__init__()
        self.plane = PlaneChoice()
        self.plane.currentIndexChanged.connect(self._plane_changed)
        self.scatter = Plot("", "", square=True)
        self.scatter.setToolTip(self.tr("Click a point to see its corner in the image."))
        self.scatter.scene().sigMouseClicked.connect(self._clicked)
        self._points: list[Array] = []
        self._clouds: list[pg.ScatterPlotItem] = []
        self._view = pg.ScatterPlotItem(size=6)
        self._ring = pg.ScatterPlotItem(size=15, brush=None)
        for z, item in enumerate((self._view, self._ring), start=10):
            item.setZValue(z)
            self.scatter.addItem(item)
        self.views = ViewErrors()
        self.views.picked.connect(self._pick)
        self.views.excluded.connect(
            lambda views: self.excluded.emit(tuple(self._indices[k] for k in views))
        )
        left = QWidget()
        column = QVBoxLayout(left)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.plane, 0, Qt.AlignmentFlag.AlignLeft)
        column.addWidget(self.scatter, 1)
        layout = QVBoxLayout(self.body)
        layout.addWidget(Split(560, (left, 3), (self.views, 2)))

    def _refresh(self, result: Result) -> None:
        calibration = result.calibration
        summary = summarise(calibration.residuals)
        self.views.show_views(np.array([v.rms for v in calibration.residuals]), summary.rms)
        self._points = self.plane.residuals(calibration)
        x, y, e = self.plane.names
        self.scatter.set_labels(x, y, self.plane.unit, self.plane.unit)
        self.scatter.set_title(
            self.tr("{0}: mean {1:.3f}, SD {2:.3f} {3}").format(
                e, summary.reference_mean, summary.reference_sd, self.plane.unit
            )
            if self.plane.on_reference
            else self.tr("σ: {0} {1:.3f}, {2} {3:.3f} px").format(
                x, summary.sigma_x, y, summary.sigma_y
            )
        )
        self._draw_clouds()
        self.scatter.getPlotItem().autoRange()

    def _select(self, k: int, corner: int) -> None:
        text = theme.current().text
        points = self._points[k] if k >= 0 else np.zeros((0, 2))
        self._view.setData(*points.T, brush=theme.view_colour(max(k, 0)), pen=pg.mkPen(text))
        chosen = points[corner : corner + 1] if corner >= 0 else points[:0]
        self._ring.setData(*chosen.T, pen=pg.mkPen(text, width=2))
        self.views.select(k)

    def _draw_clouds(self) -> None:
        """One item for all views of a colour and symbol: thousands of points stay quick."""
        for cloud in self._clouds:
            self.scatter.removeItem(cloud)
        alike: defaultdict[tuple[str, str], list[Array]] = defaultdict(list)
        for k, points in enumerate(self._points):
            alike[theme.view_colour(k).name(), theme.view_symbol(k)].append(points)
        self._clouds = [
            pg.ScatterPlotItem(
                *np.concatenate(points).T, size=4, pen=None, brush=brush, symbol=symbol
            )
            for (brush, symbol), points in alike.items()
        ]
        for cloud in self._clouds:
            self.scatter.addItem(cloud)

    def _plane_changed(self) -> None:
        self._stale = True
        self._update()

    def _clicked(self, event: pg.GraphicsScene.mouseEvents.MouseClickEvent) -> None:
        if event.button() is not Qt.MouseButton.LeftButton or not self._points:
            return
        box = self.scatter.getPlotItem().getViewBox()
        place = box.mapSceneToView(event.scenePos())
        pixel = np.array(box.viewPixelSize())
        everything = np.concatenate(self._points)
        distance = np.linalg.norm((everything - [place.x(), place.y()]) / pixel, axis=1)
        nearest = int(np.argmin(distance))
        if distance[nearest] < _REACH:
            ends = np.cumsum([len(points) for points in self._points])
            k = int(np.searchsorted(ends, nearest, side="right"))
            self._pick(k, nearest - int(ends[k] - len(self._points[k])))

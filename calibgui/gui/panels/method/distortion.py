"""The corrective displacement over the image (figure 8)."""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
import scipy
from PySide6.QtCore import QT_TRANSLATE_NOOP, QPointF
from PySide6.QtWidgets import QCheckBox, QComboBox, QLabel

from calibgui.dataset import Result
from calibgui.engine.arrays import Array, BoolArray, Size
from calibgui.engine.camera import Displacement, DisplacementPart, compute_displacement
from calibgui.engine.geometry import centre_of_array
from calibgui.engine.images import make_mesh
from calibgui.engine.numbers import format_two_digits
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.parts.arrows import trace_arrows
from calibgui.gui.panels.parts.contours import Contours
from calibgui.gui.panels.parts.heat import HeatMap, image_rectangle
from calibgui.gui.panels.services import Services
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.layouts import make_row
from calibgui.gui.widgets.levels import choose_levels

_CELLS = 160
"""Values along the image's longer side."""
_ARROWS = 14
"""Arrows along the image's longer side."""


class DistortionPanel(Panel):
    """A map of how far the lens moves each pixel from where an ideal camera would see it."""

    title = str(QT_TRANSLATE_NOOP("DistortionPanel", "Distortion"))
    purpose = str(
        QT_TRANSLATE_NOOP(
            "DistortionPanel",
            "How far the lens moves each pixel from where an ideal camera would see it.",
        )
    )

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self.part = QComboBox()
        for part, name in (
            (DisplacementPart.COMPLETE, self.tr("Complete")),
            (DisplacementPart.RADIAL, self.tr("Radial part")),
            (DisplacementPart.DECENTERING, self.tr("Decentering part")),
        ):
            self.part.addItem(name, part)
        self.part.setAccessibleName(self.tr("Part of the distortion"))
        self.part.setToolTip(
            self.tr("Radial: along rays from the centre. Decentering: from lenses out of line.")
        )
        self.part.currentIndexChanged.connect(self._refresh_now)
        self.masked = QCheckBox(self.tr("Only &where corners were seen"))
        self.masked.setToolTip(
            self.tr("Beyond the corners' convex hull the correction is an extrapolation.")
        )
        self.masked.toggled.connect(self._refresh_now)
        self.plot = HeatMap(self.tr("displacement d [px]"))
        self.plot.scene().sigMouseMoved.connect(self._hover)
        self.contours = Contours(self.plot, theme.make_pen("#c8ffffff"))
        self._arrows = self.plot.plot(connect="finite", pen=theme.make_pen("#90ffffff"))
        edge = theme.make_pen("#101418")
        self.centre = pg.ScatterPlotItem(symbol="+", size=18, brush="#ffe600", pen=edge)
        self.principal = pg.ScatterPlotItem(symbol="x", size=16, brush="#ff3b30", pen=edge)
        for mark in (self.centre, self.principal):
            self.plot.addItem(mark)
        self.under_cursor = QLabel()
        legend = QLabel(self.tr("+ array's centre   × principal point   → gradient"))
        bar = make_row(self.part, self.masked, None)
        self._fill_body(bar, (self.plot, 1), self.under_cursor, legend, None)

    def displacement(self, uv: Array) -> Displacement:
        """The chosen part of the displacement at pixels (..., 2)."""
        assert self._result is not None
        return compute_displacement(
            uv, self._result.calibration.camera, DisplacementPart(self.part.currentData())
        )

    def _refresh(self, result: Result) -> None:
        camera = result.calibration.camera
        u, v = _cells(camera.size, _CELLS)
        d = self.displacement(make_mesh(u, v)).length
        d = np.where(self._shown(make_mesh(u, v), result), d, np.nan)
        self.plot.show_values(d, image_rectangle(camera.size))
        self.plot.fit(camera.size)
        self.contours.show(u, v, d, choose_levels(float(np.nanmax(d, initial=0.0))))
        at = make_mesh(*_cells(camera.size, _ARROWS)).reshape(-1, 2)
        at = at[self._shown(at, result)]
        gradient = self.displacement(at).gradient
        pitch = max(camera.size) / _ARROWS
        longest = np.linalg.norm(gradient, axis=1).max(initial=1e-12)
        self._arrows.setData(*trace_arrows(at, 0.8 * pitch / longest * gradient).T)
        self.centre.setData(*centre_of_array(camera.size)[:, None])
        self.principal.setData(*camera.centre[:, None])
        self._hover(None)

    def _shown(self, uv: Array, result: Result) -> BoolArray:
        """(...) whether pixels (..., 2) are to be shown."""
        if not self.masked.isChecked():
            return np.ones(uv.shape[:-1], dtype=bool)
        corners = np.concatenate([view.uv for view in result.observations()])
        return np.asarray(scipy.spatial.Delaunay(corners).find_simplex(uv) >= 0)

    def _hover(self, position: QPointF | None) -> None:
        """Say the displacement under the cursor, or the largest where there is none."""
        if self._result is None:
            return
        size = self._result.calibration.camera.size
        uv = self.plot.pixel_at(position, size)
        if uv is not None:
            here = self.displacement(uv)
            self.under_cursor.setText(
                self.tr("u {0:.0f}, v {1:.0f}: d = {2:.2f} px ({3:+.2f}, {4:+.2f})").format(
                    *uv, float(here.length), *here.vector
                )
            )
            return
        values = self.plot.image.image
        self.under_cursor.setText(
            self.tr("d is at most {0} px: point to read it").format(
                format_two_digits(float(np.nanmax(values, initial=0.0)))
            )
        )


def _cells(size: Size, count: int) -> tuple[Array, Array]:
    """u and v of the middles of square cells that cover an image, `count` along its longer side."""
    side = max(size) / count
    u, v = ((np.arange(max(1, round(n / side))) + 0.5) for n in size)
    return u * size[0] / len(u) - 0.5, v * size[1] / len(v) - 0.5

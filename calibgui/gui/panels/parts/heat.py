"""A map over the sensor: values as colours, with a colour bar, v downwards."""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QColor

from calibgui.engine.arrays import Array, Size
from calibgui.gui.widgets.plots import ColourBar, Plot

CORNERS = (QColor(255, 255, 255, 110), "o")
"""Style of the dots where corners were seen."""


def image_rectangle(size: Size) -> QRectF:
    """The pixel array, from edge to edge."""
    return QRectF(-0.5, -0.5, *size)


def surround_places(u: Array, v: Array) -> QRectF:
    """The area of cells around evenly spaced columns u (n,) and rows v (m,)."""
    du, dv = u[1] - u[0], v[1] - v[0]
    return QRectF(u[0] - du / 2, v[0] - dv / 2, len(u) * du, len(v) * dv)


class HeatMap(Plot):
    """Values over the pixel array; NaN is left blank. Axes and colour bar end where it ends.

    Args:
        quantity: what the colours show, with its unit.
        colours: name of a pyqtgraph colour map.
    """

    def __init__(self, quantity: str, colours: str = "viridis") -> None:
        super().__init__("u", "v", "px", "px", square=True)
        self.box.invertY(True)
        self.area.show_grid(False)
        self.image = pg.ImageItem(axisOrder="row-major")
        self.addItem(self.image)
        self.bar = ColourBar(self, quantity, pg.colormap.get(colours), self.image)

    def show_values(self, values: Array, area: QRectF, top: float | None = None) -> None:
        """Spread `values` (rows, columns) over an area of the image.

        Colours start at 0 and end at `top`, or at the largest value.
        """
        if top is None:
            top = float(np.nanmax(values, initial=0.0))
        self.image.setImage(values, autoLevels=False)
        self.image.setRect(area)
        self.bar.set_levels(0.0, max(top, 1e-9))

    def fit(self, size: Size) -> None:
        """Bring the whole pixel array into view."""
        self.enclose(image_rectangle(size))

    def pixel_at(self, position: QPointF | None, size: Size) -> Array | None:
        """(2,) the pixel at a place of the scene; None beside the image."""
        if position is None:
            return None
        place = self.box.mapSceneToView(position)
        return np.array([place.x(), place.y()]) if image_rectangle(size).contains(place) else None

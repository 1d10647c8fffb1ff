"""A map over the sensor: values as colours, with a colour bar, v downwards."""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QRectF

from calibgui.engine.types import Array, Size
from calibgui.gui import theme
from calibgui.gui.plots import Plot


class HeatMap(Plot):
    """Values over the pixel array; NaN is left blank.

    Args:
        quantity: what the colours show, with its unit.
        colours: name of a pyqtgraph colour map.
    """

    def __init__(self, quantity: str, colours: str = "viridis") -> None:
        super().__init__("u", "v", "px", "px", square=True)
        self._quantity = quantity
        item = self.getPlotItem()
        item.getViewBox().invertY(True)
        item.showGrid(x=False, y=False)
        self.image = pg.ImageItem(axisOrder="row-major")
        self.addItem(self.image)
        self.bar = pg.ColorBarItem(width=14, interactive=False, colorMap=pg.colormap.get(colours))
        self.bar.setImageItem(self.image, insert_in=item)
        self._restyle()

    def show_values(self, values: Array, size: Size) -> None:
        """Spread `values` (rows, columns) over an image of `size`; colours start at 0."""
        self.image.setImage(values, autoLevels=False)
        self.image.setRect(QRectF(-0.5, -0.5, *size))
        self.bar.setLevels((0.0, float(np.nanmax(values, initial=1e-9))))

    def fit(self, size: Size) -> None:
        """Bring the whole pixel array into view."""
        self.getPlotItem().getViewBox().setRange(QRectF(-0.5, -0.5, *size), padding=0.01)

    def _restyle(self) -> None:
        super()._restyle()
        if hasattr(self, "bar"):
            colours = theme.current()
            axis = self.bar.axis
            axis.setPen(colours.line)
            axis.setTextPen(colours.text)
            self.bar.getAxis("left").setLabel(self._quantity, color=colours.text)

"""Contour lines over a map, with their heights where there is room for them."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pyqtgraph as pg
from contourpy import contour_generator
from PySide6.QtGui import QColor, QPen

from calibgui.engine.arrays import Array
from calibgui.gui.widgets.plots import Plot

_EDGE = 3.0
"""How many times as far from a label as from the map's edge another label may be."""
_ROOM = 0.1
"""Least distance of labels, in lengths of the map."""


class Contours:
    """Lines of a plot.

    Args:
        plot: that they are drawn on.
        pen: of the lines.
    """

    def __init__(self, plot: Plot, pen: QPen) -> None:
        self._plot = plot
        self.line = plot.plot(connect="finite", pen=pen)
        self.labels: list[pg.TextItem] = []

    def show(self, u: Array, v: Array, values: Array, levels: Iterable[float]) -> None:
        """Draw where `values` (m, n) at columns u (n,) and rows v (m,) are at `levels`."""
        for label in self.labels:
            self._plot.removeItem(label)
        self.labels = []
        gap = np.full((1, 2), np.nan)
        lines: list[Array] = [gap]
        contours = contour_generator(u, v, np.ma.masked_invalid(values))
        taken: list[Array] = []
        for level in reversed(list(levels)):  # the highest have the least room
            found = [np.asarray(line) for line in contours.lines(level)]
            for line in found:
                lines += [line, gap]
            at = _roomiest(np.concatenate([np.zeros((0, 2)), *found]), taken, u, v)
            if at is not None:
                taken.append(at)
                self._label(level, at)
        self.line.setData(*np.concatenate(lines).T)

    def _label(self, level: float, at: Array) -> None:
        label = pg.TextItem(
            f"{level:g}", color=QColor("#101418"), anchor=(0.5, 0.5), fill=(255, 255, 255, 170)
        )
        label.setPos(*at)
        self._plot.addItem(label)
        self.labels.append(label)


def _roomiest(points: Array, taken: list[Array], u: Array, v: Array) -> Array | None:
    """Return the point of (n, 2) farthest from those taken and the map's edge; None if too near."""
    low, high = np.array([u[0], v[0]]), np.array([u[-1], v[-1]])
    room = _EDGE * np.minimum(points - low, high - points).min(axis=1)
    for other in taken:
        room = np.minimum(room, np.linalg.norm(points - other, axis=1))
    if room.max(initial=0.0) < _ROOM * (high - low).max():
        return None
    return np.asarray(points[int(room.argmax())])

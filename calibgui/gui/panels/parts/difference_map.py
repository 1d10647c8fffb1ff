"""A map over the image of how far two cameras differ."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtWidgets import QStackedWidget, QWidget

from calibgui.engine.arrays import Array, BoolArray, Size
from calibgui.engine.numbers import format_two_digits
from calibgui.gui.panels.parts.contours import Contours
from calibgui.gui.panels.parts.heat import CORNERS, HeatMap, surround_places
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.elided import ElidedLabel
from calibgui.gui.widgets.layouts import make_column
from calibgui.gui.widgets.levels import choose_levels
from calibgui.gui.widgets.point_cloud import PointCloud
from calibgui.gui.widgets.wrapped_label import WrappedLabel

_LEVELS = 4
"""Contour lines, at most: the map is small."""
_LEAST_PX = 1e-3
"""Largest difference that is drawn, at least: what is below it is rounding."""


class Difference(Protocol):
    """The distances between the images of the same points, over the image."""

    @property
    def u(self) -> Array:
        """(n,) columns, px."""

    @property
    def v(self) -> Array:
        """(m,) rows, px."""

    @property
    def length(self) -> Array:
        """(m, n) length of the difference, px; NaN where there is none."""

    @property
    def region(self) -> BoolArray:
        """(m, n) true where corners cover the image."""


class DifferenceMap(QWidget):
    """Draws lengths as contours and colours, which end at the largest where corners were seen."""

    def __init__(self) -> None:
        super().__init__()
        self._difference: Difference | None = None
        self._size: Size = (0, 0)
        self.plot = HeatMap(self.tr("difference [px]"))
        self.plot.setToolTip(
            self.tr(
                "Distance between a far point's images by the two calibrations that are compared,\n"
                "after the rotation that brings the two closest where corners (dots) were seen."
            )
        )
        self.plot.scene().sigMouseMoved.connect(self._hover)
        self.contours = Contours(self.plot, theme.make_pen("#c8ffffff"))
        self.corners = PointCloud(size=2)
        self.plot.addItem(self.corners)
        self.under_cursor = ElidedLabel()
        self.reason = WrappedLabel()
        self.reason.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.reason.setMargin(theme.SPACING)
        drawn = QWidget()
        make_column((self.plot, 1), self.under_cursor, None, of=drawn)
        self._stack = QStackedWidget()
        self._stack.addWidget(drawn)
        self._stack.addWidget(self.reason)
        make_column(self._stack, of=self)

    def show_difference(self, difference: Difference, size: Size, corners: Array) -> None:
        """Draw a difference over an image, with the corners (n, 2) that were seen."""
        u, v, length = difference.u, difference.v, difference.length
        top = float(np.nanmax(length[difference.region], initial=0.0))
        if top < _LEAST_PX:
            self.show_reason(
                self.tr("The two calibrations do not differ (below {0:g} px).").format(_LEAST_PX)
            )
            return
        self._difference, self._size = difference, size
        self.plot.show_values(length, surround_places(u, v), top)
        self.plot.fit(size)
        seen = np.where(difference.region, length, np.nan)
        self.contours.show(u, v, seen, choose_levels(top, _LEVELS))
        self.corners.show_points([corners], [CORNERS])
        self._stack.setCurrentIndex(0)
        self._hover(None)

    def show_reason(self, text: str) -> None:
        """Say why there is no map."""
        self._difference = None
        self.reason.setText(text)
        self._stack.setCurrentIndex(1)

    def _hover(self, position: QPointF | None) -> None:
        """Say the difference under the cursor, or the largest where there is none."""
        found = self._difference
        if found is None:
            return
        uv = self.plot.pixel_at(position, self._size)
        if uv is None:
            self.under_cursor.setText(
                self.tr("At most {0} px near corners: point to read it").format(
                    format_two_digits(float(np.nanmax(found.length[found.region], initial=0.0)))
                )
            )
            return
        column, row = np.abs(found.u - uv[0]).argmin(), np.abs(found.v - uv[1]).argmin()
        self.under_cursor.setText(
            self.tr("u {0:.0f}, v {1:.0f}: {2:.3f} px").format(*uv, found.length[row, column])
        )

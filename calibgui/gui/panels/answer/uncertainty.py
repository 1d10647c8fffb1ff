"""The uncertainty of projection over the image."""

from __future__ import annotations

import math

import numpy as np
from PySide6.QtCore import QT_TRANSLATE_NOOP, QPointF
from PySide6.QtWidgets import QLabel

from calibgui.dataset import Result
from calibgui.engine.numbers import format_two_digits
from calibgui.engine.uncertainty import ProjectionUncertainty, estimate_projection_uncertainty
from calibgui.gui.panels.latest import Latest
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.parts.contours import Contours
from calibgui.gui.panels.parts.heat import CORNERS, HeatMap, surround_places
from calibgui.gui.panels.services import Services
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.layouts import make_row
from calibgui.gui.widgets.lengths import describe_condition
from calibgui.gui.widgets.number_box import NumberBox
from calibgui.gui.widgets.point_cloud import PointCloud
from calibgui.gui.widgets.reserved_label import ReservedLabel

_LIMIT = 0.1
"""Uncertainty that a user can live with, until another is stated, px."""
_TOP = 4.0
"""Multiple of the median at which colours end: places without data would hide the rest."""


class UncertaintyPanel(Panel):
    """Shows one standard deviation of projection, without what moving the camera would undo.

    Args:
        jobs: that do the work.
    """

    title = str(QT_TRANSLATE_NOOP("UncertaintyPanel", "Uncertainty"))
    purpose = str(
        QT_TRANSLATE_NOOP(
            "UncertaintyPanel",
            "How well it is known where points are imaged.",
        )
    )

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self._work = Latest(services.jobs, self)
        self.found: ProjectionUncertainty | None = None
        """The uncertainty that is drawn; None while it is being computed."""
        self.distance = NumberBox(decimals=0, maximum=1e7, singleStep=100, suffix=self.tr(" mm"))
        self.distance.setSpecialValueText(self.tr("far away"))
        self.distance.setToolTip(
            self.tr("Of the points that the camera will look at; 0 for points far away.")
        )
        self.limit = NumberBox(
            decimals=3, minimum=0.001, maximum=100, singleStep=0.01, suffix=self.tr(" px")
        )
        self.limit.setValue(_LIMIT)
        self.limit.setToolTip(
            self.tr("The uncertainty that you can live with: the red line goes around it.")
        )
        labels = QLabel(self.tr("P&oints")), QLabel(self.tr("Limi&t"))
        for label, box in zip(labels, (self.distance, self.limit), strict=True):
            box.setKeyboardTracking(False)
            label.setBuddy(box)
        bar = make_row(labels[0], self.distance, labels[1], self.limit, None)
        self.distance.valueChanged.connect(self._refresh_now)
        self.limit.valueChanged.connect(self._draw_limit)
        self.words = ReservedLabel(5)
        self.plot = HeatMap(self.tr("one σ, worst direction [px]"))
        self.plot.setToolTip(
            self.tr(
                "A point of the scene is imaged this far from where the calibration says (1σ).\n"
                "What turning and shifting the camera would undo is taken out.\n"
                "It is what the calibration says of itself. The verdict's error may be another:\n"
                "where the remedy of a finding was tried, it is measured against the camera that\n"
                "the remedy gives. Where there are no corners it adds how far another lens model\n"
                "goes apart from this one that fits as well."
            )
        )
        self.plot.scene().sigMouseMoved.connect(self._hover)
        self.region = Contours(self.plot, theme.make_pen("#ff3b30", width=2.5))
        self.corners = PointCloud(size=2)
        self.plot.addItem(self.corners)
        self.under_cursor = QLabel()
        self._fill_body(bar, self.words, (self.plot, 1), self.under_cursor, None)

    def _refresh(self, result: Result) -> None:
        self.found = None
        self.words.setText(self.tr("Working…"))
        views = result.observations()
        self.corners.show_points([np.concatenate([view.uv for view in views])], [CORNERS])
        distance = self.distance.value() or math.inf
        self._work.start(
            self.tr("Propagating the uncertainty"),
            lambda _: estimate_projection_uncertainty(result.calibration, views, distance),
            self._show,
            lambda error: self.words.setText(str(error)),
        )

    def _restyle(self) -> None:
        """Whatever has colours follows them by itself."""

    def _show(self, found: ProjectionUncertainty) -> None:
        self.found = found
        u, v, sigma = found.u, found.v, found.worst_direction
        self.plot.show_values(sigma, surround_places(u, v), self._find_top(found))
        self.plot.fit(found.size)
        self._draw_limit()
        self._hover(None)

    def _find_top(self, found: ProjectionUncertainty) -> float:
        """Return what the brightest colour stands for, px; a few places far beyond share it."""
        return min(found.worst, _TOP * found.median)

    def _draw_limit(self) -> None:
        found, limit = self.found, self.limit.value()
        if found is None or self._result is None:
            return
        self.region.show(found.u, found.v, found.worst_direction, [limit])
        share = found.fraction(limit)
        inside = self.tr(" (inside the red line)") if 0 < share < 1 else ""
        text = self.tr(
            "By this lens model points {0} are imaged to {1} px at the centre, {2} px in the "
            "median, {3} px at worst (1σ). {4:.0f} % of the image is known to {5:g} px or "
            "better{6}."
        ).format(
            self.tr("{0:g} mm away").format(found.distance) + describe_condition(self._result)
            if math.isfinite(found.distance)
            else self.tr("far away"),
            *map(format_two_digits, (found.centre, found.median, found.worst)),
            100 * share,
            limit,
            inside,
        )
        if (top := self._find_top(found)) < found.worst:
            text += self.tr(" The brightest colour is {0} px or more.").format(
                format_two_digits(top)
            )
        self.words.setText(text)

    def _hover(self, position: QPointF | None) -> None:
        """Say the uncertainty under the cursor."""
        found = self.found
        uv = None if found is None else self.plot.pixel_at(position, found.size)
        if found is None or uv is None:
            self.under_cursor.setText(self.tr("Point at the map to read it."))
            return
        column, row = np.abs(found.u - uv[0]).argmin(), np.abs(found.v - uv[1]).argmin()
        self.under_cursor.setText(
            self.tr("u {0:.0f}, v {1:.0f}: σ = {2:.3f} px, in all directions {3:.3f} px").format(
                *uv, found.worst_direction[row, column], found.rms[row, column]
            )
        )

"""The coverage of the sensor, and of tilts and distances of the board, by the views."""

from __future__ import annotations

import math

import numpy as np
import pyqtgraph as pg
import scipy
from PySide6.QtCore import QT_TRANSLATE_NOOP, QRectF, Qt

from calibgui.dataset import Result
from calibgui.dataset.sensor_coverage import count_corners_per_cell
from calibgui.engine.numbers import format_two_digits
from calibgui.engine.uncertainty import NextView, propose_views
from calibgui.gui.panels.evidence.view_scatter import ViewScatter
from calibgui.gui.panels.latest import Latest
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.parts.heat import HeatMap, image_rectangle
from calibgui.gui.panels.parts.split import Split
from calibgui.gui.panels.services import Services
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.lengths import describe_condition
from calibgui.gui.widgets.reserved_label import ReservedLabel
from calibgui.report.boards import name_point
from calibgui.report.coverage import measure_attitudes

_CELLS = (24, 18)
"""Columns and rows of the density that is drawn."""
_MAP_HEIGHT = 248
"""Least height of the map, px: it is the panel's main thing, and as wide as a narrow panel then."""
_RING = 15
"""Tilt from one circle to the next, degrees."""
_LEAST_RINGS = 3
_ROOM = 1.1
"""Room around the outermost circle, as a share of it, for its number."""
_DIRECTIONS = 24
"""Directions that the circles' numbers may be written along."""


class CoveragePanel(Panel):
    """Shows which parts of the sensor, tilts and distances the views cover, and which view to add.

    Args:
        services: the window's jobs look for the view that would help most.
    """

    title = str(QT_TRANSLATE_NOOP("CoveragePanel", "Coverage"))
    purpose = str(
        QT_TRANSLATE_NOOP(
            "CoveragePanel",
            "What the views cover of the image, of tilts and distances, and which to add next.",
        )
    )

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self._work = Latest(services.jobs, self)
        self.density = HeatMap("")
        self.density.bar.axis.is_count = True
        self.density.setMinimumHeight(_MAP_HEIGHT)
        self.density.setToolTip(
            self.tr("Where corners were seen. The lens correction is extrapolated beyond them.")
        )
        self.next_board = self.density.plot(pen=theme.make_pen("#ff3b30", width=2.5))
        self.next_corners = pg.ScatterPlotItem(size=3, pen=None, brush="#ff3b30")
        self.density.addItem(self.next_corners)
        self.advice = ReservedLabel(4)
        self.tilts = ViewScatter(
            self.tr("tilt to the right"), self.tr("tilt upwards"), "°", "°", square=True
        )
        self.tilts.setToolTip(
            self.tr(
                "Each view's tilt, towards the side of the board that is farther away.\n"
                "Points on all sides, 20° to 45° out, determine the focal length best."
            )
        )
        self.rings = self.tilts.plot(
            connect="finite", pen=theme.make_pen("#808080", style=Qt.PenStyle.DotLine)
        )
        self.ring_numbers: list[pg.TextItem] = []
        self.distances = ViewScatter(self.tr("view"), self.tr("distance"), counts=True)
        self.distances.setToolTip(self.tr("From the camera to the middle of the corners seen."))
        self._planned: Result | None = None
        for plot in (self.tilts, self.distances):
            plot.picked.connect(self._pick)
        plots = Split(820, (self.density, 3), (self.distances, 2), (self.tilts, 2))
        # In a high card room is left: the map is no higher than its width allows.
        self._fill_body(self.advice, (plots, 1), None)

    def _refresh(self, result: Result) -> None:
        size = result.calibration.camera.size
        observations = result.observations()
        uv = np.concatenate([view.uv for view in observations])
        self.density.show_values(
            count_corners_per_cell(uv, size, _CELLS).astype(np.float64), image_rectangle(size)
        )
        self.density.bar.set_quantity(
            self.tr("circles in a cell")
            if name_point(result.board) == "circle"
            else self.tr("corners in a cell")
        )
        self.density.fit(size)
        attitude = measure_attitudes(result.calibration, observations)
        tilt = np.rad2deg(attitude.tilt)
        self.tilts.show_views(
            np.stack(
                [tilt * np.cos(attitude.direction), tilt * np.sin(attitude.direction)], axis=1
            ),
            self._indices,
        )
        self.distances.show_views(
            np.stack([np.arange(1, len(tilt) + 1), attitude.distance], axis=1), self._indices
        )
        if condition := describe_condition(result):  # which is too long for the upright axis
            views = self.tr("view (distance in mm{0})").format(condition)
            self.distances.set_labels(views, self.tr("distance"))
        else:
            self.distances.set_labels(self.tr("view"), self.tr("distance"), y_unit=self.tr("mm"))
        self.distances.box.setYRange(0, 1.1 * attitude.distance.max())
        self._draw_rings()
        self._look_for_next(result)

    def _look_for_next(self, result: Result) -> None:
        if result is self._planned:
            return
        self._planned = result
        self._draw_next(None)
        self.advice.setText(self.tr("Which view would help most? Working…"))
        self._work.start(
            self.tr("Looking for the next view"),
            lambda _: propose_views(result.calibration, result.observations(), 1)[0],
            self._draw_next,
            lambda error: self.advice.setText(str(error)),
            self._forgo,
        )

    def _forgo(self) -> None:
        """The user does not want to wait; it is tried again when the panel is drawn anew."""
        self._planned = None
        self.advice.setText(self.tr("Which view would help most was not examined."))

    def _draw_next(self, view: NextView | None) -> None:
        """Draw where the board should be next, and say so."""
        if view is None:
            self.next_board.setData([], [])
            self.next_corners.setData([], [])
            return
        around = scipy.spatial.ConvexHull(view.corners).vertices
        self.next_board.setData(*view.corners[[*around, around[0]]].T)
        self.next_corners.setData(*view.corners.T)
        diagnosis = None if self._planned is None else self._planned.calibration.diagnosis
        if diagnosis is not None:
            text = self.tr("The next view (red): {0} {1}")
            self.advice.setText(text.format(view.instruction, diagnosis.hint))
            return
        before, after = map(format_two_digits, (view.before, view.after))
        text = (
            self.tr("The next view (red): {0} It hardly lowers the uncertainty of {1} px.")
            if before == after
            else self.tr(
                "The next view (red): {0} It lowers the uncertainty over the image from "
                "{1} to {2} px."
            )
        )
        self.advice.setText(text.format(view.instruction, before, after))

    def _select(self, k: int, corner: int) -> None:  # noqa: ARG002 - a view has one tilt
        self._ring_view(k)

    def _hover_view(self, k: int) -> None:
        self._ring_view(k if k >= 0 else self._selected[0])

    def _ring_view(self, k: int) -> None:
        self.tilts.ring_view(k)
        self.distances.ring_view(k)

    def _draw_rings(self) -> None:
        """Draw circles around all tilts, with their numbers where points leave room for them."""
        points = self.tilts.points
        largest = float(np.linalg.norm(points, axis=1).max())
        rings = _RING * np.arange(1, max(_LEAST_RINGS, math.ceil(largest / _RING)) + 1)
        turn = np.append(np.linspace(0, 2 * np.pi, 73), np.nan)  # NaN parts one from the next
        self.rings.setData(
            np.outer(rings, np.cos(turn)).ravel(), np.outer(rings, np.sin(turn)).ravel()
        )
        turn = 2 * np.pi / _DIRECTIONS * np.arange(_DIRECTIONS)
        at = rings[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)[:, None]
        away = np.linalg.norm(at[:, :, None] - points, axis=-1).min(axis=(1, 2))
        for number in self.ring_numbers:
            self.tilts.removeItem(number)
        self.ring_numbers = []
        for degrees, place in zip(rings, at[away.argmax()], strict=True):
            number = pg.TextItem(f"{degrees}°", theme.current().muted, anchor=(0.5, 0.5))
            number.setPos(*place)
            self.tilts.addItem(number)
            self.ring_numbers.append(number)
        reach = _ROOM * float(rings[-1])
        self.tilts.enclose(QRectF(-reach, -reach, 2 * reach, 2 * reach))

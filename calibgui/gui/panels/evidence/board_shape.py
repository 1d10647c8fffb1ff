"""The estimated board shape: arrows for deviations in the plane, colours for those out of it."""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
import scipy
from PySide6.QtCore import QT_TRANSLATE_NOOP, QPointF, QRectF
from PySide6.QtWidgets import QLabel

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.boards import BoardShape
from calibgui.engine.errors import CalibrationError
from calibgui.formats.board_shape_json import write_board_shape
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.parts.arrows import trace_arrows
from calibgui.gui.panels.services import Services
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button
from calibgui.gui.widgets.layouts import make_row
from calibgui.gui.widgets.lengths import describe_condition, name_unit, state_condition
from calibgui.gui.widgets.plots import ColourBar, Plot
from calibgui.gui.widgets.save_names import ask_for_name
from calibgui.gui.widgets.wrapped_label import WrappedLabel
from calibgui.report.summary import (
    describe_board_shape,
    describe_board_shape_error,
    describe_lens_error,
)

_LONGEST = 0.8
"""Length of the longest arrow, in distances between corners."""
_COLOURS = "CET-D1"


class BoardShapePanel(Panel):
    """The board's deviations from its drawing."""

    title = str(QT_TRANSLATE_NOOP("BoardShapePanel", "Board shape"))
    purpose = str(
        QT_TRANSLATE_NOOP("BoardShapePanel", "How the real board deviates from its drawing.")
    )

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self.words = WrappedLabel()
        self.save = Button(self.tr("&Save shape…"))
        self.save.setToolTip(
            self.tr(
                "Write the board's shape to a file, for later calibrations with the same board: "
                "Set-up, Board is: as in a file."
            )
        )
        self.save.clicked.connect(self._ask_and_save)
        self.plot = Plot(self.tr("X on the board"), self.tr("Y on the board"), square=True)
        self.plot.box.invertY(True)
        self.dots = pg.ScatterPlotItem(size=9, pen=theme.make_pen("#808080"))
        self.colours = pg.colormap.get(_COLOURS)
        self.bar = ColourBar(self.plot, "", self.colours)
        self.plot.setToolTip(
            self.tr(
                "Arrows: from where corners should be to where they are, magnified.\n"
                "Colours: out of the plane; red is away from the camera."
            )
        )
        self.plot.addItem(self.dots)
        self.arrows = self.plot.plot(connect="finite")
        self.key = pg.TextItem(anchor=(0, 0.5))
        self.plot.addItem(self.key)
        self.plot.scene().sigMouseMoved.connect(self._hover)
        self.under_cursor = QLabel()
        below = make_row((self.under_cursor, 1), self.save)
        self._fill_body(self.words, (self.plot, 1), below, None)

    @property
    def board_shape(self) -> BoardShape:
        """The board shape that is shown."""
        assert self._shown.calibration.board_shape is not None
        return self._shown.calibration.board_shape

    @property
    def _shown(self) -> Result:
        assert self._result is not None
        return self._result

    def _missing(self, result: Result) -> str:
        calibration = result.calibration
        if calibration.board_shape is not None:
            return ""
        how = self.tr(
            "The board was taken as drawn. To estimate its shape, choose “free” or another "
            "model at “Board is” in the Set-up and calibrate again."
        )
        if (missed := calibration.lens_error) > 0:
            return describe_lens_error(calibration, missed)
        doubt = calibration.board_shape_error
        if doubt == 0:
            return how
        words = f"{describe_board_shape_error(doubt)} {state_condition(result)}"
        return f"{words.rstrip()}\n\n{how}"

    def _refresh(self, result: Result) -> None:
        board_shape = self.board_shape
        unit = name_unit(result)
        self.plot.set_labels(self.tr("X on the board"), self.tr("Y on the board"), unit, unit)
        self.bar.set_quantity(self.tr("out of the plane [{0}]").format(unit))
        at, d = board_shape.nominal, board_shape.deviation
        reach = float(np.abs(d[:, 2]).max()) or 1e-3
        brushes = self.colours.map((d[:, 2] / reach + 1) / 2, mode="qcolor")
        self.dots.setData(*at.T, brush=list(brushes))
        self.bar.set_levels(-reach, reach)
        nearest = scipy.spatial.cKDTree(at).query(at, k=2)[0]
        pitch = self._pitch = float(np.asarray(nearest)[:, 1].min())
        longest = float(np.linalg.norm(d[:, :2], axis=1).max()) or 1e-3
        scale = _LONGEST * pitch / longest
        corner, size = at.min(axis=0) - [0.0, 1.4 * pitch], _round_down(longest)
        key = np.array([[size * scale, 0.0]])
        tails = np.vstack([at + scale * d[:, :2] / 2, corner + key / 2])
        self.arrows.setData(*trace_arrows(tails, np.vstack([scale * d[:, :2], key])).T)
        colours = theme.current()
        self.arrows.setPen(theme.make_pen(colours.text, width=1.5))
        self.arrows.setShadowPen(theme.make_pen(colours.base, width=3.5))  # over pale discs
        self.key.setText(self.tr("{0:g} mm in the plane").format(size), color=colours.text)
        self.key.setPos(corner[0] + size * scale + 0.2 * pitch, corner[1])
        low, high = at.min(axis=0) - pitch * np.array([1.0, 2.0]), at.max(axis=0) + pitch
        self.plot.enclose(QRectF(*low, *(high - low)))
        words = describe_board_shape(board_shape)
        calibration = result.calibration
        if (missed := calibration.lens_error) > 0:
            words = f"{describe_lens_error(calibration, missed)}\n\n{words}"
        if board_shape.sigma.any():
            known = float(np.median(board_shape.sigma[board_shape.sigma > 0]))
            words += self.tr(" Each is known to ± {0:.2g} mm (1σ, median).").format(known)
        self.words.setText(f"{words} {state_condition(result)}".rstrip())
        self._hover(None)

    def _hover(self, position: QPointF | None) -> None:
        """Say the deviation of the corner under the cursor."""
        k = -1 if position is None else self._corner_at(position)
        if k < 0:
            self.under_cursor.setText(self.tr("Point at a corner to read it."))
            return
        board_shape = self.board_shape
        x, y, z = (
            f"{value:+.3f} ± {sigma:.3f}"
            for value, sigma in zip(board_shape.deviation[k], board_shape.sigma[k], strict=True)
        )
        self.under_cursor.setText(
            self.tr("({0:g}, {1:g}) mm: x {2}, y {3}, z {4} mm").format(
                *board_shape.nominal[k], x, y, z
            )
            + describe_condition(self._shown)
        )

    def _corner_at(self, position: QPointF) -> int:
        """The corner at a place of the scene; -1 for none."""
        place = self.plot.box.mapSceneToView(position)
        away: Array = np.linalg.norm(self.board_shape.nominal - [place.x(), place.y()], axis=1)
        k = int(away.argmin())
        return k if away[k] < self._pitch / 2 else -1

    def _ask_and_save(self) -> None:
        path = ask_for_name(
            self, self.tr("Save the board's shape"), "board-shape.json", self.tr("Shapes (*.json)")
        )
        if path is None:
            return
        try:
            write_board_shape(self.board_shape, path)
        except CalibrationError as error:
            self.failed.emit(error)


def _round_down(length: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is at most `length`."""
    power = 10.0 ** np.floor(np.log10(length))
    return float(power * max(m for m in (1, 2, 5) if m * power <= length * (1 + 1e-9)))

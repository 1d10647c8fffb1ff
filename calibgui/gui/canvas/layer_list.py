"""The list of what is drawn over the photograph: an eye and an opacity for each layer."""

from __future__ import annotations

from typing import NamedTuple

from PySide6.QtCore import QPointF, QSize, Qt
from PySide6.QtGui import QAction, QColor, QPainter, QPainterPath, QPaintEvent, QPen, QPixmap
from PySide6.QtWidgets import (
    QAbstractButton,
    QCheckBox,
    QDoubleSpinBox,
    QGridLayout,
    QLabel,
    QSlider,
    QWidget,
)

from calibgui.gui.canvas.canvas import Canvas
from calibgui.gui.canvas.layers import Layer
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.actions import make_action

_SWATCH = 12
_OPACITY_WIDTH = 72
_EYE = QSize(22, 16)


class _Row(NamedTuple):
    """How a layer is named and drawn."""

    layer: Layer
    name: str
    key: str
    tip: str
    colour: QColor


class Eye(QCheckBox):
    """A box to tick that is drawn as an eye, open or struck out."""

    def sizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        return _EYE

    def minimumSizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        return _EYE

    def hitButton(self, at: object) -> bool:  # noqa: N802, ARG002 - Qt's name
        return True

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        colours = theme.current()
        is_open = self.isChecked()
        middle = QPointF(self.width() / 2, self.height() / 2)
        left, right = middle - QPointF(8, 0), middle + QPointF(8, 0)
        lids = QPainterPath(left)
        lids.quadTo(middle - QPointF(0, 9), right)
        lids.quadTo(middle + QPointF(0, 9), left)
        colour = QColor(colours.accent if self.hasFocus() else colours.text)
        painter.setPen(QPen(colour if is_open else QColor(colours.muted), 1.4))
        painter.drawPath(lids)
        if is_open:
            painter.setBrush(colour)
            painter.drawEllipse(middle, 2.4, 2.4)
        else:
            painter.drawLine(middle + QPointF(-6, 5), middle + QPointF(6, -5))
        if self.hasFocus():
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(colour, 1, Qt.PenStyle.DotLine))
            painter.drawRect(self.rect().adjusted(0, 0, -1, -1))


class LayerList(QWidget):
    """One row for each layer: an eye, its colour and name, and its opacity.

    Attributes:
        actions_by_layer: what shows and hides each, for the menu.
    """

    def __init__(self, canvas: Canvas) -> None:
        super().__init__()
        self._canvas = canvas
        self.actions_by_layer: dict[Layer, QAction] = {}
        self.eyes: dict[Layer, QAbstractButton] = {}
        self.opacities: dict[Layer, QSlider] = {}
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.setVerticalSpacing(1)
        self._grid.setColumnStretch(2, 1)
        self.scale = QDoubleSpinBox(decimals=0, minimum=1, maximum=10_000, prefix="× ")
        self.scale.setValue(canvas.residual_scale)
        self.scale.setToolTip(self.tr("How many times as long as they are residuals are drawn"))
        self.scale.setAccessibleName(self.tr("Magnification of residuals"))
        self.scale.valueChanged.connect(canvas.set_residual_scale)
        self._grid.addWidget(QLabel(self.tr("Opacity")), 0, 4, Qt.AlignmentFlag.AlignHCenter)
        for row in (*self._describe_image_layers(), *self._describe_camera_layers()):
            self._add(row)

    def _describe_image_layers(self) -> tuple[_Row, ...]:
        """Describe what is drawn of the selected image."""
        return (
            _Row(
                Layer.REGION,
                self.tr("&Region of interest"),
                "Shift+1",
                self.tr("The part of the image that was searched (yellow outline)"),
                theme.REGION,
            ),
            _Row(
                Layer.ESTIMATES,
                self.tr("First &estimates"),
                "Shift+2",
                self.tr("Corners to the nearest pixel, by Harris' detector (red +)"),
                theme.ESTIMATE,
            ),
            _Row(
                Layer.CORNERS,
                self.tr("Refi&ned corners"),
                "Shift+3",
                self.tr("Corners at the saddle point of the grey levels (yellow +)"),
                theme.REFINED,
            ),
            _Row(
                Layer.ORDER,
                self.tr("&Order and axes"),
                "Shift+4",
                self.tr("The numbering of the corners: origin, rows, and the board's axes"),
                theme.PATH,
            ),
            _Row(
                Layer.REPROJECTION,
                self.tr("Re&projection"),
                "Shift+5",
                self.tr("Where the calibration expects the corners (blue circles)"),
                theme.REPROJECTED,
            ),
            _Row(
                Layer.RESIDUALS,
                self.tr("Re&siduals"),
                "Shift+6",
                self.tr("Arrows from expected to measured corners, magnified"),
                theme.RESIDUAL,
            ),
        )

    def _describe_camera_layers(self) -> tuple[_Row, ...]:
        """Describe what is drawn of the whole calibration."""
        return (
            _Row(
                Layer.COVERAGE,
                self.tr("Co&verage"),
                "Shift+7",
                self.tr("The corners of all views, each view's in its colour"),
                QColor(theme.MUTED_MARK),
            ),
            _Row(
                Layer.UNCERTAINTY,
                self.tr("&Uncertainty"),
                "Shift+8",
                self.tr("Lines along which points far away are located equally well (1σ)"),
                theme.UNCERTAIN,
            ),
            _Row(
                Layer.DISTORTION,
                self.tr("&Distortion"),
                "Shift+9",
                self.tr("Lines along which the lens displaces pixels equally far"),
                theme.MAGNITUDE,
            ),
            _Row(
                Layer.DISPLACEMENT,
                self.tr("Displacement &arrows"),
                "Shift+0",
                self.tr("Arrows from where the lens images a point to where a pinhole would"),
                theme.DISPLACED,
            ),
            _Row(
                Layer.NEXT_VIEW,
                self.tr("Ne&xt view"),
                "Shift+N",
                self.tr("Where the board should be held next, to lower the uncertainty most"),
                theme.NEXT_VIEW,
            ),
        )

    def _add(self, row: _Row) -> None:
        layer, canvas = row.layer, self._canvas
        action = make_action(self, row.name, row.key, row.tip, lambda: None)
        action.setCheckable(True)
        action.setChecked(layer in canvas.shown)
        action.toggled.connect(lambda shown: canvas.set_layer(layer, shown))
        plain = row.name.replace("&", "")
        eye = Eye()
        eye.setChecked(action.isChecked())
        eye.setToolTip(row.tip)
        eye.setAccessibleName(self.tr("Show {0}").format(plain))
        eye.toggled.connect(action.setChecked)
        action.toggled.connect(eye.setChecked)
        swatch = QLabel()
        swatch.setPixmap(_draw_swatch(row.colour))
        name = QLabel(plain)
        name.setToolTip(row.tip)
        opacity = QSlider(Qt.Orientation.Horizontal)
        opacity.setRange(10, 100)
        opacity.setValue(100)
        opacity.setFixedWidth(_OPACITY_WIDTH)
        opacity.setToolTip(self.tr("Opacity"))
        opacity.setAccessibleName(self.tr("Opacity of {0}").format(plain))
        opacity.valueChanged.connect(lambda value: canvas.set_opacity(layer, value / 100))
        at = self._grid.rowCount()
        self._grid.setRowMinimumHeight(at, self.scale.sizeHint().height())  # as the row that has it
        for column, widget in ((0, eye), (1, swatch), (2, name), (4, opacity)):
            self._grid.addWidget(widget, at, column)
        if layer is Layer.RESIDUALS:
            self._grid.addWidget(self.scale, at, 3)
        self.actions_by_layer[layer] = action
        self.eyes[layer], self.opacities[layer] = eye, opacity


def _draw_swatch(colour: QColor) -> QPixmap:
    """Return a patch of a colour with an edge that shows on any ground."""
    icon = QPixmap(_SWATCH, _SWATCH)
    icon.fill(colour)
    painter = QPainter(icon)
    painter.setPen(QColor(128, 128, 128))
    painter.drawRect(0, 0, _SWATCH - 1, _SWATCH - 1)
    painter.end()
    return icon

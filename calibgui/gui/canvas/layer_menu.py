"""The menu of what is drawn over the photograph."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

from PySide6.QtGui import QAction, QColor, QIcon, QPainter, QPixmap
from PySide6.QtWidgets import QMenu, QWidgetAction

from calibgui.gui.canvas.canvas import Canvas
from calibgui.gui.canvas.layers import Layer
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.actions import make_action
from calibgui.gui.widgets.number_box import NumberBox

_SWATCH = 12


class _Row(NamedTuple):
    """The name of a layer, and its drawing."""

    layer: Layer
    name: str
    key: str
    tip: str
    colour: QColor


class LayerMenu(QMenu):
    """One entry for each layer, with its colour, and how much residuals are magnified.

    Attributes:
        actions_by_layer: what shows and hides each.
    """

    def __init__(self, canvas: Canvas) -> None:
        super().__init__(canvas)
        self.setToolTipsVisible(True)
        self.actions_by_layer: dict[Layer, QAction] = {}
        self.scale = NumberBox(decimals=0, minimum=1, maximum=10_000)
        self.scale.setPrefix(self.tr("Residuals × "))
        self.scale.setValue(canvas.residual_scale)
        self.scale.setToolTip(self.tr("How many times as long as they are residuals are drawn"))
        self.scale.setAccessibleName(self.tr("Magnification of residuals"))
        self.scale.valueChanged.connect(canvas.set_residual_scale)
        for layer, name, key, tip, colour in self._describe_layers():
            action = make_action(self, name, key, tip, lambda: None)
            action.setCheckable(True)
            action.setChecked(layer in canvas.shown)
            action.setIcon(_draw_swatch(colour))
            action.toggled.connect(partial(canvas.set_layer, layer))
            self.addAction(action)
            self.actions_by_layer[layer] = action
        magnification = QWidgetAction(self)
        magnification.setDefaultWidget(self.scale)
        self.addAction(magnification)

    def _describe_layers(self) -> tuple[_Row, ...]:
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


def _draw_swatch(colour: QColor) -> QIcon:
    """Return a patch of a colour with an edge that shows on any ground."""
    icon = QPixmap(_SWATCH, _SWATCH)
    icon.fill(colour)
    painter = QPainter(icon)
    painter.setPen(QColor(128, 128, 128))
    painter.drawRect(0, 0, _SWATCH - 1, _SWATCH - 1)
    painter.end()
    return QIcon(icon)

"""The views' RMS as bars, with a threshold above which they can be excluded."""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF, Qt, Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import (
    QDoubleSpinBox,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from calibgui.engine.arrays import Array
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.plots import Plot


class ViewErrors(QWidget):
    """One bar a view; the line across them is dragged, or its height typed."""

    picked = Signal(int)
    """The view whose bar was clicked."""
    exclude_wanted = Signal(tuple)
    """The views above the threshold: the user wants them out."""

    def __init__(self) -> None:
        super().__init__()
        self._rms: Array = np.zeros(0)
        self._selected = -1
        self.plot = Plot(self.tr("view"), self.tr("RMS"), y_unit=self.tr("px"))
        self.plot.setToolTip(
            self.tr(
                "Root mean square residual of each view in the image. Drag the line down to mark "
                "views that fit badly."
            )
        )
        self._bars = pg.BarGraphItem(x=[], height=[], width=0.8)
        self._overall = pg.InfiniteLine(angle=0)
        self.line = pg.InfiniteLine(angle=0, movable=True)
        self.line.setZValue(10)
        for item in (self._bars, self._overall, self.line):
            self.plot.addItem(item)
        self.plot.getPlotItem().getViewBox().setMouseEnabled(x=True, y=False)
        self.plot.scene().sigMouseClicked.connect(self._clicked)
        self.threshold = QDoubleSpinBox(decimals=3, singleStep=0.01, suffix=self.tr(" px"))
        self.threshold.setMaximum(1e6)
        self.exclude = QPushButton()
        label = QLabel(self.tr("&Threshold"))
        label.setBuddy(self.threshold)
        bar = QHBoxLayout()
        bar.addWidget(label)
        bar.addWidget(self.threshold)
        bar.addStretch(1)
        bar.addWidget(self.exclude)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.plot, 1)
        layout.addLayout(bar)
        self.line.sigPositionChanged.connect(lambda: self.threshold.setValue(self.line.value()))
        self.threshold.valueChanged.connect(self._threshold_changed)
        self.exclude.clicked.connect(lambda: self.exclude_wanted.emit(self.above))

    @property
    def above(self) -> tuple[int, ...]:
        """The views above the threshold."""
        return tuple(np.flatnonzero(self._rms > self.threshold.value()).tolist())

    def show_views(self, rms: Array, overall: float) -> None:
        """Show the RMS of each view and of all; the threshold starts above them all."""
        self._rms, self._selected = rms, -1
        self._overall.setValue(overall)
        self.plot.set_title(self.tr("all together {0:.3f} px (dotted)").format(overall))
        top = 1.15 * float(rms.max())
        self.plot.setYRange(0, 1.05 * top, padding=0)
        self.plot.setXRange(0.4, len(rms) + 0.6, padding=0)
        self.line.setBounds((0, top))
        self.threshold.setValue(top)
        self._threshold_changed()

    def select(self, view: int) -> None:
        """Outline a view's bar; -1 for none."""
        self._selected = view
        self._draw()

    def _threshold_changed(self) -> None:
        self.line.setValue(self.threshold.value())
        count = len(self.above)
        self.exclude.setEnabled(0 < count < len(self._rms))
        self.exclude.setText(
            self.tr("E&xclude those above: {0}").format(count) if count else self.tr("None above")
        )
        self._draw()

    def _draw(self) -> None:
        colours = theme.current()
        above = set(self.above)
        brushes = [
            QColor(colours.bad) if k in above else theme.view_colour(k)
            for k in range(len(self._rms))
        ]
        clear, ring = pg.mkPen(None), pg.mkPen(colours.text, width=3)
        self._bars.setOpts(
            x=np.arange(1, len(self._rms) + 1),
            height=self._rms,
            brushes=brushes,
            pens=[ring if k == self._selected else clear for k in range(len(self._rms))],
        )
        self._overall.setPen(pg.mkPen(colours.muted, style=Qt.PenStyle.DotLine))
        self.line.setPen(pg.mkPen(colours.bad, width=2))
        self.line.setHoverPen(pg.mkPen(colours.bad, width=4))

    def _clicked(self, event: pg.GraphicsScene.mouseEvents.MouseClickEvent) -> None:
        place: QPointF = self.plot.getPlotItem().getViewBox().mapSceneToView(event.scenePos())
        view = round(place.x()) - 1
        if event.button() is Qt.MouseButton.LeftButton and 0 <= view < len(self._rms):
            self.picked.emit(view)

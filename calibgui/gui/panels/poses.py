"""Camera and boards in space, turned with the mouse or the arrow keys."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QT_TRANSLATE_NOOP, QPointF, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPolygonF,
    QWheelEvent,
)
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from calibgui.app.calibration import shorten_names
from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.services import Services
from calibgui.gui.widgets import theme
from calibgui.report.coverage import measure_attitudes
from calibgui.report.scene3d import (
    DrawnPolygon,
    Observer,
    Polygon,
    PolygonKind,
    SceneCentre,
    build_scene,
    draw_scene,
    find_view_at,
    fit_zoom,
)

_FILLED = 150
"""Polygons up to which they are filled: more would be a blur, and slow."""
_TURN = 0.008
"""Angle for a pixel of dragging, rad."""
_KEYS = {
    Qt.Key.Key_Left: (-0.1, 0.0),
    Qt.Key.Key_Right: (0.1, 0.0),
    Qt.Key.Key_Up: (0.0, -0.1),
    Qt.Key.Key_Down: (0.0, 0.1),
}


class SceneView(QWidget):
    """Polygons in space, painted from the farthest to the nearest."""

    picked = Signal(int)
    """The view whose polygon was clicked."""

    def __init__(self) -> None:
        super().__init__()
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMinimumSize(160, 120)
        self.observer = Observer()
        self._polygons: tuple[Polygon, ...] = ()
        self._drawn: tuple[DrawnPolygon, ...] = ()
        self._selected = -1
        self._pressed: QPointF | None = None
        self._last = QPointF()

    def show_scene(self, polygons: tuple[Polygon, ...]) -> None:
        """Show all of these, from the side where the observer stands."""
        self._polygons = polygons
        self.look_from(fit_zoom(polygons, self.observer))

    def go_home(self) -> None:
        """Show all from where the observer stood first."""
        self.look_from(fit_zoom(self._polygons, Observer()))

    def look_from(self, observer: Observer) -> None:
        """Move the observer."""
        self.observer = observer
        self._redraw()

    def select(self, view: int) -> None:
        """Highlight a view; -1 for none."""
        self._selected = view
        self.update()

    def to_widget(self, points: Array) -> list[QPointF]:
        """Points (n, 2) of the drawing plane in the widget."""
        scale = 0.48 * min(self.width(), self.height())
        middle = np.array([self.width(), self.height()]) / 2
        return [QPointF(*p) for p in points * scale + middle]

    def _redraw(self) -> None:
        self._drawn = draw_scene(self._polygons, self.observer)
        self.update()

    def view_under(self, position: QPointF) -> int:
        """The view at a place of the widget; -1 if none."""
        scale = 0.48 * min(self.width(), self.height())
        middle = np.array([self.width(), self.height()]) / 2
        return find_view_at(self._drawn, (np.array([position.x(), position.y()]) - middle) / scale)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.fillRect(self.rect(), QColor(theme.current().base))
        # What is selected shows through all that stands before it.
        for item in sorted(self._drawn, key=lambda item: item.polygon.view == self._selected >= 0):
            self._paint(painter, item)

    def _paint(self, painter: QPainter, item: DrawnPolygon) -> None:
        colours, view = theme.current(), item.polygon.view
        chosen = view >= 0 and view == self._selected
        colour = QColor(colours.muted) if view < 0 else theme.view_colour(view)
        painter.setPen(
            QPen(QColor(colours.text) if chosen else QColor(colour), 2.5 if chosen else 1)
        )
        colour.setAlpha(150 if chosen else 60 if len(self._drawn) <= _FILLED else 0)
        painter.setBrush(colour if colour.alpha() else Qt.BrushStyle.NoBrush)
        points = self.to_widget(item.points)
        painter.drawPolygon(QPolygonF(points))
        if item.polygon.kind is PolygonKind.BOARD:
            self._paint_axes(painter, points)

    def _paint_axes(self, painter: QPainter, points: list[QPointF]) -> None:
        """The board's origin, with the beginnings of its X (red) and Y axis (green)."""
        origin, along_x, _, along_y = points
        for end, colour in ((along_x, theme.current().bad), (along_y, theme.current().good)):
            painter.setPen(QPen(QColor(colour), 2))
            painter.drawLine(origin, origin + (end - origin) * 0.3)

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        self._pressed = self._last = event.position()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        if event.buttons() & Qt.MouseButton.LeftButton:
            step = event.position() - self._last
            self._last = event.position()
            self.look_from(self.observer.turned(_TURN * step.x(), _TURN * step.y()))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        pressed, self._pressed = self._pressed, None
        if pressed is None or (event.position() - pressed).manhattanLength() > 4:
            return
        view = self.view_under(event.position())
        if view >= 0:
            self.picked.emit(view)

    def wheelEvent(self, event: QWheelEvent) -> None:  # noqa: N802 - Qt's name
        self.look_from(self.observer.zoomed(1.0015 ** event.angleDelta().y()))

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 - Qt's name
        if turn := _KEYS.get(Qt.Key(event.key())):
            self.look_from(self.observer.turned(*turn))
        elif event.text() in ("+", "-"):
            self.look_from(self.observer.zoomed(1.2 if event.text() == "+" else 1 / 1.2))
        else:
            super().keyPressEvent(event)


class PosesPanel(Panel):
    """Shows where the board was held, seen from any side."""

    title = str(QT_TRANSLATE_NOOP("PosesPanel", "Poses"))

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self.centre = QComboBox()
        self.centre.addItem(self.tr("Boards around the camera"), SceneCentre.CAMERA)
        self.centre.addItem(self.tr("Cameras around the board"), SceneCentre.BOARD)
        self.centre.currentIndexChanged.connect(self._refresh_now)
        self.home = QPushButton(self.tr("&Reset view"))
        self.space = SceneView()
        self.space.setToolTip(
            self.tr("Drag to turn, wheel to zoom, click a board or camera to see its image.")
        )
        self.space.setAccessibleName(self.tr("Camera and boards in space"))
        self.space.picked.connect(self._pick)
        self.home.clicked.connect(self.space.go_home)
        self.words = QLabel()
        bar = QHBoxLayout()
        bar.addWidget(self.centre)
        bar.addStretch(1)
        bar.addWidget(self.home)
        layout = QVBoxLayout(self.body)
        layout.addLayout(bar)
        layout.addWidget(self.space, 1)
        layout.addWidget(self.words)

    def _refresh(self, result: Result) -> None:
        self.space.show_scene(build_scene(result, SceneCentre(self.centre.currentData())))
        self._attitudes = measure_attitudes(result.calibration, result.observations())
        self._names = shorten_names(result.used)

    def _select(self, k: int, corner: int) -> None:  # noqa: ARG002 - a board is drawn whole
        self.space.select(k)
        distance, tilt = self._attitudes.distance, np.rad2deg(self._attitudes.tilt)
        self.words.setText(
            self.tr("{0}: {1:.0f} mm away, tilted by {2:.0f}°").format(
                self._names[k], distance[k], tilt[k]
            )
            if k >= 0
            else self.tr(
                "{0} views, {1:.0f} to {2:.0f} mm away, tilted by {3:.0f}° to {4:.0f}°"
            ).format(len(tilt), distance.min(), distance.max(), tilt.min(), tilt.max())
        )

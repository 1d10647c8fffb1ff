"""The image, with marks over it and tools that work on it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from PySide6.QtCore import QEvent, QPoint, QPointF, QRect, QRectF, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QImage,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QResizeEvent,
    QTransform,
    QWheelEvent,
)
from PySide6.QtWidgets import QFrame, QGraphicsScene, QGraphicsView, QWidget

from calibgui.engine.arrays import Array, Size
from calibgui.gui.canvas.layers import Layer, Marks, paint_marks
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.focus_ring import FocusRing
from calibgui.gui.widgets.picture import Picture

_STEP = 1.25
"""Zoom of a wheel's notch or a key."""
_NEAREST, _FARTHEST = 64.0, 0.5
"""Largest zoom; smallest, over the one at which the image fits."""
_GRAB = 10
"""Distance at which a mark is hit, device-independent px."""


class Tool(Protocol):
    """A tool, which takes the mouse and the keys while it is chosen; positions are image px."""

    with_marks: bool
    """True if the usual marks are drawn beneath it."""

    def press(self, uv: Array, event: QMouseEvent) -> bool:
        """A button went down; whether the tool takes it."""

    def move(self, uv: Array, event: QMouseEvent) -> bool:
        """The mouse moved; whether the tool takes it."""

    def release(self, uv: Array, event: QMouseEvent) -> bool:
        """A button went up; whether the tool takes it."""

    def key(self, event: QKeyEvent) -> bool:
        """A key went down; whether the tool takes it."""

    def paint(self, painter: QPainter, canvas: Canvas) -> None:
        """Draw over everything else, in the widget's coordinates."""


class Canvas(QGraphicsView):
    """Zooms to the cursor, pans, and shows layers; a tool may take over."""

    hovered = Signal(float, float)
    """Image position under the cursor, px; NaN when it leaves."""
    picked = Signal(int)
    """Index of the corner that was clicked."""
    stepped = Signal(int)
    """The user asks for the next image (1) or the one before (-1)."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.marks = Marks()
        self.shown: set[Layer] = {Layer.CORNERS}
        self.residual_scale = 50.0
        self.tool: Tool | None = None
        self._picture = Picture()
        self._fits = True
        self._pan_from: QPoint | None = None
        self._pressed = QPoint()
        scene = QGraphicsScene(self)
        scene.addItem(self._picture)
        self.setScene(scene)
        self.setAccessibleName(self.tr("Photograph"))
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setTransformationAnchor(QGraphicsView.ViewportAnchor.NoAnchor)
        self.setResizeAnchor(QGraphicsView.ViewportAnchor.NoAnchor)
        self.setViewportUpdateMode(QGraphicsView.ViewportUpdateMode.FullViewportUpdate)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        FocusRing(self)
        self.setMinimumSize(240, 180)
        self.setBackgroundBrush(QColor(theme.current().canvas))

    # What is shown

    def show_image(self, levels: Sequence[QImage]) -> None:
        """Show an image (``picture.stretch_levels``), none if empty. Keeps the zoom if it can."""
        before = self._picture.boundingRect()
        self._picture.show_levels(levels)
        rect = self._picture.boundingRect()
        # The image can be dragged half out of the window.
        margin = max(rect.width(), rect.height())
        self.setSceneRect(rect.adjusted(-margin, -margin, margin, margin))
        if rect != before or self._fits:
            self.fit()

    def show_marks(self, marks: Marks) -> None:
        """Draw these marks over the image."""
        self.marks = marks
        self.viewport().update()

    def set_layer(self, layer: Layer, shown: bool) -> None:
        """Show or hide a layer."""
        (self.shown.add if shown else self.shown.discard)(layer)
        self.viewport().update()

    def set_residual_scale(self, scale: float) -> None:
        """Draw residuals that many times as long as they are."""
        self.residual_scale = scale
        self.viewport().update()

    def set_tool(self, tool: Tool | None) -> None:
        """Let `tool` have the mouse and the keys first; None for looking around."""
        self.tool = tool
        shape = Qt.CursorShape.ArrowCursor if tool is None else Qt.CursorShape.CrossCursor
        self.viewport().setCursor(shape)
        self.viewport().update()

    # Zoom

    @property
    def zoom(self) -> float:
        """Device-independent px per image px."""
        return self.transform().m11()

    def fit(self) -> None:
        """Show the whole image, and go on doing so when the window changes."""
        rect = self._picture.boundingRect()
        if rect.isEmpty():
            return
        scale = self._fitting_zoom()
        self.setTransform(QTransform.fromScale(scale, scale))
        self.centerOn(rect.center())
        self._fits = True

    def actual_size(self) -> None:
        """Show one image pixel on one of the screen, keeping the middle."""
        self.zoom_at(1.0 / self.devicePixelRatioF() / self.zoom, self.viewport().rect().center())

    def zoom_at(self, factor: float, at: QPoint | QPointF) -> None:
        """Magnify, keeping what is under `at` (widget coordinates) in its place."""
        lowest = min(self._fitting_zoom() * _FARTHEST, 1.0)
        scale = min(max(self.zoom * factor, lowest), _NEAREST)
        fixed = self.to_image(np.array([[at.x(), at.y()]]))[0]
        self.setTransform(QTransform.fromScale(scale, scale))
        self._look_at(fixed + (self._middle - [at.x(), at.y()]) / scale)
        self._fits = False

    def show_place(self, uv: Array) -> None:
        """Bring a point (2,) of the image into sight, if it is not."""
        at = self.to_screen(uv[None])[0]
        if not self.viewport().rect().adjusted(20, 20, -20, -20).contains(QPointF(*at).toPoint()):
            self._look_at(uv)
            self._fits = False

    @property
    def _size(self) -> Size:
        """Width and height of the image, px."""
        rect = self._picture.boundingRect()
        return round(rect.width()), round(rect.height())

    def _fitting_zoom(self) -> float:
        rect, port = self._picture.boundingRect(), self.viewport().rect()
        if rect.isEmpty():
            return 1.0
        return min(port.width() / rect.width(), port.height() / rect.height())

    @property
    def _middle(self) -> Array:
        """(2,) widget coordinates of the viewport's centre, as `centerOn` understands it."""
        return np.array([self.viewport().width(), self.viewport().height()]) / 2

    def _look_at(self, uv: Array) -> None:
        self.centerOn(QPointF(*uv))
        self.viewport().update()

    # Coordinates

    def to_screen(self, uv: Array) -> Array:
        """(n, 2) widget coordinates of (n, 2) image px."""
        t = self.viewportTransform()
        return np.asarray(uv) * [t.m11(), t.m22()] + [t.dx(), t.dy()]

    def to_image(self, at: Array) -> Array:
        """(n, 2) image px of (n, 2) widget coordinates."""
        t = self.viewportTransform()
        return (np.asarray(at) - [t.dx(), t.dy()]) / [t.m11(), t.m22()]

    def corner_near(self, at: QPointF) -> int:
        """Index of the corner within reach of widget coordinates; -1 if there is none."""
        corners = self.marks.corners
        if corners is None or len(corners) == 0:
            return -1
        distance = np.linalg.norm(self.to_screen(corners.uv) - [at.x(), at.y()], axis=1)
        nearest = int(np.argmin(distance))
        return nearest if distance[nearest] <= _GRAB else -1

    # Events

    def drawForeground(  # noqa: N802 - Qt's, as all below
        self,
        painter: QPainter,
        rect: QRectF | QRect,  # noqa: ARG002
    ) -> None:
        if self._picture.boundingRect().isEmpty():
            return  # marks mean nothing without what they mark
        painter.save()
        painter.resetTransform()
        painter.setClipRect(self.viewport().rect())
        if self.tool is None or self.tool.with_marks:
            paint_marks(painter, self.marks, self.to_screen, self.shown, self.residual_scale)
        if self.tool is not None:
            self.tool.paint(painter, self)
        painter.restore()

    def wheelEvent(self, event: QWheelEvent) -> None:  # noqa: N802
        notches = event.angleDelta().y() / 120
        if notches:
            self.zoom_at(_STEP**notches, event.position())
        event.accept()

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        self.setFocus(Qt.FocusReason.MouseFocusReason)
        if self.tool is not None and self.tool.press(self._uv(event), event):
            self.viewport().update()
            return
        if event.button() in (Qt.MouseButton.LeftButton, Qt.MouseButton.MiddleButton):
            self._pan_from = self._pressed = event.position().toPoint()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        uv = self._uv(event)
        self.hovered.emit(*uv)
        if self._pan_from is not None:
            self._pan(event.position().toPoint())
        elif self.tool is not None and self.tool.move(uv, event):
            self.viewport().update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        if self._pan_from is not None:
            moved = (event.position().toPoint() - self._pressed).manhattanLength()
            self._pan_from = None
            if event.button() is Qt.MouseButton.LeftButton and moved <= 3:
                corner = self.corner_near(event.position())
                if corner >= 0:
                    self.picked.emit(corner)
        elif self.tool is not None and self.tool.release(self._uv(event), event):
            self.viewport().update()

    def leaveEvent(self, event: QEvent) -> None:  # noqa: N802
        self.hovered.emit(np.nan, np.nan)
        super().leaveEvent(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802
        if self.tool is not None and self.tool.key(event):
            self.viewport().update()
            return
        middle = self.viewport().rect().center()
        match event.key():
            case Qt.Key.Key_Left | Qt.Key.Key_Up:
                self.stepped.emit(-1)
            case Qt.Key.Key_Right | Qt.Key.Key_Down:
                self.stepped.emit(1)
            case Qt.Key.Key_Plus | Qt.Key.Key_Equal:
                self.zoom_at(_STEP, middle)
            case Qt.Key.Key_Minus:
                self.zoom_at(1 / _STEP, middle)
            case _:
                super().keyPressEvent(event)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802
        super().resizeEvent(event)
        if self._fits:
            self.fit()

    def _pan(self, to: QPoint) -> None:
        assert self._pan_from is not None
        shift = to - self._pan_from
        if shift.isNull():
            return
        self._look_at(self.to_image(self._middle[None] - [shift.x(), shift.y()])[0])
        self._pan_from = to
        self._fits = False

    def _uv(self, event: QMouseEvent) -> Array:
        at = event.position()
        return self.to_image(np.array([[at.x(), at.y()]]))[0]

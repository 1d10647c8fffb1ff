"""Single corners moved, removed and restored by hand."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from PySide6.QtCore import QObject, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent, QPainter

from calibgui.app.photographs.marking import find_missing_corners, refine_corner
from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.features import Corners
from calibgui.gui.canvas import layers
from calibgui.gui.canvas.canvas import Canvas
from calibgui.gui.canvas.loupe import paint_loupe
from calibgui.gui.widgets import theme

_REACH = 10.0
"""Device-independent px."""


class CornerTool(QObject):
    """Drag a corner to move it (it snaps; Ctrl: it does not), Delete to remove the chosen one,
    click a hollow ring to find a missing one, Esc to leave."""

    with_marks = True
    chosen = Signal(int)
    """Index of a corner."""
    moved = Signal(int, object)
    """Index of a corner and its new place (2,) px."""
    removed = Signal(int)
    restored = Signal(object)
    """Row and column (2,) of a corner that is missing."""
    left = Signal()

    def __init__(
        self, canvas: Canvas, image: GreyImage, corners: Callable[[], Corners | None]
    ) -> None:
        super().__init__(canvas)
        self._canvas = canvas
        self._image = image
        self._corners = corners
        self._dragged = -1
        self._place: Array | None = None
        self._started: QPointF | None = None

    def press(self, uv: Array, event: QMouseEvent) -> bool:
        corners = self._corners()
        if event.button() is not Qt.MouseButton.LeftButton or corners is None:
            return False
        corner = self._canvas.corner_near(event.position())
        if corner >= 0:
            self._dragged, self._place = corner, None
            self._started = event.position()
            self.chosen.emit(corner)
            return True
        grid, at = find_missing_corners(corners)
        if len(at):
            distance = np.linalg.norm(
                self._canvas.to_screen(at) - self._canvas.to_screen(uv[None]), axis=1
            )
            nearest = int(np.argmin(distance))
            if distance[nearest] <= _REACH:
                self.restored.emit(grid[nearest])
                return True
        return False

    def move(self, uv: Array, event: QMouseEvent) -> bool:
        if self._dragged < 0 or self._started is None:
            return False
        if self._place is None and (event.position() - self._started).manhattanLength() < 4:
            return True
        self._place = uv
        if not event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            snapped = refine_corner(self._image, uv, _REACH / self._canvas.zoom)
            self._place = uv if snapped is None else snapped
        return True

    def release(self, uv: Array, event: QMouseEvent) -> bool:  # noqa: ARG002 - the tool's signature
        corner, place = self._dragged, self._place
        self._dragged, self._place = -1, None
        if corner >= 0 and place is not None:
            self.moved.emit(corner, place)
        return corner >= 0

    def key(self, event: QKeyEvent) -> bool:
        chosen = self._canvas.marks.chosen
        match event.key():
            case Qt.Key.Key_Delete | Qt.Key.Key_Backspace if chosen >= 0:
                self.removed.emit(chosen)
            case Qt.Key.Key_Escape:
                self.left.emit()
            case _:
                return False
        return True

    def paint(self, painter: QPainter, canvas: Canvas) -> None:
        corners = self._corners()
        if corners is not None:
            _, at = find_missing_corners(corners)
            layers.draw_rings(painter, canvas.to_screen(at), theme.ESTIMATE, 6)
        if self._place is not None:
            at = canvas.to_screen(self._place[None])
            layers.draw_crosses(painter, at, theme.REFINED, 9)
            port = QRectF(canvas.viewport().rect())
            paint_loupe(painter, self._image, self._place, self._place, QPointF(*at[0]), port)

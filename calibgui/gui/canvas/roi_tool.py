"""The tool that takes a board by four clicks (paper 4.1)."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QObject, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent, QPainter

from calibgui.app.photographs.marking import find_nearest_corner, project_marked_board
from calibgui.engine.arrays import Array, GreyImage, GridSize
from calibgui.engine.features import Corners
from calibgui.gui.canvas import layers
from calibgui.gui.canvas.canvas import Canvas
from calibgui.gui.canvas.loupe import paint_loupe
from calibgui.gui.widgets import theme

_REACH = 14.0
"""From the cursor to a corner that it snaps to, device-independent px."""
_GRAB = 12.0
"""From the cursor to a handle that it drags."""


class RoiTool(QObject):
    """Collects four points; between clicks a loupe shows where the next one would go.

    A click goes to the nearest corner in reach, with Ctrl held to where it is made. Handles are
    dragged, Backspace takes the last one back, Enter accepts, Esc leaves.
    """

    with_marks = False
    changed = Signal()
    """A point was added, moved or taken back."""
    accepted = Signal()
    left = Signal()

    def __init__(self, canvas: Canvas, image: GreyImage) -> None:
        super().__init__(canvas)
        self._canvas = canvas
        self._image = image
        self.points: list[Array] = []
        self.grid_size: GridSize | None = None
        """Rows and columns that the grid is drawn with."""
        self.preview: Corners | None = None
        """Corners that were found between the points."""
        self._cursor: Array | None = None
        self._board: Array | None = None
        self._dragged = -1

    @property
    def complete(self) -> bool:
        """Return whether all four points are there."""
        return len(self.points) == 4

    def press(self, uv: Array, event: QMouseEvent) -> bool:
        if event.button() is not Qt.MouseButton.LeftButton:
            return False
        self._dragged = self._handle_near(uv)
        if self._dragged < 0:
            if self.complete:
                return False
            self.points.append(self._aim(uv, event))
            self.changed.emit()
        return True

    def move(self, uv: Array, event: QMouseEvent) -> bool:
        self._cursor = uv
        self._board = self._snap(uv, event)
        if self._dragged >= 0:
            self.points[self._dragged] = self._aim(uv, event)
            self.preview = None
        return True

    def release(self, uv: Array, event: QMouseEvent) -> bool:
        if self._dragged < 0:
            return False
        self.points[self._dragged] = self._aim(uv, event)
        self._dragged = -1
        self.changed.emit()
        return True

    def key(self, event: QKeyEvent) -> bool:
        match event.key():
            case Qt.Key.Key_Backspace if self.points:
                self.points.pop()
                self.changed.emit()
            case Qt.Key.Key_Escape:
                self.left.emit()
            case Qt.Key.Key_Return | Qt.Key.Key_Enter if self.complete:
                self.accepted.emit()
            case _:
                return False
        return True

    def paint(self, painter: QPainter, canvas: Canvas) -> None:
        if self.complete:
            self._paint_grid(painter, canvas)
        elif self.points and self._cursor is not None:
            aim = self._cursor if self._board is None else self._board
            layers.draw_outline(
                painter, canvas.to_screen(np.array([*self.points, aim])), theme.REGION
            )
        if self.points:
            at = canvas.to_screen(np.array(self.points))
            layers.draw_rings(painter, at, theme.REGION, 7)
            for number, place in enumerate(at, start=1):
                layers.draw_label(painter, place, str(number), theme.REGION)
        if self._cursor is not None and (not self.complete or self._dragged >= 0):
            aim = self._cursor if self._board is None else self._board
            cursor = QPointF(*canvas.to_screen(self._cursor[None])[0])
            port = QRectF(canvas.viewport().rect())
            paint_loupe(painter, self._image, aim, self._board, cursor, port)

    def _paint_grid(self, painter: QPainter, canvas: Canvas) -> None:
        points = np.array(self.points)
        layers.draw_outline(painter, canvas.to_screen(points), theme.REGION)
        if self.preview is not None:
            layers.draw_crosses(painter, canvas.to_screen(self.preview.uv), theme.REFINED)
        elif self.grid_size is not None:
            grid = project_marked_board(points, self.grid_size)
            for line in (*grid, *grid.swapaxes(0, 1)):
                layers.draw_polyline(painter, canvas.to_screen(line), theme.REGION)

    def _handle_near(self, uv: Array) -> int:
        if not self.points:
            return -1
        at = self._canvas.to_screen(np.array(self.points))
        distance = np.linalg.norm(at - self._canvas.to_screen(uv[None]), axis=1)
        nearest = int(np.argmin(distance))
        return nearest if distance[nearest] <= _GRAB else -1

    def _aim(self, uv: Array, event: QMouseEvent) -> Array:
        board = self._snap(uv, event)
        return uv if board is None else board

    def _snap(self, uv: Array, event: QMouseEvent) -> Array | None:
        if event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            return None
        return find_nearest_corner(self._image, uv, _REACH / self._canvas.zoom)

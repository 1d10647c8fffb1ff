"""Polygons in space as numbered outlines, turned with the mouse or the arrow keys."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import islice
from typing import NamedTuple

import numpy as np
from PySide6.QtCore import QEvent, QPointF, QRect, QRectF, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QResizeEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QWidget

from calibgui.engine.arrays import Array
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.focus_ring import FocusRing
from calibgui.gui.widgets.plots import offer_picture
from calibgui.report.scene3d import (
    DrawnPolygon,
    Observer,
    Polygon,
    PolygonKind,
    draw_scene,
    find_view_at,
    fit_zoom,
    make_axes,
    project_into_scene,
)

_TURN = 0.008
"""Angle for a pixel of dragging, rad."""
_KEYS = {
    Qt.Key.Key_Left: (-0.1, 0.0),
    Qt.Key.Key_Right: (0.1, 0.0),
    Qt.Key.Key_Up: (0.0, -0.1),
    Qt.Key.Key_Down: (0.0, 0.1),
}
_SHARE = 0.44
"""Half the drawn scene in shorter sides of the widget: the rest is for numbers around it."""
_HUE = 0.65
"""Share of its view's colour that an outline has; the rest is the text's, which shows on the ground
in either scheme."""
_FADED = 0.65
"""Share of its colour that the farthest outline has; that of the nearest is 1."""
_GROUND = 170
"""Opacity of the patch behind a number, of 255: it is read over any board."""
_SMOOTHED = 200
"""Outlines up to which they are smoothed: more take longer than a frame while one turns them."""
_NUMBERED = 60
"""Nearest views that have numbers; of more than that all the numbers would hide the boards."""
_BELOW = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignBottom | Qt.TextFlag.TextWordWrap
_MARGIN = 4
"""Room around the sentence below the scene, px."""
_ONE_LINE = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextSingleLine


class AxisNumber(NamedTuple):
    """A number beside an axis."""

    place: QRectF
    """Its room in the widget."""
    text: str
    colour: QColor


class SceneView(QWidget):
    """Outlines in space, painted from the farthest to the nearest, farther ones fainter.

    The selected view is filled and stands before all others, and so does, less strongly, the one
    under the cursor. A number stands where it covers no other.
    """

    picked = Signal(int)
    """The view whose polygon was clicked."""
    hovered = Signal(int)
    """The view whose polygon is under the cursor now; -1 for none."""

    def __init__(self) -> None:
        super().__init__()
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        FocusRing(self)
        self.setMouseTracking(True)
        self.setMinimumSize(160, 120)
        # It fills all of itself: unless Qt knows, it is painted once more with what is behind it.
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.observer = Observer()
        self.axis_numbers: list[AxisNumber] = []
        """Numbers beside the axes, as they were painted last."""
        self.numbers_shown: dict[int, QRectF] = {}
        """Places of the views' numbers, as painted last."""
        self._polygons: tuple[Polygon, ...] = ()
        self._drawn: tuple[DrawnPolygon, ...] = ()
        self._numbers: Sequence[str] = ()
        self._colours: Sequence[QColor] = ()
        self._condition = ""
        self._room_below: QRect | None = None
        """Room of the sentence below the scene; None until it is measured."""
        self._selected = self._under_cursor = -1
        self._pressed: QPointF | None = None
        self._last = QPointF()
        offer_picture(self)

    def show_scene(
        self,
        polygons: tuple[Polygon, ...],
        numbers: Sequence[str],
        colours: Sequence[QColor],
        condition: str,
    ) -> None:
        """Show all of these, from the side where the observer stands.

        Args:
            polygons: boards, or cameras, in space.
            numbers: of the views.
            colours: of the views.
            condition: a sentence on what lengths rest on; empty if they are confirmed. Where there
                are no polygons it says why.
        """
        self._condition, self._room_below = condition, None
        self._polygons, self._numbers, self._colours = polygons, numbers, colours
        self._under_cursor = -1
        self.look_from(fit_zoom(polygons, self.observer))

    def go_home(self) -> None:
        """Show all from where the observer stood first."""
        self.look_from(fit_zoom(self._polygons, Observer()))

    def look_from(self, observer: Observer) -> None:
        """Move the observer."""
        self.observer = observer
        self._drawn = draw_scene(self._polygons, self.observer)
        self.update()

    def select(self, view: int) -> None:
        """Highlight a view; -1 for none."""
        self._selected = view
        self.update()

    def hover(self, view: int) -> None:
        """Highlight a view lightly, as if the cursor were over it; -1 for none."""
        if view != self._under_cursor:
            self._under_cursor = view
            self.update()

    def to_widget(self, points: Array) -> list[QPointF]:
        """Points (n, 2) of the drawing plane in the widget."""
        scale, middle = self._place_scene()
        return [QPointF(x, y) for x, y in (points * scale + middle).tolist()]

    def view_under(self, position: QPointF) -> int:
        """The view at a place of the widget; -1 if none."""
        scale, middle = self._place_scene()
        return find_view_at(self._drawn, (np.array([position.x(), position.y()]) - middle) / scale)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        painter = QPainter(self)
        # Beyond the edge: it lies within a pixel of the screen where the scale is no whole number.
        painter.fillRect(self.rect().adjusted(0, 0, 1, 1), QColor(theme.current().base))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if not self._drawn:
            painter.setPen(QColor(theme.current().muted))
            centred = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
            painter.drawText(self.rect(), int(centred), self._condition)
            return
        self.axis_numbers = self._paint_axes(painter)
        # What is pointed at shows through all that stands before it.
        placed = self._place_polygons()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, len(self._drawn) <= _SMOOTHED)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for item, corners in placed:
            if not self._rank(item.polygon.view):
                painter.setPen(self._choose_outline(item))
                painter.drawPolygon(corners)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for item, corners in sorted(placed, key=lambda pair: self._rank(pair[0].polygon.view)):
            if rank := self._rank(item.polygon.view):
                self._paint_chosen(painter, item, corners, rank)
        ground = QColor(theme.current().base)
        ground.setAlpha(_GROUND)
        for number in self.axis_numbers:  # over the boards, which stand before most of them
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(ground)
            painter.drawRoundedRect(number.place.adjusted(-2, 0, 2, 0), 3, 3)
            painter.setPen(number.colour)
            painter.drawText(number.place, _ONE_LINE, number.text)
        self._paint_numbers(painter, placed)
        painter.setPen(QColor(theme.current().muted))
        painter.drawText(self._find_room_below(), _BELOW, self._condition)

    def _find_room_below(self) -> QRect:
        """Return the room of the sentence below the scene, which has none if it is empty."""
        if self._room_below is None:
            room = self.rect().adjusted(_MARGIN, 0, -_MARGIN, 0)
            if self._condition:
                text = self.fontMetrics().boundingRect(room, _BELOW, self._condition)
                room.setTop(text.top() - _MARGIN)
            else:
                room.setTop(room.bottom() + 1)
            self._room_below = room
        return self._room_below

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        super().resizeEvent(event)
        self._room_below = None

    def changeEvent(self, event: QEvent) -> None:  # noqa: N802 - Qt's name
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self._room_below = None

    def _place_scene(self) -> tuple[float, Array]:
        """Return the scale of the drawing plane, px, and the place (2,) of its middle."""
        width, height = self.width(), self._find_room_below().top()
        return _SHARE * min(width, height), np.array([width, height]) / 2

    def _rank(self, view: int) -> int:
        """2 for the selected view, 1 for the one under the cursor, 0 for all others."""
        if view < 0:
            return 0
        return 2 if view == self._selected else int(view == self._under_cursor)

    def _place_polygons(self) -> list[tuple[DrawnPolygon, list[QPointF]]]:
        """Return what is drawn, the farthest first, with its corners in the widget."""
        places = iter(self.to_widget(np.concatenate([item.points for item in self._drawn])))
        return [(item, list(islice(places, len(item.points)))) for item in self._drawn]

    def _choose_outline(self, item: DrawnPolygon) -> QColor:
        """Choose the colour of an outline: mixed with the ground, not translucent, as those are
        drawn in a third of the time."""
        view = item.polygon.view
        colour = QColor(theme.current().muted) if view < 0 else self._colours[view]
        return mix_outline(colour, self._opacity(item.depth))

    def _paint_chosen(
        self, painter: QPainter, item: DrawnPolygon, points: Sequence[QPointF], rank: int
    ) -> None:
        """Paint what is selected or under the cursor."""
        colour = self._colours[item.polygon.view]
        inside = QColor(colour)
        inside.setAlpha((0, 70, 140)[rank])
        painter.setPen(QPen(colour, (1.0, 1.8, 2.5)[rank]))
        painter.setBrush(inside)
        painter.drawPolygon(points)
        if item.polygon.kind is PolygonKind.BOARD:
            self._paint_board_axes(painter, points)

    def _opacity(self, depth: float) -> float:
        """Opacity of an outline at a depth: the farther, the fainter."""
        far, near = self._drawn[0].depth, self._drawn[-1].depth  # the farthest is painted first
        return 1.0 - (1.0 - _FADED) * (depth - near) / max(far - near, 1e-9)

    def _paint_board_axes(self, painter: QPainter, points: Sequence[QPointF]) -> None:
        """The board's origin, with the beginnings of its X (red) and Y axis (green)."""
        origin, along_x, _, along_y = points
        for end, colour in ((along_x, theme.current().bad), (along_y, theme.current().good)):
            painter.setPen(QPen(QColor(colour), 2))
            painter.drawLine(origin, origin + (end - origin) * 0.3)

    def _paint_axes(self, painter: QPainter) -> list[AxisNumber]:
        """Paint the world's axes; return their numbers, in mm, which are painted later."""
        numbers = []
        colours = theme.current()
        axis_colours = (colours.bad, colours.good, colours.accent)
        metrics = painter.fontMetrics()
        for axis, colour in zip(make_axes(self._polygons), axis_colours, strict=True):
            points, depth = project_into_scene(self._polygons, axis.points, self.observer)
            if depth.min() <= 0:
                continue
            places = self.to_widget(points)
            painter.setPen(QPen(QColor(colour), 1.5))
            painter.drawLine(places[0], places[-1])
            last = places[0]
            for k, (place, number) in enumerate(zip(places, axis.numbers, strict=True)):
                is_end = k == len(places) - 1
                text = f"{axis.name} {number:g} mm" if is_end else f"{number:g}"
                room = (place - last).manhattanLength()
                if k == 0 or (not is_end and room < metrics.horizontalAdvance(text) + 8):
                    continue
                painter.setBrush(QColor(colour))
                painter.drawEllipse(place, 2, 2)
                box = QRectF(0, 0, metrics.horizontalAdvance(text), metrics.height())
                box.moveTopLeft(place + QPointF(4, 2))
                numbers.append(AxisNumber(self._keep_inside(box), text, QColor(colour)))
                last = place
        return numbers

    def _paint_numbers(
        self, painter: QPainter, placed: Sequence[tuple[DrawnPolygon, list[QPointF]]]
    ) -> None:
        """The views' numbers, the selected one's first, then from the nearest to the farthest.

        They leave the axes' numbers their places.
        """
        self.numbers_shown = {}
        on_axes = [number.place for number in self.axis_numbers]
        metrics = painter.fontMetrics()
        # The faces of one camera are drawn one by one: the nearest has the number.
        nearest = {
            item.polygon.view: (item, corners)
            for item, corners in placed
            if 0 <= item.polygon.view < len(self._numbers)
        }
        in_order = sorted(nearest.items(), key=lambda n: (-self._rank(n[0]), n[1][0].depth))
        for view, (item, corners) in in_order[:_NUMBERED]:
            text = self._numbers[view]
            box = QRectF(0, 0, metrics.horizontalAdvance(text) + 6, metrics.height())
            place = self._find_room(box, corners, [*on_axes, *self.numbers_shown.values()])
            if place is None and self._rank(view):
                place = self._keep_inside(box)  # it has a number even if it covers another
            if place is not None:
                self.numbers_shown[view] = place
                self._paint_number(painter, place, text, item)

    def _find_room(
        self, box: QRectF, corners: Sequence[QPointF], taken: Sequence[QRectF]
    ) -> QRectF | None:
        """Return the box at a place on the polygon that no number has taken; None if there is none.

        The box itself is moved to the last place tried.
        """
        middle = sum(corners, QPointF()) / len(corners)
        for corner in corners:
            box.moveCenter(corner + (middle - corner) * 0.15)
            inside = self._keep_inside(box)
            if not any(inside.intersects(other) for other in taken):
                return inside
        return None

    def _paint_number(self, painter: QPainter, box: QRectF, text: str, item: DrawnPolygon) -> None:
        colours, rank = theme.current(), self._rank(item.polygon.view)
        ground = QColor(colours.accent if rank == 2 else colours.base)
        ink = QColor(colours.on_accent if rank == 2 else colours.text)
        if not rank:
            ground.setAlpha(_GROUND)
            ink.setAlphaF(max(self._opacity(item.depth), 0.6))
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(ground)
        painter.drawRoundedRect(box, 3, 3)
        painter.setPen(ink)
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)

    def _keep_inside(self, box: QRectF) -> QRectF:
        """Return the box moved as little as it takes to lie in the widget, above the sentence."""
        bottom = self._find_room_below().top()
        x = min(max(box.x(), 0.0), max(self.width() - box.width(), 0.0))
        y = min(max(box.y(), 0.0), max(bottom - box.height(), 0.0))
        return QRectF(x, y, box.width(), box.height())

    def _point_at(self, view: int) -> None:
        if view != self._under_cursor:
            self.hover(view)
            self.hovered.emit(view)

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        self._pressed = self._last = event.position()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        if event.buttons() & Qt.MouseButton.LeftButton:
            step = event.position() - self._last
            self._last = event.position()
            self.look_from(self.observer.turned(_TURN * step.x(), _TURN * step.y()))
        else:
            self._point_at(self.view_under(event.position()))

    def leaveEvent(self, event: QEvent) -> None:  # noqa: N802 - Qt's name
        super().leaveEvent(event)
        self._point_at(-1)

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


def mix_outline(colour: QColor, opacity: float) -> QColor:
    """Return the colour of an outline of a view's colour that shows on the ground."""
    colours = theme.current()
    return _mix_outline(colour.rgb(), colours.text, colours.base, round(opacity, 2))


@lru_cache(maxsize=10_000)
def _mix_outline(colour: int, text: str, base: str, opacity: float) -> QColor:
    """Return the colour of `mix_outline`; kept, as hundreds are painted at each turn."""
    return _mix(_mix(QColor(colour), text, _HUE), base, opacity)


def _mix(colour: QColor, ground: str, share: float) -> QColor:
    """Return a colour of which `share` is `colour` and the rest is that of the ground."""
    under, rest = QColor(ground), 1 - share
    return QColor.fromRgbF(
        share * colour.redF() + rest * under.redF(),
        share * colour.greenF() + rest * under.greenF(),
        share * colour.blueF() + rest * under.blueF(),
    )

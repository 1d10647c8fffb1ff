"""The marks that are drawn over an image, in the paper's colours (figure 6).

All marks have a dark halo, so that they show on bright squares as on dark ones, and keep their
size on the screen at any zoom.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen, QPolygonF

from calibgui.engine.arrays import Array
from calibgui.engine.features import Corners
from calibgui.gui.widgets import theme

ToScreen = Callable[[Array], Array]
"""From (n, 2) px of the image to (n, 2) device-independent px of the widget."""

_ARM = 6.0
"""Half the length of a cross, if corners are far enough apart."""
_ROOM = 0.22
"""Share of the distance between corners that a mark may take to each side."""
_RING = 3.5
"""Radius of a corner's ring, if corners are far enough apart."""
_LINE = 1.4
"""Width of a line; its halo is 1 wider on each side."""
_HEAD = 5.0
"""Length of an arrow's head."""


class Layer(StrEnum):
    """The kinds of marks of one view, each of which can be shown or hidden."""

    REGION = "region"
    ESTIMATES = "estimates"
    CORNERS = "corners"
    ORDER = "order"
    REPROJECTION = "reprojection"
    RESIDUALS = "residuals"


@dataclass(frozen=True, eq=False, slots=True)
class Marks:
    """The marks of one view."""

    corners: Corners | None = None
    region: Array | None = None
    """(4, 2) px"""
    measured: Array | None = None
    """(n, 2) px, corners of the calibration."""
    predicted: Array | None = None
    """(n, 2) px, where the calibration expects them."""
    chosen: int = -1
    """Index of the corner to point out, -1 for none."""


def paint_marks(
    painter: QPainter,
    marks: Marks,
    to_screen: ToScreen,
    shown: Collection[Layer],
    residual_scale: float,
) -> None:
    """Draw the `shown` layers of `marks` on a painter in the widget's coordinates."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)

    if Layer.REGION in shown and marks.region is not None:
        draw_outline(painter, to_screen(marks.region), theme.REGION)
    corners = marks.corners
    if corners is not None:
        uv = to_screen(corners.uv)
        arm = choose_arm_length(uv)
        if Layer.ORDER in shown:
            _draw_order(painter, corners, uv)
        if Layer.ESTIMATES in shown:
            draw_crosses(painter, to_screen(corners.estimate), theme.ESTIMATE, arm)
        if Layer.CORNERS in shown:
            _draw_grid(painter, corners, uv, arm)
    if marks.predicted is not None and marks.measured is not None:
        at, measured = to_screen(marks.predicted), to_screen(marks.measured)
        if Layer.REPROJECTION in shown:
            draw_rings(painter, at, theme.REPROJECTED, choose_arm_length(at))
        if Layer.RESIDUALS in shown:
            draw_arrows(painter, at, at + residual_scale * (measured - at), theme.RESIDUAL)
    if corners is not None and 0 <= marks.chosen < len(corners):
        draw_rings(
            painter, to_screen(corners.uv[marks.chosen : marks.chosen + 1]), theme.REFINED, 12
        )


def choose_arm_length(at: Array) -> float:
    """Half the size of marks at (n, 2) screen positions that leaves room between them."""
    if len(at) < 2:
        return _ARM
    step = np.median(np.linalg.norm(np.diff(at, axis=0), axis=1))
    return float(np.clip(_ROOM * step, 1.5, _ARM))


def draw_crosses(painter: QPainter, at: Array, colour: QColor, arm: float = _ARM) -> None:
    """A + at each of (n, 2) screen positions."""
    lines = [QLineF(u - arm, v, u + arm, v) for u, v in at]
    lines += [QLineF(u, v - arm, u, v + arm) for u, v in at]
    _draw_lines(painter, lines, colour)


def draw_rings(painter: QPainter, at: Array, colour: QColor, radius: float = 4.0) -> None:
    """A circle around each of (n, 2) screen positions."""
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for pen in _make_pens(colour):
        painter.setPen(pen)
        for u, v in at:
            painter.drawEllipse(QPointF(u, v), radius, radius)


def draw_arrows(painter: QPainter, start: Array, end: Array, colour: QColor) -> None:
    """Arrows between (n, 2) screen positions; the head shrinks with a short shaft."""
    shaft = end - start
    length = np.linalg.norm(shaft, axis=1, keepdims=True)
    along = shaft / np.maximum(length, 1e-9)
    across = along[:, ::-1] * [1.0, -1.0]
    head = np.minimum(_HEAD, 0.4 * length)
    lines = []
    for a, b, left, right in zip(
        start,
        end,
        end - head * (along + 0.5 * across),
        end - head * (along - 0.5 * across),
        strict=True,
    ):
        lines += [QLineF(*a, *b), QLineF(*b, *left), QLineF(*b, *right)]
    _draw_lines(painter, lines, colour)


def trace_hull(uv: Array) -> Array:
    """Return the corners of the convex hull (m, 2) of points (n, 2), in their order around it.

    Andrew's monotone chain: points on one line, or fewer than three, have a hull as well.
    """
    points = sorted(map(tuple, uv.tolist()))

    def trace_half(points: Iterable[tuple[float, float]]) -> list[tuple[float, float]]:
        half: list[tuple[float, float]] = []
        for u, v in points:
            while len(half) > 1:
                (u0, v0), (u1, v1) = half[-2:]
                if (u1 - u0) * (v - v0) > (v1 - v0) * (u - u0):
                    break
                half.pop()
            half.append((u, v))
        return half[:-1]

    return np.array([*trace_half(points), *trace_half(reversed(points))]).reshape(-1, 2)


def draw_outline(painter: QPainter, at: Array, colour: QColor, width: float = _LINE) -> None:
    """A closed line through (n, 2) screen positions."""
    polygon = QPolygonF([QPointF(u, v) for u, v in at])
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for pen in _make_pens(colour, width):
        painter.setPen(pen)
        painter.drawPolygon(polygon)


def draw_polyline(painter: QPainter, at: Array, colour: QColor) -> None:
    """An open line through (n, 2) screen positions."""
    _draw_lines(painter, [QLineF(*a, *b) for a, b in pairwise(at)], colour)


def draw_label(painter: QPainter, at: Array, text: str, colour: QColor) -> None:
    """Text beside a screen position (2,), on a dark patch."""
    _write(painter, _place_label(painter, at, text), text, colour)


def _place_label(painter: QPainter, at: Array, text: str) -> QRectF:
    """Return the box of a text beside a screen position (2,): whole, if the position is in sight.

    In sight is what the painter's clip leaves: its viewport may be that of the whole window.
    """
    box = QRectF(painter.fontMetrics().boundingRect(text)).adjusted(-3, -1, 3, 1)
    box.moveTopLeft(QPointF(at[0] + 8, at[1] + 4))
    room = painter.clipBoundingRect()
    if room.contains(QPointF(*at)):
        box.moveRight(min(box.right(), room.right()))
        box.moveBottom(min(box.bottom(), room.bottom()))
    return box


def _write(painter: QPainter, box: QRectF, text: str, colour: QColor) -> None:
    """Text in a box, on a dark patch."""
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(theme.HALO)
    painter.drawRoundedRect(box, 3, 3)
    painter.setPen(colour)
    painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)


def _draw_grid(painter: QPainter, corners: Corners, uv: Array, radius: float) -> None:
    """The corners as rings, with lines along the rows and columns of the board."""
    lines = []
    for fixed, along in ((0, 1), (1, 0)):
        order = np.lexsort((corners.grid[:, along], corners.grid[:, fixed]))
        grid, path = corners.grid[order], uv[order]
        step = np.diff(grid, axis=0)
        next_to = (step[:, fixed] == 0) & (step[:, along] == 1)
        lines += [
            QLineF(*a, *b) for a, b in zip(path[:-1][next_to], path[1:][next_to], strict=True)
        ]
    _draw_lines(painter, lines, theme.REFINED)
    draw_rings(painter, uv, theme.REFINED, min(radius, _RING))


def _draw_order(painter: QPainter, corners: Corners, uv: Array) -> None:
    """The corners in the order of their numbers, the origin and the two axes."""
    order = np.lexsort((corners.grid[:, 1], corners.grid[:, 0]))
    path, rows = uv[order], corners.grid[order, 0]
    lines = [
        QLineF(*a, *b)
        for a, b, same in zip(path[:-1], path[1:], rows[1:] == rows[:-1], strict=True)
        if same
    ]
    _draw_lines(painter, lines, theme.PATH)
    place = {(int(m), int(n)): k for k, (m, n) in enumerate(corners.grid)}
    first = place.get((0, 0))
    if first is None:
        return
    draw_rings(painter, uv[first : first + 1], theme.PATH, 7)
    draw_label(painter, uv[first], "0, 0", theme.PATH)
    for step, name in (((0, 1), "X"), ((1, 0), "Y")):
        ends = [place.get((2 * step[0], 2 * step[1])), place.get(step)]
        end = next((k for k in ends if k is not None), None)
        if end is not None:
            draw_arrows(painter, uv[first : first + 1], uv[end : end + 1], theme.PATH)
            draw_label(painter, uv[end], name, theme.PATH)


def _draw_lines(painter: QPainter, lines: list[QLineF], colour: QColor) -> None:
    for pen in _make_pens(colour):
        painter.setPen(pen)
        painter.drawLines(lines)


def _make_pens(colour: QColor, width: float = _LINE) -> tuple[QPen, QPen]:
    """The halo's pen, then the mark's."""
    return QPen(theme.HALO, width + 2.0), QPen(colour, width)

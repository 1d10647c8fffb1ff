"""The loupe shows the image's own grey levels, magnified about the point."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QColor, QImage, QPainter

from calibgui.gui.canvas.loupe import paint_loupe
from calibgui.gui.widgets import theme

PORT = QRectF(0, 0, 400, 300)


def drawn(cursor: QPointF, mark: np.ndarray | None = None) -> QImage:
    image = np.zeros((40, 40), np.uint8)
    image[:, 20:] = 200
    picture = QImage(400, 300, QImage.Format.Format_RGB32)
    picture.fill(QColor("green"))
    painter = QPainter(picture)
    painter.setBrush(theme.HALO)  # whatever was drawn before must not fill the circle
    paint_loupe(painter, image, np.array([19.5, 20.0]), mark, cursor, PORT)
    painter.end()
    return picture


@pytest.mark.usefixtures("qapp")
def test_levels_are_those_of_the_image() -> None:
    picture = drawn(QPointF(100, 200))
    middle = QPointF(184, 116)
    assert picture.pixelColor(int(middle.x()) + 30, int(middle.y()) + 20).lightness() == 200
    assert picture.pixelColor(int(middle.x()) - 30, int(middle.y()) + 20).lightness() == 0
    # The edge lies exactly in the middle, at u = 19.5.
    row = [
        picture.pixelColor(int(middle.x()) + dx, int(middle.y()) + 20).lightness() for dx in (-2, 1)
    ]
    assert row == [0, 200]


@pytest.mark.usefixtures("qapp")
@pytest.mark.parametrize("cursor", [(10, 10), (390, 10), (390, 290), (10, 290)])
def test_it_stays_in_sight(cursor: tuple[int, int]) -> None:
    picture = drawn(QPointF(*cursor))
    changed = [
        (x, y)
        for x in range(0, 400, 4)
        for y in range(0, 300, 4)
        if picture.pixelColor(x, y) != QColor("green")
    ]
    width, height = np.ptp(np.array(changed), axis=0)
    assert min(width, height) >= 112


@pytest.mark.usefixtures("qapp")
def test_the_snapped_corner_is_marked_where_it_is() -> None:
    picture = drawn(QPointF(100, 200), mark=np.array([21.5, 20.0]))
    colour = picture.pixelColor(184 + 16, 116)
    assert colour.red() > 200
    assert colour.blue() < 120

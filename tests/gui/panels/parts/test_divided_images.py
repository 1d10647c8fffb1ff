"""Both images are magnified and moved alike; the divider stays within reach."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from calibgui.gui.panels.parts.divided_images import DividedImages
from tests.gui.panels.conftest import drag

LEFT, NONE = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier


@pytest.fixture
def images(qtbot: QtBot) -> DividedImages:
    """A dark image 400 x 300 before, one that grows lighter to the right after."""
    shown = DividedImages("before", "after")
    qtbot.addWidget(shown)
    shown.resize(400, 300)
    ramp = np.tile(np.linspace(50, 250, 400).astype(np.uint8), (300, 1))
    shown.show_images(np.full((300, 400), 10, np.uint8), ramp)
    shown.show()
    return shown


def wheel(widget: DividedImages, at: QPointF, notches: int) -> None:
    event = QWheelEvent(
        at,
        QPointF(widget.mapToGlobal(at)),
        QPoint(),
        QPoint(0, 120 * notches),
        Qt.MouseButton.NoButton,
        NONE,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(widget, event)


def pixel_under(images: DividedImages, at: QPointF) -> tuple[float, float]:
    frame = images.frame
    return (at.x() - frame.left()) / frame.width(), (at.y() - frame.top()) / frame.height()


def test_the_wheel_keeps_what_is_under_the_cursor(images: DividedImages) -> None:
    at = QPointF(310, 80)
    before = pixel_under(images, at)
    wheel(images, at, 4)
    assert images.frame.width() == pytest.approx(400 * 1.25**4)
    assert pixel_under(images, at) == pytest.approx(before)
    wheel(images, at, 100)
    assert images.frame.width() == pytest.approx(16 * 400), "one pixel is 16 at most"
    wheel(images, at, -200)
    assert images.frame.topLeft() == QPointF(0, 0) and images.frame.width() == 400


def test_magnified_images_are_dragged_within_their_bounds(
    images: DividedImages, qtbot: QtBot
) -> None:
    wheel(images, QPointF(200, 150), 3)
    left = images.frame.left()
    drag(qtbot, images, QPoint(300, 100), QPoint(260, 100))
    assert images.frame.left() == pytest.approx(left - 40, abs=1)
    assert images.divider == 0.5
    drag(qtbot, images, QPoint(390, 100), QPoint(10, 100))
    assert images.frame.right() == pytest.approx(400), "no more is shown than there is"


def test_the_divider_is_dragged_when_magnified_as_well(images: DividedImages, qtbot: QtBot) -> None:
    wheel(images, QPointF(200, 150), 3)
    frame = images.frame
    drag(qtbot, images, QPoint(200, 100), QPoint(100, 100))
    assert images.divider == pytest.approx(0.25)
    assert images.frame == frame
    picture = images.grab().toImage()
    assert picture.pixelColor(60, 100).lightness() == 10
    assert picture.pixelColor(150, 100).lightness() > 60


def test_keys_and_a_double_click(images: DividedImages, qtbot: QtBot) -> None:
    qtbot.keyClick(images, Qt.Key.Key_Plus)
    assert images.frame.width() == pytest.approx(500)
    qtbot.keyClick(images, Qt.Key.Key_Minus)
    assert images.frame.width() == pytest.approx(400)
    for away in (
        lambda: qtbot.keyClick(images, Qt.Key.Key_0),
        lambda: qtbot.mouseDClick(images, LEFT, NONE, QPoint(300, 50)),
    ):
        wheel(images, QPointF(10, 10), 5)
        away()
        assert images.frame.width() == 400
    qtbot.keyClick(images, Qt.Key.Key_Left)
    assert images.divider == pytest.approx(0.45)


def test_the_next_image_of_the_same_size_is_seen_at_the_same_place(images: DividedImages) -> None:
    wheel(images, QPointF(10, 10), 5)
    frame = images.frame
    images.show_images(None, np.zeros((300, 400), np.uint8))
    assert images.frame == frame
    images.show_images(None, np.zeros((200, 400), np.uint8))
    assert images.frame.width() == 400

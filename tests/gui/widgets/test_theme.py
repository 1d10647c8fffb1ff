"""One colour is one view, and views beyond the eighth have colours of their own."""

from __future__ import annotations

from itertools import combinations
from types import SimpleNamespace

import cv2
import numpy as np
import pytest
import shiboken6
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QGuiApplication, QImage, QPainter
from PySide6.QtWidgets import (
    QApplication,
    QCheckBox,
    QLineEdit,
    QMenu,
    QRadioButton,
    QSpinBox,
    QWidget,
)
from pytestqt.qtbot import QtBot

from calibgui.engine.arrays import Array
from calibgui.gui.widgets import theme


def to_lab(views: int) -> Array:
    """(n, 3) CIELAB of the colours of the first views."""
    colours = [theme.view_colour(k) for k in range(views)]
    rgb = np.array([[c.redF(), c.greenF(), c.blueF()] for c in colours], dtype=np.float32)
    return np.asarray(cv2.cvtColor(rgb[None], cv2.COLOR_RGB2LAB)[0])


def test_the_colours_of_views_are_told_apart() -> None:
    lab = to_lab(64)
    distance = {(a, b): np.linalg.norm(lab[a] - lab[b]) for a, b in combinations(range(64), 2)}
    assert min(distance.values()) > 5, "one just notices 2.3 side by side"
    next_to = [distance[k, k + 1] for k in range(63)]
    assert min(next_to) > 25


def test_a_colour_that_is_changed_changes_no_other() -> None:
    theme.view_colour(9).setAlpha(10)
    assert theme.view_colour(9).alpha() == 255


def test_every_colour_shows_on_light_and_on_dark() -> None:
    lightness = to_lab(64)[:, 0]
    assert lightness.min() > 25 and lightness.max() < 86


@pytest.mark.parametrize("scheme", [theme.Scheme.LIGHT, theme.Scheme.DARK])
@pytest.mark.parametrize("kind", [QCheckBox, QRadioButton, QMenu, QLineEdit, QSpinBox])
def test_the_borders_of_boxes_fields_and_menus_are_seen(
    qtbot: QtBot, qapp: QApplication, kind: type[QWidget], scheme: theme.Scheme
) -> None:
    """An empty box is a border only: WCAG asks for a contrast of 3."""
    try:
        theme.apply(qapp, scheme)
        widget = kind()
        qtbot.addWidget(widget)
        if isinstance(widget, QMenu):
            widget.addAction("").setCheckable(True)
        widget.resize(widget.sizeHint())
        around = luminance(QColor(theme.current().window))
        contrasts = [
            (max(around, seen) + 0.05) / (min(around, seen) + 0.05)
            for seen in map(luminance, list_colours(widget.grab().toImage()))
        ]
        assert max(contrasts) >= 3
    finally:
        theme.apply(qapp, theme.Scheme.LIGHT)


def list_colours(image: QImage) -> list[QColor]:
    return [image.pixelColor(x, image.height() // 2) for x in range(image.width() // 2)]


def luminance(colour: QColor) -> float:
    """Relative luminance of WCAG 2."""
    parts = np.array([colour.redF(), colour.greenF(), colour.blueF()])
    linear = np.where(parts <= 0.03928, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    return float(linear @ (0.2126, 0.7152, 0.0722))


@pytest.mark.usefixtures("qapp")
def test_lines_of_plots_are_as_wide_on_a_fine_screen(monkeypatch: pytest.MonkeyPatch) -> None:
    for ratio in (1.0, 1.5, 2.0):
        screen = SimpleNamespace(devicePixelRatio=lambda ratio=ratio: ratio)
        monkeypatch.setattr(QGuiApplication, "screens", lambda screen=screen: [screen])
        image = QImage(60, 60, QImage.Format.Format_RGB32)
        image.setDevicePixelRatio(ratio)
        image.fill(Qt.GlobalColor.black)
        painter = QPainter(image)
        painter.scale(3, 3)  # as a plot that is zoomed
        painter.setPen(theme.make_pen("#ffffff", width=2))
        painter.drawLine(0, 5, 60, 5)
        painter.end()
        lit = sum(image.pixelColor(30, y).lightnessF() for y in range(60))
        assert lit == pytest.approx(2 * ratio, abs=0.6)


class Follower(QWidget):
    """Notes the ground at each change."""

    def __init__(self) -> None:
        super().__init__()
        self.grounds: list[str] = []
        theme.follow(self.note)

    def note(self) -> None:
        self.grounds.append(theme.current().base)


def test_what_follows_the_colours_is_told_as_long_as_it_exists(qapp: QApplication) -> None:
    follower = Follower()
    try:
        theme.apply(qapp, theme.Scheme.DARK)
        assert follower.grounds == [theme.DARK.base]
        shiboken6.delete(follower)
    finally:
        theme.apply(qapp, theme.Scheme.LIGHT)
    assert follower.grounds == [theme.DARK.base]
    with pytest.raises(TypeError, match="method"):
        theme.follow(lambda: None)

"""Clouds of points: each where it belongs, in the colour of its group."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QColor, QImage, QPainter
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from calibgui.engine.arrays import Array
from calibgui.gui.widgets.plots import Plot
from calibgui.gui.widgets.point_cloud import PointCloud

RED, BLUE = QColor("#d02020"), QColor("#2020d0")


@pytest.fixture
def plot(qtbot: QtBot) -> Iterator[Plot]:
    holder = QWidget()
    plot = Plot("x", "y", parent=holder)
    plot.area.show_grid(False)
    for widget in (holder, plot):
        widget.resize(400, 300)
    holder.show()
    qtbot.waitExposed(holder)
    yield plot  # the holder must outlive it


def picture(plot: Plot, ratio: int = 1) -> QImage:
    image = QImage(plot.size() * ratio, QImage.Format.Format_RGB32)
    image.setDevicePixelRatio(ratio)
    painter = QPainter(image)
    plot.render(painter, QRectF(plot.rect()), plot.rect())
    painter.end()
    return image


def colour_at(plot: Plot, point: Array, ratio: int = 1) -> QColor:
    scene = plot.box.mapViewToScene(QPointF(*point))
    return picture(plot, ratio).pixelColor((scene * ratio).toPoint())


@pytest.mark.parametrize("ratio", [1, 2])
def test_every_point_has_the_colour_of_its_group(plot: Plot, ratio: int) -> None:
    rng = np.random.default_rng(0)
    cloud = PointCloud(size=9)
    plot.addItem(cloud)
    # More groups than there are symbols side by side on the sheet.
    points = [np.array([[k % 20, k // 20]], dtype=float) for k in range(300)]
    order = rng.permutation(300)
    cloud.show_points(points, [(RED if k < 150 else BLUE, "osd"[k % 3]) for k in order])
    plot.box.autoRange()
    for k in (0, 17, 255, 256, 299):
        assert colour_at(plot, points[k][0], ratio) == (RED if order[k] < 150 else BLUE), k
    assert colour_at(plot, np.array([3.5, 3.5]), ratio) not in (RED, BLUE)
    assert len(cloud._styles) == 6, "each is drawn once, whatever the number of groups"


def test_the_point_at_a_place_is_found_with_its_group(plot: Plot) -> None:
    cloud = PointCloud(size=4)
    plot.addItem(cloud)
    groups = [np.array([[0.0, 0], [1, 1]]), np.zeros((0, 2)), np.array([[np.nan, 0], [2, 0.5]])]
    cloud.show_points(groups, [(RED, "o")] * 3)
    plot.box.autoRange()
    for x, y, found in ((1.0, 1.0, (0, 1)), (2.0, 0.5, (2, 1)), (1.0, 0.2, None)):
        assert cloud.find_point(plot.box.mapViewToScene(QPointF(x, y))) == found
    cloud.show_points([], [])
    assert cloud.find_point(plot.box.mapViewToScene(QPointF(1, 1))) is None


def test_the_view_encloses_the_points_that_are_known(plot: Plot) -> None:
    cloud = PointCloud(size=4)
    plot.addItem(cloud)
    cloud.show_points(
        [np.array([[-3.0, 2.0], [np.nan, 50.0]]), np.array([[7.0, -5.0]])], [(RED, "o")] * 2
    )
    np.testing.assert_array_equal(np.transpose(cloud.getData()), [[-3, 2], [7, -5]])
    plot.box.autoRange()
    seen = plot.box.viewRect()
    assert seen.contains(QPointF(-3, 2))
    assert seen.contains(QPointF(7, -5))
    assert seen.height() < 20
    cloud.show_points([], [])
    assert cloud.boundingRect().isEmpty()
    picture(plot)  # nothing to draw

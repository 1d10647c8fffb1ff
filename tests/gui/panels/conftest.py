"""A result without images, and a hand that clicks on plots."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable
from typing import TypeVar

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QApplication, QWidget
from pytestqt.qtbot import QtBot

from calibgui import engine
from calibgui.dataset import Result, View, ViewStatus
from calibgui.engine.arrays import Array
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.features.corners import Corners
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.images.reading import Image
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.services import Services
from calibgui.gui.widgets.plots import Plot
from calibgui.gui.widgets.tables import Table
from tests.engine import scenes

P = TypeVar("P", bound=Panel)


def made(
    seed: int = 4, count: int = 9, noise: float = 0.1, bow: float = 0.0, **settings: object
) -> Result:
    """A calibration of synthetic corners; the second image has no board.

    The board's middle is `bow` mm nearer to the camera than its corners.
    """
    grid_size = scenes.BOARD
    scene = scenes.scene(scenes.barrel(), count, seed)
    rng = np.random.default_rng(seed)
    grid = np.indices((grid_size.rows, grid_size.cols)).reshape(2, -1).T
    views = []
    for k, pose in enumerate(scene.poses):
        uv = bowed(scene.camera, pose, bow) + rng.normal(scale=noise, size=(len(grid), 2))
        corners = Corners((9, 12), grid, uv, uv)
        views.append(View(f"view{k + 1}.png", ViewStatus.FOUND, corners=corners))
    views.insert(1, View("blank.png", ViewStatus.NO_BOARD, "No checkerboard was found."))
    observations = [view.observation(grid_size) for view in views if view.usable]
    calibration = engine.calibrate(observations, scene.size, **settings)  # type: ignore[arg-type]
    return Result(calibration, tuple(views), grid_size)


def bowed(camera: Camera, pose: Pose, bow: float) -> Array:
    """(n, 2) what the camera sees of the board with its middle raised by `bow` mm."""
    xy = scenes.BOARD.points()
    across = 2 * (xy - (xy.min(axis=0) + xy.max(axis=0)) / 2) / np.ptp(xy, axis=0)
    solid = np.column_stack([xy, -bow * (1 - across**2).sum(axis=1) / 2])
    point = solid @ rotation_from_vector(pose.rvec).T + pose.tvec
    return pixels_from_rays(point, camera)


@pytest.fixture(scope="session")
def result() -> Result:
    return made()


@pytest.fixture(scope="session")
def other() -> Result:
    """The same camera from other views."""
    return made(seed=7)


def read_nothing(path: str) -> Image:
    """Stand in for reading an image, for panels that read none."""
    raise AssertionError(f"{path} is read")


@pytest.fixture
def services(jobs: Jobs) -> Services:
    """What the window lends to its panels, without images."""
    return Services(jobs, read_nothing)


Shown = Callable[[type[P], Result | None], P]


@pytest.fixture
def shown(qtbot: QtBot, services: Services) -> Shown[P]:
    """Makes a panel, gives it a result and brings it on screen."""

    def show(kind: type[P], result: Result | None) -> P:
        panel = kind(services)
        qtbot.addWidget(panel)
        panel.resize(900, 650)
        panel.show_result(result)
        panel.show()
        qtbot.waitExposed(panel)
        QApplication.processEvents()
        return panel

    return show


def click(qtbot: QtBot, plot: Plot, x: float, y: float) -> None:
    """A left click at a plot's coordinates."""
    QApplication.processEvents()
    qtbot.mouseClick(plot.viewport(), Qt.MouseButton.LeftButton, pos=place(plot, x, y))


def read_table(table: Table) -> list[dict[str, str]]:
    """The rows of a table by the titles of its columns, hidden ones included."""
    return list(csv.DictReader(io.StringIO(table.as_csv())))


def click_row(qtbot: QtBot, table: Table, row: int) -> None:
    """A left click on the first cell of a row."""
    index = table.model().index(row, 0)
    table.scrollTo(index)
    qtbot.mouseClick(
        table.viewport(), Qt.MouseButton.LeftButton, pos=table.visualRect(index).center()
    )


def place(plot: Plot, x: float, y: float) -> QPoint:
    """The pixel of a plot's viewport at the plot's coordinates."""
    scene = plot.box.mapViewToScene(QPointF(x, y))
    return plot.mapFromScene(scene)


def drag(qtbot: QtBot, widget: QWidget, start: QPoint, end: QPoint) -> None:
    """The left button pressed at `start`, moved to `end` in steps, and let go."""
    left, none = Qt.MouseButton.LeftButton, Qt.MouseButton.NoButton
    kind = QMouseEvent.Type

    def send(
        what: QMouseEvent.Type, at: QPoint, button: Qt.MouseButton, held: Qt.MouseButton
    ) -> None:
        where = QPointF(at), QPointF(widget.mapToGlobal(at))
        event = QMouseEvent(what, *where, button, held, Qt.KeyboardModifier.NoModifier)
        QApplication.sendEvent(widget, event)
        qtbot.wait(12)  # plots look at a hundred positions a second at most

    send(kind.MouseMove, start, none, none)
    send(kind.MouseButtonPress, start, left, left)
    for share in (0.1, 0.4, 0.7, 1.0, 1.0):
        send(kind.MouseMove, start + (end - start) * share, none, left)
    send(kind.MouseButtonRelease, end, left, none)

"""What is shown and asked to be saved is what the engine makes of the image."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QImage
from pytestqt.qtbot import QtBot

from calibgui.app.outputs.previews import unfold_cube
from calibgui.app.outputs.resampling import Undistortion
from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images.projections import Projection
from calibgui.engine.images.reading import Image
from calibgui.engine.images.rectification import rectify_image
from calibgui.engine.images.undistortion import (
    choose_ideal_cameras,
    make_ideal_image,
    undistort_image,
)
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.panels.answer.undistort import RECTIFIED, STATED_ANGLE, UndistortPanel
from calibgui.gui.panels.services import Services
from calibgui.report.coverage import find_shown_extent, measure_natural_scale
from tests.gui.panels.conftest import drag

Read = Callable[[str], Image]


def photograph(path: str) -> Image:
    """Smooth noise that differs from one name to the next."""
    rng = np.random.default_rng(len(path) + sum(map(ord, path)))
    coarse = rng.integers(0, 255, (24, 32)).astype(np.uint8)
    return Image(np.kron(coarse, np.ones((20, 20), np.uint8)), Path(path))


@pytest.fixture
def panel(jobs: Jobs, qtbot: QtBot, result: Result) -> UndistortPanel:
    made = UndistortPanel(Services(jobs, photograph))
    qtbot.addWidget(made)
    made.resize(700, 600)
    made.show_result(result)
    made.show()
    qtbot.waitUntil(lambda: not jobs.running)
    return made


def shown(panel: UndistortPanel) -> list[Array]:
    """The images' pixels."""
    return [_pixels(image) for image in panel.images._images]


def _pixels(image: QImage) -> Array:
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), -1)
    return rows[:, : image.width()]


def test_the_original_beside_the_undistorted(panel: UndistortPanel, result: Result) -> None:
    before, after = shown(panel)
    grey = photograph("view1.png").grey
    np.testing.assert_array_equal(before, grey)
    np.testing.assert_array_equal(after, undistort_image(grey, result.calibration.camera).image)
    assert panel.words.text() == "view1.png: 640 × 480 px"
    assert panel.lost.text().endswith("everything that the lens sees is shown.")
    assert not panel.angle.isEnabled()


@pytest.mark.parametrize(("index", "view"), [(1, "no-border"), (2, "same-scale")])
def test_field_of_view(
    panel: UndistortPanel, result: Result, jobs: Jobs, qtbot: QtBot, index: int, view: str
) -> None:
    panel.view.setFocus()
    for _ in range(index):
        qtbot.keyClick(panel.view, Qt.Key.Key_Down)
    qtbot.waitUntil(lambda: not jobs.running)
    grey = photograph("view1.png").grey
    expected = undistort_image(grey, result.calibration.camera, view).image
    np.testing.assert_array_equal(shown(panel)[1], expected)


@pytest.mark.parametrize("projection", ["cylindrical", "equirectangular", "stereographic"])
def test_a_stated_field_of_view_in_every_projection(
    panel: UndistortPanel, result: Result, jobs: Jobs, qtbot: QtBot, projection: str
) -> None:
    panel.way.setCurrentIndex(panel.way.findData(projection))
    panel.view.setCurrentIndex(panel.view.findData(STATED_ANGLE))
    panel.angle.setValue(40)
    qtbot.waitUntil(lambda: not jobs.running)
    grey = photograph("view1.png").grey
    camera = result.calibration.camera
    expected = undistort_image(grey, camera, projection=projection, field_of_view=math.radians(40))
    before, after = shown(panel)
    np.testing.assert_array_equal(before, grey)
    np.testing.assert_array_equal(after, expected.image)
    assert panel.lost.text().startswith(f"{projection.capitalize()} of 40 degrees: the outer ")


def test_an_angle_beyond_the_projection_cannot_be_chosen(panel: UndistortPanel) -> None:
    panel.way.setCurrentIndex(panel.way.findData("equirectangular"))
    panel.view.setCurrentIndex(panel.view.findData(STATED_ANGLE))
    panel.angle.setValue(300)
    assert panel.angle.value() == 300
    panel.way.setCurrentIndex(panel.way.findData("perspective"))
    assert panel.angle.value() == 179


def test_a_cube_is_unfolded_beside_the_original(
    panel: UndistortPanel, result: Result, jobs: Jobs, qtbot: QtBot
) -> None:
    panel.way.setCurrentIndex(panel.way.findData("cube"))
    assert not panel.view.isEnabled()
    qtbot.waitUntil(lambda: not jobs.running)
    grey = photograph("view1.png").grey
    camera = result.calibration.camera
    # A lens of 60 degrees fits the front. The original keeps its shape, with black around it.
    (front,) = choose_ideal_cameras(camera, projection="cube").values()
    before, after = shown(panel)
    np.testing.assert_array_equal(after, make_ideal_image(grey, camera, front).image)
    assert before.shape == (640, 640)
    np.testing.assert_array_equal(before[80:560], grey)
    assert not before[:80].any()
    assert panel.lost.text() == "Cube of front: everything that the lens sees is shown."


def test_the_faces_of_a_cube_join_in_the_cross() -> None:
    names = ("front", "left", "right", "top", "bottom")
    faces = {name: np.full((2, 2), k + 1, np.uint8) for k, name in enumerate(names)}
    expected = [[0, 4, 0], [2, 1, 3], [0, 5, 0]]
    np.testing.assert_array_equal(unfold_cube(faces)[::2, ::2], expected)
    faces["back"] = np.full((2, 2), 6, np.uint8)
    np.testing.assert_array_equal(unfold_cube(faces)[3, ::2], [2, 1, 3, 6])
    np.testing.assert_array_equal(unfold_cube({"top": faces["top"]}), faces["top"])


def test_rectified_of_the_selected_view(
    panel: UndistortPanel, result: Result, jobs: Jobs, qtbot: QtBot
) -> None:
    panel.select(5)
    panel.way.setCurrentIndex(panel.way.findData(RECTIFIED))
    assert not panel.view.isEnabled()
    qtbot.waitUntil(lambda: not jobs.running)
    expected = rectify_image(
        photograph("view5.png").grey,
        result.calibration.camera,
        result.calibration.poses[4],
        find_shown_extent(result),
        measure_natural_scale(result),
    )
    (only,) = shown(panel)
    np.testing.assert_array_equal(only, expected.image)
    assert not panel.lost.text()


def test_the_divider_slides(panel: UndistortPanel, qtbot: QtBot) -> None:
    images = panel.images
    frame = images.frame
    start = frame.center().toPoint()
    goal = QPoint(round(frame.left() + 0.8 * frame.width()), start.y())
    drag(qtbot, images, start, goal)
    assert images.divider == pytest.approx(0.8, abs=0.01)
    qtbot.keyClick(images, Qt.Key.Key_Left)
    assert images.divider == pytest.approx(0.75, abs=0.01)
    # Left of the divider the picture is the original's, right of it the undistorted one's.
    picture = images.grab().toImage()
    both = np.array(shown(panel), dtype=float)
    for k, part in enumerate((slice(300, 400), slice(520, 600))):
        # Where the two differ most there is no doubt which is shown.
        differ = np.abs(both[0] - both[1])[40:440, part]
        v, u = np.unravel_index(differ.argmax(), differ.shape)
        v, u = v + 40, u + part.start
        x = frame.left() + (u + 0.5) / 640 * frame.width()
        y = frame.top() + (v + 0.5) / 480 * frame.height()
        level = picture.pixelColor(int(x), int(y)).red()
        assert abs(level - both[k, v, u]) < abs(level - both[1 - k, v, u])


def test_saving_names_views_and_way(panel: UndistortPanel, qtbot: QtBot) -> None:
    panel.select(3)
    with qtbot.waitSignal(panel.save_wanted) as signal:
        qtbot.mouseClick(panel.save_one, Qt.MouseButton.LeftButton)
    assert signal.args == [(3,), Undistortion()]
    with qtbot.waitSignal(panel.save_wanted) as signal:
        qtbot.mouseClick(panel.save_all, Qt.MouseButton.LeftButton)
    assert signal.args == [tuple(range(10)), Undistortion()], "also what was left out"
    panel.way.setCurrentIndex(panel.way.findData("stereographic"))
    panel.view.setCurrentIndex(panel.view.findData(STATED_ANGLE))
    panel.angle.setValue(90)
    with qtbot.waitSignal(panel.save_wanted) as signal:
        qtbot.mouseClick(panel.save_one, Qt.MouseButton.LeftButton)
    wanted = Undistortion(Projection.STEREOGRAPHIC, field_of_view=math.pi / 2)
    assert signal.args == [(3,), wanted]
    panel.way.setCurrentIndex(panel.way.findData(RECTIFIED))
    with qtbot.waitSignal(panel.save_wanted) as signal:
        qtbot.mouseClick(panel.save_all, Qt.MouseButton.LeftButton)
    assert signal.args == [(0, 2, 3, 4, 5, 6, 7, 8, 9), None]


def test_an_image_that_is_gone_says_so(jobs: Jobs, qtbot: QtBot, result: Result) -> None:
    def gone(path: str) -> Image:
        raise CalibrationError(f"{path} does not exist.", "Locate it.")

    panel = UndistortPanel(Services(jobs, gone))
    qtbot.addWidget(panel)
    panel.show_result(result)
    panel.show()
    qtbot.waitUntil(lambda: not jobs.running)
    assert panel.lost.text() == "view1.png does not exist. Locate it."
    assert not shown(panel)


def test_nothing_is_read_while_hidden(jobs: Jobs, qtbot: QtBot, result: Result) -> None:
    panel = UndistortPanel(Services(jobs, photograph))
    qtbot.addWidget(panel)
    panel.show_result(result)
    panel.select(4)
    assert not jobs.running
    panel.show()
    qtbot.waitUntil(lambda: not jobs.running)
    assert panel.words.text().startswith("view4.png")

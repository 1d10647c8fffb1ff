"""Camera files that are dropped on the window: the camera is held, and boards are located."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from calibgui.app.calibrating.board_poses import locate_boards
from calibgui.app.projects.project_file import read_project
from calibgui.engine.calibration import is_held
from calibgui.engine.camera import Camera
from calibgui.engine.images import read_image, write_image
from calibgui.engine.opencv import halve_image
from calibgui.formats import EXPORTERS, read_camera
from calibgui.formats.camera_conversion import export_camera
from calibgui.formats.result_json import read_result, write_result
from calibgui.gui.panels.answer.result import ResultPanel
from calibgui.gui.panels.answer.uncertainty import UncertaintyPanel
from calibgui.gui.panels.answer.undistort import UndistortPanel
from calibgui.gui.panels.evidence.poses import PosesPanel
from calibgui.gui.panels.method.convergence import ConvergencePanel
from calibgui.gui.window.main_window import MainWindow
from tests.gui.dialogs.test_videos import drop
from tests.photographs import CAMERA

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture(scope="module")
def few(photographs: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two photographs, which would not calibrate a camera."""
    folder = tmp_path_factory.mktemp("few")
    for name in ("view1.png", "view3.png"):
        shutil.copy(photographs / name, folder / name)
    return folder


def write_camera(path: Path, name: str, camera: Camera = CAMERA) -> Path:
    export_camera(camera, EXPORTERS[name], path)
    return path


def is_located(window: MainWindow) -> Callable[[], bool]:
    return lambda: window.session.result is not None and not window.session.jobs.running


@pytest.mark.parametrize(
    ("name", "file"),
    [("opencv", "cam.yaml"), ("ros", "ost.yaml"), ("basalt", "calib.json"), ("kalibr", "c.yaml")],
)
def test_boards_are_located_with_a_dropped_camera(
    window: MainWindow, qtbot: QtBot, few: Path, tmp_path: Path, name: str, file: str
) -> None:
    path = write_camera(tmp_path / file, name)
    drop(window, few, path)
    known = window.session.project.settings.known
    assert known is not None
    assert known.file == file
    assert f"The camera of {file}" in window.banner.text.text()
    window.calibrate.click()
    qtbot.waitUntil(is_located(window), timeout=60_000)
    result, corner_set = window.session.result, window.session.project.corner_set
    assert result is not None
    assert corner_set is not None
    calibration = result.calibration
    assert is_held(calibration)
    stored = read_camera(path).camera
    assert calibration.camera.model == stored.model
    np.testing.assert_array_equal(calibration.camera.params, stored.params)
    expected = locate_boards(stored, corner_set).located
    assert len(calibration.poses) == len(expected) == 2
    for pose, covariance, (_, found) in zip(
        calibration.poses, result.pose_covariances, expected, strict=True
    ):
        np.testing.assert_allclose(pose.tvec, found.pose.tvec, rtol=1e-9)
        np.testing.assert_allclose(covariance, found.covariance, rtol=1e-9)
    assert window.verdict.headline.text() == "KNOWN CAMERA"
    assert f"The camera of {file} stays as it is" in window.verdict.reason.text()
    assert window.verdict.button.isHidden()


def test_panels_show_what_a_known_camera_allows(
    window: MainWindow, qtbot: QtBot, few: Path, tmp_path: Path
) -> None:
    drop(window, few, write_camera(tmp_path / "cam.yaml", "opencv"))
    window.calibrate.click()
    qtbot.waitUntil(is_located(window), timeout=60_000)
    analysis = window.need_analysis()
    result = window.session.result
    assert result is not None
    assert analysis.show_panel(PosesPanel).isVisible()
    undistorted = analysis.show_panel(UndistortPanel)
    qtbot.waitUntil(lambda: undistorted.save_all.isEnabled(), timeout=20_000)
    assert "nothing was calibrated" in analysis.show_panel(ResultPanel).words.toPlainText()
    uncertainty = analysis.show_panel(UncertaintyPanel)
    qtbot.waitUntil(lambda: "known from a file" in uncertainty.words.text(), timeout=20_000)
    assert "nothing was solved" in analysis.show_panel(ConvergencePanel).words.text()
    file = tmp_path / "result.json"
    write_result(result, file)
    assert is_held(read_result(file).calibration)
    window.files.report()
    assert "this one is known from a file" in window.banner.text.text()
    (button,) = window.banner.buttons
    qtbot.mouseClick(button, LEFT)
    assert window.session.project.settings.known is None
    qtbot.waitUntil(lambda: window.session.result is not result, timeout=60_000)
    assert window.session.result is not None
    assert not is_held(window.session.result.calibration)


def test_the_set_up_names_the_camera_and_gives_it_up(
    window: MainWindow, qtbot: QtBot, photographs: Path, tmp_path: Path
) -> None:
    choice = window.settings.known
    assert choice.name.text() == "calibrated"
    drop(window, write_camera(tmp_path / "cam.yaml", "opencv"))
    drop(window, photographs)
    window.header.setup.setChecked(True)
    known = window.session.project.settings.known
    assert known is not None
    assert choice.name.text() == "cam.yaml"
    assert "fx" in choice.name.toolTip()
    assert not window.settings.model.isEnabled()
    window.files.saver.save(tmp_path / "project.json")
    kept = read_project(tmp_path / "project.json").settings.known
    assert kept is not None
    np.testing.assert_array_equal(kept.camera.params, known.camera.params)
    qtbot.mouseClick(choice.button, LEFT)
    assert window.session.project.settings.known is None
    assert window.settings.model.isEnabled()
    window.calibrate.click()
    qtbot.waitUntil(is_located(window), timeout=60_000)
    assert window.session.result is not None
    assert not is_held(window.session.result.calibration)


def test_leaving_a_photograph_out_keeps_the_camera(
    window: MainWindow, qtbot: QtBot, few: Path, tmp_path: Path
) -> None:
    window.settings.choose_model("pinhole", ())
    drop(window, few, write_camera(tmp_path / "cam.yaml", "opencv"))
    window.calibrate.click()
    qtbot.waitUntil(is_located(window), timeout=60_000)
    first = window.session.result
    window.images.follows.setChecked(True)
    window.images.exclude([window.session.project.views[0].image])
    qtbot.waitUntil(lambda: window.session.result is not first, timeout=20_000)
    result = window.session.result
    assert result is not None and first is not None
    assert len(result.used) == 1
    assert is_held(result.calibration)
    np.testing.assert_array_equal(result.calibration.camera.params, first.calibration.camera.params)


def test_photographs_of_half_the_size_are_a_mode_of_the_camera(
    window: MainWindow, qtbot: QtBot, few: Path, tmp_path: Path
) -> None:
    half = tmp_path / "half"
    half.mkdir()
    for file in few.iterdir():
        write_image(half / file.name, halve_image(read_image(file).pixels))
    drop(window, half, write_camera(tmp_path / "cam.yaml", "opencv"))
    window.calibrate.click()
    qtbot.waitUntil(is_located(window), timeout=60_000)
    assert window.session.result is not None
    camera = window.session.result.calibration.camera
    assert camera.focal[0] == pytest.approx(CAMERA.params[0] / 2, rel=1e-3)
    assert "taken to be" in window.verdict.reason.toolTip() + window.verdict.reason.text()


def test_what_is_no_camera_is_refused(window: MainWindow, few: Path, tmp_path: Path) -> None:
    (tmp_path / "notes.yaml").write_text("%YAML:1.0\n---\nfocus: 3\n")
    drop(window, few / "view1.png", tmp_path / "notes.yaml")
    assert window.session.project.settings.known is None
    assert len(window.session.project.views) == 1

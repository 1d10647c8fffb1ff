"""Take pictures of the window, one of every panel and of dialogs, those of the manual among them.

    python packaging/screenshots.py FOLDER [--size 1280x720] [--scheme light|dark] [--manual]

With --manual those that it shows are written to resources/manual/images as well.

Run it under Xvfb (QT_QPA_PLATFORM=xcb) or without a display (offscreen); QT_SCALE_FACTOR=2
doubles the resolution.
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from unittest import mock

import numpy as np
from PySide6.QtCore import QEventLoop, QPoint, QSettings, Qt, QTimer
from PySide6.QtGui import QAction, QImage
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QTabWidget

from calibgui.app.calibrating.series import Scalar
from calibgui.app.photographs import recording
from calibgui.app.system.resources import find_resource
from calibgui.cli.main import main as calibgui
from calibgui.engine.boards import Board, BoardShapeModel
from calibgui.engine.calibration import locate_board
from calibgui.engine.camera import Camera
from calibgui.engine.capture import Frame
from calibgui.engine.geometry import Pose, rotation_from_vector, vector_from_rotation
from calibgui.engine.images import render_view, write_image
from calibgui.gui.dialogs.manual_dialog import ManualDialog
from calibgui.gui.dialogs.many_cameras import ManyCameras
from calibgui.gui.dialogs.series_dialog import SeriesDialog
from calibgui.gui.panels.analysis import PANELS
from calibgui.gui.panels.answer.undistort import RECTIFIED, UndistortPanel
from calibgui.gui.panels.evidence.board_shape import BoardShapePanel
from calibgui.gui.panels.method.methods import MethodsPanel
from calibgui.gui.panels.modes import Mode
from calibgui.gui.panels.on_demand import OnDemandPanel
from calibgui.gui.verdict.before_after import BeforeAndAfter
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.actions import show_dialog
from calibgui.gui.window.main_window import MainWindow

MANUAL = find_resource("manual") / "images"
SHOWN = ("calibrated", "marking", "residuals", "distortion", "poses", "undistort", "live", "rig")
"""Pictures that the manual shows."""
_QUALITY = 85
"""Quality of the manual's pictures as WebP, of 100."""
_PATIENCE = 600.0
"""Time after which the window is taken to hang, s."""
_CAMERAS, _VIEWS = 6, 8
"""Number of cameras in the fleet, and of photographs of each."""
_BOARD = Board(6, 9, 25.0)
_LIVE = Camera((640, 480), [560, 560, 322, 236, -0.15, 0.03, 0, 0, 0], "brown-conrady")
"""What is photographed live, and with which camera."""
_RIG = (Pose([0, 0, 0], [0, 0, 0]), Pose([0.01, -0.12, 0.0], [-90.0, 1.0, 6.0]))
"""Poses cam_from_rig of two such cameras."""
_INSTANTS = 10
_STEPS, _STILL, _PICTURES = 8, 8, 4
"""Frames in which a board is moved, and for which it is held still, and pictures that are taken
live."""


def place_board(k: int, distance: float = 430.0) -> Pose:
    """Place the board, tilted otherwise for each number."""
    tilt = 0.5 * np.array([np.cos(2.4 * k), np.sin(2.4 * k), 0.1])
    R = rotation_from_vector(tilt)
    at = np.array([40 * np.cos(1.7 * k), 30 * np.sin(1.3 * k), distance + 10 * k])
    return Pose(tilt, at - R[:, :2] @ _BOARD.points().mean(axis=0))


class Hand:
    """A camera before which a hand brings a board to where it is wanted, and holds it there.

    Args:
        window: on whose page that is.
        pictures: number of pictures after which it stays on the way.
    """

    title, is_continuous, is_live = "a rendered camera", True, False
    remark = "The camera has 640 x 480 px, exposure 156, focus 30."

    def __init__(self, window: MainWindow, pictures: int) -> None:
        self._window, self._pictures = window, pictures
        self._frames = self._hold()

    def read(self) -> Frame:
        """Return the next frame."""
        return next(self._frames)

    def close(self) -> None:
        """Release nothing."""

    def _hold(self) -> Iterator[Frame]:
        pose, count, stays = place_board(0), 0, False
        while True:
            way = [pose] * _STILL
            page = self._window.own_pages.live
            camera = None if page is None or page.session is None else page.session.cameras[0]
            if count and not stays and camera is not None and camera.goal is not None:
                goal = locate_board(_LIVE, (camera.goal.reshape(-1, 2), _BOARD.points())).pose
                way = [_go(pose, goal, k / _STEPS) for k in range(1, _STEPS + 1)]
                if len(camera.pictures) == self._pictures:  # on the way to the next place
                    way, stays = way[: _STEPS // 2], True
                pose = way[-1]
                way += [pose] * _STILL
            for each in way:
                count += 1
                image = render_view(_LIVE, each, _BOARD, blur=0.7, noise=4.0, seed=count)
                yield Frame(np.repeat(image[:, :, None], 3, axis=2), count / 25)
                pause_in_thread()


def _go(start: Pose, end: Pose, part: float) -> Pose:
    """Return the pose on the way from one to another."""
    rvec, tvec = (
        (1 - part) * np.array(a) + part * np.array(b)
        for a, b in ((start.rvec, end.rvec), (start.tvec, end.tvec))
    )
    return Pose(rvec, tvec)


def pause_in_thread() -> None:
    """Leave the processor to the window."""
    time.sleep(0.02)


def pause(seconds: float) -> None:
    """Let the window work."""
    loop = QEventLoop()
    QTimer.singleShot(round(1000 * seconds), loop.quit)
    loop.exec()


def wait(condition: Callable[[], object]) -> None:
    """Let the window work until `condition` holds."""
    for _ in range(round(_PATIENCE / 0.02)):
        if condition():
            return
        pause(0.02)
    raise TimeoutError("the window does not come to an end")


@contextmanager
def open_window(width: int, height: int, scheme: theme.Scheme) -> Iterator[MainWindow]:
    """Show the window with settings of its own; what is unsaved at the end is given up."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    with tempfile.TemporaryDirectory() as home:
        os.environ["XDG_STATE_HOME"] = home
        QSettings.setPath(QSettings.Format.NativeFormat, QSettings.Scope.UserScope, home)
        app = QApplication([])
        theme.apply(app, scheme)
        window = MainWindow()
        window.resize(width, height)
        window.show()
        yield window
        window.session.document.mark_saved(window.session.project, window.files.saver.file)
        window.close()


class Photographer:
    """Writes what the window shows."""

    def __init__(self, window: MainWindow, folder: Path) -> None:
        self.window, self.folder = window, folder

    def take(self, name: str) -> None:
        """Write a picture once nothing moves any more."""
        pause(0.3)
        wait(lambda: not self.window.session.jobs.running)
        pause(0.1)
        (QApplication.activeModalWidget() or self.window).grab().save(
            str(self.folder / f"{name}.png")
        )

    def all(self) -> None:
        """The way from the empty window through every panel."""
        window, session = self.window, self.window.session
        self.take("welcome")
        window.files.open_paths([str(find_resource("sample"))])
        wait(lambda: session.result is not None)
        session.select(session.project.views[2].image)
        self.take("calibrated")
        self.desk()
        for kind in PANELS:
            if kind is BoardShapePanel:
                self.estimate_board_shape()
            panel = window.need_analysis().show_panel(kind)
            if isinstance(panel, OnDemandPanel):
                panel.run.click()
                wait(partial(getattr, panel, "found"))
            if isinstance(panel, MethodsPanel):
                panel.tables.errors.selectRow(2)  # the first differs from none: it has no map
            name = kind.__name__.removesuffix("Panel").lower()
            self.take("summary" if name == "result" else name)
        self.rectified()
        self.marking()
        self.verdict()
        self.dialogs()
        self.live()
        self.rig()
        with tempfile.TemporaryDirectory() as folder:
            self.fleet(Path(folder))
            self.series(Path(folder))

    def desk(self) -> None:
        """Take the set-up, the desk alone, a check, the tour, and a threshold."""
        window, images = self.window, self.window.images
        window.show_setup()
        self.take("setup")
        window.header.setup.setChecked(False)
        window.body.leave_desk_alone()
        self.take("alone")
        window.body.leave_desk_alone()
        window.check.check([view.image for view in window.session.project.views[:3]])
        wait(lambda: window.check.checked)
        self.take("check")
        window.check.leave()
        window.take_tour()
        self.take("tour")
        assert window._tour is not None
        window._tour.leave()
        images.list._move_threshold(0.7 * images.list.top)
        images.exclude_above.click()
        wait(lambda: window.session.project.is_current(window.session.result))
        images.list._move_threshold(0.8 * images.list.top)
        self.take("threshold")
        window.session.document.undo()

    def estimate_board_shape(self) -> None:
        """Calibrate once more, every corner of the board free."""
        session = self.window.session
        session.edit(
            "Settings",
            lambda p: replace(p, settings=replace(p.settings, board_shape=BoardShapeModel.FREE)),
        )
        self.window.calibrate.click()
        wait(lambda: len(session.project.results) == 2 and not session.jobs.running)

    def marking(self) -> None:
        """Four clicks around a board, with the loupe."""
        window, canvas = self.window, self.window.page.canvas
        session = window.session
        window.show_mode(Mode.PHOTOGRAPHS)
        session.select(session.project.views[4].image)
        pause(0.3)
        view = session.view
        assert view is not None
        assert view.corners is not None
        assert view.corners.roi is not None
        window.page.tools[0].trigger()
        for number, (u, v) in enumerate(canvas.to_screen(view.corners.roi), start=1):
            at = QPoint(round(u) + 2, round(v) - 2)
            QTest.mouseMove(canvas.viewport(), at)
            pause(0.05)
            if number == 4:
                self.take("marking")
            QTest.mouseClick(
                canvas.viewport(), Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, at
            )
        wait(window.page.marker.roi_bar.accept.isEnabled)
        self.take("marked")
        window.page.marker.leave()

    def rectified(self) -> None:
        """Take the photograph as seen from straight above the board."""
        panel = self.window.need_analysis().show_panel(UndistortPanel)
        panel.way.setCurrentIndex(panel.way.findData(RECTIFIED))
        self.take("rectified")
        panel.way.setCurrentIndex(0)

    def verdict(self) -> None:
        """Take what is found wrong with a lens model, and what its remedy has done."""
        window, session, bar = self.window, self.window.session, self.window.verdict
        session.edit(
            "Settings", lambda p: replace(p, settings=replace(p.settings, model="pinhole"))
        )
        window.calibrate.click()
        wait(lambda: session.project.is_current(session.result) and not session.jobs.running)
        bar.unfold.click()
        for row in bar.findings.rows:
            row.unfold.click()
        self.take("findings")
        bar.button.click()
        wait(lambda: isinstance(bar.comparison, BeforeAndAfter) and bar.comparison.isVisible())
        self.take("before-after")
        assert isinstance(bar.comparison, BeforeAndAfter)
        bar.comparison.back.click()

    def dialogs(self) -> None:
        """Take what opens over the window."""
        actions = {action.text(): action for action in self.window.findChildren(QAction)}
        for name, text in (
            ("export", "&Export…"),
            ("print-board", "&Print a board…"),
            ("palette", "&Find an action…"),
        ):
            actions[text].trigger()
            wait(QApplication.activeModalWidget)
            self.take(name)
            self._close_dialog()
        actions["&Manual"].trigger()
        manual = self.window.findChild(ManualDialog)
        assert manual is not None
        pause(0.3)
        manual.grab().save(str(self.folder / "manual.png"))
        manual.close()

    def fleet(self, folder: Path) -> None:
        """Calibrate a fleet from sets of the sample's photographs, and show its table."""
        photographs = [Path(view.image) for view in self.window.session.project.views]
        rows = ["id,paths,serial,date"]
        for number in range(_CAMERAS):
            chosen = [photographs[(number + k) % len(photographs)] for k in range(_VIEWS)]
            paths = ";".join(map(str, chosen))
            rows.append(f"camera {number},{paths},S{number // 2},2026-0{1 + number % 2}-15")
        rows.append(f"camera {_CAMERAS},{photographs[0]},S{_CAMERAS},")  # is refused
        manifest = folder / "fleet.csv"
        manifest.write_text("\n".join(rows))
        ledger = folder / "fleet.db"
        calibgui(["batch", str(manifest), "-o", str(ledger), "--board", "7x10", "--square", "25"])
        ManyCameras(self.window.session, self.window.files, self.window).open_fleet(ledger)
        wait(QApplication.activeModalWidget)
        self.take("fleet")
        self._close_dialog()

    def series(self, folder: Path) -> None:
        """Show the fleet's cameras as one camera at several temperatures."""
        results = sorted((folder / "fleet.results").glob("*.json"))[:_CAMERAS]
        table = folder / "temperatures.csv"
        rows = [f"{path.name},{10 * number}" for number, path in enumerate(results, start=1)]
        table.write_text("\n".join(["file,value", *rows]))
        dialog = SeriesDialog(self.window.session.jobs, self.window)
        show_dialog(dialog)
        self.take("series-empty")
        dialog.show_results(results, Scalar.TEMPERATURE, table)
        wait(lambda: dialog.analysed)
        self.take("series")
        dialog.findChildren(QTabWidget)[0].setCurrentIndex(1)
        self.take("series-camera")
        self._close_dialog()

    def live(self) -> None:
        """Photograph a rendered board live, up to a place where it is wanted."""
        window = self.window
        with mock.patch.object(recording, "open_source", lambda *_: Hand(window, _PICTURES)):
            window.own_pages.photograph_live()
            page = window.own_pages.live
            assert page is not None
            with tempfile.TemporaryDirectory() as folder:
                page.folder = Path(folder) / "pictures"
                page.limit.setValue(0.01)
                page.start.click()
                wait(lambda: page.strip.list.count() >= _PICTURES)
                pause(3.0)
                window.grab().save(str(self.folder / "live.png"))
                page.leave.click()
                wait(lambda: not page.is_running)

    def rig(self) -> None:
        """Calibrate a rendered rig."""
        window = self.window
        with tempfile.TemporaryDirectory() as folder:
            cameras = [Path(folder) / name for name in ("left", "right")]
            for k in range(_INSTANTS):
                board = place_board(k)
                for place, pose in zip(cameras, _RIG, strict=True):
                    place.mkdir(exist_ok=True)
                    R = rotation_from_vector(np.array(pose.rvec))
                    turn = R @ rotation_from_vector(np.array(board.rvec))
                    seen = Pose(vector_from_rotation(turn), R @ board.tvec + pose.tvec)
                    image = render_view(_LIVE, seen, _BOARD, blur=0.7, noise=4.0, seed=k)
                    write_image(place / f"{k + 1:02}.png", image)
            window.own_pages.show_rig(list(map(str, cameras)))
            page = window.own_pages.rig
            assert page is not None
            wait(lambda: page.pairing is not None)
            page.form.boards.square.setValue(_BOARD.square)
            page.calibrate.click()
            wait(lambda: page.result is not None)
            page.matrix.setCurrentCell(3, 1)
            page.tabs.setCurrentWidget(page.rectified)
            self.take("rig")
            page.tabs.setCurrentWidget(page.scene)
            self.take("rig-space")
            page.leave.click()

    def _close_dialog(self) -> None:
        dialog = QApplication.activeModalWidget()
        assert dialog is not None
        dialog.close()


def add_options(parser: argparse.ArgumentParser) -> argparse.ArgumentParser:
    """Add the folder, the window's size and its colours to the options."""
    parser.add_argument("folder", type=Path)
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--scheme", type=theme.Scheme, default=theme.Scheme.LIGHT)
    return parser


def main() -> None:
    """Take all pictures."""
    parser = add_options(argparse.ArgumentParser(description=__doc__.splitlines()[0]))
    parser.add_argument("--manual", action="store_true")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    with open_window(*map(int, options.size.split("x")), options.scheme) as window:
        Photographer(window, options.folder).all()
    for name in SHOWN if options.manual else ():
        picture = QImage(str(options.folder / f"{name}.png"))
        picture.save(str(MANUAL / f"{name}.webp"), quality=_QUALITY)


if __name__ == "__main__":
    main()

"""Take pictures of the window in states that the sample does not reach.

    python packaging/states.py FOLDER [--size 1280x720] [--scheme light|dark]

Photographs without a board, one view only, sixty views with long names, every kind of board, a
fisheye lens, work that is going on, menus, messages and questions.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from make_sample import BLUR, BOARD, CAMERA, LOOK, NOISE, VIEWS, place_board
from PySide6.QtCore import QPoint, QTimer
from PySide6.QtWidgets import QApplication, QMenu, QWidget
from screenshots import Photographer, add_options, open_window, pause, wait

from calibgui.app.projects.document import Document
from calibgui.app.system.resources import find_resource
from calibgui.engine.boards import (
    AprilGrid,
    Board,
    BoardShapeModel,
    Charuco,
    Circles,
    PuzzleBoard,
    TaggedCheckerboard,
)
from calibgui.engine.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import Pose, rotation_from_vector
from calibgui.engine.images import render_view, write_image
from calibgui.gui.panels.analysis import PANELS
from calibgui.gui.panels.answer.result import ResultPanel
from calibgui.gui.panels.answer.uncertainty import UncertaintyPanel
from calibgui.gui.panels.evidence.poses import PosesPanel
from calibgui.gui.panels.evidence.residuals import ResidualsPanel
from calibgui.gui.panels.method.lens_models import LensModelsPanel
from calibgui.gui.panels.modes import Mode
from calibgui.gui.panels.on_demand import OnDemandPanel

_BOARDS = {
    "charuco": Board(7, 10, 25.0, Charuco("DICT_4X4_50", 0.7)),
    "circles": Board(7, 10, 25.0, Circles(False, 0.5)),
    "asymmetric-circles": Board(9, 5, 22.0, Circles(True, 0.8)),
    "aprilgrid": Board(8, 12, 20.0, AprilGrid("t36h11", 0.3, 2, False)),
    "tagged-checkerboard": Board(7, 10, 25.0, TaggedCheckerboard("t36h11", 2, 2, True)),
    "puzzleboard": Board(7, 10, 25.0, PuzzleBoard()),
}
_FISHEYE = Camera((640, 480), [230.0, 230.5, 318.0, 242.0, 0.02, -0.01, 0.0, 0.0], "kannala-brandt")
_LONG = "2026-01-15_workshop_left-camera_exposure-1-250_second-attempt_{0:04d}.png"
_KINDS = 8
"""Number of photographs of each kind of board."""


def render(
    folder: Path,
    board: Board = BOARD,
    camera: Camera = CAMERA,
    count: int = len(VIEWS),
    name: str = "view{0:02d}.png",
    nearer: float = 1.0,
) -> Path:
    """Render photographs of a board as the sample's poses have it, each time round a bit turned."""
    folder.mkdir()
    for number in range(count):
        turn, k = divmod(number, len(VIEWS))
        pose = place_board(VIEWS[k])
        shift = BOARD.points().mean(axis=0) - board.points().mean(axis=0)
        R = rotation_from_vector(pose.rvec)
        tvec = (pose.tvec + R[:, :2] @ shift) * [1.0, 1.0, nearer]
        tvec[2] += 6.0 * turn
        placed = Pose(pose.rvec + 0.02 * turn, tvec)
        image = render_view(
            camera, placed, board, blur=BLUR, noise=NOISE, seed=number, appearance=LOOK
        )
        write_image(folder / name.format(number + 1), image)
    return folder


class States(Photographer):
    """Brings the window into states, one after the other."""

    def all(self) -> None:
        """Take all of them."""
        with tempfile.TemporaryDirectory() as home:
            for state in (
                self.messages,
                self.menus,
                self.without_board,
                self.one_view,
                self.many_views,
                self.fisheye,
                self.boards,
                self.welcome_back,
            ):
                state(Path(home))

    def begin(self, folder: Path) -> None:
        """Open a folder in an empty project, and wait until nothing moves."""
        session = self.window.session
        session.document.mark_saved(session.project, self.window.files.saver.file)
        session.begin(Document())
        self.window.files.open_paths([str(folder)])
        wait(lambda: session.project.views)
        pause(0.5)
        wait(lambda: not session.jobs.running)

    def snap(self, name: str, widget: QWidget | None = None) -> None:
        """Write a picture at once, while work goes on."""
        (widget or self.window).grab().save(str(self.folder / f"{name}.png"))

    def ask(self, name: str, question: Callable[[], object]) -> None:
        """Take a question that waits for its answer."""

        def look() -> None:
            box = QApplication.activeModalWidget()
            assert box is not None
            self.snap(name, box)
            box.close()

        QTimer.singleShot(300, look)
        question()

    def messages(self, _: Path) -> None:
        """Take messages over the photograph, questions, and parts that are closed."""
        window, session = self.window, self.window.session
        self.begin(find_resource("sample"))
        session.select(session.project.views[2].image)
        session.edit("Squares", lambda p: replace(p, lengths_confirmed=False))
        self.take("square")
        window.show_failure(
            CalibrationError(
                f"{_LONG.format(1)} cannot be read: it is no image, or it is damaged.",
                "Open it in another program, save it as PNG, and add it again.",
            )
        )
        self.take("failure")
        window.banner.show_text(
            f"3 of 14 images changed since their corners were found, among them {_LONG.format(1)}.",
            {"&Detect again": pause},
        )
        self.take("offer")
        window.banner.show_text("Wrote 14 images into undistorted.")
        self.take("message")
        window.banner.dismiss.click()
        while window.banner.isVisible():
            window.banner.dismiss.click()
        session.edit("Squares", lambda p: replace(p, lengths_confirmed=True))
        window.body.leave_desk_alone()
        self.take("alone")
        window.body.leave_desk_alone()
        window.page.tools[1].trigger()
        self.take("edit-corners")
        window.page.marker.leave()
        analysis = window.need_analysis()
        for kind in PANELS:
            if issubclass(kind, OnDemandPanel):
                analysis.show_panel(kind)
                self.take(f"before-{kind.__name__.removesuffix('Panel').lower()}")
        analysis.show_panel(LensModelsPanel).run.click()  # type: ignore[attr-defined]
        pause(0.3)
        self.snap("comparing")
        wait(lambda: not session.jobs.running)
        session.edit(
            "Settings",
            lambda p: replace(p, settings=replace(p.settings, board_shape=BoardShapeModel.FREE)),
        )
        window.show_setup()
        self.take("out-of-date")
        self.ask("unsaved", window.files.may_leave)
        self.ask("bug", lambda: window.show_failure(ValueError("by design")))

    def menus(self, _: Path) -> None:
        """Take every menu."""
        window = self.window
        menus = [action.menu() for action in window.menuBar().actions()]
        for menu in [*menus, *self._list_buttons_menus()]:
            assert isinstance(menu, QMenu)
            title = menu.title().replace("&", "") or "manage"
            menu.popup(window.mapToGlobal(QPoint(0, 20)))
            pause(0.2)
            self.snap(f"menu-{title.lower()}", menu)
            menu.close()

    def _list_buttons_menus(self) -> Iterator[QMenu]:
        menu = self.window.inspector.camera.more.menu()
        assert menu is not None
        yield menu

    def without_board(self, home: Path) -> None:
        """Take photographs that show no board."""
        folder = home / "nothing"
        folder.mkdir()
        rng = np.random.default_rng(1)
        for k in range(5):
            grey = rng.normal(120, 12, (480, 640)).clip(0, 255).astype(np.uint8)
            write_image(folder / _LONG.format(k), grey)
        (folder / "damaged.png").write_bytes(b"no image")
        self.begin(folder)
        self.window.need_analysis().show_panel(ResultPanel)
        self.take("no-board")
        self.window.show_mode(Mode.PHOTOGRAPHS)
        self.take("no-board-image")
        for k, view in enumerate(self.window.session.project.views):
            if "damaged" in view.image:
                self.window.session.select(self.window.session.project.views[k].image)
        self.take("unreadable")

    def one_view(self, home: Path) -> None:
        """Take what a single view allows, in every panel."""
        self.begin(render(home / "one", count=1))
        analysis = self.window.need_analysis()
        for kind in PANELS:
            analysis.show_panel(kind)
            self.take(f"one-{kind.__name__.removesuffix('Panel').lower()}")

    def many_views(self, home: Path) -> None:
        """Take sixty views with long names, while they are searched, calibrated, and afterwards."""
        window, session = self.window, self.window.session
        folder = render(home / "many", count=60, name=_LONG)
        session.document.mark_saved(session.project, window.files.saver.file)
        session.begin(Document())
        window.files.open_paths([str(folder)])
        wait(lambda: any(v.corners is not None for v in session.project.views))
        window.show_mode(Mode.PHOTOGRAPHS)
        pause(0.3)
        self.snap("searching")
        wait(lambda: window.calibrator.running or session.result is not None)
        self.snap("calibrating")
        wait(lambda: session.result is not None and not session.jobs.running)
        session.select(session.project.views[40].image)
        analysis = window.need_analysis()
        for kind in (ResultPanel, UncertaintyPanel, *PANELS[4:10]):
            analysis.show_panel(kind)
            self.take(f"many-{kind.__name__.removesuffix('Panel').lower()}")

    def fisheye(self, home: Path) -> None:
        """Take a fisheye lens."""
        self.begin(render(home / "fisheye", camera=_FISHEYE, nearer=0.45))
        analysis = self.window.need_analysis()
        self.window.session.select(self.window.session.project.views[5].image)
        for kind in PANELS:
            analysis.show_panel(kind)
            self.take(f"fisheye-{kind.__name__.removesuffix('Panel').lower()}")

    def boards(self, home: Path) -> None:
        """Take every kind of board, found and set up."""
        window = self.window
        for name, board in _BOARDS.items():
            self.begin(render(home / name, board, count=_KINDS))
            window.need_analysis().show_panel(ResidualsPanel)
            self.take(name)
            if window.banner.buttons and window.banner.isVisible():
                window.banner.buttons[0].click()
                pause(0.5)
                wait(lambda: not window.session.jobs.running)
            window.need_analysis().show_panel(PosesPanel)
            self.take(f"{name}-poses")
            window.show_setup()
            self.take(f"{name}-setup")

    def welcome_back(self, _: Path) -> None:
        """Take the empty window of somebody who has worked with it."""
        session = self.window.session
        session.document.mark_saved(session.project, self.window.files.saver.file)
        session.begin(Document())
        self.take("welcome-back")


def main() -> None:
    """Take all pictures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options = add_options(parser).parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    with open_window(*map(int, options.size.split("x")), options.scheme) as window:
        States(window, options.folder).all()


if __name__ == "__main__":
    main()

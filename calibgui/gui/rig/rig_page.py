"""The page of a rig: pair the photographs of several cameras, calibrate, look, and write."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from functools import partial
from pathlib import Path
from typing import TypeVar

from PySide6.QtCore import Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import (
    QFileDialog,
    QLabel,
    QMenu,
    QProgressBar,
    QStackedWidget,
    QWidget,
)

from calibgui.app.rig.frames import find_videos
from calibgui.app.rig.pairing import leave_photographs_out
from calibgui.app.rig.rig_setup import RigSetup, SearchedBoards, recall_setup
from calibgui.dataset import RigPairing, RigResult
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import read_colour
from calibgui.formats.rig_files import RIG_EXPORTERS
from calibgui.formats.rig_json import read_rig, write_rig
from calibgui.gui.jobs.job import Job
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.panels.evidence.scene_view import SceneView
from calibgui.gui.panels.latest import Latest
from calibgui.gui.rig.instant_view import InstantView
from calibgui.gui.rig.pairing_pane import PairingPane
from calibgui.gui.rig.rig_answer import RigAnswer
from calibgui.gui.rig.rig_form import RigForm
from calibgui.gui.rig.rig_work import (
    Shown,
    pair_names,
    rectify_photographs,
    search_and_calibrate,
)
from calibgui.gui.verdict.sentences import translate_sentences
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button, Kind
from calibgui.gui.widgets.layouts import make_column, make_row
from calibgui.gui.widgets.save_names import ask_for_name
from calibgui.gui.widgets.scrolling import make_scrollable
from calibgui.gui.widgets.tab_bar import TabWidget
from calibgui.report.rig import describe_pairing
from calibgui.report.scene3d import build_rig_scene

T = TypeVar("T")
_SIDE = 340
"""Width of what stands at the right, device-independent px."""


class RigPage(QWidget):
    """Shows the pairing before anything is computed, and lets it be corrected.

    Args:
        jobs: that read, search and calibrate.
    """

    left = Signal()

    def __init__(self, jobs: Jobs) -> None:
        super().__init__()
        self._jobs = jobs
        self._job: Job | None = None
        self._names: list[str] = []
        """Folders or videos that the photographs are of; empty for those of a saved rig."""
        self.result: RigResult | None = None
        self._found = SearchedBoards()
        self._at = (0, 0)
        """Camera and instant that are looked at."""
        self._photographs, self._rectified = Latest(jobs, self), Latest(jobs, self)
        self.pane, self.form, self.answer = PairingPane(), RigForm(), RigAnswer()
        self.matrix = self.pane.matrix
        self.photographs, self.rectified, self.scene = InstantView(), InstantView(), SceneView()
        self._make_controls()
        self._lay_out()
        self.matrix.instant_chosen.connect(self._look_at)
        self.pane.changed.connect(self._forget_result)
        self.form.pairing_wanted.connect(self._pair_again)
        self.form.changed.connect(self._take_setup)
        self.form.boards.pattern.failed.connect(self._show_failure)
        self.scene.picked.connect(self._pick)
        self._show_start()

    @property
    def pairing(self) -> RigPairing | None:
        """The cameras and instants; None while there are no photographs."""
        return None if self.pane.setup is None else self.pane.setup.pairing

    @property
    def is_running(self) -> bool:
        """Return whether photographs are paired or searched, or a rig is calibrated."""
        return self._job is not None

    def open_folders(self, names: Sequence[str], without: Collection[str] = ()) -> None:
        """Pair the photographs of folders, one for each camera or one that holds all, or videos.

        Args:
            names: the folders or videos.
            without: names of photographs that are left out.
        """
        if self.is_running:
            return
        self.form.begin()

        def done(pairing: RigPairing) -> None:
            self._names = list(names)
            for c, camera in enumerate(pairing.cameras):
                left_out = [k for k, file in camera.files.items() if file.name in without]
                pairing = leave_photographs_out(pairing, c, left_out)
            self._begin(RigSetup(pairing))

        self._pair(names, done)

    def open_rig(self, path: Path) -> None:
        """Show a rig that was saved."""
        if self.is_running:
            return

        def read(_: Job) -> RigResult:
            return read_rig(path)

        def done(result: RigResult) -> None:
            self._names = []
            self._begin(recall_setup(result))
            self._show_result(result)

        self._run(self.tr("Opening {0}").format(path.name), read, done)

    def _pair(self, names: Sequence[str], done: Callable[[RigPairing], None]) -> None:
        """Pair photographs as the form says."""
        work = partial(pair_names, list(names), self.form.tolerance, self.form.every.value())
        self._run(self.tr("Pairing photographs"), work, done)

    def _pair_again(self) -> None:
        """Pair the same photographs by other times, or other frames of the same videos."""
        if self._names and not self.is_running:
            self._pair(self._names, self.pane.change_pairing)

    def _run(self, label: str, work: Callable[[Job], T], done: Callable[[T], None]) -> None:
        """Work beside the window, with the progress at the right."""
        self._job = self._jobs.start(
            label,
            work,
            done,
            failed=self._show_failure,
            ended=self._end,
            is_about_document=False,
            owner=self,
        )
        self._jobs.changed.connect(self._show_progress)
        self._show_buttons()

    def _make_controls(self) -> None:
        self.state, self.progress = QLabel(), QProgressBar()
        self.progress.setTextVisible(False)
        self.add, self.open = Button(self.tr("&Folders…")), Button(self.tr("O&pen rig…"))
        self.calibrate = Button(self.tr("&Calibrate rig"), Kind.MAIN)
        self.stop, self.leave = Button(self.tr("&Stop")), Button(self.tr("C&lose"))
        self.set_up = Button(self.tr("Set-&up"))
        self.set_up.setCheckable(True)
        self.set_up.setToolTip(self.tr("What is stated of boards and photographs, to change it"))
        self.export = Button(self.tr("E&xport"), Kind.MAIN)
        menu = QMenu(self.export)
        menu.addAction(self.tr("Rig, with everything (JSON)…"), self._save)
        for name, exporter in RIG_EXPORTERS.items():
            menu.addAction(f"{exporter.title}…", partial(self._export, name))
        self.export.setMenu(menu)
        for button, run in (
            (self.add, self._ask_for_folder),
            (self.open, self._ask_for_rig),
            (self.calibrate, self._calibrate),
            (self.stop, self._stop),
            (self.leave, self._leave),
            (self.set_up, self._choose_side),
        ):
            button.clicked.connect(run)

    def _lay_out(self) -> None:
        self.tabs = TabWidget()
        self.tabs.addTab(self.photographs, self.tr("Photographs"))
        self.tabs.addTab(self.rectified, self.tr("Rectified"))
        self.tabs.addTab(self.scene, self.tr("3-D"))
        title = QLabel(self.tr("Several cameras"))
        title.setFont(theme.make_font(theme.HEADLINE, bold=True))
        self._side = QStackedWidget()
        self._side.addWidget(make_scrollable(self.form))
        self._side.addWidget(make_scrollable(self.answer))
        side = QWidget()
        side.setFixedWidth(_SIDE)
        make_column(
            title,
            (self._side, 1),
            self.state,
            self.progress,
            make_row(self.add, self.open, None, self.leave),
            make_row(self.calibrate, self.stop, self.export, self.set_up, None),
            of=side,
            spacing=12,
            margins=(theme.MARGIN, 12, theme.MARGIN, 12),
        )
        make_row(self.pane, (self.tabs, 1), side, of=self, spacing=0)

    def _show_start(self) -> None:
        self._tell(
            self.tr(
                "Cameras that stand fast to each other and photograph one board together: choose "
                "the folder that holds a folder for each camera (or all photographs, named as "
                "left01 and right01), or drop the folders here, or a video of each camera."
            )
        )
        self.photographs.show_words(self.tr("No photographs yet."))
        self._show_no_result()
        self._show_buttons()

    def _begin(self, setup: RigSetup) -> None:
        """Show other photographs."""
        self.pane.begin(setup)
        self.result, self._found = None, SearchedBoards()
        self._show_form(True)
        self._show_pairing()
        pairing = setup.pairing
        shared = pairing.shared or tuple(pairing.instants)
        self.matrix.setCurrentCell(list(pairing.instants).index(shared[0]), 0)

    def _show_pairing(self) -> None:
        assert self.pairing is not None
        nothing_shared = self.tr("No two cameras have a photograph of one instant.")
        self._tell(describe_pairing(self.pairing) if self.pairing.shared else nothing_shared)
        self.pane.show_pairing(self._found, self.result)
        self._show_buttons()

    def _look_at(self, camera: int, instant: int) -> None:
        """Show the photographs of an instant, and the chosen camera beside the first one."""
        self._at = camera, instant
        pairing, result = self.pairing, self.result
        if pairing is None:
            return
        files = {c.name: c.files[instant] for c in pairing.cameras if instant in c.files}

        def read(_: Job) -> Shown:
            return [read_colour(file) for file in files.values()], list(files), None

        self._start(self._photographs, self.photographs, read)
        if result is not None:
            at = result.rig.instants
            self.scene.select(at.index(instant) if instant in at else -1)
            second = camera or 1
            names = pairing.cameras[0].name, pairing.cameras[second].name
            if not set(names) <= set(files):
                self.rectified.show_words(
                    self.tr("{0} and {1} have no photographs of this instant together.").format(
                        *names
                    )
                )
                return
            both = [files[name] for name in names]
            self._start(
                self._rectified,
                self.rectified,
                lambda _: rectify_photographs(result, second, both, list(names)),
            )

    def _pick(self, place: int) -> None:
        """Look at the instant of a board in space."""
        if self.result is not None and self.pairing and place < len(self.result.rig.instants):
            row = list(self.pairing.instants).index(self.result.rig.instants[place])
            self.matrix.setCurrentCell(row, self._at[0])

    def _start(self, latest: Latest, view: InstantView, read: Callable[[Job], Shown]) -> None:
        """Read photographs beside the window, and show them."""
        latest.start(
            "",
            read,
            lambda shown: view.show_images(*shown),
            lambda error: view.show_words(str(error)),
        )

    def _forget_result(self) -> None:
        """Show another pairing; the rig of the last one no longer holds."""
        self.result = None
        self._show_form(True)
        self._show_no_result()
        self._show_pairing()

    def _show_no_result(self) -> None:
        """Say where results will stand that there are none."""
        words = self.tr("Calibrate the rig first.")
        self.rectified.show_words(words)
        self.scene.show_scene((), (), (), words)

    def _take_setup(self) -> None:
        """Take what the form states."""
        assert self.pairing is not None
        self.pane.change(self.form.state_setup(self.pairing))

    def _show_form(self, is_shown: bool) -> None:
        """Show what is stated in place of the answer, or the answer."""
        self._side.setCurrentIndex(0 if is_shown else 1)
        self.set_up.setChecked(is_shown)

    def _choose_side(self) -> None:
        self._show_form(self.set_up.isChecked())

    def _calibrate(self) -> None:
        """Search what was not searched, and calibrate."""
        self.calibrate.setFocus()  # what is being typed is meant now
        assert self.pane.setup is not None

        def done(answer: tuple[SearchedBoards, RigResult]) -> None:
            self._found, result = answer
            self._show_result(result)

        work = partial(search_and_calibrate, self.pane.setup, self._found)
        self._run(self.tr("Searching"), work, done)

    def _show_progress(self) -> None:
        if (job := self._job) is not None:
            self.progress.setRange(0, job.total)
            self.progress.setValue(job.finished)
            self.state.setText(f"{job.label}…")

    def _end(self) -> None:
        self._job = None
        self._jobs.changed.disconnect(self._show_progress)
        self._show_buttons()

    def _stop(self) -> None:
        if self._job is not None:
            self._job.cancel()

    def _show_result(self, result: RigResult) -> None:
        self.result = result
        self.answer.show_result(result)
        self._show_form(False)
        self._show_pairing()
        boards = [result.instants[instant] for instant in result.rig.instants]
        count = len(boards)
        colours = [QColor(theme.current().muted)] * count
        colours += [theme.view_colour(c) for c in range(len(result.rig.cameras))]
        numbers = [*boards, *result.rig.names]
        condition = (
            self.tr("Lengths hold {0}.").format(result.condition) if result.condition else ""
        )
        self.scene.show_scene(build_rig_scene(result), numbers, colours, condition)
        self._look_at(*self._at)

    def _show_failure(self, error: Exception) -> None:
        if isinstance(error, CalibrationError):
            self._show_form(True)
            self._tell(f"{error.message} {error.hint}", theme.current().bad)
        else:
            self._jobs.failed.emit(error)

    def _tell(self, text: str, colour: str | None = None) -> None:
        """Say in the form what is to do, or what went wrong."""
        self.form.words.setText(translate_sentences(text))
        theme.set_text_colour(self.form.words, colour or theme.current().text)

    def _show_buttons(self) -> None:
        running, pairing = self.is_running, self.pairing
        self.pane.hold(running)
        self.form.show_setup(self.pane.setup, self._found.seen, bool(find_videos(self._names)))
        self.form.setEnabled(not running)
        for button in (self.add, self.open):
            button.setEnabled(not running)
        self.calibrate.setVisible(pairing is not None and not running and self.result is None)
        self.calibrate.setEnabled(pairing is not None and bool(pairing.shared))
        self.stop.setVisible(running)
        self.progress.setVisible(running)
        self.state.setVisible(running)
        for button in (self.export, self.set_up):
            button.setVisible(self.result is not None and not running)

    def _ask_for_folder(self) -> None:
        folder = QFileDialog.getExistingDirectory(
            self, self.tr("Folder with a folder for each camera, or the photographs of all")
        )
        if folder:
            self.open_folders([folder])

    def _ask_for_rig(self) -> None:
        name, _ = QFileDialog.getOpenFileName(
            self, self.tr("Open rig"), "", self.tr("Rigs (*.json)")
        )
        if name:
            self.open_rig(Path(name))

    def _save(self) -> None:
        path = ask_for_name(self, self.tr("Save rig"), "rig.json", self.tr("Rigs (*.json)"))
        if path is not None and self.result is not None:
            result = self.result

            def write() -> str:
                write_rig(result, path)
                return self.tr("Wrote {0}.").format(path)

            self._write(write)

    def _export(self, name: str) -> None:
        exporter, result = RIG_EXPORTERS[name], self.result
        kinds = " ".join(f"*{suffix}" for suffix in exporter.suffixes)
        start = f"{name}{exporter.suffixes[0]}"
        path = ask_for_name(self, exporter.title, start, f"{exporter.title} ({kinds})")
        if path is not None and result is not None:
            second = self._at[0] or 1
            self._write(lambda: exporter.write(result, path, (0, second)))

    def _write(self, write: Callable[[], str]) -> None:
        """Write a file, and say so below the rig."""
        try:
            self.answer.tell(write())
        except CalibrationError as error:
            self.answer.tell(f"{error.message} {error.hint}")

    def _leave(self) -> None:
        self._stop()
        self.left.emit()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        QPainter(self).fillRect(self.rect(), QColor(theme.current().base))

"""The page of a rig: pair the photographs of several cameras, calibrate, look, and write."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import cast

from PySide6.QtCore import Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QFileDialog,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QMenu,
    QProgressBar,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from calibgui.app.calibrating.settings import Settings
from calibgui.app.photographs.board_recognition import explain_missing_board, find_any_board
from calibgui.app.photographs.detection import Detection, find_views
from calibgui.app.rig.calibrating import calibrate_photographs, search_cameras
from calibgui.app.rig.pairing import (
    leave_photographs_out,
    move_photographs,
    pair_photographs,
    recall_pairing,
)
from calibgui.dataset import DEFAULT_SQUARE, CornerSet, RigPairing, RigResult, relate_cameras
from calibgui.engine.arrays import GridSize
from calibgui.engine.boards import Board, Pattern
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import Pixels, read_colour
from calibgui.engine.rig import rectify_pair, rectify_stereo_image
from calibgui.formats.rig_files import RIG_EXPORTERS
from calibgui.formats.rig_json import read_rig, write_rig
from calibgui.gui.jobs.job import Job
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.panels.evidence.scene_view import SceneView
from calibgui.gui.panels.latest import Latest
from calibgui.gui.rig.instant_view import InstantView
from calibgui.gui.rig.pairing_matrix import PairingMatrix
from calibgui.gui.rig.rig_answer import RigAnswer
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button, Kind
from calibgui.gui.widgets.number_box import NumberBox
from calibgui.gui.widgets.save_names import ask_for_name
from calibgui.gui.widgets.scrolling import make_scrollable
from calibgui.gui.widgets.tab_bar import TabWidget
from calibgui.gui.widgets.wrapped_label import WrappedLabel
from calibgui.report.rig import describe_pairing
from calibgui.report.scene3d import build_rig_scene

_SIDE, _MATRIX = 340, 300
"""Widths of what stands at the right and of the matrix, device-independent px."""

Shown = tuple[list[Pixels], list[str], int | None]
"""Photographs, their names, and the number of columns that they stand in, if it matters."""


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
        self.pairing: RigPairing | None = None
        self.result: RigResult | None = None
        self._found: dict[str, CornerSet] = {}
        self._undo: list[RigPairing] = []
        self._at = (0, 0)
        """Camera and instant that are looked at."""
        self._photographs, self._rectified = Latest(jobs, self), Latest(jobs, self)
        self.matrix, self.answer = PairingMatrix(), RigAnswer()
        self.photographs, self.rectified, self.scene = InstantView(), InstantView(), SceneView()
        self._make_controls()
        self._lay_out()
        self.matrix.instant_chosen.connect(self._look_at)
        self.matrix.itemSelectionChanged.connect(self._show_buttons)
        self.scene.picked.connect(self._pick)
        self._show_start()

    def open_folders(self, names: Sequence[str]) -> None:
        """Pair the photographs of folders: one for each camera, or one that holds all."""
        self._jobs.start(
            self.tr("Pairing photographs"),
            lambda _: pair_photographs(list(names)),
            self._begin,
            failed=self._show_failure,
            is_about_document=False,
            owner=self,
        )

    def open_rig(self, path: Path) -> None:
        """Show a rig that was saved."""

        def read(_: Job) -> RigResult:
            return read_rig(path)

        def done(result: RigResult) -> None:
            self._begin(recall_pairing(result))
            self._show_result(result)

        self._jobs.start(
            self.tr("Opening {0}").format(path.name),
            read,
            done,
            failed=self._show_failure,
            is_about_document=False,
            owner=self,
        )

    @property
    def is_running(self) -> bool:
        """Return whether photographs are searched, or a rig is calibrated."""
        return self._job is not None

    def _make_controls(self) -> None:
        self.square = NumberBox(decimals=3, minimum=0.0, maximum=10_000.0)
        self.square.setSuffix(self.tr(" mm"))
        self.square.setSpecialValueText(self.tr("not measured (as if {0} mm)").format("30"))
        self.square.setAccessibleName(self.tr("Side of a square"))
        self.robust = QCheckBox(self.tr("Leave out what no camera e&xplains"))
        self.robust.setToolTip(self.tr("Corners and views that no camera explains take no part"))
        self.words = WrappedLabel()
        self.state, self.progress = QLabel(), QProgressBar()
        self.progress.setTextVisible(False)
        self.add, self.open = Button(self.tr("&Folders…")), Button(self.tr("O&pen rig…"))
        self.earlier, self.later = Button(self.tr("Earli&er")), Button(self.tr("La&ter"))
        self.leave_out, self.undo = Button(self.tr("Lea&ve out")), Button(self.tr("&Undo"))
        self.earlier.setToolTip(
            self.tr("Move the chosen photographs of a camera to the instant before")
        )
        self.later.setToolTip(
            self.tr("Move the chosen photographs of a camera to the instant after")
        )
        self.calibrate = Button(self.tr("&Calibrate rig"), Kind.MAIN)
        self.stop, self.leave = Button(self.tr("&Stop")), Button(self.tr("C&lose"))
        self.export = Button(self.tr("E&xport"), Kind.MAIN)
        menu = QMenu(self.export)
        menu.addAction(self.tr("Rig, with everything (JSON)…"), self._save)
        for name, exporter in RIG_EXPORTERS.items():
            menu.addAction(f"{exporter.title}…", partial(self._export, name))
        self.export.setMenu(menu)
        for button, run in (
            (self.add, self._ask_for_folder),
            (self.open, self._ask_for_rig),
            (self.earlier, lambda: self._move(-1)),
            (self.later, lambda: self._move(1)),
            (self.leave_out, self._leave_out),
            (self.undo, self._take_back),
            (self.calibrate, self._calibrate),
            (self.stop, self._stop),
            (self.leave, self._leave),
        ):
            button.clicked.connect(run)

    def _lay_out(self) -> None:
        left = QWidget()
        left.setFixedWidth(_MATRIX)
        column = QVBoxLayout(left)
        column.setContentsMargins(0, 0, 0, theme.SPACING)
        column.addWidget(self.matrix, 1)
        row = QHBoxLayout()
        row.setContentsMargins(theme.SPACING, 0, theme.SPACING, 0)
        row.setSpacing(theme.SPACING // 2)
        for button in (self.earlier, self.later, self.leave_out, self.undo):
            row.addWidget(button)
        row.addStretch(1)
        column.addLayout(row)
        self.tabs = TabWidget()
        self.tabs.addTab(self.photographs, self.tr("Photographs"))
        self.tabs.addTab(self.rectified, self.tr("Rectified"))
        self.tabs.addTab(self.scene, self.tr("3-D"))
        self._middle = QStackedWidget()
        self._middle.addWidget(self.tabs)
        title = QLabel(self.tr("Several cameras"))
        title.setFont(theme.make_font(theme.HEADLINE, bold=True))
        form = QWidget()
        rows = QFormLayout(form)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapAllRows)
        rows.addRow(self.words)
        rows.addRow(self.tr("Side of a square (distance of circles)"), self.square)
        rows.addRow(self.robust)
        self._side = QStackedWidget()
        self._side.addWidget(form)
        self._side.addWidget(make_scrollable(self.answer))
        side = QWidget()
        side.setFixedWidth(_SIDE)
        beside = QVBoxLayout(side)
        beside.setContentsMargins(theme.MARGIN, 12, theme.MARGIN, 12)
        beside.setSpacing(12)
        beside.addWidget(title)
        beside.addWidget(self._side, 1)
        beside.addWidget(self.state)
        beside.addWidget(self.progress)
        for buttons in ((self.add, self.open), (self.calibrate, self.stop, self.export)):
            row = QHBoxLayout()
            for button in buttons:
                row.addWidget(button)
            row.addStretch(1)
            if self.export in buttons:
                row.addWidget(self.leave)
            beside.addLayout(row)
        whole = QHBoxLayout(self)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.setSpacing(0)
        whole.addWidget(left)
        whole.addWidget(self._middle, 1)
        whole.addWidget(side)

    def _show_start(self) -> None:
        self.words.setText(
            self.tr(
                "Cameras that stand fast to each other and photograph one board together: choose "
                "the folder that holds a folder for each camera (or all photographs, named as "
                "left01 and right01), or drop the folders here."
            )
        )
        self.photographs.show_words(self.tr("No photographs yet."))
        self.rectified.show_words(self.tr("Calibrate the rig first."))
        self._show_buttons()

    def _begin(self, pairing: RigPairing) -> None:
        """Show a new pairing."""
        self.pairing, self.result = pairing, None
        self._found, self._undo = {}, []
        self._side.setCurrentIndex(0)
        self._show_pairing()
        shared = pairing.shared or tuple(pairing.instants)
        self.matrix.setCurrentCell(list(pairing.instants).index(shared[0]), 0)

    def _show_pairing(self) -> None:
        assert self.pairing is not None
        if self.pairing.shared:
            self.words.setText(describe_pairing(self.pairing))
        else:
            self.words.setText(self.tr("No two cameras have a photograph of one instant."))
        self.matrix.show_pairing(self.pairing, self._found, self.result)
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
                lambda _: _rectify(result, second, both, list(names)),
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

    def _move(self, step: int) -> None:
        """Move the chosen photographs to other instants."""
        assert self.pairing is not None
        chosen: dict[int, list[int]] = {}
        for camera, instants in self.matrix.list_chosen().items():
            files = self.pairing.cameras[camera].files
            moved = [files[instant] for instant in instants if instant in files]
            self._change(move_photographs(self.pairing, camera, instants, step))
            there = self.pairing.cameras[camera].files
            chosen[camera] = [instant for instant, file in there.items() if file in moved]
        self.matrix.choose(chosen)

    def _leave_out(self) -> None:
        assert self.pairing is not None
        for camera, instants in self.matrix.list_chosen().items():
            self._change(leave_photographs_out(self.pairing, camera, instants))

    def _change(self, pairing: RigPairing) -> None:
        """Take another pairing; the rig of the last one no longer holds."""
        assert self.pairing is not None
        self._undo.append(self.pairing)
        self._take(pairing)

    def _take_back(self) -> None:
        self._take(self._undo.pop())

    def _take(self, pairing: RigPairing) -> None:
        self.pairing, self.result = pairing, None
        self._side.setCurrentIndex(0)
        self.rectified.show_words(self.tr("Calibrate the rig first."))
        self.scene.show_scene((), (), (), "")
        self._show_pairing()

    def _calibrate(self) -> None:
        """Search what was not searched, and calibrate."""
        pairing, known = self.pairing, dict(self._found)
        assert pairing is not None
        square = self.square.value() or None
        settings = Settings(robust=self.robust.isChecked())

        def work(job: Job) -> tuple[dict[str, CornerSet], RigResult]:
            found = known
            if not known:
                job.rename(self.tr("Searching"))
                found = search_cameras(pairing, partial(_search, job), square)
            found = {name: _state_square(each, square) for name, each in found.items()}
            rig = calibrate_photographs(
                pairing,
                _keep_paired(found, pairing),
                settings,
                tell=lambda name: job.rename(self.tr("Calibrating {0}").format(name)),
            )
            return found, rig

        def done(answer: tuple[dict[str, CornerSet], RigResult]) -> None:
            self._found, result = answer
            self._show_result(result)

        self._job = self._jobs.start(
            self.tr("Searching"),
            work,
            done,
            failed=self._show_failure,
            ended=self._end,
            is_about_document=False,
            owner=self,
        )
        self._jobs.changed.connect(self._show_progress)
        self._show_buttons()

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
        self._side.setCurrentIndex(1)
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
            self._side.setCurrentIndex(0)
            self.words.setText(f"{error.message} {error.hint}")
            theme.set_text_colour(self.words, theme.current().bad)
        else:
            self._jobs.failed.emit(error)

    def _show_buttons(self) -> None:
        running, has_pairing = self.is_running, self.pairing is not None
        theme.set_text_colour(self.words, theme.current().text)
        chosen = bool(self.matrix.list_chosen()) and not running
        for button in (self.earlier, self.later, self.leave_out):
            button.setEnabled(chosen)
        self.undo.setEnabled(bool(self._undo) and not running)
        for button in (self.add, self.open):
            button.setEnabled(not running)
        is_ready = self.pairing is not None and bool(self.pairing.shared)
        self.calibrate.setVisible(has_pairing and not running and self.result is None)
        self.calibrate.setEnabled(is_ready)
        self.stop.setVisible(running)
        self.progress.setVisible(running)
        self.state.setVisible(running)
        self.export.setVisible(self.result is not None)

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


def _search(job: Job, files: Sequence[str], board: Board | None) -> Detection:
    """Search photographs of one camera, for a board that another camera may have told."""
    images = [Path(file) for file in files]

    def find(pattern: Pattern, grid_size: GridSize | None) -> Detection:
        return find_views(
            images,
            grid_size,
            progress=lambda done, total, _: job.advance(done, total),
            stop=job.cancelling,
            pattern=pattern,
        )

    if board is not None:
        return find(board.pattern, board.grid_size)
    detection = find_any_board(find, None)
    error, _ = explain_missing_board(detection, None, True)
    if error is not None:
        raise error
    return detection


def _state_square(corner_set: CornerSet, square: float | None) -> CornerSet:
    """Return corners on a board of squares of another length; None if it is not measured."""
    if corner_set.board is None:
        return corner_set
    board = replace(corner_set.board, square=square or DEFAULT_SQUARE)
    return replace(corner_set, board=board, lengths_confirmed=square is not None)


def _keep_paired(found: Mapping[str, CornerSet], pairing: RigPairing) -> dict[str, CornerSet]:
    """Return the corners of photographs that are not left out of the pairing."""
    kept = {}
    for camera in pairing.cameras:
        files, corner_set = {str(file) for file in camera.files.values()}, found[camera.name]
        views = tuple(view for view in corner_set.views if view.image in files)
        kept[camera.name] = replace(corner_set, views=views)
    return kept


def _rectify(result: RigResult, second: int, both: list[Path], names: list[str]) -> Shown:
    """Rectify a pair of photographs."""
    pair = rectify_pair(*relate_cameras(result.rig, 0, second))
    images = [
        cast(Pixels, rectify_stereo_image(read_colour(path), pair, which).image)
        for which, path in enumerate(both)
    ]
    return images, names, 1 if pair.is_upright else 2

"""The page on which photographs are taken live: the camera tells which is wanted next.

A job reads the cameras and looks at their frames; a timer shows the newest ones, so that the images
go on while a picture is calibrated. What was taken is on the disk at once. One camera's pictures
become a project, those of several a rig.
"""

from __future__ import annotations

import math
from contextlib import closing
from datetime import datetime
from pathlib import Path
from typing import NamedTuple

from PySide6.QtCore import QStandardPaths, Qt, QTimer, Signal
from PySide6.QtGui import QColor, QHideEvent, QKeySequence, QPainter, QPaintEvent, QShortcut
from PySide6.QtWidgets import (
    QApplication,
    QCheckBox,
    QComboBox,
    QFileDialog,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QProgressBar,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from calibgui.app.photographs.recording import (
    BoardFinder,
    CaptureProgress,
    RecordedInstant,
    Recorder,
    begin_session,
    check_recording_folder,
    open_cameras,
)
from calibgui.dataset import DEFAULT_SQUARE
from calibgui.engine.capture import (
    CameraSettings,
    JointSession,
    PairedFrames,
)
from calibgui.engine.errors import CalibrationError
from calibgui.engine.numbers import format_two_digits
from calibgui.gui.jobs.job import Job
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.live.live_views import LiveViews
from calibgui.gui.live.progress_figure import ProgressFigure
from calibgui.gui.live.source_list import SourceList
from calibgui.gui.live.taken_strip import TakenStrip
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button, Kind
from calibgui.gui.widgets.elided import ElidedLabel
from calibgui.gui.widgets.kept_settings import keep, read_kept_text
from calibgui.gui.widgets.number_box import NumberBox
from calibgui.gui.widgets.wrapped_label import WrappedLabel

_SIDE = 340
"""Width of what stands at the right, device-independent px."""
_LIMIT = 0.1
"""Uncertainty of the worst pixel that is asked for unless another is stated, px."""
_FRAME = 33
"""Time between two looks for a new image, ms."""
_SIZES = ((640, 480), (1280, 720), (1920, 1080), (3840, 2160))
"""Sizes of images that are offered, px."""
_AS_IT_IS = -1000.0
"""Number below all exposures and focuses, at which a camera stays as it is."""
_SOUND = "capture/sound"
_SILENT = "silent"


class _Seen(NamedTuple):
    """An instant that was looked at, as the job tells of it."""

    recorded: RecordedInstant
    progress: CaptureProgress
    """The progress of the camera whose wanted view is followed."""
    absent: list[str]
    """Sentences on cameras that send nothing, or images of another size."""


class LivePage(QWidget):
    """Begin, photograph, and calibrate with what was taken.

    Args:
        jobs: that look at the frames.
    """

    pictures_wanted = Signal(list)
    """The pictures in these files are to be calibrated from."""
    rig_wanted = Signal(str, list)
    """The rig whose pictures are in this folder is to be calibrated, without those at these
    instants."""
    left = Signal()

    def __init__(self, jobs: Jobs) -> None:
        super().__init__()
        self._jobs = jobs
        self._job: Job | None = None
        self.session: JointSession | None = None
        """The session that looks at the frames; None before the start."""
        self._recorder: Recorder | None = None
        self._frames: PairedFrames | None = None
        self._has_failed = False
        self._remark = ""
        """The lines that say how the cameras are set."""
        self.folder = Path()
        """The folder that the pictures are written to."""
        self.view, self.strip, self.figure = LiveViews(), TakenStrip(), ProgressFigure(_LIMIT)
        self._make_controls()
        self._lay_out()
        self._timer = QTimer(self, interval=_FRAME)
        self._timer.timeout.connect(self._show_newest)
        space = QShortcut(QKeySequence(Qt.Key.Key_Space), self)
        space.setContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)
        space.activated.connect(self._take)
        self.strip.toggle_wanted.connect(self._toggle)
        self.offer()

    def offer(self) -> None:
        """Offer to begin, with the cameras that there are now."""
        self.sources.offer()
        self.folder = _name_folder()
        self._show_folder()
        self.session = self._recorder = None
        self.strip.clear()
        self.strip.hide()
        self.figure.show_progress(None)
        self.view.begin([""])
        self.view.show_words(self.tr("Choose a camera, and press Start."))
        self._stack.setCurrentIndex(0)
        self._show_buttons()

    @property
    def is_running(self) -> bool:
        """Return whether a camera is open."""
        return self._job is not None

    def stop(self) -> None:
        """End the capture, and release the camera; what was taken stays."""
        if self._job is not None:
            self._job.stop()
            if self._frames is not None:
                self._frames.stop()

    def _make_controls(self) -> None:
        self.sources = SourceList()
        self.image_size = QComboBox()
        self.image_size.addItem(self.tr("as the camera has it"), None)
        for width, height in _SIZES:
            self.image_size.addItem(self.tr("{0} × {1} px").format(width, height), (width, height))
        self.exposure, self.focus = self._make_wish(), self._make_wish()
        for wish, name in (
            (self.exposure, self.tr("Exposure, the same in all pictures")),
            (self.focus, self.tr("Focus, the same in all pictures")),
        ):
            wish.setAccessibleName(name)
            wish.setToolTip(
                self.tr("{0}, in the camera's own unit, of a camera at this computer").format(name)
            )
        self.limit = NumberBox()
        self.limit.setRange(0.01, 10.0)
        self.limit.setSingleStep(0.05)
        self.limit.setValue(_LIMIT)
        self.limit.setSuffix(self.tr(" px"))
        self.limit.setToolTip(
            self.tr("It ends when the camera puts no pixel farther off, one standard deviation")
        )
        self.place, self.choose = ElidedLabel(), Button(self.tr("Choose…"))
        self.choose.clicked.connect(self._choose_folder)
        self.sound = QCheckBox(self.tr("A &sound for each picture"))
        self.sound.setChecked(read_kept_text(_SOUND) != _SILENT)
        self.sound.toggled.connect(lambda on: keep(_SOUND, "" if on else _SILENT))
        self.start, self.take = Button(self.tr("&Start"), Kind.MAIN), Button()
        self.take.setText(self.tr("&Take it now (space)"))
        self.finish = Button(self.tr("&Finish"))
        self.calibrate = Button(self.tr("&Calibrate with these"), Kind.MAIN)
        self.go_on, self.leave = Button(self.tr("&Go on")), Button(self.tr("&Leave"))
        self.match = QProgressBar()
        self.match.setRange(0, 100)
        self.match.setFormat(self.tr("%p % of the way to the yellow place"))
        self.words = WrappedLabel()
        for button, run in (
            (self.start, self._begin),
            (self.take, self._take),
            (self.finish, self.stop),
            (self.calibrate, self._hand_over),
            (self.go_on, self._go_on),
            (self.leave, self._leave),
        ):
            button.clicked.connect(run)

    def _make_wish(self) -> NumberBox:
        """Make a field for a setting that is the camera's own unless a number is typed in."""
        field = NumberBox()
        field.setDecimals(0)
        field.setRange(_AS_IT_IS, 100_000)
        field.setSpecialValueText(self.tr("as it is"))
        field.setValue(_AS_IT_IS)
        return field

    def _lay_out(self) -> None:
        form = QWidget()
        rows = QFormLayout(form)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapAllRows)
        rows.addRow(self.tr("Camera, address or folder"), self.sources)
        rows.addRow(self.tr("Size of its images"), self.image_size)
        wishes = QHBoxLayout()
        for label, wish in ((self.tr("Exposure"), self.exposure), (self.tr("Focus"), self.focus)):
            wishes.addWidget(QLabel(label))
            wishes.addWidget(wish, 1)
        rows.addRow(wishes)
        rows.addRow(self.tr("Until the worst pixel is known to"), self.limit)
        folder = QHBoxLayout()
        folder.addWidget(self.place, 1)
        folder.addWidget(self.choose)
        rows.addRow(self.tr("Pictures are written to"), folder)
        rows.addRow(
            WrappedLabel(
                self.tr(
                    "Hold the whole board in the picture: its kind and size are found. The yellow "
                    "shape shows where it is wanted next. When it is still, sharp and worth it, "
                    "the picture is taken by itself; every fifth one is put aside to check the "
                    "camera with. No board at hand? Calibration › Print a board shows one on a "
                    "screen."
                )
            )
        )
        live = QWidget()
        column = QVBoxLayout(live)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(theme.SPACING)
        column.addWidget(self.figure)
        column.addWidget(self.match)
        column.addWidget(self.words)
        column.addStretch(1)
        self._stack = QStackedWidget()
        self._stack.addWidget(form)
        self._stack.addWidget(live)
        title = QLabel(self.tr("Photograph live"))
        title.setFont(theme.make_font(theme.HEADLINE, bold=True))
        side = QWidget()
        side.setFixedWidth(_SIDE)
        beside = QVBoxLayout(side)
        beside.setContentsMargins(theme.MARGIN, 12, theme.MARGIN, 12)
        beside.setSpacing(12)
        beside.addWidget(title)
        beside.addWidget(self._stack, 1)
        beside.addWidget(self.sound)
        for pair in ((self.start, self.calibrate), (self.take, self.finish, self.go_on)):
            row = QHBoxLayout()
            for button in pair:
                row.addWidget(button)
            if self.start in pair:
                row.addStretch(1)
                row.addWidget(self.leave)
            else:
                row.addStretch(1)
            beside.addLayout(row)
        whole = QHBoxLayout(self)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.setSpacing(0)
        whole.addWidget(self.strip)
        whole.addWidget(self.view, 1)
        whole.addWidget(side)

    def _begin(self) -> None:
        """Begin a capture as the form says."""
        try:
            check_recording_folder(self.folder)
        except CalibrationError as error:
            self.view.show_words(f"{error.message} {self.tr('Choose another one.')}")
            return
        self.figure.limit = self.limit.value()
        finder, count = BoardFinder(None, None), len(self.sources.boxes)
        self.session = begin_session(count, finder, DEFAULT_SQUARE, self.figure.limit)
        self._recorder = Recorder(self.session, self.folder)
        self.words.setText("")
        self._record()

    def _go_on(self) -> None:
        """Take more pictures; of a camera that is known as well as was asked for, more is asked."""
        if (session := self.session) is not None:
            if session.is_complete:
                self.figure.limit = session.worst / 2
                session.state_limit(self.figure.limit)
            self._record()

    def _record(self) -> None:
        """Open the source, and look at its frames beside the window."""
        recorder, session, names = self._recorder, self.session, self.sources.list_names()
        assert recorder is not None
        assert session is not None

        wanted = CameraSettings(
            self.image_size.currentData(), _read_wish(self.exposure), _read_wish(self.focus)
        )

        def work(job: Job) -> None:
            with closing(open_cameras(names, math.inf, wanted)) as frames:
                self._frames, self._remark = frames, frames.remark
                for recorded in recorder.record(frames, lambda: job.stopping):
                    progress = recorder.measure_progress(recorded.state.leading)
                    job.send(_Seen(recorded, progress, recorder.describe_absent(frames)))

        self.view.begin(session.names)
        self.view.show_words(self.tr("Opening…"))
        self.strip.show()
        self._stack.setCurrentIndex(1)
        self._job = self._jobs.start(
            "",
            work,
            received=self._show_seen,
            failed=self._show_failure,
            ended=self._end,
            is_about_document=False,
            owner=self,
        )
        self._timer.start()
        self._show_buttons()
        self.view.setFocus()

    def _show_newest(self) -> None:
        """Show the newest images, where there are others."""
        if self._frames is not None:
            self.view.show_frames([camera.newest for camera in self._frames.cameras])

    def _show_seen(self, seen: _Seen) -> None:
        state, files = seen.recorded.state, seen.recorded.files
        self.view.show_state(state)
        leading = state.cameras[state.leading]
        self.match.setValue(round(100 * leading.match) if leading is not None else 0)
        self.match.setVisible(leading is not None and leading.goal is not None)
        if files:
            taken = [picture for picture in state.taken if picture is not None]
            self.strip.add(files[0], taken[0])
            if self.sound.isChecked():
                QApplication.beep()
        self.figure.show_progress(seen.progress)
        self._describe(seen)

    def _describe(self, seen: _Seen) -> None:
        """Say how the cameras are set, what is wrong with them, and what they tell by now."""
        progress = seen.progress
        said = [each for each in (self._remark, *seen.absent, *progress.remarks) if each]
        if progress.unseen_corners:
            text = self.tr("Pictures put aside are predicted to {0} px rms ({1} corners).").format(
                format_two_digits(progress.unseen_error), progress.unseen_corners
            )
            said.append(text)
        self.words.setText("\n".join(said))

    def _show_failure(self, error: Exception) -> None:
        self._has_failed = True
        if isinstance(error, CalibrationError):
            self.view.show_words(f"{error.message} {error.hint}")
        else:
            self._jobs.failed.emit(error)

    def _end(self) -> None:
        """The source is released: say what was reached, or why nothing was."""
        session, self._job, self._frames = self.session, None, None
        self._timer.stop()
        has_failed, self._has_failed = self._has_failed, False
        if session is None or not session.instants:
            self._stack.setCurrentIndex(0)
            if not has_failed:
                self.view.show_words(self.tr("Nothing was taken."))
        elif not has_failed:
            self.view.show_words(
                self.tr("Done: known well enough.")
                if session.is_complete
                else self.tr("Stopped. More pictures would help.")
            )
        self._show_buttons()

    def _show_buttons(self) -> None:
        running = self.is_running
        has_pictures = self.session is not None and bool(self.session.instants)
        for button, shown in (
            (self.start, not running and not has_pictures),
            (self.calibrate, not running and has_pictures),
            (self.go_on, not running and has_pictures),
            (self.take, running),
            (self.finish, running),
        ):
            button.setVisible(shown)
        self.match.setVisible(False)

    def _take(self) -> None:
        if self.is_running and self._recorder is not None:
            self._recorder.ask_for_picture()

    def _hand_over(self) -> None:
        """Let the pictures be calibrated from."""
        assert self.session is not None
        if len(self.session.names) > 1:
            self.rig_wanted.emit(str(self.folder), self.strip.list_taken_back())
        else:
            self.pictures_wanted.emit(self.strip.list_files())

    def _toggle(self, file: Path) -> None:
        if self._recorder is not None:
            self._recorder.ask_to_toggle(file)

    def _choose_folder(self) -> None:
        folder = QFileDialog.getExistingDirectory(self, self.tr("Folder for the pictures"))
        if folder:
            self.folder = Path(folder)
            self._show_folder()

    def _show_folder(self) -> None:
        self.place.setText(str(self.folder))
        self.place.setToolTip(str(self.folder))

    def _leave(self) -> None:
        self.stop()
        self.left.emit()

    def hideEvent(self, event: QHideEvent) -> None:  # noqa: N802 - Qt's name
        super().hideEvent(event)
        if not event.spontaneous():  # the window may only be minimised
            self.stop()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        QPainter(self).fillRect(self.rect(), QColor(theme.current().base))


def _read_wish(field: NumberBox) -> float | None:
    """Read what is wanted of a setting; None if nothing is."""
    return None if field.value() == _AS_IT_IS else field.value()


def _name_folder() -> Path:
    """Name a new folder for pictures, where people keep theirs."""
    place = QStandardPaths.writableLocation(QStandardPaths.StandardLocation.PicturesLocation)
    now = datetime.now().astimezone()
    return Path(place) / "calibgui" / f"{now:%Y-%m-%d %H-%M-%S}"

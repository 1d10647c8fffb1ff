"""The pages that take the window for themselves until they are left: live photographs, and rigs."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QStackedWidget

from calibgui.app.rig.camera_names import find_named_cameras
from calibgui.app.rig.frames import find_videos
from calibgui.engine.errors import CalibrationError
from calibgui.formats.origin import RIG, is_own
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.widgets import questions
from calibgui.gui.widgets.questions import Answer

if TYPE_CHECKING:
    from calibgui.gui.live.live_page import LivePage
    from calibgui.gui.rig.rig_page import RigPage


class OwnPages(QObject):
    """Makes these pages when they are first wanted.

    Args:
        desk: the pages of the window, which these join.
        jobs: that do their work.
    """

    shown = Signal()
    """One of them takes the window."""
    left = Signal()
    pictures_taken = Signal(list)
    """The photographs in these files are to be calibrated from."""

    def __init__(self, desk: QStackedWidget, jobs: Jobs) -> None:
        super().__init__(desk)
        self._desk, self._jobs = desk, jobs
        self.live: LivePage | None = None
        self.rig: RigPage | None = None

    def photograph_live(self) -> None:
        """Show the page on which a camera takes the photographs."""
        if self.live is None:
            from calibgui.gui.live.live_page import LivePage

            self.live = LivePage(self._jobs)
            self.live.pictures_wanted.connect(self.pictures_taken)
            self.live.rig_wanted.connect(lambda folder, without: self.show_rig([folder], without))
            self._add(self.live)
        if self._desk.currentWidget() is not self.live:
            self.live.offer()
        self._show(self.live)

    def show_rig(self, names: Sequence[str] = (), without: Collection[str] = ()) -> None:
        """Show the page of several cameras, with these folders, without photographs of some names,
        or with this saved rig."""
        if self.rig is None:
            from calibgui.gui.rig.rig_page import RigPage

            self.rig = RigPage(self._jobs)
            self._add(self.rig)
        self._show(self.rig)
        if len(names) == 1 and Path(names[0]).is_file():
            self.rig.open_rig(Path(names[0]))
        elif names:
            self.rig.open_folders(names, without)

    def are_of_rig(self, names: Sequence[str]) -> bool:
        """Return whether what was dropped is of several cameras; ask if it may be."""
        if self.rig is not None and self._desk.currentWidget() is self.rig:
            return True
        if len(names) == 1 and Path(names[0]).is_file() and is_own(names[0], RIG):
            return True
        if _are_named_after_cameras(names):
            return True
        are_folders = all(Path(name).is_dir() for name in names)
        if len(names) < 2 or not (are_folders or find_videos(names)):
            return False
        answer = questions.ask(
            self._desk,
            self.tr("Several cameras"),
            self.tr(
                "Are these the photographs of several cameras that stand fast to each other, a "
                "folder or a video for each? No: all are of one camera."
            ),
            Answer.Yes | Answer.No,
            Answer.No,
        )
        return answer == Answer.Yes

    def _add(self, page: LivePage | RigPage) -> None:
        page.left.connect(self.left)
        self._desk.addWidget(page)

    def _show(self, page: LivePage | RigPage) -> None:
        self.shown.emit()
        self._desk.setCurrentWidget(page)


def _are_named_after_cameras(names: Sequence[str]) -> bool:
    """Return whether names are of one folder, or of files, whose names tell several cameras."""
    are_files = all(Path(name).is_file() for name in names)
    if not are_files and len(names) > 1:
        return False
    try:
        return bool(find_named_cameras(names))
    except CalibrationError:  # whoever reads them says what is wrong
        return False

"""Offers in the banner: to put right what is not as it was left."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import partial
from pathlib import Path

from PySide6.QtCore import QFileInfo, QLocale, QObject

from calibgui.app.photographs.other_board import OtherBoard, find_other_board, read_marks
from calibgui.app.photographs.paths import NoImagesError, is_remote
from calibgui.app.projects.autosave import find_unsaved_work, read_unsaved_work
from calibgui.app.projects.document import Document
from calibgui.app.projects.project import Project, hold_known, set_grid_size, take_pattern
from calibgui.dataset import ViewStatus
from calibgui.engine.arrays import GridSize
from calibgui.engine.boards import CHECKERBOARD, Pattern
from calibgui.engine.errors import CalibrationError
from calibgui.gui.dialogs.files import Files
from calibgui.gui.images.film_strip import FilmStrip
from calibgui.gui.jobs.job import Job
from calibgui.gui.session.calibrator import Calibrator
from calibgui.gui.session.detector import Detector
from calibgui.gui.session.session import Session
from calibgui.gui.widgets.pattern_texts import list_pattern_texts
from calibgui.gui.window.banner import Banner
from calibgui.report.names import shorten_name

_AFTER_FIRST_FIT = 400
"""Time after which marks are looked for, ms: the first calibration needs the processor before."""
_MAX_FOLDERS = 3
"""Number of folders that have a button of their own, at most: a message has one line of them."""


class Offers(QObject):
    """To recover unsaved work, to search changed images again, to locate missing ones, to open
    folders below one without images, and to search for another pattern that images show.

    The latter is done without asking where nobody has stated the pattern: once in a project, as
    whoever takes it back wants it otherwise.
    """

    def __init__(
        self,
        session: Session,
        detector: Detector,
        calibrator: Calibrator,
        files: Files,
        images: FilmStrip,
        banner: Banner,
    ) -> None:
        super().__init__(session)
        self._session, self._files = session, files
        self._detector, self._calibrator = detector, calibrator
        self._thumbnails, self._banner = images.thumbnails, banner
        files.recoverable.connect(self._offer_recovery)
        files.saver.discarded.connect(self._offer_to_bring_back)
        files.images_missing.connect(self._offer_relocation)
        files.images_elsewhere.connect(self._offer_folders)
        files.report_refused.connect(self._offer_calibration)
        images.thumbnails.found_altered.connect(self._offer_detection)
        images.search_wanted.connect(self._search_again)
        detector.finished.connect(self._look_for_another)
        self._offered: dict[str, Document] = {}
        """The documents that offers were made for."""
        self._others_offered: dict[str, Hashable] = {}
        """Offers of another board, and what was looked for when they were made."""
        session.changed.connect(self._withdraw)
        self._folders_offered: tuple[str, int] | None = None
        """An offer of folders, and the number of images in the project when it was made."""
        self._looking: Job | None = None
        self._looking_for: Hashable = None
        """What `_looking` depends on."""
        self._put_off: CalibrationError | None = None
        """A failure to show if `_looking` finds nothing."""
        self._marks_asked: tuple[Document, Hashable] | None = None
        """What was looked at for marks last: every fit ends a search, if of nothing new."""
        session.changed.connect(self._drop_look)
        self._looked_early: Document | None = None
        """The document in whose first photograph with a board marks were looked for."""
        self._taken: Document | None = None
        """The document whose pattern was found out and not stated."""
        session.changed.connect(self._look_early)

    def put_off(self, failure: BaseException) -> bool:
        """Keep a failure back while another board is looked for in photographs that show none of
        the stated one, which is the likely cause; return whether that is so."""
        usable = any(view.usable for view in self._session.project.views)
        if self._looking is None or usable or not isinstance(failure, CalibrationError):
            return False
        self._put_off = failure
        return True

    def _offer(self, text: str, choice: str, does: Callable[[], None]) -> None:
        """Offer something to do with the project that is open."""
        self._banner.show_text(text, {choice: does})
        self._offered[text] = self._session.document

    def _withdraw(self) -> None:
        """Withdraw offers that were made for another project, or for another board in it."""
        for text, document in list(self._offered.items()):
            if document is not self._session.document:
                del self._offered[text]
                self._banner.withdraw(text)
        for text, sought in list(self._others_offered.items()):
            if sought != self._get_sought():
                del self._others_offered[text]
                self._banner.withdraw(text)
        if self._folders_offered is not None:
            text, count = self._folders_offered
            if len(self._session.project.views) != count:  # others were opened instead
                self._folders_offered = None
                self._banner.withdraw(text)

    def _offer_folders(self, error: NoImagesError) -> None:
        """Offer the folders with images below one that has none itself."""
        counts = error.folders
        choices = {
            self._name_choice(folder): partial(self._files.open_paths, [str(folder)])
            for folder in list(counts)[:_MAX_FOLDERS]
        }
        if len(counts) > 1:
            text = self.tr("&All {0} images").format(sum(counts.values()))
            choices[text] = partial(self._files.open_paths, list(map(str, counts)))
        self._banner.show_text(error.message, choices)
        self._folders_offered = error.message, len(self._session.project.views)

    def _offer_calibration(self) -> None:
        """Offer to calibrate the camera that is held: there is a report on that only."""
        text = self.tr(
            "A report tells how a camera was calibrated, and this one is known from a file. "
            "Calibrate it from these photographs?"
        )
        self._offer(text, self.tr("C&alibrate it"), self._calibrate_held)

    def _calibrate_held(self) -> None:
        self._session.edit(self.tr("Calibrate again"), lambda p: hold_known(p, None))
        self._calibrator.calibrate()

    def _name_choice(self, folder: Path) -> str:
        """Return the text of a button that opens a folder; a letter of a name is no shortcut."""
        return self.tr("Open {0}").format(shorten_name(folder.name).replace("&", "&&"))

    def _offer_recovery(self, path: Path) -> None:
        work = find_unsaved_work(path)
        if work is None:
            return
        if not path.is_file():
            self._offer_nameless(path, work)
            return
        self._show_recovery(
            path,
            self.tr(
                "The program ended without saving {0}. Its state of {1} has been kept. The "
                "project was saved {2}."
            ).format(path, _describe_time(work), _describe_time(path)),
        )

    def _offer_nameless(self, path: Path, work: Path) -> None:
        """Offer a project that had no file yet; its photographs tell which one it is."""
        time = _describe_time(work)

        def show(project: Project) -> None:
            folder = Path(project.views[0].image).parent if project.views else path.parent
            text = self.tr(
                "The program ended without saving a project of {0} photographs in {1}, which had "
                "no name yet. Its state of {2} has been kept."
            )
            self._show_recovery(path, text.format(len(project.views), folder, time))

        def show_time(_: Exception) -> None:
            text = self.tr(
                "The program ended without saving a project that had no name yet. Its state of {0} "
                "has been kept."
            )
            self._show_recovery(path, text.format(time))

        self._session.jobs.start(
            "", lambda _: read_unsaved_work(work, path), show, failed=show_time, owner=self
        )

    def _show_recovery(self, path: Path, text: str) -> None:
        self._banner.show_text(
            text,
            {
                self.tr("&Recover"): lambda: self._recover(path),
                self.tr("Go on &without"): lambda: self._files.saver.forget(path),
            },
        )

    def _offer_to_bring_back(self, path: Path, kept: Path) -> None:
        """Let the user think better of having given up the unsaved work on `path`."""
        self._banner.show_text(
            self.tr("The unsaved state is kept for a while, as {0}.").format(kept),
            {self.tr("&Bring it back"): lambda: self._bring_back(path, kept)},
        )

    def _bring_back(self, path: Path, kept: Path) -> None:
        if self._files.may_leave():
            self._files.saver.recover(path, kept)
        else:
            self._offer_to_bring_back(path, kept)

    def _recover(self, path: Path) -> None:
        if self._files.may_leave():
            self._files.saver.recover(path)
        else:
            self._offer_recovery(path)

    def _offer_detection(self, altered: list[str]) -> None:
        self._offer(
            self.tr(
                "{0} of {1} images changed since their corners were found, among them {2}."
            ).format(len(altered), len(self._session.project.views), altered[0]),
            self.tr("&Detect again"),
            lambda: self._search_again(altered),
        )

    def _offer_relocation(self, missing: list[str]) -> None:
        said = self.tr("{0} of {1} images are not where they were, among them {2}.")
        if is_remote(missing[0]):
            said = self.tr(
                "{0} of {1} images are at addresses, among them {2}. Download them, and locate the "
                "copies."
            )
        self._offer(
            said.format(len(missing), len(self._session.project.views), missing[0]),
            self.tr("&Locate…"),
            lambda: self._files.ask_for_moved(missing),
        )

    def _search_again(self, images: list[str]) -> None:
        """Search images anew, as their files are now."""
        self._detector.search_again(images)
        self._thumbnails.read_again(images)

    def _look_for_another(self, everything: bool) -> None:
        """Look for what else photographs show, after a search for a plain board or in vain."""
        project = self._session.project
        searched = [v for v in project.views if v.status in (ViewStatus.FOUND, ViewStatus.NO_BOARD)]
        if not everything or project.by_hand or not searched:
            return
        asked = self._session.document, self._get_question()
        if not any(v.usable for v in searched):
            look = lambda job: find_other_board(  # noqa: E731
                project.views, project.pattern, project.grid_size, job.cancelling
            )
        elif project.pattern == CHECKERBOARD and asked != self._marks_asked:
            self._marks_asked, look = asked, lambda _: read_marks(searched)
        else:
            return
        self._looking_for = self._get_question()
        self._looking = self._session.jobs.start(
            self.tr("Looking for another kind of board"),
            look,
            self._offer_another,
            inputs=self._get_question,
            ended=self._end_look,
            owner=self,
            delay=_AFTER_FIRST_FIT,
        )

    def _look_early(self) -> None:
        """Look for marks on the first board that is found: who stated no pattern need not wait for
        a plain one to be searched in all photographs."""
        session, project = self._session, self._session.project
        is_open = self._detector.running and project.pattern == CHECKERBOARD and not project.by_hand
        if not is_open or self._looked_early is session.document or project.results:
            return
        found = next((view for view in project.views if view.usable), None)
        if found is not None:
            self._looked_early = session.document
            session.jobs.start(
                "",
                lambda _: read_marks([found]),
                self._offer_another,
                inputs=self._get_sought,
                owner=self,
            )

    def _get_question(self) -> Hashable:
        """Return what a look for another board depends on: not on where the corners are, which a
        calibration locates anew."""
        found = tuple(
            (view.image, view.corners is not None) for view in self._session.project.views
        )
        return self._get_sought(), found

    def _get_sought(self) -> Hashable:
        """Return the board that is looked for."""
        project = self._session.project
        return project.pattern, project.grid_size

    def _offer_other(self, text: str, choice: str, edit: Callable[[], None]) -> None:
        """Offer to look for another board, until another one is looked for."""

        def search() -> None:
            edit()
            self._search_for_other()

        self._offer(text, choice, search)
        self._others_offered[text] = self._get_sought()

    def _drop_look(self) -> None:
        """End a look for another board whose question is no longer asked."""
        if self._looking is not None and self._get_question() != self._looking_for:
            self._put_off = None
            self._looking.cancel()

    def _end_look(self) -> None:
        failure, self._looking, self._put_off = self._put_off, None, None
        if failure is not None:
            self._banner.show_error(failure)

    def _offer_another(self, found: OtherBoard) -> None:
        if found != OtherBoard():
            self._put_off = None
        if found.grid_size is not None:
            self._offer_size(found.grid_size)
        elif found.is_mirrored:
            self._banner.show_text(
                self.tr(
                    "The photographs are mirrored, so that the marks on the board cannot be read. "
                    "Turn mirroring off in the camera or in its program, and take them again."
                )
            )
        elif found.pattern is not None:
            self._offer_pattern(found.pattern)

    def _offer_size(self, grid_size: GridSize) -> None:
        stated = self._session.project.grid_size
        assert stated is not None
        self._offer_other(
            self.tr(
                "A board of {0} × {1} inner corners is in no image; the images show {2} × {3}."
            ).format(*stated, *grid_size),
            self.tr("&Search for {0} × {1}").format(*grid_size),
            lambda: self._session.edit(
                self.tr("Number of corners"), lambda p: set_grid_size(p, grid_size)
            ),
        )

    def _offer_pattern(self, pattern: Pattern) -> None:
        """Search for another pattern, or offer to where one is stated or this was taken back."""
        session, texts = self._session, list_pattern_texts()[pattern.kind]

        def edit() -> None:
            session.edit(self.tr("Pattern"), partial(take_pattern, pattern=pattern))

        if session.project.pattern != CHECKERBOARD or self._taken is session.document:
            self._offer_other(texts.recognised, texts.search, edit)
            return
        self._taken = session.document
        edit()
        session.notified.emit(f"{texts.recognised} {self.tr('Undo goes back.')}")
        self._search_for_other()

    def _search_for_other(self) -> None:
        """Search for another board than before, and calibrate."""
        self._detector.search()  # also while the calibrator is at work
        self._calibrator.calibrate()


def _describe_time(path: Path) -> str:
    """Return the time when a file was written last, in the user's language."""
    time = QFileInfo(str(path)).lastModified()
    return QLocale().toString(time, QLocale.FormatType.ShortFormat)

"""The dialogs about files: open, add, save and export, with the questions that go with them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QFileDialog, QInputDialog, QLineEdit, QWidget

from calibgui.app.outputs.output_folder import ForeignFilesError
from calibgui.app.outputs.resampling import (
    Undistortion,
    WrittenImage,
    rectify_files,
    undistort_files,
)
from calibgui.app.photographs.paths import (
    NoImagesError,
    choose_images,
    describe_unread_folders,
    describe_unread_photographs,
)
from calibgui.app.projects.autosave import get_discarded_folder
from calibgui.app.projects.document import Document
from calibgui.app.projects.lengths import set_square
from calibgui.app.projects.moved_images import find_moved_images, list_missing_images
from calibgui.app.projects.project import (
    Project,
    add_images,
    relocate_images,
    remove_result,
    rename_result,
)
from calibgui.app.projects.project_file import is_project
from calibgui.app.projects.recent import remember_project
from calibgui.app.projects.result_project import make_project
from calibgui.app.rig.camera_names import find_named_cameras, list_cameras
from calibgui.app.system.resources import find_resource, find_sample_square
from calibgui.dataset import Result, find_orientation
from calibgui.engine.calibration import is_held
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import FORMATS, is_video, list_suffixes
from calibgui.gui.dialogs.known_cameras import is_camera_file, take_camera
from calibgui.gui.dialogs.videos import start_taking_frames
from calibgui.gui.jobs.job import Job
from calibgui.gui.session.calibrator import Calibrator
from calibgui.gui.session.detector import Detector
from calibgui.gui.session.saver import Saver
from calibgui.gui.session.session import Session, make_empty_document
from calibgui.gui.widgets import questions
from calibgui.gui.widgets.actions import show_dialog
from calibgui.gui.widgets.questions import Answer
from calibgui.gui.widgets.save_names import ask_for_name

_PROJECT = "calibgui.json"
_MAX_LISTED = 8
"""Number of files, at most, that a question or a message lists."""


class Files(QObject):
    """Dialogs over the saver; what fails is shown in the banner."""

    recoverable = Signal(Path)
    images_missing = Signal(list)
    images_elsewhere = Signal(NoImagesError)
    """A folder was opened that holds no images itself, but there are some below it."""
    report_refused = Signal()
    """A report is wanted on a camera that is known from a file, of which there is none."""

    def __init__(
        self, session: Session, detector: Detector, calibrator: Calibrator, window: QWidget
    ) -> None:
        super().__init__(session)
        self._session, self._window = session, window
        self._detector, self._calibrator = detector, calibrator
        self.saver = Saver(session)
        self.saver.recoverable.connect(self.recoverable)
        self.saver.opened.connect(self.check_images)

    @property
    def _place(self) -> str:
        """The folder to begin a choice of files in: the project's, or its images'."""
        file = self.file
        return str(file.parent) if file else ""

    @property
    def file(self) -> Path | None:
        """The file that is worked on: the project's, else its first image."""
        path, views = self._session.document.path, self._session.project.views
        return path or (Path(views[0].image) if views else None)

    def open_paths(self, names: Sequence[str]) -> None:
        """Open what was dropped, pasted or named on the command line: a project, images, videos.

        The camera of a file of this or another program is held, unless its name stands alone and is
        that of a project. Another file that ends in .json may be among images, but not be alone.
        """
        files = [Path(name) for name in names if name.lower().endswith(".json")]
        projects = files if len(names) == 1 else list(filter(is_project, files))
        cameras = [] if any(map(is_project, projects)) else list(filter(is_camera_file, names))
        if cameras:
            self.open_paths([name for name in names if name not in cameras])
            self._attempt(lambda: take_camera(self._session, *map(Path, cameras)))
        elif projects:
            self.open_project(projects[0])
            if len(names) > 1:
                self._session.notified.emit(
                    self.tr("Only the project {0} is opened, without the {1} other files.").format(
                        projects[0].name, len(names) - 1
                    )
                )
        elif names:
            try:
                videos = [Path(name) for name in names if Path(name).is_file() and is_video(name)]
                others = [name for name in names if Path(name) not in videos]
                if videos:
                    start_taking_frames(self._session, videos, self._add)
                if others:
                    self._add_images(others)
            except NoImagesError as error:
                (self.images_elsewhere if error.folders else self._session.failed).emit(error)
            except CalibrationError as error:
                self._session.failed.emit(error)

    def ask_for_camera(self) -> None:
        """Hold the camera of a file of the user's choice."""
        name, _ = QFileDialog.getOpenFileName(
            self._window, self.tr("Camera file"), self._place, self.tr("Camera files (*)")
        )
        if name:
            self._attempt(lambda: take_camera(self._session, Path(name)))

    def _add_images(self, names: Sequence[str]) -> None:
        """Add the images of files and folders, and remember a folder.

        Raises:
            CalibrationError: as `choose_images`.
        """
        images, others = choose_images(names)
        if len(names) == 1 and Path(names[0]).is_dir():
            folder, first = Path(names[0]), str(images[0])
            self._session.jobs.start("", lambda _: remember_project(folder, first))
        known = [Path(view.image) for view in self._session.project.views]
        self._add(images)
        refused = ""
        if others:
            listed = ", ".join(Path(name).name for name in others[:_MAX_LISTED])
            refused = self.tr("Not added, as no image can be read there: {0}.").format(
                listed if len(others) <= _MAX_LISTED else f"{listed}, …"
            )
            self._session.notified.emit(refused)

        def tell(unread: str) -> None:
            if unread:
                self._session.notified.emit(f"{refused}\n{unread}".strip())

        def describe_unread(_: object) -> str:
            groups = find_named_cameras(taken)
            rig = self.tr(
                "By their names these are photographs of several cameras: {0}. File › Several "
                "cameras calibrates each, and how they stand to each other."
            ).format(list_cameras(groups))
            said = describe_unread_folders(taken, known), describe_unread_photographs(taken)
            return "\n".join(filter(None, (*said, rig if groups else "")))

        taken = [name for name in names if name not in others]
        self._session.jobs.start("", describe_unread, tell)

    def paste(self) -> None:
        """Add the files or paths on the clipboard."""
        data = QGuiApplication.clipboard().mimeData()
        urls = [url.toLocalFile() for url in data.urls() if url.isLocalFile()]
        lines = [line.strip().strip('"') for line in data.text().splitlines()]
        self.open_paths(urls or [line for line in lines if line])

    def ask_for_folder(self) -> None:
        """Add the images of a folder."""
        folder = QFileDialog.getExistingDirectory(
            self._window, self.tr("Folder of images"), self._place
        )
        if folder:
            self.open_paths([folder])

    def ask_for_images(self) -> None:
        """Add single images."""
        kinds = " ".join(f"*{suffix}" for suffix in FORMATS + list_suffixes())
        names, _ = QFileDialog.getOpenFileNames(
            self._window,
            self.tr("Add images"),
            self._place,
            self.tr("Images ({0});;All files, also videos (*)").format(kinds),
        )
        self.open_paths(names)

    def open_sample(self) -> None:
        """Begin with the sample that comes with the program."""
        self._attempt(lambda: self.open_paths([str(find_resource("sample"))]))

    def new(self) -> None:
        """Begin with nothing."""
        if self.may_leave():
            self._session.begin(make_empty_document())

    def ask_for_project(self) -> None:
        """Open a project of the user's choice."""
        name, _ = QFileDialog.getOpenFileName(
            self._window, self.tr("Open project"), self._place, self.tr("Projects (*.json)")
        )
        if name:
            self.open_project(Path(name))

    def open_project(self, path: Path) -> None:
        """Open a project file."""
        if self.may_leave():
            self.saver.open(path)

    def open_result(self, path: Path, name: str) -> bool:
        """Begin a project with a result.json under a name; return whether the user allows it."""
        if not self.may_leave():
            return False

        def done(project: Project) -> None:
            self._session.begin(Document(project))
            self.check_images()

        self._session.jobs.start(
            self.tr("Opening {0}").format(name), lambda _: make_project(path, name), done
        )
        return True

    def save(self) -> None:
        """Save to the document's file, asking for one if it has none."""
        if (path := self._choose_file()) is not None:
            self.saver.save_beside(path)

    def save_as(self) -> None:
        """Save to a file of the user's choice."""
        if (path := self._ask_for_file()) is not None:
            self.saver.save_beside(path)

    def _choose_file(self) -> Path | None:
        """Return the file to save to: the document's, unless another program has written to it."""
        path = self._session.document.path
        if path is None or not self.saver.was_replaced:
            return path or self._ask_for_file()
        answer = questions.ask(
            self._window,
            self.tr("Replace the project"),
            self.tr(
                "{0} has been saved by another window or program since it was opened here. "
                "Replace what is there now?"
            ).format(path),
            Answer.Yes | Answer.SaveAll | Answer.Cancel,
            Answer.SaveAll,
        )
        if answer == Answer.SaveAll:
            return self._ask_for_file()
        return path if answer == Answer.Yes else None

    def _ask_for_file(self) -> Path | None:
        start = str(self._session.document.path or _PROJECT)
        return ask_for_name(
            self._window, self.tr("Save project"), start, self.tr("Projects (*.json)")
        )

    def may_leave(self) -> bool:
        """Return whether the document can be given up, being saved or not wanted."""
        if self._session.document.saved or not self._session.project.views:
            return True
        answer = questions.ask(
            self._window,
            self.tr("Unsaved changes"),
            self.tr("Save the changes to this project?")
            + "\n\n"
            + self.tr("What you discard is kept for a while in {0}.").format(
                get_discarded_folder()
            ),
            Answer.Save | Answer.Discard | Answer.Cancel,
            Answer.Save,
        )
        if answer == Answer.Save:
            path = self._choose_file()
            return path is not None and self._attempt(lambda: self.saver.save(path))
        return answer == Answer.Discard and self._may_give_up()

    def _may_give_up(self) -> bool:
        """Keep what is given up; ask where that is impossible, as on a full disk."""
        try:
            self.saver.give_up()
        except CalibrationError as error:
            answer = questions.ask(
                self._window,
                self.tr("Unsaved changes"),
                f"{error.message}\n\n" + self.tr("Discard the changes without a copy?"),
                Answer.Yes | Answer.No,
                Answer.No,
            )
            return answer == Answer.Yes
        return True

    def export(self) -> None:
        """Offer the shown result in every format."""
        from calibgui.gui.dialogs.export_dialog import ExportDialog

        if (result := self._session.result) is not None:
            age = self._session.describe_age(result)
            show_dialog(ExportDialog(self._session.jobs, result, self._window, age=age))

    def report(self) -> None:
        """Offer the report on the shown result."""
        from calibgui.gui.dialogs.report_dialog import ReportDialog

        result = self._session.result
        if result is not None and is_held(result.calibration):
            self.report_refused.emit()
        elif result is not None:
            age = self._session.describe_age(result)
            show_dialog(ReportDialog(self._session, result, self._window, age=age))

    def print_board(self) -> None:
        """Offer a board to print, like the project's."""
        from calibgui.gui.dialogs.print_dialog import PrintDialog

        show_dialog(PrintDialog(self._session.project.board, self._window))

    def check_images(self) -> None:
        """Announce images that are not where the project says."""
        project = self._session.project
        self._session.jobs.start(
            "",
            lambda _: list_missing_images(project),
            lambda missing: self.images_missing.emit(missing) if missing else None,
        )

    def ask_for_moved(self, missing: list[str]) -> None:
        """Find missing images in a folder of the user's choice."""
        folder = QFileDialog.getExistingDirectory(
            self._window, self.tr("Folder that holds the missing images"), self._place
        )
        if folder:
            self.find_moved(missing, Path(folder))

    def find_moved(self, missing: list[str], folder: Path) -> None:
        """Find missing images in `folder`."""
        digests = self._session.project.digests

        def done(moved: dict[str, str]) -> None:
            if moved:
                self._session.edit(self.tr("Relocate images"), lambda p: relocate_images(p, moved))
            self._session.notified.emit(
                self.tr("Found {0} of {1} missing images in {2}.").format(
                    len(moved), len(missing), folder
                )
            )

        self._session.jobs.start(
            self.tr("Looking for images"),
            lambda _: find_moved_images(missing, folder, digests),
            done,
        )

    def keep_work(self) -> None:
        """Write the unsaved state, because something went wrong."""
        self._attempt(self.saver.autosave_now)

    def rename_result(self, name: str) -> None:
        """Give a result another name."""
        new, ok = QInputDialog.getText(
            self._window,
            self.tr("Rename result"),
            self.tr("Name"),
            QLineEdit.EchoMode.Normal,
            name,
        )
        if ok and new.strip() and new != name and new not in self._session.project.results:
            self._session.edit(
                self.tr("Rename result"), lambda p: rename_result(p, name, new.strip())
            )
            self._session.show_result(new.strip())

    def delete_result(self, name: str) -> None:
        """Remove a result; undo brings it back."""
        self._session.edit(self.tr("Delete {0}").format(name), lambda p: remove_result(p, name))

    def _add(self, images: Iterable[Path]) -> None:
        """Add images and search them."""
        paths = [path.absolute() for path in images]
        square = find_sample_square(paths)

        def change(project: Project) -> Project:
            if square is not None and not project.views:
                project = set_square(project, square)
            return add_images(project, map(str, paths))

        self._session.edit(self.tr("Add images"), change)
        self.search()

    def search(self) -> None:
        """Search the images that wait; a project's first are calibrated as well."""
        if self._session.project.results or self._session.project.by_hand:
            self._detector.search()
        else:
            self._calibrator.calibrate()

    def save_changed_images(
        self, views: tuple[int, ...], undistortion: Undistortion | None
    ) -> None:
        """Write undistorted images, or rectified ones, to a folder of the user's choice."""
        result = self._session.result
        folder = QFileDialog.getExistingDirectory(
            self._window, self.tr("Folder for the images"), self._place
        )
        if result is not None and folder:
            images = [Path(result.views[k].image) for k in views]
            self._write_images(result, images, Path(folder), undistortion)

    def _write_images(
        self,
        result: Result,
        images: Sequence[Path],
        folder: Path,
        undistortion: Undistortion | None,
        overwrite: bool = False,
    ) -> None:
        """Write undistorted or rectified images; ask if they would replace others."""

        def work(job: Job) -> int:
            def progress(done: int, total: int, _: WrittenImage) -> None:
                job.advance(done, total)

            if undistortion is None:
                written = rectify_files(
                    result, images, folder, progress=progress, overwrite=overwrite
                )
            else:
                camera = result.calibration.camera
                orientation = find_orientation(result.used)
                written = undistort_files(
                    camera, images, folder, undistortion, progress, overwrite, orientation
                )
            return sum(len(image.paths) for image in written)

        def failed(error: Exception) -> None:
            if not isinstance(error, ForeignFilesError):
                self._session.failed.emit(error)
            elif self._may_replace(error, folder):
                self._write_images(result, images, folder, undistortion, overwrite=True)

        self._session.jobs.start(
            self.tr("Writing images"),
            work,
            lambda count: self._session.notified.emit(
                (
                    self.tr("Wrote {0} images to {1}.")
                    if count > 1
                    else self.tr("Wrote {0} image to {1}.")
                ).format(count, folder)
            ),
            failed=failed,
        )

    def _may_replace(self, error: ForeignFilesError, folder: Path) -> bool:
        """Ask whether files may be replaced that this program did not make."""
        listed = error.names[:_MAX_LISTED]
        names = "\n".join([*listed, "…"] if len(error.names) > len(listed) else listed)
        answer = questions.ask(
            self._window,
            self.tr("Replace files"),
            self.tr("In {0} there are files of these names, not written by this program:").format(
                folder
            )
            + f"\n\n{names}\n\n"
            + self.tr("Replace them?"),
            Answer.Yes | Answer.No,
            Answer.No,
        )
        return answer == Answer.Yes

    def _attempt(self, action: Callable[[], object]) -> bool:
        try:
            action()
        except CalibrationError as error:
            self._session.failed.emit(error)
            return False
        return True

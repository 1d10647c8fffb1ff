"""The main window: puts the parts together, and nothing else."""

from __future__ import annotations

from itertools import pairwise
from traceback import extract_tb
from typing import TYPE_CHECKING

import shiboken6
from PySide6.QtCore import QEvent, Qt, QTimer
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDragLeaveEvent, QDropEvent
from PySide6.QtWidgets import QMainWindow, QStackedWidget, QWidget

from calibgui.app.projects.recent import list_recent
from calibgui.dataset import Result
from calibgui.engine.calibration import Cost
from calibgui.engine.errors import CalibrationError
from calibgui.gui.canvas.image_page import ImagePage
from calibgui.gui.dialogs.files import Files
from calibgui.gui.images.film_strip import FilmStrip
from calibgui.gui.panels.modes import Mode, Page, describe_mode, name_mode
from calibgui.gui.session.calibrator import Calibrator
from calibgui.gui.session.detector import Detector
from calibgui.gui.session.refitter import Refitter
from calibgui.gui.session.session import Session
from calibgui.gui.settings.board_panel import BoardPanel
from calibgui.gui.settings.limits_choice import LimitsChoice
from calibgui.gui.settings.settings_panel import SettingsPanel
from calibgui.gui.verdict.check_sheet import CheckSheet
from calibgui.gui.verdict.verdict_bar import VerdictBar
from calibgui.gui.widgets.actions import show_dialog
from calibgui.gui.widgets.buttons import Button
from calibgui.gui.widgets.kept_settings import keep, read_kept_bytes
from calibgui.gui.widgets.layouts import make_column
from calibgui.gui.widgets.overlay import Overlay
from calibgui.gui.window.banner import Banner
from calibgui.gui.window.body import Body
from calibgui.gui.window.commands import Commands
from calibgui.gui.window.header import Header
from calibgui.gui.window.inspector import Inspector
from calibgui.gui.window.menus import Menus
from calibgui.gui.window.offers import Offers
from calibgui.gui.window.own_pages import OwnPages
from calibgui.gui.window.palette import Palette
from calibgui.gui.window.preparation import Preparation
from calibgui.gui.window.progress import Progress
from calibgui.gui.window.setup_sheet import SetupSheet
from calibgui.gui.window.tour import Parts, Tour
from calibgui.gui.window.welcome import Welcome

if TYPE_CHECKING:
    from calibgui.gui.panels.analysis import Analysis


class MainWindow(QMainWindow):
    """A bar of modes over the desk; below it the strip of all photographs, and the inspector.

    What a mode shows fills the desk: the selected photograph, or panels on the shown result.
    """

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("calibgui")
        self.setAcceptDrops(True)
        self.resize(1280, 720)
        self.session = Session(self)
        self.detector = Detector(self.session)
        self.calibrator = Calibrator(self.session, self.detector)
        self.files = Files(self.session, self.detector, self.calibrator, self)
        self.images = FilmStrip(self.session)
        self.page = ImagePage(self.session)
        self.board = BoardPanel(self.session)
        self.settings = SettingsPanel(self.session)
        self.settings.setParent(self)
        self.settings.hide()
        self.analysis: Analysis | None = None
        self._tour: Tour | None = None
        self._empty = True
        self._bugs: set[tuple[object, ...]] = set()
        """Bugs that were shown: what was raised, and where."""
        self._at = (self.session.document, 0)
        self.welcome = Welcome(self.session.jobs)
        self.pages = QStackedWidget()
        self.own_pages = OwnPages(self.pages, self.session.jobs)
        self.banner = Banner()
        # Over the picture: what one points at must not move when a message comes, which may say to
        # take a tool.
        Overlay(self.banner, self.pages, is_on_top=True, beside=self.page.bar)
        self.header = Header(self.session)
        self.verdict = VerdictBar(self.session, self.pages)
        self.setup = SetupSheet(self.pages, self.board, self.settings, LimitsChoice(self.session))
        self.check = CheckSheet(self.pages, self.session)
        self.progress = Progress(self.session.jobs)
        self.calibrate = Button(self.tr("C&alibrate"))
        self.calibrate.setToolTip(
            self.tr("Find the corners still missing, then estimate the camera")
        )
        self.calibrate.setDefault(True)
        self.inspector = Inspector(
            self.session, self.verdict, self.page, self.progress, self.calibrate
        )
        self.body = Body(self.pages, self.images, self.inspector)
        self.preparation = Preparation(self, self.session, self.images, self._build_next_panel)
        self._lay_out()
        self._connect()
        self._make_menus()
        self._show_parts(empty=True)
        self._refresh()
        self.files.saver.check_slot()

    def open_up(self) -> None:
        """Show the window as it was left; at first on most of the screen."""
        geometry = read_kept_bytes("geometry")
        if geometry is None or not self.restoreGeometry(geometry):
            room = self.screen().availableSize()
            self.resize(room * _SHARE_OF_SCREEN)
            if room.width() < _SMALL_SCREEN:
                self.setWindowState(Qt.WindowState.WindowMaximized)
        self.show()

    def _lay_out(self) -> None:
        self.pages.addWidget(self.welcome)
        self.pages.addWidget(self.page)
        centre = self._centre = QWidget()
        make_column(self.header, (self.body, 1), of=centre, spacing=0)
        self.setCentralWidget(centre)
        stops = (
            self.header.modes,
            self.page.canvas,
            self.images.list,
            self.images.exclude_above,
            self.verdict.button,
        )
        for before, after in pairwise(stops):
            self.setTabOrder(before, after)

    def _make_menus(self) -> None:
        commands = Commands(self, self.session, self.files, self.images, self.page)
        menus = Menus(
            self.menuBar(),
            commands.list_menus(
                self.calibrate.click,
                self.progress.end_shown,
                self.check.ask_for_photographs,
                self.close,
                self.body.leave_desk_alone,
                self._list_pages,
                lambda: show_dialog(Palette(menus, self)),
                self.take_tour,
                self.own_pages.photograph_live,
                self.own_pages.show_rig,
            ),
        )
        # Another result to be shown changes nothing here, unless the project has changed as well.
        self.session.changed.connect(lambda *_: menus.refresh())

    def _connect(self) -> None:
        self.session.changed.connect(self._refresh)
        self.session.failed.connect(self._show_failed_work)
        self.session.notified.connect(self.banner.show_text)
        self.session.withdrawn.connect(self.banner.withdraw)
        self.offers = Offers(
            self.session, self.detector, self.calibrator, self.files, self.images, self.banner
        )
        self.verdict.panel_wanted.connect(self._show_panel_named)
        self.images.list.addActions(self.page.tools)
        self.page.canvas.addAction(self.images.actions_for_menu[0])
        self.page.tool_changed.connect(self._follow_tool)
        self._connect_parts()
        refitter = Refitter(self.session, self.detector, self.calibrator)
        self.images.excluded.connect(
            lambda label: refitter.refit(label) if self.images.follows.isChecked() else None
        )
        self.board.search_wanted.connect(self.detector.search)
        self.settings.known.file_wanted.connect(self.files.ask_for_camera)
        self.calibrate.clicked.connect(self._calibrate)
        self.calibrator.began.connect(self._show_beginning)
        self.calibrator.advanced.connect(lambda step: self.need_analysis().show_iteration(step))
        self.calibrator.ended.connect(lambda: self.need_analysis().show_end())
        self.session.result_changed.connect(self._result_changed)
        for changed in (self.session.jobs.changed, self.calibrator.began, self.calibrator.ended):
            changed.connect(self._show_calibrate)
        self.files.saver.opened.connect(self.images.thumbnails.look_for_changes)
        self.own_pages.shown.connect(self._make_room)
        self.own_pages.left.connect(lambda: self._show_parts(self._empty))
        self.own_pages.pictures_taken.connect(self._take_pictures)
        self.welcome.folder_wanted.connect(self.files.ask_for_folder)
        self.welcome.images_wanted.connect(self.files.ask_for_images)
        self.welcome.camera_wanted.connect(self.own_pages.photograph_live)
        self.welcome.sample_wanted.connect(self.files.open_sample)
        self.welcome.tour_wanted.connect(self.take_tour)
        self.welcome.board_wanted.connect(self.files.print_board)
        self.welcome.recent_wanted.connect(lambda path: self.files.open_paths([str(path)]))

    def _connect_parts(self) -> None:
        """Connect the header and the inspector."""
        header, inspector = self.header, self.inspector
        header.modes.chosen.connect(self.show_mode)
        header.setup.toggled.connect(self.setup.setVisible)
        header.setup.toggled.connect(self.verdict.square.stand_aside)
        self.setup.closed.connect(lambda: header.setup.setChecked(False))
        header.report.clicked.connect(self.files.report)
        header.export.clicked.connect(self.files.export)
        header.grade.clicked.connect(self.body.show_inspector)
        self.verdict.shown.connect(header.show_grade)
        header.show_grade(None, self.verdict.headline.text())
        self.body.inspector_moved.connect(header.stand_in_for_inspector)
        inspector.done.panel_wanted.connect(self._show_panel_named)
        inspector.done.image_wanted.connect(self._show_photograph)
        camera = inspector.camera
        camera.all_wanted.connect(lambda: self._show_panel_named("ResultPanel"))
        camera.check_wanted.connect(self.check.ask_for_photographs)
        camera.compare_wanted.connect(lambda name: self.need_analysis().compare_with(name))
        camera.rename_wanted.connect(self.files.rename_result)
        camera.delete_wanted.connect(self.files.delete_result)

    def show_mode(self, mode: Mode) -> None:
        """Fill the desk with a mode."""
        self.header.modes.show_mode(mode)
        if mode is Mode.PHOTOGRAPHS:
            self.pages.setCurrentWidget(self.welcome if self._empty else self.page)
        elif not self._empty:
            self.page.marker.leave()
            analysis = self.need_analysis()
            analysis.show_mode(mode)
            self.pages.setCurrentWidget(analysis)

    def _bring_up(self, mode: Mode) -> None:
        """Show the mode of a panel that has come to the front by its name."""
        blocked = self.header.modes.blockSignals(True)
        self.header.modes.show_mode(mode)
        self.header.modes.blockSignals(blocked)
        if not self._empty:
            self.pages.setCurrentWidget(self.need_analysis())

    def _show_photograph(self, image: str = "") -> None:
        """Show a photograph, the selected one by default."""
        if image:
            self.session.select(image)
        self.show_mode(Mode.PHOTOGRAPHS)

    def _make_room(self) -> None:
        """Leave the desk to a page of its own."""
        self.body.show_parts(empty=True)
        self.header.show_modes(False)

    def _take_pictures(self, files: list[str]) -> None:
        """Calibrate from pictures that were taken live."""
        self._show_parts(self._empty)
        self.files.open_paths(files)

    def show_setup(self) -> None:
        """Open the sheet of the set-up."""
        self.header.setup.setChecked(True)

    def take_tour(self) -> None:
        """Point at one part after another; on the sample where there is no project."""
        if self._empty:
            self.files.open_sample()
        if self._tour is not None and shiboken6.isValid(self._tour):
            self._tour.leave()
        self._show_photograph()
        self.header.setup.setChecked(False)
        inspector, header = self.inspector, self.header
        parts = Parts(
            self.images,
            self.page.canvas,
            self.verdict,
            inspector.done,
            header.modes,
            header.setup,
            header.export,
            inspector.camera,
        )
        self._tour = Tour(self._centre, parts)

    def _list_pages(self) -> list[Page]:
        """Return what the window can show now."""
        if self._empty:
            return []
        pages = [
            Page(
                name_mode(Mode.PHOTOGRAPHS), describe_mode(Mode.PHOTOGRAPHS), self._show_photograph
            ),
            Page(self.tr("Set-up"), self.header.setup.toolTip(), self.show_setup),
        ]
        if self.session.result is not None:
            pages += self.need_analysis().list_pages()
        return pages

    def _show_panel_named(self, name: str) -> None:
        self.need_analysis().show_panel_named(name)

    def need_analysis(self) -> Analysis:
        """Return the panels, which are imported and made when there is something to show."""
        if self.analysis is None:
            from calibgui.gui.panels.analysis import Analysis

            self.analysis = Analysis(self.session)
            self.analysis.exclude_wanted.connect(self.images.exclude)
            self.analysis.save_wanted.connect(self.files.save_changed_images)
            self.analysis.lens_wanted.connect(self._calibrate_with_lens)
            self.analysis.method_wanted.connect(self._calibrate_with_method)
            self.analysis.mode_shown.connect(self._bring_up)
            self.analysis.corner_picked.connect(self._show_photograph)
            self.pages.addWidget(self.analysis)
        return self.analysis

    def _show_beginning(self) -> None:
        """Show that a calibration has begun, a frame after the panels were made, if they were."""
        if self.analysis is not None:
            self.analysis.show_beginning()
            return
        analysis = self.need_analysis()
        QTimer.singleShot(
            _FRAME, self, lambda: analysis.show_beginning() if self.calibrator.running else None
        )

    def _build_next_panel(self) -> bool:
        return self.analysis is not None and self.analysis.build_next()

    def _result_changed(self, result: Result | None) -> None:
        if result is not None and self.analysis is None:
            # A frame later, not in the same turn: what has been opened is on screen by then.
            QTimer.singleShot(_FRAME, self, self.need_analysis)

    def _show_failed_work(self, error: Exception) -> None:
        """Show why work has ended without a result: also a bug whose dialog was shown before."""
        if self.offers.put_off(error):
            return
        if not self.show_failure(error):
            self.banner.show_error(
                CalibrationError(
                    self.tr("The program has met an error again: {0}.").format(error),
                    self.tr("Save the project, and start the program anew."),
                )
            )

    def show_failure(self, error: BaseException) -> bool:
        """Show what cannot be done in the banner, and a bug in a dialog, each bug once.

        One in what is painted would come back as soon as its dialog is closed. Return whether the
        failure was shown.
        """
        if isinstance(error, CalibrationError):
            self.banner.show_error(error)
            return True
        place = type(error), *[frame[:2] for frame in extract_tb(error.__traceback__)[-1:]]
        if place in self._bugs:
            return False
        self._bugs.add(place)
        self.files.keep_work()
        from calibgui.gui.dialogs.bug_dialog import BugDialog

        show_dialog(BugDialog(error, self))
        return True

    def _refresh(self) -> None:
        document = self.session.document
        if (document, document.edits) != self._at:
            self._at = (document, document.edits)
            self.banner.hide_failure()
        empty = not self.session.project.views
        if empty is not self._empty:
            self._show_parts(empty)
        name = document.path.name if document.path else self.tr("Untitled")
        self.setWindowTitle(f"{name}[*]")
        self.setWindowModified(not document.saved)
        self.setWindowFilePath(str(self.files.file or ""))
        self._show_calibrate()

    def _show_parts(self, empty: bool) -> None:
        """Show the welcome page alone while there are no images, and all parts otherwise."""
        self._empty = empty
        if empty:
            self.welcome.show_recent(list_recent())
            self.header.setup.setChecked(False)
        self.body.show_parts(empty=empty)
        self.header.show_modes(not empty)
        self.show_mode(Mode.PHOTOGRAPHS)

    def _follow_tool(self, taken: bool) -> None:
        if taken:
            self.show_mode(Mode.PHOTOGRAPHS)
            self.body.show_inspector()  # what the tool says stands there
            self.banner.hide_failure()  # it would cover corners

    def _show_calibrate(self) -> None:
        running = self.calibrator.running
        self.verdict.show_running(running, self.calibrator.waiting)
        self.calibrate.setEnabled(bool(self.session.project.views) and not running)
        for button in (self.header.report, self.header.export):
            button.setEnabled(self.session.result is not None)

    def _calibrate(self) -> None:
        self.board.finish_typing()  # a shortcut does not take the focus from a box
        self.calibrator.calibrate()

    def _calibrate_with_lens(self, model: str, held: tuple[str, ...]) -> None:
        """Calibrate with another lens model, some of its coefficients held."""
        self.settings.choose_model(model, held)
        self.calibrator.calibrate()

    def _calibrate_with_method(self, method: str, cost: Cost) -> None:
        """Calibrate with another method, which minimises a cost."""
        self.settings.choose_method(method, cost)
        self.calibrator.calibrate()

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:  # noqa: N802 - Qt's name
        if event.mimeData().hasUrls():
            _accept_copy(event)
            self.inspector.invite(self.session.result is not None)

    def dragLeaveEvent(self, event: QDragLeaveEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        self.inspector.invite(False)

    def dropEvent(self, event: QDropEvent) -> None:  # noqa: N802 - Qt's name
        urls = event.mimeData().urls()
        names = [url.toLocalFile() for url in urls if url.isLocalFile()]
        checks = self.inspector.is_inviting_at(self.mapToGlobal(event.position().toPoint()))
        self.inspector.invite(False)
        if checks:
            self.check.check(names)
        elif self.own_pages.are_of_rig(names):
            self.own_pages.show_rig(names)
        else:
            self.files.open_paths(names)
        _accept_copy(event)

    def changeEvent(self, event: QEvent) -> None:  # noqa: N802 - Qt's name
        super().changeEvent(event)
        if event.type() == QEvent.Type.ActivationChange and self.isActiveWindow():
            self.images.thumbnails.look_for_changes()

    def closeEvent(self, event: QCloseEvent) -> None:  # noqa: N802 - Qt's name
        if not self.files.may_leave():
            event.ignore()
            return
        keep("geometry", self.saveGeometry())
        self.session.jobs.close()
        self.files.saver.close()
        event.accept()


def _accept_copy(event: QDropEvent) -> None:
    """Accept dropped files as copies: a program that moves files might delete the originals."""
    event.setDropAction(Qt.DropAction.CopyAction)
    event.accept()


_FRAME = 16
"""Time between two pictures on the screen, ms."""
_SHARE_OF_SCREEN = 0.8
_SMALL_SCREEN = 1600
"""Width of a screen below which the window fills it, px."""

"""The window: puts the parts together, and nothing else."""

from __future__ import annotations

import gc
from importlib import import_module
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QSettings, Qt, QTimer
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import (
    QDockWidget,
    QLabel,
    QMainWindow,
    QPushButton,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from calibgui.app.recent import recent_projects
from calibgui.dataset.result import Result
from calibgui.engine.errors import CalibrationError
from calibgui.engine.kernels import COMPILED
from calibgui.gui import qt_names, theme
from calibgui.gui.actions import show_dialog
from calibgui.gui.banner import Banner
from calibgui.gui.board_panel import TargetPanel
from calibgui.gui.bug_dialog import BugDialog
from calibgui.gui.calibrating import Calibrator
from calibgui.gui.detecting import Detector
from calibgui.gui.dock import Dock
from calibgui.gui.files import Files
from calibgui.gui.image_list import ImageList
from calibgui.gui.image_page import ImagePage
from calibgui.gui.menus import Menus
from calibgui.gui.offers import Offers
from calibgui.gui.page_tabs import PageTabs
from calibgui.gui.progress import Progress
from calibgui.gui.session import Session
from calibgui.gui.settings_panel import SettingsPanel
from calibgui.gui.welcome import Welcome

if TYPE_CHECKING:
    from calibgui.gui.analysis import Analysis


class MainWindow(QMainWindow):
    """Images on the left, the selected one in the middle, what it all means on the right."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("calibgui")
        self.setDockNestingEnabled(True)
        self.setAcceptDrops(True)
        self.resize(1280, 720)
        self.session = Session(self)
        self.detector = Detector(self.session)
        self.calibrator = Calibrator(self.session, self.detector)
        self.files = Files(self.session, self.detector, self.calibrator, self)
        self.images = ImageList(self.session)
        self.page = ImagePage(self.session)
        self.board = TargetPanel(self.session)
        self.settings = SettingsPanel(self.session)
        self.analysis: Analysis | None = None
        self._empty = True
        self._at = (self.session.document, 0)
        self.welcome = Welcome()
        self.banner = Banner()
        self.calibrate = QPushButton()
        self.calibrate.setMinimumHeight(36)
        self.calibrate.setDefault(True)
        self._lay_out()
        self._connect()
        Menus(self)
        self._show_parts(empty=True)
        self._refresh()
        self.files.saver.check_slot()

    def open_up(self) -> None:
        """Show it as it was left; the first time on most of the screen, or all of a small one."""
        if geometry := QSettings().value("geometry"):
            self.restoreGeometry(geometry)
        else:
            room = self.screen().availableSize()
            self.resize(room * _SHARE_OF_SCREEN)
            if room.width() < _SMALL_SCREEN:
                self.setWindowState(Qt.WindowState.WindowMaximized)
        self.show()

    def _lay_out(self) -> None:
        self.pages = QStackedWidget()
        self.pages.addWidget(self.welcome)
        self.pages.addWidget(self.page)
        middle = QWidget()
        column = QVBoxLayout(middle)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.banner)
        column.addWidget(self.pages, 1)
        self.setCentralWidget(middle)

        how = PageTabs()
        how.add(self.board, self.tr("Board"))
        how.add(self.settings, self.tr("Settings"))
        left = QWidget()
        column = QVBoxLayout(left)
        column.setContentsMargins(theme.SPACING, 0, 0, theme.SPACING)
        column.addWidget(self.images, 1)
        column.addWidget(how)
        column.addWidget(self.calibrate)
        self.image_dock = self._dock(self.tr("Images"), "images", left, _LEFT)
        nothing = QLabel(self.tr("Nothing is calibrated yet."))
        nothing.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.analysis_dock = self._dock(self.tr("Results"), "results", nothing, _RIGHT)
        self.place = QLabel()
        self.place.setFont(theme.fixed_font())
        self.place.setContentsMargins(0, 0, theme.SPACING, 0)
        self.statusBar().addPermanentWidget(self.place)
        self.statusBar().addPermanentWidget(Progress(self.session.jobs))

    def _dock(self, title: str, name: str, widget: QWidget, area: Qt.DockWidgetArea) -> QDockWidget:
        dock = Dock(title, name, widget, self)
        self.addDockWidget(area, dock)
        return dock

    def _connect(self) -> None:
        self.session.changed.connect(self._refresh)
        self.session.failed.connect(self.show_failure)
        self.session.told.connect(self.banner.show_text)
        Offers(self.session, self.detector, self.files, self.images, self.banner)
        self.page.place.connect(self.place.setText)
        self.images.list.addActions(self.page.tools)
        self.board.search_wanted.connect(self.detector.search)
        self.calibrate.clicked.connect(self._calibrate_or_stop)
        self.calibrator.began.connect(lambda: self.need_analysis().began())
        self.calibrator.advanced.connect(lambda step: self.need_analysis().advanced(step))
        self.calibrator.ended.connect(lambda: self.need_analysis().ended())
        self.session.result_changed.connect(self._result_changed)
        for changed in (self.session.jobs.changed, self.calibrator.began, self.calibrator.ended):
            changed.connect(self._show_calibrate)
        self.files.saver.opened.connect(self.images.thumbnails.look_for_changes)
        self.board.print_wanted.connect(self.files.print_board)
        self.welcome.folder_wanted.connect(self.files.ask_for_folder)
        self.welcome.images_wanted.connect(self.files.ask_for_images)
        self.welcome.sample_wanted.connect(self.files.open_sample)
        self.welcome.board_wanted.connect(self.files.print_board)
        self.welcome.project_wanted.connect(self.files.open_project)

    def need_analysis(self) -> Analysis:
        """The panels: they and what they import are left until there is something to show."""
        if self.analysis is None:
            from calibgui.gui.analysis import Analysis

            self.analysis = Analysis(self.session)
            self.analysis.excluded.connect(self.images.exclude)
            self.analysis.saving.connect(self.files.save_changed_images)
            self.analysis.rename_wanted.connect(self.files.rename_result)
            self.analysis.delete_wanted.connect(self.files.delete_result)
            self.analysis_dock.setWidget(self.analysis)
        return self.analysis

    def prepare(self) -> None:
        """Import beside the main thread what will be needed: SciPy, the panels, the solver.

        What is there by then stays: going through it at every full collection of garbage would
        stop the window for longer than a frame.
        """

        def load() -> None:
            if self.isVisible():  # it may have been closed meanwhile
                self.session.jobs.start(
                    "", lambda _: list(map(import_module, _NEEDED_SOON)), lambda _: gc.freeze()
                )

        qt_names.resolve(self, load)

    def _result_changed(self, result: Result | None) -> None:
        if result is not None and self.analysis is None:
            # A frame later, not in the same turn: what has been opened is on screen by then.
            QTimer.singleShot(_FRAME, self, self.need_analysis)

    def show_failure(self, error: BaseException) -> None:
        """Say what cannot be done; report what should not have happened."""
        if isinstance(error, CalibrationError):
            self.banner.show_error(error)
            return
        self.files.keep_work()
        show_dialog(BugDialog(error, self))

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
        self._show_calibrate()

    def _show_parts(self, empty: bool) -> None:
        """The welcome page alone while there are no images, else all parts."""
        self._keep_layout()
        self._empty = empty
        if empty:
            self.welcome.show_recent(recent_projects())
        self.pages.setCurrentWidget(self.welcome if empty else self.page)
        for dock in (self.image_dock, self.analysis_dock):
            dock.setVisible(not empty)
        if empty:
            return
        if state := QSettings().value("layout"):
            self.restoreState(state)
        else:
            widths = [_IMAGES_WIDTH, max(_RESULTS_WIDTH, round(_RESULTS_SHARE * self.width()))]
            self.resizeDocks([self.image_dock, self.analysis_dock], widths, _HORIZONTAL)

    def _keep_layout(self) -> None:
        if not self._empty:
            QSettings().setValue("layout", self.saveState())

    def _show_calibrate(self) -> None:
        running, stopping = self.calibrator.running, self.calibrator.stopping
        self.calibrate.setText(
            self.tr("Stopping…")
            if stopping
            else self.tr("&Stop")
            if running
            else self.tr("C&alibrate")
        )
        self.calibrate.setToolTip(
            self.tr("End with the best camera so far")
            if running
            else self.tr("Find the corners still missing, then estimate the camera")
        )
        self.calibrate.setEnabled(bool(self.session.project.views) and not stopping)

    def _calibrate_or_stop(self) -> None:
        if self.calibrator.running:
            self.calibrator.stop()
            self._show_calibrate()
        else:
            self.calibrator.calibrate()

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:  # noqa: N802 - Qt's name
        if event.mimeData().hasUrls():
            _accept_copy(event)

    def dropEvent(self, event: QDropEvent) -> None:  # noqa: N802 - Qt's name
        urls = event.mimeData().urls()
        self.files.open_paths([url.toLocalFile() for url in urls if url.isLocalFile()])
        _accept_copy(event)

    def changeEvent(self, event: QEvent) -> None:  # noqa: N802 - Qt's name
        super().changeEvent(event)
        if event.type() == QEvent.Type.ActivationChange and self.isActiveWindow():
            self.images.thumbnails.look_for_changes()

    def closeEvent(self, event: QCloseEvent) -> None:  # noqa: N802 - Qt's name
        if not self.files.may_leave():
            event.ignore()
            return
        QSettings().setValue("geometry", self.saveGeometry())
        self._keep_layout()
        self.session.jobs.close()
        self.files.saver.close()
        event.accept()


def _accept_copy(event: QDropEvent) -> None:
    """The files stay where they are, whatever is proposed: who moves them may delete them here."""
    event.setDropAction(Qt.DropAction.CopyAction)
    event.accept()


_NEEDED_SOON = (
    "scipy.stats",
    "calibgui.gui.analysis",
    *(
        ("calibgui.engine.kernels.board_shape", "calibgui.engine.kernels.stage_one")
        if COMPILED
        else ()
    ),
)
_FRAME = 16
"""Between two pictures on the screen, ms."""
_SHARE_OF_SCREEN = 0.8
_SMALL_SCREEN = 1600
"""Width below which the window fills the screen, px."""
_IMAGES_WIDTH = 264
_RESULTS_WIDTH = 556
"""At least, px, until the user chooses another."""
_RESULTS_SHARE = 0.4
"""Of the window's width."""
_LEFT = Qt.DockWidgetArea.LeftDockWidgetArea
_RIGHT = Qt.DockWidgetArea.RightDockWidgetArea
_HORIZONTAL = Qt.Orientation.Horizontal

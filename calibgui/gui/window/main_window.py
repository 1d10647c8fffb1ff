"""The main window: puts the parts together, and nothing else."""

from __future__ import annotations

import gc
from functools import partial
from importlib import import_module
from itertools import pairwise
from traceback import extract_tb
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QSize, Qt, QTimer
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent, QResizeEvent
from PySide6.QtWidgets import (
    QApplication,
    QHBoxLayout,
    QMainWindow,
    QPushButton,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from calibgui.app.projects.recent import list_recent
from calibgui.app.system.kernel_preparation import compile_kernels, prepare_solver
from calibgui.dataset import Result
from calibgui.engine.calibration import Cost
from calibgui.engine.errors import CalibrationError
from calibgui.engine.kernels import are_all_kept
from calibgui.gui.canvas.image_page import ImagePage
from calibgui.gui.dialogs.files import Files
from calibgui.gui.images.film_strip import FilmStrip
from calibgui.gui.jobs import qt_names
from calibgui.gui.jobs.job import nothing
from calibgui.gui.panels.groups import Group, Page
from calibgui.gui.session.calibrator import Calibrator
from calibgui.gui.session.detector import Detector
from calibgui.gui.session.refitter import Refitter
from calibgui.gui.session.session import Session
from calibgui.gui.settings.board_panel import BoardPanel
from calibgui.gui.settings.settings_panel import SettingsPanel
from calibgui.gui.verdict.drop_down import PICTURE
from calibgui.gui.verdict.verdict_bar import VerdictBar
from calibgui.gui.widgets.actions import show_dialog
from calibgui.gui.widgets.focus_ring import FocusRing
from calibgui.gui.widgets.kept_settings import keep, read_kept_bytes
from calibgui.gui.widgets.overlay import Overlay
from calibgui.gui.window.banner import Banner
from calibgui.gui.window.commands import Commands
from calibgui.gui.window.dock import Dock
from calibgui.gui.window.inspector import Inspector
from calibgui.gui.window.menus import Menus
from calibgui.gui.window.offers import Offers
from calibgui.gui.window.palette import Palette
from calibgui.gui.window.progress import Progress
from calibgui.gui.window.welcome import Welcome

if TYPE_CHECKING:
    from calibgui.gui.panels.analysis import Analysis


class MainWindow(QMainWindow):
    """Shows the selected image over a film strip of all images, and the inspector beside both.

    The verdict on the calibration stands above the inspector; above the image without one.
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
        self.analysis: Analysis | None = None
        self._empty = True
        self._bugs: set[tuple[object, ...]] = set()
        """Bugs that were shown: what was raised, and where."""
        self._building = QTimer(self, interval=_PAUSE)
        self._building.timeout.connect(self._build_ahead)
        self._at = (self.session.document, 0)
        self.welcome = Welcome(self.session.jobs)
        self.banner = Banner()
        self.verdict = VerdictBar(self.session)
        self.calibrate = QPushButton(self.tr("C&alibrate"))
        self.calibrate.setToolTip(
            self.tr("Find the corners still missing, then estimate the camera")
        )
        self.calibrate.setMinimumSize(_CALIBRATE)
        self.calibrate.setDefault(True)
        FocusRing(self.calibrate)  # the style marks it as default, focused or not
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
        self.pages = QStackedWidget()
        self.pages.setObjectName(PICTURE)
        self.pages.addWidget(self.welcome)
        self.pages.addWidget(self.page)
        centre = QWidget()
        self._centre = QVBoxLayout(centre)
        self._centre.setContentsMargins(0, 0, 0, 0)
        self._centre.setSpacing(0)
        desk = QHBoxLayout()
        desk.setSpacing(0)
        desk.addWidget(self.page.bar)
        desk.addWidget(self.pages, 1)
        self._centre.addLayout(desk, 1)
        self.setCentralWidget(centre)
        # Over the picture: what one points at must not move when a message comes.
        Overlay(self.banner, self.pages)
        self.progress = Progress(self.session.jobs)
        self.inspector = Inspector(
            self.page, self.board, self.settings, self.progress, self.calibrate
        )
        self.inspector_dock = Dock(self.tr("Inspector"), "inspector", self.inspector, self)
        self.addDockWidget(Qt.DockWidgetArea.RightDockWidgetArea, self.inspector_dock)
        self.setCorner(Qt.Corner.BottomRightCorner, Qt.DockWidgetArea.RightDockWidgetArea)
        self.strip_dock = Dock(self.tr("Images"), "images", self.images, self)
        self._hidden_docks = [self.strip_dock, self.inspector_dock]
        """The docks that come back beside the photograph."""
        self.strip_dock.setTitleBarWidget(QWidget())  # none: the strip is as low as it can be
        self.addDockWidget(Qt.DockWidgetArea.BottomDockWidgetArea, self.strip_dock)
        # What the inspector shows comes after its tabs, and last: it is made when it is wanted.
        for before, after in pairwise((self.page.canvas, *self.images.list_stops())):
            self.setTabOrder(before, after)
        for changed in (self.inspector_dock.visibilityChanged, self.inspector_dock.topLevelChanged):
            changed.connect(lambda _: self._place_verdict())
        self._place_verdict()

    def _place_verdict(self) -> None:
        """Put the verdict above the inspector, or above the photograph if that stands alone."""
        dock = self.inspector_dock
        alone = dock.isHidden() or dock.isFloating()
        place = self._centre if alone else self.inspector.column
        if place.indexOf(self.verdict) < 0:
            place.insertWidget(0, self.verdict)

    def _make_menus(self) -> None:
        commands = Commands(self, self.session, self.files, self.images, self.page)
        docks = {
            self.tr("F&ilm strip"): self.strip_dock,
            self.tr("Inspec&tor"): self.inspector_dock,
        }
        menus = Menus(
            self.menuBar(),
            commands.list_menus(
                self.calibrate.click,
                self.progress.end_shown,
                self.close,
                self.change_room,
                self.leave_photograph_alone,
                docks,
                self._list_pages,
                lambda: show_dialog(Palette(menus, self)),
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
        self.inspector.group_wanted.connect(lambda group: self.need_analysis().show_group(group))
        self.inspector.room_wanted.connect(self.change_room)
        refitter = Refitter(self.session, self.detector, self.calibrator)
        self.images.excluded.connect(
            lambda label: refitter.refit(label) if self.images.follows.isChecked() else None
        )
        self.board.search_wanted.connect(self.detector.search)
        self.calibrate.clicked.connect(self._calibrate)
        self.calibrator.began.connect(self._show_beginning)
        self.calibrator.advanced.connect(lambda step: self.need_analysis().show_iteration(step))
        self.calibrator.ended.connect(lambda: self.need_analysis().show_end())
        self.session.result_changed.connect(self._result_changed)
        for changed in (self.session.jobs.changed, self.calibrator.began, self.calibrator.ended):
            changed.connect(self._show_calibrate)
        self.files.saver.opened.connect(self.images.thumbnails.look_for_changes)
        self.board.print_wanted.connect(self.files.print_board)
        self.welcome.folder_wanted.connect(self.files.ask_for_folder)
        self.welcome.images_wanted.connect(self.files.ask_for_images)
        self.welcome.sample_wanted.connect(self.files.open_sample)
        self.welcome.board_wanted.connect(self.files.print_board)
        self.welcome.recent_wanted.connect(lambda path: self.files.open_paths([str(path)]))

    def _list_pages(self) -> list[Page]:
        """Return what the inspector can show now, which comes into sight with it."""
        pages = [] if self._empty else self.inspector.list_pages()
        if self.session.result is not None:
            pages += self.need_analysis().list_pages()
        return [page._replace(show=partial(self._show_page, page)) for page in pages]

    def _show_page(self, page: Page) -> None:
        self.inspector_dock.show()
        page.show()

    def _show_panel_named(self, name: str) -> None:
        self.inspector_dock.show()
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
            self.analysis.export_wanted.connect(self.files.export)
            self.analysis.rename_wanted.connect(self.files.rename_result)
            self.analysis.delete_wanted.connect(self.files.delete_result)
            self.analysis.group_shown.connect(self.inspector.show_group)
            self.inspector.set_analysis(self.analysis)
            self.inspector.show_group(Group.ANSWER)
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

    def prepare(self) -> None:
        """Import beside the main thread what will be needed: detectors, SciPy, panels, solver; then
        compile kernels, once after an installation.

        Once there is a result, the panels on it are built before they are asked for.

        What is there by then stays: going through it at every full collection of garbage would
        stop the window for longer than a frame.
        """

        def load() -> None:
            if self.isVisible():  # it may have been closed meanwhile
                self.session.jobs.start("", lambda _: _load_ahead(), loaded)

        def loaded(are_kernels_kept: bool) -> None:
            gc.freeze()
            if not are_kernels_kept and self.isVisible():
                self.session.jobs.start(
                    self.tr("Compiling for speed, once"),
                    lambda job: compile_kernels(job.advance, job.cancelling),
                    failed=nothing,  # the readable functions go on
                    is_about_document=False,
                )

        qt_names.make_classes(self, load)
        self.session.result_changed.connect(lambda _: self._building.start())
        strip = self.images.list.horizontalScrollBar()
        for in_use in (self.session.selected, self.session.hovered, strip.valueChanged):
            in_use.connect(lambda *_: self._put_off_building())

    def _put_off_building(self) -> None:
        """Build the next panel only after a pause: who scrolls would see the strip stand still."""
        if self._building.isActive():
            self._building.start()

    def _build_ahead(self) -> None:
        """Build one panel that was not shown yet, unless somebody works."""
        working = any(job.is_about_document for job in self.session.jobs.running)
        busy = working or QApplication.mouseButtons()
        if self.analysis is not None and not busy:
            self._building.stop()  # so that a panel that cannot be built is not tried for ever
            if self.analysis.build_next():
                self._building.start()

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
        self._keep_layout()
        self._empty = empty
        if empty:
            self.welcome.show_recent(list_recent())
        self.pages.setCurrentWidget(self.welcome if empty else self.page)
        for part in (self.strip_dock, self.inspector_dock, self.page.bar, self.verdict):
            part.setVisible(not empty)
        if empty:
            return
        state = read_kept_bytes("layout")
        if state is None or not self.restoreState(state, _LAYOUT):
            self._widen_inspector(_INSPECTOR_SHARE)

    def _keep_layout(self) -> None:
        if not self._empty:
            keep("layout", self.saveState(_LAYOUT))

    def change_room(self) -> None:
        """Give the inspector most of the width, or the photograph if the inspector has it."""
        is_wide = self.inspector.width() > self.width() / 2
        self._widen_inspector(_INSPECTOR_SHARE if is_wide else _LARGE_SHARE)

    def leave_photograph_alone(self) -> None:
        """Hide the film strip and the inspector, or show again what was hidden."""
        shown = [dock for dock in (self.strip_dock, self.inspector_dock) if dock.isVisible()]
        for dock in shown or self._hidden_docks:
            dock.setVisible(not shown)
        if shown:
            self._hidden_docks = shown

    def _widen_inspector(self, share: float) -> None:
        width = max(Inspector.WIDTH, round(share * self.width()))
        self.resizeDocks([self.inspector_dock], [width], Qt.Orientation.Horizontal)

    def _follow_tool(self, taken: bool) -> None:
        if taken:
            self.inspector_dock.show()  # what the tool says stands there
            self.banner.hide_failure()  # it would cover corners

    def _show_calibrate(self) -> None:
        running = self.calibrator.running
        self.verdict.show_running(running)
        self.calibrate.setEnabled(bool(self.session.project.views) and not running)

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

    def dropEvent(self, event: QDropEvent) -> None:  # noqa: N802 - Qt's name
        urls = event.mimeData().urls()
        self.files.open_paths([url.toLocalFile() for url in urls if url.isLocalFile()])
        _accept_copy(event)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        super().resizeEvent(event)
        self.verdict.fit_height(event.size().height())

    def changeEvent(self, event: QEvent) -> None:  # noqa: N802 - Qt's name
        super().changeEvent(event)
        if event.type() == QEvent.Type.ActivationChange and self.isActiveWindow():
            self.images.thumbnails.look_for_changes()

    def closeEvent(self, event: QCloseEvent) -> None:  # noqa: N802 - Qt's name
        if not self.files.may_leave():
            event.ignore()
            return
        keep("geometry", self.saveGeometry())
        self._keep_layout()
        self.session.jobs.close()
        self.files.saver.close()
        event.accept()


def _load_ahead() -> bool:
    """Import what is needed soon; return whether all kernels are compiled, and load them then."""
    for name in _NEEDED_SOON:
        import_module(name)
    if is_kept := are_all_kept():
        prepare_solver()
    return is_kept


def _accept_copy(event: QDropEvent) -> None:
    """Accept dropped files as copies: a program that moves files might delete the originals."""
    event.setDropAction(Qt.DropAction.CopyAction)
    event.accept()


_NEEDED_SOON = (
    "calibgui.engine.detection.find_corners",
    "calibgui.engine.redetection.redetect_corners",
    "scipy.stats",
    "calibgui.gui.panels.analysis",
)
"""Modules that are imported beside the main thread once the window is open."""
_FRAME = 16
"""Time between two pictures on the screen, ms."""
_PAUSE = 150
"""Time between two panels that are built ahead, ms: what the user does comes between them."""
_SHARE_OF_SCREEN = 0.8
_SMALL_SCREEN = 1600
"""Width of a screen below which the window fills it, px."""
_INSPECTOR_SHARE = 0.33
"""Share of the window's width that the inspector gets, so that the photograph has the most."""
_LARGE_SHARE = 0.72
"""The same when a plot needs the room."""
_CALIBRATE = QSize(110, 32)
_LAYOUT = 3
"""Version of the parts' layout: one that was kept of other parts is not restored."""

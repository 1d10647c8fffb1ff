"""The commands of the menus: text, tip, keys and the function that each calls."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from PySide6.QtCore import QObject
from PySide6.QtGui import QKeySequence
from PySide6.QtWidgets import QWidget

from calibgui.app.projects.recent import list_recent
from calibgui.gui.canvas.image_page import ImagePage
from calibgui.gui.dialogs.files import Files
from calibgui.gui.dialogs.many_cameras import ManyCameras
from calibgui.gui.images.film_strip import FilmStrip
from calibgui.gui.panels.modes import Page
from calibgui.gui.session.session import Session
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.actions import COPY_PICTURE, COPY_TABLE, find_copier, show_dialog
from calibgui.gui.window.menus import Command, Menu

Key = QKeySequence.StandardKey


class Commands(QObject):
    """Describes the menus of the window.

    Args:
        parent: over which dialogs open.
        session, files, images, page: on which the commands act.
    """

    def __init__(
        self, parent: QWidget, session: Session, files: Files, images: FilmStrip, page: ImagePage
    ) -> None:
        super().__init__(parent)
        self._parent, self._session, self._files = parent, session, files
        self._images, self._page = images, page
        self._many = ManyCameras(session, files, parent)

    def list_menus(
        self,
        calibrate: Callable[[], object],
        stop: Callable[[], object],
        check: Callable[[], object],
        leave: Callable[[], object],
        leave_alone: Callable[[], object],
        list_pages: Callable[[], Sequence[Page]],
        find_action: Callable[[], object],
        take_tour: Callable[[], object],
        photograph: Callable[[], object],
        show_rig: Callable[[], object],
    ) -> Sequence[Menu]:
        """Return the menus from left to right.

        Args:
            calibrate: starts a calibration.
            stop: ends the work that the progress bar tells of.
            check: asks for photographs that check the shown result.
            leave: closes the window.
            leave_alone: leaves the desk alone in the window, or not.
            list_pages: returns what the window can show now.
            find_action: opens the palette of all actions.
            take_tour: points at one part of the window after another.
            photograph: opens the page on which photographs are taken live.
            show_rig: opens the page of several cameras.
        """
        return (
            self._describe_file(leave, photograph, show_rig),
            self._describe_edit(),
            Menu(
                self.tr("&Images"),
                (
                    *self._images.actions_for_menu,
                    self._images.follows,
                    None,
                    *self._images.sorting,
                    None,
                    *self._page.tools,
                ),
            ),
            self._describe_calibration(calibrate, stop, check),
            self._describe_view(leave_alone, list_pages),
            self._describe_help(find_action, take_tour),
        )

    def _describe_file(
        self,
        leave: Callable[[], object],
        photograph: Callable[[], object],
        show_rig: Callable[[], object],
    ) -> Menu:
        files = self._files
        return Menu(
            self.tr("&File"),
            (
                Command(
                    text=self.tr("&New project"),
                    shortcut=Key.New,
                    tip=self.tr("Begin with nothing"),
                    run=files.new,
                ),
                Command(
                    text=self.tr("&Open project…"),
                    shortcut=Key.Open,
                    tip=self.tr("Open a saved project"),
                    run=files.ask_for_project,
                ),
                Menu(self.tr("Open &recent"), self._list_recent),
                Command(
                    text=self.tr("Open f&leet…"),
                    tip=self.tr("Show the cameras of a ledger that calibgui batch wrote"),
                    run=self._many.ask_for_fleet,
                ),
                Command(
                    text=self.tr("Open the sa&mple"),
                    tip=self.tr("Rendered photographs, to look around"),
                    run=files.open_sample,
                ),
                None,
                Command(
                    text=self.tr("&Save"),
                    shortcut=Key.Save,
                    tip=self.tr("Write the project to its file"),
                    run=files.save,
                ),
                Command(
                    text=self.tr("Save &as…"),
                    shortcut="Ctrl+Shift+S",
                    tip=self.tr("Write the project to another file"),
                    run=files.save_as,
                ),
                None,
                Command(
                    text=self.tr("Add &images…"),
                    shortcut="Ctrl+I",
                    tip=self.tr("Choose image files"),
                    run=files.ask_for_images,
                ),
                Command(
                    text=self.tr("Add a &folder…"),
                    shortcut="Ctrl+Shift+I",
                    tip=self.tr("Take all images of a folder"),
                    run=files.ask_for_folder,
                ),
                Command(
                    text=self.tr("P&hotograph live…"),
                    shortcut="Ctrl+L",
                    tip=self.tr("Take photographs with a camera that says where to hold the board"),
                    run=photograph,
                ),
                Command(
                    text=self.tr("Several &cameras…"),
                    tip=self.tr("Calibrate cameras that stand fast to each other: a rig"),
                    run=show_rig,
                ),
                None,
                Command(
                    text=self.tr("&Quit"),
                    shortcut="Ctrl+Q",
                    tip=self.tr("Close the window"),
                    run=leave,
                ),
            ),
        )

    def _list_recent(self) -> Sequence[Command]:
        if recent := list_recent():
            return tuple(self._describe_recent(entry.path) for entry in recent)
        tip = self.tr("Projects and folders that were opened stand here")
        return self._describe_nothing(tip, self.tr("No project or folder has been opened yet."))

    def _describe_nothing(self, tip: str, why: str) -> Sequence[Command]:
        """Return what stands in a menu that has no entries, and why."""
        text, never = self.tr("None yet"), lambda: False
        return (Command(text=text, tip=tip, run=never, is_enabled=never, why_disabled=why),)

    def _describe_recent(self, path: Path) -> Command:
        return Command(
            text=str(path),
            tip=self.tr("Open this project or folder"),
            run=partial(self._files.open_paths, [str(path)]),
        )

    def _describe_edit(self) -> Menu:
        session = self._session
        return Menu(
            self.tr("&Edit"),
            (
                Command(
                    text=self.tr("&Undo"),
                    shortcut=Key.Undo,
                    tip=self.tr("Take the last change back"),
                    run=lambda: session.document.undo(),
                    is_enabled=lambda: bool(session.document.undo_label),
                    why_disabled=self.tr("Nothing has been changed since the project was opened."),
                    get_subject=lambda: session.document.undo_label,
                ),
                Command(
                    text=self.tr("&Redo"),
                    shortcut=Key.Redo,
                    tip=self.tr("Do what was undone"),
                    run=lambda: session.document.redo(),
                    is_enabled=lambda: bool(session.document.redo_label),
                    why_disabled=self.tr("Nothing has been undone."),
                    get_subject=lambda: session.document.redo_label,
                ),
                None,
                Command(
                    text=self.tr("&Paste paths"),
                    shortcut=Key.Paste,
                    tip=self.tr("Add the files on the clipboard"),
                    run=self._files.paste,
                ),
                None,
                Command(
                    text=self.tr("Copy &table"),
                    tip=self.tr("Put the table in sight on the clipboard, for a spreadsheet"),
                    run=lambda: self._copy(COPY_TABLE),
                    is_enabled=lambda: find_copier(self._parent, COPY_TABLE) is not None,
                    why_disabled=self.tr("No table is in sight: choose a panel with one first."),
                ),
                Command(
                    text=self.tr("Copy p&lot as picture"),
                    tip=self.tr("Put a picture of the plot in sight on the clipboard"),
                    run=lambda: self._copy(COPY_PICTURE),
                    is_enabled=lambda: find_copier(self._parent, COPY_PICTURE) is not None,
                    why_disabled=self.tr("No plot is in sight: choose a panel with one first."),
                ),
            ),
        )

    def _copy(self, name: str) -> None:
        """Copy the table or picture in sight."""
        if (copier := find_copier(self._parent, name)) is not None:
            copier.trigger()

    def _show_manual(self) -> None:
        """Show the manual beside the window, or bring it to the front."""
        from calibgui.gui.dialogs.manual_dialog import ManualDialog

        manual = self._parent.findChild(ManualDialog)
        if manual is None:
            manual = ManualDialog(self._parent)
            show_dialog(manual, is_modal=False)
        manual.activateWindow()

    def _describe_calibration(
        self,
        calibrate: Callable[[], object],
        stop: Callable[[], object],
        check: Callable[[], object],
    ) -> Menu:
        session, files = self._session, self._files
        return Menu(
            self.tr("Cali&bration"),
            (
                Command(
                    text=self.tr("&Calibrate"),
                    shortcut="F9",
                    tip=self.tr("Do everything that is still to do"),
                    run=calibrate,
                    is_enabled=lambda: bool(session.project.views),
                    why_disabled=self.tr("There are no images yet: add some first."),
                ),
                Command(
                    text=self.tr("S&top"),
                    shortcut="Shift+F9",
                    tip=self.tr("End what the progress bar tells of; what is finished stays"),
                    run=stop,
                ),
                Command(
                    text=self.tr("&Export…"),
                    shortcut="Ctrl+E",
                    tip=self.tr("Write the camera for OpenCV, ROS, MATLAB or another program"),
                    run=files.export,
                    is_enabled=lambda: session.result is not None,
                    why_disabled=self.tr("Nothing is calibrated yet: press Calibrate first."),
                ),
                Command(
                    text=self.tr("&Report…"),
                    shortcut=Key.Print,
                    tip=self.tr("Write what is known as PDF or a web page, or a certificate"),
                    run=files.report,
                    is_enabled=lambda: session.result is not None,
                    why_disabled=self.tr("Nothing is calibrated yet: press Calibrate first."),
                ),
                Command(
                    text=self.tr("Chec&k with new photographs…"),
                    tip=self.tr("Whether the camera is still good; the project stays as it is"),
                    run=check,
                    is_enabled=lambda: session.result is not None,
                    why_disabled=self.tr("Nothing is calibrated yet: press Calibrate first."),
                ),
                Command(
                    text=self.tr("&Series of calibrations…"),
                    tip=self.tr("How a camera varies with zoom, focus, temperature or date"),
                    run=self._many.show_series,
                ),
                Command(
                    text=self.tr("&Hand and eye…"),
                    tip=self.tr("Where the camera is in a robot's hand, or beside the robot"),
                    run=self._show_hand_eye,
                    is_enabled=lambda: session.result is not None,
                    why_disabled=self.tr("Nothing is calibrated yet: press Calibrate first."),
                ),
                None,
                Command(
                    text=self.tr("&Print a board…"),
                    tip=self.tr("Make a board of any size"),
                    run=files.print_board,
                ),
            ),
        )

    def _show_hand_eye(self) -> None:
        """Show the dialog of hand and eye, in which the user chooses the robot's poses."""
        from calibgui.gui.dialogs.hand_eye_dialog import HandEyeDialog

        result = self._session.result
        assert result is not None
        show_dialog(HandEyeDialog(self._session.jobs, result, self._parent))

    def _describe_view(
        self, leave_alone: Callable[[], object], list_pages: Callable[[], Sequence[Page]]
    ) -> Menu:
        page, chosen = self._page, theme.chosen()
        schemes = (
            (theme.Scheme.SYSTEM, self.tr("As the &system")),
            (theme.Scheme.LIGHT, self.tr("&Light")),
            (theme.Scheme.DARK, self.tr("&Dark")),
        )
        colours = [
            Command(
                text=text,
                tip=self.tr("Choose light or dark colours"),
                run=partial(theme.choose, scheme),
                is_chosen=chosen is scheme,
            )
            for scheme, text in schemes
        ]
        return Menu(
            self.tr("&View"),
            (
                *page.zoom_actions,
                None,
                *page.layers.values(),
                None,
                Menu(self.tr("S&how panel"), lambda: self._list_pages(list_pages())),
                Command(
                    text=self.tr("The &desk alone, or back"),
                    shortcut="F7",
                    tip=self.tr("Hide the strip of images and the inspector, or show them again"),
                    run=leave_alone,
                    is_enabled=lambda: bool(self._session.project.views),
                    why_disabled=self.tr("There are no images yet: add some first."),
                ),
                Menu(self.tr("&Colours"), colours),
            ),
        )

    def _list_pages(self, pages: Sequence[Page]) -> Sequence[Command]:
        if pages:
            return [Command(text=page.title, tip=page.tip, run=page.show) for page in pages]
        tip = self.tr("What the window can show stands here")
        return self._describe_nothing(tip, self.tr("There are no images yet: add some first."))

    def _describe_help(
        self, find_action: Callable[[], object], take_tour: Callable[[], object]
    ) -> Menu:
        return Menu(
            self.tr("&Help"),
            (
                Command(
                    text=self.tr("&Manual"),
                    shortcut=Key.HelpContents,
                    tip=self.tr("How to photograph, what a message means, who reads which file"),
                    run=self._show_manual,
                ),
                Command(
                    text=self.tr("Take the &tour"),
                    tip=self.tr("Two minutes from one part of the window to the next"),
                    run=take_tour,
                ),
                Command(
                    text=self.tr("&Find an action…"),
                    shortcut="Ctrl+Shift+P",
                    tip=self.tr("Search everything that the menus can do"),
                    run=find_action,
                ),
            ),
        )

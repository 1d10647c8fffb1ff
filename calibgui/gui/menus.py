"""The menus of the window."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject
from PySide6.QtGui import QAction, QActionGroup, QKeySequence
from PySide6.QtWidgets import QMenu

from calibgui.app.recent import recent_projects
from calibgui.gui import theme
from calibgui.gui.actions import make_action, show_dialog
from calibgui.gui.help_dialog import HelpDialog

if TYPE_CHECKING:
    from calibgui.gui.main_window import MainWindow

Key = QKeySequence.StandardKey


class Menus(QObject):
    """Fills the menu bar of `window`."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        bar = window.menuBar()
        self._fill_file(bar.addMenu(self.tr("&File")))
        self._fill_edit(bar.addMenu(self.tr("&Edit")))
        self._fill_images(bar.addMenu(self.tr("&Images")))
        self._fill_calibration(bar.addMenu(self.tr("Cali&bration")))
        self._fill_view(bar.addMenu(self.tr("&View")))
        self._fill_help(bar.addMenu(self.tr("&Help")))

    def _add(
        self, menu: QMenu, text: str, key: str | Key | None, tip: str, does: Callable[[], object]
    ) -> QAction:
        action = make_action(self._window, text, key, tip, does)
        menu.addAction(action)
        return action

    def _fill_file(self, menu: QMenu) -> None:
        window, files = self._window, self._window.files
        menu.setToolTipsVisible(True)
        self._add(menu, self.tr("&New project"), Key.New, self.tr("Begin with nothing"), files.new)
        self._add(
            menu,
            self.tr("&Open project…"),
            Key.Open,
            self.tr("Open a saved project"),
            files.ask_for_project,
        )
        recent = menu.addMenu(self.tr("Open &recent"))
        recent.aboutToShow.connect(lambda: self._fill_recent(recent))
        self._add(
            menu,
            self.tr("Open the sa&mple"),
            None,
            self.tr("Rendered photographs, to look around"),
            files.open_sample,
        )
        menu.addSeparator()
        self._add(
            menu, self.tr("&Save"), Key.Save, self.tr("Write the project to its file"), files.save
        )
        self._add(
            menu,
            self.tr("Save &as…"),
            "Ctrl+Shift+S",
            self.tr("Write the project to another file"),
            files.save_as,
        )
        menu.addSeparator()
        self._add(
            menu,
            self.tr("Add &images…"),
            "Ctrl+I",
            self.tr("Choose image files"),
            files.ask_for_images,
        )
        self._add(
            menu,
            self.tr("Add a &folder…"),
            "Ctrl+Shift+I",
            self.tr("Take all images of a folder"),
            files.ask_for_folder,
        )
        menu.addSeparator()
        self._add(menu, self.tr("&Quit"), "Ctrl+Q", self.tr("Close the window"), window.close)

    def _fill_edit(self, menu: QMenu) -> None:
        window, files = self._window, self._window.files
        undo = self._add(
            menu,
            self.tr("&Undo"),
            Key.Undo,
            self.tr("Take the last change back"),
            lambda: window.session.document.undo(),
        )
        redo = self._add(
            menu,
            self.tr("&Redo"),
            Key.Redo,
            self.tr("Do what was undone"),
            lambda: window.session.document.redo(),
        )
        menu.addSeparator()
        self._add(
            menu,
            self.tr("&Paste paths"),
            Key.Paste,
            self.tr("Add the files on the clipboard"),
            files.paste,
        )

        def name_edits() -> None:
            document = window.session.document
            for action, text, label in (
                (undo, self.tr("&Undo"), document.undo_label),
                (redo, self.tr("&Redo"), document.redo_label),
            ):
                action.setText(f"{text} “{label}”" if label else text)
                action.setEnabled(bool(label))

        window.session.changed.connect(lambda *_: name_edits())
        name_edits()

    def _fill_images(self, menu: QMenu) -> None:
        window = self._window
        menu.setToolTipsVisible(True)
        menu.addActions(window.images.actions_for_menu)
        menu.addSeparator()
        menu.addActions(window.page.tools)

    def _fill_calibration(self, menu: QMenu) -> None:
        window, files = self._window, self._window.files
        menu.setToolTipsVisible(True)
        self._add(
            menu,
            self.tr("&Calibrate or stop"),
            "F9",
            self.tr("Do everything that is still to do"),
            window.calibrate.click,
        )
        export = self._add(
            menu,
            self.tr("&Export…"),
            "Ctrl+E",
            self.tr("Write the camera for another program"),
            files.export,
        )
        export.setEnabled(False)
        window.session.result_changed.connect(lambda result: export.setEnabled(result is not None))
        menu.addSeparator()
        self._add(
            menu,
            self.tr("&Print a board…"),
            "Ctrl+P",
            self.tr("Make a board of any size"),
            files.print_board,
        )

    def _fill_view(self, menu: QMenu) -> None:
        window = self._window
        menu.setToolTipsVisible(True)
        menu.addActions(window.page.zoom_actions)
        menu.addSeparator()
        menu.addActions(list(window.page.layers.values()))
        menu.addSeparator()
        for dock, text in (
            (window.image_dock, self.tr("&Images")),
            (window.analysis_dock, self.tr("Resul&ts")),
        ):
            toggle = dock.toggleViewAction()
            toggle.setText(text)
            menu.addAction(toggle)

        looks = menu.addMenu(self.tr("&Colours"))
        group = QActionGroup(window)
        for scheme, text in (
            (theme.Scheme.SYSTEM, self.tr("As the &system")),
            (theme.Scheme.LIGHT, self.tr("&Light")),
            (theme.Scheme.DARK, self.tr("&Dark")),
        ):
            action = self._add(
                looks,
                text,
                None,
                self.tr("Choose light or dark colours"),
                partial(theme.choose, scheme),
            )
            action.setCheckable(True)
            action.setChecked(theme.chosen() is scheme)
            group.addAction(action)

    def _fill_help(self, menu: QMenu) -> None:
        window = self._window
        self._add(
            menu,
            self.tr("&How it works"),
            Key.HelpContents,
            self.tr("The workflow on one page"),
            lambda: show_dialog(HelpDialog(window)),
        )

    def _fill_recent(self, menu: QMenu) -> None:
        menu.clear()
        for path in recent_projects():
            menu.addAction(str(path), partial(self._window.files.open_project, path))
        if menu.isEmpty():
            menu.addAction(self.tr("None yet")).setEnabled(False)

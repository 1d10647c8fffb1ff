"""The command palette: every action of the menus, found by typing a part of what it does."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QAction, QColor, QKeyEvent, QKeySequence
from PySide6.QtWidgets import (
    QApplication,
    QDialog,
    QHeaderView,
    QLineEdit,
    QToolButton,
    QTreeWidget,
    QTreeWidgetItem,
    QWidget,
)

from calibgui.gui.widgets import theme
from calibgui.gui.widgets.layouts import make_column
from calibgui.gui.widgets.scrolling import make_thin
from calibgui.gui.widgets.wrapped_label import WrappedLabel
from calibgui.gui.window.menus import Menus, strip_mnemonic

_WIDTH, _HEIGHT = 560, 420
_MOVES = {Qt.Key.Key_Up, Qt.Key.Key_Down, Qt.Key.Key_PageUp, Qt.Key.Key_PageDown}
_ACTION = Qt.ItemDataRole.UserRole


class Palette(QDialog):
    """Lists the actions whose text, menu or tip holds every word that is typed; Enter runs one.

    Below the list stands what the current action is good for or, of one that can do nothing now,
    why.

    Args:
        menus: whose actions are offered.
        parent: over which the palette opens.
    """

    def __init__(self, menus: Menus, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Find an action"))
        self.resize(_WIDTH, _HEIGHT)
        self._actions = menus.list_actions()
        self.search = QLineEdit()
        self.search.setPlaceholderText(self.tr("Type a part of what you want to do"))
        self.search.setAccessibleName(self.tr("Part of an action's name"))
        self.search.setClearButtonEnabled(True)
        for clear in self.search.findChildren(QToolButton):  # Qt leaves it without a name
            clear.setAccessibleName(self.tr("Clear"))
        self.search.installEventFilter(self)
        self.list = QTreeWidget()
        self.list.setAccessibleName(self.tr("Actions"))
        make_thin(self.list)
        self.list.setRootIsDecorated(False)
        self.list.setUniformRowHeights(True)
        self.list.setHeaderLabels([self.tr("Action"), self.tr("Menu"), self.tr("Keys")])
        header = self.list.header()
        header.setStretchLastSection(False)
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        self.about = WrappedLabel()
        self.about.setMinimumHeight(2 * self.about.fontMetrics().lineSpacing())
        self.about.setAlignment(Qt.AlignmentFlag.AlignTop)
        make_column(self.search, (self.list, 1), self.about, of=self, margins=theme.SPACING)
        self.search.textChanged.connect(self._fill)
        self.search.returnPressed.connect(self._run_current)
        self.list.itemActivated.connect(self._run_current)
        self.list.itemClicked.connect(self._run_current)
        self.list.currentItemChanged.connect(self._describe)
        self._fill("")

    def _fill(self, text: str) -> None:
        """List what matches, those first whose own text holds what is typed."""
        words = text.casefold().split()
        found = [
            (not all(word in strip_mnemonic(action.text()).casefold() for word in words), k)
            for k, (path, action) in enumerate(self._actions)
            if all(word in _say_all(path, action) for word in words)
        ]
        self.list.clear()
        for _, k in sorted(found):
            self.list.addTopLevelItem(_make_row(*self._actions[k]))
        if (first := self.list.topLevelItem(0)) is not None:
            self.list.setCurrentItem(first)
        else:
            self.about.setText(self.tr("No action of the menus is called so."))

    def _describe(self, item: QTreeWidgetItem | None) -> None:
        if item is not None:
            action: QAction = item.data(0, _ACTION)
            self.about.setText(action.toolTip())

    def _run_current(self) -> None:
        """Run the current action, if it can do anything, once the palette is gone."""
        if not self.isVisible():  # a click is also an activation on some desktops
            return
        item = self.list.currentItem()
        action: QAction | None = None if item is None else item.data(0, _ACTION)
        if action is None or not action.isEnabled():
            QApplication.beep()
            return
        self.accept()
        action.trigger()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        """Move in the list with the arrow keys while one types."""
        pressed = event.key() if isinstance(event, QKeyEvent) else None
        if event.type() is QEvent.Type.KeyPress and pressed in _MOVES:
            QApplication.sendEvent(self.list, event)
            return True
        return super().eventFilter(watched, event)


def _say_all(path: str, action: QAction) -> str:
    """Return everything that an action can be found by."""
    return f"{path} {strip_mnemonic(action.text())} {action.toolTip()}".casefold()


def _make_row(path: str, action: QAction) -> QTreeWidgetItem:
    keys = action.shortcut().toString(QKeySequence.SequenceFormat.NativeText)
    item = QTreeWidgetItem([strip_mnemonic(action.text()), path, keys])
    item.setData(0, _ACTION, action)
    if action.isCheckable():
        state = Qt.CheckState.Checked if action.isChecked() else Qt.CheckState.Unchecked
        item.setCheckState(0, state)
        item.setFlags(item.flags() & ~Qt.ItemFlag.ItemIsUserCheckable)
    for column in range(3):
        item.setToolTip(column, action.toolTip())
        if not action.isEnabled() or column:
            item.setForeground(column, QColor(theme.current().muted))
    return item

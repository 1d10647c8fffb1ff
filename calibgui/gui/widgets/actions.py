"""Making actions and opening dialogs, the same way everywhere."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

from PySide6.QtCore import QCoreApplication, QSize, Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QPushButton, QWidget

from calibgui.gui.widgets.buttons import Button


def make_action(
    parent: QWidget,
    text: str,
    shortcut: str | QKeySequence.StandardKey | None,
    tip: str,
    does: Callable[[], Any],
    *,
    scope: Qt.ShortcutContext = Qt.ShortcutContext.WindowShortcut,
) -> QAction:
    """An action of `parent`.

    Args:
        parent: owns it.
        text: with & before the letter that chooses it in a menu.
        shortcut: keys, or None.
        tip: what it is good for, in a sentence.
        does: called without arguments.
        scope: where the shortcut works.
    """
    action = QAction(text, parent)
    if isinstance(shortcut, QKeySequence.StandardKey):
        action.setShortcuts(shortcut)  # all that are usual: redo is Ctrl+Y and Ctrl+Shift+Z
    elif shortcut is not None:
        action.setShortcut(QKeySequence(shortcut))
    action.setStatusTip(tip)
    enable_action(action, True, "")
    action.setShortcutContext(scope)
    action.triggered.connect(lambda: does())
    return action


def enable_action(action: QAction, enabled: bool, why_disabled: str) -> None:
    """Let an action be chosen or not; while it cannot, its tooltip says why.

    Args:
        action: from `make_action`, whose tip comes back with it.
        enabled: whether it can be chosen.
        why_disabled: sentence on why it cannot, and what to do about that.
    """
    action.setEnabled(enabled)
    tip = action.statusTip()
    if not enabled and why_disabled:
        action.setToolTip(
            f"{tip}.\n{why_disabled}" if tip[-1:].isalnum() else f"{tip}\n{why_disabled}"
        )
        return
    keys = action.shortcut().toString(QKeySequence.SequenceFormat.NativeText)
    action.setToolTip(f"{tip} ({keys})" if keys else tip)


COPY_TABLE, COPY_PICTURE = "copy_table", "copy_picture"
"""Names of the actions by which a table and a picture copy themselves; see `find_copier`."""


def find_copier(window: QWidget, name: str) -> QAction | None:
    """Return the action that copies the table or picture in sight: the focused one, or the largest.

    Args:
        window: in which it is looked for.
        name: `COPY_TABLE` or `COPY_PICTURE`.
    """

    def rank(action: QAction) -> tuple[bool, int]:
        widget = cast(QWidget, action.parent())
        return widget.hasFocus(), widget.width() * widget.height()

    actions = window.findChildren(QAction, name)
    shown = [action for action in actions if cast(QWidget, action.parent()).isVisible()]
    return max(shown, key=rank, default=None)


def make_buttons(dialog: QDialog, *others: QPushButton) -> QDialogButtonBox:
    """Make the last row of a dialog: these buttons, and one that closes it, which leaves Enter to
    them."""
    buttons = QDialogButtonBox()
    close = Button(QCoreApplication.translate("actions", "Close"), takes_enter=False)
    buttons.addButton(close, QDialogButtonBox.ButtonRole.RejectRole)
    buttons.rejected.connect(dialog.reject)
    for button in others:
        buttons.addButton(button, QDialogButtonBox.ButtonRole.ActionRole)
    return buttons


def show_dialog(dialog: QDialog, *, is_modal: bool = True) -> None:
    """Open a dialog over its window, no larger than the screen.

    It ceases to exist when it is closed.

    Args:
        dialog: the dialog.
        is_modal: whether the window waits until it is closed.
    """
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    screen = dialog.screen().availableSize() - QSize(*[_FRAME] * 2)
    dialog.resize(dialog.size().boundedTo(screen))
    if is_modal:
        dialog.open()
    else:
        dialog.show()


_FRAME = 40
"""Room for what the system draws around a window, device-independent px."""

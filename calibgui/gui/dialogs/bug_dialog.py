"""The dialog for a failure of the program itself."""

from __future__ import annotations

import platform
import traceback

from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import (
    QDialog,
    QPlainTextEdit,
    QWidget,
)

from calibgui.dataset import list_installed_versions
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.actions import make_buttons
from calibgui.gui.widgets.buttons import Button, Kind
from calibgui.gui.widgets.layouts import make_column
from calibgui.gui.widgets.wrapped_label import WrappedLabel


def describe(error: BaseException) -> str:
    """Traceback and versions, as a report needs them."""
    versions = "\n".join(f"{name} {version}" for name, version in list_installed_versions().items())
    return "".join(traceback.format_exception(error)) + f"\n{versions}\n{platform.platform()}\n"


class BugDialog(QDialog):
    """The traceback with all versions, to copy."""

    def __init__(self, error: BaseException, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Something went wrong"))
        words = WrappedLabel(
            self.tr(
                "This is a fault of the program, not of your images. Your work has been kept. "
                "Please report the text below; you can go on, or save and start again."
            )
        )
        self.details = QPlainTextEdit(describe(error))
        self.details.setReadOnly(True)
        self.details.setAccessibleName(self.tr("What to report"))
        self.details.setFont(theme.fixed_font())
        self.details.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
        self.copy = Button(self.tr("&Copy"), Kind.MAIN)
        self.copy.clicked.connect(
            lambda: QGuiApplication.clipboard().setText(self.details.toPlainText())
        )
        make_column(
            words, (self.details, 1), make_buttons(self, self.copy), of=self, margins=theme.MARGIN
        )
        self.resize(720, 420)

"""Questions over a window, whose every answer has its letter on the keyboard."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import QMessageBox, QWidget

Answer = QMessageBox.StandardButton


def ask(parent: QWidget, title: str, text: str, answers: Answer, default: Answer) -> Answer:
    """Ask for one of `answers`; Enter gives the `default`, Esc cancels or says no."""
    box = QMessageBox(QMessageBox.Icon.Question, title, text, answers, parent)
    for answer, words in _list_words().items():
        if (button := box.button(answer)) is not None:
            button.setText(words)
            button.setIcon(QIcon())  # the style's are of another family, and black in the dark
    box.setDefaultButton(default)
    given = Answer(box.exec())
    box.deleteLater()
    return given


def _list_words() -> dict[Answer, str]:
    """Return the words of the answers: the system's have no letters."""
    translate = QCoreApplication.translate
    return {
        Answer.Yes: translate("questions", "&Yes"),
        Answer.No: translate("questions", "&No"),
        Answer.Save: translate("questions", "&Save"),
        Answer.SaveAll: translate("questions", "Save &as…"),
        Answer.Discard: translate("questions", "&Discard"),
        Answer.Cancel: translate("questions", "&Cancel"),
    }

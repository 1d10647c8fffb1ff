"""Questions are answered with the mouse or with one letter."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QKeySequence
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMessageBox, QWidget
from pytestqt.qtbot import QtBot

from calibgui.gui.widgets.questions import Answer, ask

_NO_MODIFIER, _ALT = Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.AltModifier
_ALL = Answer.Save | Answer.SaveAll | Answer.Discard | Answer.Cancel


@pytest.fixture
def parent(qtbot: QtBot) -> QWidget:
    """A window, over which no question stays open for longer than five seconds."""
    widget = QWidget()
    qtbot.addWidget(widget)
    with qtbot.waitActive(widget):
        widget.show()
    QTimer.singleShot(5000, widget, lambda: _get_box().done(0))
    return widget


def _get_box() -> QMessageBox:
    box = QApplication.activeModalWidget()
    assert isinstance(box, QMessageBox)
    return box


def _press(key: Qt.Key, modifier: Qt.KeyboardModifier) -> None:
    box = _get_box()
    while QApplication.activeWindow() is not box:
        box.activateWindow()
        QTest.qWait(10)
    QTest.keyClick(box.focusWidget() or box, key, modifier)


@pytest.mark.parametrize(
    ("key", "modifier", "answer"),
    [
        (Qt.Key.Key_S, _ALT, Answer.Save),
        (Qt.Key.Key_A, _ALT, Answer.SaveAll),
        (Qt.Key.Key_D, _ALT, Answer.Discard),
        (Qt.Key.Key_C, _ALT, Answer.Cancel),
        (Qt.Key.Key_Return, _NO_MODIFIER, Answer.Save),
        (Qt.Key.Key_Escape, _NO_MODIFIER, Answer.Cancel),
    ],
)
def test_a_key_answers(
    parent: QWidget, key: Qt.Key, modifier: Qt.KeyboardModifier, answer: Answer
) -> None:
    QTimer.singleShot(0, parent, lambda: _press(key, modifier))
    assert ask(parent, "Unsaved changes", "Save?", _ALL, Answer.Save) is answer


def test_every_answer_has_a_letter_of_its_own(parent: QWidget) -> None:
    letters: list[str] = []

    def look() -> None:
        buttons = _get_box().buttons()
        letters.extend(QKeySequence.mnemonic(button.text()).toString() for button in buttons)
        _get_box().done(0)

    QTimer.singleShot(0, parent, look)
    every = _ALL | Answer.Yes | Answer.No
    ask(parent, "", "Everything?", every, Answer.No)
    assert len(letters) == 6 and len(set(letters)) == 6 and "" not in letters

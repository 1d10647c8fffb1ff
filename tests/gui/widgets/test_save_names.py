"""A file is not replaced by a name that the user did not see."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtWidgets import QFileDialog, QMessageBox, QWidget
from pytestqt.qtbot import QtBot

from calibgui.gui.widgets import questions
from calibgui.gui.widgets.save_names import ask_for_name

KINDS = "PDF (*.pdf);;SVG drawing (*.svg)"


@pytest.fixture
def parent(qtbot: QtBot) -> QWidget:
    widget = QWidget()
    qtbot.addWidget(widget)
    return widget


def type_name(monkeypatch: pytest.MonkeyPatch, name: str, chosen: str = "") -> None:
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (name, chosen))


def answer(monkeypatch: pytest.MonkeyPatch, button: str) -> list[str]:
    asked: list[str] = []

    def question(_: QWidget, __: str, text: str, *___: object) -> QMessageBox.StandardButton:
        asked.append(text)
        return getattr(QMessageBox.StandardButton, button)

    monkeypatch.setattr(questions, "ask", question)
    return asked


def test_a_name_without_a_suffix_gets_the_chosen_one(
    parent: QWidget, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = answer(monkeypatch, "No")
    type_name(monkeypatch, str(tmp_path / "board"), "SVG drawing (*.svg)")
    assert ask_for_name(parent, "", "", KINDS) == tmp_path / "board.svg"
    type_name(monkeypatch, str(tmp_path / "board"))
    assert ask_for_name(parent, "", "", KINDS) == tmp_path / "board.pdf"
    type_name(monkeypatch, "")
    assert ask_for_name(parent, "", "", KINDS) is None
    # Qt has asked about a name that was typed whole.
    (tmp_path / "board.pdf").touch()
    type_name(monkeypatch, str(tmp_path / "board.pdf"))
    assert ask_for_name(parent, "", "", KINDS) == tmp_path / "board.pdf"
    assert asked == []


@pytest.mark.parametrize("button", ["Yes", "No"])
def test_a_file_of_the_longer_name_is_asked_about(
    parent: QWidget, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, button: str
) -> None:
    (tmp_path / "board.pdf").touch()
    asked = answer(monkeypatch, button)
    type_name(monkeypatch, str(tmp_path / "board"))
    path = ask_for_name(parent, "", "", KINDS)
    assert path == (tmp_path / "board.pdf" if button == "Yes" else None)
    assert asked == [f"{tmp_path / 'board.pdf'} exists. Replace it?"]


@pytest.mark.parametrize("name", ["camera.yaml", ""])
def test_the_dialog_begins_beside_the_file_that_the_window_shows(
    name: str, parent: QWidget, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    starts: list[str] = []
    monkeypatch.setattr(
        QFileDialog, "getSaveFileName", lambda *asked: (starts.append(asked[2]), ("", ""))[1]
    )
    inner = QWidget(parent)
    ask_for_name(inner, "Save", name, KINDS)
    parent.setWindowFilePath(str(tmp_path / "project.json"))
    ask_for_name(inner, "Save", name, KINDS)
    elsewhere = str(tmp_path / "elsewhere" / "b.yaml")
    ask_for_name(inner, "Save", elsewhere, KINDS)
    assert starts == [name, str(tmp_path / name), elsewhere]

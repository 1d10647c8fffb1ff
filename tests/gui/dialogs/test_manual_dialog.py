"""The manual in the window: every chapter with its pictures, and links that lead to them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from PySide6.QtCore import QUrl
from PySide6.QtGui import QAction, QDesktopServices, QKeySequence, QTextDocument
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from calibgui.app.outputs.manual import list_chapters
from calibgui.gui.dialogs.manual_dialog import ManualDialog
from calibgui.gui.widgets import theme
from calibgui.gui.window.main_window import MainWindow

PICTURE = QTextDocument.ResourceType.ImageResource


@pytest.fixture
def dialog(qtbot: QtBot) -> ManualDialog:
    made = ManualDialog()
    qtbot.addWidget(made)
    made.show()
    return made


def test_every_chapter_is_shown_with_its_pictures(dialog: ManualDialog) -> None:
    for row, chapter in enumerate(list_chapters()):
        dialog.chapters.setCurrentRow(row)
        shown = dialog.text.toPlainText()
        assert shown.startswith(dialog.chapters.item(row).text())
        assert "<!--" not in shown and "|" not in shown.replace("|v", ""), chapter.name
        named = re.findall(r'<img src="([^"]+)"', dialog.text.toHtml())
        assert len(named) == chapter.file.read_text(encoding="utf-8").count("![")
        for address in named:
            picture = dialog.text.document().resource(PICTURE.value, QUrl(address))
            assert 100 < picture.width() <= dialog.text.viewport().width()


def test_pictures_have_the_width_that_there_is(dialog: ManualDialog) -> None:
    dialog.chapters.setCurrentRow(1)
    widths = []
    for width in (900, 700):
        dialog.resize(width, 500)
        QApplication.processEvents()
        (address, *_) = re.findall(r'<img src="([^"]+)"', dialog.text.toHtml())
        widths.append(dialog.text.document().resource(PICTURE.value, QUrl(address)).width())
    assert widths[1] < widths[0]


def test_links_lead_to_chapters_headings_and_pages(
    dialog: ManualDialog, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    opened: list[QUrl] = []
    monkeypatch.setattr(QDesktopServices, "openUrl", lambda url: bool(opened.append(url)) or True)
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    dialog.text.anchorClicked.emit(QUrl("#06-messages.what-is-wrong"))
    assert dialog.chapters.currentItem().text() == "Messages and what to do"
    assert dialog.text.verticalScrollBar().value() > 500
    dialog.text.anchorClicked.emit(QUrl("#01-start"))
    assert dialog.text.verticalScrollBar().value() == 0
    dialog.text.anchorClicked.emit(QUrl("https://example.org"))
    dialog.browse.click()
    assert opened[0].host() == "example.org"
    assert Path(opened[1].toLocalFile()).read_text(encoding="utf-8").startswith("<!DOCTYPE html>")


def test_it_follows_the_colours_of_the_window(dialog: ManualDialog, qapp: QApplication) -> None:
    before = dialog.text.toHtml()
    theme.apply(qapp, theme.Scheme.DARK)
    QApplication.processEvents()
    assert theme.DARK.accent in dialog.text.toHtml() and theme.DARK.accent not in before
    theme.apply(qapp, theme.Scheme.LIGHT)


def test_the_window_shows_one_manual_and_goes_on(window: MainWindow) -> None:
    show = next(a for a in window.findChildren(QAction) if a.text() == "&Manual")
    assert QKeySequence("F1") in show.shortcuts()
    show.trigger()
    show.trigger()
    (manual,) = window.findChildren(ManualDialog)
    assert manual.isVisible() and not manual.isModal()
    manual.close()


def test_the_keys_of_the_manual_work(window: MainWindow) -> None:
    text = next(c.file for c in list_chapters() if c.name == "05-window").read_text("utf-8")
    rows = re.findall(r"^\| ([^|]+) \|", text[text.index("| key |") :], re.MULTILINE)[2:]
    named = {key for row in rows for key in re.split(r", | to ", row)}
    named -= {"↑ ↓", "← →", "wheel", "+ −"}  # which are of the widget that has the focus
    actions = window.findChildren(QAction)
    known = {key.toString() for action in actions for key in action.shortcuts()}
    assert named <= known
    menus = [a.menu() for a in window.menuBar().actions()]
    in_menus = {a.shortcut().toString() for m in menus for a in m.actions() if not a.menu()} - {""}
    listed = {f"Shift+{k}" for k in range(1, 7)} | {"Ctrl+Y"}  # as 1 to 6, and as the other redo
    assert in_menus <= named | listed

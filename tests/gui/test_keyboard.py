"""Everything can be done without the mouse: no letter means two things, and Tab goes everywhere."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QAbstractButton, QApplication, QLabel, QMenu, QTabWidget, QWidget
from pytestqt.qtbot import QtBot

from calibgui.gui.panels.analysis import PANELS
from calibgui.gui.panels.evidence.residuals import ResidualsPanel
from calibgui.gui.window.main_window import MainWindow


def labels(window: MainWindow) -> Iterator[str]:
    """The texts in sight whose marked letter does something together with Alt."""
    yield from (action.text() for action in window.menuBar().actions())
    for widget in window.findChildren(QWidget):
        if not widget.isVisible():
            continue
        if isinstance(widget, QAbstractButton) or (
            isinstance(widget, QLabel) and widget.buddy() is not None
        ):
            yield widget.text()
        elif isinstance(widget, QTabWidget):
            yield from map(widget.tabText, range(widget.count()))


def clashes(texts: Iterator[str]) -> dict[str, set[str]]:
    meant: defaultdict[str, set[str]] = defaultdict(set)
    for text in texts:
        if letter := QKeySequence.mnemonic(text).toString():
            meant[letter].add(text)
    return {letter: several for letter, several in meant.items() if len(several) > 1}


def test_no_letter_means_two_things_in_the_empty_window(window: MainWindow) -> None:
    assert clashes(labels(window)) == {}


def test_no_letter_means_two_things_in_the_full_window(full: MainWindow, qtbot: QtBot) -> None:
    for kind in PANELS:
        full.need_analysis().show_panel(kind)
        assert clashes(labels(full)) == {}, kind.__name__
        qtbot.waitUntil(lambda: not full.session.jobs.running, timeout=60_000)
    full.show_setup()
    assert clashes(labels(full)) == {}
    full.header.setup.setChecked(False)
    for tool in full.page.tools:
        tool.trigger()
        assert clashes(labels(full)) == {}
    full.page.marker.leave()


def test_every_entry_of_a_menu_has_its_letter(full: MainWindow) -> None:
    for menu in full.menuBar().findChildren(QMenu):
        texts = [a.text() for a in menu.actions() if a.text() and a.menu() is not menu]
        if menu.title() in ("", "Open &recent"):
            continue
        assert clashes(iter(texts)) == {}, menu.title()
        assert all(QKeySequence.mnemonic(text).toString() for text in texts), texts


def test_no_shortcut_means_two_things(full: MainWindow) -> None:
    meant: defaultdict[str, list[str]] = defaultdict(list)
    for action in full.findChildren(QAction):
        if action.shortcutContext() is Qt.ShortcutContext.WindowShortcut:
            for keys in action.shortcuts():
                meant[keys.toString()].append(action.text())
    assert {keys: texts for keys, texts in meant.items() if len(texts) > 1} == {}


def test_tab_goes_through_all_parts(full: MainWindow, qtbot: QtBot) -> None:
    analysis = full.need_analysis()
    panel = analysis.show_panel(ResidualsPanel).plane
    qtbot.waitUntil(lambda: not full.session.jobs.running, timeout=60_000)
    full.activateWindow()
    full.images.list.setFocus()
    reached = set()
    for _ in range(80):
        reached.add(QApplication.focusWidget())
        qtbot.keyClick(QApplication.focusWidget() or full, Qt.Key.Key_Tab)
    wanted = (
        full.images.list,
        full.calibrate,
        full.inspector.camera.results,
        full.header.modes,
        panel,
    )
    assert {type(widget).__name__ for widget in wanted if widget not in reached} == set()


def test_tab_goes_from_the_photograph_to_the_images_and_on_to_the_verdict(full: MainWindow) -> None:
    chain: list[QWidget] = [full.page.canvas]
    while (widget := chain[-1].nextInFocusChain()) is not chain[0]:
        chain.append(widget)
    stops = (
        full.page.canvas,
        full.images.list,
        full.images.exclude_above,
        full.verdict.button,
    )
    places = [chain.index(stop) for stop in stops]
    assert places == sorted(places)

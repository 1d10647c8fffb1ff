"""The languages that come with the program: complete, and with room on the screen."""

from __future__ import annotations

import ast
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QTranslator
from PySide6.QtWidgets import QApplication, QComboBox, QPushButton, QWidget
from pytestqt.qtbot import QtBot

import calibgui
from calibgui.app.projects.document import Document
from calibgui.app.system.resources import find_resource
from calibgui.gui.verdict.sentences import LISTED, translate_sentences
from calibgui.gui.widgets.buttons import Button, Kind
from calibgui.gui.window.main_window import MainWindow
from tests.app import examples

LANGUAGES = ("de", "es", "zh")
MAX_MISSING = 0.05
"""Share of the texts that may wait for a translation: they are shown in English meanwhile."""
FIELD = re.compile(r"\{[^{}]*\}")


def list_pairs(language: str) -> list[tuple[str, str]]:
    tree = ET.parse(find_resource("translations") / f"calibgui_{language}.ts")
    return [
        (m.findtext("source") or "", m.findtext("translation") or "") for m in tree.iter("message")
    ]


@pytest.fixture(params=LANGUAGES)
def language(request: pytest.FixtureRequest, qapp: QApplication) -> Iterator[str]:
    translator = QTranslator()
    file = find_resource("translations") / f"calibgui_{request.param}.qm"
    assert translator.load(str(file))
    qapp.installTranslator(translator)
    yield request.param
    qapp.removeTranslator(translator)


@pytest.mark.parametrize("name", LANGUAGES)
def test_texts_are_translated_with_the_same_places_and_shortcuts(name: str) -> None:
    pairs = list_pairs(name)
    missing = [source for source, text in pairs if not text]
    assert len(missing) < MAX_MISSING * len(pairs), missing
    for source, text in pairs:
        if text:
            assert sorted(FIELD.findall(source)) == sorted(FIELD.findall(text)), source
            assert ("&" in source) is ("&" in text), source
            assert source.count("\n") <= text.count("\n") + 1, source


def test_the_compiled_file_is_of_the_texts(language: str) -> None:
    pairs = dict(list_pairs(language))
    text = "Drop photographs of a flat board here"
    source = next(source for source in pairs if source.startswith(text))
    assert QApplication.translate("Welcome", source) == pairs[source]


def test_sentences_of_the_engine_are_translated_with_their_numbers(language: str) -> None:
    said = translate_sentences("4 views are too few. The view of Anna is upside down.")
    few, other = said.split(" The ")
    assert few.startswith("4 ") and "too few" not in few, language
    assert other == "view of Anna is upside down.", "what is not listed stays"


@pytest.mark.usefixtures("language")
def test_phrases_within_a_sentence_are_translated() -> None:
    said = translate_sentences(
        "The robot's poses are angles a, b, c of Rz(a) Ry(b) Rx(c) in degrees, millimetres, base "
        "from hand. Read so, the board scatters by 2 mm, and by 300 mm in any other way."
    )
    assert "Rz(a) Ry(b) Rx(c)" in said and "300 mm" in said
    assert not re.search("robot's|angles|degrees|millimetres|hand|board|other", said), said
    assert "instants" not in translate_sentences(
        "Paired by their names: 6 instants of several cameras, the first a.png."
    )


def test_the_engine_says_what_is_listed() -> None:
    root = Path(calibgui.__file__).parent
    files = [
        *root.glob("engine/assessment/**/*.py"),
        root / "engine/calibration/partial/degeneracy.py",
        root / "app/calibrating/best_camera.py",
        root / "report/verdict.py",
        *(root / f"report/{name}.py" for name in ("hand_eye", "rig", "numbers")),
        *(root / f"engine/{name}.py" for name in ("boards/marks", "rig/joining")),
        *root.glob("engine/hand_eye/*.py"),
        *root.glob("app/rig/*.py"),
        root / "app/calibrating/hand_eye.py",
        root / "formats/robot_poses.py",
    ]
    nodes = (node for file in files for node in ast.walk(ast.parse(file.read_text("utf-8"))))
    said = [n.value for n in nodes if isinstance(n, ast.Constant) and isinstance(n.value, str)]
    for sentence in LISTED:
        words = max(
            re.split(r"\{\d\}|: |; |, which leaves| \(| in degrees| in radians", sentence), key=len
        ).strip(" .,")
        assert any(words[1:] in text for text in said), sentence


def test_no_button_is_cut(language: str, qtbot: QtBot, tmp_path: Path) -> None:
    window = MainWindow()
    qtbot.addWidget(window)
    window.resize(1280, 720)
    window.show()
    project = replace(examples.calibrated(tmp_path), lengths_confirmed=False)
    cut = list_cut(window)
    window.session.begin(Document(project))
    qtbot.waitUntil(lambda: window.verdict.verdict is not None, timeout=30_000)
    window.show_setup()
    for fold in window.setup.folds:
        fold.setChecked(True)
    for width, height in ((1280, 720), (960, 1000)):
        window.resize(width, height)
        qtbot.wait(30)
        cut += list_cut(window)
    window.session.document.mark_saved(window.session.project, window.files.saver.file)
    window.close()
    assert not cut, language


def list_cut(window: MainWindow) -> list[str]:
    """List the texts of what is in sight that have no room."""
    QApplication.processEvents()
    wide: list[QWidget] = [w for w in window.findChildren(QPushButton) if w.isVisible()]
    cut = [
        w.text()
        for w in wide
        if isinstance(w, Button)
        and w.width() < w.sizeHint().width() - (4 if w._kind is Kind.LINK else 12)
    ]
    for part in (window.board, window.settings.lens, window.settings.experts):
        if part.isVisible():
            right = part.mapTo(window.setup, part.rect().topRight()).x()
            cut += [type(part).__name__] if right > window.setup.width() else []
            cut += [
                box.currentText()
                for box in part.findChildren(QComboBox)
                if box.isVisible() and box.width() < 40
            ]
    headline = window.verdict.headline
    if (
        headline.isVisible()
        and headline.fontMetrics().horizontalAdvance(headline.text()) > headline.width()
    ):
        cut.append(headline.text())
    return cut

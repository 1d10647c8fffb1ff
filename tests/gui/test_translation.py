"""Every text of the window goes through Qt's translation: none is left in English."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QLocale, Qt, QTranslator
from PySide6.QtGui import QAction
from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QComboBox,
    QDockWidget,
    QLabel,
    QListWidget,
    QMenu,
    QTableView,
    QTabWidget,
    QWidget,
)
from pytestqt.qtbot import QtBot

import calibgui.gui
from calibgui.app.calibrating.settings import MODEL_CHOICES
from calibgui.app.outputs.manual import list_chapters
from calibgui.app.projects.document import Document
from calibgui.app.system.limit_presets import list_presets
from calibgui.engine.assessment.residuals.residual_checks import NoiseReport
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.methods import METHODS
from calibgui.engine.camera.models import MODELS
from calibgui.engine.images.reading import Image
from calibgui.formats import EXPORTERS
from calibgui.gui import app
from calibgui.gui.dialogs.bug_dialog import BugDialog
from calibgui.gui.dialogs.export_dialog import ExportDialog
from calibgui.gui.dialogs.manual_dialog import ManualDialog
from calibgui.gui.dialogs.print_dialog import PrintDialog
from calibgui.gui.panels.analysis import PANELS
from calibgui.gui.panels.answer.undistort import UndistortPanel
from calibgui.gui.panels.evidence import residuals
from calibgui.gui.widgets.plots import Plot
from calibgui.gui.window.main_window import MainWindow
from calibgui.report.lens_models import describe_lens_model, get_lens_title
from tests.app import examples

OPEN, CLOSE = "⟦", "⟧"
WORD = re.compile(r"[a-z]{4}")
"""In a text that somebody wrote, rather than a name or a number."""


def tool(name: str) -> str:
    found = shutil.which(f"pyside6-{name}", path=str(Path(sys.executable).parent))
    assert found is not None, "PySide6-Essentials brings it"
    return found


@pytest.fixture(scope="module")
def catalogue(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """All texts that Qt's tool finds in the source, each translated to itself in brackets."""
    folder = tmp_path_factory.mktemp("translation")
    texts, compiled = folder / "calibgui_xx.ts", folder / "calibgui_xx.qm"
    source = sorted(Path(next(iter(calibgui.gui.__path__))).rglob("*.py"))
    subprocess.run([tool("lupdate"), *map(str, source), "-ts", texts], check=True)
    tree = ET.parse(texts)
    for message in tree.iter("message"):
        text, translation = message.findtext("source"), message.find("translation")
        assert text is not None
        assert translation is not None
        translation.text = OPEN + text + CLOSE
        translation.attrib.pop("type", None)
    tree.write(texts, encoding="utf-8")
    subprocess.run([tool("lrelease"), texts, "-qm", compiled], check=True)
    return compiled


@pytest.fixture
def translated(qapp: QApplication, catalogue: Path) -> Iterator[None]:
    translator = QTranslator()
    assert translator.load(str(catalogue))
    qapp.installTranslator(translator)
    yield
    qapp.removeTranslator(translator)


def texts(root: QWidget) -> Iterator[str]:
    """Everything that a user can read or hear on `root`."""
    for widget in (root, *root.findChildren(QWidget)):
        yield widget.toolTip()
        yield widget.accessibleName()
        match widget:
            case QLabel() | QAbstractButton():
                yield widget.text()
            case QComboBox():
                for row in range(widget.count()):
                    yield widget.itemText(row)
                    yield widget.itemData(row, Qt.ItemDataRole.ToolTipRole) or ""
            case QTabWidget():
                for row in range(widget.count()):
                    yield widget.tabText(row)
            case QListWidget():
                for row in range(widget.count()):
                    yield widget.item(row).text()
            case QDockWidget():
                yield widget.windowTitle()
            case QMenu():
                yield widget.title()
            case QTableView():
                model = widget.model()
                for column in range(model.columnCount()):
                    for role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.ToolTipRole):
                        yield str(model.headerData(column, Qt.Orientation.Horizontal, role) or "")
            case Plot():
                for side in ("left", "bottom"):
                    yield widget.area.axes[side].labelText
    for action in root.findChildren(QAction):
        yield action.text()
        yield action.statusTip()


def english(root: QWidget, folder: Path) -> set[str]:
    """The texts with words outside the brackets, apart from markup and paths."""
    no_words = re.compile(f"{OPEN}[^{OPEN}{CLOSE}]*{CLOSE}|<[^>]*>|{re.escape(str(folder))}")

    def strip(text: str) -> str:
        while (shorter := no_words.sub("", text)) != text:  # a text may have others in it
            text = shorter
        return text

    return {text for text in texts(root) if WORD.search(strip(text))}


NAMES = {"Calibration 1", "k3 held", "Letter", "Tabloid", "inch", *list_presets()}
OTHERS = {"Close", "Float", "Scroll Left", "Scroll Right", "Export..."}
"""Qt's and pyqtgraph's own."""


@pytest.mark.usefixtures("translated")
def test_no_text_of_the_window_is_left_in_english(
    window: MainWindow, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    grey = Image(np.zeros((150, 200), np.uint8), tmp_path)
    monkeypatch.setattr(window.session.images, "read", lambda _: grey)
    monkeypatch.setattr(residuals, "check_residuals", lambda *_: NoiseReport(()))
    window.session.begin(Document(examples.calibrated(tmp_path)))
    analysis = window.need_analysis()
    for kind in PANELS:
        analysis.show_panel(kind)
        qtbot.waitUntil(lambda: not window.session.jobs.running, timeout=60_000)
    assert window.session.result is not None
    manual = ManualDialog(window)
    export = ExportDialog(window.session.jobs, window.session.result, window)
    others = PrintDialog(Board(5, 6, 20.0), window), BugDialog(ValueError("x"), window)
    qtbot.waitUntil(lambda: not window.session.jobs.running, timeout=60_000)
    left = english(window, tmp_path)
    for dialog in (manual, export, *others):
        dialog.done(0)
    formats = {
        text
        for exporter in EXPORTERS.values()
        for text in (exporter.title, exporter.readers, exporter.keeps, exporter.loses)
    }
    lenses = {
        text
        for model in MODEL_CHOICES
        for text in (get_lens_title(model), f"{model}. {describe_lens_model(model)}")
    }
    coefficients = {name for lens in MODELS.values() for name in lens.names}
    chapters = {chapter.title for chapter in list_chapters()}
    methods = {
        text
        for name, method in METHODS.items()
        for text in (method.title, f"{method.title} ({name}). {method.limits}\n{method.source}")
    }
    undistort = analysis.show_panel(UndistortPanel)
    assert isinstance(undistort, UndistortPanel)
    told = {
        export.note.text(),
        undistort.lost.text(),
        window.verdict.reason.text(),
    }  # by the engine, as the sentences of the summary are
    headings = {f"{name} ± 1σ" for name in NAMES}  # of results, which the user names
    left = {text for text in left if not text.startswith(f"{OPEN}Table of ")}  # and their tables
    assert (
        left
        <= NAMES | headings | OTHERS | formats | lenses | coefficients | methods | told | chapters
    )


def test_qts_tool_knows_whose_each_text_is(catalogue: Path) -> None:
    """A text without a context is looked up under another one, and never found."""
    tree = ET.parse(catalogue.with_suffix(".ts"))
    for context in tree.iter("context"):
        assert context.findtext("name"), [m.findtext("source") for m in context.iter("message")]


def test_the_users_language_is_loaded(
    qapp: QApplication, catalogue: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copy(catalogue, tmp_path / "calibgui_it.qm")
    monkeypatch.setattr(app, "find_resource", lambda _: tmp_path)
    before = QLocale()
    QLocale.setDefault(QLocale("it_IT"))
    app._translate(qapp)
    try:
        assert qapp.translate("MainWindow", "C&alibrate") == OPEN + "C&alibrate" + CLOSE
    finally:
        QLocale.setDefault(before)
        for translator in qapp.findChildren(QTranslator):
            qapp.removeTranslator(translator)
            translator.deleteLater()

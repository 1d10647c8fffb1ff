"""A result is laid out as a page, and printed with its sentences, numbers and plots."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtGui import QImage, QTextDocument
from PySide6.QtPrintSupport import QPrinter, QPrintPreviewDialog
from pytestqt.qtbot import QtBot

from calibgui.dataset import Result
from calibgui.gui.dialogs.print_results import lay_out, make_document
from calibgui.gui.window.main_window import MainWindow
from calibgui.report.numbers import format_with_sigma
from calibgui.report.summary import describe_calibration
from tests.app import examples


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Result:
    return examples.calibrated(tmp_path_factory.mktemp("views")).results["k3 held"]


@pytest.fixture
def document(result: Result) -> QTextDocument:
    return make_document(lay_out(result, "k3 <held> & more"))


def test_the_page_says_what_the_window_says(document: QTextDocument, result: Result) -> None:
    text = document.toPlainText()
    assert "Calibration “k3 <held> & more”" in text
    for sentence in describe_calibration(result):
        assert sentence.text in text
    calibration = result.calibration
    assert format_with_sigma(calibration.camera.params[0], calibration.sigma[0]) in text
    assert "held at 0" in text
    assert f"{calibration.residuals[2].rms:.3f}" in text
    for heading in ("RMS [px]", "Distance [mm]", "Tilt [°]"):
        assert heading in text


def test_headings_keep_their_distance_from_tables(document: QTextDocument) -> None:
    layout = document.documentLayout()
    heading = document.firstBlock()
    while heading.text() != "Views":
        heading = heading.next()
    above = layout.blockBoundingRect(heading.previous()).bottom()  # the table's last cell
    assert layout.blockBoundingRect(heading).top() - above > 10


def test_every_plot_is_there(document: QTextDocument) -> None:
    names = ("residuals", "histograms", "distortion")
    for name in names:
        assert f'src="{name}"' in document.toHtml()
        image = document.resource(QTextDocument.ResourceType.ImageResource, name)
        assert isinstance(image, QImage) and image.width() > 500


def test_it_prints(document: QTextDocument, tmp_path: Path) -> None:
    printer = QPrinter(QPrinter.PrinterMode.HighResolution)
    printer.setOutputFormat(QPrinter.OutputFormat.PdfFormat)
    printer.setOutputFileName(str(tmp_path / "result.pdf"))
    document.print_(printer)
    written = (tmp_path / "result.pdf").read_bytes()
    assert written.startswith(b"%PDF") and len(written) > 50_000


def test_the_command_opens_a_preview(full: MainWindow, qtbot: QtBot) -> None:
    action = next(a for a in full.menuBar().actions()[0].menu().actions() if "Print" in a.text())
    assert action.isEnabled()
    action.trigger()
    qtbot.waitUntil(lambda: bool(full.findChildren(QPrintPreviewDialog)), timeout=30_000)
    (preview,) = full.findChildren(QPrintPreviewDialog)
    assert preview.windowTitle() == "Print “k3 held”"
    preview.reject()

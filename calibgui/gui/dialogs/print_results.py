"""Printing a result: its page is laid out beside the main thread and shown before it is printed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QByteArray, QObject, QUrl
from PySide6.QtGui import QImage, QTextDocument
from PySide6.QtWidgets import QWidget

from calibgui.dataset import Result
from calibgui.gui.session.session import Session
from calibgui.gui.widgets.actions import show_dialog

if TYPE_CHECKING:
    from PySide6.QtPrintSupport import QPrinter

    from calibgui.report.printed_page import PrintedPage


class ResultPrinter(QObject):
    """Shows the page of the session's result as it will be printed, to a printer or a PDF file.

    Args:
        session: whose shown result is printed.
        window: over which the preview opens.
    """

    def __init__(self, session: Session, window: QWidget) -> None:
        super().__init__(window)
        self._session, self._window = session, window
        self._printer: QPrinter | None = None
        """What the preview prints to, which does not keep it alive."""

    def preview(self) -> None:
        """Lay the shown result out, then show the pages."""
        result, name = self._session.result, self._session.result_name
        if result is not None:
            self._session.jobs.start(
                self.tr("Laying out “{0}”").format(name),
                lambda _: lay_out(result, name),
                lambda page: self._show(name, page),
                owner=self,
            )

    def _show(self, name: str, page: PrintedPage) -> None:
        # Loaded late: the window is on screen sooner, and few print.
        from PySide6.QtPrintSupport import QPrinter, QPrintPreviewDialog

        document = make_document(page)
        self._printer = QPrinter(QPrinter.PrinterMode.HighResolution)
        dialog = QPrintPreviewDialog(self._printer, self._window)
        dialog.setWindowTitle(self.tr("Print “{0}”").format(name))
        document.setParent(dialog)
        dialog.paintRequested.connect(document.print_)
        dialog.resize(900, 660)
        show_dialog(dialog)


def lay_out(result: Result, name: str) -> PrintedPage:
    """Make the page of a result; in a worker, where loading the plotting library is not felt."""
    from calibgui.report.printed_page import make_printed_page

    return make_printed_page(result, name)


def make_document(page: PrintedPage) -> QTextDocument:
    """Return a page with its pictures as a document that can be printed."""
    document = QTextDocument()
    for name, png in page.pictures.items():
        image = QImage.fromData(QByteArray(png))
        document.addResource(QTextDocument.ResourceType.ImageResource, QUrl(name), image)
    document.setDefaultStyleSheet("* { color: black; }")
    document.setHtml(page.html)
    return document

"""The manual beside the work: its chapters, one at a time."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt, QUrl
from PySide6.QtGui import QDesktopServices, QImage, QResizeEvent
from PySide6.QtWidgets import (
    QDialog,
    QListWidget,
    QTextBrowser,
    QWidget,
)

from calibgui.app.outputs.manual import list_chapters, render_chapter, write_manual
from calibgui.app.system.state_folder import find_state_folder
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.actions import make_buttons
from calibgui.gui.widgets.buttons import Button
from calibgui.gui.widgets.focus_ring import FocusRing
from calibgui.gui.widgets.layouts import make_column, make_row
from calibgui.gui.widgets.scrolling import make_thin


class ManualDialog(QDialog):
    """Lists the chapters at the left and shows the chosen one; the rest of the window stays usable.

    Args:
        parent: over which the dialog stands.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Manual"))
        self._chapters = list_chapters()
        self.chapters = QListWidget()
        self.chapters.setAccessibleName(self.tr("Chapters"))
        self.chapters.addItems([chapter.title for chapter in self._chapters])
        self.chapters.setFixedWidth(self.chapters.sizeHintForColumn(0) + 4 * theme.SPACING)
        self.chapters.setSpacing(2)
        FocusRing(self.chapters)
        self.text = _ChapterText()
        self.text.setAccessibleName(self.tr("Chapter"))
        self.text.anchorClicked.connect(self._follow)
        self.browse = Button(self.tr("Open in the &browser"), takes_enter=False)
        self.browse.setToolTip(self.tr("All chapters as one page, to search and to print"))
        self.browse.clicked.connect(self._open_page)
        buttons = make_buttons(self, self.browse)
        columns = make_row(self.chapters, (self.text, 1))
        make_column((columns, 1), buttons, of=self, margins=theme.MARGIN)
        self.resize(1080, 680)
        self.chapters.currentRowChanged.connect(self._show_chapter)
        theme.follow(self._restyle)
        self.chapters.setCurrentRow(0)

    def _restyle(self) -> None:
        self._show_chapter(self.chapters.currentRow())

    def _show_chapter(self, row: int) -> None:
        html = render_chapter(self._chapters[row], Path.as_uri)
        # Without these Qt knows no borders of single cells, and padding takes room from words.
        table = '<table cellspacing="0" cellpadding="4" style="border-collapse: collapse">'
        self.text.show_chapter(html.replace("<table>", table))

    def _follow(self, link: QUrl) -> None:
        """Show what a link leads to: a heading of the manual, or a page of the network."""
        if link.scheme():
            QDesktopServices.openUrl(link)
            return
        chapter, _, heading = link.fragment().partition(".")
        self.chapters.setCurrentRow([each.name for each in self._chapters].index(chapter))
        if heading:
            self.text.scrollToAnchor(link.fragment())

    def _open_page(self) -> None:
        path = find_state_folder() / "manual.html"
        write_manual(path)
        QDesktopServices.openUrl(QUrl.fromLocalFile(path))


class _ChapterText(QTextBrowser):
    """Shows a chapter, its pictures no wider than there is room."""

    def __init__(self) -> None:
        super().__init__()
        self._html = ""
        self.setOpenLinks(False)
        make_thin(self)
        # A bar that comes with a long chapter would change the width while that is laid out.
        self.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOn)
        self.document().setDocumentMargin(theme.MARGIN)
        FocusRing(self)

    def show_chapter(self, html: str) -> None:
        """Show a chapter from its beginning, in the colours of the window."""
        self._html = html
        self.document().setDefaultStyleSheet(_make_style())
        self.setHtml(html)

    def loadResource(self, kind: int, name: QUrl | str) -> Any:  # noqa: N802, ARG002 - Qt's
        picture = QImage(QUrl(name).toLocalFile())
        room = self.viewport().width() - 3 * theme.MARGIN
        if picture.width() <= room:
            return picture
        return picture.scaledToWidth(room, Qt.TransformationMode.SmoothTransformation)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        super().resizeEvent(event)
        if "<img" in self._html and event.size().width() != event.oldSize().width():
            place = self.verticalScrollBar().value()
            self.setHtml(self._html)
            self.verticalScrollBar().setValue(place)


def _make_style() -> str:
    """Return what a chapter looks like in the colours of the window."""
    colours = theme.current()
    return f"""
        h2 {{ margin-top: 20px }} h3 {{ margin-top: 14px }}
        th {{ color: {colours.muted}; text-align: left }}
        td, th {{ border-bottom: 1px solid {colours.line} }}
        pre {{ background-color: {colours.window}; white-space: pre-wrap }}
        a {{ color: {colours.accent} }}
    """

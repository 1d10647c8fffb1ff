"""Text that takes the room that it needs, up to some lines; the rest is scrolled to."""

from __future__ import annotations

import math

from PySide6.QtCore import Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QFrame, QSizePolicy, QTextBrowser

from calibgui.gui.widgets.focus_ring import FocusRing
from calibgui.gui.widgets.scrolling import make_thin
from calibgui.gui.widgets.wrapped_label import typeset

_SHARE = 0.1
"""Share of the window's height that the text may take, if that is more than its lines."""


class ScrollingText(QTextBrowser):
    """Shows text without a frame, that can be selected.

    Args:
        lines: the most that are shown at once in a window that is not high.
    """

    def __init__(self, lines: int) -> None:
        super().__init__()
        self._lines = lines
        self._text = ""
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.viewport().setAutoFillBackground(False)
        self.document().setDocumentMargin(0)
        make_thin(self)
        FocusRing(self)

    def show_text(self, text: str) -> None:
        """Show a text, from its beginning."""
        if text != self._text:
            self._text = text
            self.setPlainText(typeset(text))
            self._fit()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        line = self.fontMetrics().lineSpacing()
        lines = max(self._lines, math.floor(_SHARE * self.window().height() / line))
        self.setFixedHeight(min(math.ceil(self.document().size().height()), lines * line))

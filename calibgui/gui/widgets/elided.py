"""Text that gives up a part of itself, not its neighbours' room."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QPainter, QPaintEvent
from PySide6.QtWidgets import QLabel, QSizePolicy

_NAME_LENGTH = 30
"""Characters of a name that leave room for some words in the narrowest panel (chosen)."""

_FEWEST = 8
"""Characters of a longer text that tell nobody anything (chosen)."""


def elide_name(name: str, most: int = _NAME_LENGTH) -> str:
    """Return a file's name, "…" for its middle if it has more letters than there is room for.

    Qt breaks a line between words only: a name is one, and would be cut or widen a plot.
    """
    if len(name) <= most:
        return name
    kept = (most - 1) // 2
    return f"{name[:kept]}…{name[-kept:]}"


class ElidedLabel(QLabel):
    """As wide as the layout lets it be; "…" stands for what does not fit."""

    def __init__(self) -> None:
        super().__init__()
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)

    def shown_text(self) -> str:
        """The part of the text that there is room for; nothing in place of a few letters of it."""
        shown = self.fontMetrics().elidedText(
            self.text(), Qt.TextElideMode.ElideRight, self.contentsRect().width()
        )
        return shown if shown == self.text() or len(shown) > _FEWEST else ""

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        painter = QPainter(self)
        painter.setPen(self.palette().color(self.foregroundRole()))
        painter.drawText(self.contentsRect(), int(self.alignment()), self.shown_text())

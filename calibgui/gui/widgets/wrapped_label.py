"""Text in several lines, none of which breaks between a number and its unit."""

from __future__ import annotations

import re

from PySide6.QtWidgets import QLabel, QWidget

_UNITS = ("px", "mm", "m", "s", "ms", "min", "MB", "MP", "dpi", "%", "°", "degrees")
_SPACES_WITHIN_VALUES = re.compile(
    rf" (?=[=±] )|(?<= [=±]) |(?<=\d) (?=(?:{'|'.join(_UNITS)})(?!\w))"
)
"""The spaces beside "=" and "±", and those between numbers and units."""


def join_values(text: str) -> str:
    """Join numbers with their units, names and standard deviations: no line breaks between them."""
    return _SPACES_WITHIN_VALUES.sub("\N{NO-BREAK SPACE}", text)


class WrappedLabel(QLabel):
    """As many lines as the text needs in the width that the layout gives it."""

    def __init__(self, text: str = "", parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWordWrap(True)
        self.setText(text)

    def setText(self, text: str) -> None:  # noqa: N802 - Qt's name
        """Show a text."""
        self._text = text
        super().setText(join_values(text))

    def text(self) -> str:
        """Return the text as it was set, which has plain spaces."""
        return self._text

"""Text in several lines, none of which breaks between a number and its unit."""

from __future__ import annotations

import re

from PySide6.QtWidgets import QLabel, QWidget

from calibgui.gui.widgets.sizes import set_times_signs

_UNITS = ("px", "mm", "m", "s", "ms", "min", "MB", "MP", "dpi", "%", "°", "degrees")
_SPACES_WITHIN_VALUES = re.compile(
    rf" (?=[=±×] )|(?<= [=±×]) |(?<=\d) (?=(?:{'|'.join(_UNITS)})(?!\w))"
)
"""The spaces beside "=", "±" and "×", and those between numbers and units."""


def typeset(text: str) -> str:
    """Write "7 × 10" for "7 x 10", and break no line between a number and what belongs to it."""
    return _SPACES_WITHIN_VALUES.sub("\N{NO-BREAK SPACE}", set_times_signs(text))


class WrappedLabel(QLabel):
    """As many lines as the text needs in the width that the layout gives it."""

    _text = ""

    def __init__(self, text: str = "", parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWordWrap(True)
        self.setText(text)

    def setText(self, text: str) -> None:  # noqa: N802 - Qt's name
        """Show a text."""
        self._text = text
        super().setText(typeset(text))

    def text(self) -> str:
        """Return the text as it was set, which has plain spaces."""
        return self._text

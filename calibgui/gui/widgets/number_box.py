"""A field for a number, which is written as all others of the window are: with a point."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import QLocale
from PySide6.QtGui import QValidator
from PySide6.QtWidgets import QDoubleSpinBox


class NumberBox(QDoubleSpinBox):
    """Shows a point in every country, as tables, files and commands do; a comma is taken for one.

    Args:
        properties: those of the box by their Qt names.
    """

    def __init__(self, **properties: Any) -> None:
        super().__init__(**properties)
        self.setLocale(QLocale.c())

    def validate(self, text: str, place: int) -> tuple[QValidator.State, str, int]:
        """Tell whether a text is a number, a comma in it replaced."""
        return super().validate(text.replace(",", "."), place)

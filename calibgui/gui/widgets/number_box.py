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

    def show_value(self, value: float) -> None:
        """Show a value without announcing it; what is typed stays where it is the same, rounded."""
        if abs(self.value() - value) > 10.0 ** -self.decimals() / 2:
            blocked = self.blockSignals(True)
            self.setValue(value)
            self.blockSignals(blocked)

    def validate(self, text: str, place: int) -> tuple[QValidator.State, str, int]:
        """Tell whether a text is a number, a comma in it replaced."""
        return super().validate(text.replace(",", "."), place)

"""A box for a number that is as wide as the numbers need, not as its largest possible one."""

from __future__ import annotations

from PySide6.QtWidgets import QDoubleSpinBox

_ARROWS = 32
"""Width of a box's arrows and frame, device-independent px."""


def fit_width(box: QDoubleSpinBox, longest: str) -> None:
    """Make a box as wide as the longest text that it usually shows, prefix and unit included."""
    box.setFixedWidth(box.fontMetrics().horizontalAdvance(longest) + _ARROWS)

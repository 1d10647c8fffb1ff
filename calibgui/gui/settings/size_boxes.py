"""The fields for how many inner corners a board has."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication
from PySide6.QtWidgets import QSpinBox

from calibgui.app.projects.project import GRID_LINES

translate = QCoreApplication.translate
UNKNOWN = GRID_LINES.start - 1
"""Value of a box for a number of rows or columns that is not known."""


def make_size_boxes() -> tuple[QSpinBox, QSpinBox]:
    """Make the boxes for the numbers of rows and columns."""
    boxes = []
    for name in (
        translate("BoardPanel", "rows of inner corners"),
        translate("BoardPanel", "columns of inner corners"),
    ):
        box = QSpinBox(minimum=UNKNOWN, maximum=GRID_LINES[-1])
        box.setAccessibleName(name)
        box.setToolTip(
            translate(
                "BoardPanel", "Corners where four squares meet: one fewer than squares each way."
            )
        )
        box.setSpecialValueText("–")
        boxes.append(box)
    rows, cols = boxes
    return rows, cols

"""Content that scrolls where it is higher than its place, on the ground of what is around it."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QAbstractScrollArea, QFrame, QScrollArea, QWidget

SCROLL_BAR_WIDTH = 8
"""Of a scroll bar, device-independent px."""
_THIN = (
    f"QScrollBar:vertical {{ width: {8}px; background: transparent; }}"
    f"QScrollBar:horizontal {{ height: {8}px; background: transparent; }}"
    f"QScrollBar::handle {{ background: rgba(120, 130, 142, 140); border-radius: {4}px; }}"
    "QScrollBar::handle:vertical { min-height: 24px; }"
    "QScrollBar::handle:horizontal { min-width: 24px; }"
    "QScrollBar::add-line, QScrollBar::sub-line { width: 0; height: 0; }"
    "QScrollBar::add-page, QScrollBar::sub-page { background: transparent; }"
)


def make_scrollable(content: QWidget) -> QScrollArea:
    """Return an area as wide as its content may be, in which that scrolls up and down."""
    area = QScrollArea(widgetResizable=True)
    area.setWidget(content)
    for widget in (area.viewport(), content):
        widget.setAutoFillBackground(False)
    make_calm(area)
    return area


def make_calm(area: QAbstractScrollArea) -> None:
    """Give an area no frame, thin scroll bars, and no stop of the Tab key."""
    area.setFrameShape(QFrame.Shape.NoFrame)
    area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
    make_thin(area)


def make_thin(area: QAbstractScrollArea) -> None:
    """Give an area thin scroll bars."""
    for bar in (area.horizontalScrollBar(), area.verticalScrollBar()):
        bar.setStyleSheet(_THIN)

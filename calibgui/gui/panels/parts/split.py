"""Two parts side by side where there is room, one above the other where there is not."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QSplitter, QWidget


class Split(QSplitter):
    """Parts side by side if there are `least` px and more width than height, with their shares."""

    def __init__(self, least: int, *parts: tuple[QWidget, int]) -> None:
        super().__init__(Qt.Orientation.Vertical)  # asks for less width until there is room
        self._least = least
        self._shares = [share for _, share in parts]
        self.setChildrenCollapsible(False)
        for part, _ in parts:
            self.addWidget(part)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        width, height = event.size().width(), event.size().height()
        wide = width >= self._least and width > height
        orientation = Qt.Orientation.Horizontal if wide else Qt.Orientation.Vertical
        if orientation is not self.orientation() or not event.oldSize().isValid():
            self.setOrientation(orientation)
            length = width if wide else height
            self.setSizes([length * share // sum(self._shares) for share in self._shares])
        super().resizeEvent(event)

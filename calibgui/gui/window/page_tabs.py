"""Tabs that are as high as the page that is shown."""

from __future__ import annotations

from PySide6.QtCore import QSize
from PySide6.QtWidgets import QSizePolicy, QTabWidget, QWidget


class PageTabs(QTabWidget):
    """Leaves the rest of the height to its neighbours; pages may grow and shrink."""

    def __init__(self) -> None:
        super().__init__(documentMode=True)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)
        self._pages: list[QWidget] = []
        self.currentChanged.connect(self._fit)

    def add(self, page: QWidget, title: str) -> None:
        """Add a page at the end."""
        self._pages.append(page)
        self.addTab(page, title)
        self._fit()

    def sizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        return self.minimumSizeHint()  # Qt's own counts hidden pages

    def _fit(self) -> None:
        shown, hidden = QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Ignored
        for k, page in enumerate(self._pages):
            vertical = shown if k == self.currentIndex() else hidden
            page.setSizePolicy(QSizePolicy.Policy.Preferred, vertical)
        self.updateGeometry()

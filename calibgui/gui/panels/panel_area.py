"""The place of a panel, in which it scrolls if it needs more height than there is."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QFrame, QScrollArea

from calibgui.gui.panels.panel import Panel


class PanelArea(QScrollArea):
    """Makes a panel as wide as itself, and as high unless the panel needs more.

    Qt's own way gives widgets with wrapped text the height that they would like to have, not the
    least: every plot would scroll.
    """

    def __init__(self, panel: Panel) -> None:
        super().__init__()
        self.panel = panel
        self.setWidget(panel)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        panel.body.installEventFilter(self)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        super().resizeEvent(event)
        self._fit()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        if watched is self.panel.body and event.type() == QEvent.Type.LayoutRequest:
            self._fit()
        return super().eventFilter(watched, event)

    def _fit(self) -> None:
        port = self.viewport().size()
        self.panel.resize(port.width(), max(port.height(), self._find_least_height(port.width())))

    def _find_least_height(self, width: int) -> int:
        """Return the height that the panel's content needs at a width, px."""
        layout = self.panel.body.layout()
        if layout is not None and layout.hasHeightForWidth():
            return layout.minimumHeightForWidth(width)
        return self.panel.body.minimumSizeHint().height()

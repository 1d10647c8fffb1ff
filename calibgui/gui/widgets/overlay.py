"""A widget that lies over another instead of pushing it aside."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject
from PySide6.QtWidgets import QWidget


class Overlay(QObject):
    """Keeps a widget over the upper edge of another, as wide as that and as high as it needs.

    Args:
        widget: what lies over the other, outside of any layout.
        host: the widget that it becomes a child of.
    """

    def __init__(self, widget: QWidget, host: QWidget) -> None:
        super().__init__(widget)
        self._widget, self._host = widget, host
        visible = not widget.isHidden()
        widget.setParent(host)
        widget.setVisible(visible)
        widget.installEventFilter(self)
        host.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        if event.type() in (QEvent.Type.Resize, QEvent.Type.LayoutRequest, QEvent.Type.Show):
            self._place(watched)
        return False

    def _place(self, watched: QObject) -> None:
        widget, host = self._widget, self._host
        if watched not in (widget, host):
            return
        width = host.width()
        height = max(widget.heightForWidth(width), widget.minimumSizeHint().height())
        if widget.geometry().getRect() != (0, 0, width, height):
            widget.setGeometry(0, 0, width, height)
        widget.raise_()

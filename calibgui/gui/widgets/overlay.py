"""A widget that lies over another instead of pushing it aside."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject
from PySide6.QtWidgets import QWidget

_ON_TOP = "on top"
"""Property of a widget that names what lies over it on top of all others."""


class Overlay(QObject):
    """Keeps a widget over another, as wide, and as high as it needs for that width.

    It hangs below what lies over the same widget by `is_on_top`, so that it covers no message.

    Args:
        widget: what lies over the other, outside of any layout.
        host: the widget that it becomes a child of.
        at_bottom: whether it stands on the host's lower edge in place of hanging.
        width: of a widget that stands at the right, px; 0 for one as wide as the host.
        fills: whether it is as high as the host.
        is_on_top: whether others hang below it.
        beside: a widget at the host's left that it leaves free while that is shown.
    """

    def __init__(
        self,
        widget: QWidget,
        host: QWidget,
        *,
        at_bottom: bool = False,
        width: int = 0,
        fills: bool = False,
        is_on_top: bool = False,
        beside: QWidget | None = None,
    ) -> None:
        super().__init__(widget)
        self._widget, self._host = widget, host
        self._at_bottom, self._width, self._fills = at_bottom, width, fills
        visible = not widget.isHidden()
        widget.setParent(host)
        widget.setVisible(visible)
        if is_on_top:
            host.setProperty(_ON_TOP, widget)
        above = host.property(_ON_TOP)
        self._above = above if isinstance(above, QWidget) and above is not widget else None
        self._beside = beside
        watched = (widget, host, self._above, self._beside)
        self._watched = [part for part in watched if part is not None]
        for part in self._watched:
            part.installEventFilter(self)

    def place(self) -> None:
        """Take the place that the widget needs now."""
        widget, host = self._widget, self._host
        above, beside = self._above, self._beside
        top = 0 if above is None or above.isHidden() else above.height()
        left = beside.width() if beside is not None and beside.isVisibleTo(host) else 0
        room = host.height() - top
        width = min(self._width, host.width()) if self._width else host.width() - left
        needed = widget.heightForWidth(width)
        if needed < 0:  # it does not depend on the width
            needed = widget.minimumSizeHint().height()
        height = room if self._fills else min(needed, room)
        if self._at_bottom:
            top = host.height() - height
        place = (host.width() - width, top, width, height)
        if widget.geometry().getRect() != place:
            widget.setGeometry(*place)
            if (layout := widget.layout()) is not None:  # it may be in the midst of an earlier size
                layout.invalidate()
        widget.raise_()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        moves = (QEvent.Type.Resize, QEvent.Type.LayoutRequest, QEvent.Type.Show, QEvent.Type.Hide)
        if event.type() in moves and watched in self._watched:
            self.place()
        return False

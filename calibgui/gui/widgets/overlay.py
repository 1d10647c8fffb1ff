"""A widget that lies over another instead of pushing it aside."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, QPoint
from PySide6.QtWidgets import QWidget


class Overlay(QObject):
    """Keeps a widget over another, as high as it needs for its width.

    Args:
        widget: what lies over the other, outside of any layout.
        host: the widget that it becomes a child of.
        bar: the part of the host that it hangs from, as wide as that; None for its upper edge.
        share: share of the host's height below that it may take.
        at_bottom: whether it stands on the host's lower edge in place of hanging.
        narrowest: width that it needs, px. It stands to the left of a bar that is narrower, or
            hangs across the host where there is too little room as well.
        beside: the part of the host, to the left of the bar, that it hangs in where it stands
            there.
    """

    def __init__(
        self,
        widget: QWidget,
        host: QWidget,
        bar: QWidget | None = None,
        share: float = 1.0,
        at_bottom: bool = False,
        narrowest: int = 0,
        beside: QWidget | None = None,
    ) -> None:
        super().__init__(widget)
        self._widget, self._host, self._bar, self._share = widget, host, bar, share
        self._at_bottom, self._narrowest, self._beside = at_bottom, narrowest, beside
        visible = not widget.isHidden()
        widget.setParent(host)
        widget.setVisible(visible)
        self._watched = (widget, host) if bar is None else (widget, host, bar)
        for part in self._watched:
            part.installEventFilter(self)

    def place(self) -> None:
        """Take the place that the widget needs now."""
        widget, host, bar = self._widget, self._host, self._bar
        top, width = QPoint(), host.width()
        if bar is not None:
            corner = bar.mapTo(host, QPoint())
            left, room = QPoint(), corner.x()
            if self._beside is not None:
                left = self._beside.mapTo(host, QPoint())
                room = min(corner.x() - left.x(), self._beside.width())
            if bar.width() >= self._narrowest:
                top, width = corner + QPoint(0, bar.height()), bar.width()
            elif room >= self._narrowest:
                top, width = left, room
            else:
                top.setY(corner.y() + bar.height())
        needed = widget.heightForWidth(width)
        if needed < 0:  # it does not depend on the width
            needed = widget.minimumSizeHint().height()
        height = min(needed, round(self._share * (host.height() - top.y())))
        if self._at_bottom:
            top.setY(host.height() - height)
        if widget.geometry().getRect() != (top.x(), top.y(), width, height):
            widget.setGeometry(top.x(), top.y(), width, height)
            if (layout := widget.layout()) is not None:  # it may be in the midst of an earlier size
                layout.invalidate()
        widget.raise_()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        moves = (QEvent.Type.Resize, QEvent.Type.LayoutRequest, QEvent.Type.Show)
        if event.type() in moves and watched in self._watched:
            self.place()
        return False

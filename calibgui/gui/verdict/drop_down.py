"""A frame that opens at the verdict's bar over the desk: what is under it does not move."""

from __future__ import annotations

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QFrame, QWidget

from calibgui.gui.widgets import theme
from calibgui.gui.widgets.overlay import Overlay

PICTURE = "picture"
"""Name of the widget of a window that it covers where it stands to the left of its bar."""
_NARROWEST = 640
"""Width that it needs, device-independent px."""


class DropDown(QFrame):
    """Hangs from a bar until Escape closes it; `heightForWidth` is the height that it asks for.

    It stands to the left of a bar that is too narrow for it; see `Overlay`.

    Args:
        bar: the widget that it hangs from.
        share: share of the window's height below that it may take.
    """

    closed = Signal()
    """The user has closed it by Escape."""

    def __init__(self, bar: QWidget, share: float = 1.0) -> None:
        super().__init__(bar)
        self._bar, self._share = bar, share
        self._overlay: Overlay | None = None
        self.setObjectName("overlay")
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.hide()

    def open_up(self) -> None:
        """Lie over the desk."""
        if self._overlay is None:  # by now the bar is in its window
            window = self._bar.window()
            self._overlay = Overlay(
                self,
                window,
                self._bar,
                self._share,
                narrowest=_NARROWEST,
                beside=window.findChild(QWidget, PICTURE),
            )
        self._restyle()
        self._overlay.place()
        self.show()

    def fit(self) -> None:
        """Take the height that the content needs now."""
        if self._overlay is not None:
            self._overlay.place()

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 - Qt's name
        if event.key() == Qt.Key.Key_Escape:
            self.hide()
            self.closed.emit()
        else:
            super().keyPressEvent(event)

    def changeEvent(self, event: QEvent) -> None:  # noqa: N802 - Qt's name
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange:
            self._restyle()

    def _restyle(self) -> None:
        colours = theme.current()
        style = (
            f"#overlay {{ background: {colours.base}; border: 1px solid {colours.line};"
            f" border-top: none; border-bottom: 2px solid {colours.accent}; }}"
        )
        if style != self.styleSheet():
            self.setStyleSheet(style)

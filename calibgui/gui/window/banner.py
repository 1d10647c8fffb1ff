"""A line across the window for failures with their remedies, messages and questions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from PySide6.QtCore import Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QFrame, QGridLayout, QPushButton, QToolButton, QWidget

from calibgui.engine.errors import CalibrationError
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button
from calibgui.gui.widgets.layouts import make_row
from calibgui.gui.widgets.wrapped_label import WrappedLabel

_NARROW = 640
"""Width below which a message and two buttons have no room beside each other, px."""


class Banner(QFrame):
    """Shown until it is dismissed or the next message comes; a failure until work goes on.

    A question, which has choices, comes back after what covered it, another question too. So does a
    message that a question covered.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.text = WrappedLabel()
        self.text.setTextFormat(Qt.TextFormat.PlainText)
        self.text.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.buttons: list[QPushButton] = []
        self.dismiss = QToolButton()
        self.dismiss.setText("✕")
        self.dismiss.setAutoRaise(True)
        self.dismiss.setToolTip(self.tr("Dismiss this message"))
        self.dismiss.setAccessibleName(self.dismiss.toolTip())
        self.dismiss.clicked.connect(self._end)
        self._choices = QWidget()
        self._row = make_row(None, of=self._choices)
        self._grid = QGridLayout(self)
        self._grid.setColumnStretch(0, 1)
        self._grid.addWidget(self.text, 0, 0)
        self._grid.addWidget(self._choices, 0, 1)
        self._grid.addWidget(self.dismiss, 0, 2, Qt.AlignmentFlag.AlignTop)
        self._failure = False
        theme.follow(self._restyle)
        self._kept: dict[str, Mapping[str, Callable[[], None]]] = {}
        """Open questions with their choices, and messages, that come back; the latest is last."""
        self.hide()

    def show_error(self, error: CalibrationError) -> None:
        """Show what cannot be done, and the remedy."""
        self._show(f"{error.message}\n{error.hint}".strip(), {}, failure=True)

    def show_text(
        self, text: str, choices: Mapping[str, Callable[[], None]] = MappingProxyType({})
    ) -> None:
        """Show a message; each choice is a button with its text and what it does."""
        if choices:
            if not self.isHidden() and not self._failure:
                self._kept.setdefault(self.text.text(), {})
            self._kept.pop(text, None)
            self._kept[text] = choices
        self._show(text, choices)

    def withdraw(self, text: str) -> None:
        """Take the question or message `text` back, shown or covered; others stay."""
        self._kept.pop(text, None)
        if not self.isHidden() and self.text.text() == text:
            self._show_next()

    def hide_failure(self) -> None:
        """Hide a failure, which is past; a question stays."""
        if self._failure:
            self._end()

    def _end(self) -> None:
        """End what is shown; what it covered comes back."""
        self._kept.pop(self.text.text(), None)
        self._show_next()

    def _show_next(self) -> None:
        """Show the latest of what comes back, or nothing."""
        if self._kept:
            self._show(*list(self._kept.items())[-1])
        else:
            self.hide()

    def _show(
        self, text: str, choices: Mapping[str, Callable[[], None]], *, failure: bool = False
    ) -> None:
        for button in self.buttons:
            button.deleteLater()
        self.buttons = []
        for name, does in choices.items():
            button = Button(name)
            button.clicked.connect(self._end)
            button.clicked.connect(lambda _=False, does=does: does())
            self._row.addWidget(button)
            self.buttons.append(button)
        self._choices.setVisible(bool(choices))
        self.text.setText(text)
        self._failure = failure
        self._restyle()
        self.show()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        """Put the choices below the text where it would be left a narrow column."""
        super().resizeEvent(event)
        if event.size().width() < _NARROW:
            self._grid.addWidget(self._choices, 1, 0, 1, 3)
        else:
            self._grid.addWidget(self._choices, 0, 1)

    def _restyle(self) -> None:
        colours = theme.current()
        base = colours.bad_base if self._failure else colours.warning_base
        edge = colours.bad if self._failure else colours.warning
        style = (
            f"Banner {{ background: {base}; border: none; border-left: 4px solid {edge}; }}"
            f"Banner QLabel {{ color: {colours.text}; }}"
        )
        if style != self.styleSheet():
            self.setStyleSheet(style)

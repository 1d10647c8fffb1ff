"""A line across the window for failures with their remedies, messages and questions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from PySide6.QtCore import QEvent, Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QPushButton, QToolButton, QWidget

from calibgui.engine.errors import CalibrationError
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.wrapped_label import WrappedLabel


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
        self._row = QHBoxLayout(self)
        self._row.addWidget(self.text, 1)
        self._row.addWidget(self.dismiss, 0, Qt.AlignmentFlag.AlignTop)
        self._failure = False
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
            button = QPushButton(name)
            button.clicked.connect(self._end)
            button.clicked.connect(lambda _=False, does=does: does())
            self._row.insertWidget(self._row.count() - 1, button)
            self.buttons.append(button)
        self.text.setText(text)
        self._failure = failure
        self._restyle()
        self.show()

    def changeEvent(self, event: QEvent) -> None:  # noqa: N802 - Qt's name
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and hasattr(self, "_failure"):
            self._restyle()

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

"""A mode shows panels as cards in rows, which scroll where they need more than the desk."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from PySide6.QtCore import QCoreApplication, QEvent, QObject, QRectF
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QResizeEvent
from PySide6.QtWidgets import QLabel, QScrollArea, QWidget

from calibgui.gui.panels.panel import Panel
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.elided import ElidedLabel
from calibgui.gui.widgets.scrolling import make_calm

PANEL_WIDTH = 412
"""Least width of a card, device-independent px; cards of a row stand below each other in less."""
_GAP, _HEAD = 12, 32
"""Between cards and around them, and the height of a card's heading, device-independent px."""


class Row(NamedTuple):
    """Cards side by side."""

    kinds: tuple[type[Panel], ...]
    share: float
    """Share of the desk's height that they take, or more if they need it."""


def name_panel(kind: type[Panel]) -> str:
    """Return the name of a kind of panel for the user."""
    return QCoreApplication.translate(kind.__name__, kind.title)


def describe_panel(kind: type[Panel]) -> str:
    """Return in a sentence what a kind of panel shows."""
    return QCoreApplication.translate(kind.__name__, kind.purpose)


class Card(QWidget):
    """A frame with a heading, for a panel that may come later."""

    def __init__(self, kind: type[Panel]) -> None:
        super().__init__()
        self.kind = kind
        self.panel: Panel | None = None
        self._name, self._purpose = QLabel(name_panel(kind), self), ElidedLabel()
        self._name.setFont(theme.make_font(bold=True))
        self._purpose.setParent(self)
        self._purpose.setFont(theme.make_font(theme.CAPTION))
        self._purpose.setForegroundRole(self.palette().ColorRole.PlaceholderText)
        self._purpose.setText(describe_panel(kind))
        self._purpose.setToolTip(describe_panel(kind))

    def hold(self, panel: Panel) -> None:
        """Take the panel in, hidden until it is wanted."""
        self.panel = panel
        panel.setParent(self)
        panel.body.installEventFilter(self)
        self._arrange()

    def find_least_height(self, width: int) -> int:
        """Return the height that the panel needs in a width, px."""
        if self.panel is None:
            return 0
        inside, layout = width - 2 * _GAP, self.panel.body.layout()
        if layout is not None and layout.hasHeightForWidth():
            return layout.minimumHeightForWidth(inside) + _HEAD + _GAP
        return self.panel.body.minimumSizeHint().height() + _HEAD + _GAP

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        page = self.parentWidget()
        if event.type() == QEvent.Type.LayoutRequest and page is not None:
            QCoreApplication.postEvent(page, QEvent(QEvent.Type.LayoutRequest))
        return super().eventFilter(watched, event)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        super().resizeEvent(event)
        self._arrange()

    def _arrange(self) -> None:
        name = self._name.sizeHint().width()
        self._name.setGeometry(_GAP, 4, name, _HEAD - 4)
        rest = self.width() - name - 3 * _GAP
        self._purpose.setGeometry(name + 2 * _GAP, 4, max(rest, 0), _HEAD - 4)
        if self.panel is not None:
            self.panel.setGeometry(
                _GAP // 2, _HEAD, self.width() - _GAP, self.height() - _HEAD - _GAP // 2
            )

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        painter, colours = QPainter(self), theme.current()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(colours.line), 1))
        painter.setBrush(QColor(colours.base))
        rect = QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5)
        painter.drawRoundedRect(rect, theme.RADIUS, theme.RADIUS)


class ModePage(QScrollArea):
    """The cards of a mode.

    Args:
        rows: from top to bottom.
    """

    def __init__(self, rows: Sequence[Row]) -> None:
        super().__init__()
        self._rows = rows
        self.cards = {kind: Card(kind) for row in rows for kind in row.kinds}
        self._inside = QWidget()
        make_calm(self)
        for card in self.cards.values():
            card.setParent(self._inside)
        self._inside.installEventFilter(self)
        self.setWidget(self._inside)

    def bring_into_sight(self, kind: type[Panel]) -> None:
        """Scroll so that a card is seen from its top."""
        self._arrange()
        self.verticalScrollBar().setValue(self.cards[kind].y() - _GAP)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        if watched is self._inside and event.type() == QEvent.Type.LayoutRequest:
            self._arrange()
        return super().eventFilter(watched, event)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        super().resizeEvent(event)
        self._arrange()

    def _arrange(self) -> None:
        port, top = self.viewport().size(), _GAP
        whole = port.width() - 2 * _GAP
        for row in self._rows:
            count = len(row.kinds)
            width = (whole - (count - 1) * _GAP) // count
            steps = [row.kinds] if width >= PANEL_WIDTH else [(kind,) for kind in row.kinds]
            for kinds in steps:
                width = (whole - (len(kinds) - 1) * _GAP) // len(kinds)
                needed = max(self.cards[kind].find_least_height(width) for kind in kinds)
                height = max(needed, round(row.share * (port.height() - _GAP)) - _GAP)
                for k, kind in enumerate(kinds):
                    self.cards[kind].setGeometry(_GAP + k * (width + _GAP), top, width, height)
                top += height + _GAP
        self._inside.resize(port.width(), max(top, port.height()))

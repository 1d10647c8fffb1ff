"""A tour: a card points at one part of the window after another, and can be left at any step."""

from __future__ import annotations

from typing import NamedTuple

from PySide6.QtCore import QEvent, QObject, QPoint, QRect, QRectF, Qt
from PySide6.QtGui import QColor, QKeyEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QFrame, QLabel, QWidget

from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button, Kind
from calibgui.gui.widgets.layouts import make_column, make_row
from calibgui.gui.widgets.wrapped_label import WrappedLabel

_WIDTH, _GAP = 300, 12
"""Width of the card, and its distance from what it points at, device-independent px."""


class Step(NamedTuple):
    """One thing that is pointed at."""

    widget: QWidget
    title: str
    text: str


class Parts(NamedTuple):
    """The parts of the window that are pointed at, in this order."""

    strip: QWidget
    photograph: QWidget
    verdict: QWidget
    done: QWidget
    modes: QWidget
    setup: QWidget
    export: QWidget
    camera: QWidget


class Tour(QFrame):
    """Lies over the window until it is at its end, or is left; what it points at can be used.

    Args:
        host: the widget that it lies over.
        parts: what it points at.
    """

    def __init__(self, host: QWidget, parts: Parts) -> None:
        super().__init__(host)
        self._host = host
        self.steps, self.place = self._list_steps(parts), 0
        self._ring = _Ring(host)
        self._title, self._words, self._count = QLabel(), WrappedLabel(), QLabel()
        self._title.setFont(theme.make_font(bold=True))
        self._count.setForegroundRole(self._count.palette().ColorRole.PlaceholderText)
        self.leave_button = Button(self.tr("Leave"))
        self.next_button = Button("", Kind.MAIN)
        self.leave_button.clicked.connect(self.leave)
        self.next_button.clicked.connect(self._go_on)
        below = make_row((self._count, 1), self.leave_button, self.next_button)
        self._column = make_column(
            self._title, self._words, below, of=self, margins=(theme.MARGIN, 12, theme.MARGIN, 12)
        )
        host.installEventFilter(self)
        self.show()
        self._show()

    def leave(self) -> None:
        """End the tour."""
        self._ring.deleteLater()
        self.deleteLater()
        self.hide()
        self._ring.hide()

    def _list_steps(self, parts: Parts) -> list[Step]:
        """List what the tour points at."""
        return [
            Step(
                parts.strip,
                self.tr("Your photographs"),
                self.tr(
                    "The bar below each is how far its corners are from where the camera puts "
                    "them. Drag the dashed line, and leave out what is above it."
                ),
            ),
            Step(
                parts.photograph,
                self.tr("One photograph"),
                self.tr(
                    "The corners that were found. Where a board is missed, press Mark and click on "
                    "its four outermost corners."
                ),
            ),
            Step(
                parts.verdict,
                self.tr("The verdict"),
                self.tr(
                    "Whether the camera can be used, and how far off a point is in the image: at "
                    "the centre, at the edge, at worst, and in mm at your distance."
                ),
            ),
            Step(
                parts.done,
                self.tr("What was done"),
                self.tr("Each step that made the camera better can be undone, or says why."),
            ),
            Step(
                parts.modes,
                self.tr("Look closer"),
                self.tr(
                    "Each mode fills the desk: the method step by step, the fit, the lens, the "
                    "board, and images without distortion."
                ),
            ),
            Step(
                parts.setup,
                self.tr("Set-up"),
                self.tr("The board, the lens, and limits for PASS or FAIL."),
            ),
            Step(
                parts.export,
                self.tr("Take it with you"),
                self.tr("Export writes the camera for other programs, Report a page for people."),
            ),
            Step(
                parts.camera,
                self.tr("Still good?"),
                self.tr(
                    "Months later, drop a few new photographs on this side: they check the camera "
                    "and change nothing."
                ),
            ),
        ]

    def _go_on(self) -> None:
        self.place += 1
        if self.place == len(self.steps):
            self.leave()
        else:
            self._show()

    def _show(self) -> None:
        step, last = self.steps[self.place], len(self.steps) - 1
        self._title.setText(step.title)
        self._words.setText(step.text)
        self._count.setText(self.tr("{0} of {1}").format(self.place + 1, last + 1))
        self.next_button.setText(self.tr("Next") if self.place < last else self.tr("Done"))
        self.next_button.setFocus()
        self._fit()

    def _fit(self) -> None:
        """Stand beside what is pointed at, wherever there is room."""
        host, widget = self._host, self.steps[self.place].widget
        shown = widget.isVisibleTo(host)
        target = QRect(widget.mapTo(host, QPoint()), widget.size()) if shown else QRect()
        target &= host.rect()
        self._ring.show_around(target)
        self.resize(_WIDTH, self._column.heightForWidth(_WIDTH))
        room = host.rect().adjusted(_GAP, _GAP, -_GAP, -_GAP)
        beside = (
            QPoint(target.left() - _WIDTH - _GAP, target.top()),
            QPoint(target.center().x() - _WIDTH // 2, target.bottom() + _GAP),
            QPoint(target.center().x() - _WIDTH // 2, target.top() - self.height() - _GAP),
            QPoint(target.right() + _GAP, target.top()),
        )
        inside = [self._shift_into(room, at) for at in beside]
        free = (at for at in inside if not QRect(at, self.size()).intersects(target))
        middle = room.center() - self.rect().center()
        self.move(next(free, middle) if shown else middle)
        self._ring.raise_()
        self.raise_()

    def _shift_into(self, room: QRect, at: QPoint) -> QPoint:
        """Return the nearest place inside a rectangle."""
        x = min(max(at.x(), room.left()), room.right() - self.width())
        y = min(max(at.y(), room.top()), room.bottom() - self.height())
        return QPoint(x, y)

    def eventFilter(self, _: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        if event.type() in (QEvent.Type.Resize, QEvent.Type.LayoutRequest) and self.isVisible():
            self._fit()
        return False

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 - Qt's name
        if event.key() == Qt.Key.Key_Escape:
            self.leave()
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        colours, painter = theme.current(), QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(colours.accent), 1.5))
        painter.setBrush(QColor(colours.base))
        rect = QRectF(self.rect()).adjusted(1, 1, -1, -1)
        painter.drawRoundedRect(rect, theme.RADIUS, theme.RADIUS)


class _Ring(QWidget):
    """A line around what is pointed at, through which one can click."""

    def __init__(self, host: QWidget) -> None:
        super().__init__(host)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)

    def show_around(self, target: QRect) -> None:
        """Lie around a rectangle; nowhere if it is empty."""
        self.setGeometry(target.adjusted(-2, -2, 2, 2))
        self.setVisible(not target.isEmpty())

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(theme.current().accent), 3))
        rect = QRectF(self.rect()).adjusted(2, 2, -2, -2)
        painter.drawRoundedRect(rect, theme.RADIUS, theme.RADIUS)

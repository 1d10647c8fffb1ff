"""The progress of the work that runs, and a button that ends it."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QEvent, QSize
from PySide6.QtWidgets import (
    QHBoxLayout,
    QProgressBar,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from calibgui.gui.jobs.job import Job
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.widgets.elided import ElidedLabel
from calibgui.gui.widgets.icons import Icon, draw_icon

_BAR_HEIGHT, _BUTTON_HEIGHT, _ICON_SIDE = 8, 16, 10
"""Heights of the bar, the button and what is drawn on it, px: with the label above they are as high
as the button *Calibrate*, beside which they stand."""


class Progress(QWidget):
    """Shows the oldest job that has a name; n of m and the time left where they are known.

    Args:
        jobs: the jobs.
        has_button: says whether a button beside this cancels a job, which needs no second one.
    """

    def __init__(self, jobs: Jobs, has_button: Callable[[Job], bool] = lambda _: False) -> None:
        super().__init__()
        self._jobs, self._has_button = jobs, has_button
        self.label = ElidedLabel()
        self.bar = QProgressBar()
        self.bar.setFixedHeight(_BAR_HEIGHT)
        self.bar.setTextVisible(False)
        self.cancel = QToolButton()
        self.cancel.setIcon(draw_icon(Icon.CROSS))
        self.cancel.setIconSize(QSize(_ICON_SIDE, _ICON_SIDE))
        self.cancel.setAutoRaise(True)
        self.cancel.setFixedHeight(_BUTTON_HEIGHT)
        self.cancel.setToolTip(self.tr("Cancel: end this and drop what is not finished"))
        self.cancel.setAccessibleName(self.tr("Cancel"))
        self.cancel.clicked.connect(self._cancel)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addStretch(1)
        column.addWidget(self.label)  # as wide as there is room: it may be a whole sentence
        below = QHBoxLayout()
        below.addWidget(self.bar, 1)
        below.addWidget(self.cancel)
        column.addLayout(below)
        column.addStretch(1)
        for widget in (self, self.cancel):
            keeping = widget.sizePolicy()
            keeping.setRetainSizeWhenHidden(True)  # what stands beside it must not move
            widget.setSizePolicy(keeping)
        jobs.changed.connect(self._refresh)
        self._refresh()

    def changeEvent(self, event: QEvent) -> None:  # noqa: N802 - Qt's name
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and hasattr(self, "cancel"):
            self.cancel.setIcon(draw_icon(Icon.CROSS))

    def _shown(self) -> Job | None:
        return next((job for job in self._jobs.running if job.label), None)

    def _refresh(self) -> None:
        job = self._shown()
        self.setVisible(job is not None)
        if job is None:
            return
        self.cancel.setVisible(not self._has_button(job))
        text = job.label
        if job.total > 1:
            text += self.tr(": {0} of {1}").format(job.finished, job.total)
        left = job.seconds_left
        if left is not None and left >= 1:
            text += self.tr(", {0} left").format(_format_duration(left))
        self.label.setText(text)
        self.label.setToolTip(text)
        # Qt's bar paints itself at once, and with it all of the window that waits to be painted: a
        # job that an edit starts would have the window painted before the edit is shown everywhere.
        self.bar.setUpdatesEnabled(False)
        # A range of 0 to 0 moves to and fro: it goes on, nobody knows how long.
        self.bar.setRange(0, job.total if job.total > 1 else 0)
        self.bar.setValue(job.finished)
        self.bar.setUpdatesEnabled(True)

    def _cancel(self) -> None:
        job = self._shown()
        if job is not None:
            job.cancel()


def _format_duration(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 60 else f"{seconds // 60:.0f} min {seconds % 60:.0f} s"

"""The progress of the work that runs, and a button that ends it."""

from __future__ import annotations

from PySide6.QtCore import QSize
from PySide6.QtWidgets import QProgressBar, QToolButton, QWidget

from calibgui.gui.jobs.job import Job
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.elided import ElidedLabel
from calibgui.gui.widgets.icons import Icon, draw_icon
from calibgui.gui.widgets.layouts import keep_place, make_column, make_row

_BAR_HEIGHT, _BUTTON_HEIGHT, _ICON_SIDE = 8, 16, 10
"""Heights of the bar, the button and what is drawn on it, px: with the label above they are as high
as the button *Calibrate*, beside which they stand."""


class Progress(QWidget):
    """Shows the oldest job that has a name; n of m and the time left where they are known.

    Args:
        jobs: the jobs.
    """

    def __init__(self, jobs: Jobs) -> None:
        super().__init__()
        self._jobs = jobs
        self.label = ElidedLabel()
        self.bar = QProgressBar()
        self.bar.setFixedHeight(_BAR_HEIGHT)
        self.bar.setTextVisible(False)
        self.cancel = QToolButton()
        self.cancel.setIconSize(QSize(_ICON_SIDE, _ICON_SIDE))
        self.cancel.setAutoRaise(True)
        self.cancel.setFixedHeight(_BUTTON_HEIGHT)
        self.cancel.setToolTip(self.tr("Stop this; what is finished stays (Shift+F9)"))
        self.cancel.setAccessibleName(self.tr("Stop"))
        self.cancel.clicked.connect(self.end_shown)
        below = make_row((self.bar, 1), self.cancel)
        # The label is as wide as there is room: it may be a whole sentence.
        make_column(None, self.label, below, None, of=self, spacing=0)
        keep_place(self, self.cancel)
        jobs.changed.connect(self._refresh)
        theme.follow(self._restyle)
        self._restyle()
        self._refresh()

    def _restyle(self) -> None:
        self.cancel.setIcon(draw_icon(Icon.CROSS))

    def _shown(self) -> Job | None:
        """Return the oldest job to tell of, one that works on the document if there is any."""
        named = [job for job in self._jobs.running if job.label and not job.cancelled]
        return min(named, key=lambda job: not job.is_about_document, default=None)

    def _refresh(self) -> None:
        job = self._shown()
        self.setVisible(job is not None)
        if job is None:
            return
        self.cancel.setEnabled(not job.stopping)
        text = self.tr("Stopping…") if job.stopping else job.label
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

    def end_shown(self) -> None:
        """End the job that is told of, if there is one."""
        if (job := self._shown()) is not None:
            self._jobs.end(job)


def _format_duration(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 60 else f"{seconds // 60:.0f} min {seconds % 60:.0f} s"

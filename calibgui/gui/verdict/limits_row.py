"""Whether the shown result keeps the limits of the project, with the reasons where it does not."""

from __future__ import annotations

from functools import partial

from PySide6.QtGui import QResizeEvent

from calibgui.dataset import Result
from calibgui.dataset.acceptance import list_broken_limits
from calibgui.dataset.judging import recall_verdict
from calibgui.gui.panels.latest import Latest
from calibgui.gui.session.session import Session
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.reserved_label import ReservedLabel

_MOST_LINES = 3
"""Lines that the reasons have at most; the tooltip has the rest."""


class LimitsRow(ReservedLabel):
    """Says PASS or FAIL; it is hidden where nothing is demanded.

    Until a new result is judged, what was said of the last one stays, in the colour of secondary
    text.

    Args:
        session: whose shown result is measured.
    """

    def __init__(self, session: Session) -> None:
        super().__init__(1)
        self._session = session
        self._work = Latest(session.jobs, self)
        self._measured: Result | None = None
        self.broken: tuple[str, ...] = ()
        """Sentences on the limits that are broken."""
        self.setAccessibleName(self.tr("Limits"))
        session.result_changed.connect(lambda _: self._measure())
        session.judged.connect(self._measure)
        theme.follow(self._show)
        self._measure()

    def _measure(self) -> None:
        """Measure the shown result, beside the window, once it is judged."""
        result = self._session.result
        self._work.cancel()
        if result is None or result.limits is None:
            self._measured = None
        elif recall_verdict(result) is not None:
            work = partial(list_broken_limits, result, result.limits)
            done = partial(self._receive, result)
            self._work.start("", lambda _: work(), done, self._session.failed.emit)
        self._show()

    def _receive(self, result: Result, broken: tuple[str, ...]) -> None:
        self._measured, self.broken = result, broken
        self._show()

    def _show(self) -> None:
        shown, measured = self._session.result, self._measured
        limits = None if shown is None else shown.limits
        self.setVisible(limits is not None)
        if limits is None or measured is None or measured.limits is not limits:
            self.setText("")
        else:
            text = (
                self.tr("FAIL by the limits {0}. {1}")
                if self.broken
                else self.tr("PASS by the limits {0}.")
            )
            self.setText(text.format(limits.name, " ".join(self.broken)))
        colours = theme.current()
        colour = colours.bad if self.broken else colours.good
        theme.set_text_colour(self, colour if measured is shown else colours.muted)
        self._fit()

    def _fit(self) -> None:
        self.reserve(min(max(self.count_lines(), 1), _MOST_LINES))

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        super().resizeEvent(event)
        if event.size().width() != event.oldSize().width():
            self._fit()

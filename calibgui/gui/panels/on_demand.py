"""The base of panels whose content takes so long to compute that the user asks for it."""

from __future__ import annotations

from typing import ClassVar, Generic, TypeVar

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QWidget

from calibgui.dataset import Result
from calibgui.gui.jobs.job import Job
from calibgui.gui.panels.latest import Latest
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.services import Services
from calibgui.gui.widgets.buttons import Button
from calibgui.gui.widgets.layouts import make_row
from calibgui.gui.widgets.wrapped_label import WrappedLabel

Found = TypeVar("Found")


class OnDemandPanel(Panel, Generic[Found]):
    """A panel whose content is computed from the result when the user presses a button.

    The progress bar cancels the work. A text below the button says what that is for, what goes on,
    why it failed, or what was found. A subclass calls `_lay_out` and implements `_invite`, `_find`
    and `_show_found`.

    Args:
        services: as for `Panel`.
        button: the button's text.
        tip: the button's tooltip.
        label: name of the work for the progress bar.
        working: sentence that is shown while the work goes on.
    """

    keeps_best: ClassVar[bool] = False
    """True if the work returns what it has found so far when it is asked to stop."""

    def __init__(
        self, services: Services, *, button: str, tip: str, label: str, working: str
    ) -> None:
        super().__init__(services)
        self._work = Latest(services.jobs, self)
        self._label, self._working = label, working
        self._asked: Result | None = None
        """Result that the work is on, or that its outcome is of."""
        self._is_working = False
        self._failure = ""
        """Reason why the work failed, for the user; empty if it did not."""
        self._shown_if_found: tuple[QWidget, ...] = ()
        self.found: Found | None = None
        """What the work found; None before its end."""
        self.run = Button(button)
        self.run.setToolTip(tip)
        self.run.clicked.connect(self._start)
        self.words = WrappedLabel()
        self.words.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.words.setAccessibleName(self.tr("What was found"))

    def show_result(self, result: Result | None) -> None:
        """Show this result; what was found of another is kept only if it holds for this as well."""
        asked = self._asked
        if asked is None or result is None or not self._holds_for(asked, result):
            self._forget()
        super().show_result(result)

    def _lay_out(self, content: QWidget, *buttons: QWidget) -> None:
        """Lay the panel out; `content`, and buttons above it, are shown when something is found."""
        self._shown_if_found = (content, *buttons)
        bar = make_row(self.run, None, *buttons)
        # While there is no content, room for it would have to be scrolled.
        self._fill_body(bar, self.words, (content, 1), None)

    def _start(self) -> None:
        result = self._result
        assert result is not None
        self._forget()
        self._asked, self._is_working = result, True
        self._work.start(
            self._label,
            lambda job: self._find(result, job),
            self._done,
            self._fail,
            cancelled=self._end,
            keeps_best=self.keeps_best,
        )
        self._refresh_now()

    def _done(self, found: Found) -> None:
        self.found = found
        self._end()

    def _fail(self, error: Exception) -> None:
        self._failure = str(error)
        self._end()

    def _end(self) -> None:
        self._is_working = False
        self._refresh_now()

    def _forget(self) -> None:
        """Forget what was found, and cancel the search for it."""
        self._work.cancel()
        self._is_working, self._failure = False, ""
        self.found = self._asked = None

    def _refresh(self, result: Result) -> None:
        found = self.found
        self._enable_button()
        for widget in self._shown_if_found:
            widget.setVisible(found is not None)
        if found is not None:
            self._show_found(result, found)
        elif self._is_working:
            self.words.setText(self._working)
        else:
            self.words.setText(self._failure or self._invite(result))

    def _enable_button(self) -> None:
        """Let the button be pressed unless the work goes on; the focus comes back to it."""
        if self._is_working:
            self.run.clearFocus()  # Qt would hand it on, as if the user had
        self.run.setEnabled(not self._is_working)
        if self.run.isEnabled() and QApplication.focusWidget() is None:
            self.run.setFocus()

    def _holds_for(self, asked: Result, result: Result) -> bool:
        """Return whether what was found of one result holds for another; by default for itself."""
        return asked is result

    def _invite(self, result: Result) -> str:
        """Say what the button is for."""
        raise NotImplementedError

    def _find(self, result: Result, job: Job) -> Found:
        """Do the work; runs in a thread, tells the job how far it is, and must not touch a widget.

        Raises:
            CalibrationError: if the result does not allow it; its text is shown.
        """
        raise NotImplementedError

    def _show_found(self, result: Result, found: Found) -> None:
        """Show what was found, beside the result that the panel shows now."""
        raise NotImplementedError


def have_same_views(a: Result, b: Result) -> bool:
    """Return whether two results are from the same corners."""
    return len(a.used) == len(b.used) and all(x is y for x, y in zip(a.used, b.used, strict=True))

"""All panels show a result, or a sentence that says how to get one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from PySide6.QtCore import QT_TRANSLATE_NOOP, Qt, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QStackedLayout, QWidget

from calibgui.dataset import Result
from calibgui.gui.panels.services import Services
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.layouts import Part, make_column
from calibgui.gui.widgets.wrapped_label import WrappedLabel


class Panel(QWidget):
    """A view of a result. A subclass fills `body` and implements `_refresh` and `_select`.

    Panels that are not on screen do no work: what they were given last is drawn when they are
    shown. Indices of views in signals and in `select` are those of `Result.views`; within a
    panel they are those of the calibration, which lacks the views that were not used.
    """

    picked = Signal(int, int)
    """The user points at a view (index in `Result.views`) and its corner, or -1 for none."""
    hovered = Signal(int)
    """The cursor is over a view (index in `Result.views`) now, or over none: -1."""
    exclude_wanted = Signal(tuple)
    """Views (indices in `Result.views`) that the user wants out of the calibration."""
    save_wanted = Signal(tuple, object)
    """Views (indices in `Result.views`) whose images are to be written, and the `Undistortion`, or
    None for images rectified to the board."""
    lens_wanted = Signal(str, tuple)
    """Lens model that the user wants the camera calibrated with, and its coefficients to hold."""
    method_wanted = Signal(str, object)
    """Method that the user wants the camera calibrated with, and the `Cost` that it minimises."""
    failed = Signal(Exception)
    """Something that the user asked for could not be done."""

    title: ClassVar[str] = ""
    purpose: ClassVar[str] = ""
    """A sentence on what it shows: the tip of its name, by which the palette finds it, too."""
    hint: ClassVar[str] = str(
        QT_TRANSLATE_NOOP("Panel", "Nothing is calibrated yet. What Calibrate finds is shown here.")
    )
    """Shown while there is no result."""

    def __init__(self, services: Services) -> None:  # noqa: ARG002 - subclasses take from it
        super().__init__()
        self.setWindowTitle(self.tr(self.title))
        self.body = QWidget()
        self._result: Result | None = None
        self._indices: tuple[int, ...] = ()
        self._selected = (-1, -1)
        self._stale = self._behind = False
        self._empty = WrappedLabel(self.tr(self.hint))
        self._empty.setAlignment(Qt.AlignmentFlag.AlignTop)
        self._empty.setMargin(theme.SPACING)
        self._stack = QStackedLayout(self)
        self._stack.addWidget(self._empty)
        self._stack.addWidget(self.body)
        theme.follow(self._restyle)

    def _fill_body(self, *parts: Part) -> None:
        """Let the body have these parts, from top to bottom."""
        make_column(*parts, of=self.body, margins=theme.SPACING)

    def offer_results(self, results: Mapping[str, Result]) -> None:
        """Offer the project's results by name, the oldest first; most panels need but one."""

    def show_result(self, result: Result | None) -> None:
        """Show this result; None for none."""
        self._result = result
        self._selected = (-1, -1)
        self._indices = () if result is None else result.places
        missing = self.tr(self.hint) if result is None else self._missing(result)
        self._empty.setText(missing)
        self._stack.setCurrentIndex(0 if missing else 1)
        self._stale = True
        self._update()

    def note_verdict(self) -> None:
        """Say what the verdict on the shown result says, which is known now; nothing by default."""

    def select(self, view: int, corner: int = -1) -> None:
        """Highlight a view, and one of its corners, without announcing it."""
        k = self._indices.index(view) if view in self._indices else -1
        self._selected = (k, corner if k >= 0 else -1)
        self._behind = True
        self._update()

    def hover(self, view: int) -> None:
        """Highlight a view lightly that the cursor is over elsewhere, without announcing it."""
        if self._result is not None and self.isVisible() and not self._stale:
            self._hover_view(self._indices.index(view) if view in self._indices else -1)
        else:
            self._behind = True  # what was highlighted before is not when it is shown again

    def showEvent(self, event: QShowEvent) -> None:  # noqa: N802 - Qt's name
        super().showEvent(event)
        self._update()

    def _update(self) -> None:
        if self._result is None or self._stack.currentIndex() == 0 or not self.isVisible():
            return
        if self._stale:
            self._refresh(self._result)
        if self._stale or self._behind:
            self._select(*self._selected)
        self._stale = self._behind = False

    def _refresh_now(self) -> None:
        """Show the result anew, after a choice of the user's."""
        self._stale = True
        self._update()

    def _restyle(self) -> None:
        """Take the present colours; by default everything is drawn anew."""
        self._refresh_now()

    def _pick(self, k: int, corner: int = -1) -> None:
        """Announce what the user pointed at: calibrated view k and a corner."""
        self.picked.emit(self._indices[k], corner)

    def _point_at(self, k: int) -> None:
        """Announce that the cursor is over calibrated view k; -1 for none."""
        self.hovered.emit(self._indices[k] if k >= 0 else -1)
        self._hover_view(k)

    def _missing(self, result: Result) -> str:  # noqa: ARG002 - most panels show any
        """The sentence on what `result` lacks for this panel; empty if it has everything."""
        return ""

    def _refresh(self, result: Result) -> None:
        """Show `result`, in the present colours."""
        raise NotImplementedError

    def _select(self, k: int, corner: int) -> None:
        """Highlight calibrated view k (-1 for none) and a corner; nothing by default."""

    def _hover_view(self, k: int) -> None:
        """Highlight calibrated view k lightly (-1 for none); nothing by default."""

"""The steps that led to the camera take a line each, with undo or the reason why there is none."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import PurePath
from typing import NamedTuple

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QWidget

from calibgui.app.calibrating.settings import DEFAULT_MODEL
from calibgui.dataset import Result, ViewStatus
from calibgui.gui.session.session import Session
from calibgui.gui.verdict.sentences import translate_sentences
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button, Kind
from calibgui.gui.widgets.elided import elide_name
from calibgui.gui.widgets.layouts import make_column
from calibgui.gui.widgets.reserved_label import ReservedLabel
from calibgui.report.lens_models import get_short_lens_title
from calibgui.report.summary import describe_outliers
from calibgui.report.verdict import join_names

_MOST_LINES = 3
"""Lines that one entry has at most; its tooltip has the rest."""
_NAME_LENGTH = 16
"""Letters of a name that have room in the inspector."""


class Entry(NamedTuple):
    """Something that was done, or could not be."""

    text: str
    link: str
    """What the link says."""
    tip: str
    run: Callable[[], object]
    is_good: bool = True


class DoneList(QWidget):
    """Lists what is behind the shown result.

    Args:
        session: whose result is shown, and whose edits are undone.
    """

    panel_wanted = Signal(str)
    """The class name of a panel that says why."""
    image_wanted = Signal(str)
    """An image that could not be used."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self._shown: tuple[Result | None, str] | None = None
        self.rows: list[_Row] = []
        self.heading = make_heading(self.tr("What was done"))
        self._column = make_column(self.heading, None, of=self, spacing=0)
        session.changed.connect(lambda *_: self._refresh())
        session.result_changed.connect(lambda _: self._refresh())
        self._refresh()

    def _refresh(self) -> None:
        result = self._session.result
        state = result, self._session.document.undo_label
        if state == self._shown:
            return
        self._shown = state
        for row in self.rows:
            self._column.removeWidget(row)
            row.deleteLater()
        entries = [] if result is None else self._list_entries(result)
        self.rows = [_Row(entry) for entry in entries]
        for k, row in enumerate(self.rows, start=1):
            self._column.insertWidget(k, row)
        self.heading.setVisible(bool(self.rows))

    def _list_entries(self, result: Result) -> list[Entry]:
        """List what was done for a result, the last step first."""
        why, evidence = self.tr("why"), self.tr("Show what speaks for it")
        panel, entries = self.panel_wanted.emit, list[Entry]()
        can_undo = self._session.document.undo_label == self.tr("Make camera better")
        for said in map(translate_sentences, reversed(result.improvements)):
            if can_undo:
                can_undo, undo = False, self._session.document.undo
                tip = self.tr("Take this step back; redo brings it again")
                entries.append(Entry(said, self.tr("undo"), tip, undo))
            else:
                entries.append(Entry(said, why, evidence, partial(panel, "ResidualsPanel")))
        settings = result.calibration.settings
        if settings.model_reason is not None:
            model = result.calibration.camera.model
            text = (
                self.tr("Lens: the paper's model; no other predicts better")
                if model == DEFAULT_MODEL
                else self.tr("Lens: {0}, which predicts best").format(get_short_lens_title(model))
            )
            run = partial(panel, "LensModelsPanel")
            entries.append(Entry(text, why, settings.model_reason, run))
        if settings.outliers:
            said = describe_outliers(result)
            run = partial(panel, "ResidualsPanel")
            entries.append(Entry(f"{said[:1].upper()}{said[1:]}", why, evidence, run))
        lost = [
            view
            for view in result.views
            if view.enabled and not view.usable and view.status is not ViewStatus.WAITING
        ]
        if lost:
            names = [elide_name(PurePath(view.image).stem, _NAME_LENGTH) for view in lost]
            text = self.tr("{0} of {1} photographs could not be used: {2}").format(
                len(lost), len(result.views), join_names(names, most=1)
            )
            run = partial(self.image_wanted.emit, lost[0].image)
            entries.append(Entry(text, why, self.tr("Show the photograph"), run, is_good=False))
        return entries


class _Row(QWidget):
    """One entry, over a line."""

    def __init__(self, entry: Entry) -> None:
        super().__init__()
        self.entry = entry
        self._mark = QLabel("✓" if entry.is_good else "!")
        self._mark.setFixedWidth(12)
        self.words = ReservedLabel(1)
        self.words.setText(entry.text)
        self.link = Button(entry.link, Kind.LINK)
        self.link.setToolTip(entry.tip)
        self.link.setAccessibleName(f"{entry.link}: {entry.text}")
        self.link.clicked.connect(lambda: entry.run())
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 6, 0, 6)
        row.setSpacing(theme.SPACING)
        top = Qt.AlignmentFlag.AlignTop
        row.addWidget(self._mark, 0, top)
        row.addWidget(self.words, 1, top)
        row.addWidget(self.link, 0, top)

    def resizeEvent(self, event: object) -> None:  # noqa: N802, ARG002 - Qt's name
        """Take the lines that the text needs in this width."""
        self.words.reserve(min(self.words.count_lines(), _MOST_LINES))

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        colours = theme.current()
        theme.set_text_colour(self._mark, colours.good if self.entry.is_good else colours.warning)
        QPainter(self).fillRect(0, self.height() - 1, self.width(), 1, QColor(colours.line))


def make_heading(text: str) -> QLabel:
    """Return the heading of a part of the inspector."""
    heading = QLabel(text.upper())
    font = theme.make_font(theme.CAPTION, bold=True)
    font.setLetterSpacing(font.SpacingType.AbsoluteSpacing, 0.4)
    heading.setFont(font)
    heading.setForegroundRole(heading.palette().ColorRole.PlaceholderText)
    return heading

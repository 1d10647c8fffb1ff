"""Tables alike: sortable by value, copied and saved with every digit."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from PySide6.QtCore import (
    QAbstractItemModel,
    QEvent,
    QItemSelectionModel,
    QModelIndex,
    QPoint,
    QSortFilterProxyModel,
    Qt,
    QTimer,
    Signal,
)
from PySide6.QtGui import (
    QAction,
    QBrush,
    QColor,
    QGuiApplication,
    QKeySequence,
    QResizeEvent,
    QShowEvent,
    QStandardItemModel,
)
from PySide6.QtWidgets import (
    QAbstractItemView,
    QFrame,
    QHeaderView,
    QMenu,
    QStyle,
    QTableView,
    QWidget,
)

from calibgui.formats.csv_table import format_csv
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.actions import COPY_TABLE
from calibgui.gui.widgets.glossary import explain, list_terms
from calibgui.gui.widgets.save_names import ask_for_name
from calibgui.gui.widgets.scrolling import make_thin
from calibgui.gui.widgets.table_titles import MEASURED_ROWS, Titles

_SORT_ROLE = Qt.ItemDataRole.UserRole


@dataclass(frozen=True, slots=True)
class Column:
    """One column of a table.

    `values` are what sorting and CSV use; `text` turns one into what is shown.
    """

    title: str
    values: Sequence[Any]
    text: Callable[[Any], str] = str
    tip: str = ""
    """What the column means, with its unit."""
    hidden: bool = False
    """True if only copies and files hold it."""
    optional: bool = False
    """True if it is left out where there is no room for all."""
    expendable: bool = False
    """True if it is left out where even a narrow first column leaves no room for the others."""
    heading: str = ""
    """What stands over the texts, if not the title: with the unit that only they are in."""
    tips: Sequence[str] = ()
    """What there is to know of each value; the column's `tip` where it is empty."""
    ink: Callable[[Any], str] | None = None
    """The colour of each value's text; that of all texts if None."""
    unit: str = ""
    """Unit of the values, which stands below the heading; empty if they have none, or several."""

    @property
    def full_title(self) -> str:
        """The title with the unit."""
        return f"{self.title} [{self.unit}]" if self.unit else self.title


def with_digits(digits: int) -> Callable[[float], str]:
    """Text of a number with that many significant digits; a dash where there is none."""

    def text(value: float) -> str:
        if not math.isfinite(value):
            return "–"
        return f"{value:#.{digits}g}".removesuffix(".") if value else "0"

    return text


def with_decimals(decimals: int) -> Callable[[float], str]:
    """Text of a number with that many decimals; a dash where there is none."""

    def text(value: float) -> str:
        return f"{value:.{decimals}f}" if math.isfinite(value) else "–"

    return text


def format_seconds(seconds: float) -> str:
    """Format a time with its unit; a dash where it is not known."""
    if not math.isfinite(seconds):
        return "–"
    if seconds < 1:
        return f"{1000 * seconds:.0f} ms"
    return f"{seconds:.1f} s" if seconds < 10 else f"{seconds:.0f} s"


class _Model(QStandardItemModel):
    """Holds what a table shows of each value, and what it is sorted by.

    Qt asks for that dozens of times when it measures and paints a cell, and would wait for the
    interpreter each time while another thread computes: so all of it is handed over at once. What
    only sorting by a column needs is handed over when that is asked for.

    Qt makes the items. One made in Python, or looked at there, would be freed by whichever of both
    collects it first, and again by the other.
    """

    def __init__(
        self, columns: Sequence[Column] = (), marked: dict[int, str] | None = None
    ) -> None:
        super().__init__(max((len(column.values) for column in columns), default=0), len(columns))
        self.columns, self._marked, self._hovered = tuple(columns), marked or {}, -1
        self._sortable: set[int] = set()
        """Columns whose cells have the values that rows are sorted by."""
        role = Qt.ItemDataRole
        self._filled = 0
        """Rows whose cells have their texts."""
        self.fill_more()
        for place, column in enumerate(columns):
            self._colour_texts(place, column)
            self._set_heading(place, column.tip or explain(column.title), role.ToolTipRole)
            if len(column.values) and isinstance(column.values[0], _NUMBER_TYPES):
                self._set_heading(place, _NUMBERS, role.TextAlignmentRole)
            self.set_title(place, _join_heading(column))

    def hover(self, row: int) -> None:
        """Tint the row that the cursor is over; none if it is negative."""
        before, self._hovered = self._hovered, row
        for changed in (before, row):
            self._tint_row(changed)

    def tint(self) -> None:
        """Tint the rows that stand out, in the present colours."""
        for row in {*self._marked, self._hovered}:
            self._tint_row(row)
        for place, column in enumerate(self.columns):
            self._colour_texts(place, column)

    def set_title(self, place: int, text: str) -> None:
        """Set what stands over a column."""
        self._set_heading(place, text, Qt.ItemDataRole.DisplayRole)

    def _set_heading(self, place: int, value: Any, role: Qt.ItemDataRole) -> None:
        self.setHeaderData(place, Qt.Orientation.Horizontal, value, role)

    def _colour_texts(self, place: int, column: Column) -> None:
        for row, value in enumerate(column.values if column.ink else ()):
            assert column.ink is not None
            ink = QBrush(column.ink(value))
            self.setData(self.index(row, place), ink, Qt.ItemDataRole.ForegroundRole)

    def fill_more(self) -> bool:
        """Fill the cells of the next rows; return whether there are any after them.

        Every call into Qt costs some microseconds, and all cells of hundreds of rows at once would
        be felt.
        """
        rows = range(self._filled, min(self._filled + MEASURED_ROWS, self.rowCount()))
        blocked = self.blockSignals(True)  # told cell by cell, the order would be asked each time
        for place, column in enumerate(self.columns):
            self._fill_cells(place, column, rows[: max(len(column.values) - rows.start, 0)])
        self.blockSignals(blocked)
        if rows:
            last = self.index(rows[-1], self.columnCount() - 1)
            self.dataChanged.emit(self.index(rows[0], 0), last)
        self._filled = rows.stop
        return rows.stop < self.rowCount()

    def _fill_cells(self, place: int, column: Column, rows: range) -> None:
        """Fill the cells of a column in these rows."""
        role, tips = Qt.ItemDataRole, self._list_tips(place, rows)
        for row, tip in zip(rows, tips, strict=True):
            value = column.values[row]
            cell: dict[int, Any] = {role.DisplayRole: column.text(value)}
            if tip:
                cell[role.ToolTipRole] = tip
            if isinstance(value, _NUMBER_TYPES):
                cell[role.TextAlignmentRole] = _NUMBERS
            if row in self._marked:
                cell[role.BackgroundRole] = self._choose_ground(row)
            self.setItemData(self.index(row, place), cell)

    def make_sortable(self, place: int) -> None:
        """Hand over the values of a column by which its rows are sorted."""
        if place in self._sortable or not 0 <= place < len(self.columns):
            return
        self._sortable.add(place)
        for row, value in enumerate(self.columns[place].values):
            if isinstance(value, _NUMBER_TYPES):
                # NaN, which has no order, comes last.
                value = math.inf if math.isnan(value) else float(value)
            self.setData(self.index(row, place), value, _SORT_ROLE)

    def _choose_ground(self, row: int) -> QColor | None:
        """Choose the colour behind a row; None for that of all others."""
        colours = theme.current()
        if row == self._hovered:
            ground = QColor(colours.accent)
            ground.setAlpha(_TINT)
            return ground
        return QColor(colours.bad_base) if row in self._marked else None

    def _tint_row(self, row: int) -> None:
        ground = self._choose_ground(row)
        for place in range(self.columnCount()):
            self.setData(self.index(row, place), ground, Qt.ItemDataRole.BackgroundRole)

    def _list_tips(self, place: int, rows: range) -> list[str]:
        """List the tooltips of a column's cells in these rows."""
        column = self.columns[place]
        terms = list_terms() if place == 0 else {}
        return [
            self._marked.get(row)
            or (column.tips[row] if column.tips else "")
            or column.tip
            or terms.get(column.values[row], "")
            for row in rows
        ]


def _join_heading(column: Column) -> str:
    """Join the heading of a column and the unit below it."""
    heading = column.heading or column.title
    return f"{heading}\n[{column.unit}]" if column.unit else heading


_NUMBER_TYPES = (int, float, np.number)
"""Types of numbers."""
_NUMBERS = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
"""Place of numbers in their cells."""
_MORE = 100
"""Room that a column gets beyond its contents at most, device-independent px."""
_LEGIBLE = 8
"""Characters of the first column that are shown however narrow the table is."""
_TINT = 60
"""Opacity of the accent behind a row that the cursor is over, of 255."""


class _Order(QSortFilterProxyModel):
    """The rows of a `_Model` as they are sorted."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setSortRole(_SORT_ROLE)
        self._rows: frozenset[int] | None = None

    def filter_rows(self, rows: Collection[int] | None) -> None:
        """Show these rows of the model, all of them for None."""
        self._rows = None if rows is None else frozenset(rows)
        self.invalidate()

    def filterAcceptsRow(self, row: int, _: object) -> bool:  # noqa: N802 - Qt's name
        """Return whether a row is shown."""
        return self._rows is None or row in self._rows

    def sort(self, column: int, order: Qt.SortOrder = Qt.SortOrder.AscendingOrder) -> None:
        """Sort by the values of a column; as they were given if it is negative."""
        self._prepare(self.sourceModel(), column)
        super().sort(column, order)

    def setSourceModel(self, model: QAbstractItemModel) -> None:  # noqa: N802 - Qt's name
        """Take the rows of another model, sorted as those before."""
        self._prepare(model, self.sortColumn())
        super().setSourceModel(model)

    def _prepare(self, model: QAbstractItemModel, column: int) -> None:
        if isinstance(model, _Model):
            model.make_sortable(column)


class Table(QTableView):
    """Rows of numbers, sorted by a click on a column's title."""

    picked = Signal(int)
    """The row that the user chose, counted as in `Column.values`."""
    hovered = Signal(int)
    """The cursor is over a row now, counted in the same way, or over none: -1."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._model = _Model()
        self._filling = QTimer(self, interval=0)
        self._filling.timeout.connect(self._fill_more)
        self._measured_at = -1
        """Place of the scroll bar at which the texts were measured last; -1 for none."""
        self._widths: list[int] = []
        """Widths of the columns that their texts need there."""
        self._order = _Order(self)
        self._order.setSourceModel(self._model)
        self.setHorizontalHeader(Titles(self))
        self.setModel(self._order)
        theme.follow(self._restyle)
        self.setMouseTracking(True)
        self.entered.connect(lambda at: self.hovered.emit(self._order.mapToSource(at).row()))
        self.viewportEntered.connect(lambda: self.hovered.emit(-1))
        self.setSortingEnabled(True)
        self.sortByColumn(-1, Qt.SortOrder.AscendingOrder)
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setFrameShape(QFrame.Shape.NoFrame)
        make_thin(self)
        self.setShowGrid(False)
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setAccessibleName(self.tr("Table"))
        self.setWordWrap(False)
        self.setTextElideMode(Qt.TextElideMode.ElideMiddle)
        self.verticalHeader().hide()
        self.verticalHeader().setDefaultSectionSize(self.fontMetrics().height() + theme.SPACING)
        self.horizontalHeader().sortIndicatorChanged.connect(self._fit_anew)
        self.setTabKeyNavigation(False)
        self.selectionModel().currentRowChanged.connect(self._current_changed)
        self._menu = QMenu(self)
        for text, shortcut, does in (
            (self.tr("Copy"), QKeySequence(QKeySequence.StandardKey.Copy), self.copy),
            (self.tr("Save as CSV…"), QKeySequence(), self.ask_and_save),
        ):
            action = QAction(text, self, shortcut=shortcut)
            action.setShortcutContext(Qt.ShortcutContext.WidgetShortcut)
            action.triggered.connect(does)
            self.addAction(action)
            self._menu.addAction(action)
        self.actions()[0].setObjectName(COPY_TABLE)
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self.customContextMenuRequested.connect(self._show_menu)

    def show_columns(
        self, columns: Sequence[Column], marked: dict[int, str] | Collection[int] = ()
    ) -> None:
        """Show these columns; `marked` rows stand out, each with its reason as the tooltip."""
        reasons = marked if isinstance(marked, dict) else dict.fromkeys(marked, "")
        self._model = _Model(columns, reasons)
        self._order.setSourceModel(self._model)
        self._filling.start()
        self.setAccessibleName(
            self.tr("Table of {0}").format(", ".join(c.title for c in columns if not c.hidden))
        )
        self._fit_anew()

    def _fill_more(self) -> None:
        if not self._model.fill_more():
            self._filling.stop()

    def filter_rows(self, rows: Collection[int] | None) -> None:
        """Show these rows only, counted as in `Column.values`; all of them for None."""
        self._order.filter_rows(rows)

    def select(self, row: int) -> None:
        """Highlight a row, without announcing it; none if it is negative."""
        selection = self.selectionModel()
        index = self._order.mapFromSource(self._model.index(row, 0))
        blocked = selection.blockSignals(True)
        if index.isValid():
            flags = QItemSelectionModel.SelectionFlag
            selection.setCurrentIndex(index, flags.ClearAndSelect | flags.Rows)
        else:
            selection.clear()
        selection.blockSignals(blocked)
        self.viewport().update()
        if index.isValid():
            self.scrollTo(index)

    def hover(self, row: int) -> None:
        """Tint a row that the cursor is over, here or elsewhere; none if it is negative."""
        self._model.hover(row)
        if row >= 0 and not self.underMouse():  # nothing moves under the cursor
            self.scrollTo(self._order.mapFromSource(self._model.index(row, 0)))

    @property
    def natural_width(self) -> int:
        """Width in which all columns that are not hidden are seen whole, with a scroll bar."""
        header = self.horizontalHeader()
        columns = [
            max(self.sizeHintForColumn(place), header.sectionSizeHint(place))
            for place, column in enumerate(self._model.columns)
            if not column.hidden
        ]
        bar = self.verticalScrollBar().sizeHint().width()
        return sum(columns) + bar + 2 * self.frameWidth()

    def as_csv(self, separator: str = ",") -> str:
        """The table in the order shown: titles with units, then values with every digit."""
        order = self._order
        shown = [order.mapToSource(order.index(k, 0)).row() for k in range(order.rowCount())]
        columns = self._model.columns
        titles = [column.full_title for column in columns]
        rows = ([column.values[row] for column in columns] for row in shown)
        return format_csv([titles, *rows], separator)

    def copy(self) -> None:
        """Put the whole table on the clipboard, as a spreadsheet takes it."""
        QGuiApplication.clipboard().setText(self.as_csv("\t"))

    def save(self, path: str | Path) -> None:
        """Write the table as CSV."""
        Path(path).write_text(self.as_csv(), encoding="utf-8")

    def ask_and_save(self) -> None:
        """Let the user choose a file, then `save`."""
        path = ask_for_name(
            self, self.tr("Save table"), "", self.tr("Comma-separated values (*.csv)")
        )
        if path is not None:
            self.save(path)

    def leaveEvent(self, event: QEvent) -> None:  # noqa: N802 - Qt's name
        super().leaveEvent(event)
        self.hovered.emit(-1)

    def _restyle(self) -> None:
        self._model.tint()

    def showEvent(self, event: QShowEvent) -> None:  # noqa: N802 - Qt's name
        super().showEvent(event)
        self._fit()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        super().resizeEvent(event)
        if event.size().width() != event.oldSize().width():
            self._fit()
        chosen = self.currentIndex()
        if event.size().height() != event.oldSize().height() and chosen.isValid():
            self.scrollTo(chosen)  # it was selected before the table had its height

    def _fit_anew(self) -> None:
        """Measure the texts again, and fit the columns."""
        self._measured_at = -1
        self._fit()

    def _give_natural_widths(self) -> None:
        """Give columns the widths that the texts in sight need; a new width of the table is no
        reason to measure them again."""
        header, at = self.horizontalHeader(), self.verticalScrollBar().value()
        if at == self._measured_at:
            for place, width in enumerate(self._widths):
                header.resizeSection(place, width)
            return
        header.resizeSections(QHeaderView.ResizeMode.ResizeToContents)
        self._measured_at = at
        self._widths = [header.sectionSize(place) for place in range(header.count())]

    def _fit(self) -> None:
        """Spare the user sideways scrolling: leave columns out, then narrow the first one.

        Where there is room all columns get a part of it.
        """
        header, columns = self.horizontalHeader(), self._model.columns
        for place, column in enumerate(columns):
            self.setColumnHidden(place, column.hidden)
        if not columns or not self.isVisible():
            return
        title = _join_heading(columns[0])
        self._model.set_title(0, title)
        self._give_natural_widths()
        room = self.viewport().width()
        for place, column in enumerate(columns):
            if column.optional and header.length() > room:
                self.setColumnHidden(place, True)
        if (excess := header.length() - room) > 0:
            whole = header.sectionSize(0)
            margin = self.style().pixelMetric(QStyle.PixelMetric.PM_FocusFrameHMargin, None, self)
            letters = _LEGIBLE * self.fontMetrics().averageCharWidth()
            least = min(whole, letters + 2 * (margin + 1))
            header.resizeSection(0, max(least, whole - excess))
            for place, column in enumerate(columns):
                if column.expendable and header.length() > room:
                    self.setColumnHidden(place, True)
            left = room - header.length()
            header.resizeSection(0, max(least, min(whole, header.sectionSize(0) + left)))
            self._model.set_title(0, self._elide_lines(title, header.sectionSize(0)))
            return
        shown = [place for place in range(len(columns)) if not self.isColumnHidden(place)]
        more = min((room - header.length()) // len(shown), _MORE)
        for place in shown:
            header.resizeSection(place, header.sectionSize(place) + more)

    def _elide_lines(self, text: str, width: int) -> str:
        """Put "…" for what has no room in a heading; Qt would take its lines for one."""
        metrics, mode = self.horizontalHeader().fontMetrics(), Qt.TextElideMode.ElideRight
        margin = self.style().pixelMetric(QStyle.PixelMetric.PM_HeaderMargin, None, self)
        lines = text.split("\n")
        return "\n".join(metrics.elidedText(line, mode, width - 2 * margin) for line in lines)

    def _current_changed(self, current: QModelIndex) -> None:
        if current.isValid():
            self.picked.emit(self._order.mapToSource(current).row())

    def _show_menu(self, position: QPoint) -> None:
        self._menu.popup(self.viewport().mapToGlobal(position))

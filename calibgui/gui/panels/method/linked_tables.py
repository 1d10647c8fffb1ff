"""Several tables of the same rows, one of which is in front."""

from __future__ import annotations

from PySide6.QtCore import Signal

from calibgui.gui.widgets.tab_bar import TabWidget
from calibgui.gui.widgets.tables import Table


class LinkedTables(TabWidget):
    """Shows tables of the same rows; a row that is selected in one is selected in the others."""

    picked = Signal(int)
    """The row that the user chose, counted as in the columns' values."""

    def __init__(self) -> None:
        super().__init__()
        self._tables: list[Table] = []

    def add_table(self, name: str) -> Table:
        """Add an empty table behind those that there are."""
        table = Table()
        table.picked.connect(self._pick)
        self._tables.append(table)
        self.addTab(table, name)
        return table

    def select(self, row: int) -> None:
        """Highlight a row without announcing it."""
        for table in self._tables:
            table.select(row)

    def _pick(self, row: int) -> None:
        self.select(row)
        self.picked.emit(row)

from __future__ import annotations

import gc
import math
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication, QStandardItem
from pytestqt.qtbot import QtBot

from calibgui.gui.widgets.tables import Column, Table, with_decimals, with_digits


def shown(table: Table, column: int = 0) -> list[str]:
    model = table.model()
    return [model.index(row, column).data() for row in range(model.rowCount())]


def example(qtbot: QtBot) -> Table:
    table = Table()
    qtbot.addWidget(table)
    table.show_columns(
        [
            Column("view", ["a", "b", "c"]),
            Column("RMS", [0.25, math.nan, 1 / 3], with_decimals(2), "of the residual", unit="px"),
        ],
        {2: "far off"},
    )
    return table


def test_sorting_is_by_value_with_missing_ones_last(qtbot: QtBot) -> None:
    table = example(qtbot)
    assert shown(table) == ["a", "b", "c"]
    assert shown(table, 1) == ["0.25", "–", "0.33"]
    table.sortByColumn(1, Qt.SortOrder.AscendingOrder)
    assert shown(table) == ["a", "c", "b"]
    # Other rows come in the order that the user has chosen.
    table.show_columns([Column("view", ["d", "e", "f"]), Column("RMS", [10.0, 9.0, -1.0])])
    assert shown(table) == ["f", "e", "d"]


def test_pythons_collector_owns_no_item_of_qts(qtbot: QtBot) -> None:
    """One that it frees before the model does, as in a cycle, the model frees once more."""
    table = example(qtbot)
    table.show()
    table.sortByColumn(1, Qt.SortOrder.AscendingOrder)
    table.hover(1)
    assert not [each for each in gc.get_objects() if isinstance(each, QStandardItem)]


def test_a_click_announces_the_original_row(qtbot: QtBot) -> None:
    table = example(qtbot)
    table.sortByColumn(0, Qt.SortOrder.DescendingOrder)
    table.resize(300, 200)
    table.show()
    cell = table.visualRect(table.model().index(0, 0)).center()
    with qtbot.waitSignal(table.picked) as picked:
        qtbot.mouseClick(table.viewport(), Qt.MouseButton.LeftButton, pos=cell)
    assert picked.args == [2]
    with qtbot.assertNotEmitted(table.picked):
        table.select(0)
    assert table.currentIndex().data() == "a"


def test_copy_and_csv_hold_every_digit(qtbot: QtBot, tmp_path: Path) -> None:
    table = example(qtbot)
    table.save(tmp_path / "table.csv")
    lines = (tmp_path / "table.csv").read_text(encoding="utf-8").splitlines()
    assert lines == ["view,RMS [px]", "a,0.25", "b,nan", f"c,{1 / 3!r}"]
    table.copy()
    assert f"c\t{1 / 3!r}" in QGuiApplication.clipboard().text()


def test_a_unit_stands_below_the_heading(qtbot: QtBot) -> None:
    table = example(qtbot)
    table.show()
    header, role = table.horizontalHeader(), Qt.ItemDataRole.DisplayRole
    heads = [table.model().headerData(k, Qt.Orientation.Horizontal, role) for k in range(2)]
    assert heads == ["view", "RMS\n[px]"]
    assert header.height() >= 2 * header.fontMetrics().height()


def test_number_formats() -> None:
    assert with_digits(3)(1234.5) == "1.23e+03"
    assert with_digits(3)(math.nan) == "–"
    assert [with_digits(2)(value) for value in (0.9, 0.86, 12.3, 0.0)] == [
        "0.90",
        "0.86",
        "12",
        "0",
    ]


def test_a_hidden_column_is_for_files_only(qtbot: QtBot) -> None:
    table = example(qtbot)
    table.show_columns([Column("a", [1]), Column("b", [2], hidden=True)])
    assert [table.isColumnHidden(k) for k in range(2)] == [False, True]
    assert table.as_csv() == "a,b\n1,2\n"
    table.show_columns([Column("a", [1]), Column("b", [2])])
    assert not table.isColumnHidden(1)


def test_columns_give_way_before_the_user_must_scroll(qtbot: QtBot) -> None:
    table = Table()
    qtbot.addWidget(table)
    table.show_columns(
        [
            Column("view", ["photograph_of_a_board_001.png"]),
            Column("change", [1.25], with_decimals(2), optional=True),
            Column("RMS", [0.25], with_decimals(2), heading="RMS [px]"),
        ]
    )
    table.show()
    header = table.horizontalHeader()
    widths = {}
    for width in (600, 310, 150, 600):
        table.resize(width, 200)
        assert header.length() <= table.viewport().width()
        widths[width] = (table.isColumnHidden(1), header.sectionSize(0))
    whole = table.sizeHintForColumn(0)
    assert widths[600][0] is False and widths[600][1] >= whole
    assert widths[310][0] is True and widths[310][1] >= whole
    assert widths[150][0] is True and widths[150][1] < whole
    table.resize(60, 200)  # then sideways, rather than names of nothing but dots
    assert header.sectionSize(0) > table.fontMetrics().horizontalAdvance("photog")
    assert table.as_csv().splitlines()[0] == "view,change,RMS"
    assert table.model().headerData(2, Qt.Orientation.Horizontal) == "RMS [px]"


def test_an_expendable_column_goes_where_names_cannot_be_narrower(qtbot: QtBot) -> None:
    table = Table()
    qtbot.addWidget(table)
    table.show_columns(
        [
            Column("view", ["photograph_of_a_board_001.png"]),
            Column("fx", [4100.25], with_decimals(2), expendable=True),
            Column("RMS", [0.25], with_decimals(2)),
        ]
    )
    table.show()
    header = table.horizontalHeader()
    table.resize(200, 200)
    assert not table.isColumnHidden(1)
    table.resize(header.length() - header.sectionSize(0) + 40, 200)
    assert table.isColumnHidden(1) and not table.isColumnHidden(2)
    assert header.length() <= table.viewport().width()


def test_the_heading_of_a_narrowed_column_shows_that_it_goes_on(qtbot: QtBot) -> None:
    table = Table()
    qtbot.addWidget(table)
    table.show_columns(
        [
            Column("Parameter of the camera", ["fx"], unit="px"),
            Column("RMS", [0.25], with_decimals(2), unit="px"),
        ]
    )
    table.show()
    header = table.horizontalHeader()
    heads = {}
    for width in (600, 150, 600):
        table.resize(width, 200)
        heads[width] = str(table.model().headerData(0, Qt.Orientation.Horizontal))
        wide = max(map(header.fontMetrics().horizontalAdvance, heads[width].split("\n")))
        assert wide < header.sectionSize(0)
    assert heads[600] == "Parameter of the camera\n[px]"
    assert heads[150].startswith("Para") and heads[150].endswith("…\n[px]")


def test_a_row_that_was_selected_before_the_table_had_room_comes_into_sight(qtbot: QtBot) -> None:
    table = Table()
    qtbot.addWidget(table)
    table.show_columns([Column("view", list(map(str, range(60))))])
    table.resize(200, 20)
    table.show()
    table.select(40)
    table.verticalScrollBar().setValue(0)
    table.resize(200, 300)
    assert table.viewport().rect().contains(table.visualRect(table.model().index(40, 0)))


def test_what_is_scrolled_to_is_read_whole(qtbot: QtBot) -> None:
    table = Table()
    qtbot.addWidget(table)
    values = ["1"] * 30 + ["0.019988 ± 0.000079"]
    table.show_columns([Column("n", [f"k{k}" for k in range(31)]), Column("value", values)])
    table.resize(400, 120)
    table.show()
    text = table.fontMetrics().horizontalAdvance(values[-1])
    assert table.horizontalHeader().sectionSize(1) > text


def test_hundreds_of_rows_are_filled_in_slices(qtbot: QtBot) -> None:
    table = Table()
    qtbot.addWidget(table)
    names = [f"view {k}" for k in range(250)]
    table.show_columns([Column("view", names), Column("RMS", [0.1 * k for k in range(250)])])
    assert shown(table)[:100] == names[:100]
    assert shown(table)[-1] is None, "the last come later"
    qtbot.waitUntil(lambda: shown(table)[-1] is not None)
    assert shown(table) == names
    assert table.as_csv().count("\n") == 251

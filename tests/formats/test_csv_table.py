"""Tables in CSV: what keeps one from being read is named."""

from __future__ import annotations

from pathlib import Path

import pytest

from calibgui.engine.errors import CalibrationError
from calibgui.formats.csv_table import read_csv_rows, read_numbered_csv_rows


def test_rows_are_read_by_the_columns_names(tmp_path: Path) -> None:
    file = tmp_path / "table.csv"
    file.write_text('\ufeffa,b\r\n1,"two\r\nlines"\r\n3,4\r\n', encoding="utf-8", newline="")
    rows = [{"a": "1", "b": "two\r\nlines"}, {"a": "3", "b": "4"}]
    assert read_csv_rows(file) == rows
    assert read_numbered_csv_rows(file) == [(3, rows[0]), (4, rows[1])]


def test_what_is_wrong_is_named(tmp_path: Path) -> None:
    with pytest.raises(CalibrationError, match=r"absent\.csv does not exist"):
        read_csv_rows(tmp_path / "absent.csv")
    file = tmp_path / "table.csv"
    file.write_bytes(b"\xed\xa0\x80")
    with pytest.raises(CalibrationError, match=r"table\.csv is not a CSV file") as caught:
        read_csv_rows(file)
    assert caught.value.hint

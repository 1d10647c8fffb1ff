"""Tables in CSV: what keeps one from being read is named."""

from __future__ import annotations

import csv
import io
import tempfile
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import calibgui
from calibgui.engine.errors import CalibrationError
from calibgui.formats.csv_table import format_csv, read_csv_rows, read_numbered_csv_rows


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


FORMULAS = ["=1+1", "+A1", "-A1", "@SUM(A1)", "\t=1", "\r=1", "\n=1", "＝1", "'=1", "''+A1", "-"]
PLAIN = ["", "a=1", "'", "'a", "-1.5", "+3e-7", ".5", "ä", " x"]


@pytest.mark.parametrize("text", FORMULAS)
def test_a_text_that_a_spreadsheet_computes_has_an_apostrophe(text: str) -> None:
    (cells,) = csv.reader(io.StringIO(format_csv([[text, "b"]]), newline=""))
    assert cells == [f"'{text}", "b"]


@pytest.mark.parametrize("cell", [*PLAIN, -1, -1.5, 3, None])
def test_other_cells_stay_as_they_are(cell: object) -> None:
    (cells,) = csv.reader(io.StringIO(format_csv([[cell, "b"]])))
    assert cells == ["" if cell is None else str(cell), "b"]


@given(st.lists(st.sampled_from([*FORMULAS, *PLAIN]) | st.text("'=+-@\t\r\n\",;a1")))
def test_every_text_comes_back(texts: list[str]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "table.csv"
        content = format_csv([["=name", "b"], *([text, "1"] for text in texts)])
        file.write_bytes(content.encode())
        assert read_csv_rows(file) == [{"=name": text, "b": "1"} for text in texts]


def test_no_other_file_writes_or_reads_csv() -> None:
    """What a spreadsheet computes is known in one place."""
    package = Path(calibgui.__file__).parent
    files = [file for file in package.rglob("*.py") if "import csv" in file.read_text("utf-8")]
    assert [file.name for file in files] == ["csv_table.py"]

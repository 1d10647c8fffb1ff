"""Tables in CSV, the same for every format that is one: reading, and writing for spreadsheets.

A spreadsheet computes a cell that begins as a formula does, whoever wrote it: a photograph may be
named ``=HYPERLINK(...)``. Such texts are written with an apostrophe in front, which spreadsheets
take for the mark of a text (OWASP, "CSV injection"), and so are those that begin with apostrophes
before such a sign. Reading takes one apostrophe away, so that every text comes back. Numbers begin
with + or - as well, and stay as they are.
"""

from __future__ import annotations

import csv
import io
import math
import os
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import describe_read_error, read_regular

_END = "\r\n"
_COMPUTED = re.compile(r"'*[=+\-@\t\r\n＝＋－＠]")
"""Beginnings of texts that a spreadsheet computes, or would without the apostrophes."""
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
MAX_TABLE_SIZE = 256 << 20
"""Size of the largest tables that are read, bytes."""


def format_csv(rows: Iterable[Sequence[object]], separator: str = ",") -> str:
    """Return a table as text, whose cells are texts and numbers; None is an empty one."""
    lines: list[str] = []
    # Only characters of the end of a line have their cells quoted: both are, and then one is.
    file = SimpleNamespace(write=lambda line: lines.append(line.removesuffix(_END)))
    writer = csv.writer(file, delimiter=separator, lineterminator=_END)
    writer.writerows([_guard(cell) for cell in row] for row in rows)
    return "".join(f"{line}\n" for line in lines)


def _guard(cell: object) -> object:
    """Return a cell as a spreadsheet does not compute it."""
    is_formula = isinstance(cell, str) and _COMPUTED.match(cell) and not _NUMBER.fullmatch(cell)
    return f"'{cell}" if is_formula else cell


def _bare(cell: Any) -> Any:
    """Return a text without the apostrophe that `_guard` has put in front of it."""
    is_guarded = isinstance(cell, str) and cell.startswith("'") and _COMPUTED.match(cell)
    return cell[1:] if is_guarded else cell


def read_csv_rows(file: Path) -> list[dict[str, str]]:
    """Read the rows of a table whose first line names the columns.

    Raises:
        CalibrationError: if the file cannot be read, or is not CSV in UTF-8.
    """
    return [row for _, row in read_numbered_csv_rows(file)]


def read_numbered_csv_rows(file: Path) -> list[tuple[int, dict[str, str]]]:
    """Read the rows of a table, each with the number of its last line.

    Raises:
        CalibrationError: as `read_csv_rows`.
    """
    try:
        text = read_regular(file, MAX_TABLE_SIZE).decode("utf-8-sig")
    except OSError as error:
        raise describe_read_error(file, error) from error
    except ValueError as error:
        raise CalibrationError(f"{file} is not a CSV file: {error}.", "Choose another.") from error
    return parse_csv(text, file)


def parse_csv(text: str, file: str | os.PathLike[str]) -> list[tuple[int, dict[str, str]]]:
    """Return the rows of a table's text, each with the number of its last line.

    Raises:
        CalibrationError: if it is not CSV; it names the `file`.
    """
    try:
        reader = csv.DictReader(io.StringIO(text, newline=""))
        rows = [(reader.line_num, row) for row in reader]
        return [(line, {_bare(k): _bare(v) for k, v in row.items()}) for line, row in rows]
    except (ValueError, csv.Error) as error:
        raise CalibrationError(f"{file} is not a CSV file: {error}.", "Choose another.") from error


def parse_cell(
    file: str | os.PathLike[str], line: int, row: Mapping[str, str | None], name: str
) -> float:
    """Return the finite number in a cell.

    Raises:
        CalibrationError: if it holds none; it names the file, the line and the column.
    """
    text = row.get(name) or ""
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise CalibrationError(
            f"{file}, line {line}: {text[:20]!r} in the column {name} is not a number.",
            "Correct the table.",
        )
    return number

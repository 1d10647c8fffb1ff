"""Reading of tables in CSV, the same for every format that is one."""

from __future__ import annotations

import csv
import io
from pathlib import Path

from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import describe_read_error, read_regular

MAX_TABLE_SIZE = 256 << 20
"""Size of the largest tables that are read, bytes."""


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
        reader = csv.DictReader(io.StringIO(text, newline=""))
        return [(reader.line_num, row) for row in reader]
    except OSError as error:
        raise describe_read_error(file, error) from error
    except (ValueError, csv.Error) as error:
        raise CalibrationError(f"{file} is not a CSV file: {error}.", "Choose another.") from error

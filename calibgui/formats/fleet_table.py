"""The ledger of a fleet as one table for analysis, in Parquet or CSV.

Reader: any reader of Parquet or CSV. The columns are those of the ledger (``fleet_ledger.py``), and
each parameter has two of its own, as ``fx`` and ``sigma_fx``; what is not known is empty. Cannot
hold: what the ledger cannot.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from calibgui.dataset.fleet import FleetCamera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import open_replacement, write_atomically
from calibgui.formats.csv_table import format_csv
from calibgui.formats.fleet_ledger import COLUMNS, encode_row
from calibgui.formats.origin import FLEET_TABLE, make_mark

_CSV, _PARQUET = ".csv", ".parquet"
_FIXED = tuple(name for name in COLUMNS if name != "parameters")
"""The columns that every table has."""


def check_fleet_table(path: Path) -> None:
    """Refuse a file that could not be written.

    Raises:
        CalibrationError: for a name that tells no format, or if the library that writes it is not
            installed.
    """
    suffix = path.suffix.lower()
    if suffix == _CSV:
        return
    if suffix != _PARQUET:
        raise CalibrationError(
            f"{path} is not named as a table.", f"Give it the suffix {_PARQUET} or {_CSV}."
        )
    try:
        import pyarrow  # noqa: F401
    except ImportError as error:
        raise CalibrationError(
            f"{path} cannot be written: pyarrow is not installed.",
            "pip install pyarrow, or name a file that ends in .csv.",
        ) from error


def write_fleet_table(cameras: Iterable[FleetCamera], path: Path) -> None:
    """Write cameras as Parquet or CSV, by the suffix of the file.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    rows = [_flatten(encode_row(camera)) for camera in cameras]
    names = list(dict.fromkeys([*_FIXED, *(name for row in rows for name in row)]))
    if path.suffix.lower() == _CSV:
        text = format_csv([names, *([row.get(name) for name in names] for row in rows)])
        write_atomically(path, text.encode())
        return
    import pyarrow
    import pyarrow.parquet

    table = pyarrow.table({name: [row.get(name) for row in rows] for name in names})
    # Arrow's own schema would push the mark away from the end of the file.
    with (
        open_replacement(path) as file,
        pyarrow.parquet.ParquetWriter(file, table.schema, store_schema=False) as writer,
    ):
        writer.write_table(table)
        writer.add_key_value_metadata({"origin": make_mark(FLEET_TABLE)})


def _flatten(row: dict[str, Any]) -> dict[str, Any]:
    """Return a row with columns for each parameter in place of their JSON object."""
    parameters = json.loads(row.pop("parameters") or "{}")
    for name, (value, sigma) in parameters.items():
        row |= {name: value, f"sigma_{name}": sigma}
    return row

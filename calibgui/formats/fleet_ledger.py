"""The ledger of a fleet: an SQLite file with one row for each camera (``dataset/fleet.py``).

Reader: `open_ledger`, and SQLite. Table ``cameras``: pixels, millimetres and degrees Celsius as the
columns' names say; ``parameters`` is a JSON object of [value, sigma] by name, ``failures`` a JSON
list of sentences, ``versions`` a JSON object. ``date`` is the manifest's, or that of the
photographs' EXIF, which ``exif_date`` is in any case. NULL is what is not known, and what is
infinite is Inf. ``result`` is the path of the camera's result.json from the folder of the ledger.
Cannot hold: corners, covariances and findings (they are in result.json); two cameras of one id.

Columns are known by their names: people may add others, which keep their values when a row is
written anew. A row with a value that cannot be read, such as text in a number, is that of a camera
with the status ``unreadable``, which says so.

Rows are written one camera at a time or many, each call in one transaction, in SQLite's
write-ahead log: a program that is killed leaves whole rows, several programs may write to one
ledger in turns, and it can be read meanwhile. The last to write a row wins. The log needs a disk
of the machine itself: on a network drive let one program write.

``PRAGMA application_id`` tells a ledger from other SQLite files, ``user_version`` is the version of
its table. A change that old programs could misread takes a new one.
"""

from __future__ import annotations

import json
import math
import os
import sqlite3
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import MappingProxyType
from typing import Any

from calibgui.dataset.fleet import (
    Change,
    Estimate,
    FleetCamera,
    FleetEntry,
    FleetFigures,
    FleetStatus,
)
from calibgui.engine.assessment import Grade, PixelError
from calibgui.engine.errors import CalibrationError
from calibgui.formats.json_document import parse_json

VERSION = 2
_APPLICATION = 0x43414C46
"""Mark of a ledger among SQLite's files: "CALF"."""
_BUSY_S = 60.0
"""Time for which a program waits for another one that writes, s: a row takes milliseconds."""
_REMEDY = "Name the file that `calibgui batch -o` wrote."
_REMEDY_OF_DAMAGE = (
    "Restore a copy of it; without one move it away and repeat calibgui batch: photographs whose "
    "corners are in the folder beside it are not searched again."
)
_REMEDY_OF_ROW = "Repeat calibgui batch, which writes the row anew, or correct the row."
_COLUMNS: Mapping[str, str] = MappingProxyType(
    {
        "id": "TEXT PRIMARY KEY NOT NULL",
        "serial": "TEXT NOT NULL",
        "date": "TEXT NOT NULL",
        "temperature_c": "REAL",
        "status": "TEXT NOT NULL",
        "problem": "TEXT NOT NULL",
        "remedy": "TEXT NOT NULL",
        "passed": "INTEGER NOT NULL",
        "failures": "TEXT NOT NULL",
        "photographs": "INTEGER NOT NULL",
        "exif_date": "TEXT NOT NULL",
        "width_px": "INTEGER",
        "height_px": "INTEGER",
        "board": "TEXT",
        "lens_model": "TEXT",
        "views": "INTEGER",
        "corners": "INTEGER",
        "rms_px": "REAL",
        "noise_px": "REAL",
        "coverage": "REAL",
        "grade": "TEXT",
        "reason": "TEXT",
        "times_better": "REAL",
        "error_centre_px": "REAL",
        "error_edge_px": "REAL",
        "error_worst_px": "REAL",
        "error_median_px": "REAL",
        "error_covered_px": "REAL",
        "error_worst_covered_px": "REAL",
        "parameters": "TEXT",
        "change_against": "TEXT",
        "change_against_digest": "TEXT",
        "change_rms_px": "REAL",
        "change_worst_px": "REAL",
        "change_expected_px": "REAL",
        "change_probability": "REAL",
        "digest": "TEXT NOT NULL",
        "state": "TEXT NOT NULL",
        "versions": "TEXT NOT NULL",
        "result": "TEXT NOT NULL",
        "cpu_seconds": "REAL",
    }
)
"""The columns of the table, with their types in SQL."""
COLUMNS = tuple(_COLUMNS)
"""Names of the columns."""
_NAMES = ", ".join(COLUMNS)
_WITH_GRADE = ("width_px", "height_px", "board", "lens_model", "views", "corners", "reason")
"""Columns that are not NULL where the grade is not, and ``parameters``."""
_KINDS: Mapping[str, tuple[tuple[type, ...], str]] = MappingProxyType(
    {
        "TEXT": ((str,), "text"),
        "INTEGER": ((int,), "a whole number"),
        "REAL": ((int, float), "a number"),
    }
)
"""By types in SQL those of the values, and words for them."""
_MAX_SHOWN = 40
"""Length of a value in a message at most."""
_ERRORS = ("centre", "edge", "worst", "median", "covered", "worst_covered")
_CHANGES = ("against", "against_digest", "rms_px", "worst_px", "expected_px", "probability")


class Ledger:
    """An open ledger; `open_ledger` makes one."""

    def __init__(self, path: Path, connection: sqlite3.Connection) -> None:
        self.path = path
        self._connection = connection

    def write(self, cameras: Iterable[FleetCamera]) -> None:
        """Write rows in one transaction, each in place of the row of the same id, if there is one.

        Raises:
            CalibrationError: if the file cannot be written, as on a full disk.
        """
        values = [tuple(encode_row(camera).values()) for camera in cameras]
        marks = ", ".join("?" * len(COLUMNS))
        anew = ", ".join(f"{name} = excluded.{name}" for name in COLUMNS)
        with _explain_errors(self.path), self._connection as connection:
            connection.executemany(
                f"INSERT INTO cameras ({_NAMES}) VALUES ({marks}) ON CONFLICT (id) DO UPDATE SET "
                f"{anew}",
                values,
            )

    def read(self) -> Iterator[FleetCamera]:
        """Yield all cameras, in the order of their ids.

        Raises:
            CalibrationError: if the file cannot be read.
        """
        return self._select("ORDER BY id")

    def read_serial(self, serial: str) -> Iterator[FleetCamera]:
        """Yield the cameras of a serial number, in the order of their dates and ids.

        Raises:
            CalibrationError: if the file cannot be read.
        """
        return self._select("WHERE serial = ? ORDER BY date, id", serial)

    def find(self, camera: str) -> FleetCamera | None:
        """Return the camera of an id, None if there is none.

        Raises:
            CalibrationError: if the file cannot be read.
        """
        return next(self._select("WHERE id = ?", camera), None)

    def locate_result(self, camera: FleetCamera) -> Path | None:
        """Return where the result.json of a camera is; None if it was refused."""
        return self.path.parent / camera.result if camera.result else None

    def _select(self, condition: str, *values: str) -> Iterator[FleetCamera]:
        with _explain_errors(self.path):
            query = f"SELECT rowid, {_NAMES} FROM cameras {condition}"
            for number, *row in self._connection.execute(query, values):
                yield _decode_row(dict(zip(COLUMNS, row, strict=True)), number)


@contextmanager
def open_ledger(path: str | os.PathLike[str], create: bool = False) -> Iterator[Ledger]:
    """Open a ledger.

    Args:
        path: its file.
        create: whether to make the file, and to write to it; else it is only read.

    Raises:
        CalibrationError: if there is none and it is not to be made, it is no ledger or one of a
            version that this program does not know, or it cannot be opened.
    """
    path = Path(path)
    if not create and not path.is_file():
        raise CalibrationError(f"There is no ledger {path}.", "calibgui batch -o makes one.")
    with _explain_errors(path):
        connection = sqlite3.connect(path, timeout=_BUSY_S)
    try:
        # Bytes that are no text cost their row, and not all of them.
        connection.text_factory = lambda raw: raw.decode("utf-8", "surrogateescape")
        with _explain_errors(path):
            _check_or_create(connection, path, create)
        yield Ledger(path, connection)
    finally:
        connection.close()


def _check_or_create(connection: sqlite3.Connection, path: Path, create: bool) -> None:
    """Make the table in an empty file; refuse a file that is no ledger of a known version.

    Raises:
        CalibrationError: if it is refused.
    """
    if create:
        # One transaction: of two programs that begin at once, one makes it and the other finds it.
        connection.execute("BEGIN IMMEDIATE")
        (tables,) = connection.execute("SELECT count(*) FROM sqlite_master").fetchone()
        if not tables:
            connection.execute(f"PRAGMA application_id = {_APPLICATION}")
            connection.execute(f"PRAGMA user_version = {VERSION}")
            columns = ", ".join(f"{name} {kind}" for name, kind in _COLUMNS.items())
            connection.execute(f"CREATE TABLE cameras ({columns})")
            connection.execute("CREATE INDEX cameras_by_serial ON cameras (serial, date, id)")
        connection.commit()
    (application,) = connection.execute("PRAGMA application_id").fetchone()
    (version,) = connection.execute("PRAGMA user_version").fetchone()
    if application != _APPLICATION:
        raise CalibrationError(f"{path} is not the ledger of a fleet.", _REMEDY)
    if version != VERSION:
        raise CalibrationError(
            f"{path} is a ledger of version {version}; this program knows version {VERSION}.",
            "Use the calibgui that wrote it, or write a new ledger.",
        )
    there = {row[1] for row in connection.execute("PRAGMA table_info(cameras)")}
    if missing := [name for name in COLUMNS if name not in there]:
        raise CalibrationError(
            f"{path} lacks columns that the ledger of a fleet has: {', '.join(missing)}.",
            "Columns may be added, but none of these renamed or left out. " + _REMEDY_OF_DAMAGE,
        )
    if create:
        connection.execute("PRAGMA journal_mode = WAL")
        # A crash of the machine may lose the last rows, which are then made again, but no more.
        connection.execute("PRAGMA synchronous = NORMAL")


@contextmanager
def _explain_errors(path: Path) -> Iterator[None]:
    """Turn SQLite's errors into those that the user can act on."""
    try:
        yield
    except MemoryError as error:
        raise CalibrationError(
            f"The ledger {path} does not fit into memory, or is damaged.", _REMEDY_OF_DAMAGE
        ) from error
    except sqlite3.DatabaseError as error:
        # The last byte tells the kind.
        message, hint = _describe_error(path, getattr(error, "sqlite_errorcode", 0) & 0xFF)
        raise CalibrationError(f"{message}: {error}.", hint) from error


def _describe_error(path: Path, code: int) -> tuple[str, str]:
    """Say what an error of SQLite means for a ledger, and what to do about it."""
    if code in (sqlite3.SQLITE_FULL, sqlite3.SQLITE_IOERR):
        return (
            f"The disk takes or gives no more of the ledger {path}",
            "Free some space, and check the disk and your quota; then repeat the command: what is "
            "done is kept.",
        )
    if code == sqlite3.SQLITE_NOTADB:
        return f"{path} is not the ledger of a fleet", f"{_REMEDY} If it is: {_REMEDY_OF_DAMAGE}"
    if code in (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_TOOBIG):
        return f"The ledger {path} is damaged", _REMEDY_OF_DAMAGE
    if code in (sqlite3.SQLITE_ERROR, sqlite3.SQLITE_CONSTRAINT, sqlite3.SQLITE_MISMATCH):
        return f"The table of the ledger {path} is not as it was made", _REMEDY_OF_DAMAGE
    return (
        f"The ledger {path} cannot be used",
        "Check its folder and your rights, and that no other program holds it.",
    )


def encode_row(camera: FleetCamera) -> dict[str, Any]:
    """Return the values of a camera's row, by the names of the columns."""
    entry, found, change = camera.entry, camera.figures, camera.change
    row: dict[str, Any] = dict.fromkeys(COLUMNS)
    row |= {
        "id": entry.id,
        "serial": entry.serial,
        "date": entry.date,
        "temperature_c": entry.temperature,
        "status": str(camera.status),
        "problem": camera.problem,
        "remedy": camera.remedy,
        "passed": int(camera.passed),
        "failures": _dump(camera.failures),
        "photographs": camera.photographs,
        "exif_date": camera.exif_date,
        "digest": camera.digest,
        "state": camera.state,
        "versions": _dump(dict(camera.versions)),
        "result": camera.result,
        "cpu_seconds": camera.cpu_seconds,
    }
    if found is not None:
        row |= _encode_figures(found)
    if change is not None:
        row |= {
            "change_against": change.against,
            "change_against_digest": change.against_digest,
            "change_rms_px": change.rms,
            "change_worst_px": change.worst,
            "change_expected_px": change.expected,
            "change_probability": change.probability,
        }
    return {name: _make_storable(value) for name, value in row.items()}


def _encode_figures(found: FleetFigures) -> dict[str, Any]:
    """Encode what is kept of a calibrated camera as a row of the table."""
    parameters = {name: [p.value, p.sigma] for name, p in found.parameters.items()}
    row = {
        "width_px": found.size[0],
        "height_px": found.size[1],
        "board": found.board,
        "lens_model": found.lens_model,
        "views": found.views,
        "corners": found.corners,
        "rms_px": found.rms,
        "noise_px": found.noise,
        "coverage": found.coverage,
        "grade": str(found.grade),
        "reason": found.reason,
        "times_better": found.times_better,
        "parameters": _dump(
            {name: [_get_finite(v) for v in pair] for name, pair in parameters.items()}
        ),
    }
    return row | {f"error_{name}_px": getattr(found.error, name) for name in _ERRORS}


def _decode_row(row: Mapping[str, Any], number: int) -> FleetCamera:
    """Return the camera of a row, one that is unreadable if a value of it cannot be read.

    Args:
        row: the values by name.
        number: SQLite's number of the row, by which it is named if its id cannot be read.
    """
    try:
        _check_values(row)
        return _decode_values(row)
    except CalibrationError as error:
        problem = f"Its row of the ledger cannot be read: {error.message}"
    name, serial = (
        value if isinstance(value, str) and _is_unicode(value) else ""
        for value in (row["id"], row["serial"])
    )
    return FleetCamera(
        FleetEntry(name or f"row {number}", serial),
        FleetStatus.UNREADABLE,
        problem,
        _REMEDY_OF_ROW,
        failures=(problem,),
    )


def _check_values(row: Mapping[str, Any]) -> None:
    """Raise CalibrationError unless the values of a row are of their columns' types."""
    needed = {name for name, kind in _COLUMNS.items() if "NOT NULL" in kind}
    if row["status"] == FleetStatus.DONE:
        needed |= {"grade", "parameters", *_WITH_GRADE}
    if row["change_against"] is not None:
        needed.add("change_against_digest")
    for name, kind in _COLUMNS.items():
        types, words = _KINDS[kind.split()[0]]
        value = row[name]
        if value is None and name not in needed:
            continue
        if not isinstance(value, types):
            raise _refuse_value(name, value, words)
        if isinstance(value, str) and not _is_unicode(value):
            raise _refuse_value(name, value, "text in UTF-8")
    if "\0" in row["result"]:
        raise _refuse_value("result", row["result"], "a path")
    for name, choices in (("status", FleetStatus), ("grade", Grade)):
        if row[name] is not None and row[name] not in list(choices):
            raise _refuse_value(name, row[name], f"one of {', '.join(choices)}")


def _refuse_value(name: str, value: Any, words: str) -> CalibrationError:
    """Return the error that the value of a column is none that it can have."""
    shown = "nothing" if value is None else repr(value)
    if len(shown) > _MAX_SHOWN:
        shown = f"{shown[:_MAX_SHOWN]}..."
    return CalibrationError(f"{name} is {shown}, not {words}.", _REMEDY_OF_ROW)


def _is_unicode(text: str) -> bool:
    """Return whether a text was valid UTF-8: what was not is read as surrogates."""
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


def _decode_values(row: Mapping[str, Any]) -> FleetCamera:
    """Return the camera of a row. Raises CalibrationError if JSON in it is not as it was made."""
    versions = parse_json(row["versions"], "versions").members()
    return FleetCamera(
        entry=FleetEntry(row["id"], row["serial"], row["date"], row["temperature_c"]),
        status=FleetStatus(row["status"]),
        problem=row["problem"],
        remedy=row["remedy"],
        photographs=row["photographs"],
        exif_date=row["exif_date"],
        figures=None if row["grade"] is None else _decode_figures(row),
        change=None if row["change_against"] is None else _decode_change(row),
        failures=tuple(one.text() for one in parse_json(row["failures"], "failures").items()),
        digest=row["digest"],
        state=row["state"],
        versions={name: version.text() for name, version in versions.items()},
        result=row["result"],
        cpu_seconds=_read_number(row["cpu_seconds"]),
    )


def _decode_figures(row: Mapping[str, Any]) -> FleetFigures:
    """Decode a row of the table; see `_encode_figures`."""
    pairs = {
        name: [number.number(nullable=True) for number in pair.items(2)]
        for name, pair in parse_json(row["parameters"], "parameters").members().items()
    }
    return FleetFigures(
        size=(row["width_px"], row["height_px"]),
        board=row["board"],
        lens_model=row["lens_model"],
        views=row["views"],
        corners=row["corners"],
        rms=_read_number(row["rms_px"]),
        noise=_read_number(row["noise_px"]),
        coverage=_read_number(row["coverage"]),
        grade=Grade(row["grade"]),
        reason=row["reason"],
        times_better=_read_number(row["times_better"]),
        error=PixelError(**{name: _read_number(row[f"error_{name}_px"]) for name in _ERRORS}),
        parameters={name: Estimate(*pair) for name, pair in pairs.items()},
    )


def _decode_change(row: Mapping[str, Any]) -> Change:
    against, digest, *numbers = (row[f"change_{name}"] for name in _CHANGES)
    return Change(against, digest, *map(_read_number, numbers))


def _dump(value: Mapping[str, Any] | Sequence[str]) -> str:
    return json.dumps(value, ensure_ascii=False)


def _make_storable(value: Any) -> Any:
    """Return a value as SQLite holds it: None for NaN, and text in valid Unicode."""
    if isinstance(value, float) and math.isnan(value):
        return None
    # Names of files that are not valid Unicode have surrogates in messages.
    is_text = isinstance(value, str)
    return value.encode("utf-8", "backslashreplace").decode() if is_text else value


def _get_finite(value: float) -> float | None:
    """Return a number as JSON holds it: None unless it is finite."""
    return value if math.isfinite(value) else None


def _read_number(value: float | None) -> float:
    """Return a number of a row; NaN for NULL."""
    return math.nan if value is None else float(value)

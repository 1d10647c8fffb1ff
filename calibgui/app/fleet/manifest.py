"""The list of the cameras of a fleet: a table in CSV or Parquet, or a folder of folders.

Columns, of which ``id`` and ``paths`` must be there:

    id           name of the set of photographs, which no other has
    paths        photographs: a folder, a pattern or a file, or several of them with ; between, from
                 the table's folder on, or addresses (http://, https://, s3://, gs://)
    board        words of the board that replace the command line's: ROWSxCOLS, its kind, and the
                 side of a square, as "charuco 5x7 30mm", with one standard deviation as
                 "30+-0.02mm"; or the file that lists its circles, from the table's folder on
    model        name of the lens model, or auto
    serial       serial number of the camera
    date         of the photographs, as 2026-03-01 or 2026-03-01T08:30; without it that of EXIF
    temperature  degrees Celsius

In a folder of folders each folder with photographs is a camera, whose id is the folder's name.
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from datetime import UTC, date, datetime
from pathlib import Path
from typing import Any

from calibgui.app.calibrating.settings import (
    Settings,
    check_settings,
    read_model_choice,
)
from calibgui.app.fleet.photographs import check_address
from calibgui.app.photographs.paths import is_remote
from calibgui.dataset.fleet import FleetEntry
from calibgui.engine.arrays import GridSize
from calibgui.engine.boards import CHECKERBOARD, KINDS, Pattern
from calibgui.engine.errors import CalibrationError
from calibgui.engine.features import METHODS, MIN_LINES
from calibgui.formats.circle_list import read_circle_list
from calibgui.formats.csv_table import read_numbered_csv_rows

_COLUMNS = ("id", "paths", "board", "model", "serial", "date", "temperature")
_NEEDED = ("id", "paths")
_PARQUET = ".parquet"
_NUMBER = r"\d*\.?\d+"


@dataclass(frozen=True, slots=True)
class BoardSought:
    """The board that is looked for in photographs."""

    square: float | None
    """Side of a square, mm; None if it is not known."""
    square_sigma: float = field(default=0.0, kw_only=True)
    """Standard deviation of the side, mm, common to all squares."""
    grid_size: GridSize | None = None
    """Rows and columns; None to infer them from the photographs."""
    pattern: Pattern | None = CHECKERBOARD
    """The pattern, whose unknown properties are inferred; None to find out all of it."""
    method: str = METHODS[0]
    """How corners are located, one of ``features.METHODS``."""


@dataclass(frozen=True, slots=True)
class CameraTask:
    """A camera to calibrate."""

    entry: FleetEntry
    """What the manifest says of it."""
    paths: tuple[str, ...]
    """Folders, patterns, files and addresses of its photographs."""
    board: BoardSought
    """The board that they show."""
    settings: Settings
    """How to calibrate."""


def read_manifest(path: Path, board: BoardSought, settings: Settings) -> tuple[CameraTask, ...]:
    """Read the cameras of a fleet.

    Args:
        path: a table or a folder.
        board, settings: what holds for cameras of which the table does not say otherwise.

    Raises:
        CalibrationError: if it cannot be read, or says of a camera what cannot be; the message
            names the line.
    """
    tasks: list[CameraTask] = []
    lines: dict[str, str] = {}
    for place, row in _read_rows(path):
        try:
            task = _read_task(row, path, board, settings)
            # Files are named after ids, and some systems take A and a for one name.
            first = lines.setdefault(task.entry.id.casefold(), place)
            if first != place:
                raise CalibrationError(
                    f"the id {task.entry.id!r} is that of {first}.", "Give each an id of its own."
                )
        except CalibrationError as error:
            raise CalibrationError(f"{path}, {place}: {error.message}", error.hint) from error
        tasks.append(task)
    if not tasks:
        hint = "Add a line for each."
        if path.is_dir():
            hint = "Name a folder that holds a folder of photographs for each camera."
        raise CalibrationError(f"{path} lists no cameras.", hint)
    return tuple(tasks)


def _read_rows(path: Path) -> list[tuple[str, dict[str, str]]]:
    """Return the rows of a manifest, each with its place in words."""
    if path.is_dir():
        return [(f"folder {row['id']}", row) for row in _list_folders(path)]
    if path.suffix.lower() == _PARQUET:
        numbered = [(f"row {n}", row) for n, row in enumerate(_read_parquet(path), start=1)]
    else:
        numbered = [(f"line {line}", row) for line, row in read_numbered_csv_rows(path)]
    columns = [] if not numbered else [name for name in numbered[0][1] if name is not None]
    for name in columns:
        if name not in _COLUMNS:
            raise CalibrationError(
                f"{path} has a column {name!r}, which means nothing here.",
                f"Columns are {', '.join(_COLUMNS)}: rename it or leave it out.",
            )
    for name in _NEEDED:
        if numbered and name not in columns:
            raise CalibrationError(
                f"{path} has no column {name!r}.", "The first line names the columns, as id,paths."
            )
    return numbered


def _list_folders(path: Path) -> Iterable[dict[str, str]]:
    """List the folders in a folder as rows of a table."""
    try:
        entries = sorted(entry.name for entry in os.scandir(path) if entry.is_dir())
    except OSError as error:
        raise CalibrationError(
            f"{path} cannot be read: {error.strerror or error}.", "Check that you may read it."
        ) from error
    return [{"id": name, "paths": name} for name in entries if not name.startswith(".")]


def _read_parquet(path: Path) -> list[dict[str, str]]:
    """Return the rows of a table in Parquet as text.

    Raises:
        CalibrationError: if it cannot be read, or the library that reads it is not installed.
    """
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError as error:
        raise CalibrationError(
            f"{path} cannot be read: pyarrow is not installed.",
            "pip install pyarrow, or give the table as CSV.",
        ) from error
    try:
        table = pyarrow.parquet.read_table(path)
    except (OSError, pyarrow.ArrowException) as error:
        raise CalibrationError(
            f"{path} is not a table in Parquet: {error}.", "Choose another file."
        ) from error
    return [{k: "" if v is None else str(v) for k, v in row.items()} for row in table.to_pylist()]


def _read_task(
    row: Mapping[Any, str | None], path: Path, board: BoardSought, settings: Settings
) -> CameraTask:
    """Return the camera of a row. Raises CalibrationError if something in it is wrong."""
    if None in row:
        raise CalibrationError("it has more cells than columns.", "Quote cells that hold commas.")
    cells = {name: (row.get(name) or "").strip() for name in _COLUMNS}
    for name in _NEEDED:
        if not cells[name]:
            raise CalibrationError(f"the cell {name!r} is empty.", "Fill it in.")
    entry = FleetEntry(
        cells["id"],
        cells["serial"],
        _read_date(cells["date"]),
        _read_temperature(cells["temperature"]),
    )
    try:
        entry.id.encode()
    except UnicodeEncodeError as error:
        raise CalibrationError("its name is not valid Unicode.", "Rename it.") from error
    folder = path if path.is_dir() else path.parent
    names = [name for part in cells["paths"].split(";") if (name := part.strip())]
    for name in filter(is_remote, names):
        check_address(name)
    paths = tuple(
        name if is_remote(name) else os.path.abspath(folder / name)  # noqa: PTH100 - keeps links
        for name in names
    )
    sought = read_board_words(cells["board"], board, folder)
    if sought.square is None:
        raise CalibrationError(
            "the side of a square is not known.",
            "Add it to the column board, as 30mm, or to the command line: --square 30.",
        )
    return CameraTask(entry, paths, sought, _read_model(cells["model"], settings))


def read_board_words(text: str, board: BoardSought, folder: Path = Path()) -> BoardSought:
    """Return `board` with what the words of a text say otherwise, such as "charuco 5x7 30mm".

    Args:
        text: the words.
        board: the board of which they say something.
        folder: the folder from which a list of circles is named.

    Raises:
        CalibrationError: for a word that says nothing of a board, or a list that cannot be read.
    """
    for word in text.replace(",", " ").split():
        if word in KINDS:
            if board.pattern is None or word != board.pattern.kind:
                board = replace(board, pattern=KINDS[word])
        elif match := re.fullmatch(r"(\d{1,9})[x×](\d{1,9})", word):
            size = int(match[1]), int(match[2])
            if min(size) < MIN_LINES:
                raise CalibrationError(
                    f"a board of {word} is too small.",
                    f"Boards have at least {MIN_LINES}x{MIN_LINES} inner corners.",
                )
            board = replace(board, grid_size=size)
        elif match := re.fullmatch(rf"({_NUMBER})(?:(?:±|\+-|\+/-)({_NUMBER}))?mm", word):
            square, sigma = float(match[1]), float(match[2] or 0)
            if not sigma < square < math.inf:
                raise CalibrationError(
                    f"{word} is not the side of a square.", "Write it as 30mm, or 30+-0.02mm."
                )
            board = replace(board, square=square, square_sigma=sigma)
        elif Path(word).suffix.lower() in (".csv", ".json"):
            pattern, pitch = read_circle_list(folder / word)
            size = pattern.grid_size
            board = replace(board, square=pitch, square_sigma=0.0, pattern=pattern, grid_size=size)
        else:
            raise CalibrationError(
                f"{word!r} says nothing of a board.",
                "Write ROWSxCOLS, the side of a square as 30mm, and one of "
                f"{', '.join(KINDS)}, with blanks between; or name a list of circles, as dots.csv.",
            )
    return board


def _read_model(text: str, settings: Settings) -> Settings:
    if not text:
        return settings
    changed = replace(settings, model=read_model_choice(text))
    check_settings(changed)
    return changed


def _read_date(text: str) -> str:
    """Return a date in ISO's form, times with a zone in UTC, so that the text sorts as the time."""
    if not text:
        return ""
    try:
        if re.fullmatch(r"\d{4}-?\d\d-?\d\d", text):
            return date.fromisoformat(text).isoformat()
        found = datetime.fromisoformat(text)
        if found.tzinfo is not None:
            found = found.astimezone(UTC).replace(tzinfo=None)
        return found.isoformat()
    except (ValueError, OverflowError) as error:
        raise CalibrationError(
            f"{text!r} is not a date.", "Write it as 2026-03-01 or 2026-03-01T08:30."
        ) from error


def _read_temperature(text: str) -> float | None:
    if not text:
        return None
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise CalibrationError(
            f"{text!r} is not a temperature.", "Write degrees Celsius as a number, as 21.5."
        )
    return value

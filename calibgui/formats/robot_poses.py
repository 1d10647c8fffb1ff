"""Poses of a robot, as controllers and other programs write them: CSV, JSON, text and MAT files.

Read: numbers, six (x, y, z and angles or a rotation vector), seven (x, y, z and a quaternion),
twelve or sixteen (a matrix) to a pose, in whatever units and order: what they mean is found out
with the photographs (``engine/hand_eye/readings.py``).

Text and CSV: a pose a line, its numbers apart by commas, semicolons, tabs or blanks, or a matrix in
three or four lines of four. A column of words holds the names of the photographs. A first line may
name the columns: qx, qy, qz, qw are then brought into that order, and columns of times and counts
are left out. A comment follows # or %.
JSON: a list of poses, or an object of them by the names of photographs, perhaps its member "poses".
A pose is a list of numbers or of rows, or an object with "matrix", or with "translation" (or
"position", "tvec", "t") and "rotation" (or "orientation", "quaternion", "rvec", "R"), whose members
may be lists or objects of x, y, z and w.
MAT: MATLAB's files up to version 7, with one array of poses: a pose a row, or a matrix a layer.
Cannot hold: how accurate the poses are.
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, freeze
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import describe_read_error, read_regular
from calibgui.formats.gate import parse_number, read_text
from calibgui.formats.json_document import parse_json
from calibgui.formats.mat_file import NotMatError, read_mat_variables
from calibgui.formats.node import Node

_MAX_SIZE = 16 << 20
"""Size of the largest files that are read, bytes: a matrix of sixteen numbers has some 300."""
_LENGTHS = (6, 7, 12, 16)
"""Numbers of numbers of a pose."""
_NOT_OF_POSES = re.compile(r"(time|timestamp|stamp|t_s|sec|nsec|nanosec|index|idx|id|no|nr|seq|#)")
"""Names of columns that say nothing of a pose."""
_QUATERNION = ("qx", "qy", "qz", "qw")
_TRANSLATION = ("translation", "position", "tvec", "t")
_ROTATION = ("rotation", "orientation", "quaternion", "rvec", "R")
_NAMES = ("image", "name", "file")
_HINT = (
    "Give a line for each pose: x, y, z and angles, a rotation vector or a quaternion, or a matrix "
    "of 12 or 16 numbers."
)


@dataclass(frozen=True, eq=False, slots=True)
class RobotPoseTable:
    """Poses of a robot as they stand in a file."""

    file: str
    numbers: Array
    """(K, n) numbers of each pose, n of 6, 7, 12 or 16."""
    names: tuple[str, ...] = ()
    """Names of the photographs; empty if the file has none, so that their order counts."""

    def __post_init__(self) -> None:
        freeze(self, "numbers")


def read_robot_poses(path: str | os.PathLike[str]) -> RobotPoseTable:
    """Read the poses of a robot.

    Raises:
        CalibrationError: if the file cannot be read, or holds no poses; it names file and place.
    """
    suffix = Path(path).suffix.lower()
    if suffix == ".mat":
        return _read_mat(path)
    text, file = read_text(path, _MAX_SIZE, "a file of poses"), os.fspath(path)
    return _decode(parse_json(text, file)) if suffix == ".json" else _read_lines(text, file)


def _make_table(file: str, poses: Sequence[npt.ArrayLike], names: Sequence[str]) -> RobotPoseTable:
    """Make the table. Raises CalibrationError for numbers that are no poses."""
    rows = [np.asarray(pose, np.float64).ravel() for pose in poses]
    lengths = {len(row) for row in rows}
    if len(lengths) != 1 or not lengths <= set(_LENGTHS):
        counts = " and ".join(map(str, sorted(lengths))) or "no"
        raise CalibrationError(f"{file}: poses of {counts} numbers are none of a robot.", _HINT)
    if len(set(names)) < len(names):
        twice = next(name for k, name in enumerate(names) if name in names[:k])
        raise CalibrationError(
            f"{file} has two poses for {twice}.", "Leave one pose for each photograph."
        )
    return RobotPoseTable(file, np.stack(rows), tuple(names))


def _read_lines(text: str, file: str) -> RobotPoseTable:
    """Read text and CSV."""
    separator = next((s for s in (";", "\t", ",") if s in text), None)
    lines = [
        (number, [cell.strip().strip('"') for cell in line.split(separator)])
        for number, line in enumerate(
            (re.split("[#%]", line)[0].strip() for line in text.splitlines()), start=1
        )
        if line
    ]
    head: list[str] = []
    if lines and sum(not _is_number(cell) for cell in lines[0][1]) > 1:
        head = [cell.lower() for cell in lines.pop(0)[1]]
    if not lines:
        raise CalibrationError(f"{file} holds no poses.", _HINT)
    width = len(lines[0][1])
    for number, cells in lines:
        if len(cells) != width:
            raise CalibrationError(
                f"{file}, line {number}: it has {len(cells)} entries, and the first one {width}.",
                "Give as many on each line.",
            )
    columns = list(range(width))
    words = [k for k in columns if not any(_is_number(cells[k]) for _, cells in lines)]
    columns = [k for k in columns if k not in words[:1]]
    if len(head) == width:
        columns = [k for k in columns if not _NOT_OF_POSES.fullmatch(head[k])]
        if set(_QUATERNION) <= set(head):
            at = [head.index(name) for name in _QUATERNION]
            columns = [k for k in columns if k not in at] + at
    table = [[_parse_cell(cells[k], file, number) for k in columns] for number, cells in lines]
    names = [cells[words[0]] for _, cells in lines] if words else []
    return _make_table(file, _join_lines(table), names)


def _join_lines(table: list[list[float]]) -> list[npt.ArrayLike]:
    """Join the lines of matrices that take three or four."""
    if len(table[0]) != 4:
        return list(table)
    rows = 4 if table[3::4] and all(line == [0, 0, 0, 1] for line in table[3::4]) else 3
    if len(table) % rows:
        return list(table)
    return list(np.reshape(table, (-1, 4 * rows)))


def _is_number(cell: str) -> bool:
    try:
        parse_number(cell)
    except ValueError:
        return False
    return True


def _parse_cell(cell: str, file: str, line: int) -> float:
    try:
        number = parse_number(cell)
    except ValueError as error:
        raise CalibrationError(f"{file}, line {line}: {error}.", _HINT) from error
    if not np.isfinite(number):
        raise CalibrationError(f"{file}, line {line}: {cell[:20]!r} is too large.", _HINT)
    return number


def _decode(node: Node) -> RobotPoseTable:
    """Decode JSON."""
    if isinstance(node.value, dict) and "poses" in node.value:
        node = node["poses"]
    if isinstance(node.value, dict):
        members = node.members()
        return _make_table(node.file, [_decode_pose(each) for each in members.values()], [*members])
    poses = node.items()
    names = [name for pose in poses if (name := _decode_name(pose)) is not None]
    if names and len(names) < len(poses):
        raise CalibrationError(
            f"{node.file}: some poses name their photograph and others do not.",
            "Name all of them, or none.",
        )
    return _make_table(node.file, [_decode_pose(pose) for pose in poses], names)


def _decode_name(pose: Node) -> str | None:
    if not isinstance(pose.value, dict):
        return None
    named = (pose.get(key) for key in _NAMES)
    return next((node.text() for node in named if node is not None), None)


def _decode_pose(node: Node) -> Array:
    """Return the numbers of a pose."""
    if not isinstance(node.value, dict):
        return _decode_numbers(node)
    for key in ("matrix", "pose"):
        if (whole := node.get(key)) is not None:
            return _decode_pose(whole)
    place, rotation = (
        next((found for key in keys if (found := node.get(key)) is not None), None)
        for keys in (_TRANSLATION, _ROTATION)
    )
    if place is None or rotation is None:
        node.fail('a pose, which has "translation" and "rotation", or a "matrix"')
    t, r = _decode_numbers(place), _decode_numbers(rotation)
    if len(t) == 3 and len(r) == 9:
        return np.column_stack([r.reshape(3, 3), t]).ravel()
    return np.concatenate([t, r])


def _decode_numbers(node: Node) -> Array:
    """Return numbers of a list, of a list of lists, or of an object of x, y, z and w."""
    if isinstance(node.value, dict):
        keys = [key for key in "xyzw" if key in node.value]
        return np.array([node[key].number() for key in keys])
    rows = node.items()
    if rows and isinstance(rows[0].value, list | np.ndarray):
        return np.concatenate([row.numbers(None) for row in rows])
    return node.numbers(None)


def _read_mat(path: str | os.PathLike[str]) -> RobotPoseTable:
    """Read a MAT file."""
    file = os.fspath(path)
    try:
        variables = read_mat_variables(read_regular(path, _MAX_SIZE))
    except OSError as error:
        raise describe_read_error(path, error) from error
    except NotMatError as error:
        raise CalibrationError(
            f"{file} is not a MAT file that is read here: {error}.",
            "Save it in MATLAB with the option -v7, or write the poses as CSV.",
        ) from error
    arrays = [value for _, value in variables if not isinstance(value, str)]
    return _make_table(file, [pose for array in arrays for pose in _list_poses(array)], [])


def _list_poses(array: Array) -> list[npt.ArrayLike]:
    """List the poses of an array; none of one that holds something else."""
    if not np.isfinite(array).all():
        return []
    for sides in ((4, 4), (3, 4)):
        if array.shape == sides:
            return [array]
        if array.ndim == 3 and array.shape[:2] == sides:  # as MATLAB has it
            return list(np.moveaxis(array, 2, 0))
        if array.ndim == 3 and array.shape[1:] == sides:
            return list(array)
    return list(array) if array.ndim == 2 and array.shape[1] in _LENGTHS else []

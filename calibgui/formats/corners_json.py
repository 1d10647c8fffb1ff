"""corners.json: located corners with their places on the plate, from this or any program.

    {"size": [w, h], "views": [{"image", "uv": [[u, v], ...], "board": [[x, y], ...], "cov"}]}

Reader: `read_corners`, and any JSON reader. Positions are pixels in the array frame (0-based,
integer at pixel centres, v down), `board` millimetres on the plate, `cov` (optional) 2 x 2
covariances in px^2. This program adds the board as `target` (``pattern_json.py``) and per view
what ``views_json.py`` lists; a reader may ignore all of it. Views without corners have empty lists.
Cannot hold: a calibration (see ``result_json.py``).
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from calibgui.dataset.corner_set import CornerSet
from calibgui.dataset.result import Result
from calibgui.engine.arrays import Size
from calibgui.engine.errors import CalibrationError
from calibgui.formats.exporter import Exporter, ExportReport
from calibgui.formats.json_document import Node, read, write
from calibgui.formats.pattern_json import read_target, target_record
from calibgui.formats.views_json import read_views, view_record

_LONGEST = 1_000_000
"""Side of an image, px; no camera's is longer."""


def write_corners(corner_set: CornerSet, path: str | os.PathLike[str]) -> None:
    """Write corners.json.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    write(path, corners_record(corner_set))


def corners_record(corner_set: CornerSet) -> dict[str, Any]:
    """The content of corners.json."""
    record: dict[str, Any] = {"size": corner_set.size}
    if corner_set.board is not None:
        record["target"] = target_record(corner_set.board)
    return record | {"views": [view_record(view, corner_set.board) for view in corner_set.views]}


def read_corners(path: str | os.PathLike[str]) -> CornerSet:
    """Read corners.json.

    Raises:
        CalibrationError: if the file cannot be read or something in it is wrong, naming view
            and entry.
    """
    node = read(path)
    if (other := node.get("format")) is not None:
        raise CalibrationError(
            f"{node.file} is a file of the format {other.value!r}, not corners.json.",
            "Name the corners: `calibgui detect -o` writes them, and `--export corners=`.",
        )
    board = read_target(node.get("target"))
    return CornerSet(read_size(node["size"]), read_views(node["views"], board), board)


def read_size(node: Node) -> Size:
    """Width and height of an image."""
    width, height = (int(n) for n in node.integers(2))
    if not 1 <= width <= _LONGEST or not 1 <= height <= _LONGEST:
        node.fail("the width and height of an image")
    return width, height


def _export(result: Result, path: Path) -> ExportReport:
    size = result.calibration.camera.size
    write_corners(CornerSet(size, result.views, result.board), path)
    return ExportReport(path, EXPORTER.limits)


EXPORTER = Exporter(
    name="corners",
    title="Corners as JSON",
    suffixes=(".json",),
    limits="Corners of all images and their places on the plate; no calibration.",
    write=_export,
    partial=True,
)

"""corners.json: located corners with their places on the board, from this or any program.

    {"size": [w, h], "views": [{"image", "uv": [[u, v], ...], "board": [[x, y], ...], "cov"}]}

Reader: `read_corners`, and any JSON reader. Positions are pixels in the array frame (0-based,
integer at pixel centres, v down), `board` millimetres on the board, `cov` (optional) 2 x 2
covariances in px^2. This program adds a sentence on where the file comes from as `origin`
(``origin.py``), the board as `target` (``pattern_json.py``), `lengths_confirmed`, which is false if
nobody has stated the side of a square, and to each view the members that ``views_json.py`` lists; a
reader may ignore these. Views without corners have empty lists.
Cannot hold: a calibration (see ``result_json.py``).
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from calibgui.dataset import CornerSet, Result
from calibgui.engine.arrays import Size
from calibgui.engine.camera import MODELS
from calibgui.engine.errors import CalibrationError
from calibgui.formats.exporter import Exporter, ExportReport, describe_condition
from calibgui.formats.json_document import Node, read_json, write_json
from calibgui.formats.origin import CORNERS, make_mark
from calibgui.formats.pattern_json import decode_board, encode_board
from calibgui.formats.views_json import decode_views, encode_view

_MAX_SIDE_PX = 1_000_000
"""Largest side of an image, px; a longer one is refused as an error of the file."""


def write_corners(corner_set: CornerSet, path: str | os.PathLike[str]) -> None:
    """Write corners.json.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    write_json(path, encode_corners(corner_set))


def encode_corners(corner_set: CornerSet) -> dict[str, Any]:
    """Return the content of corners.json."""
    record: dict[str, Any] = {"origin": make_mark(CORNERS), "size": corner_set.size}
    if corner_set.board is not None:
        record["target"] = encode_board(corner_set.board)
    if not corner_set.lengths_confirmed:
        record["lengths_confirmed"] = False
    return record | {"views": [encode_view(view, corner_set.board) for view in corner_set.views]}


def read_corners(path: str | os.PathLike[str]) -> CornerSet:
    """Read corners.json.

    Raises:
        CalibrationError: if the file cannot be read or something in it is wrong; the message
            names view and entry.
    """
    node = read_json(path)
    if node.get("format") is not None or not {"size", "views"} & node.members().keys():
        raise CalibrationError(
            f"{node.file} is not a file of corners.",
            "Name the corners: `calibgui detect -o` writes them, and `--export corners=`.",
        )
    board = decode_board(node.get("target"))
    confirmed = node.get("lengths_confirmed")
    return CornerSet(
        decode_size(node["size"]),
        decode_views(node["views"], board),
        board,
        lengths_confirmed=True if confirmed is None else confirmed.flag(),
    )


def decode_size(node: Node) -> Size:
    """Return the width and height of an image, px."""
    width, height = (int(n) for n in node.integers(2))
    if not 1 <= width <= _MAX_SIDE_PX or not 1 <= height <= _MAX_SIDE_PX:
        node.fail("the width and height of an image")
    return width, height


def _export(result: Result, path: Path) -> ExportReport:
    size = result.calibration.camera.size
    write_corners(CornerSet(size, result.views, result.board, result.lengths_confirmed), path)
    return ExportReport(path, f"{EXPORTER.limits} {describe_condition(result)}".rstrip())


EXPORTER = Exporter(
    name="corners",
    title="Corners as JSON",
    suffixes=(".json",),
    models=tuple(MODELS),
    limits="Corners of all images and their places on the board; no calibration.",
    write=_export,
    partial=True,
    needs_corners=True,
)

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
from calibgui.engine.camera import MODELS
from calibgui.engine.errors import CalibrationError
from calibgui.formats.exporter import Exporter, ExportReport, describe_condition
from calibgui.formats.json_document import read_json, write_json
from calibgui.formats.node import Node
from calibgui.formats.origin import CORNERS, make_mark
from calibgui.formats.pattern_json import decode_board, encode_board
from calibgui.formats.views_json import decode_views, encode_view

EXAMPLE = """\
{"size": [1280, 720], "views": [
  {"image": "view01.png",
   "uv": [[101.5, 80.2], [160.7, 81.5], [102.0, 140.1], [161.1, 141.6]],
   "board": [[0, 0], [25, 0], [0, 25], [25, 25]]}
]}"""
"""The shortest file that can be read."""
HINT = f"""\
`calibgui detect -o` and `--export corners=` write such files. From another program write a \
corners.json, uv in pixels and board in mm:
{EXAMPLE}
or a table in CSV with the columns image,u,v,row,col or image,u,v,X,Y."""
"""Advice where a file holds no corners in a form that is read."""


NOTE = "Corners and their places on the board; no calibration."
"""What users should know of a file of corners."""


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
    return decode_corners(read_json(path))


def decode_corners(node: Node) -> CornerSet:
    """Return the corners of the content of a corners.json.

    Raises:
        CalibrationError: if something in it is wrong; the message names view and entry.
    """
    if node.get("format") is not None or not {"size", "views"} & node.members().keys():
        raise CalibrationError(f"{node.file} is not a file of corners.", HINT)
    board = decode_board(node.get("target"))
    confirmed = node.get("lengths_confirmed")
    return CornerSet(
        node["size"].image_size(),
        decode_views(node["views"], board),
        board,
        lengths_confirmed=True if confirmed is None else confirmed.flag(),
    )


def _export(result: Result, path: Path) -> ExportReport:
    size = result.calibration.camera.size
    write_corners(CornerSet(size, result.views, result.board, result.lengths_confirmed), path)
    return ExportReport(path, f"{NOTE} {describe_condition(result)}".rstrip())


EXPORTER = Exporter(
    name="corners",
    title="Corners as JSON",
    suffixes=(".json",),
    models=tuple(MODELS),
    readers="calibgui, any reader of JSON",
    keeps="the corners of all photographs and their places on the board",
    loses="the calibration",
    write=_export,
    partial=True,
    needs_corners=True,
)

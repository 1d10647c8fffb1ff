"""Views as they were found in photographs, by keys of what was searched for in which content.

Reader: `read_detections`. Each view is as in corners.json (``views_json.py``), on a board of
squares of 1 mm, with its ``key``. The file only saves time and may be deleted.
Cannot hold: what a search says of a corner besides its place and covariance, as its contrast.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from calibgui.dataset import View
from calibgui.engine.boards import Board
from calibgui.engine.errors import CalibrationError
from calibgui.formats.json_document import check_format, read_json, write_json
from calibgui.formats.node import Node
from calibgui.formats.pattern_json import decode_pattern
from calibgui.formats.views_json import decode_views, encode_view

FORMAT = "calibgui-detections"
VERSION = 1


def read_detections(file: Path) -> dict[str, View]:
    """Read the views by their keys; none from a file that is missing or cannot be understood."""
    try:
        node = read_json(file)
        check_format(node, FORMAT, VERSION, "a record of detections")
        return {view["key"].text(): _decode_view(view) for view in node["views"].items()}
    except CalibrationError:
        return {}


def write_detections(views: Mapping[str, View], file: Path) -> None:
    """Write views by their keys.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    records = [
        {"key": key} | encode_view(view, None if view.corners is None else _make_board(view))
        for key, view in views.items()
    ]
    write_json(file, {"format": FORMAT, "version": VERSION, "views": records})


def drop_details(view: View) -> View:
    """Return a view without what the file cannot hold: as it is once written and read."""
    if view.corners is None:
        return view
    corners = replace(view.corners, blur=None, contrast=None, residual=None, rejected=())
    return replace(view, corners=corners)


def _make_board(view: View) -> Board:
    """Return a board with the corners of a view."""
    assert view.corners is not None
    return Board(*view.corners.shape, 1.0, view.corners.pattern)


def _decode_view(node: Node) -> View:
    board = None
    if (shape := node.get("shape")) is not None:
        board = Board(*shape.grid_size(), 1.0, decode_pattern(node.get("pattern")))
    (view,) = decode_views(Node([node.value], node.where, node.file), board)
    return view

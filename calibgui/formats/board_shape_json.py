"""board-shape.json: the estimated shape of a board, for later calibrations to hold.

    {"format": "calibgui-plate", "version": 1, "model", "nominal_mm": [[x, y], ...],
     "deviation_mm": [[dx, dy, dz], ...], "sigma_mm": [[sx, sy, sz], ...]}

Reader: `read_board_shape`, and any JSON reader. Lengths are millimetres in the board's frame: a
corner is at its nominal place plus its deviation; z is along x cross y. Cannot hold: the
calibration that estimated the shape (see ``result_json.py``).
"""

from __future__ import annotations

import os
from typing import Any

from calibgui.engine.boards import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.formats.json_document import Node, check_format, read_json, write_json

FORMAT = "calibgui-plate"
VERSION = 1


def write_board_shape(board_shape: BoardShape, path: str | os.PathLike[str]) -> None:
    """Write the shape of a board.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    write_json(path, {"format": FORMAT, "version": VERSION, **encode_board_shape(board_shape)})


def read_board_shape(path: str | os.PathLike[str]) -> BoardShape:
    """Read the shape of a board.

    Raises:
        CalibrationError: if the file cannot be read or is of another format.
    """
    node = read_json(path)
    check_format(node, FORMAT, VERSION, "a board shape")
    return decode_board_shape(node)


def encode_board_shape(board_shape: BoardShape) -> dict[str, Any]:
    """Return the JSON object of a board's shape, the same in this file and in a result."""
    return {
        "model": board_shape.model,
        "nominal_mm": board_shape.nominal,
        "deviation_mm": board_shape.deviation,
        "sigma_mm": board_shape.sigma,
    }


def decode_board_shape(node: Node) -> BoardShape:
    """Return the board's shape of a JSON object."""
    nominal = node["nominal_mm"].numbers(None, 2)
    return BoardShape(
        BoardShapeModel(node["model"].choice(list(BoardShapeModel))),
        nominal,
        node["deviation_mm"].numbers(len(nominal), 3),
        node["sigma_mm"].numbers(len(nominal), 3),
    )


def decode_prior(node: Node) -> BoardShapePrior:
    """Return the prior standard deviations [in_plane, out_of_plane], mm, of a board's shape."""
    if not (sigma := node.numbers(2)).min() > 0:
        node.fail("two lengths above 0")
    return BoardShapePrior(*sigma.tolist())

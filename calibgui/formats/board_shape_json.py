"""plate.json: the shape of a target as it was found to be, for later calibrations to hold.

    {"format": "calibgui-plate", "version": 1, "model", "nominal_mm": [[x, y], ...],
     "deviation_mm": [[dx, dy, dz], ...], "sigma_mm": [[sx, sy, sz], ...]}

Reader: `read_plate`, and any JSON reader. Millimetres in the plate's frame: the nominal corner
plus its deviation is where the corner is; z is along x cross y. Cannot hold: how the plate was
found (see ``result_json.py``).
"""

from __future__ import annotations

import os
from typing import Any

from calibgui.engine.boards import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.formats.json_document import Node, check_format, read, write

FORMAT = "calibgui-plate"
VERSION = 1


def write_board_shape(board_shape: BoardShape, path: str | os.PathLike[str]) -> None:
    """Write plate.json.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    write(path, {"format": FORMAT, "version": VERSION, **board_shape_record(board_shape)})


def read_board_shape(path: str | os.PathLike[str]) -> BoardShape:
    """Read plate.json.

    Raises:
        CalibrationError: if the file cannot be read or is no plate.
    """
    node = read(path)
    check_format(node, FORMAT, VERSION)
    return read_board_shape_record(node)


def board_shape_record(board_shape: BoardShape) -> dict[str, Any]:
    """A plate as JSON holds it, in this file and in a result."""
    return {
        "model": board_shape.model,
        "nominal_mm": board_shape.nominal,
        "deviation_mm": board_shape.deviation,
        "sigma_mm": board_shape.sigma,
    }


def read_board_shape_record(node: Node) -> BoardShape:
    """The inverse of `plate_record`."""
    nominal = node["nominal_mm"].numbers(None, 2)
    return BoardShape(
        BoardShapeModel(node["model"].choice(list(BoardShapeModel))),
        nominal,
        node["deviation_mm"].numbers(len(nominal), 3),
        node["sigma_mm"].numbers(len(nominal), 3),
    )


def read_prior(node: Node) -> BoardShapePrior:
    """What is known of a plate, [in_plane, out_of_plane] mm, where a file keeps it."""
    if not (sigma := node.numbers(2)).min() > 0:
        node.fail("two lengths above 0")
    return BoardShapePrior(*sigma.tolist())

"""board-shape.json: the estimated shape of a board, for later calibrations to hold.

    {"format": "calibgui-plate", "version": 1, "model", "nominal_mm": [[x, y], ...],
     "deviation_mm": [[dx, dy, dz], ...], "sigma_mm": [[sx, sy, sz], ...],
     "covariance_mm2": [[s00, s01, s02, ...], [s11, s12, ...], ...],
     "views": ["16 hexadecimal digits", ...]}

Reader: `read_board_shape`, and any JSON reader. Lengths are millimetres in the board's frame: a
corner is at its nominal place plus its deviation; z is along x cross y. `covariance_mm2` is the
upper triangle of the covariance S of the errors that corners have in common: of the
coefficients along x, y and z of each product of Legendre polynomials L_i(x) L_j(y), i + j <= 7, in
the order 00, 01, ..., 07, 10, ...; x and y are from -1 to 1 between the board's outermost corners
(``engine/boards/shape.py``). It is null, or missing in files of earlier versions, where it is not
known. `views` are digests of the views that the shape was estimated from. Cannot hold: the
calibration that estimated the shape (see ``result_json.py``).
"""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.boards import (
    ERROR_COEFFICIENTS,
    BoardShape,
    BoardShapeModel,
    BoardShapePrior,
)
from calibgui.formats.json_document import check_format, read_json, write_json
from calibgui.formats.node import Node

FORMAT = "calibgui-plate"
VERSION = 1
_MAX_NEGATIVE = 1e-6
"""Part of the largest eigenvalue of a covariance by which rounding may make others negative."""


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
        "covariance_mm2": _encode_covariance(board_shape.covariance),
        "views": board_shape.views,
    }


def decode_board_shape(node: Node) -> BoardShape:
    """Return the board's shape of a JSON object."""
    nominal = node["nominal_mm"].numbers(None, 2)
    return BoardShape(
        BoardShapeModel(node["model"].choice(list(BoardShapeModel))),
        nominal,
        node["deviation_mm"].numbers(len(nominal), 3),
        node["sigma_mm"].numbers(len(nominal), 3),
        _decode_covariance(node.get("covariance_mm2")),
        tuple(view.text() for view in views.items()) if (views := node.get("views")) else (),
    )


def _encode_covariance(covariance: Array | None) -> list[Array] | None:
    """Return the rows of a covariance's upper triangle."""
    return None if covariance is None else [row[i:] for i, row in enumerate(covariance)]


def _decode_covariance(node: Node | None) -> Array | None:
    """Return the covariance of its upper triangle's rows, None if it is not known."""
    if node is None:
        return None
    covariance = np.zeros((ERROR_COEFFICIENTS, ERROR_COEFFICIENTS))
    for i, row in enumerate(node.items(ERROR_COEFFICIENTS)):
        covariance[i, i:] = covariance[i:, i] = row.numbers(ERROR_COEFFICIENTS - i)
    values = np.linalg.eigvalsh(covariance)
    if values[0] < -_MAX_NEGATIVE * max(values[-1], 0.0):
        node.fail("a covariance: it has a negative variance")
    return covariance


def decode_prior(node: Node) -> BoardShapePrior:
    """Return the prior standard deviations [in_plane, out_of_plane], mm, of a board's shape."""
    if not (sigma := node.numbers(2)).min() > 0:
        node.fail("two lengths above 0")
    return BoardShapePrior(*sigma.tolist())

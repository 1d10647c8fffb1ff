"""A board of circles that are listed one by one, as a table or as JSON.

A table in CSV names its columns, two of them x and y, or x_mm and y_mm: the centre of a circle in
each further line. In JSON the same is

    {"circles_mm": [[0, 0], [20, 0], [10, 17]], "diameter_mm": 9}

of which the diameter may be left out. X points to the right and Y down, as the board is seen from
its front, mm; the origin may lie anywhere.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from calibgui.engine.boards import ListedCircles, list_circles
from calibgui.engine.errors import CalibrationError
from calibgui.formats.csv_table import parse_cell, read_numbered_csv_rows
from calibgui.formats.json_document import read_json

_COLUMNS = (("x_mm", "y_mm"), ("x", "y"), ("X", "Y"))


def read_circle_list(path: str | os.PathLike[str]) -> tuple[ListedCircles, float]:
    """Read the circles of a board.

    Returns:
        The pattern, and the least distance of two circles, mm: the side of a `Board`'s squares.

    Raises:
        CalibrationError: if the file cannot be read, or lists no circles that lie apart.
    """
    diameter = None
    if Path(path).suffix.lower() == ".json":
        node = read_json(path)
        places = node["circles_mm"].numbers(None, 2)
        stated = node.get("diameter_mm")
        diameter = None if stated is None else stated.number()
    else:
        rows = read_numbered_csv_rows(Path(path))
        names = rows[0][1].keys() if rows else ()
        pair = next((pair for pair in _COLUMNS if set(pair) <= set(names)), None)
        if pair is None:
            raise CalibrationError(
                f"{path} lists no circles: it has no columns x and y below their names.",
                "Let its first line be x,y and each further line the centre of a circle, in mm.",
            )
        places = np.array(
            [[parse_cell(path, line, row, name) for name in pair] for line, row in rows]
        )
    try:
        return list_circles(places, diameter)
    except CalibrationError as error:
        raise CalibrationError(f"{path}: {error.message}", error.hint) from error

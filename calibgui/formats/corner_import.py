"""Reading located corners from a file of any program, whichever it is: `read_corner_file`.

The content tells the format: corners.json (``corners_json.py``), mrcal's corners.vnl
(``corners_vnl.py``), a table in CSV (``corners_csv.py``), Bouguet's Calib_Results.mat
(``bouguet_results.py``), or lists of points (``corner_lists.py``). Where the file does not hold the
images' size it is read from the images, where one of them lies beside the file, or must be stated.
"""

from __future__ import annotations

import os
from dataclasses import replace

from calibgui.dataset import CornerSet
from calibgui.engine.arrays import GridSize, Size
from calibgui.engine.errors import CalibrationError
from calibgui.formats import bouguet_results, corner_lists, corners_csv, corners_json, corners_vnl
from calibgui.formats.corner_table import CornerText
from calibgui.formats.gate import read_text
from calibgui.formats.json_document import MAX_JSON_SIZE, parse_json

SUFFIXES = (".json", ".vnl", ".csv", ".mat", ".txt", ".yml", ".yaml", ".xml")
"""Suffixes of files of corners."""
_BINARY = ((bouguet_results.is_mat, bouguet_results.unpack_mat),)
"""Functions that tell and translate the binary files that are read."""


def read_corner_file(
    path: str | os.PathLike[str],
    grid_size: GridSize | None = None,
    square: float | None = None,
    size: Size | None = None,
    square_sigma: float = 0.0,
) -> CornerSet:
    """Read located corners from a file.

    Args:
        path: the file; its content tells the format.
        grid_size: rows and columns of the board's corners, for a file that does not state them.
        square: side of the board's squares, mm; it takes the place of that in the file.
        size: width and height of the images, px, for a file that does not state them.
        square_sigma: standard deviation of `square`, mm, common to all squares.

    Raises:
        CalibrationError: if the file cannot be read, something in it is wrong or missing, or it
            gives the corners' places in mm although `square` is stated.
    """
    text = read_text(path, MAX_JSON_SIZE, "a file of corners", corners_json.HINT, _BINARY)
    source = CornerText(text, os.fspath(path), grid_size, size)
    if corners_vnl.SIGNATURE.search(text):
        corner_set = corners_vnl.read_corners_vnl(source)
    elif corners_csv.SIGNATURE.match(text):
        corner_set = corners_csv.read_corners_csv(source)
    elif corner_lists.OPENCV_SIGNATURE.search(text):
        corner_set = corner_lists.read_opencv_corners(source)
    elif corner_lists.ZHANG_SIGNATURE.match(text):
        corner_set = corner_lists.read_zhang_corners(source)
    elif bouguet_results.CORNERS_SIGNATURE.search(text):
        corner_set = bouguet_results.read_bouguet_corners(source)
    elif text.lstrip().startswith("{") or not text.strip():
        corner_set = corners_json.decode_corners(parse_json(text, source.file))
        source.check_stated(corner_set)
    else:
        raise CalibrationError(f"{source.file} is not a file of corners.", corners_json.HINT)
    if square is None:
        return corner_set
    return _state_square(corner_set, square, square_sigma, source.file)


def _state_square(
    corner_set: CornerSet, square: float, square_sigma: float, file: str
) -> CornerSet:
    """Return the corners on a board of squares of a side with its standard deviation, mm."""
    if corner_set.board is None:
        raise CalibrationError(
            f"{file} already gives the corners' places on the board in millimetres.",
            "Leave the side of a square out.",
        )
    board = replace(corner_set.board, square=square, square_sigma=square_sigma)
    return replace(corner_set, board=board, lengths_confirmed=True)

"""Corners as lists of points: Zhang's texts, and what OpenCV's calibration sample writes.

Reader: `read_zhang_corners` and `read_opencv_corners`; pixels are the array frame's.

Zhang's Model.txt lists the board's points, x y x y ..., and each text beside it with as many
numbers those of one photograph in the same order, as data1.txt. They are millimetres here, though
Zhang's own are inches: only lengths depend on it.

OpenCV's sample writes `image_points` (a row for each photograph, a column for each corner, row by
row of the board), `board_width` and `board_height`, and the images' size. Its `square_size` has no
unit, and is left to the user to state.
Cannot hold: the names of photographs, corners that were not found.
"""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np

from calibgui.dataset import CornerSet, View, ViewStatus
from calibgui.engine.arrays import Array
from calibgui.engine.calibration import Observation
from calibgui.engine.errors import CalibrationError
from calibgui.formats.corner_table import CornerText, make_board, make_view
from calibgui.formats.gate import parse_number, read_text
from calibgui.formats.node import Node
from calibgui.formats.opencv_storage import parse_storage

OPENCV_SIGNATURE = re.compile(r"""(^[ \t]*|["<])image_points["\s:>]""", re.MULTILINE)
"""The entry of OpenCV's sample that holds the corners."""
ZHANG_SIGNATURE = re.compile(r"\A(\s*[-+]?[\d.]+(e[-+]?\d+)?\s){8}", re.IGNORECASE)
"""Eight numbers: the corners of a square in Zhang's lists."""
_MAX_LENGTH = 1 << 22
"""Length of the longest list beside Zhang's model that is looked at, bytes."""


def read_zhang_corners(source: CornerText) -> CornerSet:
    """Read the board's points, and those of the photographs from the texts beside the file.

    Raises:
        CalibrationError: if the points are no pairs of numbers, none of the texts has as many, or
            the images' size is not known.
    """
    if source.grid_size is not None:
        source.fail("gives the corners' places, not their rows and columns.", "Leave --board out.")
    board = _parse_points(source.text)
    if board is None:
        source.fail("is no list of points, x y x y ....", "Correct the file or write it again.")
    model = Path(source.file)
    views = []
    for path in sorted(model.parent.glob(f"*{model.suffix}"), key=_split_numbers):
        uv = None if path.samefile(model) else _read_points(path)
        if uv is not None and len(uv) == len(board):
            views.append(View(path.name, ViewStatus.FOUND, points=Observation(uv, board)))
    if not views:
        source.fail(
            f"lists {len(board)} points of a board, and no text beside it lists as many.",
            "Put the lists of the photographs' points beside it.",
        )
    size = source.find_size(())  # the lists name no images
    return CornerSet(size, tuple(views), None, lengths_confirmed=False)


def _split_numbers(path: Path) -> list[tuple[str, int]]:
    """Return a key by which data2.txt comes before data10.txt."""
    return [(word, int(digits or 0)) for word, digits in re.findall(r"(\D*)(\d{0,9})", path.name)]


def _read_points(path: Path) -> Array | None:
    """Return the points of a text; None if it is no list of points."""
    try:
        return _parse_points(read_text(path, _MAX_LENGTH, "a list of points"))
    except CalibrationError:
        return None


def _parse_points(text: str) -> Array | None:
    """Return points (n, 2); None if the text is no list of pairs of finite numbers."""
    try:
        numbers = np.array([parse_number(word) for word in text.split()])
    except ValueError:
        return None
    if not len(numbers) or len(numbers) % 2 or not np.isfinite(numbers).all():
        return None
    return numbers.reshape(-1, 2)


def read_opencv_corners(source: CornerText) -> CornerSet:
    """Read the corners of OpenCV's calibration sample.

    Raises:
        CalibrationError: if something is missing or wrong.
    """
    content = parse_storage(source.text, source.file)
    sides = [content[key].number() for key in ("board_height", "board_width")]
    grid_size = Node(sides, "the board's height and width", source.file).grid_size()
    points, count = content["image_points"], math.prod(grid_size)
    uv = points["data"].numbers(points["rows"].integer() * count * 2).reshape(-1, count, 2)
    sides = [content[key].number() for key in ("image_width", "image_height")]
    size = Node(sides, "the images' width and height", source.file).image_size()
    board = make_board(grid_size)
    places = np.argwhere(np.ones(grid_size, bool))
    views = tuple(make_view(f"photograph {k}", board, places, each) for k, each in enumerate(uv, 1))
    corner_set = CornerSet(size, views, board, lengths_confirmed=False)
    source.check_stated(corner_set)
    return corner_set

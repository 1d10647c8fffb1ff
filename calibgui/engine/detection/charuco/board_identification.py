"""Reading the board that a ChArUco pattern states in an image, and telling what is there instead.

Only markers that agree with what is stated of dictionary, layout, size and markers' side are
accepted, in the image or in its negative; where the size is stated, also those of a board that
begins with another number than 0. What is there instead is looked for among all dictionaries, which
takes as long once more: only after all else has failed.
"""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np

from calibgui.engine.arrays import Array, GreyImage, GridSize
from calibgui.engine.boards.charuco import (
    MARKER_LAYOUTS,
    Charuco,
    MarkerLayout,
    dictionary_family,
)
from calibgui.engine.detection.charuco.first_marker_number import (
    find_first_marker_number,
    list_shifted_layouts,
)
from calibgui.engine.detection.charuco.marker_reader import MarkerReader, ReadBoard
from calibgui.engine.detection.charuco.markers import Markers
from calibgui.engine.detection.charuco.thresholds import CHARUCO_THRESHOLDS
from calibgui.engine.detection.detector_io import convert_for_reading, invert_levels
from calibgui.engine.errors import MirroredError, NoBoardError, UnknownPartError


def open_readers(
    grey: GreyImage, outline: Array | None, pattern: Charuco, grid_size: GridSize | None
) -> list[MarkerReader]:
    """Return readers of the markers in an image and in its negative, which remember them.

    Of a board whose first marker is stated they read no others.
    """
    numbers = None
    if pattern.first_marker is not None:
        last = sys.maxsize if grid_size is None else pattern.number_markers(grid_size).stop
        numbers = range(pattern.first_marker, last)
    image = convert_for_reading(grey)
    positive = MarkerReader(image, outline, numbers=numbers)
    return [positive, MarkerReader(invert_levels(image), outline, positive, numbers)]


def read_board(
    pattern: Charuco, readers: list[MarkerReader], grid_size: GridSize | None
) -> tuple[ReadBoard, bool] | None:
    """Read the dictionary and the board's markers in an image and its negative.

    Only what agrees with the statements in `pattern` and `grid_size` is accepted.

    Returns:
        The board, and whether it is printed bright on dark; None if there is no such board:
        `explain_missing_board` names the one that is there instead.

    Raises:
        NoBoardError: if the markers contradict what is stated of their side or of the size.
    """
    read = read_markers(pattern, readers, grid_size, CHARUCO_THRESHOLDS.min_markers)
    is_open = grid_size is not None and pattern.first_marker is None
    if grid_size and is_open and (read is None or count_rows(read[0].readings[0]) > grid_size[0]):
        read = _read_numbered_board(pattern, readers, grid_size) or read
    if read is None:
        return None
    if (contradiction := contradict(read[0].readings[0], pattern, grid_size)) is not None:
        raise contradiction
    return read


def read_markers(
    pattern: Charuco, readers: list[MarkerReader], grid_size: GridSize | None, least: int
) -> tuple[ReadBoard, bool] | None:
    """Read the markers of a board on which at least so many agree, and tell whether it is printed
    bright on dark; None if there is no such board."""
    layouts = list_layouts(pattern, grid_size)
    count = None if grid_size is None else pattern.number_markers(grid_size).stop
    for is_inverted, reader in enumerate(readers):
        read = (
            reader.read_dictionary(pattern.dictionary, layouts, count, least)
            if pattern.dictionary
            else reader.search_dictionaries(layouts, count, least)
        )
        if read is not None:
            return read, bool(is_inverted)
    return None


def _read_numbered_board(
    pattern: Charuco, readers: list[MarkerReader], grid_size: GridSize
) -> tuple[ReadBoard, bool] | None:
    """Read the markers of a board of stated size that begins with another number than 0; returns as
    `read_markers`."""
    shifted = list_shifted_layouts(grid_size[1] + 1)
    for is_inverted, reader in enumerate(readers):
        read = (
            reader.read_dictionary(pattern.dictionary, [*MARKER_LAYOUTS, *shifted])
            if pattern.dictionary
            else reader.search_dictionaries([*MARKER_LAYOUTS, *shifted])
        )
        if read is None or read.readings[0].layout.cols != grid_size[1] + 1:
            continue
        layouts = list_layouts(pattern, grid_size)
        numbered = find_first_marker_number(read.readings[0], layouts, grid_size)
        if numbered is not None:
            return ReadBoard(read.dictionary, [numbered]), bool(is_inverted)
    return None


def contradict(
    markers: Markers[MarkerLayout], pattern: Charuco, grid_size: GridSize | None
) -> NoBoardError | None:
    """Return the error that says in what the markers read do not agree with what is stated."""
    if (
        pattern.marker is not None
        and abs(markers.side - pattern.marker) > CHARUCO_THRESHOLDS.max_side_difference
    ):
        return NoBoardError(
            f"The markers are {markers.side:.2f} of a square, not {pattern.marker:.2f}.",
            "State the sides of marker and square as measured, or leave the marker's out.",
        )
    if grid_size is not None and count_rows(markers) > grid_size[0]:
        return _explain_other_size(markers, grid_size)
    return None


def count_rows(markers: Markers[MarkerLayout]) -> int:
    """Return the least number of rows of inner corners of a board with these markers."""
    return int(markers.squares[:, 0].max())


def list_layouts(pattern: Charuco, grid_size: GridSize | None) -> list[MarkerLayout]:
    """List the layouts that agree with what is stated."""
    first = pattern.first_marker or 0
    if grid_size is None:
        return [
            replace(layout, first=first)
            for layout in MARKER_LAYOUTS
            if layout.first_dark or pattern.legacy is not False
        ]
    if pattern.legacy is not None:
        return [MarkerLayout(grid_size[1] + 1, pattern.is_first_square_dark(grid_size), first)]
    both = (True, False) if (grid_size[0] + 1) % 2 == 0 else (True,)
    return [MarkerLayout(grid_size[1] + 1, dark, first) for dark in both]


def explain_missing_board(
    pattern: Charuco, readers: list[MarkerReader], grid_size: GridSize | None
) -> NoBoardError:
    """Return the error that says what the image shows instead of the stated board."""
    read = None
    is_anything_stated = pattern != Charuco() or grid_size is not None
    for reader in readers if is_anything_stated else ():
        if pattern.dictionary:
            read = read or reader.read_dictionary(pattern.dictionary, MARKER_LAYOUTS)
        read = read or reader.search_dictionaries(MARKER_LAYOUTS, must_agree=True)
    if read is None and any(reader.is_undecided for reader in readers):
        return UnknownPartError(
            "The markers seen do not tell how many squares the board has in a row.",
            "State its rows and columns, or show more of it.",
        )
    if read is None and any(reader.is_mirrored(pattern.dictionary) for reader in readers):
        return MirroredError()
    if read is None:
        return NoBoardError(
            "No ChArUco board was found.",
            "Take the picture again: sharp, evenly lit and near enough for its markers to be read;"
            " state dictionary and size, or leave them out.",
        )
    dictionary, markers = read.dictionary, read.readings[0]
    if pattern.dictionary and dictionary_family(dictionary) != dictionary_family(
        pattern.dictionary
    ):
        return NoBoardError(
            f"The markers are of {dictionary}, not of {pattern.dictionary}.",
            "State that dictionary, or leave it out.",
        )
    rows = count_rows(markers)
    if grid_size is not None and (markers.layout.cols - 1 != grid_size[1] or rows > grid_size[0]):
        return _explain_other_size(markers, grid_size)
    return NoBoardError(
        "The first square of this board is "
        + ("dark." if markers.layout.first_dark else "white, as before OpenCV 4.6."),
        "State the other layout, or leave it out.",
    )


def _explain_other_size(markers: Markers[MarkerLayout], stated: GridSize) -> NoBoardError:
    """Return the error that says which size was found instead of the stated one, or that the
    markers are those of a board of that size that does not begin with number 0."""
    rows, cols = count_rows(markers), markers.layout.cols - 1
    last = (stated[0] + 1) * (stated[1] + 1) // 2 - 1
    low, high = int(markers.numbers.min()), int(markers.numbers.max())
    are_of_later_board = cols == stated[1] and np.ptp(markers.squares[:, 0]) <= stated[0]
    if are_of_later_board and low > 0 and high > last:
        return NoBoardError(
            f"The markers read are numbers {low} to {high}; a board of {stated[0]} x {stated[1]} "
            f"inner corners has 0 to {last}, so that this one is numbered from another.",
            "Show it from its first row to its last, or leave the size out: its rows are then "
            "counted as if the numbers began with 0.",
        )
    return NoBoardError(
        f"This board has at least {rows} rows and exactly {cols} columns of inner corners, "
        f"not {stated[0]} x {stated[1]}.",
        "State the number of inner corners, rows x columns, or leave it out.",
    )

"""Corners as comma-separated values, one row a corner, for spreadsheets and statistics.

    image,row,col,u_px,v_px,x_mm,y_mm[,cov_uu,cov_uv,cov_vv]

Reader: any reader of CSV, and `read_corners_csv`. Positions are pixels in the array frame
(0-based, integer at pixel centres, v down) and millimetres on the board, covariances px^2.
`row` and `col` are empty for corners whose place on a board of known layout is not known.

Tables of other programs are read with the image, u and v, and the place on the board: row and
column, counted from 0, or X and Y in mm, or in m where the columns are called x_m and y_m.
Cannot hold: the images' size, the board's, images without corners, first estimates.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from calibgui.dataset import CornerSet, Result, View, ViewStatus
from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.boards import Board
from calibgui.engine.calibration import Observation
from calibgui.engine.camera import MODELS
from calibgui.engine.files import write_atomically
from calibgui.formats.corner_table import CornerText, make_board, make_view
from calibgui.formats.corners_json import HINT, NOTE
from calibgui.formats.csv_table import format_csv, parse_cell, parse_csv
from calibgui.formats.exporter import Exporter, ExportReport, describe_condition
from calibgui.formats.image_names import shorten_names
from calibgui.formats.node import MAX_LINES, Node

_POINT_COLUMNS = ("u_px", "v_px", "x_mm", "y_mm")
_COVARIANCE_COLUMNS = ("cov_uu", "cov_uv", "cov_vv")
_COLUMNS = ("image", "row", "col", *_POINT_COLUMNS)
_IMAGE_NAMES = ("image", "filename", "file", "name", "view")
_PIXEL_NAMES = (("u_px", "v_px"), ("u", "v"), ("x_px", "y_px"), ("x", "y"))
_GRID_NAMES = (("row", "col"), ("row", "column"))
_BOARD_NAMES = {
    ("x_mm", "y_mm"): 1.0,
    ("X_mm", "Y_mm"): 1.0,
    ("X", "Y"): 1.0,
    ("x_m", "y_m"): 1000.0,
    ("X_m", "Y_m"): 1000.0,
    ("x", "y"): 1.0,
}
"""Columns of places on the board, in the order in which they are looked for, and their unit, mm."""
SIGNATURE = re.compile(rf"\A\ufeff?[^\n{{]*\b({'|'.join(_IMAGE_NAMES)})\b[^\n{{]*,")
"""The first line of a table of corners, which names the columns."""
_ROUNDING = 1e-6
"""Largest difference of a place from that of its row and column, over the side of a square."""


def write_corners_csv(
    views: Sequence[View], board: Board | None, path: str | os.PathLike[str]
) -> None:
    """Write the corners of all views that have corners.

    Images at absolute paths are named from the innermost folder that holds them all: what stands
    above it differs between computers.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    found = [view for view in views if view.status is ViewStatus.FOUND]
    weighted = any(view.observation(board).cov is not None for view in found)
    rows: list[Sequence[object]] = [_COLUMNS + _COVARIANCE_COLUMNS if weighted else _COLUMNS]
    names = shorten_names([view.image for view in found])
    for view, name in zip(found, names, strict=True):
        rows += _make_rows(view, name, view.observation(board))
    # A file name that is not valid Unicode is written so that every reader takes it.
    write_atomically(path, format_csv(rows).encode(errors="backslashreplace"))


def _make_rows(view: View, image: str, points: Observation) -> Iterator[list[str | int | float]]:
    for i in range(len(points.uv)):
        place = ["", ""] if view.corners is None else view.corners.grid[i].tolist()
        row = [image, *place, *points.uv[i].tolist(), *points.xy[i].tolist()]
        if points.cov is not None:
            row += points.cov[i][[0, 0, 1], [0, 1, 1]].tolist()
        yield row


def read_corners_csv(source: CornerText) -> CornerSet:
    """Read the corners of a table.

    Raises:
        CalibrationError: if a column is missing or a cell no number, a place is none of a board or
            taken twice, or the images' size is not known.
    """
    rows = parse_csv(source.text, source.file)
    names = rows[0][1].keys() if rows else ()
    image = next((name for name in _IMAGE_NAMES if name in names), "")
    pixels = next((pair for pair in _PIXEL_NAMES if set(pair) <= set(names)), None)
    places = next(
        (pair for pair in _BOARD_NAMES if set(pair) <= set(names) and pair != pixels), None
    )
    cells = next((pair for pair in _GRID_NAMES if set(pair) <= set(names)), None)
    if not image or pixels is None or (places is None and cells is None):
        source.fail("is no table of corners.", HINT)
    if cells and any(not row[name] for _, row in rows for name in cells):
        cells = None if places else cells  # corners of no known layout beside others
    weighted = set(_COVARIANCE_COLUMNS) <= set(names)
    used = [*pixels, *(cells or ()), *(places or ()), *(_COVARIANCE_COLUMNS if weighted else ())]
    numbers = np.array(
        [[parse_cell(source.file, n, row, name) for name in used] for n, row in rows]
    )
    columns = dict(zip(used, numbers.T, strict=True))
    uv = np.column_stack([columns[name] for name in pixels])
    grid = _take_places(source, columns, cells) if cells else None
    xy = None
    if places:
        xy = _BOARD_NAMES[places] * np.column_stack([columns[name] for name in places])
    board = _find_board(source, grid, xy)
    if board is None and source.grid_size is not None:
        source.fail("gives the corners' places in mm, not by rows.", "Leave --board out.")
    cov = None
    if weighted:
        cov = np.stack([columns[name] for name in np.take(_COVARIANCE_COLUMNS, [0, 1, 1, 2])], -1)
        cov = Node(cov.reshape(-1, 2, 2), "cov", source.file).covariances(len(cov), 2, 2)
    of: dict[str, list[int]] = {}
    for k, (_, row) in enumerate(rows):
        of.setdefault(row[image] or "", []).append(k)
    views = []
    for name, each in of.items():
        weights = None if cov is None else cov[each]
        if board is not None and grid is not None:
            if len(np.unique(grid[each], axis=0)) < len(each):
                source.fail(f"has two corners in one place of {name[:100]}.", "Correct the table.")
            views.append(make_view(name, board, grid[each], uv[each], weights))
        elif xy is not None:
            points = Observation(uv[each], xy[each], weights)
            views.append(View(name, ViewStatus.FOUND, points=points))
    return CornerSet(source.find_size(of), tuple(views), board, lengths_confirmed=xy is not None)


def _take_places(
    source: CornerText, columns: Mapping[str, Array], cells: tuple[str, str]
) -> IntArray:
    """Return rows and columns (n, 2) on the board, counted from 0."""
    grid = np.column_stack([columns[name] for name in cells])
    limits = source.grid_size or (MAX_LINES, MAX_LINES)
    if (grid != np.rint(grid)).any() or (grid < 0).any() or (grid >= limits).any():
        source.fail(
            f"has a row or column that is no whole number from 0 to below {max(limits)}.",
            "Rows and columns of the board are counted from 0.",
        )
    return grid.astype(np.int64)


def _find_board(source: CornerText, grid: IntArray | None, xy: Array | None) -> Board | None:
    """Return the board of squares that rows and columns lie on; None where there are none, or the
    stated places are not those of squares."""
    if grid is None:
        return None
    size = source.grid_size or tuple((grid.max(axis=0) + 1).tolist())
    if xy is None:
        return make_board((size[0], size[1]))
    steps = float(np.sum(grid.astype(float) ** 2))
    square = float(np.sum(grid[:, ::-1] * xy)) / steps if steps else 0.0
    if not square > 0 or np.abs(square * grid[:, ::-1] - xy).max() > _ROUNDING * square:
        return None
    return Board(size[0], size[1], float(f"{square:.12g}"))


def _export(result: Result, path: Path) -> ExportReport:
    write_corners_csv(result.views, result.board, path)
    return ExportReport(path, f"{NOTE} {describe_condition(result)}".rstrip())


EXPORTER = Exporter(
    name="corners-csv",
    title="Corners as CSV",
    suffixes=(".csv",),
    models=tuple(MODELS),
    readers="spreadsheets, any reader of CSV",
    keeps="the corners and their places on the board",
    loses="the calibration, photographs without corners",
    write=_export,
    partial=True,
    needs_corners=True,
)

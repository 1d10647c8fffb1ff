"""Corners as comma-separated values, one row a corner, for spreadsheets and statistics.

    image,row,col,u_px,v_px,x_mm,y_mm[,cov_uu,cov_uv,cov_vv]

Reader: any reader of CSV. Positions are pixels in the array frame
(0-based, integer at pixel centres, v down) and millimetres on the board, covariances px^2.
`row` and `col` are empty for corners whose place on a board of known layout is not known.
Cannot hold: the images' size, the board's, images without corners, first estimates.
"""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Iterator, Sequence
from pathlib import Path, PurePath

from calibgui.dataset import Result, View, ViewStatus
from calibgui.engine.boards import Board
from calibgui.engine.calibration import Observation
from calibgui.engine.camera import MODELS
from calibgui.engine.files import write_atomically
from calibgui.formats.exporter import Exporter, ExportReport, describe_condition

_POINT_COLUMNS = ("u_px", "v_px", "x_mm", "y_mm")
_COVARIANCE_COLUMNS = ("cov_uu", "cov_uv", "cov_vv")
_COLUMNS = ("image", "row", "col", *_POINT_COLUMNS)


def write_corners_csv(
    views: Sequence[View], board: Board | None, path: str | os.PathLike[str]
) -> None:
    """Write the corners of all views that have corners.

    Images at absolute paths are named from the innermost folder that holds them all: what stands
    above it differs between computers.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    found = [view for view in views if view.status is ViewStatus.FOUND]
    weighted = any(view.observation(board).cov is not None for view in found)
    writer.writerow(_COLUMNS + _COVARIANCE_COLUMNS if weighted else _COLUMNS)
    names = _shorten_names([view.image for view in found])
    for view, name in zip(found, names, strict=True):
        writer.writerows(_make_rows(view, name, view.observation(board)))
    # A file name that is not valid Unicode is written so that every reader takes it.
    write_atomically(path, text.getvalue().encode(errors="backslashreplace"))


def _make_rows(view: View, image: str, points: Observation) -> Iterator[list[str | int | float]]:
    for i in range(len(points.uv)):
        place = ["", ""] if view.corners is None else view.corners.grid[i].tolist()
        row = [image, *place, *points.uv[i].tolist(), *points.xy[i].tolist()]
        if points.cov is not None:
            row += points.cov[i][[0, 0, 1], [0, 1, 1]].tolist()
        yield row


def _shorten_names(images: Sequence[str]) -> list[str]:
    """Return absolute paths from the innermost folder that holds them all, others as they are."""
    paths = [PurePath(image) for image in images]
    if not paths or not all(path.is_absolute() for path in paths):
        return list(images)
    try:
        folder = os.path.commonpath([path.parent for path in paths])
    except ValueError:  # on several drives
        return list(images)
    return [path.relative_to(folder).as_posix() for path in paths]


def _export(result: Result, path: Path) -> ExportReport:
    write_corners_csv(result.views, result.board, path)
    return ExportReport(path, f"{EXPORTER.limits} {describe_condition(result)}".rstrip())


EXPORTER = Exporter(
    name="corners-csv",
    title="Corners as CSV",
    suffixes=(".csv",),
    models=tuple(MODELS),
    limits="Corners and their places on the board; no calibration, no images without corners.",
    write=_export,
    partial=True,
    needs_corners=True,
)

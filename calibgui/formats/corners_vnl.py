"""corners.vnl: the corners of a board as mrgingham writes them and mrcal takes them.

    # filename x y level
    frame00.jpg 101.5 80.2 0
    frame01.jpg - - -

Reader: mrcal-calibrate-cameras, mrgingham's tools, and `read_corners_vnl`. A row is a corner in
pixels of the array frame, and the rows of an image are the board's corners row by row. The board's
rows and columns are not in the file. A corner at "-", at two negative places, or of a negative
level or no weight was not found; neither was a board of which the only row is such. A corner of
level L has 2^L times the noise of one of level 0; a `weight` in place of the level divides the
noise. Levels are written, as mrcal takes the last column for one whatever its legend says: 0 for
corners as exact as the median one or more so.
Cannot hold: the images' size, the board's rows, columns and squares, blanks in names, covariances.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from calibgui.dataset import CornerSet, Result, View
from calibgui.engine.arrays import Array, GridSize, IntArray
from calibgui.engine.camera import MODELS
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically
from calibgui.formats.corner_table import CornerText, make_board, make_view, scale_unit
from calibgui.formats.exporter import Exporter, ExportReport, describe_condition
from calibgui.formats.gate import parse_number
from calibgui.formats.image_names import shorten_names
from calibgui.formats.origin import make_mark

SIGNATURE = re.compile(r"^[ \t]*#[ \t]*filename[ \t]+x[ \t]+y\b", re.MULTILINE)
"""The legend of the columns."""
_NOISE_PX = 0.1
"""Standard deviation of corners of level 0 or weight 1, px: a lower bound, as the solver puts what
is beyond it down to the model, alike for all corners."""


def write_corners_vnl(result: Result, path: Path) -> ExportReport:
    """Write the corners of all photographs on which a board was found or looked for.

    Raises:
        CalibrationError: if corners came without rows and columns, or the file cannot be written.
    """
    views = [view for view in result.views if view.points is None]
    if result.board is None or not views:
        raise CalibrationError(
            f"{path} is not written: the corners have no rows and columns on a board.",
            "Export them as corners-csv.",
        )
    rows, cols = result.board.grid_size
    sigmas = [_measure_sigmas(view) for view in views]
    typical = float(np.median(np.concatenate(sigmas)))
    lines = [f"# {make_mark(EXPORTER.name)} {describe_condition(result)}".rstrip()]
    lines += [f"# {cols} columns, {rows} rows", "# filename x y level"]
    names = shorten_names([view.image for view in views])
    for view, name, sigma in zip(views, names, sigmas, strict=True):
        word = _spell(name)
        levels = np.maximum(np.rint(np.log2(sigma / typical)), 0).astype(int)
        lines += _list_rows(word, view, (rows, cols), levels)
    write_atomically(path, ("\n".join(lines) + "\n").encode())
    note = f"Corners, for mrcal-calibrate-cameras --object-width-n {cols} --object-height-n {rows}."
    if any(_spell(name) != name for name in names):
        note = f"{note} Blanks in names of images are written as _, and other letters by codes."
    return ExportReport(path, f"{note} {describe_condition(result)}".rstrip())


def _spell(name: str) -> str:
    """Return the name of an image as mrcal reads it: in ASCII without blanks."""
    return re.sub(r"[\s#]", "_", name).encode("ascii", "backslashreplace").decode()


def _measure_sigmas(view: View) -> Array:
    """Return the standard deviation (n,) of a view's corners, px; 1 where it is not known."""
    if view.corners is None:
        return np.empty(0)
    if view.corners.cov is None:
        return np.ones(len(view.corners.uv))
    return np.asarray(np.sqrt(np.trace(view.corners.cov, axis1=-2, axis2=-1) / 2))


def _list_rows(name: str, view: View, grid_size: GridSize, levels: IntArray) -> list[str]:
    """Return the lines of a photograph: one for each place on the board, or one for none."""
    if view.corners is None:
        return [f"{name} - - -"]
    lines = np.full(grid_size, f"{name} - - -", dtype=object)
    for (row, col), (u, v), level in zip(
        view.corners.grid.tolist(), view.corners.uv.tolist(), levels.tolist(), strict=True
    ):
        lines[row, col] = f"{name} {u!r} {v!r} {level}"
    return [str(line) for line in lines.ravel()]


def read_corners_vnl(source: CornerText) -> CornerSet:
    """Read the corners, whose weights count where they differ.

    Raises:
        CalibrationError: if a row is none of a corner, the board's size is not stated or not that
            of the file, or the images' size is not known.
    """
    legend = SIGNATURE.search(source.text)
    line = source.text[legend.start() :].partition("\n")[0] if legend else ""
    is_weight = "weight" in line.split()
    rows: dict[str, list[tuple[float, float, float]]] = {}
    for number, text in enumerate(source.text.splitlines(), 1):
        words = text.partition("#")[0].split()
        if words:
            rows.setdefault(words[0], []).append(_read_row(source, number, words[1:], is_weight))
    if not rows:
        source.fail("holds no corners.", "Write it again.")
    tables = {image: np.array(each) for image, each in rows.items()}
    grid_size = _check_count(source, tables)
    sigmas = np.concatenate([table[:, 2] for table in tables.values()])
    is_uneven = len(np.unique(sigmas[np.isfinite(sigmas)])) > 1
    views = tuple(_make_view(image, table, grid_size, is_uneven) for image, table in tables.items())
    return CornerSet(
        source.find_size(tables), views, make_board(grid_size), lengths_confirmed=False
    )


def _read_row(
    source: CornerText, number: int, words: list[str], is_weight: bool
) -> tuple[float, float, float]:
    """Return column, row and relative noise of a corner; NaN where it was not found."""
    try:
        values = [np.nan if word == "-" else parse_number(word) for word in words]
        u, v, rank = [*values, 1.0 if is_weight else 0.0][:3]
    except ValueError as error:
        source.fail(
            f"has no corner in line {number}: {error}.",
            "A row is a name, x, y and perhaps a level.",
        )
    is_found = np.isfinite([u, v, rank]).all() and not (u < 0 and v < 0)
    is_found &= rank > 0 if is_weight else 0 <= rank < np.inf
    if not is_found:
        return np.nan, np.nan, np.nan
    return u, v, 1 / rank if is_weight else 2.0 ** min(rank, 100.0)


def _check_count(source: CornerText, tables: dict[str, Array]) -> GridSize:
    """Return the stated rows and columns, which every image has that has any."""
    counts = {image: len(table) for image, table in tables.items() if len(table) > 1}
    image, count = next(iter(counts.items()), ("", 0))
    if source.grid_size is None:
        sizes = [f"{n}x{count // n}" for n in range(3, count // 3 + 1) if count % n == 0]
        listed = f" {', '.join(sizes)} have its {count} corners." if sizes else ""
        source.fail(
            "does not say how many rows and columns the board has.",
            f"State them, as --board ROWSxCOLS.{listed}",
        )
    rows, cols = source.grid_size
    for image, count in counts.items():
        if count != rows * cols:
            source.fail(
                f"has {count} rows for {image[:100]}; a board of {rows} x {cols} has "
                f"{rows * cols}.",
                "State the board's rows and columns of inner corners, as --board ROWSxCOLS.",
            )
    return rows, cols


def _make_view(image: str, table: Array, grid_size: GridSize, is_uneven: bool) -> View:
    """Return the view of an image from the rows (n, 3) of `_read_row`."""
    places = np.argwhere(np.ones(grid_size, bool))[: len(table)]
    found = np.isfinite(table[:, 0])
    cov = scale_unit((_NOISE_PX * table[found, 2]) ** 2) if is_uneven else None
    return make_view(image, make_board(grid_size), places[found], table[found, :2], cov)


EXPORTER = Exporter(
    name="corners-vnl",
    title="Corners for mrcal",
    suffixes=(".vnl",),
    models=tuple(MODELS),
    readers="mrcal, mrgingham's tools",
    keeps="the corners, and how exactly they were found, in powers of two",
    loses="the calibration, the board's rows, columns and squares, the images' size",
    write=write_corners_vnl,
    partial=True,
    needs_corners=True,
)

"""Pixels of points in the cameras of a rig, and the points in space that answer them, as CSV.

Read: a table whose first line names the columns point, camera, u and v (or u_px and v_px): a row
for each point that a camera sees, px, the camera by its name in the rig. Written:

    point,cameras,x_mm,y_mm,z_mm,sigma_x_mm,sigma_y_mm,sigma_z_mm,rms_px,reason

in the rig's frame; `rms_px` is that of the point's residuals. A point that fewer than two cameras
see has the reason and empty cells.

Reader: any reader of CSV. Cannot hold: correlations.
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from calibgui.dataset import RigResult
from calibgui.engine.arrays import Array
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically
from calibgui.engine.rig import TriangulatedPoints
from calibgui.formats.csv_table import format_csv, parse_cell, read_numbered_csv_rows

_PIXEL_COLUMNS = (("u_px", "v_px"), ("u", "v"))
_LACK = "fewer than two cameras see it"


def read_seen_points(
    path: str | os.PathLike[str], result: RigResult
) -> tuple[tuple[str, ...], Mapping[int, Array]]:
    """Read the pixels of points.

    Returns:
        The names of the points, and the pixels (n, 2) of all points in each camera that the table
        names, NaN where it does not see one.

    Raises:
        CalibrationError: if the file cannot be read, lacks a column, names a camera that the rig
            has not, or a point twice in one camera, or a cell is no number.
    """
    rows = read_numbered_csv_rows(Path(path))
    names = rows[0][1].keys() if rows else ()
    pair = next((pair for pair in _PIXEL_COLUMNS if set(pair) <= set(names)), None)
    if pair is None or not {"point", "camera"} <= set(names):
        raise CalibrationError(
            f"{path} is no table of points in cameras: it has no columns point, camera, u and v.",
            "Let its first line be point,camera,u,v and each further line as P1,left,320.5,240.",
        )
    points = tuple(dict.fromkeys(row["point"] for _, row in rows))
    pixels: dict[int, Array] = {}
    for line, row in rows:
        if row["camera"] not in result.rig.names:
            raise CalibrationError(
                f"{path}, line {line}: the rig has no camera {row['camera']!r}.",
                f"Its cameras are {', '.join(result.rig.names)}.",
            )
        c, k = result.rig.names.index(row["camera"]), points.index(row["point"])
        seen = pixels.setdefault(c, np.full((len(points), 2), np.nan))
        if np.isfinite(seen[k]).any():
            raise CalibrationError(
                f"{path}, line {line}: {row['camera']} sees {row['point']} twice.",
                "Give each point one name, and one row for each camera.",
            )
        seen[k] = [parse_cell(path, line, row, name) for name in pair]
    return points, pixels


def write_space_points(
    names: Sequence[str],
    pixels: Mapping[int, Array],
    found: TriangulatedPoints,
    path: str | os.PathLike[str],
) -> None:
    """Write points in space, with one standard deviation.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    axes = ("x", "y", "z")
    head = ["point", "cameras", *(f"{a}_mm" for a in axes), *(f"sigma_{a}_mm" for a in axes)]
    rows: list[Sequence[object]] = [[*head, "rms_px", "reason"]]
    cameras = np.sum([np.isfinite(uv).all(axis=1) for uv in pixels.values()], axis=0).tolist()
    table = np.column_stack([found.points, found.sigma, found.rms]).tolist()
    for name, count, numbers in zip(names, cameras, table, strict=True):
        cells = [number if math.isfinite(number) else "" for number in numbers]
        rows.append([name, count, *cells, "" if math.isfinite(numbers[0]) else _LACK])
    write_atomically(path, format_csv(rows).encode(errors="backslashreplace"))

"""Pixels as comma-separated values, and the rays and points of the world that answer them.

Read: a table whose first line names the columns, two of them u and v, or u_px and v_px, or x and y,
and perhaps sigma_px, the standard deviation of each pixel along both axes. Written:

    u_px,v_px,ray_x,ray_y,ray_z,sigma_deg,x_mm,y_mm,sigma_x_mm,sigma_y_mm,reason,...

Rays have the length 1, X to the right, Y down, Z ahead; x_mm and y_mm are places on the plane, only
where there is one. A pixel that has no ray or point has the reason and empty cells. The other
columns of the table that was read follow as they were.

Reader: any reader of CSV. Cannot hold: correlations.
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from calibgui.engine.arrays import Array, freeze
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically
from calibgui.engine.uncertainty import BoardPoints, PixelRays
from calibgui.formats.csv_table import format_csv, parse_cell, read_numbered_csv_rows

_PIXEL_COLUMNS = (("u_px", "v_px"), ("u", "v"), ("x", "y"))
_SIGMA_COLUMN = "sigma_px"


@dataclass(frozen=True, eq=False, slots=True)
class PixelTable:
    """Pixels that were read from a table."""

    uv: Array
    """(n, 2) px."""
    sigma: Array | None
    """(n,) standard deviations along each axis, px; None if the table does not state them."""
    others: tuple[Mapping[str, str], ...]
    """The other cells of each row, by column."""

    def __post_init__(self) -> None:
        freeze(self, "uv", "sigma")


def read_points(path: str | os.PathLike[str]) -> PixelTable:
    """Read a table of pixels.

    Raises:
        CalibrationError: if the file cannot be read, lacks the columns, or a cell is no number.
    """
    rows = read_numbered_csv_rows(Path(path))
    names = rows[0][1].keys() if rows else ()
    pair = next((pair for pair in _PIXEL_COLUMNS if set(pair) <= set(names)), None)
    if pair is None:
        raise CalibrationError(
            f"{path} is no table of pixels: it has no columns u and v below their names.",
            "Let its first line be u,v and each further line a pixel, as 320.5,240.",
        )
    used = [*pair, *([_SIGMA_COLUMN] if _SIGMA_COLUMN in names else [])]
    values = np.array([[parse_cell(path, line, row, name) for name in used] for line, row in rows])
    if values.shape[1] > 2 and (values[:, 2] < 0).any():
        line = rows[int(np.argmax(values[:, 2] < 0))][0]
        raise CalibrationError(
            f"{path}, line {line}: {_SIGMA_COLUMN} is below 0.", "Correct the table."
        )
    return PixelTable(
        values[:, :2],
        values[:, 2] if values.shape[1] > 2 else None,
        tuple({k: v or "" for k, v in row.items() if k and k not in used} for _, row in rows),
    )


def write_rays(
    table: PixelTable,
    rays: PixelRays,
    on_plane: BoardPoints | None,
    reasons: Sequence[str],
    path: str | os.PathLike[str],
) -> None:
    """Write the rays of pixels, their places on a plane where there is one, and why one has none.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    head = ["u_px", "v_px", "ray_x", "ray_y", "ray_z", "sigma_deg"]
    columns = [*table.uv.T, *rays.rays.T, np.degrees(rays.sigma)]
    if on_plane is not None:
        head += ["x_mm", "y_mm", "sigma_x_mm", "sigma_y_mm"]
        variances = np.diagonal(on_plane.covariance, axis1=1, axis2=2)
        columns += [*on_plane.points.T, *np.sqrt(variances).T]
    others = list(dict.fromkeys(name for row in table.others for name in row))
    rows: list[Sequence[object]] = [[*head, "reason", *others]]
    for numbers, reason, other in zip(
        np.column_stack(columns).tolist(), reasons, table.others, strict=True
    ):
        cells = [number if math.isfinite(number) else "" for number in numbers]
        rows.append([*cells, reason, *(other.get(name, "") for name in others)])
    write_atomically(path, format_csv(rows).encode(errors="backslashreplace"))

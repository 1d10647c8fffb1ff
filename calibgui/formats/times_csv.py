"""Times of the photographs of a rig, as CSV.

Read: a table whose first line names the columns camera, number and time_s: the camera by its name,
the number of its photograph or frame, and when it was taken by that camera's clock, s.

Reader: any reader of CSV.
"""

from __future__ import annotations

import os
from collections.abc import Collection
from pathlib import Path

from calibgui.engine.errors import CalibrationError
from calibgui.formats.csv_table import parse_cell, read_numbered_csv_rows


def read_times(
    path: str | os.PathLike[str], cameras: Collection[str]
) -> dict[str, dict[int, float]]:
    """Read the times of photographs by camera and number.

    Raises:
        CalibrationError: if the file cannot be read or lacks a column, a cell is no number, or a
            camera has another name than `cameras`, or no times.
    """
    rows = read_numbered_csv_rows(Path(path))
    if not rows or not {"camera", "number", "time_s"} <= rows[0][1].keys():
        raise CalibrationError(
            f"{path} is no table of times: it has no columns camera, number and time_s.",
            "Let its first line be camera,number,time_s and each further line as left,12,0.4.",
        )
    times: dict[str, dict[int, float]] = {name: {} for name in cameras}
    for line, row in rows:
        if row["camera"] not in times:
            raise CalibrationError(
                f"{path}, line {line}: there is no camera {row['camera']!r}.",
                f"The cameras are {', '.join(sorted(cameras))}.",
            )
        number = parse_cell(path, line, row, "number")
        times[row["camera"]][int(number)] = parse_cell(path, line, row, "time_s")
    for name, own in times.items():
        if not own:
            raise CalibrationError(f"{path} has no times of {name}.", "Add them.")
    return times

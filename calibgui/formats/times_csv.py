"""Times of the photographs of a rig, as CSV.

Read: a table whose first line names time_s, when a photograph was taken by its camera's clock, s,
and either file, its name with as many folders as tell it apart, or camera and number: the camera by
its name, and the last number in the photograph's name, or the frame's.

Reader: any reader of CSV.
"""

from __future__ import annotations

import os
import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path, PurePosixPath

from calibgui.engine.errors import CalibrationError
from calibgui.formats.csv_table import parse_cell, read_numbered_csv_rows


def read_times(
    path: str | os.PathLike[str], groups: Mapping[str, Sequence[Path]]
) -> dict[str, dict[Path, float]]:
    """Read the times of photographs, s, by the names of their cameras.

    Args:
        path: the table.
        groups: the photographs of each camera, by its name. Rows on others are left out.

    Raises:
        CalibrationError: if the file cannot be read or lacks a column, a cell is no number, a name
            means photographs of two cameras, or a camera has another name or no times.
    """
    rows = read_numbered_csv_rows(Path(path))
    head = rows[0][1].keys() if rows else set()
    if not ({"file", "time_s"} <= head or {"camera", "number", "time_s"} <= head):
        raise CalibrationError(
            f"{path} is no table of times: it has no columns file and time_s, or camera, number "
            "and time_s.",
            "Let its first line be file,time_s and each further line as left/0012.png,0.4.",
        )
    times: dict[str, dict[Path, float]] = {name: {} for name in groups}
    by_name: dict[str, list[tuple[str, Path]]] = defaultdict(list)
    by_number: dict[tuple[str, int], Path] = {}
    for camera, files in groups.items():
        for file in files:
            by_name[file.name].append((camera, file))
            if numbers := re.findall(r"\d+", file.stem):
                by_number[camera, int(numbers[-1])] = file
    for line, row in rows:
        time = parse_cell(path, line, row, "time_s")
        if "file" in head:
            file_name = PurePosixPath(row["file"].replace("\\", "/"))
            count = len(file_name.parts)
            meant = [
                one for one in by_name[file_name.name] if one[1].parts[-count:] == file_name.parts
            ]
            if len(meant) > 1:
                raise CalibrationError(
                    f"{path}, line {line}: several photographs are called {row['file']}.",
                    "Write the folder in front of the name.",
                )
            for camera, file in meant:
                times[camera][file] = time
            continue
        if row["camera"] not in times:
            raise CalibrationError(
                f"{path}, line {line}: there is no camera {row['camera']!r}.",
                f"The cameras are {', '.join(sorted(groups))}.",
            )
        number = int(parse_cell(path, line, row, "number"))
        if (row["camera"], number) in by_number:
            times[row["camera"]][by_number[row["camera"], number]] = time
    for name, own in times.items():
        if not own:
            raise CalibrationError(f"{path} has no times of {name}.", "Add them.")
    return times

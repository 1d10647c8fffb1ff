"""Corners of BabelCalib's image sets: a 186-degree fisheye, the corners found by Deltille."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from calibgui.engine.arrays import Size
from calibgui.engine.calibration.observations import Observation

OV_PLANE_SIZE: Size = (1280, 800)
"""Width and height of the images of ov_plane, px."""


def read_ov_plane(folder: Path, part: str) -> list[Observation]:
    """Read the views of ov_plane: "train", to calibrate from, or "test", the unseen ones."""
    lines = [line.split(",") for line in (folder / "ov_plane.dsc").read_text().splitlines()]
    first = next(i for i, line in enumerate(lines) if line[0].startswith("t25h7")) + 1
    places = np.array([list(map(float, line[3:5])) for line in lines[first:] if len(line) > 4])
    views = []
    for file in sorted((folder / "corners" / part).glob("*.orpc")):
        rows = [line.split(",") for line in file.read_text().splitlines()]
        points = np.array([list(map(float, row)) for row in rows if len(row) == 5])
        views.append(Observation(points[:, 3:5], places[points[:, 1].astype(int)]))
    return views

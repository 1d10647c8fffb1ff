"""resampled.json: the geometry of undistorted or rectified images, written beside them.

    {"kind": "undistorted" | "rectified", "size": [w, h], "matrix": 3 x 3,
     "images": {"name of the new image": "image that it was made from", ...}}

Reader: any JSON reader. Pixels are in the array frame (0-based, integer at pixel centres, v
down). `matrix` is the pinhole camera matrix of undistorted images, which have no distortion
left, or takes points (X, Y, 1) mm of the board to pixels of rectified ones.
Cannot hold: the camera that took the images (see ``result_json.py``).
"""

from __future__ import annotations

import os
from collections.abc import Mapping

from calibgui.engine.arrays import Array, Size
from calibgui.formats.json_document import write_json


def write_resampled(
    path: str | os.PathLike[str], kind: str, size: Size, matrix: Array, images: Mapping[str, str]
) -> None:
    """Write resampled.json.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    write_json(path, {"kind": kind, "size": size, "matrix": matrix, "images": images})

"""resampled.json: the geometry of undistorted or rectified images, written beside them.

    {"format": "calibgui-resampled", "version": 1,
     "written": {"name of an image": SHA-256 of its file, or null, ...},
     "kind": "undistorted" | "rectified", "size": [w, h], "matrix": 3 x 3,
     "images": {"name of the new image": "image that it was made from", ...},
     "projection": "perspective" | "cylindrical" | "equirectangular" | "stereographic" | "cube",
     "rotations": {"front": 3 x 3, "left": 3 x 3, ...}}

Reader: any JSON reader; `read_resampled`. `written` records which images of the folder this
program made, in earlier calls as well, so that a later one may replace them. While new ones are
being made their SHA-256 is null, and the geometry is that of an earlier call or missing.

Pixels are in the array frame (0-based, integer at pixel centres, v down). The `matrix` of rectified
images takes points (X, Y, 1) mm of the board to pixels. That of undistorted ones has the focal
lengths and the centre of the ideal camera that would have taken them. With x = (u - cx) / fx and
y = (v - cy) / fy, a pixel looks along the ray (X, Y, Z), X to the right, Y down, Z along the axis
of the real camera:

    perspective       (x, y, 1)
    cylindrical       (sin x, y, cos x)
    equirectangular   (cos y sin x, sin y, cos y cos x)
    stereographic     (x, y, 1 - (x^2 + y^2) / 4)
    cube              R (x, y, 1) with the `rotations` R of the face

`projection` stands beside undistorted images only, `rotations` beside a cube only, where the new
images are named after their face: NAME_front.png and so on.
Cannot hold: the camera that took the images (see ``result_json.py``).
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from calibgui.engine.arrays import Array, Size
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import IdealCamera, Projection
from calibgui.formats.json_document import check_format, read_json, write_json

FORMAT = "calibgui-resampled"
VERSION = 1

Written = Mapping[str, str | None]
"""SHA-256 of images that this program made, by their names; None while they are being made."""


def read_resampled(path: Path) -> tuple[dict[str, Any], Written] | None:
    """Read the whole content of the file, and of it the record of the images.

    Returns:
        Both, empty if there is no file; None if the file is something else, and so another's.
    """
    if not path.exists():
        return {}, {}
    try:
        node = read_json(path)
        check_format(node, FORMAT, VERSION, "a record of resampled images")
        record = node["written"].members()
        return node.value, {k: None if n.value is None else n.text() for k, n in record.items()}
    except CalibrationError:
        return None


def update_written(
    path: str | os.PathLike[str], content: Mapping[str, Any], written: Written
) -> None:
    """Write the `content` that the file had before with another record of the images.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    write_json(path, {"format": FORMAT, "version": VERSION, **content, "written": written})


def write_resampled(
    path: str | os.PathLike[str],
    kind: str,
    size: Size,
    matrix: Array,
    images: Mapping[str, str],
    written: Written,
    ideals: Mapping[str, IdealCamera] | None = None,
) -> None:
    """Write resampled.json.

    Args:
        path: of the file.
        kind: "undistorted" or "rectified".
        size, matrix: of all new images.
        images: names of the new images, with the images that they were made from.
        written: all images of the folder that this program made.
        ideals: the ideal cameras of undistorted images, as `choose_ideal_cameras` returns them.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    content: dict[str, Any] = {"kind": kind, "size": size, "matrix": matrix, "images": images}
    if ideals is not None and "" in ideals:
        content["projection"] = str(ideals[""].projection)
    elif ideals is not None:
        content["projection"] = str(Projection.CUBE)
        content["rotations"] = {face: ideal.rotation for face, ideal in ideals.items()}
    update_written(path, content, written)

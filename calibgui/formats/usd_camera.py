"""A camera of Universal Scene Description in text, moving from photograph to photograph.

Reader: USD, and what imports it (Blender, Houdini, Maya, Omniverse). It is the ideal camera of the
undistorted images that `calibgui undistort` makes, as USD knows no distortion; ``undistortion_map``
makes such images from photographs there. The film back has the width of the sensor if its crop
factor is known, else 36 mm; pixels have whole numbers at their corners in it, and the offsets of
the aperture put the principal point where it is. The world is the board, in the axes of OpenGL
(``camera_places.py``) with Z up, and in centimetres, so that focal length and apertures, which are
tenths of a unit, are millimetres. Frame k is the k-th photograph, whose name is beside it.
Cannot hold: the distortion, standard deviations, corners.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from pathlib import Path

from calibgui.dataset import Result
from calibgui.engine.files import write_atomically
from calibgui.engine.geometry import Pose, corner_from_array
from calibgui.engine.images import IdealCamera
from calibgui.formats.camera_places import world_from_camera_upright
from calibgui.formats.exporter import Exporter, ExportReport, describe_condition
from calibgui.formats.origin import make_mark
from calibgui.formats.undistortion_map import choose_shown_camera

_CM_PER_M = 100
_FILM_MM = 36.0
"""Width of the film back of a camera whose crop factor is not known, mm."""
_NOTE = "The camera of the undistorted images, which `calibgui undistort` makes."


def write_usd(result: Result, path: Path) -> ExportReport:
    """Write the camera and its places.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    ideal = choose_shown_camera(result.calibration.camera)
    crop = result.find_hardware().crop
    width, height = ideal.size
    film = (
        _FILM_MM if crop is None else math.hypot(36, 24) / crop * width / math.hypot(width, height)
    )
    note = " ".join(filter(None, [make_mark(EXPORTER.name), _NOTE, describe_condition(result)]))
    images = [view.image for view in result.used]
    text = format_stage(ideal, film, result.calibration.poses, images, note)
    write_atomically(path, text.encode(errors="backslashreplace"))
    return ExportReport(path, _NOTE)


def format_stage(
    ideal: IdealCamera, film: float, poses: Sequence[Pose], images: Sequence[str], note: str
) -> str:
    """Return the text of the file.

    Args:
        ideal: the camera of the undistorted images.
        film: width of the film back, mm.
        poses: the board's pose in each photograph.
        images: names of the photographs.
        note: the note on the file.
    """
    width, height = ideal.size
    fx, fy = ideal.matrix[[0, 1], [0, 1]].tolist()
    cx, cy = corner_from_array(ideal.matrix[:2, 2]).tolist()
    mm_x = film / width
    mm_y = mm_x * fx / fy
    motions, names = [], []
    for k, (pose, image) in enumerate(zip(poses, images, strict=True), 1):
        motion = world_from_camera_upright(pose)
        motion[:3, 3] *= _CM_PER_M
        rows = ", ".join(f"({', '.join(map(repr, row))})" for row in motion.T.tolist())
        motions.append(f"            {k}: ( {rows} ),\n")
        names.append(f"            {k}: {json.dumps(image, ensure_ascii=False)},\n")
    return f"""\
#usda 1.0
(
    doc = {json.dumps(note)}
    defaultPrim = "Camera"
    metersPerUnit = {1 / _CM_PER_M}
    upAxis = "Z"
    startTimeCode = 1
    endTimeCode = {len(poses)}
)

def Camera "Camera"
{{
    token projection = "perspective"
    float focalLength = {fx * mm_x:.9g}
    float horizontalAperture = {film:.9g}
    float verticalAperture = {height * mm_y:.9g}
    float horizontalApertureOffset = {(width / 2 - cx) * mm_x:.9g}
    float verticalApertureOffset = {(cy - height / 2) * mm_y:.9g}
    float2 clippingRange = (0.1, 100000)
    custom string image.timeSamples = {{
{"".join(names)}    }}
    matrix4d xformOp:transform.timeSamples = {{
{"".join(motions)}    }}
    uniform token[] xformOpOrder = ["xformOp:transform"]
}}
"""


EXPORTER = Exporter(
    name="usd",
    title="USD camera",
    suffixes=(".usda",),
    models=(),
    readers="USD: Blender, Houdini, Maya, Omniverse",
    keeps="the camera of the undistorted images, and where it was at each photograph, in cm from "
    "the board",
    loses="the distortion, standard deviations, corners",
    write=write_usd,
    needs_corners=True,
    fits_rays=True,
)

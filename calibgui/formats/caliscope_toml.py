"""camera_array.toml of caliscope, with one camera.

Reader: caliscope, and `read_caliscope`. Pixels and entries are those of Anipose
(``anipose_toml.py``), within a table `cameras` in which they have numbers for names.
Cannot hold: other lens models and skew (they are refitted), standard deviations, poses, corners.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from calibgui.dataset import Result
from calibgui.engine.camera import Camera
from calibgui.engine.geometry import Pose
from calibgui.formats import anipose_toml
from calibgui.formats.anipose_toml import format_entries, read_tables
from calibgui.formats.camera_places import WORLD
from calibgui.formats.camera_refit import write_in_models
from calibgui.formats.exporter import FRAME, Exporter, ExportReport
from calibgui.formats.importer import CameraText, ImportedCamera, Importer
from calibgui.formats.toml_document import parse_toml

_MAX_LENGTH = 1 << 20
"""Length of the longest text that is read, characters: a camera has some five hundred."""


def write_caliscope(result: Result, path: Path) -> ExportReport:
    """Write an array of one camera."""
    return write_in_models(
        result, path, EXPORTER, lambda fitted, note: format_array([fitted.camera], note)
    )


def format_array(cameras: Sequence[Camera], note: str, poses: Sequence[Pose] = (WORLD,)) -> str:
    """Return the text of the file; as ``anipose_toml.format_calibration``."""
    tables = [
        f"[cameras.{c}]\ncam_id = {c}\n{format_entries(camera, pose)}"
        for c, (camera, pose) in enumerate(zip(cameras, poses, strict=True))
    ]
    return f"# {note}\n# {FRAME}\n" + "\n".join(tables)


def read_caliscope(source: CameraText) -> ImportedCamera:
    """Read a camera, which is named by its number; its pose is left out.

    Raises:
        CalibrationError: as `read_tables`.
    """
    content = parse_toml(source.text, source.file, _MAX_LENGTH)
    return read_tables(source, content["cameras"], EXPORTER.title)


EXPORTER = Exporter(
    name="caliscope",
    title="caliscope camera array",
    suffixes=(".toml",),
    models=anipose_toml.EXPORTER.models,
    refits=anipose_toml.EXPORTER.refits,
    readers="caliscope",
    keeps="the camera in the models of cv2.projectPoints or cv2.fisheye",
    loses="standard deviations, poses, corners",
    write=write_caliscope,
)
IMPORTER = Importer(
    EXPORTER.title,
    re.compile(r"^[ \t]*\[cameras\.\d", re.MULTILINE),
    read_caliscope,
    several=True,
)

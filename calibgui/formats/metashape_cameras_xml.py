"""Cameras as Agisoft Metashape exports them: a camera, and where it took each photograph.

Reader: Metashape and PhotoScan (File, Import, Import Cameras), nerfstudio's and other converters of
such files, and `read_metashape` for the camera, which is written as in ``metashape_xml.py``: as the
adjusted calibration of a sensor, in its convention of pixels. `transform` of a photograph leads
from the camera, Y down and Z ahead, to the world in metres, row by row; the world is the board, Y
up and Z out of it. Photographs are known by the names of their files without suffix.
Cannot hold: other lens models (they are refitted), standard deviations, corners.
"""

from __future__ import annotations

from html import escape
from pathlib import Path, PurePath

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.calibration import Calibration
from calibgui.formats.camera_places import Y_UP_FROM_Y_DOWN, world_from_camera_upright
from calibgui.formats.camera_refit import write_in_models
from calibgui.formats.exporter import Exporter, ExportReport
from calibgui.formats.metashape_xml import EXPORTER as CALIBRATION
from calibgui.formats.metashape_xml import format_note, is_fisheye, list_values


def write_metashape_cameras(result: Result, path: Path) -> ExportReport:
    """Write a camera with its photographs."""
    labels = [PurePath(view.image).stem for view in result.used]
    return write_in_models(
        result, path, EXPORTER, lambda fitted, note: format_cameras(fitted, labels, note)
    )


def format_cameras(calibration: Calibration, labels: list[str], note: str) -> str:
    """Return the text of the file.

    Args:
        calibration: its camera is in one of the format's models.
        labels: the name of each pose's photograph.
        note: the note on the file.
    """
    camera = calibration.camera
    kind = "fisheye" if is_fisheye(camera) else "frame"
    size = '<resolution width="{}" height="{}"/>'.format(*camera.size)
    values = "".join(f"     <{name}>{value!r}</{name}>\n" for name, value in list_values(camera))
    places = "".join(
        f'   <camera id="{k}" sensor_id="0" component_id="0" label="{escape(label)}">\n'
        f"    <transform>{_format_rows(world_from_camera_upright(pose) @ Y_UP_FROM_Y_DOWN)}"
        "</transform>\n"
        "    <orientation>1</orientation>\n"
        "   </camera>\n"
        for k, (label, pose) in enumerate(zip(labels, calibration.poses, strict=True))
    )
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f"{format_note(note)}"
        '<document version="2.0.0">\n'
        ' <chunk label="calibgui" enabled="true">\n'
        '  <sensors next_id="1">\n'
        f'   <sensor id="0" label="camera" type="{kind}">\n'
        f"    {size}\n"
        f'    <calibration type="{kind}" class="adjusted">\n'
        f"     {size}\n"
        f"{values}"
        "    </calibration>\n"
        "   </sensor>\n"
        "  </sensors>\n"
        '  <components next_id="1" active_id="0">\n'
        '   <component id="0" label="Component 1"/>\n'
        "  </components>\n"
        f'  <cameras next_id="{len(labels)}" next_group_id="0">\n'
        f"{places}"
        "  </cameras>\n"
        " </chunk>\n"
        "</document>\n"
    )


def _format_rows(motion: Array) -> str:
    return " ".join(repr(value) for value in motion.ravel().tolist())


EXPORTER = Exporter(
    name="metashape-cameras",
    title="Metashape cameras",
    suffixes=(".xml",),
    stem="cameras",
    models=CALIBRATION.models,
    refits=CALIBRATION.refits,
    holds_skew=True,
    readers="Metashape, nerfstudio's ns-process-data",
    keeps="the camera as in the calibration, and where it was at each photograph, in metres from "
    "the board",
    loses="standard deviations, corners",
    write=write_metashape_cameras,
    needs_corners=True,
)

"""File formats: one module each, which names its reader, its convention and what it cannot hold.

To add an exporter, write a module with a function (result, path) -> ExportReport that writes
through ``engine.files.write_atomically``, describe it in a constant `EXPORTER`, and list the module
below: command line and window take it from there. `Exporter.models` names the lens models that the
format holds; ``camera_refit.write_in_models`` writes these as calibrated, refits others in
`Exporter.refits` and refuses a refit that cannot follow the lens. The exporter is complete when a
test reads the file with the program that it is for and projects the same points to the same pixels.

A camera that came without corners is a result without views; ``camera_conversion`` makes one, and
leaves out formats that need corners (`Exporter.needs_corners`).

A format whose cameras are read, too, has a function (CameraText) -> ImportedCamera and a constant
`IMPORTER` in the same module, which is listed in ``camera_import``; `read_camera` finds the format
of a file by its content.

Whatever is read passes ``gate.py``: text of a stated size, data of a stated depth, values by type.
"""

from __future__ import annotations

import os
from pathlib import Path

from calibgui.dataset import Result
from calibgui.engine.errors import CalibrationError
from calibgui.formats import (
    adobe_lcp,
    anipose_toml,
    basalt_json,
    bouguet_results,
    caliscope_toml,
    colmap_cameras,
    colmap_model,
    corners_csv,
    corners_json,
    corners_vnl,
    engine_python,
    gyroflow_json,
    kalibr_camchain,
    lensfun_xml,
    matlab_script,
    metashape_cameras_xml,
    metashape_xml,
    mrcal_model,
    nerfstudio_json,
    opencv_file,
    opencv_python,
    openvins_yaml,
    orb_slam_yaml,
    result_json,
    ros_yaml,
    undistortion_map,
    usd_camera,
)
from calibgui.formats.camera_import import IMPORTERS, holds_camera, read_camera
from calibgui.formats.exporter import Exporter, ExportReport
from calibgui.formats.importer import ImportedCamera, Importer

EXPORTERS: dict[str, Exporter] = {
    module.EXPORTER.name: module.EXPORTER
    for module in (
        result_json,
        opencv_file,
        ros_yaml,
        kalibr_camchain,
        openvins_yaml,
        orb_slam_yaml,
        mrcal_model,
        colmap_cameras,
        colmap_model,
        nerfstudio_json,
        metashape_xml,
        metashape_cameras_xml,
        matlab_script,
        bouguet_results,
        basalt_json,
        anipose_toml,
        caliscope_toml,
        gyroflow_json,
        lensfun_xml,
        adobe_lcp,
        undistortion_map,
        usd_camera,
        engine_python,
        opencv_python,
        corners_json,
        corners_csv,
        corners_vnl,
    )
}
"""Exporters by name, in the order of menus."""


def export(result: Result, name: str, path: str | os.PathLike[str]) -> ExportReport:
    """Write `result` as the file `path` in the format `name`.

    Raises:
        CalibrationError: for an unknown format, a suffix that is not the format's, a file
            that cannot be written, a lens that the format's lens model cannot follow, or a partial
            calibration if the format cannot state what was assumed.
    """
    exporter = find_exporter(name, path)
    diagnosis = result.calibration.diagnosis
    if diagnosis is not None and not exporter.partial:
        raise CalibrationError(
            f"{os.fspath(path)} is not written: readers of the format {name!r} would take a "
            f"partial calibration for a whole one. {diagnosis.message}",
            diagnosis.hint,
        )
    return exporter.write(result, Path(path))


def find_exporter(name: str, path: str | os.PathLike[str]) -> Exporter:
    """Return the exporter `name` after a check that it can write `path`.

    Raises:
        CalibrationError: for an unknown format or a name that is not the format's.
    """
    if name not in EXPORTERS:
        raise CalibrationError(
            f"There is no export format {name!r}.", f"Choose from {', '.join(EXPORTERS)}."
        )
    exporter = EXPORTERS[name]
    if Path(path).suffix.lower() not in exporter.suffixes:
        raise CalibrationError(
            f"{os.fspath(path)} is not named as a file of the format {name!r}.",
            f"Give it the suffix {' or '.join(exporter.suffixes)}.",
        )
    if exporter.stem and Path(path).stem != exporter.stem:
        raise CalibrationError(
            f"{os.fspath(path)} is not named as readers of the format {name!r} expect.",
            f"Name it {' or '.join(exporter.stem + suffix for suffix in exporter.suffixes)}.",
        )
    return exporter


__all__ = [
    "EXPORTERS",
    "IMPORTERS",
    "ExportReport",
    "Exporter",
    "ImportedCamera",
    "Importer",
    "Result",
    "export",
    "find_exporter",
    "holds_camera",
    "read_camera",
]

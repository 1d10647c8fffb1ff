"""Reading the camera of a file of another program, whichever it is: `read_camera`.

`read_result_file` reads a result, and says of the others that they are none.

The format is recognised by the file's content, because suffixes do not tell: ".yaml" is OpenCV's,
ROS's and Kalibr's, ".json" ours, Basalt's and OpenCV's, ".txt" anybody's.
"""

from __future__ import annotations

import os
import re

from calibgui.dataset import Result
from calibgui.engine.arrays import Size
from calibgui.engine.errors import CalibrationError
from calibgui.formats import (
    anipose_toml,
    basalt_json,
    bouguet_results,
    caliscope_toml,
    colmap_cameras,
    gyroflow_json,
    kalibr_camchain,
    matlab_script,
    metashape_xml,
    mrcal_model,
    nerfstudio_json,
    opencv_file,
    orb_slam_yaml,
    photonvision_json,
    result_json,
    ros_yaml,
)
from calibgui.formats.gate import read_text
from calibgui.formats.importer import CameraText, ImportedCamera, Importer
from calibgui.formats.json_document import parse_json
from calibgui.formats.origin import CORNERS, make_mark

IMPORTERS: tuple[Importer, ...] = tuple(
    module.IMPORTER
    for module in (
        result_json,
        photonvision_json,
        mrcal_model,
        basalt_json,
        caliscope_toml,
        anipose_toml,
        gyroflow_json,
        nerfstudio_json,
        metashape_xml,
        bouguet_results,
        matlab_script,
        kalibr_camchain,
        orb_slam_yaml,
        ros_yaml,
        opencv_file,
        colmap_cameras,
    )
)
"""The formats that cameras are read from, in the order in which files are tried."""
_NAME_ITS_RESULT = "Name the result.json of the calibration that it was written from."
_WITHOUT_CAMERA = (
    (
        re.compile("<lensdatabase"),
        "is a lensfun database, which holds no camera in pixels.",
        _NAME_ITS_RESULT,
    ),
    (
        re.compile("photoshop/1.0/camera-profile"),
        "is a lens profile of Adobe's, whose images may be of any size.",
        _NAME_ITS_RESULT,
    ),
    (
        re.compile(make_mark("(opencv-)?python")),
        "is a script in Python, which is not run.",
        _NAME_ITS_RESULT,
    ),
    (
        re.compile(f"{make_mark(CORNERS)}|\\Aimage,row,col,|^# filename x y ", re.MULTILINE),
        "holds corners, but no camera.",
        "Calibrate them first: `calibgui calibrate -o` writes a result.json.",
    ),
)
"""Patterns of files that this program writes and reads no camera from, what these are, and what to
do instead."""
_BINARY = (
    (bouguet_results.is_mat, bouguet_results.unpack_mat),
    (colmap_cameras.is_binary, colmap_cameras.unpack_cameras),
)
"""Functions that tell and translate the binary files that are read."""
MAX_FILE_SIZE = 64 << 20
"""Size of the largest files that are read, bytes: results and mrcal's models hold all corners."""


def read_camera(
    path: str | os.PathLike[str], name: str | None = None, size: Size | None = None
) -> ImportedCamera:
    """Read a camera from a file of this program or of another one.

    Args:
        path: the file; its content tells the format.
        name: name of the camera in a file that holds several.
        size: width and height of the images, px, for a file that does not state them.

    Raises:
        CalibrationError: if the file cannot be read, is of no known format, holds several cameras
            and `name` does not choose one, has a lens model that this program has not, or
            something in it is wrong; the message says what can be read.
    """
    source = CameraText(_read_text(path), os.fspath(path), name, size)
    _refuse_without_camera(source)
    importer = _find_importer(source.text)
    if importer is None:
        if source.file.lower().endswith(".json") or not source.text.strip():
            parse_json(source.text, source.file)  # says where it is damaged
        source.fail(
            "is not a camera file that can be read.",
            f"These can be read: {', '.join(importer.title for importer in IMPORTERS)}.",
        )
    if name is not None and not importer.several:
        source.fail(
            f"holds one camera without a name ({importer.title}).", f"Leave the name {name!r} out."
        )
    return importer.read(source)


def holds_camera(path: str | os.PathLike[str]) -> bool:
    """Return whether a file is of one of the formats that cameras are read from."""
    try:
        return _find_importer(_read_text(path)) is not None
    except CalibrationError:
        return False


def read_result_file(path: str | os.PathLike[str]) -> Result:
    """Read a result.json.

    Raises:
        CalibrationError: as `result_json.read_result`; if the file is a camera of another program,
            or another one that this program writes, the message says so.
    """
    try:
        return result_json.read_result(path)
    except CalibrationError as error:
        _refuse_other_file(path, error)
        raise


def _refuse_other_file(path: str | os.PathLike[str], error: CalibrationError) -> None:
    """Raise a CalibrationError if the file, which is no result by `error`, is a known other one."""
    try:
        source = CameraText(_read_text(path), os.fspath(path))
    except CalibrationError:
        return
    _refuse_without_camera(source)
    importer = _find_importer(source.text)
    if importer not in (None, result_json.IMPORTER):
        raise CalibrationError(
            f"{source.file} holds a camera only ({importer.title}): neither corners, nor the poses "
            "and uncertainties that come from them.",
            f"{_NAME_ITS_RESULT} `calibgui calibrate -o` writes it.",
        ) from error


def _refuse_without_camera(source: CameraText) -> None:
    """Raise a CalibrationError if the file is a known one that holds no camera."""
    for pattern, what, hint in _WITHOUT_CAMERA:
        if pattern.search(source.text):
            source.fail(what, hint)


def _find_importer(text: str) -> Importer | None:
    """Return the format that a text is of; None if it is none that cameras are read from."""
    return next((one for one in IMPORTERS if one.signature.search(text)), None)


def _read_text(path: str | os.PathLike[str]) -> str:
    """Return the text of a file, or that which says the same as its binary content.

    Raises as ``gate.read_text``.
    """
    readable = f"These can be read: {', '.join(importer.title for importer in IMPORTERS)}."
    title = "a camera file that can be read"
    return read_text(path, MAX_FILE_SIZE, title, readable, _BINARY)

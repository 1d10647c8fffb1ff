"""COLMAP's cameras.txt or cameras.bin, with one camera.

Reader: COLMAP and pycolmap, which take it for the first camera of a sparse model, and
`read_colmap`. The suffix tells whether the file is a text or binary, and binary files are read as
the texts that say the same. Pixels of COLMAP have whole numbers at their corners: the principal
point is half a pixel more than OpenCV's. Each of COLMAP's models lists its parameters in an order
of its own. A camera of five coefficients is written as FULL_OPENCV, whose other three are 0;
decentering on a fisheye as THIN_PRISM_FISHEYE, whose thin prism is 0.
Cannot hold: other lens models and skew (they are refitted), standard deviations, poses, corners
(``colmap_model.py``).
"""

from __future__ import annotations

import re
import struct
from pathlib import Path

from calibgui.dataset import Result
from calibgui.engine.camera import Camera
from calibgui.engine.geometry import corner_from_array
from calibgui.formats.camera_refit import write_in_models
from calibgui.formats.exporter import Exporter, ExportReport
from calibgui.formats.gate import parse_number
from calibgui.formats.importer import CameraText, ImportedCamera, Importer

_FOCALS = "fx fy cx cy"
_READABLE = {
    "SIMPLE_PINHOLE": ("pinhole", "f cx cy"),
    "PINHOLE": ("pinhole", _FOCALS),
    "SIMPLE_RADIAL": ("brown-conrady-4", "f cx cy k1"),
    "RADIAL": ("brown-conrady-4", "f cx cy k1 k2"),
    "OPENCV": ("brown-conrady-4", f"{_FOCALS} k1 k2 p1 p2"),
    "FULL_OPENCV": ("rational", f"{_FOCALS} k1 k2 p1 p2 k3 k4 k5 k6"),
    "SIMPLE_FISHEYE": ("kannala-brandt", "f cx cy"),
    "FISHEYE": ("kannala-brandt", _FOCALS),
    "SIMPLE_RADIAL_FISHEYE": ("kannala-brandt", "f cx cy k1"),
    "RADIAL_FISHEYE": ("kannala-brandt", "f cx cy k1 k2"),
    "OPENCV_FISHEYE": ("kannala-brandt", f"{_FOCALS} k1 k2 k3 k4"),
    "THIN_PRISM_FISHEYE": ("kannala-brandt-decentering", f"{_FOCALS} k1 k2 p1 p2 k3 k4 sx1 sy1"),
    "SIMPLE_DIVISION": ("division", "f cx cy k1"),
    "DIVISION": ("division", f"{_FOCALS} k1"),
    "EUCM": ("eucm", f"{_FOCALS} alpha beta"),
}
"""COLMAP's models: our id, and the names of the parameters in COLMAP's order; f is fx and fy."""
_WRITTEN = {
    "brown-conrady": "FULL_OPENCV",
    "brown-conrady-4": "OPENCV",
    "pinhole": "PINHOLE",
    "rational": "FULL_OPENCV",
    "kannala-brandt": "OPENCV_FISHEYE",
    "kannala-brandt-decentering": "THIN_PRISM_FISHEYE",
    "division": "DIVISION",
    "ucm": "EUCM",
    "eucm": "EUCM",
}
"""COLMAP's models that cameras of ours are written in."""
_NUMBERS = {
    "SIMPLE_PINHOLE": 0,
    "PINHOLE": 1,
    "SIMPLE_RADIAL": 2,
    "RADIAL": 3,
    "OPENCV": 4,
    "OPENCV_FISHEYE": 5,
    "FULL_OPENCV": 6,
    "FOV": 7,
    "SIMPLE_RADIAL_FISHEYE": 8,
    "RADIAL_FISHEYE": 9,
    "THIN_PRISM_FISHEYE": 10,
    "SIMPLE_DIVISION": 12,
    "DIVISION": 13,
    "SIMPLE_FISHEYE": 14,
    "FISHEYE": 15,
    "EUCM": 16,
}
"""Numbers of COLMAP's models in binary files."""
_COUNTS = {_NUMBERS[name]: len(names.split()) for name, (_, names) in _READABLE.items()}
_COUNTS[_NUMBERS["FOV"]] = 5
"""Numbers of parameters of a binary file's models."""
_HEAD = struct.Struct("<IiQQ")
"""A camera's number, its model's number, width and height in a binary file."""


def write_colmap(result: Result, path: Path) -> ExportReport:
    """Write a file with one camera."""
    make = pack_cameras if path.suffix.lower() == ".bin" else format_cameras
    return write_in_models(result, path, EXPORTER, lambda fitted, note: make(fitted.camera, note))


def list_parameters(camera: Camera) -> tuple[str, list[float]]:
    """Return COLMAP's model of a camera in one of the format's models, and its parameters."""
    model = _WRITTEN[camera.model]
    values = {"beta": 1.0} | dict(zip(camera.names, camera.params.tolist(), strict=True))
    values["cx"], values["cy"] = corner_from_array(camera.centre).tolist()
    return model, [values.get(name, 0.0) for name in _READABLE[model][1].split()]


def pack_cameras(camera: Camera, note: str) -> bytes:
    """Return the content of a binary file; the note stands behind the camera, where no reader
    looks."""
    model, parameters = list_parameters(camera)
    head = struct.pack("<Q", 1) + _HEAD.pack(1, _NUMBERS[model], *camera.size)
    return head + struct.pack(f"<{len(parameters)}d", *parameters) + note.encode()


def is_binary(content: bytes) -> bool:
    """Return whether the content of a file begins as that of a cameras.bin does."""
    if len(content) < 8 + _HEAD.size:
        return False
    (count,) = struct.unpack_from("<Q", content)
    return 0 < count < len(content) and _HEAD.unpack_from(content, 8)[1] in _NUMBERS.values()


def unpack_cameras(content: bytes) -> str:
    """Return the cameras.txt that says the same as the content of a cameras.bin.

    Raises:
        ValueError: if the content ends within a camera, or a camera has an unknown model.
    """
    names = {number: name for name, number in _NUMBERS.items()}
    lines, place = [], 8
    try:
        for _ in range(struct.unpack_from("<Q", content)[0]):
            camera, number, width, height = _HEAD.unpack_from(content, place)
            if number not in names:
                raise ValueError(f"camera {camera} has the unknown lens model {number}")
            place += _HEAD.size
            parameters = struct.unpack_from(f"<{_COUNTS[number]}d", content, place)
            place += 8 * len(parameters)
            values = " ".join(map(repr, parameters))
            lines.append(f"{camera} {names[number]} {width} {height} {values}")
    except struct.error as error:
        raise ValueError("it ends within a camera") from error
    return "\n".join(lines)


def format_cameras(camera: Camera, note: str) -> str:
    """Return the text of the file; `camera` is in one of the format's models."""
    model, parameters = list_parameters(camera)
    numbers = " ".join(map(repr, parameters))
    width, height = camera.size
    return (
        f"# {note}\n"
        "# Pixels count from 0 at the corner of the first pixel, u right, v down.\n"
        "# Camera list with one line of data per camera:\n"
        "#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n"
        "# Number of cameras: 1\n"
        f"1 {model} {width} {height} {numbers}\n"
    )


def read_colmap(source: CameraText) -> ImportedCamera:
    """Read a camera of a cameras.txt; its name is its number there.

    Raises:
        CalibrationError: if a line is none of a camera, several cameras are there and none is
            chosen, or the lens model is none of ours.
    """
    lines = [line.split() for line in source.text.splitlines()]
    entries = [words for words in lines if words and not words[0].startswith("#")]
    cameras = {words[0]: words[1:] for words in entries}
    if len(cameras) < len(entries):
        source.fail("has two lines for one camera.")
    name, words = source.choose_camera(cameras)
    if len(words) < 3:
        source.fail(f"has an incomplete line for camera {name}.")
    if words[0] == "FOV":
        source.fail(
            "has the lens model FOV, which cannot be read: its formula is none of ours.",
            "The nearest that can be read is OPENCV_FISHEYE: let COLMAP estimate that, with "
            "--ImageReader.camera_model OPENCV_FISHEYE.",
        )
    if words[0] not in _READABLE:
        source.refuse_model(words[0], list(_READABLE))
    model, listed = _READABLE[words[0]]
    names = listed.split()
    try:
        width, height, *numbers = map(parse_number, words[1:])
    except ValueError as error:
        source.fail(f"has a line for camera {name} that holds more than numbers: {error}.")
    if len(numbers) != len(names):
        source.fail(f"has {len(numbers)} parameters for camera {name}; {words[0]} has {listed}.")
    values = dict(zip(names, numbers, strict=True))
    if "f" in values:
        values["fx"] = values["fy"] = values.pop("f")
    values["cx"], values["cy"] = values["cx"] - 0.5, values["cy"] - 0.5
    if any(values.pop(term, 0.0) != 0 for term in ("sx1", "sy1")):
        source.refuse_model(words[0], list(_READABLE), "its thin prism (sx1, sy1) is not 0")
    camera = source.make_camera(source.choose_size((width, height)), model, values)
    notes = (f"Camera {name} of {len(cameras)}.",) if len(cameras) > 1 else ()
    return ImportedCamera(camera, EXPORTER.title, notes=notes)


EXPORTER = Exporter(
    name="colmap",
    title="COLMAP cameras.txt",
    suffixes=(".txt", ".bin"),
    models=tuple(_WRITTEN),
    refits=("brown-conrady", "kannala-brandt-decentering"),
    readers="COLMAP, pycolmap",
    keeps="the camera in OpenCV's models, as THIN_PRISM_FISHEYE, DIVISION or EUCM; pixels count "
    "from a corner",
    loses="standard deviations, poses, corners",
    write=write_colmap,
)
IMPORTER = Importer(
    EXPORTER.title,
    re.compile(r"^[ \t]*\d+[ \t]+[A-Z][A-Z_]+[ \t]+\d+[ \t]+\d+[ \t]", re.MULTILINE),
    read_colmap,
    several=True,
)

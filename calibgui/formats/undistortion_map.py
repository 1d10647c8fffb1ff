"""The map that undistorts photographs: an STMap in OpenEXR or TIFF, or an array for cv2.remap.

Reader: of .exr and .tif Nuke, Fusion, Natron and Blender (STMap, Map UV), of .npy NumPy. A pixel of
the map belongs to one of the undistorted image that `calibgui undistort` makes, and says where in
the photograph its colour is. In .npy (h, w, 2) these are pixels of the array frame (0-based,
integer at pixel centres), to be given to cv2.remap as they are. In the others the channels R and G
are shares of the photograph's width and height from its lower left corner, as compositing programs
count them.
Places outside of the photograph have -1 px, which none of them shows.
Cannot hold: the camera itself, standard deviations, poses, corners.

A .exr is a file of scan lines without compression (OpenEXR File Layout, version 2), a .tif one of
three floats a pixel in one strip (TIFF, revision 6.0), the third of which is 0.
"""

from __future__ import annotations

import io
import struct
from pathlib import Path

import numpy as np

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.camera import Camera, pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically
from calibgui.engine.images import FieldOfView, IdealCamera, choose_ideal_cameras, make_mesh
from calibgui.formats.exporter import Exporter, ExportReport
from calibgui.formats.origin import make_mark

_MAGIC, _VERSION, _FLOAT, _NO_COMPRESSION, _TOP_DOWN = 20000630, 2, 2, 0, 0
"""Numbers of the OpenEXR layout."""
_NOTE = "Undistorts photographs as `calibgui undistort` does, from the camera as calibrated."


def write_map(result: Result, path: Path) -> ExportReport:
    """Write the map of the undistorted image.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    camera = result.calibration.camera
    ideal = choose_shown_camera(camera)
    places = make_map(camera, ideal)
    mark = make_mark(EXPORTER.name)
    suffix, shares = path.suffix.lower(), (places + 0.5) / camera.size * [1, -1] + [0, 1]
    if suffix == ".npy":
        write_atomically(path, pack_npy(places, mark))
    else:
        write_atomically(path, (pack_exr if suffix == ".exr" else pack_tiff)(shares, mark))
    fx, fy, cx, cy = ideal.matrix[[0, 1, 0, 1], [0, 1, 2, 2]].tolist()
    note = f"{_NOTE} The new images have fx {fx:.6g}, fy {fy:.6g}, cx {cx:.6g}, cy {cy:.6g} px."
    return ExportReport(path, note)


def choose_shown_camera(camera: Camera) -> IdealCamera:
    """Choose the camera of a perspective image that shows all of the photograph, or that keeps the
    scale of its middle where the lens model folds over at the edge."""
    try:
        (ideal,) = choose_ideal_cameras(camera).values()
    except CalibrationError:
        (ideal,) = choose_ideal_cameras(camera, FieldOfView.SAME_SCALE).values()
    return ideal


def make_map(camera: Camera, ideal: IdealCamera) -> Array:
    """Return the places (h, w, 2) in the photograph, px, of the pixels of the ideal image."""
    u, v = (np.arange(length, dtype=np.float64) for length in ideal.size)
    uv = pixels_from_rays(ideal.find_rays(make_mesh(u, v)), camera)
    inside = ((uv > -0.5) & (uv < np.array(camera.size) - 0.5)).all(axis=-1, keepdims=True)
    return np.where(inside, uv, -1.0)


def pack_npy(places: Array, mark: str) -> bytes:
    """Return the content of a .npy; the mark stands behind the array, where no reader looks."""
    content = io.BytesIO()
    np.save(content, places.astype(np.float32))
    return content.getvalue() + mark.encode()


def pack_tiff(shares: Array, mark: str) -> bytes:
    """Return the content of an STMap (h, w, 2) as TIFF."""
    height, width, _ = shares.shape
    pixels = np.dstack([shares, np.zeros((height, width))]).astype("<f4").tobytes()
    comment = mark.encode() + b"\0"
    start = 8 + len(pixels)  # of what is longer than four bytes
    bits, kinds, text = start, start + 6, start + 12
    entries = [  # tag, type (2 text, 3 short, 4 long), number of values, value or place
        (256, 4, 1, width),
        (257, 4, 1, height),
        (258, 3, 3, bits),
        (259, 3, 1, 1),  # no compression
        (262, 3, 1, 2),  # red, green, blue
        (270, 2, len(comment), text),
        (273, 4, 1, 8),
        (277, 3, 1, 3),
        (278, 4, 1, height),
        (279, 4, 1, len(pixels)),
        (339, 3, 3, kinds),  # floats
    ]
    beside = struct.pack("<6H", 32, 32, 32, 3, 3, 3) + comment + b"\0" * (len(comment) % 2)
    head = struct.pack("<2sHI", b"II", 42, start + len(beside))
    listed = b"".join(struct.pack("<HHII", *entry) for entry in entries)
    return head + pixels + beside + struct.pack("<H", len(entries)) + listed + bytes(4)


def pack_exr(shares: Array, mark: str) -> bytes:
    """Return the content of an STMap (h, w, 2) as OpenEXR."""
    planes = np.stack([shares[..., 1], shares[..., 0]], axis=1)  # G before R, line by line
    height, _, width = planes.shape
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    channels = b"".join(name + b"\0" + struct.pack("<4i", _FLOAT, 0, 1, 1) for name in (b"G", b"R"))
    attributes = [
        ("channels", "chlist", channels + b"\0"),
        ("comments", "string", mark.encode()),
        ("compression", "compression", bytes([_NO_COMPRESSION])),
        ("dataWindow", "box2i", window),
        ("displayWindow", "box2i", window),
        ("lineOrder", "lineOrder", bytes([_TOP_DOWN])),
        ("pixelAspectRatio", "float", struct.pack("<f", 1.0)),
        ("screenWindowCenter", "v2f", struct.pack("<2f", 0.0, 0.0)),
        ("screenWindowWidth", "float", struct.pack("<f", 1.0)),
    ]
    head = struct.pack("<2i", _MAGIC, _VERSION)
    for name, kind, value in attributes:
        head += f"{name}\0{kind}\0".encode() + struct.pack("<i", len(value)) + value
    head += b"\0"
    length = 2 * width * 4
    start = len(head) + 8 * height
    offsets = start + (8 + length) * np.arange(height, dtype="<u8")
    lines = planes.reshape(height, -1).astype("<f4")
    numbered = zip(range(height), lines, strict=True)
    chunks = [struct.pack("<2i", y, length) + line.tobytes() for y, line in numbered]
    return head + offsets.tobytes() + b"".join(chunks)


EXPORTER = Exporter(
    name="map",
    title="Undistortion map",
    suffixes=(".exr", ".tif", ".tiff", ".npy"),
    models=(),
    readers="Nuke, Fusion, Natron and Blender (.exr, .tif), cv2.remap (.npy)",
    keeps="where each pixel of the undistorted image is in the photograph, of every lens",
    loses="the camera itself, standard deviations, poses, corners",
    write=write_map,
    fits_rays=True,
)

"""A whole model of COLMAP: the camera, the photographs with their poses, and the board's points.

Reader: COLMAP, pycolmap, and what takes sparse models (3D Gaussian splatting, nerfstudio, OpenMVS).
The file that is named is images.txt or images.bin; the cameras and points3D of the model are
written beside it, as text or binary like it. Pixels have whole numbers at their corners
(``colmap_cameras.py``, which has the camera's models as well). The world is the board, X along a
row, Y down its columns and Z into it, in metres. The board's points are those of the model, each
with its track of corners and its mean error in px, where they were found to be if the board's shape
was estimated.
Cannot hold: other lens models and skew (they are refitted), standard deviations.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from calibgui.dataset import Result
from calibgui.engine.calibration import Calibration, Observation
from calibgui.engine.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically
from calibgui.engine.geometry import corner_from_array
from calibgui.formats import colmap_cameras
from calibgui.formats.camera_places import M_PER_MM, list_motion
from calibgui.formats.camera_refit import fit_to_format
from calibgui.formats.exporter import Exporter, ExportReport
from calibgui.formats.image_names import shorten_names
from calibgui.formats.origin import is_own

_GREY = (128, 128, 128)
"""Colour of the points, which COLMAP wants."""


class _Image(NamedTuple):
    """A photograph of the model."""

    number: int
    motion: list[float]
    """Unit quaternion, its real part first, and translation, m, from the board to the camera."""
    name: str
    corners: list[tuple[float, float, int]]
    """u, v in px of the corner frame, and the number of the point."""


class _Point(NamedTuple):
    """A point of the board."""

    number: int
    place: list[float]
    """X, Y, Z, m."""
    error: float
    """Mean distance of its corners from where the camera sees it, px."""
    track: list[tuple[int, int]]
    """The images that see it, and the corner's place among those of the image."""


def write_colmap_model(result: Result, path: Path) -> ExportReport:
    """Write images.txt or images.bin, and cameras and points3D beside it.

    Raises:
        CalibrationError: if one of the files beside it is not of this program, no lens model of
            COLMAP's follows the lens, or a file cannot be written.
    """
    expressed, note, marked = fit_to_format(result, path, EXPORTER)
    names = shorten_names([view.image for view in result.used])
    images, points = _collect(expressed.calibration, result.observations(), names)
    contents = format_model(
        expressed.calibration.camera, images, points, marked, path.suffix.lower() == ".bin"
    )
    beside = {path.with_stem(stem): contents[stem] for stem in ("cameras", "points3D")}
    for other in beside:
        if other.exists() and not is_own(other, EXPORTER.name):
            raise CalibrationError(
                f"{other} exists, and calibgui did not write it.", "Choose a folder of its own."
            )
    for place, content in ({path: contents["images"]} | beside).items():
        write_atomically(place, content)
    note = f"{note} {' and '.join(other.name for other in beside)} are beside it."
    if path.suffix.lower() == ".txt" and any(" " in name for name in names):
        note = f"{note} COLMAP reads names with blanks from images.bin only."
    return ExportReport(path, note, expressed.largest_error)


def _collect(
    calibration: Calibration, observations: Sequence[Observation], names: Sequence[str]
) -> tuple[list[_Image], list[_Point]]:
    """Return the photographs and the points of a calibration, numbered from 1."""
    places = _locate_points(calibration, observations)
    numbers = {place: k for k, place in enumerate(places, 1)}
    tracks: dict[int, list[tuple[int, int]]] = {k: [] for k in numbers.values()}
    errors: dict[int, list[float]] = {k: [] for k in numbers.values()}
    images = []
    for number, (view, pose, name) in enumerate(
        zip(observations, calibration.poses, names, strict=True), 1
    ):
        seen = [numbers[x, y] for x, y in view.xy.tolist()]
        off = np.linalg.norm(calibration.residuals[number - 1].image, axis=1).tolist()
        for k, (point, error) in enumerate(zip(seen, off, strict=True)):
            tracks[point].append((number, k))
            errors[point].append(error)
        uv = corner_from_array(view.uv).tolist()
        corners = [(u, v, point) for (u, v), point in zip(uv, seen, strict=True)]
        images.append(_Image(number, list_motion(pose), name, corners))
    points = [
        _Point(k, places[place], float(np.mean(errors[k])), tracks[k])
        for place, k in numbers.items()
    ]
    return images, points


def _locate_points(
    calibration: Calibration, observations: Sequence[Observation]
) -> dict[tuple[float, float], list[float]]:
    """Return where the board's points are, m, by their places on the drawing, mm."""
    drawn = np.unique(np.concatenate([view.xy for view in observations]), axis=0)
    places = {(x, y): [x * M_PER_MM, y * M_PER_MM, 0.0] for x, y in drawn.tolist()}
    if (shape := calibration.board_shape) is not None:
        real = np.pad(shape.nominal, ((0, 0), (0, 1))) + shape.deviation
        found = zip(shape.nominal.tolist(), (real * M_PER_MM).tolist(), strict=True)
        places |= {(x, y): place for (x, y), place in found if (x, y) in places}
    return places


def format_model(
    camera: Camera,
    images: Sequence[_Image],
    points: Sequence[_Point],
    note: str,
    is_binary: bool,
) -> dict[str, bytes]:
    """Return the contents of the three files by their stems."""
    if is_binary:
        return {
            "cameras": colmap_cameras.pack_cameras(camera, note),
            "images": _pack_images(images) + note.encode(),
            "points3D": _pack_points(points) + note.encode(),
        }
    return {
        "cameras": colmap_cameras.format_cameras(camera, note).encode(),
        "images": (f"# {note}\n{_format_images(images)}").encode(errors="backslashreplace"),
        "points3D": (f"# {note}\n{_format_points(points)}").encode(),
    }


def _format_images(images: Sequence[_Image]) -> str:
    lines = [
        "# Image list with two lines of data per image:",
        "#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME",
        "#   POINTS2D[] as (X, Y, POINT3D_ID)",
    ]
    for image in images:
        lines.append(f"{image.number} {' '.join(map(repr, image.motion))} 1 {image.name}")
        lines.append(" ".join(f"{u!r} {v!r} {point}" for u, v, point in image.corners))
    return "\n".join(lines) + "\n"


def _format_points(points: Sequence[_Point]) -> str:
    lines = [
        "# 3D point list with one line of data per point:",
        "#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)",
    ]
    for point in points:
        values = [*point.place, *_GREY, point.error]
        track = " ".join(f"{image} {k}" for image, k in point.track)
        lines.append(f"{point.number} {' '.join(map(repr, values))} {track}")
    return "\n".join(lines) + "\n"


def _pack_images(images: Sequence[_Image]) -> bytes:
    parts = [struct.pack("<Q", len(images))]
    for image in images:
        name = image.name.encode(errors="backslashreplace")
        parts += [struct.pack("<I7dI", image.number, *image.motion, 1), name + b"\0"]
        parts.append(struct.pack("<Q", len(image.corners)))
        parts += [struct.pack("<2dQ", *corner) for corner in image.corners]
    return b"".join(parts)


def _pack_points(points: Sequence[_Point]) -> bytes:
    parts = [struct.pack("<Q", len(points))]
    for point in points:
        parts.append(struct.pack("<Q3d3Bd", point.number, *point.place, *_GREY, point.error))
        parts.append(struct.pack("<Q", len(point.track)))
        parts += [struct.pack("<2I", *seen) for seen in point.track]
    return b"".join(parts)


EXPORTER = Exporter(
    name="colmap-model",
    title="COLMAP model",
    suffixes=(".txt", ".bin"),
    stem="images",
    models=colmap_cameras.EXPORTER.models,
    refits=colmap_cameras.EXPORTER.refits,
    readers="COLMAP, pycolmap, 3D Gaussian splatting, OpenMVS",
    keeps="the camera as in cameras.txt, poses in metres, corners and the board's points, in "
    "three files of a folder",
    loses="standard deviations",
    write=write_colmap_model,
    needs_corners=True,
)

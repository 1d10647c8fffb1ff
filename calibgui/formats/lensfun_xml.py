"""A lensfun database in XML with one lens, at one focal length or at those of a zoom lens.

Reader: lensfun 0.3 and later, and what it is built into (darktable, RawTherapee, digiKam). Pixels
count from 0 at the centre of the first pixel. A pixel's distance from the lens centre is measured
in half the distance between the first and the last pixel of the shorter side, and the model is
poly5,

    Rd = Ru (1 + k1 Ru^2 + k2 Ru^4),

where Ru is f tan(theta) for a rectilinear lens and f theta for one of the type fisheye. It has
square pixels, no decentering, and one centre for all focal lengths. Focal lengths are in mm on a
sensor of the crop factor; `real-focal` is the calibrated one.
Cannot hold: any other lens model, which is fitted to the camera's rays, standard deviations, poses,
corners.

The centre is the mean of the cameras' centres. A rotation makes up for most of the differences
(`compare_cameras` says why), so focal length, k1 and k2 are fitted with a rotation of the rays.
Where neither EXIF nor the user states the crop factor, the sensor of a single camera is taken for
one of 36 mm x 24 mm, or of its diagonal; for a zoom lens the nominal focal lengths say what size
fits them best.

The type decides what a photo editor does that removes only the distortion: a rectilinear lens is
straightened, a fisheye stays one. The barrel distortion of a narrow lens is that of a fisheye as
well, so that the better fit does not tell them apart. A lens of less than 100 degrees counts as
rectilinear unless that cannot follow it; beyond, it is the type of the better fit.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.dataset import UNKNOWN_HARDWARE, Hardware, Result
from calibgui.engine.arrays import Array
from calibgui.engine.camera import Camera, pixels_from_rays, rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically
from calibgui.engine.geometry import rotation_from_vector
from calibgui.engine.images import make_mesh
from calibgui.formats.camera_refit import MAX_REFIT_ERROR
from calibgui.formats.exporter import Exporter, ExportReport, describe_condition
from calibgui.formats.origin import make_mark

_NAMED = ("maker", "model", "lens", "mount", "crop")
"""What lensfun finds a lens by."""
_MODELS = {"rectilinear": "brown-conrady-4", "fisheye": "kannala-brandt"}
"""Lensfun's types of lenses, and our models of them, of which p1, p2 or k3, k4 are 0 here."""
_MAX_RECTILINEAR = math.radians(50)
"""Angle from the axis up to which a lens counts as rectilinear if that follows it: fisheye lenses
see 180 degrees across the image's diagonal, and those of cropped sensors 100."""
_MIN_UNEVENNESS = 1e-3
"""Logarithm of fx / fy from which pixels that are not square are named: 0.3 px or more at the edge
of an image of 640 pixels."""
_DIAGONAL_MM = math.hypot(36.0, 24.0)
"""Diagonal of the sensor of crop factor 1."""
_MESH_STEPS = 32
"""Number of pixels along either side of the image whose rays a camera without corners is fitted
to."""


class _Fit(NamedTuple):
    """A radial camera that follows another one."""

    camera: Camera
    error: float
    """Largest distance, px, of its pixels from the other's after a rotation; infinite if it has
    none."""


def write_lensfun(result: Result, path: Path) -> ExportReport:
    """Write the lens of one camera.

    Raises:
        CalibrationError: if lensfun's model cannot follow the lens, or the file cannot be written.
    """
    camera = result.calibration.camera
    if result.used:
        uv = np.concatenate([view.uv for view in result.observations()])
    else:
        uv = _make_mesh(camera)
    hardware = result.find_hardware()
    half_mm = _DIAGONAL_MM / 2 / math.hypot(_measure_aspect(camera), 1.0) / (hardware.crop or 1.0)
    where = "where corners were seen" if result.used else "over the whole image"
    condition = describe_condition(result)
    return _write([camera], [uv], None, half_mm, where, condition, path, hardware)


def write_lensfun_zoom(cameras: Sequence[tuple[float, Camera]], path: Path) -> ExportReport:
    """Write a zoom lens.

    Args:
        cameras: nominal focal lengths, mm, and the camera at each, of one image size.
        path: the file.

    Raises:
        CalibrationError: if lensfun's model cannot follow the lens, or the file cannot be written.
    """
    ordered = sorted(cameras, key=lambda pair: pair[0])
    nominal = [focal for focal, _ in ordered]
    listed = [camera for _, camera in ordered]
    half_mm = float(np.median([mm * _measure_half(c) / c.focal.mean() for mm, c in ordered]))
    meshes = [_make_mesh(camera) for camera in listed]
    return _write(listed, meshes, nominal, half_mm, "over the whole image", "", path)


def _write(
    cameras: Sequence[Camera],
    pixels: Sequence[Array],
    nominal: Sequence[float] | None,
    half_mm: float,
    where: str,
    condition: str,
    path: Path,
    hardware: Hardware = UNKNOWN_HARDWARE,
) -> ExportReport:
    """Fit lensfun's models to the rays of `pixels`, and write one lens with all focal lengths."""
    kind, fits = _fit_cameras(cameras, pixels, path, hardware.type)
    error = max(fit.error for fit in fits)
    note = (
        f"Lens model poly5 of a {kind} lens without decentering, fitted to the rays; differs by at "
        f"most {error:.2g} px {where}, after a rotation."
    )
    if missing := [name for name in _NAMED if getattr(hardware, name) is None]:
        note = f"{note} Not known and yours to set: {', '.join(missing)}."
    text = format_database(
        kind,
        [fit.camera for fit in fits],
        nominal,
        half_mm,
        " ".join(filter(None, [make_mark(EXPORTER.name), note, condition])),
        hardware,
    )
    write_atomically(path, text.encode())
    return ExportReport(path, note, error)


def _fit_cameras(
    cameras: Sequence[Camera], pixels: Sequence[Array], path: Path, stated: str | None
) -> tuple[str, list[_Fit]]:
    """Fit the stated type of lens to all cameras, or else that which the file's head says.

    Raises:
        CalibrationError: if none follows them.
    """
    centre = np.mean([camera.centre for camera in cameras], axis=0)
    is_narrow = all(_measure_angle(camera) < _MAX_RECTILINEAR for camera in cameras)
    tried: list[tuple[float, str, list[_Fit]]] = []
    for kind in _MODELS if stated is None else (stated,):
        fits = [
            _fit_radially(camera, uv, centre, kind)
            for camera, uv in zip(cameras, pixels, strict=True)
        ]
        tried.append((max(fit.error for fit in fits), kind, fits))
        if is_narrow and tried[-1][0] < MAX_REFIT_ERROR:
            break
    error, kind, fits = min(tried, key=lambda one: one[0])
    if not error < MAX_REFIT_ERROR:
        off = f"{error:.3g} px off" if math.isfinite(error) else "without an image of some rays"
        ratio = max((camera.focal[0] / camera.focal[1] for camera in cameras), key=_differ_from_one)
        uneven = _differ_from_one(ratio) > _MIN_UNEVENNESS
        pixels_are = f" (here fx is {ratio:.4g} times fy)" if uneven else ""
        raise CalibrationError(
            f"{path} is not written: lensfun's lens model poly5, which has square pixels"
            f"{pixels_are} and no decentering, cannot follow this lens. The nearest is {off}.",
            "Export it to another format, as gyroflow, or write undistorted images.",
        )
    return kind, fits


def _measure_angle(camera: Camera) -> float:
    """Return the largest angle from the axis of the rays of the image, rad."""
    rays = rays_from_pixels(_make_mesh(camera), camera)
    theta = np.arctan2(np.hypot(rays[:, 0], rays[:, 1]), rays[:, 2])
    return float(np.max(theta, initial=0.0, where=np.isfinite(theta)))


def _differ_from_one(ratio: float) -> float:
    return abs(math.log(ratio))


def _fit_radially(camera: Camera, uv: Array, centre: Array, kind: str) -> _Fit:
    """Fit a camera with square pixels, k1 and k2 about a centre to another camera's rays."""
    rays = rays_from_pixels(uv, camera)
    seen = np.isfinite(rays).all(axis=-1)
    rays, uv = rays[seen], uv[seen]
    theta = np.arctan2(np.hypot(rays[:, 0], rays[:, 1]), rays[:, 2])
    if kind == "rectilinear" and not np.all(theta < np.pi / 2):
        return _Fit(camera, math.inf)
    radius = np.tan(theta) if kind == "rectilinear" else theta
    distance = np.linalg.norm(uv - camera.centre, axis=-1)
    scale = np.percentile(distance, 90)
    start = float(radius @ distance / (radius @ radius))

    def make_camera(x: Array) -> Camera:
        focal = x[0] * start
        params = np.array([focal, focal, *centre, x[1], x[2], 0.0, 0.0])
        return Camera(camera.size, params, _MODELS[kind])

    def measure_miss(x: Array) -> Array:
        if x[0] <= 0:
            return np.full(uv.size, scale)
        miss = pixels_from_rays(rays @ rotation_from_vector(x[3:]).T, make_camera(x)) - uv
        return np.nan_to_num(miss, nan=scale).ravel()

    turn = np.append((centre - camera.centre)[::-1] * [-1.0, 1.0], 0.0) / start
    found = scipy.optimize.least_squares(
        measure_miss, [1.0, 0.0, 0.0, *turn], x_scale=[1, 1, 1, 0.1, 0.1, 0.1]
    )
    fitted = make_camera(found.x)
    imaged = pixels_from_rays(rays @ rotation_from_vector(found.x[3:]).T, fitted)
    error = float(np.linalg.norm(imaged - uv, axis=-1).max())
    return _Fit(fitted, error if math.isfinite(error) else math.inf)


def format_database(
    kind: str,
    cameras: Sequence[Camera],
    nominal: Sequence[float] | None,
    half_mm: float,
    note: str,
    hardware: Hardware = UNKNOWN_HARDWARE,
) -> str:
    """Return the text of the file.

    Args:
        kind: lensfun's type of the lens.
        cameras: radial cameras with one centre, by ascending focal length.
        nominal: their nominal focal lengths, mm; None to take the calibrated ones.
        half_mm: half the shorter side of the sensor, mm.
        note: the note on the file.
        hardware: the names of camera and lens.
    """
    size, half, aspect = cameras[0].size, _measure_half(cameras[0]), _measure_aspect(cameras[0])
    x, y = (cameras[0].centre - (np.array(size) - 1) / 2) / half
    crop = _DIAGONAL_MM / 2 / math.hypot(aspect, 1.0) / half_mm
    rows = []
    for k, camera in enumerate(cameras):
        real = float(camera.focal[0]) / half * half_mm
        focal = real if nominal is None else nominal[k]
        unit = half / float(camera.focal[0])
        k1, k2 = camera.coefficients[0] * unit**2, camera.coefficients[1] * unit**4
        rows.append(
            f'            <distortion model="poly5" focal="{focal:.6g}" k1="{k1:.9g}" '
            f'k2="{k2:.9g}"/>\n'
            f'            <real-focal-length focal="{focal:.6g}" real-focal="{real:.9g}"/>\n'
        )
    maker, model = (escape(name or "") for name in (hardware.maker, hardware.model))
    mount = escape(hardware.mount or "calibgui")
    lens_maker = escape(hardware.lens_maker or hardware.maker or "calibgui")
    type_line = "" if kind == "rectilinear" else f"        <type>{kind}</type>\n"
    return f"""\
<!-- {escape(note, quote=False).replace("--", "- -")} -->
<lensdatabase version="1">
    <mount>
        <name>{mount}</name>
    </mount>
    <camera>
        <maker>{maker or "calibgui"}</maker>
        <model>{model or "camera"}</model>
        <mount>{mount}</mount>
        <cropfactor>{crop:.9g}</cropfactor>
    </camera>
    <lens>
        <maker>{lens_maker}</maker>
        <model>{escape(hardware.lens or "lens")}</model>
        <mount>{mount}</mount>
{type_line}        <center x="{x:.9g}" y="{y:.9g}"/>
        <cropfactor>{crop:.9g}</cropfactor>
        <aspect-ratio>{aspect:.9g}</aspect-ratio>
        <calibration>
{"".join(rows)}        </calibration>
    </lens>
</lensdatabase>
"""


def _measure_half(camera: Camera) -> float:
    """Return half the distance between the first and the last pixel of the shorter side, px."""
    return (min(camera.size) - 1) / 2


def _measure_aspect(camera: Camera) -> float:
    """Return the longer side of the image over the shorter one, as lensfun measures both."""
    return (max(camera.size) - 1) / (min(camera.size) - 1)


def _make_mesh(camera: Camera) -> Array:
    """Return pixels (n, 2) all over the image."""
    u, v = (np.linspace(0, length - 1, _MESH_STEPS) for length in camera.size)
    return make_mesh(u, v).reshape(-1, 2)


EXPORTER = Exporter(
    name="lensfun",
    title="lensfun database",
    suffixes=(".xml",),
    models=(),
    readers="lensfun: darktable, RawTherapee, digiKam",
    keeps="focal length, centre, k1 and k2 of poly5, fitted to the rays, a zoom lens with its "
    "focal lengths, the names of camera and lens",
    loses="pixels that are not square, decentering, standard deviations, poses, corners",
    write=write_lensfun,
    fits_rays=True,
    write_zoom=write_lensfun_zoom,
)

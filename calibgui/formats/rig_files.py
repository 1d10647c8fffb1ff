"""Rigs in the files of other programs: OpenCV's stereo file, ROS's pair of files, Kalibr's chain.

opencv    cv2.FileStorage in YAML, XML or JSON, of two cameras: K1 D1 K2 D2 R T E F R1 R2 P1 P2 Q as
          cv2.stereoCalibrate and cv2.stereoRectify return them, with the images' sizes, and
          fisheye_model, 1 if D1 and D2 are those of cv2.fisheye. Lengths are mm. R1 to Q are those
          of `engine.rig.rectify_pair`.
ros       two camera_info files, NAME-<camera>.yaml, of two cameras: rectification_matrix and
          projection_matrix are those of the rectified pair, in the second's last column the
          baseline, px m, as stereo_image_proc reads it.
kalibr    camchain.yaml with all cameras in their order; T_cn_cnm1 takes points of the camera before
          to the next, m.

Pixels are OpenCV's (0-based, integer at pixel centres). Cameras of lens models that a format does
not hold are converted by their rays, and the file says by how much they differ; a pair in OpenCV's
file is of one family, perspective or fisheye. No format holds standard deviations, times or boards.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from calibgui.dataset import RigResult, StereoRectification, relate_cameras
from calibgui.engine import opencv
from calibgui.engine.arrays import Array
from calibgui.engine.camera import Camera, find_model
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically
from calibgui.engine.geometry import Pose, rotation_from_vector
from calibgui.engine.rig import StereoPair, rectify_pair
from calibgui.formats import kalibr_camchain, opencv_file, ros_yaml
from calibgui.formats.camera_conversion import convert_alike, convert_within_limit
from calibgui.formats.exporter import FRAME, Exporter
from calibgui.formats.opencv_lens import FISHEYE, list_coefficients
from calibgui.formats.origin import make_mark

_METRE = 1000.0
"""Millimetres in a metre, the unit of ROS and Kalibr."""


@dataclass(frozen=True, slots=True)
class RigExporter:
    """A file format that rigs can be written in."""

    name: str
    """Name of the format on the command line."""
    title: str
    """What is written, in words."""
    suffixes: tuple[str, ...]
    """Suffixes of its files, the usual one first."""
    list_files: Callable[[RigResult, Path, tuple[int, int]], list[Path]]
    """Function that lists the files that will be written."""
    write: Callable[[RigResult, Path, tuple[int, int]], str]
    """Function from a rig, a path and two cameras that writes the files and returns a sentence."""


def write_opencv_stereo(
    result: RigResult, path: Path, pair: tuple[int, int], zoom: float = 1.0
) -> str:
    """Write OpenCV's file of two cameras, whose rectified images have a focal length times `zoom`.

    Raises:
        CalibrationError: if no lens model of OpenCV follows both cameras, they cannot be rectified,
            or the file cannot be written.
    """
    cameras, pose = relate_cameras(result.rig, *pair)
    expressed, note = _express(cameras, opencv_file.EXPORTER, path, of_one_family=True)
    stereo = rectify_pair((expressed[0], expressed[1]), pose, zoom)
    values: dict[str, int | float | str | Array] = {
        "cameras": " ".join(result.rig.names[c] for c in pair),
        "fisheye_model": int(expressed[0].model == FISHEYE),
    }
    for number, camera in enumerate(expressed, 1):
        values |= {
            f"image_width{number}": camera.size[0],
            f"image_height{number}": camera.size[1],
            f"K{number}": camera.matrix,
            f"D{number}": list_coefficients(camera)[None],
        }
    values |= {
        "R": rotation_from_vector(pose.rvec),
        "T": pose.tvec[:, None],
        "E": stereo.essential,
        "F": stereo.fundamental,
    }
    for number in (1, 2):
        values[f"R{number}"] = stereo.rotations[number - 1]
    for number in (1, 2):
        values[f"P{number}"] = stereo.projections[number - 1]
    values["Q"] = stereo.disparity_to_depth
    comment = f"{make_mark('rig-opencv')} {note} {FRAME} Lengths are in mm."
    suffix = path.suffix.lower()
    if suffix == ".json":
        text = opencv.format_storage(suffix, {"note": comment} | values)
    else:
        text = opencv.format_storage(suffix, values, comment)
    write_atomically(path, text.encode())
    return f"Wrote {path}. {note}"


def write_ros_pair(result: RigResult, path: Path, pair: tuple[int, int]) -> str:
    """Write ROS's camera_info files of two cameras. Raises as `write_opencv_stereo`."""
    cameras, pose = relate_cameras(result.rig, *pair)
    expressed, note = _express(cameras, ros_yaml.EXPORTER, path)
    stereo = rectify_pair((expressed[0], expressed[1]), pose)
    files = _list_ros_files(result, path, pair)
    for which, (camera, file) in enumerate(zip(expressed, files, strict=True)):
        comment = f"{make_mark('rig-ros')} {note} Lengths are in m."
        name = result.rig.names[pair[which]]
        text = ros_yaml.format_camera_info(camera, name, comment, _make_ros_part(stereo, which))
        write_atomically(file, text.encode())
    return f"Wrote {' and '.join(map(str, files))}. {note}"


def _make_ros_part(stereo: StereoPair, which: int) -> StereoRectification:
    """Return the rectification of one camera, with the baseline in px m."""
    P = stereo.projections[which].copy()
    P[:, 3] /= _METRE
    return StereoRectification(stereo.rotations[which], P)


def _list_ros_files(result: RigResult, path: Path, pair: tuple[int, int]) -> list[Path]:
    names = ("".join(c if c.isalnum() else "_" for c in result.rig.names[c]) for c in pair)
    return [path.with_name(f"{path.stem}-{name}{path.suffix}") for name in names]


def write_kalibr_chain(result: RigResult, path: Path, _pair: tuple[int, int]) -> str:
    """Write Kalibr's camchain of all cameras. Raises as `write_opencv_stereo`."""
    rig = result.rig
    expressed, note = _express(rig.cameras, kalibr_camchain.EXPORTER, path)
    seen = [{view.instant for view in rig.views if view.camera == c} for c in range(len(expressed))]
    entries = [f"# {make_mark('rig-kalibr')} {note} Lengths are in m.\n# {FRAME}\n"]
    for c, camera in enumerate(expressed):
        before = None if c == 0 else _make_transform(relate_cameras(rig, c - 1, c)[1])
        seen = [
            {view.instant for view in rig.views if view.camera == k} for k in range(len(expressed))
        ]
        overlaps = [k for k in range(len(expressed)) if k != c and seen[k] & seen[c]]
        entries.append(kalibr_camchain.format_camera(camera, c, overlaps, before))
    write_atomically(path, "".join(entries).encode())
    return f"Wrote {path}. {note}"


def _make_transform(pose: Pose) -> Array:
    """Return the (4, 4) matrix of a pose, m."""
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = rotation_from_vector(pose.rvec), pose.tvec / _METRE
    return T


def _express(
    cameras: Sequence[Camera], exporter: Exporter, path: Path, of_one_family: bool = False
) -> tuple[list[Camera], str]:
    """Express cameras in lens models that a format holds; return them and a note on it."""
    is_fisheye = {camera.model == FISHEYE for camera in cameras}
    if all(map(exporter.holds, cameras)) and not (of_one_family and len(is_fisheye) > 1):
        models = ", ".join(dict.fromkeys(find_model(camera.model).title for camera in cameras))
        return list(cameras), f"Lens model {models}, as calibrated."
    if of_one_family:
        conversions = convert_alike(cameras, exporter, path)
        if len({each.camera.model == FISHEYE for each in conversions}) > 1:
            conversions = [convert_within_limit(camera, FISHEYE) for camera in cameras]
    else:
        conversions = [convert_alike([camera], exporter, path)[0] for camera in cameras]
    models = ", ".join(dict.fromkeys(find_model(c.camera.model).title for c in conversions))
    worst = max(each.largest_error for each in conversions)
    note = (
        f"Lens model {models}, converted; differs by at most {worst:.3g} px over the whole image."
    )
    return [each.camera for each in conversions], note


RIG_EXPORTERS = {
    exporter.name: exporter
    for exporter in (
        RigExporter(
            "opencv",
            "OpenCV's file of a stereo pair",
            (".yaml", ".yml", ".xml", ".json"),
            lambda _result, path, _pair: [path],
            write_opencv_stereo,
        ),
        RigExporter(
            "ros",
            "two camera_info files of ROS",
            (".yaml", ".yml"),
            _list_ros_files,
            write_ros_pair,
        ),
        RigExporter(
            "kalibr",
            "Kalibr's camchain of all cameras",
            (".yaml", ".yml"),
            lambda _result, path, _pair: [path],
            write_kalibr_chain,
        ),
    )
}
"""Formats of rigs by name."""


def find_rig_exporter(name: str, path: Path) -> RigExporter:
    """Return the format `name` after a check that its files have the suffix of `path`.

    Raises:
        CalibrationError: for an unknown format or a suffix that is not the format's.
    """
    if name not in RIG_EXPORTERS:
        raise CalibrationError(
            f"There is no format {name!r} of rigs.", f"Choose from {', '.join(RIG_EXPORTERS)}."
        )
    exporter = RIG_EXPORTERS[name]
    if path.suffix.lower() not in exporter.suffixes:
        raise CalibrationError(
            f"{path} is not named as a file of the format {name!r}.",
            f"Give it the suffix {' or '.join(exporter.suffixes)}.",
        )
    return exporter

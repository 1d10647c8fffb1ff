"""Rigs in the files of other programs: OpenCV's stereo file, ROS's pair of files, Kalibr's chain.

Those that state each camera's pose in one frame are in ``rig_arrays.py``.

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

from pathlib import Path

import numpy as np

from calibgui.dataset import RigResult, StereoRectification, relate_cameras
from calibgui.engine import opencv
from calibgui.engine.arrays import Array
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically
from calibgui.engine.geometry import Pose, rotation_from_vector
from calibgui.engine.rig import StereoPair, rectify_pair
from calibgui.formats import kalibr_camchain, opencv_file, ros_yaml
from calibgui.formats.camera_places import M_PER_MM
from calibgui.formats.exporter import FRAME
from calibgui.formats.opencv_lens import FISHEYE, list_coefficients
from calibgui.formats.origin import make_mark
from calibgui.formats.rig_arrays import ARRAY_EXPORTERS
from calibgui.formats.rig_exporter import RigExporter, express_cameras, name_file


def write_opencv_stereo(
    result: RigResult, path: Path, pair: tuple[int, int], zoom: float = 1.0
) -> str:
    """Write OpenCV's file of two cameras, whose rectified images have a focal length times `zoom`.

    Raises:
        CalibrationError: if no lens model of OpenCV follows both cameras, they cannot be rectified,
            or the file cannot be written.
    """
    cameras, pose = relate_cameras(result.rig, *pair)
    expressed, note = express_cameras(cameras, opencv_file.EXPORTER, path, of_one_family=True)
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
    expressed, note = express_cameras(cameras, ros_yaml.EXPORTER, path)
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
    P[:, 3] *= M_PER_MM
    return StereoRectification(stereo.rotations[which], P)


def _list_ros_files(result: RigResult, path: Path, pair: tuple[int, int]) -> list[Path]:
    return [name_file(path, result.rig.names[c]) for c in pair]


def write_kalibr_chain(result: RigResult, path: Path, _pair: tuple[int, int]) -> str:
    """Write Kalibr's camchain of all cameras. Raises as `write_opencv_stereo`."""
    rig = result.rig
    expressed, note = express_cameras(rig.cameras, kalibr_camchain.EXPORTER, path)
    seen = [{view.instant for view in rig.views if view.camera == c} for c in range(len(expressed))]
    entries = [f"# {make_mark('rig-kalibr')} {note} Lengths are in m.\n# {FRAME}\n"]
    for c, camera in enumerate(expressed):
        before = None if c == 0 else _make_transform(relate_cameras(rig, c - 1, c)[1])
        overlaps = [k for k in range(len(expressed)) if k != c and seen[k] & seen[c]]
        entries.append(kalibr_camchain.format_camera(camera, c, overlaps, before))
    write_atomically(path, "".join(entries).encode())
    return f"Wrote {path}. {note}"


def _make_transform(pose: Pose) -> Array:
    """Return the (4, 4) matrix of a pose, m."""
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = rotation_from_vector(pose.rvec), pose.tvec * M_PER_MM
    return T


RIG_EXPORTERS = {
    exporter.name: exporter
    for exporter in (
        RigExporter(
            "opencv",
            "OpenCV's file of a stereo pair",
            (".yaml", ".yml", ".xml", ".json"),
            "OpenCV",
            "two cameras, R and T between them, E, F, and the rectification with Q; mm",
            write_opencv_stereo,
        ),
        RigExporter(
            "ros",
            "two camera_info files of ROS",
            (".yaml", ".yml"),
            "ROS (stereo_image_proc)",
            "two cameras and their rectification, with the baseline in px m",
            write_ros_pair,
            _list_ros_files,
        ),
        RigExporter(
            "kalibr",
            "Kalibr's camchain of all cameras",
            (".yaml", ".yml"),
            "Kalibr, OpenVINS",
            "all cameras, each from the one before it; m",
            write_kalibr_chain,
        ),
        *ARRAY_EXPORTERS,
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

"""Rigs in files that state the pose of each camera in one frame, which is that of the first.

anipose     calibration.toml: `rotation` and `translation` of each camera, mm.
pose2sim    the same in metres, and without cv2.fisheye, which Pose2Sim does not know.
caliscope   camera_array.toml, m; cameras have numbers for names.
mrcal       NAME-<camera>.cameramodel for each camera, with `rt_cam_ref`, m.
colmap      rig_config.json as `colmap rig_configurator` takes it: cam_from_rig of each camera as a
            quaternion, its real part first, and metres; photographs of a scene lie in one folder
            for each camera, which is called as the camera is.
nerfstudio  transforms.json with the photographs that the rig was calibrated from: each frame has a
            camera of its own and where it was, from the board. All are OPENCV or OPENCV_FISHEYE, as
            the file names one model.

Pixels and coefficients are those of the formats of one camera (``anipose_toml.py`` and so on).
No format holds standard deviations, times or boards.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import scipy

from calibgui.dataset import RigResult
from calibgui.engine.files import write_atomically
from calibgui.engine.geometry import Pose, rotation_from_vector, vector_from_rotation
from calibgui.formats import (
    anipose_toml,
    caliscope_toml,
    colmap_cameras,
    mrcal_model,
    nerfstudio_json,
)
from calibgui.formats.camera_places import M_PER_MM, list_motion, world_from_camera_upright
from calibgui.formats.exporter import Exporter
from calibgui.formats.image_names import locate_from
from calibgui.formats.json_document import dumps
from calibgui.formats.opencv_lens import PERSPECTIVE_MODELS
from calibgui.formats.origin import make_mark
from calibgui.formats.rig_exporter import RigExporter, express_cameras, name_file

_POSE2SIM = replace(anipose_toml.EXPORTER, models=PERSPECTIVE_MODELS, refits=("brown-conrady",))
"""The format of one camera for Pose2Sim."""


def write_anipose_array(result: RigResult, path: Path, _pair: tuple[int, int]) -> str:
    """Write a calibration.toml in mm. Raises CalibrationError as all functions here: if no lens
    model of the format follows a camera, or a file cannot be written."""
    return _write_toml(result, path, "anipose", anipose_toml.EXPORTER, 1.0)


def write_pose2sim_array(result: RigResult, path: Path, _pair: tuple[int, int]) -> str:
    """Write a calibration.toml in metres."""
    return _write_toml(result, path, "pose2sim", _POSE2SIM, M_PER_MM)


def _write_toml(result: RigResult, path: Path, name: str, exporter: Exporter, scale: float) -> str:
    """Write Anipose's tables; `scale` is the length of a millimetre in the file's unit."""
    rig = result.rig
    cameras, note = express_cameras(rig.cameras, exporter, path)
    comment = f"{make_mark(f'rig-{name}')} {note} Lengths are in {'mm' if scale == 1 else 'm'}."
    poses = _scale_poses(rig.poses, scale)
    text = anipose_toml.format_calibration(cameras, comment, rig.names, poses)
    write_atomically(path, text.encode())
    return f"Wrote {path}. {note}"


def write_caliscope_array(result: RigResult, path: Path, _pair: tuple[int, int]) -> str:
    """Write a camera_array.toml."""
    rig = result.rig
    cameras, note = express_cameras(rig.cameras, caliscope_toml.EXPORTER, path)
    numbers = ", ".join(f"{c} is {name}" for c, name in enumerate(rig.names))
    comment = f"{make_mark('rig-caliscope')} {note} Lengths are in m. Camera {numbers}."
    text = caliscope_toml.format_array(cameras, comment, _scale_poses(rig.poses, M_PER_MM))
    write_atomically(path, text.encode())
    return f"Wrote {path}. {note}"


def write_mrcal_models(result: RigResult, path: Path, pair: tuple[int, int]) -> str:
    """Write a .cameramodel for each camera."""
    rig = result.rig
    cameras, note = express_cameras(rig.cameras, mrcal_model.EXPORTER, path)
    comment = f"{make_mark('rig-mrcal')} {note} Lengths are in m."
    files = _list_mrcal_files(result, path, pair)
    poses = _scale_poses(rig.poses, M_PER_MM)
    for c, (camera, pose, file) in enumerate(zip(cameras, poses, files, strict=True)):
        corners = np.concatenate([v.uv for (of, _, _), v in result.observations.items() if of == c])
        region = corners[scipy.spatial.ConvexHull(corners).vertices]
        text = mrcal_model.format_camera_model(camera, region, comment, pose)
        write_atomically(file, text.encode())
    return f"Wrote {' and '.join(map(str, files))}. {note}"


def _list_mrcal_files(result: RigResult, path: Path, _pair: tuple[int, int]) -> list[Path]:
    return [name_file(path, name) for name in result.rig.names]


def write_colmap_rig(result: RigResult, path: Path, _pair: tuple[int, int]) -> str:
    """Write a rig_config.json."""
    rig = result.rig
    cameras, note = express_cameras(rig.cameras, colmap_cameras.EXPORTER, path)
    entries: list[dict[str, object]] = []
    for camera, name, pose in zip(cameras, rig.names, rig.poses, strict=True):
        model, parameters = colmap_cameras.list_parameters(camera)
        motion = list_motion(pose)
        place = {"cam_from_rig_rotation": motion[:4], "cam_from_rig_translation": motion[4:]}
        entries.append(
            {
                "image_prefix": f"{name}/",
                **(place if entries else {"ref_sensor": True}),
                "camera_model_name": model,
                "camera_params": parameters,
            }
        )
    content = [{"note": f"{make_mark('rig-colmap')} {note}", "cameras": entries}]
    write_atomically(path, f"{dumps(content)}\n".encode())
    return (
        f"Wrote {path}. {note} Put the photographs of a scene into folders named as the cameras "
        "are, those of one instant under one name."
    )


def write_nerfstudio_frames(result: RigResult, path: Path, _pair: tuple[int, int]) -> str:
    """Write a transforms.json with a camera in each frame."""
    rig = result.rig
    exporter = nerfstudio_json.EXPORTER
    cameras, note = express_cameras(rig.cameras, exporter, path, of_one_family=True)
    boards = dict(zip(rig.instants, rig.boards, strict=True))
    # One frame for each photograph of the scene, which is what stands fast to the first board.
    seen = dict.fromkeys(
        (view.camera, view.instant)
        for view in rig.views
        if rig.placed_boards[view.board].reference == 0
    )
    frames = [
        {
            "file_path": locate_from(path.parent, result.images[camera, instant]),
            **nerfstudio_json.list_intrinsics(cameras[camera]),
            "transform_matrix": world_from_camera_upright(
                _compose(rig.poses[camera], boards[instant])
            ).tolist(),
        }
        for camera, instant in seen
    ]
    content = {
        "note": f"{make_mark('rig-nerfstudio')} {note}",
        "camera_model": nerfstudio_json.name_model(cameras[0]),
        "frames": frames,
    }
    write_atomically(path, f"{dumps(content)}\n".encode())
    return f"Wrote {path}. {note}"


def _compose(c_from_b: Pose, b_from_a: Pose) -> Pose:
    """Return the pose c_from_a."""
    R = rotation_from_vector(c_from_b.rvec)
    turn = vector_from_rotation(R @ rotation_from_vector(b_from_a.rvec))
    return Pose(turn, R @ b_from_a.tvec + c_from_b.tvec)


def _scale_poses(poses: Sequence[Pose], scale: float) -> list[Pose]:
    """Return poses with lengths in another unit."""
    return [Pose(pose.rvec, pose.tvec * scale) for pose in poses]


ARRAY_EXPORTERS = (
    RigExporter(
        "anipose",
        "Anipose's calibration of all cameras",
        (".toml",),
        "Anipose, FreeMoCap",
        "all cameras in the frame of the first; mm",
        write_anipose_array,
    ),
    RigExporter(
        "pose2sim",
        "Pose2Sim's calibration of all cameras",
        (".toml",),
        "Pose2Sim",
        "all cameras, none as a fisheye, in the frame of the first; m",
        write_pose2sim_array,
    ),
    RigExporter(
        "caliscope",
        "caliscope's camera array",
        (".toml",),
        "caliscope",
        "all cameras by numbers in the frame of the first; m",
        write_caliscope_array,
    ),
    RigExporter(
        "mrcal",
        "camera models of mrcal, one for each camera",
        (".cameramodel",),
        "mrcal",
        "all cameras in the frame of the first, and where corners were seen; m",
        write_mrcal_models,
        _list_mrcal_files,
    ),
    RigExporter(
        "colmap",
        "COLMAP's rig_config.json",
        (".json",),
        "COLMAP 3.12 and later (rig_configurator), pycolmap",
        "all cameras in the frame of the first; m",
        write_colmap_rig,
    ),
    RigExporter(
        "nerfstudio",
        "nerfstudio's transforms.json of all photographs",
        (".json",),
        "nerfstudio",
        "a camera in each frame, all perspective or all fisheye, and where it was from the board; "
        "m",
        write_nerfstudio_frames,
    ),
)
"""Formats of rigs whose cameras have one frame."""

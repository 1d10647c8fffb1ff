"""Every reader of the project, with a sound file of each format that it reads.

A format of cameras is found by itself: by the golden file that its importer reads. Of all others
`find_readers` names the function, and ``test_readers.py`` fails on a reader that is not among them.
"""

from __future__ import annotations

import contextlib
import io
import os
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import scipy

from calibgui.app.calibrating.series import Scalar, read_series
from calibgui.app.calibrating.settings import Settings
from calibgui.app.fleet.manifest import BoardSought, read_manifest
from calibgui.app.photographs.regions import read_regions
from calibgui.app.photographs.videos import sample_video
from calibgui.app.projects.autosave import read_unsaved_work
from calibgui.app.projects.project_file import encode_project, read_project
from calibgui.app.projects.recent import list_recent
from calibgui.app.system.state_folder import find_state_folder
from calibgui.engine import opencv
from calibgui.engine.boards import BoardShape, BoardShapeModel
from calibgui.engine.camera import Camera, pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import is_video, read_image, read_image_header, read_small_image
from calibgui.formats import IMPORTERS, read_camera
from calibgui.formats.board_poses_json import read_board_poses
from calibgui.formats.board_shape_json import read_board_shape, write_board_shape
from calibgui.formats.bouguet_results import pack_results
from calibgui.formats.camera_import import read_result_file
from calibgui.formats.circle_list import read_circle_list
from calibgui.formats.colmap_cameras import pack_cameras
from calibgui.formats.corner_import import read_corner_file
from calibgui.formats.corners_json import encode_corners, read_corners
from calibgui.formats.detections_json import read_detections, write_detections
from calibgui.formats.json_document import dumps
from calibgui.formats.limits_toml import read_limits
from calibgui.formats.matlab_script import format_script
from calibgui.formats.mrcal_model import format_camera_model
from calibgui.formats.points_csv import read_points
from calibgui.formats.poses_json import read_pose
from calibgui.formats.resampled_json import read_resampled
from calibgui.formats.result_json import encode_result
from calibgui.formats.rig_json import read_rig, write_rig
from calibgui.formats.robot_poses import read_robot_poses
from calibgui.formats.space_points_csv import read_seen_points
from calibgui.formats.times_csv import read_times
from tests.formats.cameras import example, splined
from tests.formats.rigs import make_result as make_rig_result

GOLDEN = Path(__file__).parents[2] / "golden"
_CAMERAS = {"gyroflow.json": "24"}
"""Names of the cameras that are read of files that hold several."""
_RAY = np.array([[0.1, 0.05, 1.0]])
_POSES = {"a.png": {"rvec": [0.1, 0.2, 0.3], "tvec": [1.0, 2.0, 3.0]}}
_PINHOLE = Camera((640, 480), np.array([600.0, 600.0, 320.0, 240.0]), "pinhole")
_LOCATED = {
    "format": "calibgui-poses",
    "version": 1,
    "camera": {
        "model": _PINHOLE.model,
        "size": _PINHOLE.size,
        "params": dict(zip(_PINHOLE.names, _PINHOLE.params.tolist(), strict=True)),
    },
    "views": [
        {
            "image": "a.png",
            "noise_px": 0.1,
            "rvec": [0.1, 0.2, 0.3],
            "tvec_mm": [1.0, 2.0, 3.0],
            "pose_covariance": np.eye(6).tolist(),
            "pose_covariance_by_noise": np.eye(6).tolist(),
            "pose_by_camera": np.ones((6, 4)).tolist(),
            "mirrored_worse_by_sigmas": None,
        }
    ],
}
_PIXELS = "name,u,v,sigma_px\na,320.5,240,0.1\nb,100,17.25,0.2\n"
_SEEN = "point,camera,u,v\nA,cam0,320.5,240\nA,cam1,100,17.25\n"
_MESSAGE = """\
header: {stamp: {sec: 1, nanosec: 0}, frame_id: a}
height: 480
width: 640
distortion_model: plumb_bob
d: [-0.3, 0.1, 0.001, 0.0, 0.0]
k: [500.0, 0.0, 320.0, 0.0, 500.0, 240.0, 0.0, 0.0, 1.0]
r: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
p: [480.0, 0.0, 320.0, 0.0, 0.0, 480.0, 240.0, 0.0, 0.0, 0.0, 1.0, 0.0]
binning_x: 0
binning_y: 0
roi: {x_offset: 0, y_offset: 0, height: 0, width: 0, do_rectify: false}
---
"""
_PHOTONVISION = {
    "resolution": {"width": 640.0, "height": 480.0},
    "cameraIntrinsics": {
        "rows": 3,
        "cols": 3,
        "type": 6,
        "data": [600, 0, 320, 0, 600, 240, 0, 0, 1],
    },
    "distCoeffs": {"rows": 1, "cols": 5, "type": 6, "data": [0.1, -0.2, 0.001, 0.002, 0.05]},
    "lensmodel": "LENSMODEL_OPENCV",
}
_VNL = "# filename x y level\n" + "".join(
    f"{image} {10.5 + 50 * k} {20.25 + 40 * j} {(j + k) % 3}\n"
    for image in ("a.png", "b.png")
    for j in range(3)
    for k in range(4)
)
_CAMERAS_BIN = pack_cameras(example("rational"), "A note.")
_PLACES = np.array([[0.0, 30, 0, 30], [0, 0, 30, 30], [0, 0, 0, 0]])
_CALIB_RESULTS = pack_results(
    {
        "fc": np.array([[600.0], [601.0]]),
        "cc": np.array([[320.0], [240.0]]),
        "alpha_c": np.zeros((1, 1)),
        "kc": np.array([[-0.2], [0.1], [1e-3], [2e-3], [0.0]]),
        "nx": np.array([[640.0]]),
        "ny": np.array([[480.0]]),
        "active_images": np.ones((1, 2)),
        "x_1": 100 + 2 * _PLACES[:2],
        "X_1": _PLACES,
        "x_2": 150 + 3 * _PLACES[:2],
        "X_2": _PLACES,
    },
    "A note.",
)
_REGIONS = {"a.png": [[0, 0], [90, 0], [90, 90], [0, 90]]}
_RESAMPLED = {
    "format": "calibgui-resampled",
    "version": 1,
    "written": {"a.png": "ab" * 32, "b.png": None},
    "kind": "undistorted",
    "size": [640, 480],
    "matrix": [[600, 0, 320], [0, 600, 240], [0, 0, 1]],
}
_LIMITS = "largest_edge_error_px = 0.5\nfewest_views = 8\nleast_coverage = 0.3\n"
_MANIFEST = (
    "id,paths,board,model,serial,date,temperature\n"
    "a,photographs,charuco 5x7 30mm,auto,7,2026-03-01,21.5\n"
    'b,"c;d",9x6 25mm,brown-conrady,8,2026-03-02T08:30,\n'
)


@dataclass(frozen=True, slots=True)
class Reader:
    """A reader, and a sound file for it."""

    name: str
    """Name of the format in the campaign's table."""
    file: str
    """Name of the file."""
    sample: bytes
    """Content of a sound file."""
    read: Callable[[Path], object]
    """The function that reads the file, and does with the content what is usually done next."""
    functions: tuple[str, ...] = ()
    """Names of the functions by which it is read."""
    tells: bool = True
    """False if a file that cannot be read is taken for none, as the program's own notes are."""


def find_readers(folder: Path) -> dict[str, Reader]:
    """Return all readers by their names; what has to be written for samples goes to `folder`."""
    readers = [
        *_find_camera_readers(),
        *_list_calibration_readers(folder),
        *_list_other_readers(folder),
        *_list_image_readers(folder),
    ]
    return {reader.name: reader for reader in readers}


def _find_camera_readers() -> list[Reader]:
    """Return a reader for each golden file that a camera is read from, and for some of further
    languages and lenses."""
    samples = {path.name: path.read_bytes() for path in sorted(GOLDEN.iterdir())}
    K, D = np.array([[600.0, 0, 320], [0, 600, 240], [0, 0, 1]]), np.zeros((1, 5))
    values = {"image_width": 640, "image_height": 480, "camera_matrix": K}
    for suffix in (".yaml", ".json"):
        text = opencv.format_storage(suffix, values | {"distortion_coefficients": D})
        samples[f"opencv{suffix}"] = text.encode()
    samples["fisheye.m"] = format_script(example("scaramuzza"), "A fisheye.").encode()
    region = np.array([[0.0, 0.0], [639.0, 0.0], [639.0, 479.0]])
    text = format_camera_model(splined(), region, "A splined model.")
    samples["splined.cameramodel"] = text.encode()
    samples["message.yaml"] = _MESSAGE.encode()
    samples["photonvision.json"] = _encode(_PHOTONVISION)
    readers = []
    for file, sample in samples.items():
        text = sample.decode()
        importer = next((one for one in IMPORTERS if one.signature.search(text)), None)
        if importer is not None and not file.startswith("project"):
            name = f"{importer.title}, {file}"
            readers.append(Reader(name, file, sample, _use_camera, ("read_camera",)))
    for file, sample in {"cameras.bin": _CAMERAS_BIN, "Calib_Results.mat": _CALIB_RESULTS}.items():
        readers.append(Reader(f"camera, {file}", file, sample, _use_camera, ("read_camera",)))
    return readers


def _use_camera(file: Path) -> object:
    return pixels_from_rays(_RAY, read_camera(file, _CAMERAS.get(file.name)).camera)


def _list_calibration_readers(folder: Path) -> list[Reader]:
    result = (GOLDEN / "result-1.json").read_bytes()
    project = (GOLDEN / "project-3.json").read_bytes()
    corners = (GOLDEN / "corners.json").read_bytes()
    table = b"file,value\nresult.json,35.5\n"
    (folder / "series").mkdir(exist_ok=True)
    (folder / "series" / "result.json").write_bytes(result)

    def read_table(file: Path) -> object:
        return read_series([folder / "series" / "result.json"], Scalar.ZOOM, file)

    def read_points_beside(file: Path) -> object:
        (file.parent / "data1.txt").write_text("9 8 40 9 41 40 9 41\n70 9 99 9 98 41 71 40\n")
        return dumps(encode_corners(read_corner_file(file, size=(640, 480))))

    return [
        Reader(
            "result",
            "result.json",
            result,
            lambda file: dumps(encode_result(read_result_file(file))),
            ("read_result_file", "read_result"),
        ),
        Reader(
            "corners",
            "corners.json",
            corners,
            lambda file: dumps(encode_corners(read_corners(file))),
            ("read_corners", "read_corner_file", "decode_corners"),
        ),
        Reader(
            "corners of mrcal",
            "corners.vnl",
            _VNL.encode(),
            lambda file: dumps(encode_corners(read_corner_file(file, (3, 4), 25.0, (640, 480)))),
            ("read_corner_file", "read_corners_vnl"),
        ),
        Reader(
            "corners of Bouguet",
            "Calib_Results.mat",
            _CALIB_RESULTS,
            lambda file: dumps(encode_corners(read_corner_file(file))),
            ("read_corner_file", "read_bouguet_corners"),
        ),
        Reader(
            "corners of OpenCV",
            "corners.yml",
            opencv.format_storage(
                ".yml",
                {
                    "image_width": 640,
                    "image_height": 480,
                    "board_width": 4,
                    "board_height": 3,
                    "image_points": np.arange(48.0).reshape(2, 24),
                },
            ).encode(),
            lambda file: dumps(encode_corners(read_corner_file(file))),
            ("read_corner_file", "read_opencv_corners"),
        ),
        Reader(
            "corners of Zhang",
            "Model.txt",
            b"0 0 30 0 30 30 0 30\n60 0 90 0 90 30 60 30\n",
            read_points_beside,
            ("read_corner_file", "read_zhang_corners"),
        ),
        Reader(
            "table of corners",
            "corners.csv",
            (GOLDEN / "corners.csv").read_bytes(),
            lambda file: dumps(encode_corners(read_corner_file(file, size=(640, 480)))),
            ("read_corner_file", "read_corners_csv"),
        ),
        Reader(
            "project",
            "project.json",
            project,
            lambda file: dumps(encode_project(read_project(file), file.parent)),
            ("read_project",),
        ),
        Reader(
            "autosave",
            ".project.json.autosave",
            project,
            lambda file: read_unsaved_work(file, file.parent / "project.json"),
            ("read_unsaved_work",),
        ),
        Reader("series", "series.csv", table, read_table, ("read_series", "read_csv_rows")),
    ]


def _list_other_readers(folder: Path) -> list[Reader]:
    nominal = np.array([[0.0, 0.0], [30.0, 0.0], [0.0, 30.0]])
    shape = BoardShape(BoardShapeModel.FREE, nominal, np.full((3, 3), 0.1), np.full((3, 3), 0.01))
    write_board_shape(shape, folder / "shape")
    views = read_corners(GOLDEN / "corners.json").views
    write_detections({"ab" * 32: views[0]}, folder / "detections")

    def read_recent(file: Path) -> object:
        os.environ["XDG_STATE_HOME"] = str(file.parent)  # on Linux: where the worker runs
        notes = find_state_folder() / "recent.json"
        notes.unlink(missing_ok=True)
        with contextlib.suppress(FileNotFoundError):
            file.rename(notes)
        return list_recent()

    def read_fleet(file: Path) -> object:
        return read_manifest(file, BoardSought(30.0), Settings())

    write_rig(make_rig_result(), folder / "rig")
    return [
        Reader(
            "board shape",
            "board-shape.json",
            (folder / "shape").read_bytes(),
            read_board_shape,
            ("read_board_shape",),
        ),
        Reader(
            "board poses", "poses.json", _encode(_POSES), read_board_poses, ("read_board_poses",)
        ),
        Reader(
            "pose of a photograph",
            "poses.json",
            _encode(_LOCATED),
            lambda file: read_pose(file, _PINHOLE, "a.png"),
            ("read_pose",),
        ),
        *(
            Reader(f"robot's poses, {file}", file, sample, read_robot_poses, ("read_robot_poses",))
            for file, sample in _list_robot_poses()
        ),
        Reader(
            "circle list",
            "circles.csv",
            b"x,y\n0,0\n20,0\n10,17\n30,17\n",
            read_circle_list,
            ("read_circle_list",),
        ),
        Reader("pixels", "points.csv", _PIXELS.encode(), read_points, ("read_points",)),
        Reader("rig", "rig.json", (folder / "rig").read_bytes(), read_rig, ("read_rig",)),
        Reader(
            "points in cameras",
            "seen.csv",
            _SEEN.encode(),
            lambda file: read_seen_points(file, make_rig_result()),
            ("read_seen_points",),
        ),
        Reader(
            "times of photographs",
            "times.csv",
            b"camera,number,time_s\nleft,1,0.1\nright,1,0.11\n",
            lambda file: read_times(file, {c: [Path(f"{c}1.png")] for c in ("left", "right")}),
            ("read_times",),
        ),
        Reader(
            "regions",
            "regions.json",
            _encode(_REGIONS),
            lambda file: read_regions(file, [Path("a.png")]),
            ("read_regions",),
        ),
        Reader("limits", "limits.toml", _LIMITS.encode(), read_limits, ("read_limits",)),
        Reader("manifest", "fleet.csv", _MANIFEST.encode(), read_fleet, ("read_manifest",)),
        Reader(
            "resampled",
            "resampled.json",
            _encode(_RESAMPLED),
            read_resampled,
            ("read_resampled",),
            tells=False,
        ),
        Reader(
            "detections",
            "detections.json",
            (folder / "detections").read_bytes(),
            read_detections,
            ("read_detections",),
            tells=False,
        ),
        Reader(
            "recent projects",
            "notes.json",
            _encode([{"path": str(folder), "image": "a.png"}]),
            read_recent,
            ("list_recent",),
            tells=False,
        ),
    ]


def _list_robot_poses() -> list[tuple[str, bytes]]:
    """List files of a robot's poses in each language, with their names."""
    rows = np.arange(18.0).reshape(3, 6) / 8
    mat = io.BytesIO()
    scipy.io.savemat(mat, {"poses": rows})
    lines = [f"{k}.png,{','.join(map(str, row))}" for k, row in enumerate(rows.tolist())]
    named = {"a.png": {"tvec": [1, 2, 3], "rvec": [0.1, 0.2, 0.3]}, "b.png": [1, 2, 3, 4, 5, 6]}
    return [
        ("robot.csv", "\n".join(["image,x,y,z,a,b,c", *lines]).encode()),
        ("robot.json", _encode(named)),
        ("robot.mat", mat.getvalue()),
    ]


def _list_image_readers(folder: Path) -> list[Reader]:
    pixels = np.random.default_rng(0).integers(0, 256, (60, 80)).astype(np.uint8)
    video = folder / "video.avi"
    writer = cv2.VideoWriter(str(video), cv2.VideoWriter_fourcc(*"MJPG"), 10, (80, 60))
    for k in range(5):
        writer.write(np.roll(np.dstack([pixels] * 3), 5 * k, axis=1))
    writer.release()

    def take_frames(file: Path) -> object:
        if not is_video(file):
            raise CalibrationError(f"{file} is no video.")
        with tempfile.TemporaryDirectory() as place:
            return sample_video(file, Path(place), 3, lambda *_: None)

    readers = [
        Reader("video (avi)", video.name, video.read_bytes(), take_frames, ("decode_video",))
    ]
    for suffix in (".png", ".jpg", ".tif"):
        file = folder / f"a{suffix}"
        file.write_bytes(opencv.encode_image(suffix, pixels) or b"")
        readers.append(
            Reader(
                f"photograph ({suffix[1:]})",
                file.name,
                file.read_bytes(),
                lambda path: (read_image_header(path), read_small_image(path, 1), read_image(path)),
                ("read_image", "read_image_header", "read_small_image"),
            )
        )
    return readers


def _encode(content: Mapping[str, object] | list[object]) -> bytes:
    return dumps(content).encode()

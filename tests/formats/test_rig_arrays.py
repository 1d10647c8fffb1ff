"""Rigs whose cameras have one frame project to the same pixels in the programs that read them.

Where a program cannot be installed beside numpy (nerfstudio wants PyTorch) the documented meaning
of its file's entries is computed here.
"""

from __future__ import annotations

import json
from pathlib import Path

import cv2
import numpy as np
import pytest

from calibgui.engine.camera import Camera
from calibgui.formats.anipose_toml import format_calibration
from calibgui.formats.camera_places import WORLD
from calibgui.formats.rig_files import RIG_EXPORTERS
from tests.formats.readers import in_other_python
from tests.formats.rigs import make_result, make_result_of_boards
from tests.formats.test_rig_files import BROWN, FISHEYE, POINTS, SECOND_BROWN, see

_ANIPOSE = """
import json, sys
import numpy as np
from aniposelib.cameras import CameraGroup

group = CameraGroup.load(sys.argv[1])
seen = group.project(np.array(json.loads(sys.argv[2])))
print(json.dumps({"seen": seen.tolist(), "names": group.get_names()}))
"""
_POSE2SIM = """
import json, sys
from pathlib import Path
import cv2
import numpy as np
from Pose2Sim.common import retrieve_calib_params

read = retrieve_calib_params(Path(sys.argv[1]))
points = np.array(json.loads(sys.argv[2])) / 1000
seen = [cv2.projectPoints(points, *each)[0][:, 0].tolist()
        for each in zip(read["R"], read["T"], read["K"], read["dist"])]
print(json.dumps({"seen": seen}))
"""
_CALISCOPE = """
import json, sys
import cv2
import numpy as np
from caliscope.cameras.camera_array import CameraArray

points = np.array(json.loads(sys.argv[2]))[:, None] / 1000
seen = []
for _, camera in sorted(CameraArray.from_toml(sys.argv[1]).cameras.items()):
    project = cv2.fisheye.projectPoints if camera.fisheye else cv2.projectPoints
    turn = cv2.Rodrigues(camera.rotation)[0]
    uv = project(points, turn, camera.translation, camera.matrix, camera.distortions)[0]
    seen.append(uv.reshape(-1, 2).tolist())
print(json.dumps({"seen": seen}))
"""
_MRCAL = """
import json, sys
import mrcal
import numpy as np

points, seen = np.array(json.loads(sys.argv[1])) / 1000, []
for name in sys.argv[2:]:
    model = mrcal.cameramodel(name)
    ahead = mrcal.transform_point_rt(model.extrinsics_rt_fromref(), points)
    seen.append(mrcal.project(ahead, *model.intrinsics()).tolist())
print(json.dumps({"seen": seen}))
"""
_COLMAP = """
import json, sys
import numpy as np
import pycolmap

(rig,) = pycolmap.read_rig_config(sys.argv[1])
points, seen = np.array(json.loads(sys.argv[2])) / 1000, []
for each in rig.cameras:
    ahead = points if each.ref_sensor else np.array([each.cam_from_rig * X for X in points])
    seen.append(np.array([each.camera.img_from_cam(X) for X in ahead]).reshape(-1, 2).tolist())
print(json.dumps({"seen": seen, "names": [each.image_prefix for each in rig.cameras]}))
"""
_READERS = {
    "anipose": (_ANIPOSE, "import aniposelib", ".toml"),
    "pose2sim": (_POSE2SIM, "from Pose2Sim.common import retrieve_calib_params", ".toml"),
    "caliscope": (
        _CALISCOPE,
        "from caliscope.cameras.camera_array import CameraArray",
        ".toml",
    ),
    "colmap": (_COLMAP, "import pycolmap", ".json"),
}


@pytest.mark.parametrize("name", _READERS)
def test_its_reader_projects_to_our_pixels(tmp_path: Path, name: str) -> None:
    result = make_result(BROWN, FISHEYE if name != "pose2sim" else SECOND_BROWN, count=2)
    script, needs, suffix = _READERS[name]
    path = tmp_path / f"rig{suffix}"
    assert "as calibrated" in RIG_EXPORTERS[name].write(result, path, (0, 1))
    read = in_other_python(script, path, POINTS.tolist(), needs=needs)
    shift = 0.5 if name == "colmap" else 0.0
    for c, seen in enumerate(read["seen"]):
        np.testing.assert_allclose(np.array(seen) - shift, see(result, c), atol=1e-6)
    assert read.get("names") in (None, ["cam0", "cam1"], ["cam0/", "cam1/"])


def test_mrcal_projects_to_our_pixels(tmp_path: Path) -> None:
    result = make_result(BROWN, SECOND_BROWN, count=2)
    exporter = RIG_EXPORTERS["mrcal"]
    files = exporter.list_files(result, tmp_path / "rig.cameramodel", (0, 1))
    exporter.write(result, tmp_path / "rig.cameramodel", (0, 1))
    assert [file.name for file in files] == ["rig-cam0.cameramodel", "rig-cam1.cameramodel"]
    read = in_other_python(_MRCAL, POINTS.tolist(), *files, needs="import mrcal")
    for c, seen in enumerate(read["seen"]):
        np.testing.assert_allclose(seen, see(result, c), atol=1e-6)


@pytest.mark.parametrize("lens", [BROWN, FISHEYE])
def test_frames_of_nerfstudio_see_the_board_where_we_do(tmp_path: Path, lens: Camera) -> None:
    result = make_result(lens, count=2)
    path = tmp_path / "transforms.json"
    RIG_EXPORTERS["nerfstudio"].write(result, path, (0, 1))
    content = json.loads(path.read_text())
    project = cv2.fisheye.projectPoints if lens is FISHEYE else cv2.projectPoints
    assert content["camera_model"] == ("OPENCV_FISHEYE" if lens is FISHEYE else "OPENCV")
    assert len(content["frames"]) == len(result.rig.views)
    names = ("k1", "k2", "k3", "k4") if lens is FISHEYE else ("k1", "k2", "p1", "p2", "k3")
    flip = np.diag([1.0, -1.0, -1.0, 1.0])
    for frame, view in zip(content["frames"], result.rig.views, strict=True):
        observation = result.observations[view.camera, view.board, view.instant]
        assert frame["file_path"] == result.images[view.camera, view.instant]
        camera_from_board = flip @ np.linalg.inv(frame["transform_matrix"]) @ flip
        board = np.pad(observation.xy / 1000, ((0, 0), (0, 1)))
        X = board @ camera_from_board[:3, :3].T + camera_from_board[:3, 3]
        K = np.array([[frame["fl_x"], 0, frame["cx"]], [0, frame["fl_y"], frame["cy"]], [0, 0, 1]])
        D = np.array([frame[key] for key in names])
        uv = project(X[:, None], np.zeros(3), np.zeros(3), K, D)[0][:, 0] - 0.5
        np.testing.assert_allclose(uv, observation.uv - view.residuals, atol=1e-6)


def test_frames_of_nerfstudio_are_photographs_of_all_boards(tmp_path: Path) -> None:
    result = make_result_of_boards()
    RIG_EXPORTERS["nerfstudio"].write(result, tmp_path / "transforms.json", (0, 1))
    frames = json.loads((tmp_path / "transforms.json").read_text())["frames"]
    files = [frame["file_path"] for frame in frames]
    assert len(set(files)) == len(files) < len(result.rig.views)
    assert set(files) == set(result.images.values())


def test_tables_of_ten_cameras_keep_their_order() -> None:
    names = [f"camera {c}" for c in range(11)]
    text = format_calibration([BROWN] * 11, "", names, [WORLD] * 11)
    tables = [line for line in text.splitlines() if line.startswith("[cam_")]
    assert tables == sorted(tables) and tables[10] == "[cam_10]"

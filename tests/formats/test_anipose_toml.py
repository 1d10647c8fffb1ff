"""Cameras in TOML, read by aniposelib, Pose2Sim and caliscope where they are installed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from calibgui.dataset import Result
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.formats import export, read_camera
from calibgui.formats.anipose_toml import EXPORTER
from calibgui.formats.opencv_lens import FISHEYE
from tests.formats.cameras import example, holding
from tests.formats.readers import RAYS, in_other_python

_ANIPOSE = """
import json, sys
import numpy as np
from aniposelib.cameras import CameraGroup

group = CameraGroup.load(sys.argv[1])
(seen,) = group.project(np.array(json.loads(sys.argv[2])))
print(json.dumps({"seen": seen.tolist(), "size": [int(n) for n in group.cameras[0].get_size()]}))
"""
_CALISCOPE = """
import json, sys
import cv2
import numpy as np
from caliscope.cameras.camera_array import CameraArray

(camera,) = CameraArray.from_toml(sys.argv[1]).cameras.values()
project = cv2.fisheye.projectPoints if camera.fisheye else cv2.projectPoints
points = np.array(json.loads(sys.argv[2]))[:, None]
turn = cv2.Rodrigues(camera.rotation)[0]
seen = project(points, turn, camera.translation, camera.matrix, camera.distortions)[0]
print(json.dumps({"seen": seen.reshape(-1, 2).tolist(), "size": list(camera.size)}))
"""
_POSE2SIM = """
import json, sys
from pathlib import Path
import cv2
import numpy as np
from Pose2Sim.common import retrieve_calib_params

read = retrieve_calib_params(Path(sys.argv[1]))
points = np.array(json.loads(sys.argv[2]))
seen = cv2.projectPoints(points, read["R"][0], read["T"][0], read["K"][0], read["dist"][0])[0]
print(json.dumps({"seen": seen.reshape(-1, 2).tolist(), "size": read["S"][0].tolist()}))
"""
_READERS = {
    "anipose": (_ANIPOSE, "import aniposelib"),
    "caliscope": (_CALISCOPE, "from caliscope.cameras.camera_array import CameraArray"),
}


@pytest.mark.parametrize("name", _READERS)
@pytest.mark.parametrize("model", EXPORTER.models)
def test_its_reader_projects_each_model_to_our_pixels(
    tmp_path: Path, result: Result, name: str, model: str
) -> None:
    camera = example(model)
    path = export(holding(result, camera), name, tmp_path / "camera.toml").path
    script, needs = _READERS[name]
    read = in_other_python(script, path, RAYS.tolist(), needs=needs)
    assert tuple(read["size"]) == camera.size
    assert np.abs(np.array(read["seen"]) - pixels_from_rays(RAYS, camera)).max() < 1e-9


def test_pose2sim_projects_to_our_pixels(tmp_path: Path, result: Result) -> None:
    camera = example("brown-conrady")
    path = export(holding(result, camera), "anipose", tmp_path / "Calib.toml").path
    needs = "from Pose2Sim.common import retrieve_calib_params"
    read = in_other_python(_POSE2SIM, path, RAYS.tolist(), needs=needs)
    assert tuple(read["size"]) == camera.size
    assert np.abs(np.array(read["seen"]) - pixels_from_rays(RAYS, camera)).max() < 1e-9


_ENTRIES = """
size = [640, 480]
matrix = [[600.0, 0.0, 320.0], [0.0, 600.0, 240.0], [0.0, 0.0, 1.0]]
distortions = {}
fisheye = {}
"""


@pytest.mark.parametrize("head", ["cam_{}", "cameras.{}"])
def test_a_camera_of_several_is_chosen_by_its_name(tmp_path: Path, head: str) -> None:
    file = tmp_path / "cameras.toml"
    tables = [
        f"[{head.format(0)}]{_ENTRIES.format([0.1, 0.2, 0.3, 0.4, 0.5], 'false')}",
        f"[{head.format(1)}]{_ENTRIES.format([0.01, 0.0, 0.0, 0.0], 'true')}",
    ]
    file.write_text("".join(tables) + "[metadata]\nadjusted = true\n")
    names = [head.format(k).removeprefix("cameras.") for k in (0, 1)]
    with pytest.raises(CalibrationError, match="holds 2 cameras"):
        read_camera(file)
    assert [read_camera(file, name).camera.model for name in names] == ["brown-conrady", FISHEYE]
    assert "of 2" in read_camera(file, names[0]).notes[0]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (f"[cam_0]{_ENTRIES.format([0.1], 'false')}", "has 1 coefficient"),
        (f"[cam_0]{_ENTRIES.format([0.1] * 5, 'true')}", "fisheye model has 4"),
        (f"[cam_0]{_ENTRIES.format([0.1] * 4, '3')}", "fisheye is not true or false"),
        ("[cam_0]\ndistortions = [0.0, 0.0, 0.0, 0.0]\n", "size is missing"),
        ("[cam_0\ndistortions = [0.0]\n", "is not a TOML file"),
    ],
)
def test_errors_name_file_and_fault(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "camera.toml"
    file.write_text(text)
    with pytest.raises(CalibrationError, match=message) as caught:
        read_camera(file)
    assert str(file) in caught.value.message

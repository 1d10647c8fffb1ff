"""COLMAP's cameras.txt, read by pycolmap where it is installed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from calibgui.dataset import Result
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.formats import read_camera
from calibgui.formats.camera_refit import express_in_format
from calibgui.formats.colmap_cameras import EXPORTER, write_colmap
from calibgui.formats.origin import make_mark
from tests.formats.cameras import PERSPECTIVE, WIDE_RAYS, example, holding
from tests.formats.readers import RAYS, in_other_python

_COLMAP = """
import json, sys
from pathlib import Path
import numpy as np
import pycolmap

folder = Path(sys.argv[1])
for name in ("images.txt", "points3D.txt"):
    (folder / name).write_text("")
model = pycolmap.Reconstruction()
model.read_text(folder)
print(json.dumps([{
    "size": [camera.width, camera.height],
    "model": camera.model_name,
    "seen": np.asarray(camera.img_from_cam(np.array(json.loads(sys.argv[2])))).tolist(),
} for _, camera in sorted(model.cameras.items())]))
"""


def test_half_a_pixel_is_added(tmp_path: Path, result: Result) -> None:
    """Whoever reads it: the first pixel's corner is COLMAP's origin."""
    report = write_colmap(result, tmp_path / "cameras.txt")
    first, *_, last = (tmp_path / "cameras.txt").read_text().splitlines()
    assert first == f"# {make_mark('colmap')} {report.note}"
    number, model, width, height, *values = last.split()
    camera = express_in_format(result, EXPORTER).calibration.camera
    assert (number, model, int(width), int(height)) == ("1", "FULL_OPENCV", *camera.size)
    fx, fy, cx, cy, *lens = map(float, values)
    assert np.array_equal([fx, fy, cx - 0.5, cy - 0.5], camera.params[:4])
    assert np.array_equal(lens, [*camera.coefficients[:5], 0.0, 0.0, 0.0])


def test_colmap_projects_what_it_reads_to_our_pixels(tmp_path: Path, result: Result) -> None:
    write_colmap(result, tmp_path / "cameras.txt")
    (read,) = in_other_python(_COLMAP, tmp_path, RAYS.tolist(), needs="import pycolmap")
    camera = express_in_format(result, EXPORTER).calibration.camera
    assert (tuple(read["size"]), read["model"]) == (camera.size, "FULL_OPENCV")
    ours = pixels_from_rays(RAYS, camera)
    assert np.abs(np.array(read["seen"]) - 0.5 - ours).max() < 1e-9


def test_colmap_projects_each_model_to_our_pixels(tmp_path: Path, result: Result) -> None:
    cameras = [example(model) for model in EXPORTER.models]
    lines = []
    for number, camera in enumerate(cameras):
        write_colmap(holding(result, camera), tmp_path / "cameras.txt")
        lines.append(f"{number}{(tmp_path / 'cameras.txt').read_text().splitlines()[-1][1:]}\n")
    (tmp_path / "cameras.txt").write_text("".join(lines))
    read = in_other_python(_COLMAP, tmp_path, WIDE_RAYS.tolist(), needs="import pycolmap")
    for camera, theirs in zip(cameras, read, strict=True):
        assert tuple(theirs["size"]) == camera.size
        limit = np.cos(np.deg2rad(45)) if camera.model in PERSPECTIVE else 0.0
        inside = WIDE_RAYS[:, 2] > limit * np.linalg.norm(WIDE_RAYS, axis=1)
        ours = pixels_from_rays(WIDE_RAYS[inside], camera)
        assert np.abs(np.array(theirs["seen"])[inside] - 0.5 - ours).max() < 1e-9


_LINES = {
    "SIMPLE_PINHOLE": "300.5 320.25 240.5",
    "PINHOLE": "300.5 310 320.25 240.5",
    "SIMPLE_RADIAL": "300.5 320.25 240.5 -0.05",
    "RADIAL": "300.5 320.25 240.5 -0.05 0.01",
    "OPENCV": "300.5 310 320.25 240.5 -0.05 0.01 1e-3 -2e-3",
    "FULL_OPENCV": "300.5 310 320.25 240.5 -0.05 0.01 1e-3 -2e-3 0.002 0.1 -0.02 0.003",
    "SIMPLE_FISHEYE": "300.5 320.25 240.5",
    "FISHEYE": "300.5 310 320.25 240.5",
    "SIMPLE_RADIAL_FISHEYE": "300.5 320.25 240.5 -0.05",
    "RADIAL_FISHEYE": "300.5 320.25 240.5 -0.05 0.01",
    "OPENCV_FISHEYE": "300.5 310 320.25 240.5 -0.05 0.01 1e-3 -2e-3",
    "THIN_PRISM_FISHEYE": "300.5 310 320.25 240.5 -0.05 0.01 1e-3 -2e-3 0.002 -3e-4 0 0",
    "SIMPLE_DIVISION": "300.5 320.25 240.5 -0.2",
    "DIVISION": "300.5 310 320.25 240.5 -0.2",
    "EUCM": "300.5 310 320.25 240.5 0.6 1.1",
}


def test_we_project_what_we_read_to_colmaps_pixels(tmp_path: Path) -> None:
    lines = [f"{k} {model} 640 480 {_LINES[model]}\n" for k, model in enumerate(_LINES)]
    (tmp_path / "cameras.txt").write_text("# Number of cameras: 15\n" + "".join(lines))
    read = in_other_python(_COLMAP, tmp_path, RAYS.tolist(), needs="import pycolmap")
    for (number, model), theirs in zip(enumerate(_LINES), read, strict=True):
        camera = read_camera(tmp_path / "cameras.txt", name=str(number)).camera
        assert tuple(theirs["size"]) == camera.size and theirs["model"] == model
        ours = pixels_from_rays(RAYS, camera)
        assert np.abs(np.array(theirs["seen"]) - 0.5 - ours).max() < 1e-9


def test_a_camera_of_several_is_chosen_by_its_number(tmp_path: Path) -> None:
    file = tmp_path / "cameras.txt"
    file.write_text("1 PINHOLE 640 480 300 300 320 240\n12 FOV 640 480 300 300 320 240 0.9\n")
    with pytest.raises(CalibrationError, match="holds 2 cameras: 1, 12"):
        read_camera(file)
    read = read_camera(file, name="1")
    assert read.camera.params.tolist() == [300, 300, 319.5, 239.5]
    assert read.notes == ("Camera 1 of 2.",)
    with pytest.raises(CalibrationError, match="lens model FOV, which cannot be read") as caught:
        read_camera(file, name="12")
    assert "OPENCV_FISHEYE" in caught.value.hint


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("1 PINHOLE 640 480 300 300 320", "3 parameters for camera 1; PINHOLE has fx fy cx cy"),
        ("1 PINHOLE 640 480 300 300 320 x", "holds more than numbers"),
        ("1 PINHOLE 640 480 0 300 320 240", "No camera has the parameters"),
        ("1 PINHOLE 640 480 nan 300 320 240", "'nan' is not a number"),
        (f"1 THIN_PRISM_FISHEYE 640 480 {'1 ' * 12}", r"its thin prism \(sx1, sy1\) is not 0"),
    ],
)
def test_errors_name_file_and_fault(tmp_path: Path, line: str, message: str) -> None:
    file = tmp_path / "cameras.txt"
    file.write_text(line + "\n")
    with pytest.raises(CalibrationError, match=message) as caught:
        read_camera(file)
    assert str(file) in caught.value.message

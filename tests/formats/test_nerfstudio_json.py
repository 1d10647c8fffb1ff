"""transforms.json, read by the names that nerfstudio has and projected by its conventions.

Nerfstudio needs a graphics card's libraries to be imported. Its conventions: OpenGL's axes, pixels
counted from a corner, and OpenCV's polynomials.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.formats import read_camera
from calibgui.formats.camera_refit import express_in_format
from calibgui.formats.nerfstudio_json import EXPORTER, write_nerfstudio
from tests.formats.cameras import example, holding, rays_for, seen_points


def project(content: dict[str, Any], points: Array) -> Array:
    """Pixels (n, 2), from the first one's corner, of points in axes X right, Y up, Z back."""
    ahead = points * [1.0, -1.0, -1.0]
    K = np.array(
        [[content["fl_x"], 0, content["cx"]], [0, content["fl_y"], content["cy"]], [0, 0, 1.0]]
    )
    zero = np.zeros(3)
    if content["camera_model"] == "OPENCV_FISHEYE":
        coefficients = np.array([content[f"k{n}"] for n in (1, 2, 3, 4)])
        return cv2.fisheye.projectPoints(ahead[:, None], zero, zero, K, coefficients)[0][:, 0]
    assert content["k4"] == 0, "it multiplies r^8, which OpenCV has not"
    coefficients = np.array([content[key] for key in ("k1", "k2", "p1", "p2", "k3")])
    return cv2.projectPoints(ahead, zero, zero, K, coefficients)[0].reshape(-1, 2)


@pytest.mark.parametrize("model", EXPORTER.models)
def test_nerfstudio_projects_each_model_to_our_pixels(
    tmp_path: Path, result: Result, model: str
) -> None:
    camera = example(model)
    path = write_nerfstudio(holding(result, camera), tmp_path / "transforms.json").path
    content = json.loads(path.read_text())
    assert (content["w"], content["h"]) == camera.size
    rays = rays_for(camera)
    theirs = project(content, rays * [1.0, -1.0, -1.0])
    assert np.abs(theirs - 0.5 - pixels_from_rays(rays, camera)).max() < 1e-9


def test_each_photograph_sees_the_board_where_we_do(tmp_path: Path, result: Result) -> None:
    """The board lies in the world in metres, Y up along it and Z out of it."""
    write_nerfstudio(result, tmp_path / "transforms.json")
    content = json.loads((tmp_path / "transforms.json").read_text())
    expected = seen_points(result, express_in_format(result, EXPORTER).calibration)
    assert [frame["file_path"] for frame in content["frames"]] == [v.image for v in result.used]
    for frame, (board, uv) in zip(content["frames"], expected, strict=True):
        world_from_camera = np.array(frame["transform_matrix"])
        assert world_from_camera[2, 3] > 0, "the camera is in front of the board"
        world = np.column_stack([board * [1e-3, -1e-3, -1e-3], np.ones(len(board))])
        points = np.linalg.solve(world_from_camera, world.T).T[:, :3]
        assert np.abs(project(content, points) - 0.5 - uv).max() < 1e-6


def test_images_are_found_from_the_files_folder(
    tmp_path: Path, result: Result, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    image = Path(result.used[0].image)
    image.touch()
    (tmp_path / "scene").mkdir()
    write_nerfstudio(result, Path("scene") / "transforms.json")
    first, second, *_ = json.loads((tmp_path / "scene/transforms.json").read_text())["frames"]
    assert first["file_path"] == f"../{image}"
    assert second["file_path"] == result.used[1].image, "there is no such file"


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ({"k4": 0.1}, "its k4 is not 0"),
        ({"camera_model": "OPENCV_FISHEYE", "p1": 0.1}, "its p1 is not 0"),
        ({"camera_model": "EQUIRECTANGULAR"}, "lens model EQUIRECTANGULAR, which cannot be read"),
        ({"w": 640.5}, "no image|integer"),
        ({"fl_y": None}, "fl_y is not a finite number"),
    ],
)
def test_what_is_none_of_our_models_is_refused(
    tmp_path: Path, entries: dict[str, Any], message: str
) -> None:
    content = {"fl_x": 600.0, "fl_y": 600.0, "cx": 320.0, "cy": 240.0, "w": 640, "h": 480}
    file = tmp_path / "transforms.json"
    file.write_text(json.dumps(content))
    assert read_camera(file).camera.params[:4].tolist() == [600, 600, 319.5, 239.5]
    file.write_text(json.dumps(content | entries))
    with pytest.raises(CalibrationError, match=message) as caught:
        read_camera(file)
    assert str(file) in caught.value.message

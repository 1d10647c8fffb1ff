"""Settings of ORB-SLAM3 and OpenVINS, read by cv2.FileStorage as both read them."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.formats import EXPORTERS, export, read_camera
from calibgui.formats.opencv_lens import FISHEYE
from tests.formats.cameras import example, holding, rays_for


def project(rays: Array, K: Array, D: Array, fisheye: bool) -> Array:
    none = np.zeros(3)
    if fisheye:
        return cv2.fisheye.projectPoints(rays[:, None], none, none, K, D)[0][:, 0]
    return cv2.projectPoints(rays, none, none, K, D)[0].reshape(-1, 2)


@pytest.mark.parametrize("model", EXPORTERS["orb-slam3"].models)
def test_orb_slam_projects_each_model_to_our_pixels(
    tmp_path: Path, result: Result, model: str
) -> None:
    camera = example(model)
    path = export(holding(result, camera), "orb-slam3", tmp_path / "camera.yaml").path
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_READ)
    value = {
        name: storage.getNode(f"Camera1.{name}").real()
        for name in ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4")
        if not storage.getNode(f"Camera1.{name}").empty()
    }
    kind = storage.getNode("Camera.type").string()
    assert kind == ("KannalaBrandt8" if model == FISHEYE else "PinHole")
    size = [int(storage.getNode(f"Camera.{side}").real()) for side in ("width", "height")]
    assert tuple(size) == camera.size
    K = np.array([[value["fx"], 0, value["cx"]], [0, value["fy"], value["cy"]], [0, 0, 1]])
    names = ("k1", "k2", "k3", "k4") if model == FISHEYE else ("k1", "k2", "p1", "p2", "k3")
    D = np.array([value.get(name, 0.0) for name in names])
    rays = rays_for(camera)
    theirs = project(rays, K, D, model == FISHEYE)
    assert np.abs(theirs - pixels_from_rays(rays, camera)).max() < 1e-9


def test_settings_of_orb_slam_2_are_read(tmp_path: Path) -> None:
    text = '%YAML:1.0\nCamera.type: "PinHole"\n' + "".join(
        f"Camera.{name}: {value}\n"
        for name, value in {"fx": 500.5, "fy": 501, "cx": 320, "cy": 240, "k1": -0.2}.items()
    )
    (tmp_path / "TUM1.yaml").write_text(text)
    with pytest.raises(CalibrationError, match="does not say how large"):
        read_camera(tmp_path / "TUM1.yaml")
    camera = read_camera(tmp_path / "TUM1.yaml", size=(640, 480)).camera
    assert camera.params[:5].tolist() == [500.5, 501, 320, 240, -0.2]
    (tmp_path / "TUM1.yaml").write_text(text.replace("PinHole", "Rectified"))
    with pytest.raises(CalibrationError, match="lens model Rectified, which cannot be read"):
        read_camera(tmp_path / "TUM1.yaml")


@pytest.mark.parametrize("model", EXPORTERS["openvins"].models)
def test_openvins_projects_each_model_to_our_pixels(
    tmp_path: Path, result: Result, model: str
) -> None:
    camera = example(model)
    path = export(holding(result, camera), "openvins", tmp_path / "camera.yaml").path
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_READ)
    node = storage.getNode("cam0")

    def numbers(name: str) -> list[float]:
        entry = node.getNode(name)
        return [entry.at(k).real() for k in range(entry.size())]

    fx, fy, cx, cy = numbers("intrinsics")
    assert tuple(numbers("resolution")) == camera.size
    assert node.getNode("camera_model").string() == "pinhole"
    kind = node.getNode("distortion_model").string()
    assert kind == ("equidistant" if model == FISHEYE else "radtan")
    rows = node.getNode("T_imu_cam")
    motion = [[rows.at(j).at(k).real() for k in range(4)] for j in range(4)]
    assert np.array_equal(motion, np.eye(4))
    K = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])
    rays = rays_for(camera)
    theirs = project(rays, K, np.array(numbers("distortion_coeffs")), model == FISHEYE)
    assert np.abs(theirs - pixels_from_rays(rays, camera)).max() < 1e-9
    assert read_camera(path).camera.model == model

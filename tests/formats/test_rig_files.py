"""Files of rigs project the same points to the same pixels when their own readers read them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
import yaml

from calibgui.dataset import RigResult
from calibgui.engine.arrays import Array
from calibgui.engine.camera import Camera, pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import Pose, rotation_from_vector
from calibgui.formats import read_camera
from calibgui.formats.rig_files import RIG_EXPORTERS, find_rig_exporter
from tests.engine.rig.scenes import LENSES
from tests.formats.rigs import make_result

POINTS = np.random.default_rng(3).uniform([-80, -80, 500], [200, 120, 900], (40, 3))
BROWN, FISHEYE = LENSES[:2]
SECOND_BROWN = replace(BROWN, params=BROWN.params + np.r_[5, 5, 3, -4, np.zeros(6)])


def see(result: RigResult, c: int) -> Array:
    """The pixels of the points, which are in the rig's frame, in camera c."""
    pose = result.rig.poses[c]
    X = POINTS @ rotation_from_vector(pose.rvec).T + pose.tvec
    return pixels_from_rays(X, result.rig.cameras[c])


def project(file: cv2.FileStorage, number: int, rvec: Array, tvec: Array) -> Array:
    """What OpenCV makes of the camera of a number."""
    K, D = file.getNode(f"K{number}").mat(), file.getNode(f"D{number}").mat()
    arguments = POINTS[:, None].copy(), np.array(rvec), np.array(tvec), K, D
    if file.getNode("fisheye_model").real():
        return cv2.fisheye.projectPoints(*arguments)[0][:, 0]
    return cv2.projectPoints(*arguments)[0][:, 0]


@pytest.mark.parametrize("lens", [BROWN, FISHEYE])
@pytest.mark.parametrize("suffix", [".yaml", ".xml", ".json"])
def test_opencv_reads_a_stereo_pair(tmp_path: Path, lens: Camera, suffix: str) -> None:
    result = make_result(lens, count=2)
    path = tmp_path / f"stereo{suffix}"
    said = RIG_EXPORTERS["opencv"].write(result, path, (0, 1))
    assert str(path) in said and "as calibrated" in said
    file = cv2.FileStorage(str(path), cv2.FILE_STORAGE_READ)
    R, T = file.getNode("R").mat(), file.getNode("T").mat()
    zero = np.zeros(3)
    np.testing.assert_allclose(project(file, 1, zero, zero), see(result, 0), atol=1e-6)
    rvec = cv2.Rodrigues(R)[0]
    np.testing.assert_allclose(project(file, 2, rvec, T), see(result, 1), atol=1e-6)
    # Through OpenCV's own rectification both images have a point in one row, and Q finds it.
    undistort = (
        cv2.fisheye.undistortPoints
        if lens is FISHEYE
        else lambda *a, **k: cv2.undistortPoints(*a, **k, criteria=(3, 300, 1e-14))
    )
    flat = [
        undistort(
            see(result, c)[:, None].copy(),
            file.getNode(f"K{c + 1}").mat(),
            file.getNode(f"D{c + 1}").mat(),
            R=file.getNode(f"R{c + 1}").mat(),
            P=file.getNode(f"P{c + 1}").mat(),
        )[:, 0]
        for c in (0, 1)
    ]
    np.testing.assert_allclose(flat[0][:, 1], flat[1][:, 1], atol=1e-3)
    seen = np.c_[flat[0], flat[0][:, 0] - flat[1][:, 0]]
    X = cv2.perspectiveTransform(seen[:, None], file.getNode("Q").mat())[:, 0]
    np.testing.assert_allclose(X @ file.getNode("R1").mat(), POINTS, rtol=1e-4, atol=0.05)
    E, F = file.getNode("E").mat(), file.getNode("F").mat()
    assert np.linalg.matrix_rank(E, tol=1e-6) == 2 and F[2, 2] == 1


def test_ros_reads_a_pair_with_its_baseline(tmp_path: Path) -> None:
    result = make_result(BROWN, SECOND_BROWN, count=2)
    RIG_EXPORTERS["ros"].write(result, tmp_path / "rig.yaml", (0, 1))
    pair = []
    for c in (0, 1):
        file = tmp_path / f"rig-cam{c}.yaml"
        assert yaml.safe_load(file.read_text())["camera_name"] == f"cam{c}"
        camera = read_camera(file)
        np.testing.assert_allclose(
            pixels_from_rays(POINTS, camera.camera),
            pixels_from_rays(POINTS, result.rig.cameras[c]),
            atol=1e-9,
        )
        assert camera.rectification is not None
        pair.append(camera.rectification)
    assert not pair[0].P[:, 3].any()
    baseline = np.linalg.norm(result.rig.poses[1].tvec) / 1000
    assert -pair[1].P[0, 3] / pair[1].P[0, 0] == pytest.approx(baseline)
    # A point's pixels by P have one row, and their disparity is the baseline's.
    X = POINTS @ pair[0].R.T / 1000
    pixels = [np.c_[X, np.ones(len(X))] @ each.P.T for each in pair]
    left, right = (each[:, :2] / each[:, 2:] for each in pixels)
    np.testing.assert_allclose(left[:, 1], right[:, 1])
    np.testing.assert_allclose(
        left[:, 0] - right[:, 0], pair[1].P[0, 0] * baseline / X[:, 2], rtol=1e-9
    )


def test_kalibr_reads_the_chain(tmp_path: Path) -> None:
    lens = Camera(BROWN.size, BROWN.params[:8], "brown-conrady-4")
    result = make_result(lens, FISHEYE, LENSES[3], count=3)
    path = tmp_path / "chain.yaml"
    RIG_EXPORTERS["kalibr"].write(result, path, (0, 1))
    chain = yaml.safe_load(path.read_text())
    assert list(chain) == ["cam0", "cam1", "cam2"]
    assert "T_cn_cnm1" not in chain["cam0"] and chain["cam0"]["cam_overlaps"] == [1, 2]
    T = np.eye(4)
    for c, name in enumerate(chain):
        T = np.array(chain[name].get("T_cn_cnm1", np.eye(4))) @ T
        X = np.c_[POINTS / 1000, np.ones(len(POINTS))] @ T.T
        camera = read_camera(path, name).camera
        np.testing.assert_allclose(pixels_from_rays(X[:, :3], camera), see(result, c), atol=1e-6)


def test_a_pair_of_two_families_becomes_one(tmp_path: Path) -> None:
    result = make_result(BROWN, FISHEYE, count=2)
    path = tmp_path / "stereo.yaml"
    said = RIG_EXPORTERS["opencv"].write(result, path, (0, 1))
    assert "converted; differs by at most" in said
    file = cv2.FileStorage(str(path), cv2.FILE_STORAGE_READ)
    zero = np.zeros(3)
    np.testing.assert_allclose(project(file, 1, zero, zero), see(result, 0), atol=1.0)


def test_other_pairs_of_a_rig(tmp_path: Path) -> None:
    result = make_result(BROWN, count=3)
    path = tmp_path / "stereo.yaml"
    RIG_EXPORTERS["opencv"].write(result, path, (2, 1))
    file = cv2.FileStorage(str(path), cv2.FILE_STORAGE_READ)
    assert file.getNode("cameras").string() == "cam2 cam1"
    a, b = result.rig.poses[2], result.rig.poses[1]
    R = rotation_from_vector(b.rvec) @ rotation_from_vector(a.rvec).T
    np.testing.assert_allclose(file.getNode("R").mat(), R)
    np.testing.assert_allclose(file.getNode("T").mat()[:, 0], b.tvec - R @ a.tvec)


def test_unknown_formats_and_suffixes_are_refused() -> None:
    with pytest.raises(CalibrationError, match="no format 'meshlab'"):
        find_rig_exporter("meshlab", Path("a.txt"))
    with pytest.raises(CalibrationError, match="not named as a file of the format"):
        find_rig_exporter("ros", Path("a.json"))


def test_cameras_face_to_face_are_not_rectified(tmp_path: Path) -> None:
    result = make_result(BROWN, count=2)
    facing = Pose([0.0, np.pi, 0.0], [0.0, 0.0, 900.0])
    rig = replace(result.rig, poses=(result.rig.poses[0], facing))
    with pytest.raises(CalibrationError, match="cannot be rectified"):
        RIG_EXPORTERS["opencv"].write(replace(result, rig=rig), tmp_path / "a.yaml", (0, 1))

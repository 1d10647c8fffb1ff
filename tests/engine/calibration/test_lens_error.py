"""A lens that its model does not follow is told from a board that is off, both ways."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.geometry.rotations import rotation_from_vector
from tests.babelcalib import OV_PLANE_SIZE, read_ov_plane
from tests.engine.scenes import BOARD, VGA, barrel, brown, scene, stored

MODULE = import_module("calibgui.engine.calibration.model_errors")
XY = BOARD.points()
HALF = (XY - XY.mean(axis=0)) / (np.ptp(XY, axis=0) / 2)
FISHEYE = Camera(
    VGA, np.array([330.0, 330.0, 318.0, 240.0, -0.02, 4e-3, -3e-3, 4e-4]), "kannala-brandt"
)


def deviation(kind: str, mm: float) -> Array:
    """(n, 3) a board's deviation, mm."""
    d = np.zeros((len(XY), 3))
    if kind == "bow":
        d[:, 2] = mm * (1 - HALF[:, 0] ** 2)
    elif kind == "twist":
        d[:, 2] = mm * HALF[:, 0] * HALF[:, 1]
    elif kind == "skewed":
        d[:, 0] = mm * HALF[:, 1]
    elif kind == "rough":
        d = np.random.default_rng(7).normal(scale=mm, size=d.shape)
    return d


def photographed(camera: Camera, d: Array, count: int, noise: float = 0.1) -> list[Observation]:
    """Views of a board with deviations d, as if it had none."""
    rng = np.random.default_rng(count)
    solid = np.column_stack([XY, np.zeros(len(XY))]) + d
    views = []
    for pose in scene(camera, count, seed=count).poses:
        uv = pixels_from_rays(solid @ rotation_from_vector(pose.rvec).T + pose.tvec, camera)
        views.append(Observation(uv + rng.normal(scale=noise, size=uv.shape), XY))
    return views


@pytest.mark.parametrize("count", [12, 20])
@pytest.mark.parametrize(("kind", "mm"), [("flat", 0.0), ("bow", 0.3), ("rough", 0.05)])
@pytest.mark.parametrize(
    ("camera", "model"),
    [(barrel(), "pinhole"), (brown(), "pinhole"), (FISHEYE, "pinhole"), (FISHEYE, "division")],
)
def test_a_wrong_lens_model_is_not_called_a_bent_board(
    camera: Camera, model: str, kind: str, mm: float, count: int
) -> None:
    views = photographed(camera, deviation(kind, mm), count, 0.05)
    found = calibrate(views, VGA, model=model)
    assert found.board_shape_error == 0
    rms = np.sqrt(np.mean([view.rms**2 for view in found.residuals]))
    assert 0.7 * rms < found.lens_error < rms


@pytest.mark.parametrize("count", [8, 20])
@pytest.mark.parametrize(
    ("kind", "mm"), [("bow", 1.0), ("twist", 1.0), ("skewed", 0.5), ("rough", 0.1), ("rough", 1.0)]
)
@pytest.mark.parametrize("camera", [barrel(), FISHEYE])
def test_a_bent_board_is_not_called_a_wrong_lens_model(
    camera: Camera, kind: str, mm: float, count: int
) -> None:
    views = photographed(camera, deviation(kind, mm), count)
    found = calibrate(views, VGA, model=camera.model)
    assert found.lens_error == 0
    assert found.board_shape_error > 0


@pytest.mark.parametrize(("count", "noise", "mm"), [(6, 0.3, 0.5), (8, 0.1, 0.2), (12, 0.3, 0.2)])
def test_a_skewed_board_that_a_lens_would_explain_as_well_is_not_called_a_lens(
    count: int, noise: float, mm: float
) -> None:
    """A lens of hundreds of unknowns explains what one angle does, and the free board no more."""
    found = calibrate(
        photographed(FISHEYE, deviation("skewed", mm), count, noise), VGA, model=FISHEYE.model
    )
    assert found.lens_error == 0
    assert found.board_shape_error > 0


def test_noise_is_neither() -> None:
    found = calibrate(photographed(barrel(), deviation("flat", 0.0), 12), VGA)
    assert found.lens_error == 0
    assert found.board_shape_error == 0


def _without_the_test(monkeypatch: pytest.MonkeyPatch, views: list[Observation]) -> Calibration:
    with monkeypatch.context() as patch:
        patch.setattr(MODULE, "measure_lens_error", lambda *_: 0.0)
        return calibrate(views, VGA, model="pinhole")


def test_only_the_name_of_the_error_depends_on_the_verdict(monkeypatch: pytest.MonkeyPatch) -> None:
    """The estimates are those for the board as drawn, and no uncertainty is smaller."""
    views = photographed(barrel(), deviation("flat", 0.0), 12)
    found, blamed = calibrate(views, VGA, model="pinhole"), _without_the_test(monkeypatch, views)
    assert found.lens_error > 0
    assert blamed.board_shape_error > 0
    np.testing.assert_array_equal(found.camera.params, blamed.camera.params)
    np.testing.assert_array_equal(found.covariance, blamed.covariance)
    np.testing.assert_array_equal(found.pose_covariances, blamed.pose_covariances)


@pytest.mark.parametrize("shape", [BoardShapeModel.NOMINAL, BoardShapeModel.BOW])
def test_without_errors_of_models_the_camera_is_the_same(shape: BoardShapeModel) -> None:
    views = photographed(barrel(), deviation("bow", 0.5), 9)
    whole = calibrate(views, VGA, board_shape=shape)
    plain = calibrate(views, VGA, board_shape=shape, model_errors=False)
    np.testing.assert_array_equal(plain.camera.params, whole.camera.params)
    np.testing.assert_array_equal(plain.covariance, plain.noise_covariance)
    np.testing.assert_array_equal(plain.noise_covariance, whole.noise_covariance)
    assert plain.board_shape_error == plain.lens_error == plain.overdispersion == 0
    if shape is BoardShapeModel.NOMINAL:
        assert whole.board_shape_error > 0 and (whole.sigma[:4] > plain.sigma[:4]).all()


def test_the_lens_is_examined_only_where_the_board_is_suspected(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def refuse(*_: object) -> float:
        raise AssertionError

    monkeypatch.setattr(MODULE, "measure_lens_error", refuse)
    calibrate(photographed(barrel(), deviation("flat", 0.0), 8), VGA)
    with pytest.raises(AssertionError):
        calibrate(photographed(barrel(), deviation("rough", 0.5), 8), VGA)


def test_a_shape_that_is_estimated_with_a_wrong_lens_model_is_suspect() -> None:
    straight = Camera(VGA, np.array([650.0, 650.0, 310.0, 243.0]), "pinhole")
    for camera, suspect in ((barrel(), True), (straight, False)):
        views = photographed(camera, deviation("bow", 1.0), 12)
        found = calibrate(views, VGA, model="pinhole", board_shape=BoardShapeModel.FREE)
        assert found.board_shape is not None
        assert bool(found.lens_error > 0) is suspect


@pytest.fixture(scope="module")
def wide(data_dir: Path) -> list[Observation]:
    """The training views of BabelCalib's OV plane, a lens of 186 degrees."""
    return read_ov_plane(data_dir / "babelcalib_ov_plane", "train")


@pytest.mark.data
def test_the_papers_model_does_not_follow_a_fisheye(wide: list[Observation]) -> None:
    found = calibrate(wide, OV_PLANE_SIZE)
    assert found.board_shape_error == 0
    assert found.lens_error > 3.5  # of 5.1 px rms


@pytest.mark.data
def test_a_fisheye_model_leaves_the_board_to_blame(wide: list[Observation]) -> None:
    found = calibrate(wide, OV_PLANE_SIZE, model="kannala-brandt")
    assert found.lens_error == 0
    assert found.board_shape_error == pytest.approx(0.02, abs=0.015)


@pytest.mark.data
@pytest.mark.parametrize(("model", "fault"), [("lucchese", False), ("pinhole", True)])
def test_bouguets_board_is_off_and_his_lens_no_pinhole(
    data_dir: Path, model: str, fault: bool
) -> None:
    folder = data_dir / "bouguet_calib_example" / "corners_and_results"
    found = calibrate(*stored(folder / "corners_25img__benJephunneh.json"), model=model)
    assert (found.lens_error > 1.0) is fault
    assert found.board_shape_error == (0 if fault else pytest.approx(0.16, abs=0.02))
    if not fault:
        expected = [657.363435504, 657.826087576, 303.032828544, 242.495047804]
        np.testing.assert_allclose(found.camera.params[:4], expected, rtol=1e-9)
        expected = [1.8942, 1.7071, 2.2347, 1.2690]
        np.testing.assert_allclose(found.sigma[:4], expected, rtol=1e-3)

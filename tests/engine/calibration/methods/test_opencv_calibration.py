"""OpenCV's calibration through the adapter, against cv2 called directly and against our own."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from calibgui.engine import opencv
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.methods.bouguet import BOUGUET_K3
from calibgui.engine.calibration.methods.opencv_calibration import OPENCV
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.refinement.levenberg_marquardt import StartError
from calibgui.engine.calibration.result import Calibration, Iteration, Status
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.rotations import rotation_from_vector
from tests.engine.scenes import VGA, brown, looking, scene, seen

CAMERA = brown(aspect=1.01)


@pytest.fixture(scope="module")
def views() -> list[Observation]:
    return scene(CAMERA, 6, seed=1).noisy(0.1, np.random.default_rng(0))


@pytest.fixture(scope="module")
def found(views: list[Observation]) -> Calibration:
    return calibrate(views, VGA, method=OPENCV)


def test_it_is_what_opencv_returns(views: list[Observation], found: Calibration) -> None:
    xyz = [np.column_stack([view.xy, np.zeros(len(view.xy))]) for view in views]
    criteria = (cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 100, np.finfo(float).eps)
    rms, K, k, rvecs, tvecs = cv2.calibrateCamera(
        [points.astype(np.float32) for points in xyz],
        [view.uv.astype(np.float32) for view in views],
        VGA,
        None,
        None,
        criteria=criteria,
    )
    expected = [K[0, 0], K[1, 1], K[0, 2], K[1, 2], *np.ravel(k)[:5], 0.0]
    np.testing.assert_allclose(found.camera.params, expected, rtol=1e-6)
    for pose, rvec, tvec in zip(found.poses, rvecs, tvecs, strict=True):
        R = rotation_from_vector(np.ravel(rvec))
        np.testing.assert_allclose(rotation_from_vector(np.array(pose.rvec)), R, atol=1e-8)
        np.testing.assert_allclose(pose.tvec, np.ravel(tvec), rtol=1e-6)
    # Its root mean square distance, of corners in single precision.
    assert found.history[-1].rms == pytest.approx(rms, rel=1e-5)
    assert found.fixed == ("skew",)


def test_it_agrees_with_our_solver(views: list[Observation], found: Calibration) -> None:
    own = calibrate(views, VGA, method=BOUGUET_K3)
    assert found.status is Status.CONVERGED
    deviation = np.abs(found.camera.params - own.camera.params)
    assert (deviation <= 2e-3 * np.nan_to_num(own.sigma)).all()
    np.testing.assert_allclose(found.sigma, own.sigma, rtol=1e-3)


def test_it_finds_the_truth_to_single_precision() -> None:
    found = calibrate(scene(CAMERA, 6, seed=1).views, VGA, method=OPENCV)
    assert found.status is Status.CONVERGED
    np.testing.assert_allclose(found.camera.params[:4], CAMERA.params[:4], rtol=1e-6)
    np.testing.assert_allclose(found.camera.params[4:], CAMERA.params[4:], atol=1e-4)


def test_views_may_be_partial() -> None:
    rng = np.random.default_rng(3)
    poses = [looking(CAMERA, rng, fill=(0.9, 1.3)) for _ in range(6)]
    partial = seen(CAMERA, poses, partial=True).noisy(0.1, rng)
    assert len({len(view.uv) for view in partial}) > 1
    found = calibrate(partial, VGA, method=OPENCV)
    own = calibrate(partial, VGA, method=BOUGUET_K3)
    assert found.status is Status.CONVERGED
    deviation = np.abs(found.camera.params - own.camera.params)
    assert (deviation <= 2e-3 * np.nan_to_num(own.sigma)).all()


@pytest.mark.parametrize(
    "fix",
    [
        {"k3": None},
        {"fx": 651.0, "fy": 656.0},
        {"cx": None, "cy": None},
        {"p1": 1e-3, "p2": 0.0},
        {"k1": -0.2, "k2": 0.0, "k3": 0.0},
    ],
)
def test_parameters_are_held(views: list[Observation], fix: dict[str, float | None]) -> None:
    found = calibrate(views, VGA, method=OPENCV, fix=fix)
    own = calibrate(views, VGA, method=BOUGUET_K3, fix=fix)
    assert set(found.fixed) == {*fix, "skew"}
    deviation = np.abs(found.camera.params - own.camera.params)
    assert (deviation <= 2e-3 * np.nan_to_num(own.sigma)).all()


@pytest.mark.parametrize("fix", [{"fx": 650.0}, {"cy": None}, {"p1": 0.0}])
def test_pairs_are_held_together(views: list[Observation], fix: dict[str, float | None]) -> None:
    with pytest.raises(CalibrationError, match="only together"):
        calibrate(views, VGA, method=OPENCV, fix=fix)


@pytest.mark.parametrize("options", [{"free": ["skew"]}, {"fix": {"skew": 0.01}}])
def test_a_skew_is_refused(views: list[Observation], options: dict[str, object]) -> None:
    with pytest.raises(CalibrationError, match="knows no skew"):
        calibrate(views, VGA, method=OPENCV, **options)  # type: ignore[arg-type]


def test_a_solve_that_was_cut_short_says_so(views: list[Observation]) -> None:
    found = calibrate(views, VGA, method=OPENCV, max_iterations=1)
    assert found.status is Status.MAX_ITERATIONS


def test_one_evaluation_is_reported(views: list[Observation]) -> None:
    told: list[Iteration] = []

    def take(iteration: Iteration) -> bool:
        told.append(iteration)
        return True

    found = calibrate(views, VGA, method=OPENCV, report=take)
    assert tuple(told) == found.history
    assert len(told) == 1


def test_views_that_opencv_refuses(
    views: list[Observation], monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_args: object, **_options: object) -> None:
        raise cv2.error("no")

    monkeypatch.setattr(cv2, "calibrateCamera", refuse)
    with pytest.raises(StartError, match="OpenCV finds no camera in these views"):
        calibrate(views, VGA, method=OPENCV)
    nothing = opencv.calibrate_camera([views[0].uv], [views[0].xy], VGA, None, 0, 30)
    assert nothing is None

"""Projection uncertainty against re-calibrations, central differences and mrcal."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays, rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import rotations
from calibgui.engine.uncertainty.projection_uncertainty import (
    compute_sensitivity,
    compute_worst_sigma,
    estimate_projection_uncertainty,
    make_map_grid,
)
from tests.engine.scenes import (
    BOARD,
    TRUE_BOARD,
    barrel,
    brown,
    central_differences,
    relative,
    scene,
)

DISTANCES = (np.inf, 600.0)


def _point(camera: Camera, uv: Array, distance: float) -> Array:
    """(..., 3) the point behind a pixel."""
    return rays_from_pixels(uv, camera) * (distance if np.isfinite(distance) else 1)


def _reprojected(truth: Calibration, again: Calibration, uv: Array, distance: float) -> Array:
    """Where a re-calibration sees the points behind the pixels, by the mean of its boards."""
    p = _point(truth.camera, uv, distance)
    moved = []
    for old, new in zip(truth.poses, again.poses, strict=True):
        turn = rotations.rotation_from_vector(new.rvec) @ rotations.rotation_from_vector(old.rvec).T
        far = not np.isfinite(distance)
        moved.append(p @ turn.T if far else (p - old.tvec) @ turn.T + new.tvec)
    mean = np.mean(moved, axis=0)
    return pixels_from_rays(mean, again.camera)


@pytest.mark.parametrize("distance", DISTANCES)
def test_sensitivity_is_the_derivative(distance: float) -> None:
    camera = barrel(aspect=1.1)
    uv = np.array([[20.0, 30.0], [300.0, 200.0], [600.0, 470.0]])
    p = _point(camera, uv, distance)
    by_params, by_motion = compute_sensitivity(camera, uv, distance)

    def turned(motion: Array) -> Array:
        q = p @ rotations.rotation_from_vector(motion[:3]).T + (
            motion[3:] if np.isfinite(distance) else 0.0
        )
        return pixels_from_rays(q, camera)

    def changed(params: Array) -> Array:
        return pixels_from_rays(p, Camera(camera.size, params, camera.model))

    step = np.array([1e-4] * 3 + [0.1] * 3)
    assert relative(by_motion, central_differences(turned, np.zeros(6), step)) < 1e-8
    step = np.array([0.1] * 4 + [1e-3] * 6)
    params = np.array(camera.params)
    assert relative(by_params, central_differences(changed, params, step)) < 1e-8


@pytest.mark.slow
def test_predicts_the_scatter_of_recalibrations() -> None:
    true = scene(barrel(), 8, seed=3)
    size, rng = true.size, np.random.default_rng(5)
    exact = calibrate(true.views, size, prior=TRUE_BOARD)
    uv = np.stack(np.meshgrid(np.linspace(0, 639, 7), np.linspace(0, 479, 5)), axis=-1)
    drawn = [true.noisy(0.3, rng) for _ in range(80)]
    found = [calibrate(views, size, prior=TRUE_BOARD) for views in drawn]
    for distance in DISTANCES:
        draws = [_reprojected(exact, again, uv, distance) - uv for again in found]
        predicted = [_at(*pair, uv, distance) for pair in zip(found[:5], drawn, strict=False)]
        empirical = np.einsum("nija,nijb->ijab", draws, draws) / len(draws)
        ratio = compute_worst_sigma(empirical) / compute_worst_sigma(np.mean(predicted, axis=0))
        # Of 80 draws a standard deviation is known to 8 %.
        assert 0.85 < np.median(ratio) < 1.15
        assert ratio.min() > 0.7
        assert ratio.max() < 1.35


def _at(result: Calibration, views: list[Observation], uv: Array, distance: float) -> Array:
    """The covariances of `projection_uncertainty` at pixels of its map."""
    whole = estimate_projection_uncertainty(result, views, distance)
    columns = np.abs(whole.u[:, None] - uv[0, :, 0]).argmin(axis=0)
    rows = np.abs(whole.v[:, None] - uv[:, 0, 1]).argmin(axis=0)
    return whole.covariance[np.ix_(rows, columns)]


def test_numbers_of_the_map() -> None:
    views = scene(barrel(), 6).noisy(0.2, np.random.default_rng(1))
    result = calibrate(views, barrel().size)
    found = estimate_projection_uncertainty(result, views)
    assert found.u[[0, -1]].tolist() == [0, 639]
    assert found.v[[0, -1]].tolist() == [0, 479]
    assert found.u[len(found.u) // 2] == 319.5
    assert found.centre <= found.median <= found.worst
    assert found.fraction(found.worst) == 1.0
    assert found.fraction(found.median) == pytest.approx(0.5, abs=0.01)
    assert (found.rms <= found.worst_direction).all()
    eigenvalues = np.linalg.eigvalsh(found.covariance)
    assert found.worst_direction == pytest.approx(np.sqrt(eigenvalues[..., 1]))


def test_more_views_leave_less_uncertain() -> None:
    views = scene(barrel(), 16).noisy(0.2, np.random.default_rng(1))
    few, many = (
        estimate_projection_uncertainty(calibrate(views[:n], barrel().size), views[:n])
        for n in (4, 16)
    )
    assert many.median < 0.7 * few.median


@pytest.mark.parametrize("distance", [0.0, -1.0, np.nan])
def test_a_distance_behind_the_camera_is_refused(distance: float) -> None:
    views = scene(barrel(), 4).noisy(0.2, np.random.default_rng(1))
    result = calibrate(views, barrel().size)
    with pytest.raises(CalibrationError, match="not in front"):
        estimate_projection_uncertainty(result, views, distance)


def test_a_grid_of_a_tall_image() -> None:
    u, v = make_map_grid((480, 640))
    assert len(v) == 41
    assert len(u) == 31


@pytest.mark.parametrize("distance", DISTANCES)
def test_agrees_with_mrcal(tmp_path: Path, distance: float) -> None:
    python = Path("/usr/bin/python3")
    if (
        not python.exists()
        or subprocess.run(
            [python, "-c", "import mrcal"], capture_output=True, check=False
        ).returncode
    ):
        pytest.skip("mrcal is not installed (Debian: apt-get install python3-mrcal)")
    views = scene(brown(), 10, seed=2).noisy(0.2, np.random.default_rng(4))
    result = calibrate(views, brown().size, model="brown-conrady", prior=TRUE_BOARD)
    ours = estimate_projection_uncertainty(result, views, distance)
    uv = np.stack(np.meshgrid(ours.u, ours.v), axis=-1)
    given, reference = tmp_path / "given.npz", tmp_path / "reference.npz"
    np.savez(
        given,
        boards=[view.uv.reshape(BOARD.rows, BOARD.cols, 2) for view in views],
        params=result.camera.params[:9],
        poses=[np.concatenate([pose.rvec, pose.tvec]) for pose in result.poses],
        size=brown().size,
        square=BOARD.square,
        noise=result.noise,
        uv=uv.reshape(-1, 2),
        distance=600.0,
    )
    script = Path(__file__).with_name("mrcal_reference.py")
    subprocess.run([python, script, given, reference], check=True, capture_output=True)
    theirs = np.load(reference)
    assert np.abs(theirs["params"][:4] - result.camera.params[:4]).max() < 0.01
    covariance = theirs["infinite" if np.isinf(distance) else "finite"].reshape(*uv.shape, 2)
    ratio = ours.worst_direction / compute_worst_sigma(covariance)
    assert np.abs(ratio - 1).max() < 1e-4

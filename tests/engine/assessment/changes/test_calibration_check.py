"""Checks of a stored camera: changes are found, boards are not taken for them, sigmas hold."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.changes.calibration_check import (
    CalibrationCheck,
    CheckVerdict,
    Weakness,
    check_calibration,
)
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays, rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from tests.engine.scenes import BOARD, barrel, example, looking, seen

NOISE = 0.1
SIZE = (1280, 960)
WIDE = Camera(SIZE, [520, 520, 633, 475, -0.02, 3e-3, -1e-3, 1e-4], "kannala-brandt")
LENS = barrel(focal=1300.0, size=SIZE)


@cache
def stored(camera: Camera) -> Calibration:
    rng = np.random.default_rng(1)
    poses = [looking(camera, rng) for _ in range(15)]
    return calibrate(seen(camera, poses).noisy(NOISE, rng), camera.size, model=camera.model)


def changed(camera: Camera, scale: float = 1.0, shift: Sequence[float] = (0, 0)) -> Camera:
    params = np.array(camera.params)
    params[:2] *= scale
    params[2:4] += shift
    return Camera(camera.size, params, camera.model)


def views_of(
    camera: Camera, count: int, seed: int, bow: float = 0.0, square: float = 1.0
) -> list[Observation]:
    """Views of a board that is bowed, mm, and whose squares are `square` times as large."""
    rng = np.random.default_rng(seed)
    xy = BOARD.points()
    half = (xy.max(axis=0) - xy.min(axis=0)) / 2
    height = bow * (1 - ((xy[:, 0] - xy[:, 0].min() - half[0]) / half[0]) ** 2)
    places = np.column_stack([square * xy, height])
    views = []
    for _ in range(count):
        pose = looking(camera, rng)
        turned = places @ Rotation.from_rotvec(np.array(pose.rvec)).as_matrix().T
        uv = pixels_from_rays(turned + square * np.array(pose.tvec), camera)
        views.append(Observation(uv + rng.normal(scale=NOISE, size=uv.shape), xy))
    return views


def check(camera: Camera, views: list[Observation], limit: float = 0.5) -> CalibrationCheck:
    known = stored(camera)
    return check_calibration(known.camera, views, known.covariance, limit)


@pytest.mark.parametrize("camera", [LENS, WIDE], ids=["lucchese", "kannala-brandt"])
def test_verdicts(camera: Camera) -> None:
    assert check(camera, views_of(camera, 6, 2)).verdict is CheckVerdict.STILL_GOOD
    refocused = check(camera, views_of(changed(camera, 1.01), 4, 3))
    assert refocused.verdict is CheckVerdict.HAS_CHANGED
    assert refocused.scale == pytest.approx(0.01, abs=4 * refocused.scale_sigma)
    longer = check(camera, views_of(changed(camera, 1.003), 6, 4), limit=0.2)
    assert longer.verdict is CheckVerdict.HAS_CHANGED


def test_the_change_is_the_difference_of_the_cameras_without_rotation() -> None:
    other = changed(LENS, 1.02, (4, -3))
    views = views_of(other, 8, 5)
    found = check_calibration(LENS, views)
    uv = np.concatenate([view.uv for view in views])
    rays = rays_from_pixels(uv, LENS)

    def miss(turn: Array) -> Array:
        return pixels_from_rays(Rotation.from_rotvec(turn).apply(rays), other) - uv

    best = least_squares(lambda turn: miss(turn).ravel(), np.zeros(3)).x
    expected = np.sqrt(np.mean(np.sum(miss(best) ** 2, axis=1)))
    assert found.change == pytest.approx(expected, rel=0.05)
    whole = np.sqrt(np.mean(np.sum(miss(np.zeros(3)) ** 2, axis=1)))
    assert found.whole_change == pytest.approx(whole, rel=0.1)
    np.testing.assert_allclose(found.shift, (4, -3), atol=4 * found.shift_sigma.max())


def test_a_moved_centre_is_mostly_hidden_by_a_rotation_but_found() -> None:
    found = check(LENS, views_of(changed(LENS, shift=(3, 0)), 8, 6))
    assert found.whole_change > 2
    assert found.change < 0.5
    assert found.shift[0] == pytest.approx(3, abs=3 * found.shift_sigma[0])
    assert found.shift[0] > 3 * found.shift_sigma[0]


@pytest.mark.parametrize("bow", [0.7, 1.5])
def test_a_bent_board_is_no_changed_camera(bow: float) -> None:
    for seed in range(4):
        found = check(LENS, views_of(LENS, 4, 10 + seed, bow=bow))
        assert found.verdict is not CheckVerdict.HAS_CHANGED
        assert found.rms > 2 * NOISE  # which would alarm whoever looks at the residuals only
        assert found.bend == pytest.approx(bow * 2 / 3, rel=0.2)  # from its mean, the farther side
        assert found.bend > 5 * found.bend_sigma


def test_the_squares_size_does_not_matter() -> None:
    found = check(LENS, views_of(LENS, 6, 2, square=1.1))
    assert found.change == pytest.approx(check(LENS, views_of(LENS, 6, 2)).change, rel=1e-3)


def test_a_board_parallel_to_the_sensor_cannot_tell() -> None:
    pose = Pose((0, 0, 0), (-165.0, -120.0, 500.0))
    uv = seen(changed(LENS, 1.02), [pose]).views[0].uv
    found = check(LENS, [Observation(uv, BOARD.points())])
    assert found.verdict is CheckVerdict.CANNOT_TELL
    assert found.weakness is Weakness.SCALE


def test_outliers_are_left_out() -> None:
    views = views_of(LENS, 5, 2)
    uv = np.array(views[0].uv)
    uv[[3, 50]] += (9.0, -14.0)
    views[0] = Observation(uv, views[0].xy)
    mixed = np.random.default_rng(0).permutation(len(uv))
    views.append(Observation(views[1].uv[mixed], views[1].xy))
    views.append(Observation(views[1].uv[::-1] * [1, -1] + [0, 900], views[1].xy))  # mirrored
    found = check(LENS, views)
    assert found.verdict is CheckVerdict.STILL_GOOD
    assert found.views[0].left_out == 2
    assert [view.used == 0 for view in found.views] == [False] * 5 + [True] * 2
    assert all("board like this" in v.reason or "do not fit" in v.reason for v in found.views[5:])


def test_corners_beyond_the_lens_are_left_out() -> None:
    folding = Camera((640, 480), [600, 600, 319.5, 239.5, -0.6, 0, 0, 0, 0], "brown-conrady")
    views = views_of(example("brown-conrady"), 2, 0)
    check_calibration(folding, views)  # ends


def test_views_that_are_too_poor() -> None:
    few = Observation(*(part[:8] for part in views_of(LENS, 1, 0)[0][:2]))
    with pytest.raises(CalibrationError, match="8 corners, and 12"):
        check(LENS, [few])
    with pytest.raises(CalibrationError, match="there are none"):
        check(LENS, [])


def test_without_a_covariance_the_files_own_error_is_a_change() -> None:
    known = stored(LENS)
    wrong = changed(known.camera, 1.01)
    views = views_of(LENS, 4, 7)
    assert check_calibration(wrong, views).verdict is CheckVerdict.HAS_CHANGED
    wide = np.diag((0.02 * np.abs(known.camera.params)) ** 2)
    assert check_calibration(wrong, views, wide).verdict is CheckVerdict.CANNOT_TELL


def _simulate(camera: Camera, count: int, views: int, **made: float) -> list[CalibrationCheck]:
    return [check(camera, views_of(camera, views, 100 + seed, **made)) for seed in range(count)]


def test_the_standard_deviations_hold_and_nothing_is_a_false_alarm() -> None:
    # The stored calibration is one, so that its own error is alike in all checks: without it.
    found = [check_calibration(LENS, views_of(LENS, 2, 100 + seed)) for seed in range(40)]
    scores: Array = np.array([[*(f.shift / f.shift_sigma), f.scale / f.scale_sigma] for f in found])
    np.testing.assert_allclose(np.sqrt(np.mean(scores**2, axis=0)), 1, atol=0.3)
    assert np.abs(scores.mean(axis=0)).max() < 0.4
    assert all(f.verdict is not CheckVerdict.HAS_CHANGED for f in found)


def test_views_that_disagree_widen_the_standard_deviation() -> None:
    views = views_of(LENS, 4, 5)
    plain = check_calibration(LENS, views)
    wide = check_calibration(LENS, views, overdispersion=3)
    assert wide.change_sigma == pytest.approx(3 * plain.change_sigma, rel=0.1)
    assert wide.noise == pytest.approx(plain.noise, rel=0.02)


@pytest.mark.slow
@pytest.mark.parametrize(("camera", "bow"), [(LENS, 1.0), (WIDE, 0.0)])
def test_false_alarms_are_rare(camera: Camera, bow: float) -> None:
    found = [f for n in (1, 2, 4) for f in _simulate(camera, 12, n, bow=bow)]
    alarms = sum(f.verdict is CheckVerdict.HAS_CHANGED for f in found)
    assert not alarms  # of 36: one in 15 is told with 92 %

"""The synthetic check finds the camera that rendered the views."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui import engine
from calibgui.app.calibrating.synthetic import SyntheticCheck, run_synthetic_check
from calibgui.dataset import Result, ViewStatus
from calibgui.engine.boards.board import Board
from calibgui.engine.errors import CalibrationError, Cancelled
from calibgui.engine.geometry.pose import Pose
from tests.app.rendered import BOARD, small_result

pytestmark = pytest.mark.usefixtures("search_here")


@pytest.fixture(scope="module")
def result() -> Result:
    return small_result()


@pytest.fixture(scope="module")
def check(result: Result) -> SyntheticCheck:
    return run_synthetic_check(result)


def test_the_rendering_camera_is_found_again(check: SyntheticCheck) -> None:
    real, synthetic = check.real.calibration, check.synthetic.calibration
    free = synthetic.sigma > 0
    miss = (synthetic.camera.params - real.camera.params)[free] / real.sigma[free]
    assert np.abs(miss).max() < 2
    # What is left is the finder's error, well below the noise of the real corners.
    assert engine.summarise_residuals(synthetic.residuals).rms < 0.04
    assert np.median(check.extrinsic_errors) < 1e-3


def test_settings_are_repeated(check: SyntheticCheck) -> None:
    assert check.synthetic.calibration.settings == check.real.calibration.settings


def test_views_keep_their_names_and_corners(check: SyntheticCheck) -> None:
    """Corners that the real view lacks are not used, and numbers are the real view's."""
    assert [view.image for view in check.synthetic.views] == [f"{k}.png" for k in range(5)]
    for real, synthetic in zip(
        check.real.observations(), check.synthetic.observations(), strict=True
    ):
        places = {tuple(xy): uv for uv, xy in zip(*real[:2], strict=True)}
        assert 0.9 * len(real.xy) < len(synthetic.xy) <= len(real.xy)
        for uv, xy in zip(*synthetic[:2], strict=True):
            np.testing.assert_allclose(uv, places[tuple(xy)], atol=0.4)


@pytest.mark.parametrize("turned", [False, True])
def test_corners_are_numbered_as_in_the_real_views(turned: bool) -> None:
    """A board of even sides looks the same upside down, so the finder may count either way."""
    check = run_synthetic_check(small_result(Board(6, 8, 30.0), turned))
    real, synthetic = (
        np.array([pose.rvec for pose in result.calibration.poses])
        for result in (check.real, check.synthetic)
    )
    np.testing.assert_allclose(synthetic, real, atol=0.02)


def test_extrinsic_errors_compare_the_papers_parameters(check: SyntheticCheck) -> None:
    real, synthetic = check.real.paper_poses(), check.synthetic.paper_poses()
    assert check.extrinsic_errors.shape == (5, 6)
    expected = abs((real[3].omega - synthetic[3].omega) / real[3].omega)
    assert check.extrinsic_errors[3, 0] == pytest.approx(expected, rel=1e-9)


def test_a_view_that_is_not_found_again_is_left_out(result: Result) -> None:
    """A pose so far away that the rendered board is a few pixels wide."""
    poses = list(result.calibration.poses)
    poses[2] = Pose(poses[2].rvec, poses[2].tvec * [1, 1, 12])
    distant = replace(result, calibration=replace(result.calibration, poses=tuple(poses)))
    check = run_synthetic_check(distant)
    lost = check.synthetic.views[2]
    assert lost.status is ViewStatus.NO_BOARD and lost.reason
    assert check.extrinsic_errors.shape == (4, 6)
    assert np.median(check.extrinsic_errors[2]) < 2e-3  # the real view 3


def test_progress_counts_views_and_may_cancel(result: Result) -> None:
    told: list[tuple[int, int]] = []

    def progress(done: int, total: int) -> None:
        told.append((done, total))
        if done == 2:
            raise Cancelled

    with pytest.raises(Cancelled):
        run_synthetic_check(result, progress=progress)
    assert told == [(1, 5), (2, 5)]


def test_a_target_is_needed(result: Result) -> None:
    points = tuple(
        replace(view, points=view.observation(BOARD), corners=None) if view.usable else view
        for view in result.views
    )
    with pytest.raises(CalibrationError, match="pattern of the board is not known"):
        run_synthetic_check(Result(result.calibration, points, None))

"""What is wrong with a calibration is named by its cause, and nothing where nothing is wrong."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.action_trials import try_action
from calibgui.engine.assessment.causes import input_errors
from calibgui.engine.assessment.causes.findings import list_findings
from calibgui.engine.assessment.causes.input_errors import (
    find_wrong_frame,
    screen_misplaced_corners,
)
from calibgui.engine.assessment.causes.two_pictures import find_two_pictures
from calibgui.engine.assessment.changes.comparison import compare_cameras
from calibgui.engine.assessment.finding import Cause, Finding
from calibgui.engine.assessment.residuals.residual_statistics import summarise_residuals
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError, Cancelled
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.numbers import format_two_digits
from tests.engine.scenes import VGA, barrel, looking, scene, scene_in_the_middle, seen
from tests.faults.campaign import inject_fault
from tests.faults.sets import draw_rendered_set, photograph

CLEAN = scene(barrel(), 10, seed=3).noisy(0.1, np.random.default_rng(1))
MIDDLE = np.array([319.5, 239.5])


def found(views: list[Observation], **settings: object) -> tuple[Finding, ...]:
    return list_findings(calibrate(views, VGA, **settings), views)  # type: ignore[arg-type]


def changed(k: int, uv: Array) -> list[Observation]:
    """The clean views, one of them with other corners."""
    return [*CLEAN[:k], Observation(uv, CLEAN[k].xy), *CLEAN[k + 1 :]]


def test_nothing_is_found_where_nothing_is_wrong() -> None:
    assert found(CLEAN) == ()


@pytest.mark.parametrize("share", [0.05, 0.2])
def test_corners_that_are_off_are_named_with_their_view(share: float) -> None:
    uv = np.array(CLEAN[4].uv)
    uv[:: round(1 / share)] += [30.0, -20.0]
    views = changed(4, uv)
    finding = found(views)[0]
    assert finding.cause is Cause.MISPLACED_CORNERS
    assert finding.views == (4,)
    assert "View 5" in finding.message
    assert "Leave outliers out" in finding.remedy
    error = compare_cameras(barrel(), calibrate(views, VGA).camera, views=CLEAN)
    assert finding.harm == pytest.approx(error.rms, rel=0.2)


def test_a_corner_as_uncertain_as_it_says_is_not_looked_for_and_a_certain_one_is() -> None:
    """One that the image's border cuts may be off by pixels, where all others are precise."""
    views = [Observation(v.uv, v.xy, np.tile(0.01 * np.eye(2), (len(v.uv), 1, 1))) for v in CLEAN]
    uv, cov = np.array(views[4].uv), np.array(views[4].cov)
    uv[0] += [3.0, 0.0]
    certain = [*views[:4], Observation(uv, views[4].xy, cov), *views[5:]]
    wide = np.concatenate([4.0 * np.eye(2)[None], cov[1:]])
    uncertain = [*views[:4], Observation(uv, views[4].xy, wide), *views[5:]]
    screening = screen_misplaced_corners(calibrate(certain, VGA), certain)
    assert screening is not None
    assert [(r.view, r.corners) for r in screening.rejected] == [(4, (0,))]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(input_errors, "screen_outliers", None)  # nothing that is called
        assert screen_misplaced_corners(calibrate(uncertain, VGA), uncertain) is None


@pytest.mark.parametrize("axis", [0, 1])
def test_two_pictures_in_each_photograph_are_two_cameras(axis: int) -> None:
    """The board is in one or the other, and each has its principal point in its middle."""
    size = (VGA[0], 2 * VGA[1]) if axis else (2 * VGA[0], VGA[1])
    views = [Observation(np.array(view.uv), view.xy) for view in CLEAN]
    for k in (1, 2, 5, 8):
        views[k].uv[:, axis] += VGA[axis]
    (finding,) = list_findings(calibrate(views, size), views)
    assert finding.cause is Cause.MIXED_VIEWS
    assert finding.views == (1, 2, 5, 8)
    assert ("below row" if axis else "right of column") in finding.message
    assert "Cut" in finding.remedy


def test_views_at_two_sides_of_one_picture_are_one_camera() -> None:
    """Though each side by itself follows a lens better that the model does not follow."""
    camera, rng, poses = barrel(), np.random.default_rng(4), []
    for k in range(12):
        pose = looking(camera, rng, fill=(0.15, 0.3))
        aside = 0.28 * (-1) ** k * VGA[0] / camera.focal[0] * pose.tvec[2]
        poses.append(Pose(pose.rvec, np.add(pose.tvec, [aside, 0.0, 0.0])))
    views = seen(camera, poses).noisy(0.1, rng)
    assert all(len(set(v.uv[:, 0] > MIDDLE[0])) == 1 for v in views)
    assert find_two_pictures(calibrate(views, VGA, model="pinhole"), views) is None


def test_what_a_wrong_lens_leaves_open_is_no_finding_beside_it() -> None:
    made = inject_fault("wide-lens", 3000)
    calibration = calibrate(made.views, made.size, model=made.options["model"])
    assert {u.name for u in calibration.undetermined} & {"k1", "k2", "k3"}
    findings = list_findings(calibration, made.views)
    assert [finding.cause for finding in findings] == [Cause.LENS]


def test_a_held_value_is_named_and_freed() -> None:
    finding = found(CLEAN, fix={"fx": 600.0})[0]
    assert finding.cause is Cause.HELD_VALUE
    assert "fx" in finding.message
    assert "650" in finding.evidence
    assert found(CLEAN, fix={"fx": 650.0}) == ()


def test_values_that_are_held_wrongly_together_are_freed_together() -> None:
    fixed = {"cx": 330.0, "cy": 220.0, "k3": -0.04}
    calibration = calibrate(CLEAN, VGA, fix=fixed)
    (finding,) = list_findings(calibration, CLEAN)
    assert finding.cause is Cause.HELD_VALUE
    assert finding.message == "The views contradict the values at which cx, cy are held."
    assert finding.action is not None and finding.action.parameters == ("cx", "cy")
    trial = try_action(finding.action, calibration, CLEAN)
    assert trial is not None and "k3" in trial.calibration.fixed
    assert list_findings(trial.calibration, CLEAN) == ()


def test_harm_of_a_held_value_is_the_error_where_there_are_corners() -> None:
    calibration = calibrate(CLEAN, VGA, fix={"fx": 640.0})
    error = compare_cameras(barrel(), calibration.camera, views=CLEAN)
    (finding,) = list_findings(calibration, CLEAN)
    assert finding.harm == pytest.approx(error.rms, rel=0.03)
    assert finding.harm < 0.7 * error.worst


def test_views_of_another_camera_are_no_misplaced_corners() -> None:
    change = np.array([-37.5, -37.5, 15.0, 15.0, 0, 0, 0, 0, 0, 0])
    made = scene(barrel(), 16, seed=3)
    others = scene(Camera(VGA, barrel().params + change), 16, seed=3)
    rng = np.random.default_rng(1)
    pairs = zip(made.noisy(0.07, rng), others.noisy(0.07, rng), strict=True)
    (finding,) = found([b if k in (2, 7, 12) else a for k, (a, b) in enumerate(pairs)])
    assert finding.cause is Cause.MIXED_VIEWS
    assert finding.views == (2, 7, 12)


@pytest.mark.parametrize("roughness", [0.2, 0.6])
def test_corners_are_misplaced_on_a_rough_board_and_both_are_named(roughness: float) -> None:
    def print_roughly(xy: Array) -> Array:
        shifts = np.random.default_rng(1).normal(scale=roughness, size=(len(xy), 3))
        return np.asarray(np.column_stack([xy, np.zeros(len(xy))]) + shifts)

    views = photograph(draw_rendered_set(np.random.default_rng(0)), displace=print_roughly)
    uv, xy, _ = views[3]
    row = np.flatnonzero(xy[:, 1] == np.unique(xy[:, 1])[2])
    uv = np.array(uv)
    uv[row[:-1]] = uv[row[1:]]
    views[3] = Observation(uv, xy)
    calibration = calibrate(views, VGA)
    first, second = list_findings(calibration, views)
    assert (first.cause, second.cause) == (Cause.MISPLACED_CORNERS, Cause.BOARD_SHAPE)
    assert 3 in first.views
    shown = format_two_digits(summarise_residuals(calibration.residuals).rms)
    assert f"of {shown} px RMS;" in first.evidence
    assert f" px RMS ({shown} px with the corners that do not fit)" in second.evidence


def test_corners_are_misplaced_where_other_views_have_motion_and_long_tails() -> None:
    rng, views = np.random.default_rng(1), []
    for view in scene(barrel(), 12, seed=3).noisy(0.0, rng):
        moved = (view.uv[:, 1:] / VGA[1] - 0.5) * rng.normal(0, 0.3, 2)
        noise = 0.04 * rng.standard_t(3, view.uv.shape)
        views.append(Observation(view.uv + moved + noise, view.xy))
    first, second = np.array(views[2].uv), np.array(views[5].uv)
    first[-40:], second[-40:] = views[5].uv[-40:], views[2].uv[-40:]
    views[2], views[5] = Observation(first, views[2].xy), Observation(second, views[5].xy)
    finding = found(views)[0]
    assert finding.cause is Cause.MISPLACED_CORNERS
    assert set(finding.views[:2]) == {2, 5}


@pytest.mark.parametrize("seed", [4, 5, 6])
def test_views_all_alike_are_too_few_whatever_they_have_in_common(seed: int) -> None:
    """A burst magnifies errors of corners that all photographs share."""
    camera, rng = barrel(), np.random.default_rng(seed)
    pose = looking(camera, np.random.default_rng(seed))
    moved = rng.normal(0, 1.0, (12, 2, 3)) * [[[2e-3], [1.0]]]
    poses = [replace(pose, rvec=pose.rvec + r, tvec=pose.tvec + t) for r, t in moved]
    made = seen(camera, poses).noisy(0.02, rng)
    shared = rng.normal(0, 0.02, made[0].uv.shape)
    (finding,) = found([Observation(view.uv + shared, view.xy) for view in made])
    assert finding.cause is Cause.FEW_VIEWS
    assert finding.message == "The views are too few, or too much alike."


def test_boards_in_the_middle_of_the_image_are_too_far_away_and_not_too_few() -> None:
    views = scene_in_the_middle(barrel(), 10, seed=1, spread=0.05)
    (finding,) = found(views.noisy(0.02, np.random.default_rng(1)))
    assert finding.cause is Cause.FEW_VIEWS
    assert finding.message.startswith("Corners cover only 9 % of the image")
    assert "corners" in finding.remedy
    assert "too few" not in finding.message


def test_the_search_for_causes_tells_of_its_steps_and_can_be_abandoned() -> None:
    calibration, steps = calibrate(CLEAN, VGA), []

    def abandon() -> None:
        steps.append(len(steps))
        if len(steps) == 5:
            raise Cancelled

    with pytest.raises(Cancelled):
        list_findings(calibration, CLEAN, check=abandon)
    assert len(steps) == 5


def test_two_views_are_too_few() -> None:
    finding = found(CLEAN[:2])[0]
    assert finding.cause is Cause.FEW_VIEWS
    assert "2 views" in finding.message


def test_another_frame_is_named_or_refused() -> None:
    centred = [Observation(view.uv - MIDDLE, view.xy) for view in CLEAN]
    with pytest.raises(CalibrationError, match="left of the image or above it") as caught:
        calibrate(centred, VGA)
    assert "upper left pixel" in caught.value.hint
    finding = find_wrong_frame(Camera((1600, 1200), barrel().params), CLEAN)
    assert finding is not None
    assert "upper left quarter" in finding.message
    assert find_wrong_frame(barrel(), CLEAN) is None


def test_corners_are_not_misplaced_where_the_board_was_not_printed_true() -> None:
    """Sharp views of squares that are half a percent too high miss by many of their sigmas."""
    views = scene(barrel(), 8, seed=2).noisy(0.004, np.random.default_rng(1))
    stretched = [Observation(view.uv, view.xy * [1.0, 1.005]) for view in views]
    found = list_findings(calibrate(stretched, VGA), stretched)
    assert [finding.cause for finding in found] == [Cause.BOARD_SHAPE]


def test_a_lens_is_named_by_what_it_misses_beside_an_estimated_board() -> None:
    """Standard deviations do not include what a lens leaves where the board takes it up."""
    made = inject_fault("wide-lens-rough-print", 7301)
    found = list_findings(calibrate(made.views, made.size, **made.options), made.views)
    assert [finding.cause for finding in found] == [Cause.LENS]
    assert found[0].harm == pytest.approx(0.08, abs=0.01)

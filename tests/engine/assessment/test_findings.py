"""What is wrong with a calibration is named by its cause, and nothing where nothing is wrong."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.assessment import input_errors
from calibgui.engine.assessment.comparison import compare_cameras
from calibgui.engine.assessment.finding import Cause, Finding
from calibgui.engine.assessment.findings import list_findings
from calibgui.engine.assessment.input_errors import find_wrong_frame, screen_misplaced_corners
from calibgui.engine.assessment.side_by_side import find_two_pictures
from calibgui.engine.assessment.verdict import try_action
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector
from tests.engine.scenes import BOARD, VGA, barrel, looking, scene, seen
from tests.faults.campaign import inject_fault
from tests.faults.sets import change_camera, draw_rendered_set, photograph

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


def test_a_wrong_lens_is_named_before_the_board() -> None:
    findings = found(CLEAN, model="pinhole")
    assert [finding.cause for finding in findings] == [Cause.LENS]
    assert "pinhole" in findings[0].message


def print_badly(xy: Array) -> Array:
    """Return where the corners (n, 2) of a print lie that is off by half a millimetre, (n, 3)."""
    rng = np.random.default_rng(3)
    off = {tuple(p): rng.normal(0, 0.3, 3) for p in BOARD.points().tolist()}
    return np.array([[*p, 0.0] + off[tuple(p)] for p in xy.tolist()])


@pytest.mark.parametrize("board", ["nominal", "free"])
def test_a_fisheye_is_the_cause_where_the_board_is_off_as_well(board: str) -> None:
    lens = np.array([230.0, 230.0, 312.0, 246.0, 0.02, -6e-3, 3e-3, -1.5e-3])
    views = photograph(
        draw_rendered_set(np.random.default_rng(5), Camera(VGA, lens, "kannala-brandt")),
        displace=print_badly,
    )
    findings = found(views, board_shape=board)
    assert [finding.cause for finding in findings] == [Cause.LENS]
    assert ("estimates the board's shape" in findings[0].evidence) is (board == "nominal")
    followed = found(views, model="kannala-brandt")
    assert [finding.cause for finding in followed] == [Cause.BOARD_SHAPE]
    assert found(views, model="kannala-brandt", board_shape="free") == ()


def test_photographs_of_a_stereo_pair_are_two_kinds_where_the_board_is_off_as_well() -> None:
    photographed = draw_rendered_set(np.random.default_rng(11))
    left, count = photographed.camera, len(photographed.poses)
    right = change_camera(left, cx=1.06, cy=0.94)
    views = photograph(
        photographed, [left, right] * (count // 2) + [left] * (count % 2), print_badly
    )
    (finding,) = found(views)
    assert finding.cause is Cause.MIXED_VIEWS
    assert set(finding.views) in ({*range(0, count, 2)}, {*range(1, count, 2)})
    one = [view for k, view in enumerate(views) if k not in finding.views]
    assert [finding.cause for finding in found(one)] == [Cause.BOARD_SHAPE]


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
    first, second = found(views)
    assert (first.cause, second.cause) == (Cause.MISPLACED_CORNERS, Cause.BOARD_SHAPE)
    assert 3 in first.views


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


def test_stabilised_images_are_no_rolling_shutter() -> None:
    """The principal point wanders with the image; motion within a view has more unknowns."""
    rng = np.random.default_rng(5)
    stabilised = []
    for view in scene(barrel(), 15, seed=3).noisy(0.1, rng):
        uv = view.uv + rng.normal(scale=10.0, size=2)
        inside = ((uv >= 0) & (uv < barrel().size)).all(axis=1)
        stabilised.append(Observation(uv[inside], view.xy[inside]))
    named = list_findings(calibrate(stabilised, barrel().size), stabilised)
    assert [finding.cause for finding in named] == [Cause.MOVING_CENTRE]
    assert "stabilisation off" in named[0].remedy


def test_paper_that_curls_anew_in_each_view_is_no_rolling_shutter() -> None:
    """No test is of such paper, and motion with the rows explains more than half of it."""
    rng = np.random.default_rng(2)
    camera, xy = barrel(), BOARD.points()
    x, y = (2 * (xy - xy.mean(axis=0)) / np.ptp(xy, axis=0)).T
    shapes = np.stack([x**2, x * y, y**2, x**3, x**2 * y, x * y**2, y**3], axis=1)
    views = []
    for pose in scene(camera, 12, seed=3).poses:
        bent = np.column_stack([xy, shapes @ rng.normal(size=7)])
        points = bent @ rotation_from_vector(pose.rvec).T + pose.tvec
        uv = pixels_from_rays(points, camera)
        views.append(Observation(uv + rng.normal(0, 0.05, uv.shape), xy))
    (finding,) = found(views)
    assert finding.cause is Cause.DISAGREEMENT
    assert "in its own way" in finding.message
    assert "stiff" in finding.remedy
    assert finding.harm > 0.1


def test_a_blurred_edge_of_the_image_is_no_other_lens() -> None:
    rng, views = np.random.default_rng(2), []
    for view in scene(barrel(), 20, seed=2).views:
        radius = np.linalg.norm(view.uv - np.array(barrel().size) / 2, axis=1) / 400
        noise = (0.1 + radius**3)[:, None] * rng.normal(size=view.uv.shape)
        views.append(Observation(view.uv + noise, view.xy))
    assert list_findings(calibrate(views, barrel().size), views) == ()


def test_few_views_of_a_stretched_board_agree_enough() -> None:
    """Five views cannot agree by more than 3.2; motion in each has 30 unknowns for a board's 2."""
    board = Board(rows=4, cols=5, square=30.0)
    camera, rng = barrel(), np.random.default_rng(2)
    poses = [looking(camera, rng, board=board, fill=(0.5, 0.6)) for _ in range(5)]
    views = [
        Observation(view.uv, view.xy / [1.0, 1.02])
        for view in seen(camera, poses, board=board).noisy(0.05, rng)
    ]
    named = list_findings(calibrate(views, camera.size), views)
    assert [finding.cause for finding in named] == [Cause.BOARD_SHAPE]


def test_three_views_that_do_not_tell_board_and_lens_apart_are_too_few() -> None:
    drawn = scene(barrel(), 3, seed=1).noisy(0.005, np.random.default_rng(1))
    views = [Observation(view.uv, view.xy / [1.0003, 1.0]) for view in drawn]
    (finding,) = found(views, fix=["p3"])
    assert finding.cause is Cause.FEW_VIEWS
    assert finding.message.startswith("3 views are too few to tell whether the lens model")
    assert found(drawn, fix=["p3"]) == ()


def test_a_bent_board_is_named_if_it_matters() -> None:
    def bent(height: float) -> list[Observation]:
        made = scene(barrel(), 10, seed=3)
        extent = np.ptp(CLEAN[0].xy, axis=0) / 2
        views = []
        for pose, view in zip(made.poses, CLEAN, strict=True):
            x = (view.xy[:, 0] - view.xy[:, 0].mean()) / extent[0]
            lifted = np.column_stack([view.xy, height * (1 - x**2)])
            R = rotation_from_vector(np.array(pose.rvec))
            uv = pixels_from_rays(lifted @ R.T + pose.tvec, barrel())
            noise = np.random.default_rng(len(views)).normal(0, 0.1, uv.shape)
            views.append(Observation(uv + noise, view.xy))
        return views

    finding = found(bent(2.0))[0]
    assert finding.cause is Cause.BOARD_SHAPE
    assert "mm" in finding.evidence
    assert found(bent(0.01)) == ()


def test_a_bowed_board_is_named_though_its_lens_is_followed_almost() -> None:
    """It moves pixels by several, and the decentering that is held at 0 by a tenth of one."""
    photographed = draw_rendered_set(np.random.default_rng(2))
    exact = replace(
        photographed,
        noise=tuple(0.006 / photographed.level * noise for noise in photographed.noise),
    )
    middle, half = BOARD.points().mean(axis=0)[0], np.ptp(BOARD.points()[:, 0]) / 2
    views = photograph(
        exact, displace=lambda xy: np.column_stack([xy, 4 * ((xy[:, 0] - middle) / half) ** 2])
    )
    findings = found(views, fix=["p1", "p2"])
    assert [finding.cause for finding in findings] == [Cause.BOARD_SHAPE]


@pytest.mark.parametrize("every", [2, 3])
def test_photographs_stored_upside_down_are_named_and_not_a_board(every: int) -> None:
    """They move the principal point to the image's other side, as much as a free board follows."""
    turned = [
        Observation(2 * MIDDLE - view.uv, view.xy) if k % every else view
        for k, view in enumerate(CLEAN)
    ]
    (finding,) = found(turned)
    upright = tuple(range(0, len(turned), every))
    assert finding.cause is Cause.MIXED_VIEWS
    assert set(finding.views) in (set(upright), set(range(len(turned))) - set(upright))
    assert "upside down" in finding.message and "Turn them by 180 degrees" in finding.remedy


def test_views_all_alike_are_too_few_whatever_they_have_in_common() -> None:
    """A burst magnifies errors of corners that all photographs share."""
    camera, rng = barrel(), np.random.default_rng(4)
    pose = looking(camera, np.random.default_rng(4))
    moved = rng.normal(0, 1.0, (12, 2, 3)) * [[[2e-3], [1.0]]]
    poses = [replace(pose, rvec=pose.rvec + r, tvec=pose.tvec + t) for r, t in moved]
    made = seen(camera, poses).noisy(0.02, rng)
    shared = rng.normal(0, 0.02, made[0].uv.shape)
    (finding,) = found([Observation(view.uv + shared, view.xy) for view in made])
    assert finding.cause is Cause.FEW_VIEWS
    assert finding.message == "The views are too few, or too much alike."


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

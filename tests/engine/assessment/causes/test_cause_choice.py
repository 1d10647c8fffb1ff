"""Residuals that are not noise are given the cause that made them, and no other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.causes.findings import list_findings
from calibgui.engine.assessment.finding import Cause, Finding
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.geometry.rotations import rotation_from_vector
from tests.engine.scenes import BOARD, VGA, barrel, looking, scene, seen
from tests.faults.campaign import inject_fault
from tests.faults.sets import change_camera, draw_rendered_set, photograph

CLEAN = scene(barrel(), 10, seed=3).noisy(0.1, np.random.default_rng(1))
MIDDLE = np.array([319.5, 239.5])


def found(views: list[Observation], **settings: object) -> tuple[Finding, ...]:
    return list_findings(calibrate(views, VGA, **settings), views)  # type: ignore[arg-type]


def test_a_wrong_lens_is_named_before_the_board() -> None:
    findings = found(CLEAN, model="pinhole")
    assert [finding.cause for finding in findings] == [Cause.LENS]
    assert "Pinhole" in findings[0].message


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
    assert ("with the board as calibrated" in findings[0].evidence) is (board == "nominal")
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


def test_a_weak_rolling_shutter_is_no_changing_focus() -> None:
    """It has six unknowns in each view, four of which explain nothing, and focus has one."""
    made = inject_fault("rolling-shutter", 31031)
    named = list_findings(calibrate(made.views, made.size), made.views)
    assert [finding.cause for finding in named] == [Cause.ROLLING_SHUTTER]


def test_shifted_rows_are_named_and_do_not_hide_focus_or_squares() -> None:
    """They let causes with many unknowns explain more than their share."""
    rng = np.random.default_rng(3)

    def shift_rows(uv: Array, size: float) -> Array:
        shift = np.interp(uv[:, 1], np.arange(0, 481, 20), rng.normal(0, size, 25))
        return np.asarray(uv + np.column_stack([shift, 0 * shift]))

    views, centre = scene(barrel(), 14, seed=3).noisy(0.05, rng), barrel().centre
    scales = 1 + rng.normal(0, 0.004, len(views))
    for cause in (Cause.FOCUS, Cause.BOARD_SHAPE, Cause.LINE_JITTER):
        changed = []
        for k, (uv, xy, _) in enumerate(views):
            if cause is Cause.FOCUS:
                uv = centre + scales[k] * (uv - centre)
            if cause is Cause.BOARD_SHAPE:
                xy = xy / [1.0, 1.003]
            size = 0.2 if cause is Cause.LINE_JITTER else 0.07
            changed.append(Observation(shift_rows(uv, size), xy))
        assert [finding.cause for finding in found(changed)] == [cause]


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


def test_photographs_stored_mirrored_are_named() -> None:
    """A board that is seen in a mirror is numbered from its other side."""
    mirrored = [
        Observation(view.uv * [-1, 1] + [2 * MIDDLE[0], 0], view.xy * [-1, 1]) if k % 2 else view
        for k, view in enumerate(CLEAN)
    ]
    (finding,) = found(mirrored)
    assert "are mirrored left to right against the others" in finding.message
    assert finding.remedy.startswith("Mirror them left to right, or take the files")


def test_two_cameras_alike_are_not_said_to_be_turned() -> None:
    """Turned back, the second has its principal point nearer to the first, but not there."""
    rng = np.random.default_rng(714)
    photographed = draw_rendered_set(rng)
    params = photographed.camera.params
    left, right = (
        Camera(VGA, [*(params[:2] * focal), *(MIDDLE + off), *params[4:]])
        for off, focal in zip(rng.normal(0, 6.0, (2, 2)), rng.normal(1, 0.003, 2), strict=True)
    )
    (finding,) = found(photograph(photographed, [left, right] * (len(photographed.poses) // 2)))
    assert finding.cause is Cause.MIXED_VIEWS
    assert "are of two kinds" in finding.message


def test_a_fisheye_that_a_pinhole_does_not_follow_is_no_lack_of_views() -> None:
    """Of these ten the noise, if it were all that a pinhole leaves, would leave pixels unknown."""
    fisheye = Camera(VGA, [330.0, 330.0, 312.0, 246.0, -0.02, 4e-3, -3e-3, 4e-4], "kannala-brandt")
    views = photograph(draw_rendered_set(np.random.default_rng([1373, 0]), fisheye))
    findings = list_findings(calibrate(views, VGA, model="pinhole"), views)
    assert [finding.cause for finding in findings] == [Cause.LENS]


def test_a_board_under_glass_is_not_said_to_bend_for_certain() -> None:
    """Glass of 6 mm moves corners by the angle at which they are seen."""
    camera, rng = barrel(), np.random.default_rng(12)
    poses = [looking(camera, rng) for _ in range(14)]
    views = []
    for pose, view in zip(poses, seen(camera, poses).views, strict=True):
        R = rotation_from_vector(np.array(pose.rvec))
        board = np.column_stack([view.xy, np.zeros(len(view.xy))])
        towards = -(R.T @ np.array(pose.tvec)) - board
        flat, height = np.linalg.norm(towards[:, :2], axis=1), np.abs(towards[:, 2])
        sine = flat / np.hypot(flat, height)
        shift = 6.0 * (flat / height - sine / 1.5 / np.sqrt(1 - (sine / 1.5) ** 2))
        board[:, :2] -= towards[:, :2] * (shift / flat)[:, None]
        uv = pixels_from_rays(board @ R.T + pose.tvec, camera)
        views.append(Observation(uv + rng.normal(0, 0.03, uv.shape), view.xy))
    finding = found(views)[0]
    assert finding.cause is Cause.BENDING_BOARD
    assert "glass" in finding.message
    assert "glass" in finding.remedy

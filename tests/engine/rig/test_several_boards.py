"""Rigs with several boards that stand fast to each other: truth without noise, honest errors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.rig import Mistake, Rig, RigBoard, RigCamera, calibrate_rig
from tests.engine.rig.scenes import (
    check_rigs_honest,
    compose,
    disturb,
    measure_pose_error,
    photograph_board,
)
from tests.engine.rig.several_boards import BoardsScene, make_boards_rig, take_views

Kept = Callable[[int, int, int], bool]


def calibrate(scene: BoardsScene, boards: list[RigBoard] | None = None) -> Rig:
    cameras = disturb(scene.rig.cameras, np.random.default_rng(1))
    return calibrate_rig(cameras, boards=boards or scene.boards)


def check_truth(rig: Rig, scene: BoardsScene) -> None:
    """Check cameras, places of boards and lenses to 1e-9, of lengths of some 1000 mm."""
    for found, true in (
        (rig.poses, scene.rig.poses),
        ([board.pose for board in rig.placed_boards], scene.places),
    ):
        turn, move = measure_pose_error(found, true)
        assert turn < 1e-9
        assert move < 1e-9 * 1000
    for camera, known in zip(rig.cameras, scene.rig.cameras, strict=True):
        np.testing.assert_allclose(camera.params, known.camera.params, atol=1e-7)
    assert rig.rms < 1e-9
    assert not rig.left_out


@pytest.mark.parametrize(("cameras", "boards"), [(2, 2), (4, 3)])
def test_boards_and_mixed_lenses_without_noise_are_found_exactly(cameras: int, boards: int) -> None:
    scene = make_boards_rig(cameras, boards)
    rig = calibrate(scene)
    check_truth(rig, scene)
    assert len(rig.views) == sum(
        len(views) for camera in scene.rig.cameras for views in camera.views_by_board
    )
    assert (rig.board_sigma(0) == 0).all()
    assert [board.name for board in rig.placed_boards] == [board.name for board in scene.boards]


NO_COMMON_BOARD: dict[str, tuple[int, Kept]] = {
    "the first camera saw both boards before": (2, lambda c, b, k: c == b if k >= 12 else c == 0),
    "a third camera sees both": (3, lambda c, b, _: c in (2, b)),
    "two others see one each, at other instants": (
        4,
        lambda c, b, k: (c in (0, 2, 3) and b == 0) if k < 8 else (c in (2, 3) and b == c - 2)
        if k < 16 else (c, b) in ((1, 1), (2, 0)),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", NO_COMMON_BOARD)
def test_cameras_without_a_common_board_are_joined_by_two(name: str) -> None:
    count, is_kept = NO_COMMON_BOARD[name]
    scene = make_boards_rig(count, 2, 24).keep(is_kept)
    first, second = (camera.views_by_board for camera in scene.rig.cameras[:2])
    assert not any(set(a) & set(b) for a, b in zip(first, second, strict=True))
    check_truth(calibrate(scene), scene)


def test_a_stated_place_joins_what_nothing_else_does() -> None:
    scene = make_boards_rig(2, 2).keep(lambda c, b, _: c == b)
    with pytest.raises(CalibrationError) as failed:
        calibrate(scene)
    assert "cam0 (see board 1); cam1 (see board 2)" in failed.value.message
    assert "state how these boards stand" in failed.value.hint
    rig = calibrate(scene, [RigBoard("board 1"), RigBoard("board 2", scene.places[1])])
    check_truth(rig, scene)
    assert not rig.board_sigma(1).any()


def test_boards_that_are_never_seen_together_have_no_place_beside_each_other() -> None:
    scene = make_boards_rig(3, 2, 24).keep(
        lambda c, b, k: (c < 2 and b == 0) if k < 12 else (c > 0 and b == 1)
    )
    rig = calibrate(scene)
    assert [board.reference for board in rig.placed_boards] == [0, 1]
    assert not rig.placed_boards[1].pose.tvec.any()
    assert {(pair.first, pair.second) for pair in rig.pairs} == {(0, 1), (1, 2)}
    turn, move = measure_pose_error(rig.poses, scene.rig.poses)
    assert turn < 1e-9
    assert move < 1e-6
    # The rig has the second board itself where it alone is seen.
    there = compose(scene.rig.boards[-1], scene.places[1])
    assert measure_pose_error([rig.boards[-1]], [there])[1] < 1e-6


def test_a_board_that_no_camera_sees_is_named() -> None:
    scene = make_boards_rig(2, 2)
    with pytest.raises(CalibrationError, match="No photograph shows the third"):
        calibrate(scene, [*scene.boards, RigBoard("the third")])


def test_offsets_in_time_are_found_with_several_boards() -> None:
    """All boards move on evenly, and one camera is late."""
    scene, late = make_boards_rig(2, 2, 3), 0.2
    start, cameras = scene.rig.boards[0], []
    for c, camera in enumerate(scene.rig.cameras):
        views: list[dict] = [{}, {}]
        for k in range(16):
            time = k + late * c
            first = Pose(start.rvec + 0.02 * time, start.tvec + np.array([4.0, 2.0, -3.0]) * time)
            for b, place in enumerate(scene.places):
                pose = compose(scene.rig.poses[c], compose(first, place))
                if (view := photograph_board(camera.camera, pose)) is not None:
                    views[b][k] = view
        cameras.append(take_views(camera, views))
    held = [camera.hold() for camera in cameras]
    rig = calibrate_rig(held, estimate_offsets=True, boards=scene.boards)
    assert rig.offsets[1] == pytest.approx(late, abs=2e-3)
    assert measure_pose_error([rig.placed_boards[1].pose], scene.places[1:])[1] < 0.1


@pytest.mark.slow
def test_covariances_of_boards_are_those_of_draws() -> None:
    """Of 300 draws the ratio was 0.93 to 1.05 (board) and 0.93 to 1.07 (camera)."""
    scene, rng = make_boards_rig(3, 2), np.random.default_rng(5)
    rigs = [calibrate_rig(scene.noisy(0.1, rng), boards=scene.boards) for _ in range(20)]
    check_rigs_honest(rigs, scene.rig, scene.places[1:])


def see_moved(scene: BoardsScene, moved: Pose, first: int) -> list[RigCamera]:
    """What cameras see with noise if the second board stands otherwise from an instant on."""
    rng = np.random.default_rng(3)
    cameras = []
    for camera, pose in zip(scene.rig.cameras, scene.rig.poses, strict=True):
        views: list[dict] = [{}, {}]
        for k, board in enumerate(scene.rig.boards):
            places = (
                scene.places[0],
                compose(moved, scene.places[1]) if k >= first else scene.places[1],
            )
            for b, place in enumerate(places):
                view = photograph_board(camera.camera, compose(pose, compose(board, place)))
                if view is not None:
                    noise = rng.normal(0, 0.1, view.uv.shape)
                    views[b][k] = view._replace(uv=view.uv + noise)
        cameras.append(take_views(camera, views))
    return cameras


def test_boards_that_move_against_each_other_are_named() -> None:
    moved = Pose([0.004, -0.006, 0.003], [2.0, -1.5, 1.0])
    for seed in range(2):
        scene = make_boards_rig(2, 2, 24, seed)
        [mistake] = calibrate_rig(see_moved(scene, moved, 12), boards=scene.boards).mistakes
        assert mistake.kind is Mistake.BOARDS_MOVED
        assert abs(mistake.instants[0] - 12) <= 3
    still = calibrate_rig(see_moved(scene, moved, 24), boards=scene.boards)
    assert not still.mistakes


def test_a_photograph_of_another_instant_is_left_out_with_all_its_boards() -> None:
    scene = make_boards_rig(2, 2, 20)
    cameras = scene.noisy(0.1, np.random.default_rng(4))
    views = [dict(each) for each in cameras[1].views_by_board]
    for each in views:
        each[4], each[9] = each[9], each[4]
    rig = calibrate_rig([cameras[0], take_views(cameras[1], views)], boards=scene.boards)
    assert {(view.board, view.instant) for view in rig.left_out} == {
        (board, instant) for board in (0, 1) for instant in (4, 9)
    }
    [mistake] = rig.mistakes
    assert mistake.kind is Mistake.OTHER_INSTANT
    assert mistake.instants == (4, 9)


def test_a_board_that_one_camera_has_wrong_throughout_is_left_out_there() -> None:
    scene = make_boards_rig(3, 2, 20)
    cameras = scene.noisy(0.1, np.random.default_rng(4))
    first, second = cameras[1].views_by_board
    others = list(second.values())[8:11]
    cameras[1] = take_views(cameras[1], [dict(first), dict(enumerate(others))])
    shaped = [replace(board, shape=BoardShapeModel.BOW) for board in scene.boards]
    for boards in (scene.boards, shaped):
        rig = calibrate_rig(cameras, boards=boards)
        assert {(view.camera, view.board) for view in rig.left_out} == {(1, 1)}
        assert len(rig.left_out) == 3
        assert rig.rms == pytest.approx(0.1 * np.sqrt(2), rel=0.05)

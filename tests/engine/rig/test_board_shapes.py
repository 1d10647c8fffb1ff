"""The shapes of a rig's boards are estimated with it, shared by all cameras."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.errors import CalibrationError
from calibgui.engine.rig import Rig, RigCamera, calibrate_rig
from tests.engine.rig.scenes import BOARD, check_rigs_honest, disturb, measure_pose_error
from tests.engine.rig.several_boards import BoardsScene, bend_board, make_boards_rig

BENT = bend_board(1.0, 0.5)
ORDER = np.lexsort(BOARD.points().T[::-1])
"""The order of a shape's corners: by x and then y."""


def calibrate(scene: BoardsScene, cameras: list[RigCamera], shape: str) -> Rig:
    boards = [replace(board, shape=BoardShapeModel(shape)) for board in scene.boards]
    return calibrate_rig(cameras, boards=boards)


def test_bent_boards_without_noise_are_found_exactly() -> None:
    deviations = (BENT, -0.6 * BENT)
    scene = make_boards_rig(2, 2, 14, deviations=deviations)
    rig = calibrate(scene, disturb(scene.rig.cameras, np.random.default_rng(1)), "free")
    turn, move = measure_pose_error(rig.poses, scene.rig.poses)
    assert turn < 1e-9
    assert move < 1e-6
    for board, true in zip(rig.placed_boards, deviations, strict=True):
        assert board.shape is not None
        np.testing.assert_allclose(board.shape.nominal, BOARD.points()[ORDER])
        np.testing.assert_allclose(board.shape.deviation, true[ORDER], atol=1e-8)
    assert measure_pose_error([rig.placed_boards[1].pose], scene.places[1:])[1] < 1e-6


def test_a_bowed_board_is_a_bow() -> None:
    xy = BOARD.points()
    u, v = ((2 * xy - xy.max(axis=0)) / xy.max(axis=0)).T
    bow = np.column_stack([np.zeros_like(xy), 0.8 * (1 - u**2) - 0.3 * (1 - v**2)])
    scene = make_boards_rig(2, 1, 16, deviations=(bow,))
    rig = calibrate(scene, disturb(scene.rig.cameras, np.random.default_rng(1)), "bow")
    assert rig.rms < 1e-9
    shape = rig.placed_boards[0].shape
    assert shape is not None
    np.testing.assert_allclose(shape.deviation, bow[ORDER], atol=1e-8)


def test_a_shape_makes_the_rig_several_times_better_and_its_errors_honest() -> None:
    errors, scores, apart = {"nominal": [], "free": []}, [], []
    for seed in range(3):
        scene = make_boards_rig(3, 1, 24, seed, (BENT,))
        cameras = scene.noisy(0.1, np.random.default_rng(seed))
        for shape, found in errors.items():
            rig = calibrate(scene, cameras, shape)
            found.append(measure_pose_error(rig.poses, scene.rig.poses))
        away = rig.poses[2].tvec - scene.rig.poses[2].tvec
        scores.append(away / rig.pose_sigma(2)[3:])
        shape_found = rig.placed_boards[0].shape
        assert shape_found is not None
        apart.append((shape_found.deviation - BENT[ORDER]) / shape_found.sigma)
        assert rig.rms == pytest.approx(0.1 * np.sqrt(2), rel=0.05)
        assert rig.rms_alone < 1.01 * rig.rms  # on the board of that shape, too
        assert rig.disagreement < 1.3
    # Of 16 seeds the medians were 0.0050 rad and 0.67 mm for the drawing, 0.00029 rad and 0.060 mm
    # with the shape.
    turns, moves = np.median(errors["nominal"], axis=0) / np.median(errors["free"], axis=0)
    assert turns > 8
    assert moves > 3
    assert np.abs(scores).max() < 4
    assert 0.4 < np.sqrt(np.mean(np.square(apart))) < 1.2


@pytest.mark.slow
def test_covariances_beside_a_shape_are_those_of_draws() -> None:
    scene, rng = make_boards_rig(3, 1, 24, deviations=(BENT,)), np.random.default_rng(3)
    rigs = [calibrate(scene, scene.noisy(0.1, rng), "free") for _ in range(15)]
    check_rigs_honest(rigs, scene.rig)


def test_views_that_do_not_carry_a_shape_are_refused() -> None:
    scene = make_boards_rig(2, 1, 4)
    few = scene.keep(lambda c, _, k: k < 2 or (c == 0 and k == 2))
    with pytest.raises(CalibrationError, match="Shape of a board: 5 views cannot carry"):
        calibrate(few, [camera.hold() for camera in few.rig.cameras], "free")
    scene = make_boards_rig(2, 1, 12)
    cameras = [
        replace(
            camera.hold(),
            views={
                k: view._replace(uv=view.uv[keep], xy=view.xy[keep])
                for k, view in camera.views.items()
                if (keep := np.any(view.xy > 0, axis=1) | (k < 1)).any()
            },
        )
        for camera in scene.rig.cameras
    ]
    with pytest.raises(CalibrationError, match="1 of the board's 70 corners"):
        calibrate(scene, cameras, "free")

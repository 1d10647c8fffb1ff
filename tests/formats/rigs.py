"""A small rig with its corners, for the tests of formats."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np

from calibgui.dataset import RigResult
from calibgui.engine.boards import Board, BoardShapeModel, Charuco
from calibgui.engine.camera import Camera
from calibgui.engine.rig import Rig, RigCamera, calibrate_rig
from tests.engine.rig.scenes import BOARD, LENSES, make_rig
from tests.engine.rig.several_boards import make_boards_rig


@cache
def make_result(*lenses: Camera, count: int = 3) -> RigResult:
    """The rig of a scene with noise, whose cameras have these lenses in turn."""
    scene = make_rig(count, instants=6 * count, lenses=lenses or LENSES)
    cameras = scene.noisy(0.1, np.random.default_rng(1))
    return _gather(cameras, calibrate_rig(cameras), (BOARD,))


@cache
def make_result_of_boards() -> RigResult:
    """A rig of two cameras that see two boards, of which a shape is estimated."""
    scene = make_boards_rig(2, 2, 12)
    cameras = scene.noisy(0.1, np.random.default_rng(1))
    boards = [replace(board, shape=BoardShapeModel.BOW) for board in scene.boards]
    patterns = (Charuco("DICT_4X4_50", 0.7, False, first) for first in (0, 44))
    drawn = tuple(replace(BOARD, pattern=pattern) for pattern in patterns)
    return _gather(cameras, calibrate_rig(cameras, boards=boards), drawn)


def _gather(cameras: Sequence[RigCamera], rig: Rig, boards: tuple[Board, ...]) -> RigResult:
    seen = {
        (c, b, k): view
        for c, camera in enumerate(cameras)
        for b, views in enumerate(camera.views_by_board)
        for k, view in views.items()
    }
    return RigResult(
        rig,
        {instant: f"{instant:04d}" for instant in rig.instants},
        {(c, k): f"cam{c}/{k:04d}.png" for c, _, k in seen},
        seen,
        boards,
        remarks=("A remark.",),
    )

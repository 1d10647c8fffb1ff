"""Calibrations such as `calibgui paper` makes, from computed corners instead of photographs."""

from __future__ import annotations

import numpy as np

from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.calibrating.settings import Settings
from calibgui.dataset import CornerSet, Result, View, ViewStatus
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.result import Cost
from calibgui.engine.features.corners import Corners
from tests.engine import scenes

BOARD = Board(rows=8, cols=9, square=30.0)


def calibrate_paper_views(seed: int, views: int = 25, cost: Cost = Cost.PAPER) -> Result:
    """Calibrate `views` views with noise of 0.1 px, in the paper's formulation."""
    rng = np.random.default_rng(seed)
    camera = scenes.barrel()
    poses = [scenes.looking(camera, rng, board=BOARD) for _ in range(views)]
    found = []
    for k, seen in enumerate(scenes.seen(camera, poses, BOARD).noisy(0.1, rng), start=1):
        grid = np.rint(seen.xy[:, ::-1] / BOARD.square)
        corners = Corners((BOARD.rows, BOARD.cols), grid, seen.uv, seen.uv)
        found.append(View(f"Image{k}.tif", ViewStatus.FOUND, corners=corners))
    return calibrate_views(CornerSet(camera.size, tuple(found), BOARD), Settings(cost=cost))

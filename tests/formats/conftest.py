"""Results of synthetic scenes, with every kind of view that a file must hold."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui import engine
from calibgui.dataset import Result, View, ViewStatus
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.pattern import Symmetry
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera
from calibgui.engine.features.corners import Corners, OtherBoard
from calibgui.engine.images.fields import Field
from tests.engine import scenes

BOARD = Board(rows=6, cols=8, square=30.0)
_NOISE = 0.1


def solved(camera: Camera, model: str = "lucchese", weighted: bool = False, **options: object):
    """A calibration of five of eight views: partial, foreign, disabled and missing ones too."""
    rng = np.random.default_rng(7)
    poses = [scenes.looking(camera, rng, board=BOARD) for _ in range(6)]
    noisy = scenes.seen(camera, poses, BOARD).noisy(_NOISE, rng)
    views = [_found(f'Bild {k} ä,"日本".png', o, weighted) for k, o in enumerate(noisy)]
    views[1] = _found("half.png", Observation(noisy[1].uv[5:], noisy[1].xy[5:]), weighted)
    foreign = Observation(noisy[2].uv, noisy[2].xy, _covariances(48) if weighted else None)
    views[2] = View("foreign.png", ViewStatus.FOUND, points=foreign)
    views[3] = replace(views[3], enabled=False, roi=np.array([[0, 0], [9, 0], [9, 9], [0, 9.5]]))
    views[4] = replace(views[4], orientation=6, field=Field.EVEN)
    views.insert(0, View("dark.png", ViewStatus.NO_BOARD, "No board: the image is dark."))
    views.append(View("later.png"))
    used = [view.observation(BOARD) for view in views if view.usable]
    calibration = engine.calibrate(used, camera.size, model=model, **options)
    return Result(calibration, tuple(views), BOARD)


def _found(image: str, points: Observation, weighted: bool) -> View:
    corners = Corners(
        shape=(BOARD.rows, BOARD.cols),
        grid=np.rint(points.xy[:, ::-1] / BOARD.square),
        uv=points.uv,
        estimate=np.rint(points.uv),
        cov=_covariances(len(points.uv)) if weighted else None,
        ambiguity=Symmetry.HALF_TURN,
        roi=np.array([[1.5, 2], [600, 3], [610, 470], [5, 460]]),
        relative=len(points.uv) < BOARD.rows * BOARD.cols,
        others=(OtherBoard((4, 5), np.array([[9.5, 8], [90, 7], [95, 60], [8, 70]])),),
    )
    return View(image, ViewStatus.FOUND, corners=corners)


def _covariances(count: int) -> np.ndarray:
    rng = np.random.default_rng(count)
    u, v = rng.uniform(0.5, 1.5, (2, count)) * _NOISE
    uv = rng.uniform(-0.5, 0.5, count) * u * v
    return np.array([[u**2, uv], [uv, v**2]]).transpose(2, 0, 1)


@pytest.fixture(scope="session")
def result() -> Result:
    """The paper's model."""
    return solved(scenes.barrel())


@pytest.fixture(scope="session")
def weighted() -> Result:
    """Corners with covariances, pixels that are not square, p3 free and the centre held."""
    return solved(scenes.barrel(0.9), weighted=True, fix={"cx": 300.0, "cy": 250.0}, free=["p3"])


@pytest.fixture(scope="session")
def forward_result() -> Result:
    """OpenCV's model, calibrated as such."""
    return solved(scenes.brown(), model="brown-conrady")

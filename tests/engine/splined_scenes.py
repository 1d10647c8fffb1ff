"""Views of a camera with a splined lens, with known truth."""

from __future__ import annotations

import numpy as np

from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.observations import (
    Observation,
    Observations,
    pack_observations,
)
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.camera.models.splined_stereographic import (
    SplinedStereographic,
    rays_from_stereographic,
    stereographic_from_rays,
)
from calibgui.engine.geometry.rotations import rotation_from_vector


def make_splined_views(
    lens: SplinedStereographic,
    count: int,
    rng: np.random.Generator,
    board: Board | None = None,
    noise: float = 0.1,
    weighted: bool = False,
) -> tuple[State, Observations]:
    """Whole boards where four control points surround every corner, and the state behind them.

    Args:
        lens: the lens; its coefficients are random, a hundredth of a radian.
        count: number of views.
        rng: source of the choice.
        board: the board, 6 x 7 corners if None.
        noise: standard deviation of the corners, px.
        weighted: whether each corner has a covariance of its own, and every third view misses some.
    """
    xy = (board or Board(6, 7, 30.0)).points()
    k = rng.normal(0, 0.01, len(lens.names))
    params = np.concatenate([[1000.0, 1010.0, 1000.0, 750.0], k])
    views: list[Observation] = []
    R, T, surrounded = np.empty((count, 3, 3)), np.empty((count, 3)), lens.edge - lens.pitch
    while len(views) < count:
        turn = rotation_from_vector(rng.uniform(-0.6, 0.6, 3))
        towards = rays_from_stereographic(rng.uniform(-0.8, 0.8, 2) * surrounded)[0]
        place = rng.uniform(300, 700) * towards - turn[:, :2] @ xy.mean(axis=0)
        rays = xy @ turn[:, :2].T + place
        if (np.abs(stereographic_from_rays(rays)[0]) > surrounded).any():
            continue
        d = lens.project_points(rays, k)
        uv = params[2:4] + params[:2] * d + rng.normal(0, noise, d.shape)
        R[len(views)], T[len(views)] = turn, place
        n, cov = len(xy), None
        if weighted:
            n -= 4 * (len(views) % 3)
            root = rng.normal(size=(n, 2, 2))
            cov = root @ np.swapaxes(root, 1, 2) + 0.1 * np.eye(2)
        views.append(Observation(uv[:n], xy[:n], cov))
    return State(params, R, T), pack_observations(views)

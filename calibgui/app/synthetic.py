"""The synthetic check (paper 5.2): would the method find this camera again?

Every view is rendered from its estimated pose through the estimated camera, the corners are
located in the rendered images and the calibration is run on them with the same settings. What
it returns can be compared with the values that went into the rendering, which are exact. The
residuals that remain are the corner finder's; whatever the real residuals have beyond them
comes from the real board, lens and sensor.

A corner found in a rendered view takes the number of the real view's corner whose predicted
place it is nearest to, so that both calibrations rest on the same corners of the board however
the finder counts a symmetric or partly seen one.
"""

from __future__ import annotations

from contextlib import closing
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import scipy

from calibgui import engine
from calibgui.app.workers import Crashed, spread
from calibgui.dataset.result import Result
from calibgui.dataset.view import View, ViewStatus
from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.boards import Board, BoardShapeModel
from calibgui.engine.calibration import Calibration, Cost, settings_of
from calibgui.engine.camera import Camera, project_points
from calibgui.engine.detection import METHODS, Corners, find_corners
from calibgui.engine.errors import CalibrationError, NoBoardError, Progress
from calibgui.engine.geometry import Pose
from calibgui.engine.images import Appearance, render

BLUR = 1.0
"""Standard deviation of the rendered images' blur, px: that of a well focused photograph."""

_CRASHED = "The search for its board ended abnormally."


@dataclass(frozen=True, eq=False, slots=True)
class SyntheticCheck:
    """A calibration beside the one of its own synthetic views."""

    real: Result
    synthetic: Result
    """Its views are those of `real` that were calibrated, under the same names; corners are the
    rendered images'. A view whose rendering was not found again says why."""

    @property
    def extrinsic_errors(self) -> Array:
        """(K, 6) |(z_real - z_syn) / z_real| of omega, phi, theta, tX, tY, tZ (eq. 51).

        One row for each view that was found again, in the order of the synthetic views.
        """
        before, after = (
            np.array([pose.vector for pose in result.paper_poses()])
            for result in (self.real, self.synthetic)
        )
        found = [view.usable for view in self.synthetic.views]
        with np.errstate(divide="ignore"):
            return np.asarray(np.abs(1 - after / before[found]))


def synthetic_check(
    result: Result,
    *,
    blur: float = BLUR,
    noise: float = 0.0,
    progress: Progress | None = None,
) -> SyntheticCheck:
    """Render the views of `result`, and calibrate from the rendered images.

    Args:
        result: of a target of known pattern.
        blur: standard deviation of the images' blur, px.
        noise: standard deviation of the images' noise, grey levels.
        progress: told of each view.

    Raises:
        CalibrationError: if the target is not known, or too few rendered views are found again.
        Cancelled: from `progress`.
    """
    board = result.board
    if board is None:
        raise CalibrationError(
            "The views cannot be rendered: the target's pattern is not known.",
            "Calibrate from images of the target, or state its rows, columns and square.",
        )
    camera, poses, views = result.calibration.camera, result.calibration.poses, [*result.used]
    again = partial(_found_again, camera, board, _board_of(result.calibration), blur, noise)
    items = list(zip(range(len(views)), views, poses, strict=True))
    with closing(spread(again, items)) as found:
        for done, (k, view) in enumerate(found, start=1):
            views[k] = _lost(views[k], _CRASHED) if isinstance(view, Crashed) else view
            if progress is not None:
                progress(done, len(views))
    observations = [view.observation(board) for view in views if view.usable]
    settings = {**settings_of(result.calibration), "board_shape": BoardShapeModel.NOMINAL}
    calibration = engine.calibrate(observations, camera.size, **settings)
    return SyntheticCheck(result, replace(result, calibration=calibration, views=tuple(views)))


def _board_of(calibration: Calibration) -> Appearance:
    """The board that the calibration believes in.

    The paper's own grid makes its squares fx / fy as high as wide
    (``engine/estimation/stage_two.py``).
    """
    fx, fy = calibration.camera.focal
    return Appearance(stretch=fx / fy if calibration.cost is Cost.PAPER else 1.0)


def _found_again(
    camera: Camera,
    board: Board,
    grid_size: Appearance,
    blur: float,
    noise: float,
    item: tuple[int, View, Pose],
) -> View:
    """The view with the corners of its rendered image."""
    k, real, pose = item
    image = render(camera, pose, board, blur=blur, noise=noise, seed=k, appearance=grid_size)
    observed = real.observation(board)
    predicted = project_points(observed.xy, camera, pose)
    grid = np.indices(board.grid_size).reshape(2, -1).T
    grid = grid[np.asarray(scipy.spatial.cKDTree(board.points(grid)).query(observed.xy)[1])]
    try:
        method = METHODS[0] if real.corners is None else real.corners.method
        found = find_corners(image, board.grid_size, method=method, pattern=board.pattern)
        return replace(real, corners=_numbered(found, grid, predicted), points=None)
    except NoBoardError as error:
        return _lost(real, str(error))


def _lost(view: View, reason: str) -> View:
    return replace(view, status=ViewStatus.NO_BOARD, reason=reason, corners=None, points=None)


def _numbered(found: Corners, grid: IntArray, predicted: Array) -> Corners:
    """The found corners nearest to `predicted` (n, 2), numbered by `grid` (n, 2)."""
    nearest = scipy.spatial.cKDTree(predicted)
    limit = np.asarray(nearest.query(predicted, k=2)[0])[:, 1] / 2
    distance, which = map(np.asarray, nearest.query(found.uv))
    good = distance < limit[which]
    if np.count_nonzero(good) < len(predicted) / 2:
        raise NoBoardError(
            "The corners found in the rendered view are not where they were put.",
            "Its pose is doubtful: look at this view's residuals.",
        )
    return replace(
        found,
        grid=grid[which[good]],
        uv=found.uv[good],
        estimate=found.estimate[good],
        cov=None if found.cov is None else found.cov[good],
    )

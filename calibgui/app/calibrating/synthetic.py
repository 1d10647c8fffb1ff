"""The synthetic check (paper 5.2): a calibration from renderings of its own views.

Every view is rendered from its estimated pose through the estimated camera, the corners are
located in the rendered images and calibrated with the same settings. The estimates can be compared
with the values that were rendered, which are exact. The remaining residuals are errors of the
corner finder; anything beyond them in the real residuals comes from the real board, lens and
sensor. The noise that was found in the real residuals can be added to the rendered corners: what
the real residuals then have beyond the synthetic ones is no noise.

A corner found in a rendered view is numbered as the corner of the real view whose predicted
position is nearest, so that both calibrations use the same corners even if the finder numbers a
symmetric or partly seen board differently.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import scipy

from calibgui import engine
from calibgui.app.system.workers import Crashed, map_in_processes
from calibgui.dataset import Result, View, ViewStatus
from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.assessment import separate_error_sources
from calibgui.engine.boards import Board, BoardShapeModel
from calibgui.engine.calibration import Calibration, Cost, recover_arguments
from calibgui.engine.camera import Camera, project_points
from calibgui.engine.detection import find_corners
from calibgui.engine.errors import CalibrationError, NoBoardError, Progress
from calibgui.engine.features import METHODS, Corners
from calibgui.engine.geometry import Pose
from calibgui.engine.images import Appearance, render_view

BLUR_PX = 1.0
"""Standard deviation of the blur of rendered images, px: that of a well focused photograph."""

_CRASH_REASON = "The search for its board ended abnormally."


@dataclass(frozen=True, eq=False, slots=True)
class SyntheticCheck:
    """A calibration, and the one from its synthetic views."""

    real: Result
    synthetic: Result
    """Calibration from renderings. Its views are the used views of `real`, with the corners found
    in their renderings, or the reason why no board was found."""
    noise: float = 0.0
    """Standard deviation of each coordinate of the synthetic corners about the rendered place, px,
    that was asked for; 0 if nothing was added to the finder's own error."""

    @property
    def extrinsic_errors(self) -> Array:
        """Relative errors (K, 6) |(z_real - z_syn) / z_real| of the external parameters (eq. 51).

        The columns are omega, phi, theta, tX, tY, tZ.

        There is one row for each view whose board was found, in the order of the synthetic views.
        """
        before, after = (
            np.array([pose.vector for pose in result.paper_poses()])
            for result in (self.real, self.synthetic)
        )
        found = [view.usable for view in self.synthetic.views]
        with np.errstate(divide="ignore"):
            return np.asarray(np.abs(1 - after / before[found]))


def run_synthetic_check(
    result: Result,
    *,
    blur: float = BLUR_PX,
    corner_noise: float = 0.0,
    progress: Progress | None = None,
) -> SyntheticCheck:
    """Render the views of `result`, and calibrate from the rendered images.

    Args:
        result: calibration from a board of known pattern.
        blur: standard deviation of the blur of the images, px.
        corner_noise: standard deviation of each coordinate of the corners, px, up to which
            Gaussian noise is added to the finder's own error; see `measure_corner_noise`.
        progress: called after each view.

    Raises:
        CalibrationError: if the board is not known, or is found in too few rendered views.
        Cancelled: from `progress`.
    """
    board = result.board
    if board is None:
        raise CalibrationError(
            "The views cannot be rendered: the pattern of the board is not known.",
            "Calibrate from images of the board, or state its rows, columns and square.",
        )
    camera, poses, views = result.calibration.camera, result.calibration.poses, [*result.used]
    appearance = _make_appearance(result.calibration)
    again = partial(_search_rendered_view, camera, board, appearance, blur)
    items = list(zip(views, poses, strict=True))
    with closing(map_in_processes(again, items)) as found:
        for done, (k, view) in enumerate(found, start=1):
            views[k] = (
                _record_no_board(views[k], _CRASH_REASON) if isinstance(view, Crashed) else view
            )
            if progress is not None:
                progress(done, len(views))
    if corner_noise > 0:
        views = _add_corner_noise(views, result, board, corner_noise)
    observations = [view.observation(board) for view in views if view.usable]
    settings = {**recover_arguments(result.calibration), "board_shape": BoardShapeModel.NOMINAL}
    calibration = engine.calibrate(observations, camera.size, **settings)
    synthetic = replace(result, calibration=calibration, views=tuple(views))
    return SyntheticCheck(result, synthetic, corner_noise)


def measure_corner_noise(result: Result) -> float:
    """Measure the standard deviation of a coordinate of the corners, px, less systematic errors.

    It is the noise that is left of the residuals beside smooth errors of lens, board and single
    views (``separate_error_sources``), with the residuals that camera and poses took up.
    """
    sources = separate_error_sources(result.calibration, result.observations())
    return sources.noise / np.sqrt(2) * np.sqrt(_count_coordinates(result) / count_freedom(result))


def count_freedom(result: Result) -> int:
    """Return the number of coordinates less that of estimated parameters and poses, at least 1."""
    free = np.count_nonzero(result.calibration.sigma > 0)
    return max(_count_coordinates(result) - int(free) - 6 * len(result.used), 1)


def _count_coordinates(result: Result) -> int:
    return 2 * sum(len(view.image) for view in result.calibration.residuals)


def _add_corner_noise(
    views: Sequence[View], result: Result, board: Board, noise: float
) -> list[View]:
    """Displace the corners at random until they are `noise` px off the rendered places.

    The finder's own error counts towards that, so nothing is added if it is as large already.
    """
    camera, poses = result.calibration.camera, result.calibration.poses
    missed = [
        observed.uv - project_points(observed.xy, camera, pose)
        for view, pose in zip(views, poses, strict=True)
        if view.usable
        for observed in (view.observation(board),)
    ]
    own = float(np.mean(np.concatenate(missed) ** 2)) if missed else 0.0
    added = np.sqrt(max(noise**2 - own, 0.0))
    rng = np.random.default_rng(0)
    return [
        view
        if view.corners is None
        else replace(
            view,
            corners=replace(
                view.corners, uv=view.corners.uv + rng.normal(0.0, added, view.corners.uv.shape)
            ),
        )
        for view in views
    ]


def _make_appearance(calibration: Calibration) -> Appearance:
    """Return the appearance of the board that the calibration assumes.

    In the paper's own reference grid squares are fx / fy as high as wide.
    """
    fx, fy = calibration.camera.focal
    return Appearance(stretch=fx / fy if calibration.cost is Cost.PAPER else 1.0)


def _search_rendered_view(
    camera: Camera,
    board: Board,
    appearance: Appearance,
    blur: float,
    item: tuple[View, Pose],
) -> View:
    """Return the view with the corners of its rendered image."""
    real, pose = item
    image = render_view(camera, pose, board, blur=blur, appearance=appearance)
    observed = real.observation(board)
    predicted = project_points(observed.xy, camera, pose)
    grid = np.indices(board.grid_size).reshape(2, -1).T
    grid = grid[np.asarray(scipy.spatial.cKDTree(board.points(grid)).query(observed.xy)[1])]
    try:
        method = METHODS[0] if real.corners is None else real.corners.method
        found = find_corners(image, board.grid_size, method=method, pattern=board.pattern)
        return replace(real, corners=_assign_grid(found, grid, predicted), points=None)
    except NoBoardError as error:
        return _record_no_board(real, str(error))


def _record_no_board(view: View, reason: str) -> View:
    return replace(view, status=ViewStatus.NO_BOARD, reason=reason, corners=None, points=None)


def _assign_grid(found: Corners, grid: IntArray, predicted: Array) -> Corners:
    """Return the found corners nearest to `predicted` (n, 2) px, numbered by `grid` (n, 2)."""
    nearest = scipy.spatial.cKDTree(predicted)
    limit = np.asarray(nearest.query(predicted, k=2)[0])[:, 1] / 2
    distance, which = map(np.asarray, nearest.query(found.uv))
    good = distance < limit[which]
    if np.count_nonzero(good) < len(predicted) / 2:
        raise NoBoardError(
            "The corners found in the rendered view are not where they were rendered.",
            "Its pose is doubtful: look at the residuals of this view.",
        )
    return replace(
        found,
        grid=grid[which[good]],
        uv=found.uv[good],
        estimate=found.estimate[good],
        cov=None if found.cov is None else found.cov[good],
    )

"""Each camera of a rig alone: where the board was in each of its views, and how fast it moved.

The camera is held, and the poses are those of Stage II for it (``bundle_adjustment.py``). How well
a view tells its pose is the block V of its normal equations. The corners of all cameras count in
the same px: where they have covariances, each camera's weights are scaled alike.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.observations import Observations, pack_observations
from calibgui.engine.calibration.refinement.bundle_adjustment import solve_stage_two
from calibgui.engine.calibration.refinement.residuals import (
    State,
    compute_misses,
    compute_view_products,
)
from calibgui.engine.calibration.refinement.whitening import whiten_observations
from calibgui.engine.calibration.resection import estimate_poses
from calibgui.engine.calibration.result import Cost
from calibgui.engine.errors import CalibrationError
from calibgui.engine.rig.consensus import ViewPoses
from calibgui.engine.rig.records import RigCamera

_START_CORNERS = 16
"""Number of corners of a view from which a start is found: more cost time only."""


@dataclass(frozen=True, eq=False, slots=True)
class CameraAlone:
    """A camera of a rig, with the board where each of its views has it."""

    observations: Observations
    """The views, whitened."""
    poses: ViewPoses
    """The poses of the board in them."""
    residuals: Array
    """(K, N, 2) measured minus predicted corners, px."""
    cost: float
    """Sum of the squares of the whitened residuals, px^2."""
    by_focal: Array
    """(K, 6) change of the local (w, tau) of each pose with the logarithm of the focal length."""

    def select(self, views: IntArray) -> CameraAlone:
        """Return some of the views, with their share of the cost."""
        return CameraAlone(
            self.observations.select_views(views),
            self.poses.select(views),
            self.residuals[views],
            self.cost * len(views) / max(len(self.residuals), 1),
            self.by_focal[views],
        )

    def compute_rms(self) -> Array:
        """Return (K,) root mean square lengths of the views' residuals, px."""
        mask = self.observations.mask
        squares = np.sum(self.residuals**2, axis=2) * mask
        return np.asarray(np.sqrt(squares.sum(axis=1) / mask.sum(axis=1)))


def see_alone(cameras: Sequence[RigCamera], instants: Sequence[int]) -> list[CameraAlone]:
    """Find the board in the views of each camera alone.

    Args:
        cameras: the cameras.
        instants: the numbers of all instants, ascending.

    Raises:
        CalibrationError: if a view cannot be used, or a camera does not fit its views.
    """
    packed = [_pack(camera) for camera in cameras]
    found = []
    for camera, observations in zip(cameras, _whiten_alike(cameras, packed), strict=True):
        at = np.searchsorted(instants, sorted(camera.views)).astype(np.int64)
        found.append(locate_views(camera, observations, at))
    return found


def _pack(camera: RigCamera) -> Observations:
    """Return a camera's views in the order of their instants."""
    if not camera.views:
        raise CalibrationError(
            f"{camera.name} has no view of the board.", "Leave it out, or photograph the board."
        )
    instants = sorted(camera.views)
    names = [f"{camera.name}, instant {instant}" for instant in instants]
    return pack_observations([camera.views[instant] for instant in instants], names)


def _whiten_alike(
    cameras: Sequence[RigCamera], packed: Sequence[Observations]
) -> list[Observations]:
    """Whiten the views of all cameras, so that a residual of 1 px means the same in all of them.

    A camera's own weights are 1 for its median corner.
    """
    variances = [
        None
        if part.cov is None
        else float(np.median((np.trace(part.cov, axis1=2, axis2=3) / 2)[part.mask > 0]))
        + camera.model_error**2
        for camera, part in zip(cameras, packed, strict=True)
    ]
    stated = [variance for variance in variances if variance is not None]
    usual = float(np.median(stated)) if stated else 1.0
    whitened = []
    for camera, part, variance in zip(cameras, packed, variances, strict=True):
        part = whiten_observations(part, camera.model_error**2)
        if part.whitening is not None and variance is not None:
            part = replace(part, whitening=part.whitening * np.sqrt(usual / variance))
        whitened.append(part)
    return whitened


def _thin_corners(observations: Observations) -> Observations:
    """Return views with few corners of each, spread over all of them: enough for a start, as the
    way back through a lens takes longer than all that follows."""
    count = observations.mask.sum(axis=1, dtype=np.int64)[:, None]
    k = np.arange(min(_START_CORNERS, observations.mask.shape[1]))
    # Multiples of the golden ratio fill an interval evenly, and skip from row to row of a board.
    spread = (k * 0.618034 % 1 * count).astype(np.int64)
    chosen = np.where(count > len(k), spread, k)
    views = np.arange(len(count))[:, None]
    return Observations(
        observations.uv[views, chosen],
        observations.xy[views, chosen],
        observations.mask[views, chosen],
    )


def locate_views(camera: RigCamera, observations: Observations, at: IntArray) -> CameraAlone:
    """Find the board in the views of a camera, whose instants have the places `at`.

    Raises:
        CalibrationError: if the camera does not fit its views.
    """
    try:
        solution = solve_stage_two(
            observations,
            estimate_poses(camera.camera, _thin_corners(observations)),
            model=camera.camera.model,
            cost=Cost.IMAGE,
            scale=1.0,
            free=np.zeros(0, dtype=np.int64),
            report=None,
            max_iterations=100,
        )
        covariance = np.asarray(np.linalg.inv(solution.normal.V), np.float64)
    except (CalibrationError, np.linalg.LinAlgError) as error:
        raise CalibrationError(
            f"{camera.name}: no poses of a flat board explain its corners with its camera.",
            "Check that the camera is of these images, and the board's rows and columns.",
        ) from error
    state: State = solution.state
    residuals = compute_misses(state, observations, camera.camera.model, Cost.IMAGE)
    poses = ViewPoses(state.R, state.T, covariance, at)
    focal = np.arange(2)
    products = compute_view_products(state, observations, camera.camera.model, focal)
    pull = products[:, 2:-1, :2] @ camera.camera.focal
    by_focal = -(covariance @ pull[..., None])[..., 0]
    return CameraAlone(observations, poses, residuals, solution.normal.cost, by_focal)

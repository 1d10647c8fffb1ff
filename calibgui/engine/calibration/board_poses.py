"""The pose of a board under a known camera, with its covariance.

The camera is held: this is Stage II without free parameters, for one view (``resection.py``). With
P the derivatives of the whitened residuals r by the pose and Q those by the camera's parameters,

    sigma^2 = r^T r / (2N - 6),     V = P^T P,     G = d pose / d camera = -V^-1 P^T Q,
    cov(pose) = sigma^2 V^-1 + G cov(camera) G^T:

the residuals' own variance, and what an error of the camera does to the pose, which is the same for
all views of the camera. An error of the board's scale moves the board along the ray of its origin
(``scaling.py``). It does not measure other errors of the board, which is taken as drawn.

From far away a plane looks alike from two sides (``geometry/planar_pose.py``). Both poses are
refined, and the worse one says how certain the better one is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, freeze
from calibgui.engine.calibration.observations import Observation, Observations, pack_observations
from calibgui.engine.calibration.refinement.covariances import (
    convert_pose_covariances,
    estimate_variance,
)
from calibgui.engine.calibration.refinement.planar_pose_ambiguity import mirror_poses
from calibgui.engine.calibration.refinement.residuals import (
    State,
    compute_misses,
    compute_view_products,
)
from calibgui.engine.calibration.refinement.whitening import (
    estimate_model_variance,
    whiten_observations,
)
from calibgui.engine.calibration.resection import estimate_poses, refine_poses
from calibgui.engine.calibration.result import Cost
from calibgui.engine.calibration.scaling import compute_scale_covariance
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import (
    compute_inverse_left_jacobian,
    rotation_from_vector,
    vector_from_rotation,
)

_POSE, _CAMERA = slice(-7, -1), slice(None, -7)
"""Places of the columns of pose and camera among a view's columns [camera, pose, r]."""


@dataclass(frozen=True, eq=False, slots=True)
class BoardPose:
    """The pose of a board in one view of a known camera."""

    pose: Pose
    covariance: Array
    """(6, 6) covariance of (rvec, tvec), rad and mm, the errors of the camera and of the board's
    scale included."""
    noise_covariance: Array
    """(6, 6) the same from the corners' noise alone."""
    by_camera: Array
    """(6, P) derivatives of (rvec, tvec) by the camera's parameters."""
    residuals: Array
    """(n, 2) measured minus predicted corners, px."""
    noise: float
    """Standard deviation of one residual coordinate, px; of the median corner where corners have
    covariances."""
    lead: float
    """Standard deviations by which the mirrored pose fits worse; infinite if there is none."""
    scale_sigma: float = 0.0
    """Standard deviation of the board's scale, relative."""

    def __post_init__(self) -> None:
        freeze(self, "covariance", "noise_covariance", "by_camera", "residuals")

    @property
    def sigma(self) -> Array:
        """(6,) standard deviations of (rvec, tvec), rad and mm."""
        return np.asarray(np.sqrt(np.diag(self.covariance)))

    @property
    def rms(self) -> float:
        """Root mean square length of the residuals, px."""
        return float(np.sqrt(np.mean(np.sum(self.residuals**2, axis=1))))


def locate_board(
    camera: Camera,
    view: Observation | tuple[Array, Array],
    covariance: Array | None = None,
    name: str = "The view",
    scale_sigma: float = 0.0,
) -> BoardPose:
    """Estimate the pose of a flat board in front of a known camera.

    Args:
        camera: the camera, which is held.
        view: the corners uv (n, 2) px, the same corners on the board xy (n, 2) mm, and optionally
            the covariances of uv (n, 2, 2) px^2.
        covariance: (P, P) covariance of the camera's parameters, which then counts in that of the
            pose; None if the camera counts as exact.
        name: name of the view, for messages.
        scale_sigma: standard deviation of the board's scale, relative (`Board.scale_sigma`).

    Raises:
        CalibrationError: if the view cannot be used, or no pose in front of the camera explains it.

    Examples:
        >>> from calibgui.engine import Board, Camera, Pose, locate_board, project_points
        >>> camera = Camera((640, 480), [650, 650, 320, 240], "pinhole")
        >>> xy = Board(rows=6, cols=7, square=30.0).points()
        >>> uv = project_points(xy, camera, Pose((0.5, 0, 0), (-90, -75, 500)))
        >>> locate_board(camera, (uv, xy)).pose.tvec.round(6).tolist()
        [-90.0, -75.0, 500.0]
    """
    packed = pack_observations([view], [name])
    try:
        state = _refine(estimate_poses(camera, packed), packed, camera)
        if packed.cov is not None:
            residuals = compute_misses(state, packed, camera.model, Cost.IMAGE)
            tau2 = estimate_model_variance(packed, residuals, unknowns=6)
            packed = whiten_observations(packed, tau2)
            state = _refine(state, packed, camera)
    except (CalibrationError, np.linalg.LinAlgError) as error:
        raise CalibrationError(
            f"{name}: no pose of a flat board explains its corners with this camera.",
            "Check that the camera's file is of this camera and of images of this size, and the "
            "board's rows and columns.",
        ) from error
    state, other = _choose_better_side(state, packed, camera)
    products = _multiply(state, packed, camera)
    variance = estimate_variance(products[-1, -1], packed.count, unknowns=6)
    worse = np.inf if other is None else _multiply(other, packed, camera)[-1, -1]
    rise = max(worse - products[-1, -1], 0.0)
    inverse = np.linalg.inv(products[_POSE, _POSE])
    rvec = vector_from_rotation(state.R)
    own = convert_pose_covariances(np.asarray(variance * inverse[None], np.float64), rvec)[0]
    by_camera = -inverse @ products[_POSE, _CAMERA]
    by_camera[:3] = compute_inverse_left_jacobian(rvec[0]) @ by_camera[:3]
    from_camera = 0.0 if covariance is None else by_camera @ covariance @ by_camera.T
    pose = Pose(rvec[0], state.T[0])
    return BoardPose(
        pose=pose,
        covariance=own + from_camera + compute_scale_covariance(pose, scale_sigma),
        noise_covariance=own,
        by_camera=by_camera,
        residuals=compute_misses(state, packed, camera.model, Cost.IMAGE)[0],
        noise=float(np.sqrt(variance)),
        lead=float(np.sqrt(rise / variance)) if variance > 0 else np.inf,
        scale_sigma=scale_sigma,
    )


def follow_board(camera: Camera, view: tuple[Array, Array], near: Pose) -> Pose:
    """Estimate the pose of a board that was in another one shortly before.

    It is the nearest minimum, without covariance: `locate_board` starts anew, and compares the two
    sides that look alike.

    Args:
        camera: the camera, which is held.
        view: the corners uv (n, 2) px, and on the board xy (n, 2) mm.
        near: the pose before.

    Raises:
        CalibrationError: if the view cannot be used, or no such pose explains it.
    """
    rvec = np.asarray(near.rvec, dtype=np.float64)[None]
    start = State(camera.params, rotation_from_vector(rvec), np.asarray(near.tvec)[None])
    state = _refine(start, pack_observations([view]), camera)
    return Pose(vector_from_rotation(state.R)[0], state.T[0])


def _refine(start: State, observations: Observations, camera: Camera) -> State:
    return refine_poses(start, observations, camera.model, Cost.IMAGE)


def _multiply(state: State, observations: Observations, camera: Camera) -> Array:
    """Return the products (P + 7, P + 7) of the view's columns [camera, pose, r]."""
    everything = np.arange(len(camera.params))
    return compute_view_products(state, observations, camera.model, everything)[0]


def _choose_better_side(
    state: State, observations: Observations, camera: Camera
) -> tuple[State, State | None]:
    """Return the better of the two poses that look alike, and the other; None if it is no minimum.

    A mirrored pose that comes back when it is refined is none of its own.
    """
    start = mirror_poses(state, observations)
    try:
        other = _refine(start, observations, camera)
    except (CalibrationError, np.linalg.LinAlgError):  # it has no image, or lies behind the camera
        return state, None
    if np.linalg.norm(other.R - state.R) < np.linalg.norm(other.R - start.R):
        return state, None
    pair = sorted((state, other), key=lambda s: float(_multiply(s, observations, camera)[-1, -1]))
    return pair[0], pair[1]

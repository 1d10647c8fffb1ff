"""Hand and eye from poses of a robot and photographs: the camera in the hand, or beside the robot.

`calibrate_hand_eye` is the whole story: the board's poses by the camera alone, the reading of the
robot's poses that fits (``choice.py``), a start in closed form (``closed_form.py``), and the
refinement with the robot's own noise (``refinement.py``).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, freeze
from calibgui.engine.boards.shape import BoardShape
from calibgui.engine.calibration.board_shape.parametrisation import place_on_board_shape
from calibgui.engine.calibration.observations import (
    Observation,
    Observations,
    name_views,
    pack_observations,
)
from calibgui.engine.calibration.refinement.covariances import (
    convert_pose_covariances,
    estimate_variance,
)
from calibgui.engine.calibration.refinement.residuals import State, compute_misses
from calibgui.engine.calibration.refinement.whitening import (
    estimate_model_variance,
    whiten_observations,
)
from calibgui.engine.calibration.resection import estimate_poses, refine_poses
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import make_cross_matrix
from calibgui.engine.hand_eye.choice import (
    MIN_POSES,
    Choice,
    choose_reading,
    describe_direction,
)
from calibgui.engine.hand_eye.motions import Motions
from calibgui.engine.hand_eye.readings import list_readings
from calibgui.engine.hand_eye.refinement import Estimate, Scene, refine_hand_eye

_LEAST_NOISE_PX = 1e-9
"""Noise of corners below which it is rounding, px."""
_OPEN_TURN = 1e-3
"""Singular value below which an open direction turns nothing: rounding."""


class ToolError(NamedTuple):
    """The error of a tool that goes by what the camera sees, one standard deviation."""

    sigma_mm: float
    """Along the worst axis, mm."""
    sigma_rad: float
    """About the worst axis, rad."""
    robot_share: float
    """Share of the variance at the tool that the robot's poses are to blame for; the rest is the
    corners' and the camera's."""


@dataclass(frozen=True, eq=False, slots=True)
class HandEye:
    """The camera in the hand, or beside the robot, with its errors and the robot's."""

    eye_in_hand: bool
    """True if the camera is in the hand; False if it stands and the board is in the hand."""
    camera_pose: Pose
    """hand_from_camera, or base_from_camera if the camera stands."""
    board_pose: Pose
    """base_from_board, or hand_from_board if the camera stands."""
    covariance: Array
    """(6, 6) of the camera pose's (rvec, tvec), rad and mm, apart from what is open."""
    board_covariance: Array
    """(6, 6) of the board pose's."""
    tool: ToolError
    robot_sigmas: Array
    """(2,) standard deviations of a pose of the robot, about each axis, rad, and along each, mm."""
    corrections: Array
    """(K, 6) most likely errors of the robot's poses, rad and mm, in the hand's frame, or in the
    base's if the camera stands."""
    rms: float
    """Root mean square length of the residuals, px, with the robot's poses corrected."""
    noise: float
    """Standard deviation of a residual coordinate with each pose by itself, px."""
    scatter: float
    """Root mean square distance of the board's points in the robot's frame from their means, mm,
    with the closed form."""
    next_scatter: float
    """The same of the next best reading, mm; infinite if there is none."""
    reading: str
    """The meaning of the robot's numbers, in words."""
    rivals: tuple[str, ...]
    """Readings that fit as well."""
    shift: int
    """Number of places by which the robot's poses come before their photographs; 0 as stated."""
    names: tuple[str, ...]
    """(K,) names of the photographs with a pose."""
    open_turns: Array
    """(n, 3) axes in the hand's frame, or the base's, about which the camera may be turned."""
    open_shifts: Array
    """(n, 3) directions there along which the camera may be shifted."""
    repeated: tuple[tuple[str, ...], ...]
    """Names of photographs that have the same pose of the robot."""

    def __post_init__(self) -> None:
        freeze(
            self,
            *("covariance", "board_covariance", "robot_sigmas"),
            *("corrections", "open_turns", "open_shifts"),
        )

    @property
    def sigma(self) -> Array:
        """(6,) standard deviations of the camera pose's (rvec, tvec), rad and mm."""
        return np.asarray(np.sqrt(np.diag(self.covariance)))


def calibrate_hand_eye(
    camera: Camera,
    views: Sequence[Observation | tuple[Array, Array]],
    robot: npt.ArrayLike,
    *,
    covariance: Array | None = None,
    board_shape: BoardShape | None = None,
    eye_in_hand: bool | None = None,
    tool: npt.ArrayLike | None = None,
    names: Sequence[str] | None = None,
) -> HandEye:
    """Find where a camera is in a robot's hand, or beside the robot.

    Args:
        camera: the camera.
        views: corners and their places on the board, mm, as for `calibrate`.
        robot: (K, n) a pose of the robot for each view, as 6, 7, 12 or 16 numbers of which the
            meaning is found out (``readings.py``), or (K, 4, 4).
        covariance: (P, P) covariance of the camera's parameters; None if the camera is exact.
        board_shape: the board's shape, if it is not as drawn.
        eye_in_hand: True if the camera is in the hand, False if it stands; None takes the robot's
            poses for base_from_hand, and finds out.
        tool: (3,) the tool's point in the hand's frame, mm; None for where the board is.
        names: names of the views, for messages.

    Raises:
        CalibrationError: for fewer than three different poses, and if no reading of the poses fits.

    Examples:
        A hand 100 mm behind its camera looks at a board from four sides.

        >>> from calibgui.engine import Board, Camera, Pose, project_points
        >>> from calibgui.engine.geometry import rotation_from_vector
        >>> camera = Camera((640, 480), [650, 650, 320, 240], "pinhole")
        >>> xy = Board(rows=6, cols=7, square=30.0).points()
        >>> turns = [(0.5, 0, 0), (-0.5, 0, 0), (0, 0.5, 0), (0.3, 0.4, 0)]
        >>> views = [(project_points(xy, camera, Pose(w, (-90, -75, 500))), xy) for w in turns]
        >>> R = rotation_from_vector(-np.array(turns))
        >>> poses = np.concatenate([R, (R @ (90, 75, -600))[..., None]], axis=2)
        >>> found = calibrate_hand_eye(camera, views, poses)
        >>> abs(found.camera_pose.tvec.round(6)).tolist()
        [0.0, 0.0, 100.0]
        >>> found.reading
        'matrices row by row, millimetres, base from hand'
    """
    names = tuple(names or name_views(len(views)))
    numbers = np.asarray(robot, np.float64)
    numbers = numbers.reshape(len(numbers), -1)
    if len(numbers) != len(views):
        raise CalibrationError(
            f"There are {len(views)} photographs and {len(numbers)} poses of the robot.",
            "Give one pose for each photograph.",
        )
    if not np.isfinite(numbers).all():
        at = int(np.argmin(np.isfinite(numbers).all(axis=1)))
        raise CalibrationError(
            f"{names[at]}: the robot's pose holds a number that is not finite.", "Leave it out."
        )
    repeated = _find_repeated(numbers, names)
    readings = list_readings(numbers)
    observations, boards, variance = _locate_boards(camera, views, board_shape, names)
    points = _choose_points(observations)
    choice = choose_reading(readings, boards, points, eye_in_hand)
    photographs, rows = choice.pair(len(views))
    poses = choice.reading.poses.select(rows)
    boards = boards.select(photographs)
    scene = Scene(
        camera,
        _take_root(covariance, len(camera.params)),
        observations.select_views(photographs),
        variance,
        poses.invert() if choice.is_inverted else poses,
        float(np.linalg.norm(boards.t, axis=1).mean()),
    )
    found = refine_hand_eye(scene, choice.start.X, choice.start.W, boards)
    is_in_hand = not choice.is_inverted if eye_in_hand is None else eye_in_hand
    where = _place_tool(found, scene.robot, points, is_in_hand, tool)
    return _assemble(scene, found, choice, is_in_hand, where, names[photographs], repeated)


def _find_repeated(numbers: Array, names: Sequence[str]) -> tuple[tuple[str, ...], ...]:
    """Find the photographs that have the same pose of the robot.

    Raises:
        CalibrationError: if there are fewer than three different poses.
    """
    kinds: dict[bytes, list[str]] = {}
    for name, row in zip(names, numbers, strict=True):
        kinds.setdefault(row.tobytes(), []).append(name)
    repeated = tuple(tuple(same) for same in kinds.values() if len(same) > 1)
    if len(kinds) >= MIN_POSES:
        return repeated
    same = f": {', '.join(repeated[0])} have the same one" if repeated else ""
    raise CalibrationError(
        f"There are {len(kinds)} different poses of the robot with a board{same}; hand and eye "
        f"need at least {MIN_POSES}.",
        "Photograph the board from ten poses or more, turned about two axes at least.",
    )


def _locate_boards(
    camera: Camera,
    views: Sequence[Observation | tuple[Array, Array]],
    board_shape: BoardShape | None,
    names: Sequence[str],
) -> tuple[Observations, Motions, float]:
    """Locate the board in each view by the camera alone; return the whitened views, cam_from_board,
    and the variance of a coordinate, px^2."""
    observations = pack_observations(views, names)
    if board_shape is not None:
        observations = place_on_board_shape(observations, board_shape)
    try:
        state = _refine(estimate_poses(camera, observations), observations, camera)
    except (CalibrationError, np.linalg.LinAlgError) as error:
        raise CalibrationError(
            "No poses of a flat board explain the corners with this camera.",
            "Check that the camera's file is of this camera and of images of this size.",
        ) from error
    unknowns = 6 * len(views)
    misses = compute_misses(state, observations, camera.model, Cost.IMAGE)
    tau2 = estimate_model_variance(observations, misses, unknowns)
    observations = whiten_observations(observations, tau2)
    state = _refine(state, observations, camera)
    misses = compute_misses(state, observations, camera.model, Cost.IMAGE)
    if observations.whitening is not None:
        misses = (observations.whitening @ misses[..., None])[..., 0]
    cost = float(np.sum(misses**2 * observations.mask[..., None]))
    variance = estimate_variance(cost, observations.count, unknowns)
    variance = variance if np.isfinite(variance) else 0.0
    return observations, Motions(state.R, state.T), max(variance, _LEAST_NOISE_PX**2)


def _refine(start: State, observations: Observations, camera: Camera) -> State:
    return refine_poses(start, observations, camera.model, Cost.IMAGE)


def _choose_points(observations: Observations) -> Array:
    """Choose (4, 3) the corners of the rectangle that holds all corners of the board, mm."""
    xy = observations.xy[observations.mask > 0][:, :2]
    (left, top), (right, bottom) = xy.min(axis=0), xy.max(axis=0)
    return np.array([[x, y, 0.0] for x in (left, right) for y in (top, bottom)])


def _take_root(covariance: Array | None, count: int) -> Array:
    """Return U (P, Q) with U U^T the covariance of the camera; no columns if it is exact."""
    if covariance is None:
        return np.zeros((count, 0))
    values, vectors = np.linalg.eigh(covariance)
    return np.asarray((vectors * np.sqrt(np.maximum(values, 0.0)))[:, values > 0])


def _place_tool(
    found: Estimate, robot: Motions, points: Array, is_in_hand: bool, tool: npt.ArrayLike | None
) -> Array:
    """Place the tool (K, 3) in the frame that X leads to: the hand's, or the base's.

    Without a tool it is where the board's middle was.
    """
    if tool is None:
        middle = points.mean(axis=0, keepdims=True)
        return found.X.after(found.boards).move(middle)[:, 0]
    place = np.asarray(tool, np.float64)
    if place.shape != (3,) or not np.isfinite(place).all():
        raise CalibrationError(
            "The tool's point is not three finite numbers.", "Give X, Y, Z in mm."
        )
    if is_in_hand:
        return place[None]
    return robot.invert().move(place[None])[:, 0]  # of a camera that stands H_k is hand_from_base


def _measure_tool_error(found: Estimate, where: Array) -> ToolError:
    """Measure the error of X at places (K, 3): of a point p it is w x (p - t) + tau."""
    by_X = np.concatenate(
        [-make_cross_matrix(where - found.X.t), np.broadcast_to(np.eye(3), (len(where), 3, 3))],
        axis=2,
    )

    def average(covariance: Array) -> Array:
        return np.asarray(np.mean(by_X @ covariance[:6, :6] @ np.swapaxes(by_X, 1, 2), axis=0))

    parts = [average(part) for part in found.parts]
    robot, corners, camera = (float(np.trace(part)) for part in parts)
    # The axes of the scatter would themselves be chosen by chance.
    worst = np.linalg.eigh(sum(parts))[1][:, -1]
    turning = np.linalg.eigh(found.parts.sum(axis=0)[:3, :3])[1][:, -1]
    return ToolError(
        float(np.sqrt(worst @ average(found.covariance) @ worst)),
        float(np.sqrt(turning @ found.covariance[:3, :3] @ turning)),
        robot / (robot + corners + camera),
    )


def _list_open_directions(found: Estimate) -> tuple[Array, Array]:
    """List axes (n, 3) about which, and directions (n, 3) along which X is open."""
    turns, shifts = found.open_directions[:, :3], found.open_directions[:, 3:6]
    U, turning, axes = np.linalg.svd(turns)
    count = int(np.sum(turning > _OPEN_TURN))
    _, sizes, along = np.linalg.svd(U[:, count:].T @ shifts)
    return axes[:count], along[: int(np.sum(sizes > _OPEN_TURN))]


def _assemble(
    scene: Scene,
    found: Estimate,
    choice: Choice,
    is_in_hand: bool,
    where: Array,
    names: tuple[str, ...],
    repeated: tuple[tuple[str, ...], ...],
) -> HandEye:
    """Assemble the record."""
    camera_pose, board_pose = found.X.make_pose(), found.W.make_pose()
    local = np.stack([found.covariance[:6, :6], found.covariance[6:, 6:]])
    rvecs = np.stack([camera_pose.rvec, board_pose.rvec])
    covariance, board_covariance = convert_pose_covariances(local, rvecs)
    state = State(found.params, found.boards.R, found.boards.t)
    misses = compute_misses(state, scene.observations, scene.camera.model, Cost.IMAGE)
    square = np.sum(misses**2 * scene.observations.mask[..., None])
    open_turns, open_shifts = _list_open_directions(found)
    return HandEye(
        eye_in_hand=is_in_hand,
        camera_pose=camera_pose,
        board_pose=board_pose,
        covariance=covariance,
        board_covariance=board_covariance,
        tool=_measure_tool_error(found, where),
        robot_sigmas=np.sqrt(found.variances),
        corrections=found.corrections,
        rms=float(np.sqrt(square / scene.observations.count)),
        noise=float(np.sqrt(scene.variance)),
        scatter=choice.start.scatter,
        next_scatter=choice.next_best,
        reading=f"{choice.reading.words}, {describe_direction(choice.is_inverted, is_in_hand)}",
        rivals=choice.rivals,
        shift=choice.shift,
        names=names,
        open_turns=open_turns,
        open_shifts=open_shifts,
        repeated=repeated,
    )

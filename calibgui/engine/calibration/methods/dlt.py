"""The direct linear transformation of Abdel-Aziz and Karara (1971), for several planes.

Points (X, Y, Z) of a fixed frame and their image points are related by eleven parameters,

    u = (L1 X + L2 Y + L3 Z + L4) / (L9 X + L10 Y + L11 Z + 1),
    v = (L5 X + L6 Y + L7 Z + L8) / (L9 X + L10 Y + L11 Z + 1),

which multiplied by the denominator are linear in L1 to L11: two equations a point,

    [X Y Z 1 0 0 0 0 -u X -u Y -u Z] L = u,    [0 0 0 0 X Y Z 1 -v X -v Y -v Z] L = v.

The rows (L1 L2 L3 L4), (L5 L6 L7 L8), (L9 L10 L11 1) are a matrix P of 3 x 4, and P ~ A [R T] with

    A = [fx  fx skew  cx;  0  fy  cy;  0  0  1],

so that A, up to its scale, is the triangular factor of P's first three columns, and R the
orthogonal one (RQ decomposition). These are five and six parameters: eleven as well. We solve for P
as a whole, of length 1, because its last entry, 1 above, may be 0 in another frame; points and
image points are brought to zero mean and equal spread before (Hartley 1997), without which the
equations are badly conditioned. What is minimised is no error in the image. There is no distortion.

Points of one plane leave three more of P's entries open than its scale, so that one view of a flat
board is not enough, nor are several whose relation is not known. The method therefore takes the
pose of the board in a fixed frame for each view, the camera standing still; the board's poses
before the camera are then camera_from_frame frame_from_board.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.methods.method import (
    Initialisation,
    Method,
    Problem,
    check_ideal_lens,
    hold_parameters,
    keep_start,
)
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.levenberg_marquardt import StartError
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector

_MODEL = "brown-conrady-4"
_DISTORTION = ("k1", "k2", "p1", "p2")
_MIN_THICKNESS = 1e-3
"""Spread of the points across the plane nearest to them, relative to that along it, below which
they are taken for points of one plane: a board of 300 mm may itself be off by 0.3 mm."""
_NEED = (
    "The DLT needs points that are not in one plane: views of the board in several known places of "
    "a fixed frame, before a camera that does not move."
)
"""Advice where it cannot be done."""


class Projection(NamedTuple):
    """A camera without distortion, and its place."""

    A: Array
    """(3, 3) upper triangular, last entry 1: px from the plane z = 1 of the camera frame."""
    R: Array
    """(3, 3) rotation camera_from_frame."""
    T: Array
    """(3,) translation camera_from_frame, mm."""


def solve_dlt(points: Array, uv: Array) -> Array:
    """Solve for P (3, 4) of unit length, [u v 1] ~ P [X Y Z 1], positive before the camera.

    Args:
        points: (n, 3) points of the fixed frame, mm.
        uv: (n, 2) image points, px.

    Raises:
        StartError: if the points lie in one plane.
    """
    to_points, to_uv = _normalise(points), _normalise(uv)
    X = _make_homogeneous(points) @ to_points.T
    u, v = (_make_homogeneous(uv) @ to_uv.T)[:, :2].T
    spread = np.linalg.svd(X[:, :3], compute_uv=False)
    if spread[2] < _MIN_THICKNESS * spread[1]:
        raise StartError("All points of these views lie in one plane.", _NEED)
    none = np.zeros_like(X)
    equations = np.concatenate(
        [
            np.hstack([X, none, -u[:, None] * X]),
            np.hstack([none, X, -v[:, None] * X]),
        ]
    )
    least = np.linalg.svd(equations, full_matrices=False)[2][-1].reshape(3, 4)
    P = np.linalg.inv(to_uv) @ least @ to_points
    depth = _make_homogeneous(points) @ P[2]
    return np.asarray(P * np.sign(depth.sum()) / np.linalg.norm(P))


def decompose_projection(P: Array) -> Projection:
    """Decompose P (3, 4) into A [R T].

    Raises:
        StartError: if no camera has this P, because the frame is mirrored.
    """
    if not np.linalg.det(P[:, :3]) > 0:
        raise StartError(
            "The image shows the boards mirrored against the poses that were problem.",
            "Check the poses' frame, and that the views number their corners as the board does.",
        )
    A, R = scipy.linalg.rq(P[:, :3])
    sign = np.sign(np.diag(A))
    A, R = A * sign, sign[:, None] * R
    T = np.asarray(np.linalg.solve(A, P[:, 3]), dtype=np.float64)
    return Projection(A / A[2, 2], np.asarray(R, dtype=np.float64), T)


def _normalise(points: Array) -> Array:
    """Return the similarity (d + 1, d + 1) to zero mean and unit spread along each axis."""
    d = points.shape[1]
    mean = points.mean(axis=0)
    scale = np.sqrt(np.mean((points - mean) ** 2))
    T = np.eye(d + 1)
    T[:d, :d] /= scale
    T[:d, d] = -mean / scale
    return T


def _make_homogeneous(points: Array) -> Array:
    """Return points (n, d) with a last coordinate of 1."""
    return np.concatenate([points, np.ones((len(points), 1))], axis=1)


def _place_boards(observations: Observations, R: Array, T: Array) -> tuple[Array, Array]:
    """Return all corners (n, 3) in the fixed frame, mm, and their image points (n, 2)."""
    placed = observations.xy[..., :2] @ np.swapaxes(R[..., :2], 1, 2) + T[:, None]
    seen = observations.mask > 0
    return placed[seen], observations.uv[seen]


def _check_held(problem: Problem) -> None:
    """Refuse to hold what the DLT always estimates, and to estimate what it does not know."""
    names = [name for name in problem.held if name not in _DISTORTION]
    if names:
        raise CalibrationError(
            f"The DLT cannot hold {', '.join(names)}.", "Choose the method 'zhang' for that."
        )
    check_ideal_lens(problem, "The DLT", _DISTORTION)


def _initialise(board_poses: Sequence[Pose] | None, problem: Problem) -> Initialisation:
    """Solve for camera and poses in closed form.

    Raises:
        CalibrationError: if there is not a pose of the board for each view, if other parameters are
            held than the distortion, or if all corners lie in one plane.
    """
    if board_poses is None:
        raise CalibrationError(
            "The places of the board in these views are not known to each other, so that each view "
            "by itself shows one plane only.",
            _NEED,
        )
    observations = problem.observations
    if len(board_poses) != len(observations.uv):
        raise CalibrationError(
            f"The DLT was given the poses of {len(board_poses)} boards for "
            f"{len(observations.uv)} views.",
            "Give the pose of the board in each view, in the order of the views; a part of the "
            "views needs their poses only.",
        )
    _check_held(problem)
    R = rotation_from_vector(np.array([pose.rvec for pose in board_poses]))
    T = np.array([pose.tvec for pose in board_poses])
    camera = decompose_projection(solve_dlt(*_place_boards(observations, R, T)))
    (fx, shear, cx), (_, fy, cy), _ = camera.A
    params = np.array([fx, fy, cx, cy, 0.0, 0.0, 0.0, 0.0, shear / fx])
    state = State(params, camera.R @ R, T @ camera.R.T + camera.T)
    return hold_parameters(state, problem.model, problem.held, {})


def make_dlt(board_poses: Sequence[Pose] | None) -> Method:
    """Make the method for boards in known places.

    Args:
        board_poses: for each view, in their order, the pose of the board in a frame in which the
            camera stood still: X_frame = R X_board + tvec. None where that is not known; the
            method then says why it cannot be used. Three at least: ``calibrate`` refuses two views
            before any method, since without a known relation they do not determine a camera.

    Example:
        A board of 7 x 6 corners that stands in three places before a fixed camera, here in the
        camera's own frame.

        >>> import numpy as np
        >>> from calibgui.engine import Board, Camera, Pose, calibrate, project_points
        >>> truth = Camera((640, 480), [650, 655, 310, 245, 0, 0, 0, 0, 0], "brown-conrady-4")
        >>> xy = Board(rows=6, cols=7, square=30.0).points()
        >>> tilts = [(0.5, 0, 0), (0, 0.5, 0), (-0.3, -0.4, 0)]
        >>> places = [Pose(tilt, (-90, -75, 500)) for tilt in tilts]
        >>> views = [(project_points(xy, truth, place), xy) for place in places]
        >>> found = calibrate(views, truth.size, method=make_dlt(places))
        >>> bool(np.allclose(found.camera.params, truth.params, atol=1e-6))
        True
    """
    return Method(
        name="dlt",
        label="DLT",
        title="DLT: direct linear transformation",
        source="Y. I. Abdel-Aziz, H. M. Karara, Direct linear transformation from comparator "
        "coordinates into object space coordinates in close-range photogrammetry, Proceedings of "
        "the Symposium on Close-Range Photogrammetry, Falls Church (1971) 1-18",
        limits="It needs boards in known places before a camera that does not move, and knows no "
        "distortion.",
        lens_models=(_MODEL,),
        initialise=partial(_initialise, board_poses),
        refine=keep_start,
        held=_DISTORTION,
        is_minimum=False,
    )


DLT = make_dlt(None)
"""The method without known places of the board, which says what it lacks."""

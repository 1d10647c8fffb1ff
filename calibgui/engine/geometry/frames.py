"""Coordinate frames, and the only conversions between them.

Programs disagree about where a pixel's coordinates begin and which way y points. All frames
that this one knows are listed here, and every conversion is below.

array frame (u, v)   pixels, 0-based, integer coordinates at pixel centres, u right, v down.
                     OpenCV's, and the frame of every interface of the engine. Its camera
                     frame is right-handed: X right, Y down, Z forward.
paper's frame (x, y) pixels, origin at the centre of the pixel array, x right, y up:
                     x = u - (W - 1) / 2, y = (H - 1) / 2 - v. Its camera frame is
                     left-handed: X right, Y up, Z forward. Used by Stage I and for display.
corner frame         pixels, 0-based, integer coordinates at pixel corners: photogrammetry's.
board frame          millimetres in the plane of the board, as the caller numbers it.

`b_from_a` names a transform of coordinates in a to coordinates in b.

The paper measures a pose from the virtual centred fronto-parallel (CFP) camera, which
looks at the board's centre from the distance L + f: X_cam = R X' + T with
X' = (X', Y', L + f) and t = T / (L + f) (eq. 6, 21). A board point (X, Y) from the centre is
thus at R[:, :2] (X, Y) + (L + f) (r3 + t): the planar pose's translation is (L + f) (r3 + t).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, Size
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import (
    paper_angles_from_rotation,
    rotation_from_paper_angles,
    rotation_from_vector,
    vector_from_rotation,
)

_FLIP = np.array([1.0, -1.0, 1.0])
"""Signs that turn the array frame's camera axes into the paper's: y changes its sign."""


def centre_of_array(size: Size) -> Array:
    """Return (2,) the centre of the pixel array in the array frame, px."""
    return np.array([(size[0] - 1) / 2, (size[1] - 1) / 2])


def paper_from_array(uv: Array, size: Size) -> Array:
    """Convert image points (..., 2) from the array frame to the paper's."""
    u, v = centre_of_array(size)
    return np.stack([uv[..., 0] - u, v - uv[..., 1]], axis=-1)  # a coordinate at a time is fast


def array_from_paper(xy: Array, size: Size) -> Array:
    """Convert image points (..., 2) from the paper's frame to the array frame."""
    return xy * _FLIP[:2] + centre_of_array(size)


def corner_from_array(uv: Array) -> Array:
    """Convert image points (..., 2) from the array frame to the corner frame."""
    return uv + 0.5


PAPER_NAMES = ("xp", "yp", "k1", "k2", "k3", "p1", "p2", "p3", "fx", "fy")
"""Names of the paper's ten intrinsics in the order of Table 2."""


def paper_from_intrinsics(params: Array, size: Size) -> tuple[Array, Array]:
    """Convert intrinsics from the array frame to the paper's ten, in its pixel units.

    k_j carries px^-2j, p1 and p2 px^-1, p3 px^-2, all by powers of fx; p2 changes sign with y.

    Args:
        params: (10,) fx, fy, cx, cy (px), k1, k2, k3, p1, p2, p3 (dimensionless).
        size: of the image, px.

    Returns:
        Values (10,) in the order of `PAPER_NAMES` and their Jacobian (10, 10) with respect
        to `params`, which carries a covariance over.
    """
    fx, fy, cx, cy = params[:4]
    powers = np.array([2.0, 4.0, 6.0, 1.0, 1.0, 2.0])
    signs = np.array([1.0, 1.0, 1.0, 1.0, -1.0, 1.0])
    scale = signs * fx**-powers
    xp, yp = paper_from_array(np.array([cx, cy]), size)
    values = np.concatenate([[xp, yp], scale * params[4:], [fx, fy]])
    J = np.zeros((10, 10))
    J[0, 2], J[1, 3] = _FLIP[:2]
    J[2:8, 4:] = np.diag(scale)
    J[2:8, 0] = -powers * values[2:8] / fx
    J[8, 0] = J[9, 1] = 1.0
    return values, J


@dataclass(frozen=True, slots=True)
class PaperPose:
    """The external parameters of one view as the paper writes them (3.2)."""

    omega: float
    phi: float
    theta: float
    tx: float
    ty: float
    tz: float
    """t = T / (L + f), dimensionless."""
    distance: float
    """L + f, from the CFP camera to the board, mm."""

    @property
    def vector(self) -> Array:
        """(6,) omega, phi, theta (rad), tX, tY, tZ."""
        return np.array([self.omega, self.phi, self.theta, self.tx, self.ty, self.tz])

    @property
    def translation(self) -> Array:
        """(3,) T = (L + f) t, mm (after eq. 30)."""
        return self.distance * self.vector[3:]


def _find_board_axes(R: Array) -> Array:
    """Return (3,) signs that turn board axes into the paper's left-handed ones.

    If the board's Z points away from the camera its Y points down and is flipped; if Z points
    at the camera, Y is up already, and Z is flipped.
    """
    return _FLIP if R[2, 2] >= 0 else np.array([1.0, 1.0, -1.0])


def paper_from_pose(pose: Pose, centre: Array, distance: float) -> PaperPose:
    """Convert a pose to the paper's external parameters.

    Args:
        pose: cam_from_board in the array frame, mm.
        centre: (2,) the board's centre in board coordinates, mm.
        distance: L + f, mm (eq. 30).
    """
    R = rotation_from_vector(pose.rvec)
    axes = _find_board_axes(R)
    paper_R = _FLIP[:, None] * R * axes
    planar = _FLIP * (R[:, :2] @ centre + pose.tvec)
    t = planar / distance - paper_R[:, 2]
    return PaperPose(
        *paper_angles_from_rotation(paper_R), float(t[0]), float(t[1]), float(t[2]), distance
    )


def pose_from_paper(paper: PaperPose, centre: Array, y_up: bool = False) -> Pose:
    """Convert the paper's external parameters to a pose: the inverse of `paper_from_pose`.

    Args:
        paper: the external parameters.
        centre: (2,) the board's centre in board coordinates, mm.
        y_up: true if board coordinates have Y up.
    """
    axes = np.array([1.0, 1.0, -1.0]) if y_up else _FLIP
    paper_R = rotation_from_paper_angles(paper.omega, paper.phi, paper.theta)
    R = _FLIP[:, None] * paper_R * axes
    planar = _FLIP * paper.distance * (paper_R[:, 2] + paper.vector[3:])
    return Pose(vector_from_rotation(R), planar - R[:, :2] @ centre)

"""Links: what the instants at which two cameras both see the board tell of how they stand.

The pair is calibrated as a rig of two, with both cameras held as they are known so far. With the
covariance of the pose b_from_a, the uncertainty of where b sees what a sees is, for a point X of a,

    sqrt(largest eigenvalue of J cov J^T),    J = d projection_b(R X + T) / d (rvec, tvec),

and the worst one is that of all points on rays over the sensor of a, as near as the nearest board
that both saw and as far as the farthest, that b sees. It is told in px, as what is known of one
camera is, and comes down with the square root of the number of instants.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays, rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.rig.calibrate_rig import calibrate_rig
from calibgui.engine.rig.consensus import Relation
from calibgui.engine.rig.records import RigCamera

_STEP = np.cbrt(np.finfo(np.float64).eps)
"""Step of the central differences by the pose, rad, and over the distance: with it rounding and
curvature err alike."""


@dataclass(frozen=True, slots=True)
class Link:
    """Two cameras, and how well it is known how they stand to each other."""

    first: int
    second: int
    """Numbers of the cameras."""
    shared: int
    """Number of instants at which both see the board."""
    worst: float
    """Uncertainty of the worst place at which the second sees what the first sees, px; infinite if
    it is not known."""
    relation: Relation | None
    """The place of the second camera beside the first; None if it is not known."""

    def count_missing(self, limit: float) -> int:
        """Count the instants that are missing, about, for an uncertainty of `limit` px.

        They are three at least, so that two outvote one that is wrong.
        """
        if not np.isfinite(self.worst):
            return max(1, 3 - self.shared)
        needed = int(np.ceil(self.shared * (self.worst / limit) ** 2))
        return max(0, max(3, needed) - self.shared)


def measure_link(
    calibrations: tuple[Calibration, Calibration],
    views: tuple[Mapping[int, Observation], Mapping[int, Observation]],
) -> tuple[float, Relation | None]:
    """Measure how two cameras stand to each other, and how well it is known.

    Args:
        calibrations: both cameras, as far as they are known.
        views: what each sees of the board, by instants that both share.

    Returns:
        The uncertainty of the worst place, px, at which the second sees what the first sees, and
        the relation; infinity and None if a camera is not determined, or the views do not tell.
    """
    if any(each.diagnosis is not None for each in calibrations):
        return np.inf, None
    cameras = [
        RigCamera(name, each.camera, seen, model_error=each.model_error).hold()
        for name, each, seen in zip("ab", calibrations, views, strict=True)
    ]
    try:
        rig = calibrate_rig(cameras)
    except CalibrationError:
        return np.inf, None
    place = rig.layout.pose(1)
    covariance = rig.covariance[place, place]
    distances = [float(np.linalg.norm(pose.tvec)) for pose in rig.boards]
    points = _spread_points(rig.cameras[0], min(distances), max(distances))
    pose = rig.poses[1]
    relation = Relation.of_pose(pose)
    return _measure_worst(rig.cameras[1], pose, covariance, points), relation


def find_relations(links: Sequence[Link], first: int) -> dict[int, tuple[Relation, float]]:
    """Find how cameras stand to one of them, along the links that are known.

    Returns:
        By the numbers of the cameras, also for the first: the relation, and the uncertainty of the
        worst place, px, as if those of all links on the way added up as independent ones do.
    """
    found = {first: (Relation(np.eye(3), np.zeros(3)), 0.0)}
    waiting = [first]
    while waiting:
        here = waiting.pop()
        for link in links:
            if link.relation is None or here not in (link.first, link.second):
                continue
            there = link.second if here == link.first else link.first
            if there in found:
                continue
            step = link.relation if here == link.first else link.relation.invert()
            relation, worst = found[here]
            found[there] = step.after(relation), float(np.hypot(worst, link.worst))
            waiting.append(there)
    return found


def show_board(board: Array, pose: Pose, relation: Relation, camera: Camera) -> Array | None:
    """Return where a camera sees a board that another one sees in a pose.

    Args:
        board: (n, 2) corners on the board, mm.
        pose: other_from_board.
        relation: the place of the camera beside the other one.
        camera: the camera.

    Returns:
        (n, 2) px, which may lie outside of the image; None if all do, or one has no image.
    """
    from_board = relation.after(Relation.of_pose(pose))
    points = board @ from_board.R[:, :2].T + from_board.T
    uv = pixels_from_rays(points, camera)
    is_seen = ((uv >= 0) & (uv <= np.array(camera.size) - 1)).all(axis=1).any()
    rays = points / np.linalg.norm(points, axis=1)[:, None]
    is_sound = np.allclose(rays_from_pixels(uv, camera), rays)  # where it folds, others are there
    return uv if is_seen and is_sound else None


def _spread_points(camera: Camera, near: float, far: float) -> Array:
    """Return points (n, 3), mm, on rays over the sensor, at two distances."""
    width, height = camera.size
    uv = np.stack(np.meshgrid(np.linspace(0, width - 1, 7), np.linspace(0, height - 1, 7)), -1)
    rays = rays_from_pixels(uv.reshape(-1, 2), camera)
    return np.concatenate([near * rays, far * rays])


def _measure_worst(camera: Camera, pose: Pose, covariance: Array, points: Array) -> float:
    """Measure the largest uncertainty of the projections of points that a camera sees, px."""
    uv = _project(camera, np.r_[pose.rvec, pose.tvec], points)
    is_seen = ((uv >= 0) & (uv <= np.array(camera.size) - 1)).all(axis=1)
    if not is_seen.any():
        return np.inf
    points = points[is_seen]
    steps = np.repeat([_STEP, _STEP * np.linalg.norm(points, axis=1).max()], 3)
    params = np.r_[pose.rvec, pose.tvec]
    columns = []
    for step in np.diag(steps):
        moved = _project(camera, params + step, points) - _project(camera, params - step, points)
        columns.append(moved / (2 * step.sum()))
    J = np.stack(columns, axis=-1)
    variances = np.linalg.eigvalsh(J @ covariance @ np.swapaxes(J, 1, 2))[:, -1]
    return float(np.sqrt(variances.max()))


def _project(camera: Camera, params: Array, points: Array) -> Array:
    """Project points (n, 3), mm, of the first camera's frame with a pose (rvec, tvec); NaN of those
    behind."""
    X = points @ rotation_from_vector(params[:3]).T + params[3:]
    return pixels_from_rays(X / np.linalg.norm(X, axis=1)[:, None], camera)

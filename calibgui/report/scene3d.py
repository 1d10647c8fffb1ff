"""Camera and boards in space, drawn by projection to a plane: no 3-D graphics needed.

A scene is a list of flat polygons. Camera-centric, the world is the camera's frame (X right,
Y down, Z forward) and the boards stand in it; board-centric, it is the plate's frame and the
cameras X_plate = R^T (X_cam - T) stand in it. An observer at a distance of three times the
scene's radius orbits about its middle: with B = B_x(elevation) B_y(azimuth) a point X is at

    p = B (X - middle) + (0, 0, 3 radius),      s = zoom (p_x, p_y) / p_z,

and polygons are painted from the farthest to the nearest by the mean depth of their corners.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from calibgui.dataset.result import Result
from calibgui.engine.arrays import Array, freeze
from calibgui.engine.camera import Camera
from calibgui.engine.geometry import Pose, rotation
from calibgui.report.coverage import board_extent_px

_DISTANCE = 3.0
"""Of the observer from the middle, in radii of the scene."""
_CAMERA_SIZE = 0.12
"""Length of a drawn camera over the mean distance of the boards."""


class Centre(StrEnum):
    """What stands still."""

    CAMERA = "camera"
    BOARD = "board"


class Kind(StrEnum):
    """What a polygon is part of."""

    BOARD = "board"
    CAMERA = "camera"


@dataclass(frozen=True, eq=False, slots=True)
class Polygon:
    """A flat outline in the world; its first corner is the board's origin or the camera's apex."""

    points: Array
    """(n, 3) mm."""
    kind: Kind
    view: int
    """The calibrated view that it stands for; -1 for what all views share."""

    def __post_init__(self) -> None:
        freeze(self, "points")


def scene(result: Result, centre: Centre) -> tuple[Polygon, ...]:
    """The calibrated views' boards around the camera, or cameras around the board."""
    camera, poses = result.calibration.camera, result.calibration.poses
    outline = _board_outline(result)
    size = _CAMERA_SIZE * float(np.mean([np.linalg.norm(pose.tvec) for pose in poses]))
    body = _camera_faces(camera, size)
    if centre is Centre.CAMERA:
        shared = [Polygon(face, Kind.CAMERA, -1) for face in body]
        placed = [
            Polygon(_cam_from_board(outline, pose), Kind.BOARD, k) for k, pose in enumerate(poses)
        ]
    else:
        shared = [Polygon(outline, Kind.BOARD, -1)]
        placed = [
            Polygon(_board_from_cam(face, pose), Kind.CAMERA, k)
            for k, pose in enumerate(poses)
            for face in body
        ]
    return (*shared, *placed)


@dataclass(frozen=True, slots=True)
class Observer:
    """Where the scene is looked at from: radians, and a zoom; at 1 all fits from every side."""

    azimuth: float = 0.6
    elevation: float = 0.4
    zoom: float = 1.0

    def turned(self, right: float, down: float) -> Observer:
        """Moved about the scene by angles; never over the poles."""
        elevation = float(np.clip(self.elevation + down, -np.pi / 2, np.pi / 2))
        return replace(self, azimuth=self.azimuth - right, elevation=elevation)

    def zoomed(self, factor: float) -> Observer:
        """Seen larger by `factor`, within reason."""
        return replace(self, zoom=float(np.clip(self.zoom * factor, 0.2, 20.0)))


@dataclass(frozen=True, eq=False, slots=True)
class Drawn:
    """A polygon on the drawing plane."""

    polygon: Polygon
    points: Array
    """(n, 2), x right, y down; the whole scene lies within the unit circle at zoom 1."""
    depth: float


def draw(polygons: Sequence[Polygon], observer: Observer) -> tuple[Drawn, ...]:
    """The polygons in the order in which to paint them. What is behind the observer is left out."""
    if not polygons:
        return ()
    everything = np.concatenate([polygon.points for polygon in polygons])
    middle = (everything.min(axis=0) + everything.max(axis=0)) / 2
    radius = float(np.linalg.norm(everything - middle, axis=1).max()) or 1.0
    points, depth = project((everything - middle) / radius, observer)
    ends = np.cumsum([len(polygon.points) for polygon in polygons])[:-1]
    drawn = [
        Drawn(polygon, at, float(far.mean()))
        for polygon, at, far in zip(
            polygons, np.split(points, ends), np.split(depth, ends), strict=True
        )
        if far.min() > 0.1
    ]
    return tuple(sorted(drawn, key=lambda d: -d.depth))


def fitted(polygons: Sequence[Polygon], observer: Observer) -> Observer:
    """The observer with the zoom at which the scene, seen from there, fills a square of side 2."""
    drawn = draw(polygons, replace(observer, zoom=1.0))
    reach = max((float(np.abs(item.points).max()) for item in drawn), default=1.0)
    return replace(observer, zoom=1.0 / reach)


def project(points: Array, observer: Observer) -> tuple[Array, Array]:
    """(n, 2) on the drawing plane and (n,) depth of points (n, 3) in radii from the middle."""
    a, e = observer.azimuth, observer.elevation
    turn = rotation(np.array([e, 0.0, 0.0])) @ rotation(np.array([0.0, a, 0.0]))
    p = points @ turn.T + np.array([0.0, 0.0, _DISTANCE])
    # A sphere of radius 1 at this distance is seen under asin(1 / distance).
    scale = observer.zoom * np.sqrt(_DISTANCE**2 - 1)
    return scale * p[:, :2] / p[:, 2:], p[:, 2]


def view_at(drawn: Sequence[Drawn], point: Array) -> int:
    """The view of the nearest polygon at `point` (2,) of the drawing plane; -1 if none."""
    for item in reversed(drawn):
        if item.polygon.view >= 0 and _contains(item.points, point):
            return item.polygon.view
    return -1


def _contains(outline: Array, point: Array) -> bool:
    """Whether a convex outline (n, 2) holds the point."""
    edge = np.roll(outline, -1, axis=0) - outline
    to = point - outline
    side = edge[:, 0] * to[:, 1] - edge[:, 1] * to[:, 0]
    return bool((side >= 0).all() or (side <= 0).all())


def _board_outline(result: Result) -> Array:
    """(4, 3) corners of the board with its outer squares, from the origin's side round, mm."""
    x0, y0, x1, y1 = board_extent_px(result)
    return np.array([[x0, y0, 0.0], [x1, y0, 0.0], [x1, y1, 0.0], [x0, y1, 0.0]])


def _camera_faces(camera: Camera, length: float) -> list[Array]:
    """The pyramid from the camera's centre to its image plane, `length` mm long."""
    w, h = camera.size
    corners = np.array([[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]]) - 0.5
    rays = (corners - camera.centre) / camera.focal
    base = np.column_stack([rays, np.ones(4)]) * length
    apex = np.zeros(3)
    return [base, *(np.array([apex, base[i], base[(i + 1) % 4]]) for i in range(4))]


def _cam_from_board(points: Array, pose: Pose) -> Array:
    return np.asarray(points @ rotation(pose.rvec).T + pose.tvec)


def _board_from_cam(points: Array, pose: Pose) -> Array:
    return np.asarray((points - pose.tvec) @ rotation(pose.rvec))

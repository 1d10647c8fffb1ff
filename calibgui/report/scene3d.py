"""Scene of camera and boards in space, projected to a plane: no 3-D graphics needed.

A scene is a list of flat polygons. Camera-centric, the world is the camera's frame (X right,
Y down, Z forward) and the boards stand in it; board-centric, it is the board's frame and the
cameras X_board = R^T (X_cam - T) stand in it. An observer at a distance of three times the
scene's radius orbits about its middle: with B = B_x(elevation) B_y(azimuth) a point X is at

    p = B (X - middle) + (0, 0, 3 radius),      s = zoom (p_x, p_y) / p_z,

and polygons are painted from the farthest to the nearest by the mean depth of their corners.
Axes of the world, with numbers in mm, say how large all this is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import assert_never

import numpy as np

from calibgui.dataset import Result, RigResult
from calibgui.engine.arrays import Array, freeze
from calibgui.engine.camera import Camera
from calibgui.engine.geometry import rotation_from_vector
from calibgui.report.coverage import find_shown_extent

_OBSERVER_DISTANCE = 3.0
"""Distance of the observer from the middle, in radii of the scene."""
_NEAREST_DEPTH = 0.1
"""Least distance from the observer of what is drawn, radii of the scene."""
_RELATIVE_CAMERA_LENGTH = 0.12
"""Length of a drawn camera over the mean distance of the boards."""
_TICKS = 6
"""Numbers on the longest axis, at most: more would touch each other in a narrow panel."""


class SceneCentre(StrEnum):
    """Object that stands still in the scene."""

    CAMERA = "camera"
    BOARD = "board"


class PolygonKind(StrEnum):
    """Object that a polygon is part of."""

    BOARD = "board"
    CAMERA = "camera"


@dataclass(frozen=True, eq=False, slots=True)
class Polygon:
    """A flat outline in the world; its first corner is the board's origin or the camera's apex."""

    points: Array
    """(n, 3) corners, mm."""
    kind: PolygonKind
    """Object that it is part of."""
    view: int
    """Index of the calibrated view that it stands for; -1 for what all views share."""

    def __post_init__(self) -> None:
        freeze(self, "points")


def build_scene(result: Result, centre: SceneCentre) -> tuple[Polygon, ...]:
    """Build the scene: the views' boards around the camera, or their cameras around the board."""
    camera, poses = result.calibration.camera, result.calibration.poses
    outline = _make_board_outline(result)
    R = rotation_from_vector(np.array([pose.rvec for pose in poses]))
    T = np.array([pose.tvec for pose in poses])
    size = _RELATIVE_CAMERA_LENGTH * float(np.linalg.norm(T, axis=1).mean())
    body = _make_camera_faces(camera, size)
    match centre:
        case SceneCentre.CAMERA:
            shared = [Polygon(face, PolygonKind.CAMERA, -1) for face in body]
            boards = outline @ R.swapaxes(1, 2) + T[:, None]
            placed = [Polygon(points, PolygonKind.BOARD, k) for k, points in enumerate(boards)]
        case SceneCentre.BOARD:
            shared = [Polygon(outline, PolygonKind.BOARD, -1)]
            placed = [
                Polygon((face - T[k]) @ R[k], PolygonKind.CAMERA, k)
                for k in range(len(poses))
                for face in body
            ]
        case _:
            assert_never(centre)
    return (*shared, *placed)


def build_rig_scene(result: RigResult) -> tuple[Polygon, ...]:
    """Build the scene of a rig in the frame of its first camera.

    The boards at an instant stand for one of the views 0 to n - 1, in the order of the rig's
    instants, and the cameras for those after them.
    """
    rig = result.rig
    T = np.array([pose.tvec for pose in rig.boards])
    size = _RELATIVE_CAMERA_LENGTH * float(np.linalg.norm(T, axis=1).mean())
    outlines = [_outline_rig_board(result, b) for b in range(len(rig.placed_boards))]
    seen = dict.fromkeys((view.instant, view.board) for view in rig.views)
    polygons = [
        Polygon(outlines[b] @ rotation_from_vector(pose.rvec).T + pose.tvec, PolygonKind.BOARD, k)
        for k, (instant, pose) in enumerate(zip(rig.instants, rig.boards, strict=True))
        for b in range(len(outlines))
        if (instant, b) in seen
    ]
    for c, (camera, pose) in enumerate(zip(rig.cameras, rig.poses, strict=True)):
        R = rotation_from_vector(pose.rvec)
        polygons += [
            Polygon((face - pose.tvec) @ R, PolygonKind.CAMERA, len(rig.boards) + c)
            for face in _make_camera_faces(camera, size)
        ]
    return tuple(polygons)


def _outline_rig_board(result: RigResult, b: int) -> Array:
    """Return corners (4, 3) of the rectangle around all points of board `b` that were seen, mm, in
    the frame of the board that its place is beside."""
    xy = np.concatenate(
        [view.xy for (_, board, _), view in result.observations.items() if board == b]
    )
    (x0, y0), (x1, y1) = xy.min(axis=0), xy.max(axis=0)
    corners = np.array([[x0, y0, 0.0], [x1, y0, 0.0], [x1, y1, 0.0], [x0, y1, 0.0]])
    pose = result.rig.placed_boards[b].pose
    return corners @ rotation_from_vector(pose.rvec).T + pose.tvec


@dataclass(frozen=True, slots=True)
class Observer:
    """Direction from which the scene is looked at, rad, and zoom; at 1 all fits from every side."""

    azimuth: float = 0.6
    elevation: float = 0.4
    zoom: float = 1.0

    def turned(self, right: float, down: float) -> Observer:
        """Return the observer moved about the scene by angles, rad, never over the poles."""
        elevation = float(np.clip(self.elevation + down, -np.pi / 2, np.pi / 2))
        return replace(self, azimuth=self.azimuth - right, elevation=elevation)

    def zoomed(self, factor: float) -> Observer:
        """Return the observer with the zoom times `factor`, between 0.2 and 20."""
        return replace(self, zoom=float(np.clip(self.zoom * factor, 0.2, 20.0)))


@dataclass(frozen=True, eq=False, slots=True)
class DrawnPolygon:
    """A polygon on the drawing plane."""

    polygon: Polygon
    """The polygon in space."""
    points: Array
    """(n, 2), x right, y down; the whole scene lies within the unit circle at zoom 1."""
    depth: float
    """Mean depth of the corners, radii of the scene."""


@dataclass(frozen=True, eq=False, slots=True)
class Axis:
    """An axis of the world, with ticks; its origin is the camera's centre or the board's origin."""

    name: str
    """Name of the axis: X, Y or Z."""
    points: Array
    """(n, 3) origin, then the ticks, mm; the last one is the axis's end."""
    numbers: Array
    """(n,) distances of the points from the origin, mm."""

    def __post_init__(self) -> None:
        freeze(self, "points", "numbers")


def make_axes(polygons: Sequence[Polygon]) -> tuple[Axis, ...]:
    """Make the world's axes X, Y and Z, each about as long as the scene in its direction.

    Ticks have one round distance on all three. An axis along which there is nothing has one tick.
    """
    if not polygons:
        return ()
    reach = np.concatenate([polygon.points for polygon in polygons]).max(axis=0)
    step = _round_up(float(reach.max()) / _TICKS)
    axes = []
    for name, direction, length in zip("XYZ", np.eye(3), reach, strict=True):
        numbers: Array = step * np.arange(max(int(length / step), 1) + 1, dtype=np.float64)
        axes.append(Axis(name, np.outer(numbers, direction), numbers))
    return tuple(axes)


def _round_up(length: float) -> float:
    """Return the next 1, 2 or 5 times a power of ten."""
    if not length > 0:
        return 1.0
    power = float(10.0 ** np.floor(np.log10(length)))
    return next(digit * power for digit in (1, 2, 5, 10) if digit * power >= length * (1 - 1e-9))


def _measure_scene(polygons: Sequence[Polygon]) -> tuple[Array, float]:
    """Return the middle (3,) of the scene and its radius about it, mm."""
    everything = np.concatenate([polygon.points for polygon in polygons])
    middle = (everything.min(axis=0) + everything.max(axis=0)) / 2
    return middle, float(np.linalg.norm(everything - middle, axis=1).max()) or 1.0


def project_into_scene(
    polygons: Sequence[Polygon], points: Array, observer: Observer
) -> tuple[Array, Array]:
    """Project points (n, 3), mm, to the plane (n, 2) of the drawn polygons, with depths (n,).

    Depths are in radii of the scene.
    """
    middle, radius = _measure_scene(polygons)
    return project_to_plane((points - middle) / radius, observer)


def draw_scene(polygons: Sequence[Polygon], observer: Observer) -> tuple[DrawnPolygon, ...]:
    """Project polygons, and order them for painting; those behind the observer are left out."""
    if not polygons:
        return ()
    everything = np.concatenate([polygon.points for polygon in polygons])
    points, depth = project_into_scene(polygons, everything, observer)
    lengths = np.array([len(polygon.points) for polygon in polygons])
    ends = np.cumsum(lengths)
    begins = ends - lengths
    is_seen = np.minimum.reduceat(depth, begins) > _NEAREST_DEPTH
    mean = np.add.reduceat(depth, begins) / lengths
    return tuple(
        DrawnPolygon(polygons[k], points[begins[k] : ends[k]], float(mean[k]))
        for k in np.argsort(-mean, kind="stable").tolist()
        if is_seen[k]
    )


def fit_zoom(polygons: Sequence[Polygon], observer: Observer) -> Observer:
    """Return the observer with the zoom at which scene and axes fill a square of side 2."""
    observer = replace(observer, zoom=1.0)
    drawn = [item.points for item in draw_scene(polygons, observer)]
    for axis in make_axes(polygons):
        points, depth = project_into_scene(polygons, axis.points, observer)
        drawn.append(points[depth > _NEAREST_DEPTH])
    reach = float(np.abs(np.concatenate(drawn)).max(initial=0.0)) if drawn else 1.0
    return replace(observer, zoom=1.0 / reach)


def project_to_plane(points: Array, observer: Observer) -> tuple[Array, Array]:
    """Project points (n, 3), radii from the middle, to the plane (n, 2), with depths (n,)."""
    a, e = observer.azimuth, observer.elevation
    turn = rotation_from_vector(np.array([e, 0.0, 0.0])) @ rotation_from_vector(
        np.array([0.0, a, 0.0])
    )
    p = points @ turn.T + np.array([0.0, 0.0, _OBSERVER_DISTANCE])
    # A sphere of radius 1 at this distance is seen under asin(1 / distance).
    scale = observer.zoom * np.sqrt(_OBSERVER_DISTANCE**2 - 1)
    return scale * p[:, :2] / p[:, 2:], p[:, 2]


def find_view_at(drawn: Sequence[DrawnPolygon], point: Array) -> int:
    """Find the view of the nearest polygon at `point` (2,) of the drawing plane; -1 if none."""
    for item in reversed(drawn):
        if item.polygon.view >= 0 and _is_inside(item.points, point):
            return item.polygon.view
    return -1


def _is_inside(outline: Array, point: Array) -> bool:
    """Return whether a convex outline (n, 2) contains the point."""
    edge = np.roll(outline, -1, axis=0) - outline
    to = point - outline
    side = edge[:, 0] * to[:, 1] - edge[:, 1] * to[:, 0]
    return bool((side >= 0).all() or (side <= 0).all())


def _make_board_outline(result: Result) -> Array:
    """Return corners (4, 3) of the board with its outer squares, from the origin's on, mm."""
    x0, y0, x1, y1 = find_shown_extent(result)
    return np.array([[x0, y0, 0.0], [x1, y0, 0.0], [x1, y1, 0.0], [x0, y1, 0.0]])


def _make_camera_faces(camera: Camera, length: float) -> list[Array]:
    """Return the faces of the pyramid from the camera's centre to its image, `length` mm long."""
    w, h = camera.size
    corners = np.array([[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]]) - 0.5
    rays = (corners - camera.centre) / camera.focal
    base = np.column_stack([rays, np.ones(4)]) * length
    apex = np.zeros(3)
    return [base, *(np.array([apex, base[i], base[(i + 1) % 4]]) for i in range(4))]

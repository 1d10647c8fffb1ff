"""The next view to take: where to hold the board so that the camera is known best.

Candidate views need no images. Every pose of a lattice (places in the image, tilts towards eight
directions, distances) from which the whole board is seen has its information
(``fisher_information.py``) from the derivatives at its predicted corners; the one that lowers
the loss of ``view_design.py`` most is the next. It then counts as photographed, and the next
after it is sought.

The lattice holds the board upright as the board was held so far, with corners no closer together
than in the views at hand, so that they will be located as well as these. A direction in the
image e = (e1, e2), in which the board recedes, is a turn about w = e x (0, 0, 1) = (e2, -e1, 0).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
import scipy

from calibgui.engine.arrays import Array, freeze
from calibgui.engine.calibration.observations import Observation, Observations
from calibgui.engine.calibration.problem import find_free_parameters
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.camera.projection import measure_axis_scale, rays_from_pixels
from calibgui.engine.errors import CalibrationError, Progress
from calibgui.engine.geometry import rotations
from calibgui.engine.geometry.directions import measure_angles_off_axis
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.uncertainty.fisher_information import (
    FisherInformation,
    compute_view_information,
)
from calibgui.engine.uncertainty.view_design import build_design

_PLACES_IN_IMAGE = ((0.2, 0.35, 0.5, 0.65, 0.8), (0.25, 0.5, 0.75))
"""Places of the board's middle, in widths and in heights of the image."""
_TILTS_DEG = (25.0, 45.0)
"""Tilts beside none, degrees; beyond 45 the corners of a printed board are hard to locate."""
_MIN_SPACING_OF_TILTED = 0.5
"""Least distance between corners of the first tilted board, over that of those held parallel: less
than 45 degrees make of it."""
_WIDTHS_IN_IMAGE = (0.3, 0.45, 0.6, 0.75, 0.9)
"""Widths of the untilted board, in widths of the image."""
_MARGIN_IN_WIDTHS = 0.01
"""Margin that is kept free around the board, in widths of the image."""
_MAX_PARALLEL_ANGLE = np.deg2rad(50.0)
"""Angle off the axis up to which the untilted board is parallel to the sensor, rad."""
_SIDE_NAMES = (
    "right",
    "lower right",
    "lower",
    "lower left",
    "left",
    "upper left",
    "upper",
    "upper right",
)
"""Names of the sides that recede, in eighths of a turn."""


@dataclass(frozen=True, eq=False, slots=True)
class NextView:
    """A view that is worth taking, and what it would gain."""

    pose: Pose
    """cam_from_board, mm."""
    place: Array
    """(2,) place of the board's middle, in widths and heights of the image."""
    fill: float
    """Width of the board if it were not tilted, in widths of the image."""
    tilt: float
    """Angle between the board's normal and the optical axis, degrees."""
    side: int | None
    """Side that recedes, in eighths of a turn: 0 right, 2 lower, 4 left, 6 upper; None untilted."""
    corners: Array
    """(n, 2) predicted corners, px."""
    before: float
    """Rms standard deviation of projection over the image before the view is taken, px."""
    after: float
    """Rms standard deviation of projection over the image after it is taken, px."""

    def __post_init__(self) -> None:
        freeze(self, "place", "corners")

    @property
    def instruction(self) -> str:
        """Sentence that tells where and how to hold the board."""
        column = int(np.digitize(self.place[0], (0.4, 0.6)))
        row = int(np.digitize(self.place[1], (0.4, 0.6)))
        where = (
            ("upper left corner", "upper edge", "upper right corner"),
            ("left edge", "middle", "right edge"),
            ("lower left corner", "lower edge", "lower right corner"),
        )[row][column]
        side = (
            ""
            if self.side is None
            else (f", its {_SIDE_NAMES[self.side]} side tilted {self.tilt:.0f} degrees away")
        )
        return (
            f"Hold the board towards the {where} of the image, {100 * self.fill:.0f} % as wide "
            f"as it{side}."
        )


def propose_views(
    calibration: Calibration,
    views: Sequence[Observation],
    count: int = 3,
    progress: Progress | None = None,
) -> tuple[NextView, ...]:
    """Propose the views that lower the uncertainty of projection most, one after the other.

    Args:
        calibration: the calibration.
        views: the views that it was made from.
        count: number of views to propose.
        progress: function that is called for each candidate view.

    Raises:
        CalibrationError: if no candidate view shows the whole board.
        Cancelled: if `progress` raises it.
    """
    board = np.unique(np.round(np.concatenate([view.xy for view in views]), 9), axis=0)
    candidates = _list_candidates(calibration, views, board, progress)
    if not candidates:
        raise CalibrationError(
            "No candidate view shows the whole board.", "Check the calibration's focal lengths."
        )
    design = build_design(calibration, views)
    possible = _compute_candidate_information(
        calibration, board, [candidate.pose for candidate in candidates]
    )
    every = FisherInformation(
        *(np.concatenate(p) for p in zip(design.views, possible, strict=True))
    )
    # The systematic part is stated for the views at hand: it is converted to the larger number.
    share = len(design.views.camera) / len(every.camera) if design.is_systematic_averaged else 1.0
    extended = replace(design, views=every, systematic=design.systematic * share)
    taken = np.concatenate([np.ones(len(views)), np.zeros(len(candidates))])
    places = np.array([candidate.place for candidate in candidates])
    is_open = np.ones(len(candidates), dtype=bool)
    proposed: list[NextView] = []
    while len(proposed) < count and is_open.any():
        trials = taken + np.eye(len(taken))[len(views) :][is_open]
        losses = extended.compute_loss(trials)
        best = int(np.flatnonzero(is_open)[losses.argmin()])
        before, after = np.sqrt(extended.compute_loss(taken)), np.sqrt(losses.min())
        proposed.append(replace(candidates[best], before=float(before), after=float(after)))
        taken[len(views) + best] = 1.0
        is_open &= (places != places[best]).any(axis=1)  # the next elsewhere in the image
    return tuple(proposed)


def _list_candidates(
    calibration: Calibration,
    views: Sequence[Observation],
    board: Array,
    progress: Progress | None,
) -> list[NextView]:
    """List all candidate views, their gain left open (NaN)."""
    camera = calibration.camera
    w, h = camera.size
    finest = min(_measure_spacing(view.uv) for view in views)
    middle = (board.min(axis=0) + board.max(axis=0)) / 2
    width = float(np.ptp(board[:, 0]))
    scale = measure_axis_scale(camera)
    upright = np.diag([1.0, 1.0, 1.0] if _is_y_down(calibration) else [1.0, -1.0, -1.0])
    found = []
    is_partial = calibration.diagnosis is not None
    # No information tells what a partial calibration assumes; tilted views determine it. Their
    # corners lie closer to each other than those of a board that was held parallel.
    tilts = _list_tilts(is_tilted=is_partial)
    finest *= _MIN_SPACING_OF_TILTED if is_partial else 1.0
    tried = list(product(*_PLACES_IN_IMAGE, _WIDTHS_IN_IMAGE, tilts))
    for done, (x, y, fill, (tilt, side)) in enumerate(tried):
        if progress is not None:
            progress(done, len(tried))
        place = np.array([x, y])
        angle = 2 * np.pi * (side or 0) / 8
        lean = np.deg2rad(tilt) * np.array([np.sin(angle), -np.cos(angle), 0.0])
        ray = rays_from_pixels(place * (w - 1, h - 1), camera)
        R = _face_camera(ray) @ rotations.rotation_from_vector(lean) @ upright
        ray = ray / max(ray[2], np.cos(_MAX_PARALLEL_ANGLE))
        T = width * scale / (fill * w) * ray - R[:, :2] @ middle
        pose = Pose(rotations.vector_from_rotation(R), T)
        corners = project_points(board, camera, pose)
        if _is_within_image(corners, camera) and _measure_spacing(corners) >= finest:
            found.append(NextView(pose, place, fill, tilt, side, corners, np.nan, np.nan))
    return found


def _face_camera(ray: Array) -> Array:
    """Return the rotation (3, 3) of a board that is seen along a ray of length 1, without tilt.

    It is parallel to the sensor, except where it would be seen almost edge-on.
    """
    angle = float(measure_angles_off_axis(ray))
    if not angle > _MAX_PARALLEL_ANGLE:
        return np.eye(3)
    axis = np.array([-ray[1], ray[0], 0.0]) / np.hypot(*ray[:2])
    return rotations.rotation_from_vector(angle * axis)


def _list_tilts(*, is_tilted: bool) -> list[tuple[float, int | None]]:
    """List the tilts, degrees, with the sides that recede; no tilt only if it may be one."""
    tilts: list[tuple[float, int | None]] = list(product(_TILTS_DEG, range(8)))
    return tilts if is_tilted else [(0.0, None), *tilts]


def _is_y_down(calibration: Calibration) -> bool:
    """Return whether the board's Z points away from the camera in most views, so that Y is down."""
    R = rotations.rotation_from_vector(np.array([pose.rvec for pose in calibration.poses]))
    return bool(np.sign(R[:, 2, 2]).sum() >= 0)


def _measure_spacing(corners: Array) -> float:
    """Return the smallest distance between corners (n, 2), px."""
    return float(np.asarray(scipy.spatial.cKDTree(corners).query(corners, k=2)[0])[:, 1].min())


def _is_within_image(corners: Array, camera: Camera) -> bool:
    """Return whether all corners (n, 2) lie in the image, off its margin."""
    margin = _MARGIN_IN_WIDTHS * camera.size[0]
    inside = (corners >= margin) & (corners <= np.array(camera.size) - 1 - margin)
    return bool(inside.all())


def _compute_candidate_information(
    calibration: Calibration, board: Array, poses: list[Pose]
) -> FisherInformation:
    """Compute the information that views in these poses would hold about the camera."""
    K = len(poses)
    R = rotations.rotation_from_vector(np.array([pose.rvec for pose in poses]))
    state = State(calibration.camera.params, R, np.array([pose.tvec for pose in poses]))
    uv = np.array([project_points(board, calibration.camera, pose) for pose in poses])
    seen = Observations(uv, np.tile(board, (K, 1, 1)), np.ones((K, len(board))), None)
    return compute_view_information(
        state,
        seen,
        calibration.camera.model,
        find_free_parameters(calibration),
        calibration.cost,
        calibration.reference_scale,
    )

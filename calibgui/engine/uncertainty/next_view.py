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

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, BoolArray, freeze
from calibgui.engine.calibration.observations import Observation, Observations
from calibgui.engine.calibration.problem import find_free_parameters
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import (
    measure_axis_scale,
    pixels_from_rays,
    rays_from_pixels,
)
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import rotations
from calibgui.engine.geometry.directions import measure_angles_off_axis
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.uncertainty.fisher_information import (
    FisherInformation,
    compute_view_information,
)
from calibgui.engine.uncertainty.view_design import ViewDesign, build_design

Loss = Callable[[ViewDesign, Array], Array]
"""Variance of projection that a choice (..., K) of views of a design leaves, (...) px^2."""
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
    """Standard deviation of projection before the view is taken, px: over the image, or of its
    worst pixel, whichever was to be lowered."""
    after: float
    """The same after it is taken, px."""

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


class _Candidates(NamedTuple):
    """C views that might be taken of the n corners of a board."""

    place: Array
    """(C, 2) places of the board's middle, in widths and heights of the image."""
    fill: Array
    """(C,) widths of the untilted board, in widths of the image."""
    tilt: Array
    """(C,) tilts, degrees."""
    side: Array
    """(C,) sides that recede, in eighths of a turn; NaN untilted."""
    R: Array
    """(C, 3, 3) rotations cam_from_board."""
    T: Array
    """(C, 3) translations, mm."""

    def choose(self, chosen: BoolArray) -> _Candidates:
        """Return the candidates that a mask (C,) chooses."""
        return _Candidates(*(each[chosen] for each in self))

    def project(self, board: Array, camera: Camera) -> Array:
        """Return the corners (C, n, 2) of board points (n, 2), px; NaN where none is seen."""
        return pixels_from_rays(
            board @ np.swapaxes(self.R[..., :2], 1, 2) + self.T[:, None], camera
        )


def propose_views(
    calibration: Calibration,
    views: Sequence[Observation],
    count: int = 3,
    loss: Loss = ViewDesign.compute_loss,
) -> tuple[NextView, ...]:
    """Propose the views that lower the uncertainty of projection most, one after the other.

    Args:
        calibration: the calibration.
        views: the views that it was made from.
        count: number of views to propose.
        loss: what of the uncertainty is lowered: its mean square over the image, or that of the
            worst pixel (``ViewDesign.compute_worst``).

    Raises:
        CalibrationError: if no candidate view shows the whole board.
    """
    board = np.unique(np.round(np.concatenate([view.xy for view in views]), 9), axis=0)
    candidates, corners = _list_candidates(calibration, views, board)
    if not len(corners):
        raise CalibrationError(
            "No candidate view shows the whole board.", "Check the calibration's focal lengths."
        )
    extended = _extend_design(calibration, views, board, candidates, corners)
    taken = np.concatenate([np.ones(len(views)), np.zeros(len(corners))])
    is_open = np.ones(len(corners), dtype=bool)
    proposed: list[NextView] = []
    while len(proposed) < count and is_open.any():
        trials = taken + np.eye(len(taken))[len(views) :][is_open]
        losses = loss(extended, trials)
        best = int(np.flatnonzero(is_open)[losses.argmin()])
        side = candidates.side[best]
        proposed.append(
            NextView(
                Pose(rotations.vector_from_rotation(candidates.R[best]), candidates.T[best]),
                place=candidates.place[best],
                fill=float(candidates.fill[best]),
                tilt=float(candidates.tilt[best]),
                side=None if np.isnan(side) else int(side),
                corners=corners[best],
                before=float(np.sqrt(loss(extended, taken))),
                after=float(np.sqrt(losses.min())),
            )
        )
        taken[len(views) + best] = 1.0
        # The next is sought elsewhere in the image.
        is_open &= (candidates.place != candidates.place[best]).any(axis=1)
    return tuple(proposed)


def predict_uncertainty(
    calibration: Calibration,
    views: Sequence[Observation],
    view: Observation,
    pose: Pose,
    loss: Loss = ViewDesign.compute_loss,
) -> float:
    """Predict the standard deviation of projection, px, with one more view.

    Args:
        calibration: the calibration.
        views: the views that it was made from.
        view: the view that is added; where its corners are counts, and not by how much they are
            off.
        pose: its pose cam_from_board, mm.
        loss: what of the uncertainty is predicted, as for `propose_views`.
    """
    R = rotations.rotation_from_vector(np.array(pose.rvec))
    unused = np.full(1, np.nan)
    one = _Candidates(unused, unused, unused, unused, R[None], np.array(pose.tvec)[None])
    extended = _extend_design(calibration, views, view.xy, one, view.uv[None])
    return float(np.sqrt(loss(extended, np.ones(len(views) + 1))))


def _extend_design(
    calibration: Calibration,
    views: Sequence[Observation],
    board: Array,
    candidates: _Candidates,
    corners: Array,
) -> ViewDesign:
    """Build the design whose choice is the views of a calibration and candidates after them."""
    design = build_design(calibration, views)
    possible = _compute_candidate_information(calibration, board, candidates, corners)
    every = FisherInformation(
        *(np.concatenate(p) for p in zip(design.views, possible, strict=True))
    )
    # The systematic part is stated for the views at hand: it is converted to the larger number.
    share = len(design.views.camera) / len(every.camera) if design.is_systematic_averaged else 1.0
    return replace(design, views=every, systematic=design.systematic * share)


def _list_candidates(
    calibration: Calibration, views: Sequence[Observation], board: Array
) -> tuple[_Candidates, Array]:
    """List the views that show the whole board large enough, with their corners (C, n, 2), px."""
    camera = calibration.camera
    finest = min(measure_spacing(view.uv) for view in views)
    is_partial = calibration.diagnosis is not None
    # No information tells what a partial calibration assumes; tilted views determine it. Their
    # corners lie closer to each other than those of a board that was held parallel.
    finest *= _MIN_SPACING_OF_TILTED if is_partial else 1.0
    posed = _pose_boards(calibration, board, _list_tilts(is_tilted=is_partial))
    around = board[scipy.spatial.ConvexHull(board).vertices]
    posed = posed.choose(_are_within_image(posed.project(around, camera), camera))
    corners = posed.project(board, camera)
    good = _are_within_image(corners, camera)
    good[good] = [measure_spacing(uv) >= finest for uv in corners[good]]
    return posed.choose(good), corners[good]


def _pose_boards(
    calibration: Calibration, board: Array, tilts: list[tuple[float, float]]
) -> _Candidates:
    """Pose the board at all places, distances and tilts."""
    camera = calibration.camera
    w, h = camera.size
    tried = np.array(
        [
            (*place, fill, *tilted)
            for place, fill, tilted in product(product(*_PLACES_IN_IMAGE), _WIDTHS_IN_IMAGE, tilts)
        ]
    )
    place, fill, tilt, side = tried[:, :2], tried[:, 2], tried[:, 3], tried[:, 4]
    angle = 2 * np.pi * np.nan_to_num(side) / 8
    lean = np.stack([np.sin(angle), -np.cos(angle), np.zeros(len(angle))], axis=-1)
    rays = rays_from_pixels(place * (w - 1, h - 1), camera)
    upright = np.diag([1.0, 1.0, 1.0] if _is_y_down(calibration) else [1.0, -1.0, -1.0])
    turned = rotations.rotation_from_vector(np.deg2rad(tilt)[:, None] * lean)
    R = _face_camera(rays) @ turned @ upright
    middle = (board.min(axis=0) + board.max(axis=0)) / 2
    depth = np.ptp(board[:, 0]) * measure_axis_scale(camera) / (fill * w)
    along = rays / np.maximum(rays[:, 2:], np.cos(_MAX_PARALLEL_ANGLE))
    return _Candidates(place, fill, tilt, side, R, depth[:, None] * along - R[..., :2] @ middle)


def _face_camera(rays: Array) -> Array:
    """Return the rotations (C, 3, 3) of boards that are seen along rays of length 1, untilted.

    They are parallel to the sensor, except where they would be seen almost edge-on.
    """
    angle = measure_angles_off_axis(rays)
    is_oblique = angle > _MAX_PARALLEL_ANGLE
    axis = np.stack([-rays[:, 1], rays[:, 0], np.zeros(len(rays))], axis=-1)
    axis /= np.maximum(np.linalg.norm(axis, axis=-1, keepdims=True), np.finfo(float).tiny)
    return rotations.rotation_from_vector(np.where(is_oblique, angle, 0.0)[:, None] * axis)


def _list_tilts(*, is_tilted: bool) -> list[tuple[float, float]]:
    """List the tilts, degrees, with the sides that recede; no tilt only if it may be one."""
    tilts = list(product(_TILTS_DEG, map(float, range(8))))
    return tilts if is_tilted else [(0.0, np.nan), *tilts]


def _is_y_down(calibration: Calibration) -> bool:
    """Return whether the board's Z points away from the camera in most views, so that Y is down."""
    R = rotations.rotation_from_vector(np.array([pose.rvec for pose in calibration.poses]))
    return bool(np.sign(R[:, 2, 2]).sum() >= 0)


def measure_spacing(corners: Array) -> float:
    """Return the smallest distance between corners (n, 2), px."""
    return float(np.asarray(scipy.spatial.cKDTree(corners).query(corners, k=2)[0])[:, 1].min())


def _are_within_image(corners: Array, camera: Camera) -> BoolArray:
    """Return whether all corners (C, n, 2) of each view lie in the image, off its margin."""
    margin = _MARGIN_IN_WIDTHS * camera.size[0]
    inside = (corners >= margin) & (corners <= np.array(camera.size) - 1 - margin)
    return np.asarray(inside.all(axis=(1, 2)))


def _compute_candidate_information(
    calibration: Calibration, board: Array, candidates: _Candidates, corners: Array
) -> FisherInformation:
    """Compute the information that views would hold about the camera."""
    count = len(corners)
    state = State(calibration.camera.params, candidates.R, candidates.T)
    ones = np.ones(corners.shape[:2])
    seen = Observations(corners, np.tile(board, (count, 1, 1)), ones, None)
    return compute_view_information(
        state,
        seen,
        calibration.camera.model,
        find_free_parameters(calibration),
        calibration.cost,
        calibration.reference_scale,
    )

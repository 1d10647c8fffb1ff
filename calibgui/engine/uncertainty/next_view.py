"""Which view to take next: where to hold the board so that the camera is known best.

Imagined views need no images. Every pose of a lattice (places in the image, tilts towards eight
directions, distances) from which the whole board is seen has its information
(``information.py``) from the derivatives at its predicted corners; the one that lowers the
loss of ``view_design.py`` most is the next. It is then taken as photographed, and the next
after it is sought.

The lattice holds poses upright as the board was held so far, with corners no closer together
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
from calibgui.engine.calibration.problem import free_parameters
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.camera.projection import rays
from calibgui.engine.errors import CalibrationError, Progress
from calibgui.engine.geometry import rotations
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.uncertainty.fisher_information import Information, view_information
from calibgui.engine.uncertainty.view_design import design

_PLACES = ((0.2, 0.35, 0.5, 0.65, 0.8), (0.25, 0.5, 0.75))
"""Of the board's middle, in widths and heights of the image."""
_TILTS = (25.0, 45.0)
"""Degrees, beside none; beyond 45 the corners of a printed board are hard to locate."""
_FILLS = (0.3, 0.45, 0.6, 0.75, 0.9)
"""Width of an untilted board, in widths of the image."""
_MARGIN = 0.01
"""Of the image's width that is kept free around the board."""
_SIDES = (
    "right",
    "lower right",
    "lower",
    "lower left",
    "left",
    "upper left",
    "upper",
    "upper right",
)


@dataclass(frozen=True, eq=False, slots=True)
class NextView:
    """A view worth taking."""

    pose: Pose
    place: Array
    """(2,) of the board's middle, in widths and heights of the image."""
    fill: float
    """Width of the board if it were not tilted, in widths of the image."""
    tilt: float
    """Degrees."""
    side: int | None
    """Side that recedes, in eighths of a turn: 0 right, 2 lower, 4 left, 6 upper; None untilted."""
    corners: Array
    """(n, 2) where its corners will be, px."""
    before: float
    """Rms standard deviation of projection over the image before it is taken, px."""
    after: float
    """The same after."""

    def __post_init__(self) -> None:
        freeze(self, "place", "corners")

    @property
    def words(self) -> str:
        """What to do, in a sentence."""
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
            else (f", its {_SIDES[self.side]} side tilted {self.tilt:.0f} degrees away")
        )
        return (
            f"Hold the board towards the {where} of the image, {100 * self.fill:.0f} % as wide "
            f"as it{side}."
        )


def next_views(
    calibration: Calibration,
    views: Sequence[Observation],
    count: int = 3,
    progress: Progress | None = None,
) -> tuple[NextView, ...]:
    """The views that are worth most, one after the other.

    Args:
        calibration: of the camera.
        views: that it was made from.
        count: how many to propose.
        progress: told of each imagined view.

    Raises:
        CalibrationError: if the camera sees the whole board from nowhere.
        Cancelled: from `progress`.
    """
    board = np.unique(np.round(np.concatenate([view.xy for view in views]), 9), axis=0)
    imagined = _lattice(calibration, views, board, progress)
    if not imagined:
        raise CalibrationError(
            "No imagined view shows the whole board.", "Check the calibration's focal lengths."
        )
    known = design(calibration, views)
    possible = _informed(calibration, board, [one.pose for one in imagined])
    every = Information(*(np.concatenate(p) for p in zip(known.views, possible, strict=True)))
    # The doubt belongs to the views at hand: it is told in their number.
    share = len(known.views.camera) / len(every.camera) if known.doubt_falls else 1.0
    whole = replace(known, views=every, doubt=known.doubt * share)
    taken = np.concatenate([np.ones(len(views)), np.zeros(len(imagined))])
    places = np.array([one.place for one in imagined])
    open_ = np.ones(len(imagined), dtype=bool)
    proposed: list[NextView] = []
    while len(proposed) < count and open_.any():
        trials = taken + np.eye(len(taken))[len(views) :][open_]
        losses = whole.loss(trials)
        best = int(np.flatnonzero(open_)[losses.argmin()])
        before, after = np.sqrt(whole.loss(taken)), np.sqrt(losses.min())
        proposed.append(replace(imagined[best], before=float(before), after=float(after)))
        taken[len(views) + best] = 1.0
        open_ &= (places != places[best]).any(axis=1)  # the next elsewhere in the image
    return tuple(proposed)


def _lattice(
    calibration: Calibration,
    views: Sequence[Observation],
    board: Array,
    progress: Progress | None,
) -> list[NextView]:
    """All imagined views, without what they are worth."""
    camera = calibration.camera
    w, h = camera.size
    finest = min(_spacing(view.uv) for view in views)
    middle = (board.min(axis=0) + board.max(axis=0)) / 2
    width = float(np.ptp(board[:, 0]))
    upright = np.diag([1.0, 1.0, 1.0] if _faces(calibration) else [1.0, -1.0, -1.0])
    found = []
    tried = list(product(*_PLACES, _FILLS, _leanings()))
    for done, (x, y, fill, (tilt, side)) in enumerate(tried):
        if progress is not None:
            progress(done, len(tried))
        place = np.array([x, y])
        angle = 2 * np.pi * (side or 0) / 8
        lean = np.deg2rad(tilt) * np.array([np.sin(angle), -np.cos(angle), 0.0])
        R = rotations.rotation(lean) @ upright
        ray = np.append(rays(place * (w - 1, h - 1), camera), 1.0)
        T = width * camera.focal[0] / (fill * w) * ray - R[:, :2] @ middle
        pose = Pose(rotations.rotation_vector(R), T)
        corners = project_points(board, camera, pose)
        if _visible(corners, camera) and _spacing(corners) >= finest:
            found.append(NextView(pose, place, fill, tilt, side, corners, np.nan, np.nan))
    return found


def _leanings() -> list[tuple[float, int | None]]:
    """Tilts with the sides that recede."""
    return [(0.0, None), *product(_TILTS, range(8))]


def _faces(calibration: Calibration) -> bool:
    """Whether the plate's Z points away from the camera in most views, so that Y is down."""
    R = rotations.rotation(np.array([pose.rvec for pose in calibration.poses]))
    return bool(np.sign(R[:, 2, 2]).sum() >= 0)


def _spacing(corners: Array) -> float:
    """Smallest distance between corners (n, 2), px."""
    return float(np.asarray(scipy.spatial.cKDTree(corners).query(corners, k=2)[0])[:, 1].min())


def _visible(corners: Array, camera: Camera) -> bool:
    margin = _MARGIN * camera.size[0]
    inside = (corners >= margin) & (corners <= np.array(camera.size) - 1 - margin)
    return bool(inside.all())


def _informed(calibration: Calibration, board: Array, poses: list[Pose]) -> Information:
    """What views in these poses would say of the camera."""
    K = len(poses)
    R = rotations.rotation(np.array([pose.rvec for pose in poses]))
    state = State(calibration.camera.params, R, np.array([pose.tvec for pose in poses]))
    uv = np.array([project_points(board, calibration.camera, pose) for pose in poses])
    seen = Observations(uv, np.tile(board, (K, 1, 1)), np.ones((K, len(board))), None)
    return view_information(
        state,
        seen,
        calibration.camera.model,
        free_parameters(calibration),
        calibration.cost,
        calibration.reference_scale,
    )

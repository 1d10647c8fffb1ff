"""The records of a rig: what is given of its cameras and boards, and what was found.

A rig is several cameras that do not move against each other, and instants at which they photograph
one board together, or several that stand fast to each other. Its frame is that of its first camera:
`Rig.poses` are cam_from_rig, so that the first is the identity, and `Rig.boards` are rig_from_board
of the first board. The others' place beside it is `PlacedBoard.pose`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum

import numpy as np

from calibgui.engine.arrays import Array, IntArray, freeze
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Status
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import find_model
from calibgui.engine.geometry.pose import Pose


@dataclass(frozen=True, eq=False, slots=True)
class RigCamera:
    """A camera of a rig as it is known before, with what it saw."""

    name: str
    """Its name, for messages."""
    camera: Camera
    """The camera as it was calibrated alone, or as an earlier result has it."""
    views: Mapping[int, Observation]
    """Corners of the first board in its photographs, by the number of the instant."""
    fixed: Sequence[str] | None = None
    """Names of the parameters that are held; None for those that the lens model holds by default.
    """
    covariance: Array | None = None
    """(P, P) covariance of the camera's parameters, if they are known from elsewhere than `views`:
    they are then estimated with this as prior. None if the views alone tell them."""
    model_error: float = 0.0
    """Standard deviation that the models of board and lens add to the covariances of corners, px
    along each axis; see ``Calibration.model_error``."""
    times: Mapping[int, float] = field(default_factory=dict)
    """Time of each photograph by the camera's clock, s, by the number of the instant; empty if they
    are not known, and all cameras took them at the same moments, a second apart."""
    others: Sequence[Mapping[int, Observation]] = ()
    """Corners of the second board and of those after it, likewise."""

    @property
    def views_by_board(self) -> tuple[Mapping[int, Observation], ...]:
        """The views of each board."""
        return (self.views, *self.others)

    @property
    def free(self) -> IntArray:
        """Indices of the parameters that are estimated."""
        held = find_model(self.camera.model).held if self.fixed is None else self.fixed
        return np.array([i for i, name in enumerate(self.camera.names) if name not in held], int)

    def hold(self) -> RigCamera:
        """Return the camera with all parameters held."""
        return replace(self, fixed=self.camera.names, covariance=None)


@dataclass(frozen=True, eq=False, slots=True)
class RigBoard:
    """A board of a rig as it is known before."""

    name: str = "the board"
    """Its name, for messages."""
    pose: Pose | None = None
    """Pose first_from_board beside the first board if it is stated, which is then held; None to
    estimate it."""
    shape: BoardShapeModel = BoardShapeModel.NOMINAL
    """The deviations from its drawing that are estimated with the rig."""


@dataclass(frozen=True, eq=False, slots=True)
class PlacedBoard:
    """A board of a rig with its place beside the others, after the solve."""

    name: str = "the board"
    pose: Pose = field(default_factory=lambda: Pose(np.zeros(3), np.zeros(3)))
    """Pose reference_from_board."""
    reference: int = 0
    """Number of the board that the pose is beside: the first one, or another one if this board was
    never seen at one instant with the first; its own number if it was seen with none before it."""
    shape: BoardShape | None = None
    """The shape that was estimated; None if the board is as drawn."""


@dataclass(frozen=True, eq=False, slots=True)
class RigView:
    """The view of the board by one camera at one instant, after the solve."""

    camera: int
    """Number of the camera, from 0."""
    instant: int
    """Number of the instant."""
    residuals: Array
    """(n, 2) measured minus predicted corner, px."""
    alone: float
    """Root mean square length of the residuals with the camera as it was calibrated alone, and the
    board where this view alone has it, px."""
    contradiction: float
    """Root mean square difference of the board's pose in this view from that in the view of the
    same instant that it is compared with, in units of its effect on the corners, px; 0 for that
    view itself. A view that fits has about the corners' noise."""
    turned: float = 0.0
    """Angle, degrees, by which the board was counted from another end than in the view of the same
    instant that it is compared with; the residuals are with the board turned back."""
    board: int = 0
    """Number of the board, from 0."""

    def __post_init__(self) -> None:
        freeze(self, "residuals")

    @property
    def rms(self) -> float:
        """Root mean square length of the residuals, px."""
        return float(np.sqrt(np.mean(np.sum(self.residuals**2, axis=1))))


@dataclass(frozen=True, slots=True)
class RigPair:
    """Two cameras that were joined, because they share most instants."""

    first: int
    """Number of the camera that was in place before."""
    second: int
    """Number of the camera that was joined to it."""
    shared: int
    """Number of instants at which both see the board, and agree."""
    scatter: float
    """Root mean square distance, mm, of the second camera's places as single instants have them
    from the one that most agree about."""
    noise_scatter: float
    """The same as the corners' noise alone explains it."""


class Mistake(StrEnum):
    """The mistakes that are told apart."""

    SHIFTED = "shifted"
    EXCHANGED = "exchanged"
    OTHER_SCALE = "other-scale"
    MOVED = "moved"
    REFOCUSED = "refocused"
    OTHER_INSTANT = "other-instant"
    LESS_AGREEMENT = "less-agreement"
    BOARDS_MOVED = "boards-moved"


@dataclass(frozen=True, slots=True)
class RigMistake:
    """A mistake that was found."""

    kind: Mistake
    camera: int
    """Number of the camera, or of the second one of the pair that it was found in."""
    other: int
    """Number of the first camera of the pair; that of the camera itself where there is none."""
    instants: tuple[int, ...]
    """Numbers of the instants concerned; of what has moved or was refocused, those after."""
    value: float
    """Number of instants by which a pairing is shifted (positive if the camera's photographs belong
    to later ones), ratio of squares or of focal lengths, or distance, mm, by which a camera has
    moved, or one board beside another; 0 otherwise."""


@dataclass(frozen=True, slots=True)
class LeftOutView:
    """A view that took no part because it contradicts the others."""

    camera: int
    """Number of the camera, from 0."""
    instant: int
    """Number of the instant."""
    error: float
    """Root mean square length, px, by which the corners of this view and of the one that it is
    compared with lie off what both views would have together."""
    board: int = 0
    """Number of the board, from 0."""


@dataclass(frozen=True, eq=False, slots=True)
class Layout:
    """The places of a rig's parameters in one vector.

    Camera by camera, they are the parameters of the camera, the rotation vector and the translation
    of its pose cam_from_rig, rad and mm, and the time by which its photographs are late, s. Those
    of the pose reference_from_board of the second board and of those after it come last.
    """

    counts: tuple[int, ...]
    """Numbers of the cameras' own parameters."""
    boards: int = 1
    """Number of boards."""

    @property
    def size(self) -> int:
        """Number of all parameters."""
        return self._board_start + 6 * (self.boards - 1)

    @property
    def _board_start(self) -> int:
        return sum(self.counts) + 7 * len(self.counts)

    def camera(self, c: int) -> slice:
        """Return the place of camera `c`'s own parameters."""
        start = sum(self.counts[:c]) + 7 * c
        return slice(start, start + self.counts[c])

    def pose(self, c: int) -> slice:
        """Return the place of camera `c`'s pose."""
        start = self.camera(c).stop
        return slice(start, start + 6)

    def offset(self, c: int) -> int:
        """Return the place of camera `c`'s offset in time."""
        return self.pose(c).stop

    def board(self, b: int) -> slice:
        """Return the place of board `b`'s pose; that of the first, which has none, is empty."""
        start = self._board_start + 6 * max(b - 1, 0)
        return slice(start, start + 6 * (b > 0))


@dataclass(frozen=True, eq=False, slots=True)
class Rig:
    """Cameras that stand fast to each other, with everything needed to judge them."""

    names: tuple[str, ...]
    """Names of the cameras."""
    cameras: tuple[Camera, ...]
    poses: tuple[Pose, ...]
    """Poses cam_from_rig of the cameras; that of the first is the identity."""
    offsets: Array
    """(C,) times by which each camera is later than the first, s; 0 where it was not estimated."""
    covariance: Array
    """(n, n) covariance of all parameters in the order of `layout`; 0 for what is held. It counts
    how much the instants disagree, and no error that all instants share, such as the board's."""
    noise_covariance: Array
    """(n, n) the same from the corners' noise alone."""
    instants: tuple[int, ...]
    """Numbers of the instants that took part, ascending."""
    boards: tuple[Pose, ...]
    """Pose rig_from_board of the first board at each of these instants; of the board that those
    seen there have their places beside, if the first has none beside them."""
    views: tuple[RigView, ...]
    """The views of the cameras at these instants, by camera, board and instant."""
    noise: float
    """Standard deviation of one coordinate of a residual, px."""
    disagreement: float
    """Ratio of the instants' disagreement about the rig to what the corners' noise explains, if it
    is significant; `covariance` includes it. 0 otherwise."""
    status: Status
    pairs: tuple[RigPair, ...]
    """The pairs that join the cameras, in the order in which they were joined."""
    left_out: tuple[LeftOutView, ...] = ()
    """Views that took no part because they contradict the others."""
    mistakes: tuple[RigMistake, ...] = ()
    """What is wrong with the views, as far as they tell (``mistakes.py``)."""
    placed_boards: tuple[PlacedBoard, ...] = (PlacedBoard(),)
    """The boards."""

    def __post_init__(self) -> None:
        freeze(self, "offsets", "covariance", "noise_covariance")

    @property
    def layout(self) -> Layout:
        """The places of the parameters in `covariance`."""
        counts = tuple(len(camera.params) for camera in self.cameras)
        return Layout(counts, len(self.placed_boards))

    @property
    def rms(self) -> float:
        """Root mean square length of all residuals, px."""
        return _compute_rms([view.residuals for view in self.views])

    @property
    def rms_alone(self) -> float:
        """Root mean square length of the residuals of each camera alone, px."""
        squares = [view.alone**2 * len(view.residuals) for view in self.views]
        return float(np.sqrt(sum(squares) / sum(len(view.residuals) for view in self.views)))

    def camera_sigma(self, c: int) -> Array:
        """Return (P,) standard deviations of camera `c`'s own parameters; 0 for held ones."""
        return self._sigma(self.layout.camera(c))

    def pose_sigma(self, c: int) -> Array:
        """Return (6,) standard deviations of camera `c`'s (rvec, tvec), rad and mm."""
        return self._sigma(self.layout.pose(c))

    def offset_sigma(self, c: int) -> float:
        """Return the standard deviation of camera `c`'s offset in time, s."""
        place = self.layout.offset(c)
        return float(np.sqrt(self.covariance[place, place]))

    def board_sigma(self, b: int) -> Array:
        """Return (6,) standard deviations of board `b`'s (rvec, tvec) beside its reference, rad and
        mm; 0 for a reference itself."""
        return self._sigma(self.layout.board(b)) if b else np.zeros(6)

    def camera_rms(self, c: int) -> float:
        """Return the root mean square length of camera `c`'s residuals, px."""
        return _compute_rms([view.residuals for view in self.views if view.camera == c])

    def _sigma(self, place: slice) -> Array:
        return np.asarray(np.sqrt(np.diagonal(self.covariance)[place]))


def _compute_rms(residuals: Sequence[Array]) -> float:
    squares = [np.sum(part**2) for part in residuals]
    return float(np.sqrt(sum(squares) / sum(map(len, residuals))))

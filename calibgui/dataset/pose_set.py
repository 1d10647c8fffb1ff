"""The poses of boards in photographs of a known camera: what is saved, drawn and tabulated."""

from __future__ import annotations

from dataclasses import dataclass

from calibgui.dataset.corner_set import describe_lengths
from calibgui.engine.boards import Board
from calibgui.engine.calibration import BoardPose
from calibgui.engine.camera import Camera


@dataclass(frozen=True, eq=False, slots=True)
class LocatedView:
    """A photograph with the pose of its board, or with the reason why it has none."""

    image: str
    """Path or name of the image."""
    found: BoardPose | None = None
    reason: str = ""
    """Why there is no pose; empty if there is one."""


@dataclass(frozen=True, eq=False, slots=True)
class PoseSet:
    """Photographs of one camera, which is held, with the poses of the board that they show."""

    camera: Camera
    views: tuple[LocatedView, ...]
    """All photographs, those without a pose included."""
    board: Board | None = None
    """The board of known layout; None where the corners came with their board points."""
    lengths_confirmed: bool = True
    """False if nobody has stated the side of a square: all lengths then hold if it is that."""
    has_covariance: bool = True
    """False if the camera counts as exact, because the errors of its parameters are not known."""

    @property
    def located(self) -> tuple[tuple[str, BoardPose], ...]:
        """The images in which the board was located, each with its pose."""
        return tuple((view.image, view.found) for view in self.views if view.found is not None)

    @property
    def condition(self) -> str:
        """Condition under which all lengths hold, as "if squares are 30 mm"; empty if they do."""
        return "" if self.lengths_confirmed else describe_lengths(self.board)

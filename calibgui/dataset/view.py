"""Targets, and what images show of them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from calibgui.engine.arrays import Array, freeze
from calibgui.engine.boards import Board
from calibgui.engine.calibration import Observation
from calibgui.engine.detection import Corners


class ViewStatus(StrEnum):
    """What is known of one image."""

    WAITING = "waiting"
    """Not searched yet."""
    FOUND = "found"
    NO_BOARD = "no-board"
    UNREADABLE = "unreadable"
    WRONG_SIZE = "wrong-size"


@dataclass(frozen=True, eq=False, slots=True)
class View:
    """One image of a project, with its corners or the reason why there are none."""

    image: str
    """Path or name of the image."""
    status: ViewStatus = ViewStatus.WAITING
    reason: str = ""
    """Why the image cannot be used, and the remedy; empty if it can."""
    note: str = ""
    """How its corners came about, where that is worth knowing."""
    corners: Corners | None = None
    """Corners found on a target of known layout."""
    points: Observation | None = None
    """Corners with their plate points, where they came from elsewhere (a corners file)."""
    roi: Array | None = None
    """(4, 2) region of interest given by the user, px."""
    enabled: bool = True
    """Whether the user wants it in the calibration."""

    def __post_init__(self) -> None:
        freeze(self, "roi")

    @property
    def usable(self) -> bool:
        """Whether the view takes part in a calibration."""
        return self.enabled and self.status is ViewStatus.FOUND

    def observation(self, board: Board | None) -> Observation:
        """What the view contributes to a calibration, on `target` (needed for found corners)."""
        if self.points is not None:
            return self.points
        if self.corners is None or board is None:
            raise ValueError(f"{self.image} has no corners on a known target")
        return Observation(self.corners.uv, board.points(self.corners.grid), self.corners.cov)

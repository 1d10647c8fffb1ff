"""One photograph with its corners, or with the reason why it has none."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import PurePath

from calibgui.engine.arrays import Array, freeze
from calibgui.engine.boards import Board
from calibgui.engine.calibration import Observation
from calibgui.engine.camera import ImageCircle
from calibgui.engine.features import Corners
from calibgui.engine.images import Field

_TOO_FEW_CORNERS = (
    "The few corners found do not tell where the board is: at least 4 do, in two rows and two "
    "columns. They are kept, and take no part in a calibration: show more of the board."
)


class ViewStatus(StrEnum):
    """Outcome of the search for the board in one photograph."""

    WAITING = "waiting"
    """Not searched yet."""
    FOUND = "found"
    """The board was found."""
    NO_BOARD = "no-board"
    """No board was found."""
    UNREADABLE = "unreadable"
    """The file is missing, damaged or no image."""
    WRONG_SIZE = "wrong-size"
    """The image has another size than the others."""


@dataclass(frozen=True, eq=False, slots=True)
class View:
    """One photograph of a project, with its corners or the reason why there are none."""

    image: str
    """Path or name of the image."""
    status: ViewStatus = ViewStatus.WAITING
    """Outcome of the search for the board."""
    reason: str = ""
    """Why the image cannot be used, and the remedy; empty if it can."""
    note: str = ""
    """Remark on the search that found the corners, where there is one; otherwise empty."""
    corners: Corners | None = None
    """Corners found on a board of known layout."""
    points: Observation | None = None
    """Corners with their points on the board, where another program located them."""
    roi: Array | None = None
    """(4, 2) corners of the region of interest that the user gave, px."""
    orientation: int | None = None
    """EXIF orientation by which the image's pixels are turned, 1 to 8, the same for all photographs
    of a camera (``app/photographs/sensor_frame.py``); None for that which the file states."""
    field: Field | None = None
    """The field of an interlaced frame that is searched; None for all of its rows."""
    circle: ImageCircle | None = None
    """The part of the image that the lens lights; None where it fills all of it."""
    enabled: bool = True
    """True if the user wants the view in the calibration."""

    def __post_init__(self) -> None:
        freeze(self, "roi")

    @property
    def name(self) -> str:
        """Name of the image without its folder."""
        return PurePath(self.image).name

    @property
    def usable(self) -> bool:
        """True if the view takes part in a calibration: its board is found, with corners that tell
        a pose, and it is enabled."""
        return self.enabled and self.status is ViewStatus.FOUND and not self._lacks_pose

    @property
    def why_unused(self) -> str:
        """The reason why an enabled image takes no part in a calibration, and the remedy;
        empty if it does."""
        if self.reason or not self._lacks_pose:
            return self.reason
        return _TOO_FEW_CORNERS

    @property
    def _lacks_pose(self) -> bool:
        return self.corners is not None and not self.corners.determine_pose

    def refuse(self, status: ViewStatus, reason: str) -> View:
        """Return the view without corners, with the reason why there are none."""
        return replace(self, status=status, reason=reason, corners=None)

    def observation(self, board: Board | None) -> Observation:
        """Return the corners with their points on `board`, as a calibration takes them.

        Raises:
            ValueError: if the view has no corners, or corners found on a board that is not given.
        """
        if self.points is not None:
            return self.points
        if self.corners is None or board is None:
            raise ValueError(f"{self.image} has no corners on a known board")
        return Observation(self.corners.uv, board.points(self.corners.grid), self.corners.cov)


def find_orientation(views: Iterable[View]) -> int | None:
    """Return the EXIF orientation by which most views with a board are turned; None if unknown."""
    found = Counter(view.orientation for view in views if view.status is ViewStatus.FOUND)
    found.pop(None, None)
    return max(found, key=found.__getitem__, default=None)

"""A calibration together with the views that it was made from: what is saved and exported."""

from __future__ import annotations

import platform
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import scipy

import calibgui
from calibgui.dataset.view import View
from calibgui.engine import opencv
from calibgui.engine.boards import AprilGrid, Board
from calibgui.engine.calibration import Calibration, Observation
from calibgui.engine.geometry import PaperPose, paper_from_pose


def list_installed_versions() -> dict[str, str]:
    """Return the versions of this program and of the libraries that its numbers depend on."""
    return {
        "calibgui": calibgui.__version__,
        "numpy": np.__version__,
        "scipy": scipy.__version__,
        "opencv": opencv.VERSION,
        "python": platform.python_version(),
    }


@dataclass(frozen=True, eq=False, slots=True)
class Result:
    """A calibration with the views that it was made from, used or not."""

    calibration: Calibration
    views: tuple[View, ...]
    """All photographs; the calibration's k-th pose belongs to the k-th usable one."""
    board: Board | None = None
    """The board of known layout; None where the corners came with their board points."""
    versions: Mapping[str, str] = field(default_factory=list_installed_versions)
    """Versions of the programs that made the calibration, by name."""
    lengths_confirmed: bool = True
    """False if nobody has stated the side of a square: all lengths then hold if it is that."""
    places: tuple[int, ...] = field(init=False, repr=False)
    """Indices in `views` of those that take part, in the order of the calibration's poses."""

    def __post_init__(self) -> None:
        places = tuple(k for k, view in enumerate(self.views) if view.usable)
        object.__setattr__(self, "places", places)
        if len(self.used) != len(self.calibration.poses):
            raise ValueError(
                f"{len(self.calibration.poses)} poses do not answer {len(self.used)} usable views"
            )

    @property
    def used(self) -> tuple[View, ...]:
        """Views that take part, in the order of the calibration's poses."""
        return tuple(self.views[k] for k in self.places)

    def observations(self) -> list[Observation]:
        """Return the corners of the used views, with their points on the board."""
        return [view.observation(self.board) for view in self.used]

    @property
    def condition(self) -> str:
        """Condition under which all lengths hold, as "if squares are 30 mm"; empty if they do."""
        if self.lengths_confirmed or self.board is None:
            return ""
        length = f"{self.board.square:g} mm"
        if not self.board.pattern.has_squares:
            return f"if circles are {length} apart"
        parts = "tags" if isinstance(self.board.pattern, AprilGrid) else "squares"
        return f"if {parts} are {length}"

    def paper_poses(self) -> tuple[PaperPose, ...]:
        """Return the paper's external parameters of the used views.

        They are measured from the centre of the corners, at the distance L + f from which
        the reference image has its scale (eq. 30).
        """
        corners = np.concatenate([xy for _, xy, _ in self.observations()])
        centre = (corners.min(axis=0) + corners.max(axis=0)) / 2
        distance = float(self.calibration.camera.focal[0]) / self.calibration.reference_scale
        return tuple(paper_from_pose(pose, centre, distance) for pose in self.calibration.poses)

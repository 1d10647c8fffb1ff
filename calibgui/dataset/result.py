"""A calibration together with the views that it was made from: what is saved and exported."""

from __future__ import annotations

import platform
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import scipy

from calibgui.dataset.corner_set import describe_lengths
from calibgui.dataset.hardware import UNKNOWN_HARDWARE, Hardware, read_hardware
from calibgui.dataset.limits import Limits
from calibgui.dataset.stereo_rectification import StereoRectification
from calibgui.dataset.view import View
from calibgui.engine import opencv
from calibgui.engine.arrays import Array
from calibgui.engine.boards import Board
from calibgui.engine.calibration import Calibration, Observation, compute_scale_covariance
from calibgui.engine.camera import SensorMode
from calibgui.engine.geometry import PaperPose, paper_from_pose
from calibgui.version import __version__


def list_installed_versions() -> dict[str, str]:
    """Return the versions of this program and of the libraries that its numbers depend on."""
    return {
        "calibgui": __version__,
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
    conversion: str = ""
    """Note on how a camera without corners was converted; empty for calibrations."""
    region: Array | None = None
    """(n, 2) outline, px, of where the image of such a camera is known."""
    rectification: StereoRectification | None = None
    """The rectification that the camera's file holds beside such a camera."""
    mode: SensorMode | None = None
    """The stream that the file is for, from the images of the calibration, in whose pixels all else
    is; None if it is for these."""
    hardware: Hardware = UNKNOWN_HARDWARE
    """The camera and the lens as far as somebody stated them; not what photographs state."""
    improvements: tuple[str, ...] = ()
    """Sentences on what was done to make the camera better than the first that was found."""
    limits: Limits | None = None
    """What is demanded of the calibration; None if nothing is."""
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

    def find_hardware(self) -> Hardware:
        """Return the camera and the lens, as stated or else as the photographs state them."""
        return self.hardware.over(read_hardware(view.image for view in self.used))

    @property
    def scale_sigma(self) -> float:
        """Standard deviation of the board's scale, by which every length is in error, relative."""
        return 0.0 if self.board is None else self.board.scale_sigma

    @property
    def pose_covariances(self) -> Array:
        """(K, 6, 6) covariances of (rvec, tvec), rad and mm, the error of the board's scale
        included."""
        by_scale = [
            compute_scale_covariance(pose, self.scale_sigma) for pose in self.calibration.poses
        ]
        return self.calibration.pose_covariances + np.reshape(by_scale, (-1, 6, 6))

    @property
    def condition(self) -> str:
        """Condition under which all lengths hold, as "if squares are 30 mm"; empty if they do."""
        return "" if self.lengths_confirmed else describe_lengths(self.board)

    def paper_poses(self) -> tuple[PaperPose, ...]:
        """Return the paper's external parameters of the used views.

        They are measured from the centre of the corners, at the distance L + f from which
        the reference image has its scale (eq. 30).
        """
        corners = np.concatenate([xy for _, xy, _ in self.observations()])
        centre = (corners.min(axis=0) + corners.max(axis=0)) / 2
        distance = float(self.calibration.camera.focal[0]) / self.calibration.reference_scale
        return tuple(paper_from_pose(pose, centre, distance) for pose in self.calibration.poses)

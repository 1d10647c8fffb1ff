"""A rig together with the photographs that it was made from: what is saved and exported."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from calibgui.dataset.corner_set import describe_lengths
from calibgui.dataset.result import list_installed_versions
from calibgui.engine.boards import Board
from calibgui.engine.calibration import Observation
from calibgui.engine.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import Pose, rotation_from_vector, vector_from_rotation
from calibgui.engine.rig import Rig


@dataclass(frozen=True, eq=False, slots=True)
class RigResult:
    """A rig with the views that it was made from."""

    rig: Rig
    instants: Mapping[int, str]
    """Names of the instants by their numbers."""
    images: Mapping[tuple[int, int], str]
    """Paths of the photographs, by the numbers of camera and instant."""
    observations: Mapping[tuple[int, int, int], Observation]
    """Corners in these photographs as they were counted there, by the numbers of camera, board and
    instant."""
    boards: tuple[Board, ...] = ()
    """The boards of known layout; none where the corners came with their board points."""
    lengths_confirmed: bool = True
    """False if nobody has stated the side of a square: all lengths then hold if it is that."""
    remarks: tuple[str, ...] = ()
    """Sentences on how the rig was made that the user should know."""
    versions: Mapping[str, str] = field(default_factory=list_installed_versions)
    """Versions of the programs that made the rig, by name."""

    @property
    def condition(self) -> str:
        """Condition under which all lengths hold, as "if squares are 30 mm"; empty if they do."""
        return (
            ""
            if self.lengths_confirmed
            else describe_lengths(self.boards[0] if self.boards else None)
        )

    def find_camera(self, name: str) -> int:
        """Return the number of a camera.

        Raises:
            CalibrationError: if the rig has none of that name.
        """
        if name not in self.rig.names:
            raise CalibrationError(
                f"The rig has no camera {name!r}.", f"Choose from {', '.join(self.rig.names)}."
            )
        return self.rig.names.index(name)


def relate_cameras(rig: Rig, first: int, second: int) -> tuple[tuple[Camera, Camera], Pose]:
    """Return two cameras of a rig, and the pose second_from_first."""
    a, b = rig.poses[first], rig.poses[second]
    R = rotation_from_vector(b.rvec) @ rotation_from_vector(a.rvec).T
    pose = Pose(vector_from_rotation(R), b.tvec - R @ a.tvec)
    return (rig.cameras[first], rig.cameras[second]), pose

"""The pose of a board in front of a camera."""

from __future__ import annotations

from dataclasses import dataclass

from calibgui.engine.arrays import Array, freeze


@dataclass(frozen=True, eq=False, slots=True)
class Pose:
    """A rigid motion cam_from_board: X_cam = R X_board + tvec, with R = exp(rvec)."""

    rvec: Array
    """(3,) rotation vector, rad."""
    tvec: Array
    """(3,) translation, mm."""

    def __post_init__(self) -> None:
        freeze(self, "rvec", "tvec")
        if not self.rvec.shape == self.tvec.shape == (3,):
            raise ValueError(
                f"rvec and tvec must be of shape (3,), not {self.rvec.shape} and {self.tvec.shape}"
            )

"""A camera that is known before any photograph is taken, from whatever file it was read."""

from __future__ import annotations

from dataclasses import dataclass

from calibgui.engine.arrays import Array, freeze
from calibgui.engine.camera import Camera


@dataclass(frozen=True, eq=False, slots=True)
class KnownCamera:
    """A camera that is held as its file states it."""

    camera: Camera
    file: str
    """Name of its file, without the folder."""
    title: str
    """Title of the file's format."""
    covariance: Array | None = None
    """(P, P) covariance of the camera's parameters; None if the file does not state it."""

    def __post_init__(self) -> None:
        freeze(self, "covariance")

"""The photographs of a rig, each a camera at an instant, before anything is searched in them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True, slots=True)
class CameraPhotographs:
    """The photographs of one camera of a rig."""

    name: str
    """Name of the camera, which no other of the rig has."""
    files: Mapping[int, Path]
    """Its photographs by the number of the instant."""
    times: Mapping[Path, float] = field(default_factory=dict)
    """When they were taken by the camera's clock, s, as far as it is known."""


@dataclass(frozen=True, slots=True)
class RigPairing:
    """The photographs that were taken at the same instants."""

    cameras: tuple[CameraPhotographs, ...]
    """The cameras; the first one's frame will be the rig's."""
    instants: Mapping[int, str]
    """What the names of the photographs of each instant have in common, by its number."""
    how: str
    """What they were paired by, as "names"."""

    @property
    def shared(self) -> tuple[int, ...]:
        """Instants of which at least two cameras have a photograph."""
        counts = Counter(instant for camera in self.cameras for instant in camera.files)
        return tuple(instant for instant in self.instants if counts[instant] > 1)

    @property
    def left_over(self) -> tuple[Path, ...]:
        """Photographs of instants that no other camera has one of."""
        shared = set(self.shared)
        return tuple(
            file
            for camera in self.cameras
            for instant, file in camera.files.items()
            if instant not in shared
        )

"""The description of a file format that results can be written in, and of a written file."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from calibgui.dataset import Result
from calibgui.engine.camera import Camera, SplinedStereographic, find_model

FRAME = "Pixels count from 0 at the centre of the first pixel, u right, v down."
"""The sentence with which a file in the array frame states its convention."""

SPLINED = "splined-stereographic"
"""The id that stands for the splined models of any size in `Exporter.models`."""


def describe_condition(result: Result) -> str:
    """Describe in a sentence what all lengths of a result rest on; empty if nobody need be told."""
    return f"Lengths hold {result.condition}." if result.condition else ""


@dataclass(frozen=True, slots=True)
class ExportReport:
    """A file that was written."""

    path: Path
    note: str
    """One or two sentences that the user should know about the file."""
    largest_error_px: float | None = None
    """Largest distance between the exported camera and the calibrated one over the whole image,
    px; NaN if the exported one is not defined everywhere; None if nothing was refitted."""


@dataclass(frozen=True, slots=True)
class Exporter:
    """A file format that results can be written in."""

    name: str
    """Name of the format on the command line."""
    title: str
    """Name of the format in a menu."""
    suffixes: tuple[str, ...]
    """Suffixes of its files, the usual one first."""
    models: tuple[str, ...]
    """Names of the lens models that it holds as calibrated."""
    readers: str
    """The programs that read its files."""
    keeps: str
    """What it holds of a calibration, as a clause; a camera in another lens model than those named
    here is refitted."""
    loses: str
    """What it does not hold, as a clause."""
    write: Callable[[Result, Path], ExportReport]
    """Function that writes a file; it raises CalibrationError if it cannot."""
    stem: str = ""
    """Name without suffix that its readers look for; empty if any will do."""
    refits: tuple[str, ...] = ()
    """Names of the models in which cameras of other models are refitted, the simplest first; a
    camera that none of them follows is not written. Empty if nothing is ever refitted."""
    zeros: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Names of the coefficients that it does not have, of some of its models: they must be 0."""
    holds_rectification: bool = False
    """True if the format holds the rectification of a stereo pair."""
    holds_skew: bool = False
    """True if the format holds the skew of those models that have one."""
    partial: bool = False
    """True if the format states what was assumed of a camera, or holds no camera."""
    needs_corners: bool = False
    """True if a camera without the corners that it was calibrated from cannot be written."""
    fits_rays: bool = False
    """True if the format has a lens model of its own, which `write` fits to any camera's rays."""
    write_zoom: Callable[[Sequence[tuple[float, Camera]], Path], ExportReport] | None = None
    """Function that writes one file of a zoom lens from its focal lengths, mm, and cameras, or None
    if the format holds one camera; it raises CalibrationError if it cannot."""

    @property
    def file_name(self) -> str:
        """Name of a file unless the user chooses another."""
        return f"{self.stem or 'camera'}{self.suffixes[0]}"

    def holds(self, camera: Camera) -> bool:
        """Return whether `write` takes the camera as calibrated."""
        named = dict(zip(camera.names, camera.params.tolist(), strict=True))
        if named.get("skew", 0.0) != 0 and not (self.holds_skew or self.fits_rays):
            return False
        if any(named[name] != 0 for name in self.zeros.get(camera.model, ())):
            return False
        return self.holds_model(camera.model)

    def holds_model(self, model: str) -> bool:
        """Return whether `write` takes cameras of a lens model as calibrated."""
        splined = isinstance(find_model(model), SplinedStereographic)
        return self.fits_rays or model in self.models or (splined and SPLINED in self.models)

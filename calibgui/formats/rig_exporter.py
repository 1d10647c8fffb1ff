"""The description of a file format that rigs can be written in, and cameras in its lens models."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from calibgui.dataset import RigResult
from calibgui.engine.camera import Camera, find_model
from calibgui.formats.camera_conversion import convert_alike, convert_within_limit
from calibgui.formats.exporter import Exporter
from calibgui.formats.opencv_lens import FISHEYE


@dataclass(frozen=True, slots=True)
class RigExporter:
    """A file format that rigs can be written in."""

    name: str
    """Name of the format on the command line."""
    title: str
    """The words for what the format is, as in a menu."""
    suffixes: tuple[str, ...]
    """Suffixes of its files, the usual one first."""
    readers: str
    """The programs that read its files."""
    keeps: str
    """The clause that says what the format keeps of a rig."""
    write: Callable[[RigResult, Path, tuple[int, int]], str]
    """Function from a rig, a path and two cameras that writes the files and returns a sentence."""
    list_files: Callable[[RigResult, Path, tuple[int, int]], list[Path]] = (
        lambda _result, path, _pair: [path]
    )
    """Function that lists the files that will be written."""


def name_file(path: Path, camera: str) -> Path:
    """Return the path of one camera's file of several, as rig-left.yaml."""
    name = "".join(c if c.isalnum() else "_" for c in camera)
    return path.with_name(f"{path.stem}-{name}{path.suffix}")


def express_cameras(
    cameras: Sequence[Camera], exporter: Exporter, path: Path, of_one_family: bool = False
) -> tuple[list[Camera], str]:
    """Express cameras in lens models that a format holds.

    Args:
        cameras: the cameras.
        exporter: the format of one camera.
        path: the file that is to be written, for messages.
        of_one_family: True if all must be perspective, or all fisheye.

    Returns:
        The cameras, and a sentence on them.

    Raises:
        CalibrationError: if no lens model of the format follows a camera.
    """
    is_fisheye = {camera.model == FISHEYE for camera in cameras}
    if all(map(exporter.holds, cameras)) and not (of_one_family and len(is_fisheye) > 1):
        models = ", ".join(dict.fromkeys(find_model(camera.model).title for camera in cameras))
        return list(cameras), f"Lens model {models}, as calibrated."
    if of_one_family:
        conversions = convert_alike(cameras, exporter, path)
        if len({each.camera.model == FISHEYE for each in conversions}) > 1:
            conversions = [convert_within_limit(camera, FISHEYE) for camera in cameras]
    else:
        conversions = [convert_alike([camera], exporter, path)[0] for camera in cameras]
    models = ", ".join(dict.fromkeys(find_model(c.camera.model).title for c in conversions))
    worst = max(each.largest_error for each in conversions)
    note = (
        f"Lens model {models}, converted; differs by at most {worst:.3g} px over the whole image."
    )
    return [each.camera for each in conversions], note

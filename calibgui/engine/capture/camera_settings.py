"""Settings of a camera at this computer: the size of its images, its exposure and its focus."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from calibgui.engine.arrays import Size
from calibgui.engine.opencv import Stream

AUTOFOCUS_WARNING = "Autofocus is on, which changes the lens: set a focus."


@dataclass(frozen=True, slots=True)
class CameraSettings:
    """Settings that are wanted of a camera; what is None stays as the camera has it."""

    size: Size | None = None
    """Width and height of its images, px."""
    exposure: float | None = None
    """Exposure in the camera's own unit, which ends its automatic exposure."""
    focus: float | None = None
    """Focus in the camera's own unit, which ends its autofocus."""


def adjust_camera(stream: Stream, wanted: CameraSettings) -> str:
    """Set a camera as it is wanted, and say how it is then, and what it does not take."""
    if wanted.size is not None:
        stream.set_size(wanted.size)
    if wanted.exposure is not None:
        stream.set_exposure(wanted.exposure)
    if wanted.focus is not None:
        stream.set_focus(wanted.focus)
    return " ".join(_describe_camera(stream, wanted))


def _describe_camera(stream: Stream, wanted: CameraSettings) -> Iterator[str]:
    width, height = stream.size
    has = [f"{width} x {height} px"]
    has += [f"exposure {stream.exposure:g}"] if stream.exposure is not None else []
    has += [f"focus {stream.focus:g}"] if stream.focus is not None else []
    yield f"The camera has {', '.join(has)}."
    refused = []
    if wanted.size is not None and wanted.size != stream.size:
        refused.append(f"{wanted.size[0]} x {wanted.size[1]} px")
    if wanted.exposure is not None and wanted.exposure != stream.exposure:
        refused.append(f"exposure {wanted.exposure:g}")
    if wanted.focus is not None and wanted.focus != stream.focus:
        refused.append(f"focus {wanted.focus:g}")
    if refused:
        yield f"It does not take {', '.join(refused)}."
    if stream.has_autofocus_on:
        yield AUTOFOCUS_WARNING

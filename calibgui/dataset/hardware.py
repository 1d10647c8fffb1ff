"""Some formats name the camera and the lens that took the photographs."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields
from pathlib import Path

from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import read_image_header

LENS_TYPES = ("rectilinear", "fisheye")


@dataclass(frozen=True, slots=True)
class Hardware:
    """A camera and its lens; None for what is not known."""

    maker: str | None = None
    """Maker of the camera."""
    model: str | None = None
    """Model of the camera."""
    lens: str | None = None
    """Model of the lens."""
    lens_maker: str | None = None
    """Maker of the lens."""
    mount: str | None = None
    """The lens mount, as lensfun names it."""
    crop: float | None = None
    """Diagonal of a sensor of 36 mm x 24 mm over that of the camera's."""
    type: str | None = None
    """One of `LENS_TYPES`."""

    def over(self, other: Hardware) -> Hardware:
        """Return this one, with what is not known of it as it is in the other."""
        known = {field.name: getattr(self, field.name) for field in fields(self)}
        return Hardware(
            **{
                name: getattr(other, name) if value is None else value
                for name, value in known.items()
            }
        )


UNKNOWN_HARDWARE = Hardware()


def read_hardware(images: Iterable[str]) -> Hardware:
    """Return what the first of the photographs that can be read states in EXIF."""
    for image in images:
        if not Path(image).is_file():
            continue
        try:
            exif = read_image_header(image).exif
        except CalibrationError:
            continue
        focal, equivalent = exif.focal_length_mm, exif.equivalent_focal_length_mm
        return Hardware(
            maker=exif.make,
            model=exif.model,
            lens=exif.lens,
            lens_maker=exif.lens_maker,
            crop=equivalent / focal if focal and equivalent else None,
        )
    return Hardware()

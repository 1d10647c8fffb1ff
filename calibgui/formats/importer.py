"""The description of a file format that cameras can be read from, and what its readers share.

A camera of another program becomes a `Camera` of this one without any fit: every format that is
read has a lens model of ours with the same formula, and a camera whose formula we do not have is
refused. Pixels become those of the array frame, 0 at the centre of the first pixel.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import NoReturn, TypeVar

import numpy as np

from calibgui.dataset import StereoRectification
from calibgui.engine.arrays import Array, Size
from calibgui.engine.camera import (
    Camera,
    SensorMode,
    check_image_size,
    find_model,
    list_parameter_names,
)
from calibgui.engine.errors import CalibrationError

_Entry = TypeVar("_Entry")

_CORRECT = "Correct the file or write it again."
_MAX_NAME = 100
"""Length of the longest name from a file that a message repeats, characters."""


@dataclass(frozen=True, eq=False, slots=True)
class ImportedCamera:
    """A camera that was read from a file."""

    camera: Camera
    title: str
    """Title of the file's format."""
    covariance: Array | None = None
    """(P, P) covariance of the camera's parameters; None if the file has none."""
    notes: tuple[str, ...] = ()
    """Sentences that the user should know about what was read."""
    rectification: StereoRectification | None = None
    """The rectification of a stereo pair that the file holds; None if it holds none, or that of one
    camera."""
    mode: SensorMode | None = None
    """How the camera's images are made from those that it was calibrated with; None if they are
    these."""
    orientation: int | None = None
    """EXIF orientation by which its photographs are turned; None if the file does not state it."""


@dataclass(frozen=True, slots=True)
class CameraText:
    """The text of a file that holds cameras, and what the user said about it."""

    text: str
    file: str
    """Name of the file, for messages."""
    wanted: str | None = None
    """Name of the camera to read; None for the only one."""
    size: Size | None = None
    """Width and height of the images as stated by the user, px."""

    def fail(self, fault: str, hint: str = _CORRECT) -> NoReturn:
        """Raise a CalibrationError that names the file, its fault and the remedy."""
        raise CalibrationError(f"{self.file} {fault}", hint)

    def refuse_model(self, name: str, readable: Sequence[str], reason: str = "") -> NoReturn:
        """Raise a CalibrationError about a lens model of the format that is not one of ours."""
        self.fail(
            f"has the lens model {name[:_MAX_NAME]}, which cannot be read"
            f"{reason and f': {reason}'}.",
            f"These can be read: {', '.join(readable)}.",
        )

    def choose_camera(self, cameras: Mapping[str, _Entry]) -> tuple[str, _Entry]:
        """Return the name and the content of the wanted camera, or of the only one.

        Raises:
            CalibrationError: if there is none of this name, or there are several and none is
                named, with the list of cameras.
        """
        listed = ", ".join(cameras)
        if not cameras:
            self.fail("holds no camera.")
        if self.wanted is None:
            if len(cameras) > 1:
                self.fail(f"holds {len(cameras)} cameras: {listed}.", "Say which one to read.")
            return next(iter(cameras.items()))
        if self.wanted not in cameras:
            self.fail(f"holds no camera {self.wanted!r}.", f"It holds {listed}.")
        return self.wanted, cameras[self.wanted]

    def choose_size(self, stated: Sequence[float] | None) -> Size:
        """Return the images' width and height, px, by the file (`stated`) or else by the user.

        Raises:
            CalibrationError: if neither says it, both do and disagree, or it is none of an image.
        """
        if stated is None:
            if self.size is None:
                self.fail(
                    "does not say how large its images are.", "State their width and height in px."
                )
            return self.size
        with self._naming_file():
            width, height = check_image_size(stated)
        if self.size is not None and self.size != (width, height):
            self.fail(
                f"is for images of {width} x {height} px, not {self.size[0]} x {self.size[1]} px.",
                "Leave the size out, or choose the file of these images; for the camera of another "
                "size of images, convert it with --to-size.",
            )
        return width, height

    def list_parameters(self, model: str) -> tuple[str, ...]:
        """Return the names of the parameters of our model of an id.

        Raises:
            CalibrationError: if there is no such model: there are limits to splined ones.
        """
        with self._naming_file():
            return list_parameter_names(model)

    def make_camera(self, size: Size, model: str, values: Mapping[str, float]) -> Camera:
        """Return a camera from its parameters by name.

        Args:
            size: width and height of its images, px.
            model: a lens model's id.
            values: fx, fy, cx, cy in px of the array frame, and coefficients of the model; those
                that are left out have the model's defaults.

        Raises:
            CalibrationError: if the values do not make a camera.
        """
        names = self.list_parameters(model)
        known = dict(zip(names[4:], find_model(model).defaults, strict=True)) | dict(values)
        with self._naming_file():
            return Camera(size, np.array([known[name] for name in names]), model)

    @contextmanager
    def _naming_file(self) -> Iterator[None]:
        """Name the file in the messages of errors that its values raise."""
        try:
            yield
        except CalibrationError as error:
            raise CalibrationError(f"{self.file}: {error.message}", error.hint) from error


@dataclass(frozen=True, slots=True)
class Importer:
    """A file format that cameras can be read from."""

    title: str
    """Name of the format in messages and menus."""
    signature: re.Pattern[str]
    """A pattern that is found in files of this format, and not in those of the formats that are
    asked after it."""
    read: Callable[[CameraText], ImportedCamera]
    """Function that reads a camera; it raises CalibrationError if it cannot."""
    several: bool = False
    """True if files of the format name their cameras."""

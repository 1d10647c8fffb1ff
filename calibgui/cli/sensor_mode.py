"""The options on sensor modes: how the images at hand were made from those of the calibration."""

from __future__ import annotations

import argparse
import re
from dataclasses import replace

from calibgui.app.photographs.image_mode import guess_mode
from calibgui.cli.arguments import parse_positive
from calibgui.cli.camera import parse_size
from calibgui.cli.console import Console
from calibgui.engine.arrays import Size
from calibgui.engine.camera import SensorMode, describe_mode
from calibgui.engine.errors import CalibrationError
from calibgui.formats import ImportedCamera

_OPTIONS = ("crop", "binning", "scale", "squeeze", "to_size", "flip")
_FLIPS = {"horizontal": (True, False), "vertical": (False, True), "both": (True, True)}


def add_mode_options(parser: argparse.ArgumentParser, images: str) -> None:
    """Add the options; `images` names in the help what they are about."""
    group = parser.add_argument_group(
        "sensor mode",
        f"How {images} were made from those that the camera was calibrated with, in this order. "
        "What is not stated is inferred from their size where that tells it.",
    )
    group.add_argument(
        "--crop",
        type=_parse_crop,
        metavar="X,Y,WxH",
        help="a part of the image: its first column and row, counted from 0, and its size, px",
    )
    group.add_argument(
        "--binning", type=_parse_count, metavar="N", help="N x N pixels made into one"
    )
    group.add_argument(
        "--scale", type=parse_positive, metavar="FACTOR", help="scaled, as 0.5 for half the size"
    )
    group.add_argument(
        "--squeeze",
        type=parse_size,
        metavar="WxH",
        help="the whole image in another size, px, also of another aspect",
    )
    group.add_argument(
        "--to-size",
        type=parse_size,
        metavar="WxH",
        help="their size, px: the whole image scaled, or its middle, where the numbers tell which",
    )
    group.add_argument(
        "--flip",
        choices=list(_FLIPS),
        help="mirrored left to right, top to bottom, or both, which is a turn by 180 degrees",
    )


def adapt_to_images(
    stored: ImportedCamera,
    options: argparse.Namespace | None,
    console: Console,
    size: Size | None = None,
) -> ImportedCamera:
    """Return the camera of the images at hand, and say in which mode it is taken.

    Args:
        stored: the camera as its file has it.
        options: those of `add_mode_options`; None for a command that has none.
        console: is told the mode.
        size: width and height of the images, px; None if there are none.

    Raises:
        CalibrationError: if the mode that is stated is impossible or leads to another size, or none
            is stated and no or more than one mode explains the size.
    """
    stated = argparse.Namespace(**dict.fromkeys(_OPTIONS)) if options is None else options
    mode = _find_mode(stored, stated, size)
    if mode.is_identity:
        return stored
    how = "" if is_mode_stated(stated) else "; options such as --crop state another mode"
    if options is None:
        how = "; convert makes the camera of another mode"
    console.print_problem(
        f"calibgui: images of {mode.size[0]} x {mode.size[1]} px count as {describe_mode(mode)}"
        f"{how}."
    )
    if mode.is_mirrored:
        console.print_problem(
            "calibgui: the images are mirrored, and so is the world in which rays and poses are."
        )
    whole = mode if stored.mode is None else stored.mode.then(mode)
    covariance = stored.covariance
    if covariance is not None:
        covariance = mode.adapt_covariance(covariance, stored.camera.model)
    return replace(
        stored,
        camera=mode.adapt_camera(stored.camera),
        covariance=covariance,
        rectification=stored.rectification and stored.rectification.adapt(mode),
        mode=None if whole.is_identity else whole,
    )


def _find_mode(
    stored: ImportedCamera, options: argparse.Namespace, size: Size | None = None
) -> SensorMode:
    """Return the mode from the camera's images to those at hand. Raises as `adapt_to_images`."""
    mode = SensorMode.identity(stored.camera.size)
    if stored.mode is not None and size == stored.mode.full and not is_mode_stated(options):
        return stored.mode.invert()
    if options.crop:
        left, top, part = options.crop
        mode = mode.crop(left, top, part)
    if options.binning:
        mode = mode.bin_pixels(options.binning)
    if options.scale:
        mode = mode.scale(options.scale)
    if options.squeeze:
        mode = mode.resize(options.squeeze)
    if options.to_size:
        mode = mode.then(guess_mode(mode.size, options.to_size))
    if size not in (None, mode.size):
        mode = _reach_size(mode, size, options)
    return mode.flip(*_FLIPS[options.flip]) if options.flip else mode


def _reach_size(mode: SensorMode, size: Size, options: argparse.Namespace) -> SensorMode:
    """Return the mode continued to the size of the images; with a scale that is stated, theirs is
    at most rounded otherwise."""
    if not (options.binning or options.scale or options.squeeze or options.to_size):
        return mode.then(guess_mode(mode.size, size))
    if max(abs(a - b) for a, b in zip(mode.size, size, strict=True)) <= 1:
        return SensorMode(mode.full, size, mode.factor, mode.offset)
    raise CalibrationError(
        f"The mode that is stated leads to images of {mode.size[0]} x {mode.size[1]} px, and "
        f"these have {size[0]} x {size[1]} px.",
        "State how these images were made, or leave it to their size.",
    )


def is_mode_stated(options: argparse.Namespace) -> bool:
    """Return whether one of the options of `add_mode_options` is given."""
    return any(getattr(options, name) for name in _OPTIONS)


def _parse_crop(text: str) -> tuple[int, int, Size]:
    """Read a part of an image such as "0,60,640x360"."""
    match = re.fullmatch(r"(\d{1,6}),(\d{1,6}),(\d{1,6}[x×]\d{1,6})", text.strip())
    if match is None:
        raise argparse.ArgumentTypeError(f"{text!r} is not X,Y,WxH, as 0,60,640x360")
    return int(match[1]), int(match[2]), parse_size(match[3])


def _parse_count(text: str) -> int:
    """Read a number of pixels from 1 on."""
    if not re.fullmatch(r"[1-9]\d{0,3}", text.strip()):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of pixels, as 2")
    return int(text)

"""The mode by which a camera's images became those of another size is told by the numbers alone.

Images of the same aspect count as the whole sensor, scaled; images as wide or as high as the
camera's as their middle. What else is smaller in both directions may be the middle at the camera's
scale or the largest middle part of that aspect, scaled: nobody but the user knows. What is larger
can only be the latter, unless that would be less than half of the image.
"""

from __future__ import annotations

from calibgui.engine.arrays import Size
from calibgui.engine.camera import SensorMode
from calibgui.engine.errors import CalibrationError

_MIN_SHARE = 0.5
"""Share of the image, at least, that a stream of another aspect shows: from 4:3 to 16:9 it is 0.75,
from 16:9 to a square 0.56."""


def guess_mode(full: Size, size: Size) -> SensorMode:
    """Guess the mode of images of a size.

    Args:
        full: width and height of the images that the camera is for, px.
        size: those of the images that are given.

    Raises:
        CalibrationError: if no mode explains the size, or two do; with the options that state them.
    """
    whole = SensorMode.identity(full)
    (W, H), (w, h) = full, size
    if size == full:
        return whole
    if not (w == W or h == H) and abs(w / W - h / H) <= 1 / W + 1 / H:  # but for whole pixels
        return whole.resize(size)
    stated = f"Images of {w} x {h} px, and a camera of {W} x {H} px"
    is_turned = w != h and W != H and (w > h) != (W > H)
    cropped = _crop_middle(whole, size) if w <= W and h <= H else None
    part = _find_largest_part(full, size)
    is_scaled = w != W and h != H and part[0] * part[1] >= _MIN_SHARE * W * H
    scaled = _crop_middle(whole, part).resize(size) if is_scaled else None
    if is_turned or (cropped is None and scaled is None):
        raise CalibrationError(
            f"{stated}: no crop of the middle and no scale makes the one of the other"
            f"{', unless they were turned by a quarter' if size == (H, W) else ''}.",
            "Name the camera of these images, or state their mode: --crop X,Y,WxH, --binning N, "
            "--scale FACTOR.",
        )
    if cropped is not None and scaled is not None:
        raise CalibrationError(
            f"{stated}: they may be its middle, or be scaled as well.",
            f"Say which: {_write_crop(full, size)} is the middle at the camera's own scale, and "
            f"{_write_crop(full, part)} --to-size {w}x{h} the largest part of this aspect, scaled.",
        )
    found = cropped or scaled
    assert found is not None
    return found


def _crop_middle(whole: SensorMode, size: Size) -> SensorMode:
    return whole.crop(*_find_corner(whole.full, size), size)


def _find_corner(full: Size, size: Size) -> tuple[int, int]:
    """Return the first column and row of the middle part of a size."""
    return (full[0] - size[0]) // 2, (full[1] - size[1]) // 2


def _find_largest_part(full: Size, size: Size) -> Size:
    """Return the size of the largest part of the image with the aspect of `size`."""
    scale = min(full[0] / size[0], full[1] / size[1])
    return round(scale * size[0]), round(scale * size[1])


def _write_crop(full: Size, size: Size) -> str:
    """Return the option that states the middle part of a size."""
    left, top = _find_corner(full, size)
    return f"--crop {left},{top},{size[0]}x{size[1]}"

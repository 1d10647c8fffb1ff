"""Arrays and sizes."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from calibgui.engine.errors import CalibrationError

Array = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
Int32Array = npt.NDArray[np.int32]
BoolArray = npt.NDArray[np.bool_]

Size = tuple[int, int]
"""Width and height of an image, pixels."""

Board = tuple[int, int]
"""Rows and columns of a target's points: inner corners of a checkerboard, circles of a grid."""


def frozen(values: npt.ArrayLike) -> Array:
    """A read-only float64 copy of `values`."""
    array = np.array(values, dtype=np.float64, order="C")
    array.flags.writeable = False
    return array


def frozen_int(values: npt.ArrayLike) -> IntArray:
    """A read-only int64 copy of `values`."""
    array = np.array(values, dtype=np.int64, order="C")
    array.flags.writeable = False
    return array


def freeze(record: object, *names: str) -> None:
    """Make the named arrays of a frozen dataclass read-only float64 copies; None stays.

    To be called where the record is made, in ``__post_init__``.
    """
    for name in names:
        if (values := getattr(record, name)) is not None:
            object.__setattr__(record, name, frozen(values))


def image_size(size: Size) -> Size:
    """Width and height of an image as whole numbers.

    Raises:
        CalibrationError: if they are no size.
    """
    width, height = (int(length) for length in size)
    if min(width, height) < 1:
        raise CalibrationError(
            f"There is no image of {width} x {height} pixels.", "Give its width and height."
        )
    return width, height

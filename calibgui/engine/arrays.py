"""Arrays and sizes.

The one place that imports OpenCV: its shapes and names differ between 4.x and 5.x.

Points come back as (n, 2) float64 whatever the version.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
Int32Array = npt.NDArray[np.int32]
BoolArray = npt.NDArray[np.bool_]

Size = tuple[int, int]
"""Width and height of an image, pixels."""

GridSize = tuple[int, int]
"""Rows and columns of a target's points: inner corners of a checkerboard, circles of a grid."""


def freeze_array(values: npt.ArrayLike) -> Array:
    """A read-only float64 copy of `values`."""
    array = np.array(values, dtype=np.float64, order="C")
    array.flags.writeable = False
    return array


def freeze_ints(values: npt.ArrayLike) -> IntArray:
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
            object.__setattr__(record, name, freeze_array(values))


GreyImage = npt.NDArray[Any]
FloatImage = npt.NDArray[np.float32]

"""A preview shows an undistorted or rectified image beside the image that it is made from."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import cast

import numpy as np
import numpy.typing as npt

from calibgui.app.outputs.resampling import Undistortion
from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.geometry import rotation_from_vector
from calibgui.engine.images import (
    Image,
    describe_hidden_angles,
    make_ideal_image,
    rectify_image,
)
from calibgui.report.coverage import find_shown_extent, measure_natural_scale

Grey = npt.NDArray[np.uint8]

_PLACES = {
    "top": (0, 1),
    "left": (1, 0),
    "front": (1, 1),
    "right": (1, 2),
    "back": (1, 3),
    "bottom": (2, 1),
}
"""Row and column of each face."""


def transform_image(
    result: Result, k: int, choice: Undistortion | None, read: Callable[[str], Image]
) -> tuple[Grey | None, Grey, str]:
    """Return the image of calibrated view k, what becomes of it, and which angle is lost.

    A rectified image stands alone, and loses what is not the board. The faces of a cube are
    unfolded into one picture.

    Raises:
        CalibrationError: if the image cannot be read, or not be changed so.
    """
    grey = read(result.used[k].image).grey
    camera = result.calibration.camera
    if choice is None:
        pose, extent = result.calibration.poses[k], find_shown_extent(result)
        rectified = rectify_image(grey, camera, pose, extent, measure_natural_scale(result))
        return None, cast(Grey, rectified.image), ""
    ideals = choice.choose_cameras(camera)
    made = {
        face: cast(Grey, make_ideal_image(grey, camera, ideal).image)
        for face, ideal in ideals.items()
    }
    after = made[""] if "" in made else unfold_cube(made)
    return _pad_to_aspect(grey, after), after, describe_hidden_angles(camera, ideals)


def _pad_to_aspect(image: Grey, other: Grey) -> Grey:
    """Return the image with black around it, its sides in the ratio of another's."""
    (height, width), (rows, columns) = image.shape, other.shape
    wide, high = (
        max(width, round(height * columns / rows)),
        max(height, round(width * rows / columns)),
    )
    left, top = (wide - width) // 2, (high - height) // 2
    return np.pad(image, ((top, high - height - top), (left, wide - width - left)))


def unfold_cube(faces: Mapping[str, Grey]) -> Grey:
    """Return the square faces of a cube as a cross, cut to those that there are, black between.

    Args:
        faces: (n, n) by their names, all of one size.
    """
    places = {name: _PLACES[name] for name in faces}
    first = np.min(list(places.values()), axis=0)
    rows, columns = np.max(list(places.values()), axis=0) + 1 - first
    side = len(next(iter(faces.values())))
    cross = np.zeros((rows * side, columns * side), np.uint8)
    for name, place in places.items():
        v, u = (place - first) * side
        cross[v : v + side, u : u + side] = faces[name]
    return cross


def undistort_alike(
    a: Result, b: Result, turn: Array, path: str, read: Callable[[str], Image]
) -> tuple[Grey, Grey]:
    """Undistort an image by the cameras of two results, so that both show the same directions.

    Args:
        a, b: results of one image size.
        turn: (3,) rotation vector b_from_a, rad, between the cameras' frames.
        path: the image.
        read: reads it.

    Raises:
        CalibrationError: if the image cannot be read, or has another size.
    """
    grey = read(path).grey
    (ideal,) = Undistortion().choose_cameras(a.calibration.camera).values()
    turned = replace(ideal, rotation=rotation_from_vector(turn) @ ideal.rotation)
    return (
        cast(Grey, make_ideal_image(grey, a.calibration.camera, ideal).image),
        cast(Grey, make_ideal_image(grey, b.calibration.camera, turned).image),
    )

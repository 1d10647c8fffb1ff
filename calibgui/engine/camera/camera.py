"""A camera: the size of its images, a lens model and the values of its parameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, BoolArray, Size, freeze
from calibgui.engine.camera.image_circle import ImageCircle
from calibgui.engine.camera.models import find_model, list_parameter_names, resolve_model_id
from calibgui.engine.errors import CalibrationError

_MAX_DIGITS = 12
"""Length of the longest number that a message repeats, characters."""
_MAX_SIDE_PX = 1_000_000
"""Largest side of an image, px; a longer one is an error of whoever stated it."""


def check_image_size(size: Sequence[float]) -> Size:
    """Return the width and height of an image as whole numbers.

    Raises:
        CalibrationError: if they are not two whole numbers of pixels, from 1 to a million.
    """
    sides = tuple(size)
    if len(sides) != 2 or not all(1 <= side <= _MAX_SIDE_PX and side % 1 == 0 for side in sides):
        stated = " x ".join(str(side)[:_MAX_DIGITS] for side in sides)
        raise CalibrationError(
            f"There is no image of {stated} pixels.", "Give its width and height."
        )
    return int(sides[0]), int(sides[1])


@dataclass(frozen=True, eq=False, slots=True)
class Camera:
    """Intrinsics in the array frame: a lens model's id and its parameters.

    The last parameters may be left out if the model holds them by default; they take the values at
    which it holds them.

    Raises:
        CalibrationError: if there is no such model, it has another number of parameters, a number
            is not finite, a focal length is not positive, or the size is below 1 px.

    Examples:
        >>> from calibgui.engine.camera import Camera
        >>> params = [600, 600, 320, 240, -0.25, 0.1, 0, 0, 0]
        >>> camera = Camera((640, 480), params, "brown-conrady")
        >>> dict(zip(camera.names, camera.params.tolist(), strict=True))["k1"]
        -0.25
        >>> camera.matrix
        array([[600.,   0., 320.],
               [  0., 600., 240.],
               [  0.,   0.,   1.]])
    """

    size: Size
    """Width and height of its images, px."""
    params: Array
    """(P,) fx, fy, cx, cy (px) and the model's dimensionless coefficients, in the order of
    `names`."""
    model: str = "lucchese"
    """The lens model, a key of ``camera.models.MODELS``; ids of earlier versions are replaced."""
    circle: ImageCircle | None = None
    """The part of the image that the lens lights; None where it fills all of it."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "size", check_image_size(self.size))
        object.__setattr__(self, "model", resolve_model_id(self.model))
        object.__setattr__(self, "params", _fill_held_coefficients(self.params, self.model))
        freeze(self, "params")
        if self.params.shape != (len(self.names),):
            raise CalibrationError(
                f"{self.params.size} numbers do not make a camera of the lens model "
                f"{self.model!r}.",
                f"Give {', '.join(self.names)}.",
            )
        if not (np.isfinite(self.params).all() and (self.params[:2] > 0).all()):
            raise CalibrationError(
                f"No camera has the parameters {self.params.tolist()}.",
                "Give finite numbers, and focal lengths above 0.",
            )

    def lights(self, uv: Array) -> BoolArray:
        """Return (...) whether the lens lights pixels (..., 2)."""
        if self.circle is None:
            return np.ones(uv.shape[:-1], dtype=bool)
        return self.circle.contains(uv)

    @property
    def names(self) -> tuple[str, ...]:
        """(P,) names of the parameters."""
        return list_parameter_names(self.model)

    @property
    def focal(self) -> Array:
        """(2,) fx, fy, px."""
        return self.params[0:2]

    @property
    def centre(self) -> Array:
        """(2,) cx, cy, px."""
        return self.params[2:4]

    @property
    def coefficients(self) -> Array:
        """The lens coefficients, dimensionless."""
        return self.params[4:]

    @property
    def matrix(self) -> Array:
        """(3, 3) the camera matrix K."""
        fx, fy, cx, cy = self.params[:4]
        return np.array([[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]])


def _fill_held_coefficients(params: npt.ArrayLike, model: str) -> Array:
    """Return the parameters, with defaults of held ones that were left out at the end."""
    given, lens = np.asarray(params, dtype=np.float64), find_model(model)
    left_out = list_parameter_names(model)[given.size :]
    if given.ndim != 1 or not left_out or not set(left_out) <= set(lens.held):
        return given
    return np.concatenate([given, lens.defaults[-len(left_out) :]])

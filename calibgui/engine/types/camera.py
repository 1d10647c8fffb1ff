"""A camera, and where it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibgui.engine.errors import CalibrationError
from calibgui.engine.lens import parameter_names
from calibgui.engine.types.arrays import Array, Size, freeze, image_size


@dataclass(frozen=True, eq=False, slots=True)
class Pose:
    """cam_from_plate: X_cam = R X_plate + tvec, with R = exp(rvec)."""

    rvec: Array
    """(3,) rotation vector, rad."""
    tvec: Array
    """(3,) translation, mm."""

    def __post_init__(self) -> None:
        freeze(self, "rvec", "tvec")
        if not self.rvec.shape == self.tvec.shape == (3,):
            raise ValueError(
                f"rvec and tvec must be of shape (3,), not {self.rvec.shape} and {self.tvec.shape}"
            )


@dataclass(frozen=True, eq=False, slots=True)
class Camera:
    """Intrinsics in the array frame: a lens model's name and its parameters.

    Raises:
        CalibrationError: if there is no such model, it has another number of parameters, a number
            is not finite, a focal length not positive, or the size none.
    """

    size: Size
    """Width and height of its images, px."""
    params: Array
    """(P,) fx, fy, cx, cy (px) and the model's dimensionless coefficients, in the order of
    `names`."""
    model: str = "lucchese"
    """A key of ``lens.MODELS``."""

    def __post_init__(self) -> None:
        freeze(self, "params")
        object.__setattr__(self, "size", image_size(self.size))
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

    @property
    def names(self) -> tuple[str, ...]:
        """(P,) names of the parameters."""
        return parameter_names(self.model)

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

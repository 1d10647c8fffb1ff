"""The contract of a lens model: two maps between measured and ideal points, with derivatives.

A real lens images a scene point where an ideal pinhole would not. A model either corrects the
measured point (the paper's does) or distorts the ideal one (OpenCV's does); every model offers
both directions, so that the rest of the engine need not know which is which.

Frames: `d` is a measured (distorted) and `n` an ideal (undistorted) image point, both
(..., 2) dimensionless: d = ((u - cx) / fx, (v - cy) / fy), and n = (X/Z, Y/Z) for a scene
point in the camera frame. `k` are the model's coefficients.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

from calibgui.engine.arrays import Array


class Mapped(NamedTuple):
    """Points after a lens map, with its derivatives."""

    points: Array
    """(..., 2)."""
    by_point: Array
    """(..., 2, 2) derivative with respect to the argument."""
    by_coefficients: Array
    """(..., 2, C) derivative with respect to k."""


class Lens(Protocol):
    """A lens model: two maps, inverse to each other wherever the lens is invertible."""

    @property
    def title(self) -> str:
        """A short plain name for lists of models to choose from."""
        ...

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the coefficients k; those of the radial part, the lowest first, begin with k.

        The start of the estimation sets the first coefficient alone.
        """
        ...

    @property
    def powers(self) -> tuple[int, ...]:
        """Power of the radius that each coefficient multiplies, relative to the radius."""
        ...

    @property
    def held(self) -> tuple[str, ...]:
        """Names of the coefficients that are held at 0 unless the user frees them."""
        ...

    @property
    def radius_in_pixels(self) -> bool:
        """True if d is in units of fx along both axes (the paper's radius), not of fx and fy."""
        ...

    def correct(self, d: Array, k: Array) -> Mapped:
        """Map measured to ideal points. NaN where the model has no ideal point."""
        ...

    def distort(self, n: Array, k: Array) -> Mapped:
        """Map ideal to measured points. NaN where the model has no measured point."""
        ...

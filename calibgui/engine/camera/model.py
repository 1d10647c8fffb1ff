"""The contract of a lens model: rays to image points and back, with all derivatives.

A lens maps directions. Seen from the camera, a scene point lies in the direction of a ray
(X, Y, Z); the lens images it at a point d of the image, and nothing else about it matters. Rays,
and not the points (X/Z, Y/Z) of a plane, are what a lens of 180 degrees and more needs: at 90
degrees off the axis the plane has no point, and near it none that is well determined.

Frames: a ray is (..., 3) in the camera frame, X to the right, Y down, Z along the axis, of any
length; d is (..., 2) and dimensionless, d = ((u - cx) / fx, (v - cy) / fy), measured to the right
and down. `k` are the model's coefficients. ``camera.projection`` adds focal lengths and centre.

A model whose map is the plane's, d as a function of (X/Z, Y/Z), derives from ``camera.plane``.

What the start of a calibration needs besides the maps is data of the model too, so that it knows no
model by its name: which parameters are held, where several minima lie, what a start leaves alone.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array


class LensProjection(NamedTuple):
    """Image points of rays, with derivatives."""

    points: Array
    """(..., 2) d."""
    by_ray: Array
    """(..., 2, 3) derivative by the ray; its product with the ray is 0."""
    by_coefficients: Array
    """(..., 2, C) derivative by k."""


class LensUnprojection(NamedTuple):
    """Rays of image points, with derivatives."""

    rays: Array
    """(..., 3) of length 1."""
    by_point: Array
    """(..., 3, 2) derivative by d."""
    by_coefficients: Array
    """(..., 3, C) derivative by k."""


class Trials(NamedTuple):
    """Values of one coefficient from each of which a fit begins."""

    coefficient: str
    """Name of the coefficient."""
    values: tuple[float, ...]
    """The values, ascending."""


class Lens(ABC):
    """A lens model: two maps, inverse to each other wherever the lens is one-to-one."""

    title: str
    """A short plain name for lists of models to choose from."""
    names: tuple[str, ...]
    """Names of the coefficients k."""
    powers: tuple[int, ...]
    """Power of the radius that each coefficient multiplies, relative to the radius; 0 for a
    coefficient that shapes the projection as a whole."""
    held: tuple[str, ...] = ()
    """Names of the parameters that are held unless the user frees them.

    A parameter that does what a rotation, a roll or a shift of the camera does belongs here: poses
    and centre would take up any value of it, the residuals could not tell, and all of them would
    be undetermined together.
    """

    @property
    def short_title(self) -> str:
        """Title without the programs that the model is known from, for sentences."""
        return self.title.partition(" (")[0]

    asymmetric: tuple[str, ...] = ()
    """Names of the coefficients without which the lens is symmetric about its axis."""
    odd_along: tuple[tuple[str, ...], tuple[str, ...]] = (
        ("p2", "s1", "s2", "skew"),
        ("p1", "s3", "s4", "skew"),
    )
    """Names of the coefficients that change their sign in the lens that is mirrored along x, and in
    the one that is mirrored along y; by default those of OpenCV's names."""
    radius_in_pixels: bool = False
    """True if d is in units of fx along both axes (the paper's radius), not of fx and fy."""
    valley: Trials | None = None
    """The coefficient along which the cost of a calibration has several minima, because others do
    nearly the same, with values between and beside these; None if one start is enough."""
    conversion_starts: Trials | None = None
    """The coefficient along which the cost of a fit to the rays of another camera has several
    minima, with values between and beside these; None if one start is enough. Such a fit begins
    with the other coefficients at their defaults."""
    held_at_start: tuple[str, ...] = ()
    """Names of the coefficients that a start leaves at their defaults, although they are free in
    the solve: the rays of a start are not good enough to tell them from the others."""
    least_at_start: Mapping[str, float] = MappingProxyType({})
    """Least values of coefficients at a start, by name: those below which another coefficient
    has hardly any effect, so that a solve from there would not determine it."""
    control_points: tuple[int, int] | None = None
    """Numbers along x and y of the control points of a spline, whose coefficients each act on a
    small part of the image; None if each coefficient acts on the whole image."""
    edge: Array | None = None
    """(2,) largest |u| along x and y that is imaged, where u = 2 (X, Y) / (|r| + Z) is a ray's
    stereographic point, if that is fixed beforehand; None if it depends on the coefficients."""

    @property
    def defaults(self) -> tuple[float, ...]:
        """Values of the coefficients of the plainest lens: where held ones stay and fits begin."""
        return (0.0,) * len(self.names)

    @abstractmethod
    def project(self, rays: Array, k: Array) -> LensProjection:
        """Map rays to image points. NaN where the model has none, and for a ray of length 0."""

    @abstractmethod
    def unproject(self, d: Array, k: Array) -> LensUnprojection:
        """Map image points to rays of length 1. NaN where the model has none."""

    def project_points(self, rays: Array, k: Array) -> Array:
        """Map rays to image points (..., 2) as `project` does, without derivatives."""
        return self.project(rays, k).points

    def unproject_points(self, d: Array, k: Array) -> tuple[Array, Array]:
        """Map image points to rays of length 1 as `unproject` does, with derivatives by d only."""
        rays, by_point, _ = self.unproject(d, k)
        return rays, by_point

    def mirror(self, k: Array, along: tuple[bool, bool]) -> Array:
        """Return the coefficients of the mirrored lens: it images (-X, Y, Z) where this one images
        (X, Y, Z), with -d_x for d_x, if it is mirrored along x, and so along y."""
        odd = [
            set(names)
            for names, is_mirrored in zip(self.odd_along, along, strict=True)
            if is_mirrored
        ]
        signs = [(-1.0) ** sum(name in names for names in odd) for name in self.names]
        return np.asarray(k * np.array(signs))

    def fit_to_rays(self, rays: Array, d: Array) -> Array | None:  # noqa: ARG002 - for overrides
        """Fit the coefficients (C,) to image points of rays, where that is a linear problem.

        It is None for models that are not linear in their coefficients, which take an iteration.

        Args:
            rays: (n, 3) rays of any length.
            d: (n, 2) their image points, dimensionless.
        """
        return None

    def compute_stiffness(self, corners: int) -> Array | None:  # noqa: ARG002 - for overrides
        """Compute (C, C) the matrix Q of a prior k^T Q k that the solver adds to the cost.

        It is None for models whose coefficients the corners determine.

        Args:
            corners: number of corners in all views.
        """
        return None

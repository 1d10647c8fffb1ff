"""A lens sees angles that undistorted images do not show; they are measured, and put into words.

From the axis to the middle of each side of the photograph, the lens sees up to some angle off the
axis. The undistorted images show its rays up to another; what lies between the two is lost. What is
lost between the sides, in the corners, is told by the share of the photograph's pixels.

The photograph's own limits count, and those of the lens model. How far the lens really draws, where
its circle ends within a black frame, no calibration knows.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, BoolArray
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import rays_from_pixels
from calibgui.engine.geometry.directions import measure_angles_off_axis
from calibgui.engine.images.outline import find_axis, find_outermost_pixels
from calibgui.engine.images.projections import IdealCamera
from calibgui.engine.images.resampling import is_inside
from calibgui.engine.images.sampling import make_mesh

_STEPS = 1001
"""Number of pixels from the axis to a side that are looked at: every 0.1 degrees of 100."""
_MESH = 41, 31
"""Columns and rows of the pixels that the share of lost pixels is counted of."""
_MIN_LOST_SHARE = 4e-3
"""Share of lost pixels from which it is told: five of the mesh, as rounding may lose one."""


@dataclass(frozen=True, slots=True)
class HiddenAngles:
    """The angles that a lens sees and undistorted images do not show."""

    left: float
    """Angle between the outermost ray that is shown and the outermost that is seen, radians,
    from the axis to the left; `right`, `top` and `bottom` likewise."""
    right: float
    top: float
    bottom: float
    share: float
    """Share of the photograph's lit pixels with a ray that are not shown, 0 to 1."""


def measure_hidden_angles(camera: Camera, ideals: Iterable[IdealCamera]) -> HiddenAngles:
    """Measure what images of `ideals` do not show of what `camera` sees."""
    shown_by = tuple(ideals)
    (u, v), (width, height) = find_axis(camera)[0], camera.size
    ends = np.array([[-0.5, v], [width - 0.5, v], [u, -0.5], [u, height - 0.5]])
    ways = [_measure_way(camera, shown_by, end) for end in find_outermost_pixels(ends, camera)]
    left, right, top, bottom = ways
    mesh = make_mesh(*(np.linspace(0, n - 1, m) for n, m in zip(camera.size, _MESH, strict=True)))
    rays = rays_from_pixels(mesh, camera)
    is_seen = np.isfinite(rays).all(axis=-1) & camera.lights(mesh)
    is_lost = is_seen & ~_find_shown(rays, shown_by)
    return HiddenAngles(left, right, top, bottom, float(is_lost.sum() / max(is_seen.sum(), 1)))


def _measure_way(camera: Camera, ideals: tuple[IdealCamera, ...], end: Array) -> float:
    """Return the angle, radians, that is lost on the way from the axis to a pixel (2,)."""
    axis, _ = find_axis(camera)
    rays = rays_from_pixels(axis + np.linspace(0, 1, _STEPS)[:, None] * (end - axis), camera)
    angle = measure_angles_off_axis(rays)
    is_shown = _find_shown(rays, ideals)
    first_lost = _STEPS if is_shown.all() else int(is_shown.argmin())
    return float(angle[-1] - angle[max(first_lost - 1, 0)])


def _find_shown(rays: Array, ideals: tuple[IdealCamera, ...]) -> BoolArray:
    """Return (...) whether any ideal camera shows the rays (..., 3)."""
    shown = np.zeros(rays.shape[:-1], bool)
    for ideal in ideals:
        shown |= is_inside(ideal.find_pixels(rays), ideal.size)
    return shown


def describe_hidden_angles(camera: Camera, ideals: Mapping[str, IdealCamera]) -> str:
    """Say in one sentence what undistorted images show, and which angle of the lens they lose.

    Args:
        camera: the camera that took the photographs.
        ideals: the ideal cameras of the images, as `choose_ideal_cameras` returns them.

    Examples:
        >>> import numpy as np
        >>> from calibgui.engine.camera import Camera
        >>> from calibgui.engine.images import choose_ideal_cameras, describe_hidden_angles
        >>> fisheye = Camera((800, 800), [246, 246, 400, 400, 0, 0, 0, 0], "kannala-brandt")
        >>> ideals = choose_ideal_cameras(fisheye, field_of_view=np.deg2rad(120))
        >>> describe_hidden_angles(fisheye, ideals)
        'Perspective of 120 degrees: the outer 33 degrees of the lens on each side and 33 degrees
        at the top and bottom are not shown.'
    """
    lost = measure_hidden_angles(camera, ideals.values())
    left, right, top, bottom = (
        round(np.rad2deg(angle)) for angle in (lost.left, lost.right, lost.top, lost.bottom)
    )
    across = [(left, "on each side")] if left == right else []
    across = across or [(left, "on the left"), (right, "on the right")]
    upright = [(top, "at the top and bottom")] if top == bottom else []
    upright = upright or [(top, "at the top"), (bottom, "at the bottom")]
    parts = [(angle, place) for angle, place in across + upright if angle]
    if parts:
        (angle, place), *others = parts
        words = [f"{_count_degrees(angle)} of the lens {place}"]
        words += [f"{_count_degrees(angle)} {place}" for angle, place in others]
        verb = "is" if parts[0][0] == len(parts) == 1 else "are"
        loss = f"the outer {_join(words)} {verb} not shown"
    elif lost.share > _MIN_LOST_SHARE:
        loss = f"{lost.share:.1%} of the photograph, in its corners, are not shown"
    else:
        loss = "everything that the lens sees is shown"
    return f"{_describe_projection(ideals)}: {loss}."


def _describe_projection(ideals: Mapping[str, IdealCamera]) -> str:
    """Return the projection's name with its field of view, or the faces of a cube."""
    if "" not in ideals:
        return f"Cube of {_join(list(ideals))}"
    ideal = ideals[""]
    ends = np.array([[-0.5, ideal.matrix[1, 2]], [ideal.size[0] - 0.5, ideal.matrix[1, 2]]])
    X, _, Z = ideal.find_rays(ends).T
    # A panorama that is wider than all directions around has no ray at its ends.
    width = np.nan_to_num(np.abs(np.arctan2(X, Z)), nan=np.pi).sum()
    return f"{ideal.projection.capitalize()} of {np.rad2deg(width):.0f} degrees"


def _count_degrees(number: int) -> str:
    return f"{number} degree{'' if number == 1 else 's'}"


def _join(words: list[str]) -> str:
    """Return the words as an enumeration."""
    return ", ".join(words[:-1]) + " and " + words[-1] if len(words) > 1 else words[0]

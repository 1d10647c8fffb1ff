"""A lens sees the part of its image whose pixels have rays of their own; its outline is found here.

Not every pixel of an image need have a direction: a fisheye's circle may end within the image, and
the polynomial of a badly determined lens may fold over within it, so that two pixels share one.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from calibgui.engine.arrays import Array, Size
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import find_model
from calibgui.engine.camera.projection import pixels_from_rays, rays_from_pixels
from calibgui.engine.camera.validity import find_valid_pixels
from calibgui.engine.geometry.directions import measure_angles_off_axis

_ANGLE_MARGIN = 1.25
"""Multiple of the greatest angle within the image, beyond which rays cannot be of the image. It
leaves room for the knots of ``images.smooth_map``, which lie outside the image."""
_BISECTIONS = 40
"""Number of halvings in the search for the outermost pixel: to 1e-8 px in any image."""
_COARSE_BISECTIONS = 10
"""Number of halvings where a thousandth of the way suffices."""


def trace_pixels(uv: Array, camera: Camera) -> Array:
    """Return rays (..., 3) of length 1 of pixels (..., 2); NaN where one has none of its own."""
    rays = rays_from_pixels(uv, camera)
    rays[~find_valid_pixels(uv, camera)] = np.nan
    return rays


def sample_sides(size: Size, count: int = 101) -> Array:
    """Return points (4, count, 2) on the outer edges of the left, top, right and bottom pixels."""
    w, h = size
    u, v = np.linspace(-0.5, w - 0.5, count), np.linspace(-0.5, h - 0.5, count)
    sides = [(u[:1], v), (u, v[:1]), (u[-1:], v), (u, v[-1:])]
    return np.stack([np.stack(np.broadcast_arrays(*side), axis=-1) for side in sides])


def prepare_tracing(camera: Camera) -> Callable[[Array], Array]:
    """Return the function that takes rays (..., 3) to the pixels (..., 2) that measured them.

    It is NaN where there is none. A polynomial that folds beyond the image sends rays from far
    outside back into it; they are told by their angle off the axis, as the image's own end at its
    sides.
    """
    sides = sample_sides(camera.size, 21)
    rays = trace_pixels(sides, camera)
    is_unseen = np.isnan(rays).any(axis=-1)
    if is_unseen.any():
        outermost = find_outermost_pixels(sides[is_unseen], camera, _COARSE_BISECTIONS)
        rays[is_unseen] = trace_pixels(outermost, camera)
    greatest = float(
        measure_angles_off_axis(rays).max(initial=0.0, where=np.isfinite(rays[..., 0]))
    )

    def trace_rays(rays: Array) -> Array:
        pixels = pixels_from_rays(rays, camera)
        pixels[measure_angles_off_axis(rays) > _ANGLE_MARGIN * greatest] = np.nan
        return pixels

    return trace_rays


def find_axis(camera: Camera) -> tuple[Array, Array]:
    """Return the pixel (2,) of the lens's axis, and the scale (2,) of the image there.

    The scale is in px per radian to the right and down. For most lens models these are the centre
    and the focal lengths; some make f another quantity (Mei's is that of a sphere's image).
    """
    imaged = find_model(camera.model).project(np.array([0.0, 0.0, 1.0]), camera.coefficients)
    scale = camera.focal * imaged.by_ray[[0, 1], [0, 1]]
    return camera.centre + camera.focal * imaged.points, scale


def find_outermost_pixels(uv: Array, camera: Camera, bisections: int = _BISECTIONS) -> Array:
    """Return the last pixels (..., 2) with a ray of their own on the way from the axis to `uv`.

    They are NaN where there is none on the whole way.
    """
    axis, _ = find_axis(camera)
    low, high = np.zeros(uv.shape[:-1]), np.ones(uv.shape[:-1])
    for _ in range(bisections):
        middle = (low + high) / 2
        is_seen = np.isfinite(trace_pixels(axis + middle[..., None] * (uv - axis), camera))
        low = np.where(is_seen.all(axis=-1), middle, low)
        high = np.where(is_seen.all(axis=-1), high, middle)
    outermost = axis + low[..., None] * (uv - axis)
    return np.where(low[..., None] > 0, outermost, np.nan)

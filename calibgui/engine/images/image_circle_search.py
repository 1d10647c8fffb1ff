"""The image circle of a lens is found in a photograph by the light that ends along it.

On the way outward from the image's middle the last pixel that is not dark lies on the circle, where
the scene is light there, and within it elsewhere. So a circle is sought that most of these pixels
share, from random triples of them (Fischler and Bolles 1981), and that none is far outside of. A
scene on a black ground ends where it happens to; and only a circle that most photographs of a
camera share counts (``camera/image_circle.py``).
"""

from __future__ import annotations

import numpy as np

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, BoolArray, GreyImage
from calibgui.engine.camera.image_circle import ImageCircle

_LONGER_SIDE = 480
"""Longer side, px, up to which an image is fine enough: a choice."""
_LIGHT = 0.25
"""Level that is not dark, from that of the image's frame to that of its lightest quarter."""
_RAYS = 90
"""Number of ways outward."""
_MIN_RAYS = _RAYS // 6
"""Number of ways that must end on the circle: of less than a sixth of it the rest is not known."""
_TRIPLES = 200
"""Number of random triples: with half of the ends on the circle, all but 1 in 10^11 searches have
one on it."""
_TOLERANCE_PX = 2.0
"""Distance from the circle of an end that counts as on it, px: a step outward and what the light's
edge is wide. A choice."""
_MIN_PART = 0.5
"""Part of the ends that the circle has in the image, from which it is one. Of 70 photographs of two
fisheyes and of a rendered endoscope it was 0.7 or more; of 190 others three had a circle."""
_MAX_OUTSIDE = 0.02
"""Part of the light that may lie beyond the circle, as that which the lens's mount reflects."""


def find_image_circle(image: GreyImage) -> ImageCircle | None:
    """Find the circle (px) that a lens lights in an image (h, w); None where it lights all."""
    scale = 1.0
    while max(image.shape) > _LONGER_SIDE:
        image, scale = opencv.halve_image(image), scale / 2
    light = _find_light(image)
    ends, middle = _find_ends(light)
    circle = _fit_circle(ends)
    if circle is None or not _is_image_circle(circle, ends, middle, light):
        return None
    u, v, radius = circle
    return ImageCircle((u + 0.5) / scale - 0.5, (v + 0.5) / scale - 0.5, radius / scale)


def _find_light(image: GreyImage) -> BoolArray:
    """Find the pixels (h, w) that are not dark, without specks."""
    frame = np.concatenate([image[0], image[-1], image[:, 0], image[:, -1]])
    dark, bright = float(np.percentile(frame, 10)), float(np.percentile(image[::4, ::4], 75))
    light = (image > dark + _LIGHT * (bright - dark)).astype(np.uint8)
    return opencv.fill_narrow_parts(light, 3, are_bright=True) > 0


def _find_ends(light: BoolArray) -> tuple[Array, Array]:
    """Find the last light pixels (n, 2) on the ways outward from the image's middle (2,), of ways
    that do not end at the image's frame."""
    h, w = light.shape
    middle = np.array([w - 1, h - 1]) / 2
    # In single precision: this is asked while the image's other copies are in memory.
    steps = np.arange(int(np.hypot(*middle)) + 1, dtype=np.float32)
    uv = steps[:, None] * _make_directions().astype(np.float32)[:, None]
    uv += middle.astype(np.float32)
    column, row = np.moveaxis(np.rint(uv).astype(np.int32), -1, 0)
    is_inside = (column >= 0) & (column < w) & (row >= 0) & (row < h)
    is_light = is_inside & light[row.clip(0, h - 1), column.clip(0, w - 1)]
    last = len(steps) - 1 - np.argmax(is_light[:, ::-1], axis=1)
    chosen = is_light.any(axis=1) & (last < is_inside.sum(axis=1) - 3)
    return uv[chosen, last[chosen]].astype(np.float64), middle


def _make_directions() -> Array:
    angle = np.arange(_RAYS) * 2 * np.pi / _RAYS
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def _fit_circle(ends: Array) -> ImageCircle | None:
    """Fit the circle that most of the ends (n, 2) share; None if they are on none."""
    if len(ends) < _MIN_RAYS:
        return None
    rng = np.random.default_rng(0)
    triples = ends[rng.integers(0, len(ends), (_TRIPLES, 3))]
    # u^2 + v^2 = 2 a u + 2 b v + c on a circle about (a, b).
    matrix = np.concatenate([2 * triples, np.ones((_TRIPLES, 3, 1))], axis=-1)
    matrix = matrix[np.abs(np.linalg.det(matrix)) > 1.0]  # others lie on a line
    if not len(matrix):
        return None
    found = np.linalg.solve(matrix, np.sum(matrix[..., :2] ** 2, axis=-1)[..., None] / 4)[..., 0]
    on = _are_on(found, ends)
    on = on[np.argmax(on.sum(axis=1))]
    whole = np.column_stack([2 * ends[on], np.ones(int(on.sum()))])
    a, b, c = np.linalg.lstsq(whole, np.sum(ends[on] ** 2, axis=1), rcond=None)[0].tolist()
    return ImageCircle(a, b, float(np.sqrt(max(c + a * a + b * b, 0.0))))


def _are_on(circles: Array, uv: Array) -> BoolArray:
    """Return (m, n) which points (n, 2) are on circles (m, 3) of a, b and c."""
    radius = np.sqrt(np.maximum(circles[:, 2] + np.sum(circles[:, :2] ** 2, axis=1), 0.0))
    distance = np.linalg.norm(uv - circles[:, None, :2], axis=-1)
    return np.asarray(np.abs(distance - radius[:, None]) <= _TOLERANCE_PX)


def _is_image_circle(circle: ImageCircle, ends: Array, middle: Array, light: BoolArray) -> bool:
    """Return whether a circle holds the image's middle, the light ends at most of it that lies in
    the image, and next to none beyond it."""
    h, w = light.shape
    around = np.array(circle[:2]) + circle.radius * _make_directions()
    seen = ((around >= 1) & (around <= [w - 2, h - 2])).all(axis=1).sum()
    distance = np.linalg.norm(ends - np.array(circle[:2]), axis=-1)
    on = (np.abs(distance - circle.radius) <= _TOLERANCE_PX).sum()
    row, column = np.arange(h, dtype=np.float32), np.arange(w, dtype=np.float32)
    square = (row[:, None] - circle.v) ** 2 + (column - circle.u) ** 2
    is_beyond = square > (circle.radius + 2 * _TOLERANCE_PX) ** 2
    outside = float(is_beyond[light].mean()) if light.any() else 0.0
    is_shared = seen >= _MIN_RAYS and on >= _MIN_PART * seen
    return bool(circle.contains(middle) and is_shared and outside < _MAX_OUTSIDE)

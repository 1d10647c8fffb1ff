"""The image circle: the part of the image that a lens lights, where it does not fill all of it.

The lenses of endoscopes and many fisheyes cast a round image on a black ground. A pixel of the
ground has no ray, whatever a lens model makes of it.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, BoolArray

_MAX_DEVIATION = 0.02
"""Difference of a photograph's circle from the usual one, over its radius, up to which it is the
same. In 70 photographs of two fisheyes and of a rendered endoscope it was 0.003 at most."""


class ImageCircle(NamedTuple):
    """A circle in the image."""

    u: float
    """Column of its centre, px."""
    v: float
    """Row of its centre, px."""
    radius: float
    """Radius, px."""

    def contains(self, uv: Array) -> BoolArray:
        """Return (...) whether pixels (..., 2) lie in the circle."""
        return np.asarray(np.linalg.norm(uv - np.array(self[:2]), axis=-1) <= self.radius)


def find_common_circle(circles: Iterable[ImageCircle | None]) -> ImageCircle | None:
    """Return the circle that most photographs of one camera share; None if they share none."""
    given = list(circles)
    found = np.array([circle for circle in given if circle is not None])
    if not len(found):
        return None
    usual = np.median(found, axis=0)
    is_usual = np.abs(found - usual).max(axis=1) <= _MAX_DEVIATION * usual[2]
    return ImageCircle(*usual.tolist()) if 2 * is_usual.sum() > len(given) else None

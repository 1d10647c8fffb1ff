"""What the corners of a board look like, and what does not look like one.

Around a corner four sectors alternate: the two opposite ones that its place requires to be dark
are darker than the two others, by a contrast comparable to that of the other corners. And all
corners of a board look alike, once sampled along the steps of the lattice and, at every second
place, mirrored: what is nearly a corner, where an edge of the surroundings meets the border of
the board, has a line that turns or a sector that is not even.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.corners.lattice import Lattice, axes
from calibgui.engine.imaging.sampling import sample
from calibgui.engine.opencv import Image
from calibgui.engine.types import Array, BoolArray, IntArray

_INSIDE = np.array([0.12, 0.22, 0.32])
"""Where a sector is sampled, in steps along both of its edges."""
_SIGNS = np.array([(1, 1), (-1, -1), (1, -1), (-1, 1)])
_SECTORS = np.array([(i * a, j * b) for i, j in _SIGNS for b in _INSIDE for a in _INSIDE])
_AROUND = np.array([-0.3, -0.2, -0.1, 0.1, 0.2, 0.3])
"""Where a corner's surroundings are compared, steps both ways."""
PLACES = np.array([(a, b) for a in _AROUND for b in _AROUND])
_EVEN = np.linalg.qr(np.column_stack([np.ones(len(PLACES)), PLACES]))[0]
"""(k, 3) orthonormal: what even light and its gradient do there."""
_CLEAR = 0.25
"""Least gap between the dark and the bright sectors over their difference."""
_WEAKEST = 0.2
"""Least contrast of a corner over the median of its lattice."""
_ENOUGH = 400
"""Corners, spread over the lattice, that tell what is typical."""
_EVENLY = 0.3
"""Greatest difference of grey levels within a square seen, over the contrast."""
_UNLIKE = 0.05
"""Greatest lack of correlation with the typical corner ..."""
_UNUSUAL = 4.0
"""... or over the median lack, whichever is more."""


class Placed(NamedTuple):
    """Corners of a lattice, and what their places there require of them."""

    uv: Array
    """(n, 2) px."""
    right: Array
    """(n, 2) steps to the next column, px."""
    down: Array
    """(n, 2) steps to the next row, px."""
    dark: BoolArray
    """(n,) whether the squares before (-, -) and after (+, +) the corner are dark."""

    def under(self, chosen: BoolArray | IntArray) -> Placed:
        """Those under a mask (n,), or with these numbers (m,)."""
        uv, right, down, dark = self
        return Placed(uv[chosen], right[chosen], down[chosen], dark[chosen])

    def some(self, most: int) -> Placed:
        """At most so many of them, spread over all."""
        n = len(self.uv)
        if n <= most:
            return self
        return self.under(np.linspace(0, n - 1, most).astype(np.int64))

    def nearer(self, plain: float) -> Placed:
        """With shorter steps, for squares of one colour only up to `plain` squares from their
        edges."""
        return self._replace(right=2 * plain * self.right, down=2 * plain * self.down)


@dataclass(frozen=True, eq=False, slots=True)
class Look:
    """Of the corners of a lattice."""

    contrast: float
    """Median, grey levels."""
    pattern: Array
    """(k,) median of their surroundings, less even light, of unit standard deviation."""
    unlike: float
    """Median lack of correlation with the pattern."""

    def shown(
        self, image: Image, uv: Array, right: Array, down: Array, dark: BoolArray
    ) -> tuple[BoolArray, Array]:
        """Which of the points have it, arguments as for `sectors`; and the gap (n,) between their
        dark and bright sectors, grey levels."""
        alternate, gap = self.alternate(image, uv, right, down, dark)
        unlike = 1 - np.mean(_surroundings(image, uv, right, down, dark) * self.pattern, axis=1)
        return alternate & (unlike <= max(_UNLIKE, _UNUSUAL * self.unlike)), gap

    def alternate(
        self, image: Image, uv: Array, right: Array, down: Array, dark: BoolArray
    ) -> tuple[BoolArray, Array]:
        """The same for points whose sectors alternate, whatever else their look."""
        gap, contrast = sectors(image, uv, right, down, dark)
        return (gap > _CLEAR * contrast) & (contrast > _WEAKEST * self.contrast), gap

    def contradicted(
        self, image: Image, uv: Array, right: Array, down: Array, dark: BoolArray
    ) -> BoolArray:
        """(n,) points around which squares of the board's contrast are seen, evenly filled, that
        do not alternate: there is no corner, rather than one that something hides."""
        values = _sectors(image, uv, right, down)
        level, spread = values.mean(axis=2), np.ptp(values, axis=2).max(axis=1)
        low, high = level.min(axis=1), level.max(axis=1)
        aside = np.minimum(level - low[:, None], high[:, None] - level).max(axis=1)
        even = np.maximum(spread, aside) < _EVENLY * self.contrast
        mixed = abs(high - low - self.contrast) < self.contrast / 2
        gap, _ = sectors(image, uv, right, down, dark)
        return np.asarray(even & mixed & (gap < 0))


def typical(lattice: Lattice, image: Image, plain: float = 0.5) -> Look:
    """The look of the corners of `lattice`, near them if the squares are of one colour only up to
    `plain` squares from their edges."""
    corners = placed(lattice).some(_ENOUGH).nearer(plain)
    _, contrast = sectors(image, *corners)
    surroundings = _surroundings(image, *corners)
    pattern = _common(surroundings)
    unlike = 1 - np.mean(surroundings * pattern, axis=1)
    return Look(float(np.median(contrast)), pattern, float(np.median(unlike)))


def pattern(corners: Placed, image: Image) -> Array:
    """The ``Look.pattern`` of the corners."""
    return _common(_surroundings(image, *corners))


def _common(surroundings: Array) -> Array:
    """What surroundings (n, k) of corners have in common, as `standard`."""
    return standard(np.median(surroundings, axis=0))


def placed(lattice: Lattice) -> Placed:
    """The corners of `lattice`."""
    right, down = axes(lattice.uv)
    at = np.nonzero(lattice.found)
    dark = lattice.dark ^ ((at[0] + at[1]) % 2 == 1)
    return Placed(lattice.uv[at], right[at], down[at], dark)


def sectors(
    image: Image, uv: Array, right: Array, down: Array, dark: BoolArray
) -> tuple[Array, Array]:
    """How clearly the four sectors around corners alternate as their places require.

    Args:
        image: (h, w) grey levels.
        uv, right, down, dark: of the corners, as `Placed`.

    Returns:
        Gap between the darkest bright and the brightest dark sector (n,), and the difference
        of bright and dark on average (n,), both grey levels and negative where exchanged.
    """
    if kernels.COMPILED:
        from calibgui.engine.kernels import appearance

        return appearance.sectors(image, uv, right, down, dark, _SECTORS, float(_INSIDE.max()))
    values = _sectors(image, uv, right, down).mean(axis=2)
    values = np.where(dark[:, None], values, -values)
    low, high = values[:, :2], values[:, 2:]
    difference = high.mean(axis=1) - low.mean(axis=1)
    return high.min(axis=1) - low.max(axis=1), difference


def _sectors(image: Image, uv: Array, right: Array, down: Array) -> Array:
    """(n, 4, k) grey levels in the squares (+, +), (-, -), (+, -) and (-, +) around corners."""
    # At the border of the image the sectors are looked at nearer to the corner.
    room = np.minimum(uv, np.array(image.shape[::-1]) - 1.0 - uv)
    reach = _INSIDE.max() * (abs(right) + abs(down))
    nearer = np.clip(room / reach, 0.1, 1.0).min(axis=1, keepdims=True)
    values = around(image, uv, nearer * right, nearer * down, _SECTORS)
    return values.reshape(len(uv), len(_SIGNS), _INSIDE.size**2)


def _surroundings(image: Image, uv: Array, right: Array, down: Array, dark: BoolArray) -> Array:
    """(n, k) grey levels around corners, mirrored where the first squares are not dark."""
    if kernels.COMPILED:
        from calibgui.engine.kernels import appearance

        return appearance.surroundings(image, uv, right, down, dark, PLACES, _EVEN)
    right = np.where(dark[:, None], right, -right)
    return standard(around(image, uv, right, down, PLACES))


def around(image: Image, uv: Array, right: Array, down: Array, places: Array) -> Array:
    """(n, k) grey levels at `places` (k, 2), in steps from the corners.

    Outside the image those opposite stand in for them: a corner is point symmetric.
    """
    if kernels.COMPILED:
        from calibgui.engine.kernels import appearance

        return appearance.around(image, uv, right, down, places)
    a, b = places.T[..., None]
    offset = a * right[:, None] + b * down[:, None]
    at = uv[:, None] + offset
    outside = ((at < -0.5) | (at > np.array(image.shape[::-1]) - 0.5)).any(axis=2)
    at[outside] -= 2 * offset[outside]
    return sample(image, at)


def standard(values: Array) -> Array:
    """`values` (..., k) less what light that varies linearly explains, over the rest's standard
    deviation."""
    rest = values - values @ _EVEN @ _EVEN.T
    return np.asarray(rest / np.maximum(rest.std(axis=-1, keepdims=True), 1e-12))

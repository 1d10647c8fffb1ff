"""What the corners of a board look like, and what does not look like one.

Around a corner four sectors alternate: the two opposite ones that its place requires to be dark
are darker than the two others, by a contrast comparable to that of the other corners. And all
corners of a board look alike, once sampled along the steps of the lattice and, at every second
place, mirrored: what is nearly a corner, where an edge of the surroundings meets the border of
the board, has a line that turns or a sector that is not even.

Are the corners of a lattice crossings of two edges?

Saddle points between bright and dark places that alternate are also found among discs and in nets
of lines. The typical corner tells them from a board's: noise and what hides a few corners do
not show in it, and its surroundings are those of two blurred edges whose squares overlap or part
by a little. In the coordinates (a, b) along the edges, in squares, it is dark where one or
the other of two events is,

    F((g + a) / s_1) F((g + b) / s_2),    F((g - a) / s_1) F((g - b) / s_2),

with the normal distribution F, the overlap g and the blurs s.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, BoolArray, GreyImage, IntArray
from calibgui.engine.detection.lattice import Lattice, axes
from calibgui.engine.images.sampling import sample

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
        self, image: GreyImage, uv: Array, right: Array, down: Array, dark: BoolArray
    ) -> tuple[BoolArray, Array]:
        """Which of the points have it, arguments as for `sectors`; and the gap (n,) between their
        dark and bright sectors, grey levels."""
        alternate, gap = self.alternate(image, uv, right, down, dark)
        unlike = 1 - np.mean(_surroundings(image, uv, right, down, dark) * self.pattern, axis=1)
        return alternate & (unlike <= max(_UNLIKE, _UNUSUAL * self.unlike)), gap

    def alternate(
        self, image: GreyImage, uv: Array, right: Array, down: Array, dark: BoolArray
    ) -> tuple[BoolArray, Array]:
        """The same for points whose sectors alternate, whatever else their look."""
        gap, contrast = sectors(image, uv, right, down, dark)
        return (gap > _CLEAR * contrast) & (contrast > _WEAKEST * self.contrast), gap

    def contradicted(
        self, image: GreyImage, uv: Array, right: Array, down: Array, dark: BoolArray
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


def typical(lattice: Lattice, image: GreyImage, plain: float = 0.5) -> Look:
    """The look of the corners of `lattice`, near them if the squares are of one colour only up to
    `plain` squares from their edges."""
    corners = placed(lattice).some(_ENOUGH).nearer(plain)
    _, contrast = sectors(image, *corners)
    surroundings = _surroundings(image, *corners)
    pattern = _common(surroundings)
    unlike = 1 - np.mean(surroundings * pattern, axis=1)
    return Look(float(np.median(contrast)), pattern, float(np.median(unlike)))


def pattern(corners: Placed, image: GreyImage) -> Array:
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
    image: GreyImage, uv: Array, right: Array, down: Array, dark: BoolArray
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
        from calibgui.engine.kernels import corner_template

        return corner_template.sectors(image, uv, right, down, dark, _SECTORS, float(_INSIDE.max()))
    values = _sectors(image, uv, right, down).mean(axis=2)
    values = np.where(dark[:, None], values, -values)
    low, high = values[:, :2], values[:, 2:]
    difference = high.mean(axis=1) - low.mean(axis=1)
    return high.min(axis=1) - low.max(axis=1), difference


def _sectors(image: GreyImage, uv: Array, right: Array, down: Array) -> Array:
    """(n, 4, k) grey levels in the squares (+, +), (-, -), (+, -) and (-, +) around corners."""
    # At the border of the image the sectors are looked at nearer to the corner.
    room = np.minimum(uv, np.array(image.shape[::-1]) - 1.0 - uv)
    reach = _INSIDE.max() * (abs(right) + abs(down))
    nearer = np.clip(room / reach, 0.1, 1.0).min(axis=1, keepdims=True)
    values = around(image, uv, nearer * right, nearer * down, _SECTORS)
    return values.reshape(len(uv), len(_SIGNS), _INSIDE.size**2)


def _surroundings(image: GreyImage, uv: Array, right: Array, down: Array, dark: BoolArray) -> Array:
    """(n, k) grey levels around corners, mirrored where the first squares are not dark."""
    if kernels.COMPILED:
        from calibgui.engine.kernels import corner_template

        return corner_template.surroundings(image, uv, right, down, dark, PLACES, _EVEN)
    right = np.where(dark[:, None], right, -right)
    return standard(around(image, uv, right, down, PLACES))


def around(image: GreyImage, uv: Array, right: Array, down: Array, places: Array) -> Array:
    """(n, k) grey levels at `places` (k, 2), in steps from the corners.

    Outside the image those opposite stand in for them: a corner is point symmetric.
    """
    if kernels.COMPILED:
        from calibgui.engine.kernels import corner_template

        return corner_template.around(image, uv, right, down, places)
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


_BLURS = np.array([0.005, 0.02, 0.04, 0.07, 0.1, 0.14, 0.18, 0.22, 0.27])
"""Of the crossings that it may be, squares."""
_OVERLAPS = np.array([-0.1, -0.08, -0.06, -0.04, -0.02, 0.0, 0.02, 0.04, 0.06, 0.08, 0.1])
"""Of these, squares."""
_FAR, _NEAR = 0.5, 0.25
"""How far from the edges squares are taken to be of one colour: in full, or where something is
printed in them."""
_UNLIKE_CROSSING = 0.011
"""Greatest lack of correlation with the nearest of the crossings ..."""
_PLAIN = 0.005
"""... and of what is near the corner with those that do not overlap, where things are printed."""


def crossed(corners: Placed, image: GreyImage) -> tuple[bool, bool]:
    """Whether the typical one of the corners is the crossing of two edges in `image` as far as its
    squares are of one colour; and whether they are throughout, with nothing printed in them."""
    near = pattern(corners.nearer(_NEAR), image)
    if _unlike(near, _crossings(_NEAR)) > _UNLIKE_CROSSING:
        return False, False
    bare = _unlike(pattern(corners, image), _crossings(_FAR)) <= _UNLIKE_CROSSING
    return bare or _unlike(near, _crossings(_NEAR, overlap=False)) <= _PLAIN, bare


def _unlike(seen: Array, crossings: Array) -> float:
    """Lack of correlation of a pattern (k,) with the nearest of crossings (m, k)."""
    return float(1 - np.max(np.abs(crossings @ seen)) / len(seen))


@cache
def _crossings(plain: float, overlap: bool = True) -> Array:
    """(m, k) what crossings look like to ``appearance.pattern``."""
    overlaps = _OVERLAPS if overlap else np.zeros(1)
    s1, s2, g = (x.reshape(-1, 1) for x in np.meshgrid(_BLURS, _BLURS, overlaps))
    a, b = 2 * plain * PLACES.T
    ndtr = scipy.special.ndtr
    one, other = (ndtr((g + sign * a) / s1) * ndtr((g + sign * b) / s2) for sign in (1, -1))
    return standard(one + other - one * other)

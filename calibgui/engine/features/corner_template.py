"""The look of a board's corners: the typical corner, and whether it is the crossing of two edges.

**The typical corner.** Around a corner four sectors alternate: the two opposite ones that its place
requires to be dark are darker than the two others, by a contrast comparable to that of the other
corners. And all corners of a board look alike, once sampled along the steps of the lattice and, at
every second place, mirrored. So the median of many is a template: what is nearly a corner, where
an edge of the surroundings meets the border of the board, has a line that turns or a sector that
is not even, and correlates badly with it. Patches are compared less the light that varies linearly
over them, at unit standard deviation.

**Crossings of two edges.** Saddle points between bright and dark places that alternate are also
found among discs and in nets of lines. The typical corner tells them from a board's: noise and
what hides a few corners do not show in it, and it looks like two blurred edges whose squares
overlap or part by a little. In the coordinates (a, b) along the edges, in squares, it is dark where
either of two events is,

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
from calibgui.engine.arrays import Array, BoolArray, GreyImage, IntArray, compute_median
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.images.sampling import sample_image

_MIN_SECTOR_GAP = 0.25
"""Least gap between the dark and the bright sectors, over their mean difference."""
MIN_RELATIVE_CONTRAST = 0.2
"""Least contrast of a corner, over the median of its lattice; less as its light is less."""
_MAX_TEMPLATE_CORNERS = 400
"""Number of corners, spread over the lattice, that the typical corner is taken from."""
MAX_DISSIMILARITY = 0.05
"""Greatest lack of correlation with the typical corner ..."""
_MAX_RELATIVE_DISSIMILARITY = 4.0
"""... or over the median lack, whichever is more."""
_MAX_CROSSING_DISSIMILARITY = 0.011
"""Greatest lack of correlation of the typical corner with the nearest of the modelled
crossings of two edges ..."""
_MAX_PRINTED_DISSIMILARITY = 0.005
"""... and, where things are printed in the squares, of what is near the corner with those
crossings that neither overlap nor part."""
_MAX_DISSIMILARITY_ALONE = 0.02
"""... or, of a lattice that stands alone with straight edges, whatever is farther away. Boards
in interlaced frames, or sharpened to one side, have up to 0.017, discs 0.024 and more."""
_SECTOR_OFFSETS = np.array([0.12, 0.22, 0.32])
"""Where a sector is sampled, in steps along both of its edges."""
_SECTOR_SIGNS = np.array([(1, 1), (-1, -1), (1, -1), (-1, 1)])
_SECTOR_POSITIONS = np.array(
    [(i * a, j * b) for i, j in _SECTOR_SIGNS for b in _SECTOR_OFFSETS for a in _SECTOR_OFFSETS]
)
"""(36, 2) samples of the four sectors, one after the other, steps."""
_LEAST_REACH = 1e-9
"""Reach of sectors, px, below which their corners have no squares."""
_PATCH_OFFSETS = np.array([-0.3, -0.2, -0.1, 0.1, 0.2, 0.3])
PATCH_POSITIONS = np.array([(a, b) for a in _PATCH_OFFSETS for b in _PATCH_OFFSETS])
"""(k, 2) where a corner's patch is sampled, steps."""
_LINEAR_LIGHT = np.linalg.qr(np.column_stack([np.ones(len(PATCH_POSITIONS)), PATCH_POSITIONS]))[0]
"""(k, 3) orthonormal: even light and its gradient over a patch."""


class OrientedCorners(NamedTuple):
    """Corners of a lattice, with the steps and the colours that the lattice gives them."""

    uv: Array
    """(n, 2) px."""
    right: Array
    """(n, 2) steps to the next column, px."""
    down: Array
    """(n, 2) steps to the next row, px."""
    dark: BoolArray
    """(n,) True if the squares before (-, -) and after (+, +) the corner are dark."""

    def select(self, chosen: BoolArray | IntArray) -> OrientedCorners:
        """Select corners by a mask (n,) or by their indices (m,)."""
        uv, right, down, dark = self
        return OrientedCorners(uv[chosen], right[chosen], down[chosen], dark[chosen])

    def subsample(self, most: int) -> OrientedCorners:
        """Select at most `most` corners, spread over all."""
        n = len(self.uv)
        if n <= most:
            return self
        return self.select(np.linspace(0, n - 1, most).astype(np.int64))

    def shorten_steps(self, bare_reach: float) -> OrientedCorners:
        """Shorten the steps so that half of each covers `bare_reach` squares, over which squares
        are of one colour."""
        return self._replace(right=2 * bare_reach * self.right, down=2 * bare_reach * self.down)


@dataclass(frozen=True, eq=False, slots=True)
class CornerTemplate:
    """The typical corner of a lattice."""

    contrast: float
    """Median contrast, grey levels."""
    patch: Array
    """(k,) median of the corners' patches, standardised."""
    dissimilarity: float
    """Median lack of correlation with the patch."""

    def match(
        self,
        image: GreyImage,
        uv: Array,
        right: Array,
        down: Array,
        dark: BoolArray,
        max_dissimilarity: float = MAX_DISSIMILARITY,
        light: Array | float = 1.0,
    ) -> tuple[BoolArray, Array]:
        """Match points with the template.

        Args:
            image: (h, w) grey levels.
            uv, right, down, dark: the points, as `OrientedCorners`.
            max_dissimilarity: greatest lack of correlation where that of most is small.
            light: (n,) share of most corners' light, in proportion to which contrast is expected.

        Returns:
            A mask (n,) of the points that look like the template, and the gap (n,) between their
            dark and bright sectors, grey levels.
        """
        alternate, gap = self.match_colours(image, uv, right, down, dark, light)
        patches = _compute_patches(image, uv, right, down, dark, PATCH_POSITIONS, _LINEAR_LIGHT)
        dissimilarity = 1 - np.mean(patches * self.patch, axis=1)
        greatest = max(
            max_dissimilarity,
            _MAX_RELATIVE_DISSIMILARITY * self.dissimilarity,
        )
        return alternate & (dissimilarity <= greatest), gap

    def match_colours(
        self,
        image: GreyImage,
        uv: Array,
        right: Array,
        down: Array,
        dark: BoolArray,
        light: Array | float = 1.0,
    ) -> tuple[BoolArray, Array]:
        """Match points by the colours of their sectors alone; arguments and results as `match`."""
        gap, contrast = compare_sectors(image, uv, right, down, dark)
        alternates = gap > _MIN_SECTOR_GAP * contrast
        least = MIN_RELATIVE_CONTRAST * light * self.contrast
        return alternates & (contrast > least), gap


def estimate_template(
    lattice: Lattice, image: GreyImage, bare_reach: float = 0.5
) -> CornerTemplate:
    """Estimate the typical corner of `lattice`.

    Args:
        lattice: the corners.
        image: (h, w) grey levels.
        bare_reach: how far from their edges the squares are of one colour, squares.
    """
    return estimate_template_of(orient_corners(lattice).shorten_steps(bare_reach), image)


def estimate_template_of(corners: OrientedCorners, image: GreyImage) -> CornerTemplate:
    """Estimate the typical one of `corners`, half of whose steps squares are of one colour over."""
    contrast = estimate_contrast(corners, image)
    corners = corners.subsample(_MAX_TEMPLATE_CORNERS)
    patches = _compute_patches(image, *corners, PATCH_POSITIONS, _LINEAR_LIGHT)
    patch = _compute_median_patch(patches)
    dissimilarity = 1 - np.mean(patches * patch, axis=1)
    return CornerTemplate(contrast, patch, float(compute_median(dissimilarity)))


def estimate_contrast(corners: OrientedCorners, image: GreyImage) -> float:
    """Estimate the median contrast of `corners`, grey levels."""
    corners = corners.subsample(_MAX_TEMPLATE_CORNERS)
    return float(compute_median(compare_sectors(image, *corners)[1]))


def _compute_median_patch(patches: Array) -> Array:
    """Compute the median (k,) of patches (n, k), standardised."""
    return _standardise(compute_median(np.ascontiguousarray(patches.T)), _LINEAR_LIGHT)


def orient_corners(lattice: Lattice) -> OrientedCorners:
    """Return the corners of `lattice` with their steps and colours."""
    right, down = lattice.steps()
    at = np.nonzero(lattice.found)
    dark = lattice.dark ^ ((at[0] + at[1]) % 2 == 1)
    return OrientedCorners(lattice.uv[at], right[at], down[at], dark)


def compare_sectors(
    image: GreyImage, uv: Array, right: Array, down: Array, dark: BoolArray
) -> tuple[Array, Array]:
    """Measure how clearly the four sectors around corners alternate as their places require.

    Args:
        image: (h, w) grey levels.
        uv, right, down, dark: the corners, as `OrientedCorners`.

    Returns:
        Gap between the darkest bright and the brightest dark sector (n,), and the difference
        of bright and dark on average (n,), both grey levels and negative where exchanged.
    """
    values = _average_sectors(image, uv, right, down, _SECTOR_POSITIONS, len(_SECTOR_SIGNS))
    values = np.where(dark[:, None], values, -values).T
    low, high = np.maximum(values[0], values[1]), np.minimum(values[2], values[3])
    return high - low, (values[2] + values[3] - values[0] - values[1]) / 2


def measure_light(image: GreyImage, corners: OrientedCorners) -> Array:
    """Measure the light on corners (n,) over that on most, at most 1: the grey levels of their
    bright squares are in proportion to it."""
    uv, right, down, dark = corners
    values = _average_sectors(image, uv, right, down, _SECTOR_POSITIONS, len(_SECTOR_SIGNS))
    level = np.where(dark, values[:, 2] + values[:, 3], values[:, 0] + values[:, 1])
    return compare_light(level)


def compare_light(level: Array) -> Array:
    """Return grey `level` (n,) of what is bright over the median, between 0 and 1."""
    return np.asarray(np.clip(level / np.maximum(compute_median(level), 1e-9), 0.0, 1.0))


@kernels.with_kernel("corner_template", "average_sectors")
def _average_sectors(
    image: GreyImage, uv: Array, right: Array, down: Array, positions: Array, count: int
) -> Array:
    """Average the grey levels (n, count) of the sectors around corners.

    At the border of the image the sectors are sampled nearer to the corner.

    Args:
        image: (h, w) grey levels.
        uv, right, down: the corners, as `OrientedCorners`.
        positions: (count * k, 2) samples of the sectors, one sector after the other, steps.
        count: number of sectors.
    """
    nearer = _shorten_at_border(image, uv, right, down, float(positions.max()))
    values = sample_around(image, uv, nearer * right, nearer * down, positions)
    return np.asarray(values.reshape(len(uv), count, -1).mean(axis=2))


def _shorten_at_border(
    image: GreyImage, uv: Array, right: Array, down: Array, reach: float
) -> Array:
    """Return the share (n, 1) of steps by which samples `reach` steps along both from the corners
    lie in the image, as far as that is sensible."""
    distance = np.minimum(uv, np.array(image.shape[::-1]) - 1.0 - uv)
    farthest = np.maximum(reach * (abs(right) + abs(down)), _LEAST_REACH)
    return np.asarray(np.clip(distance / farthest, 0.1, 1.0).min(axis=1, keepdims=True))


@kernels.with_kernel("corner_template", "compute_patches")
def _compute_patches(
    image: GreyImage,
    uv: Array,
    right: Array,
    down: Array,
    dark: BoolArray,
    positions: Array,
    light: Array,
) -> Array:
    """Compute the standardised patches (n, k) of corners, mirrored where not `dark`.

    Args:
        image: (h, w) grey levels.
        uv, right, down, dark: the corners, as `OrientedCorners`.
        positions: (k, 2) where a patch is sampled, steps.
        light: (k, m) orthonormal columns that are taken out of a patch, the first of them constant.
    """
    right = np.where(dark[:, None], right, -right)
    return _standardise(sample_around(image, uv, right, down, positions), light)


@kernels.with_kernel("corner_template", "sample_around")
def sample_around(
    image: GreyImage, uv: Array, right: Array, down: Array, positions: Array
) -> Array:
    """Sample grey levels (n, k) around corners.

    A sample outside the image is replaced by the opposite one: a corner is point symmetric.

    Args:
        image: (h, w) grey levels.
        uv: (n, 2) the corners, px.
        right, down: (n, 2) steps to the next column and row, px.
        positions: (k, 2) where to sample, steps.
    """
    a, b = positions.T[..., None]
    offset = a * right[:, None] + b * down[:, None]
    at = uv[:, None] + offset
    outside = ((at < -0.5) | (at > np.array(image.shape[::-1]) - 0.5)).any(axis=2)
    at[outside] -= 2 * offset[outside]
    return sample_image(image, at)


def _standardise(values: Array, light: Array) -> Array:
    """Subtract from `values` (..., k) what the columns of `light` (k, m) explain, the first of them
    constant, and divide by the rest's standard deviation."""
    rest = values - values @ light @ light.T
    # The first column of `light` is constant: the rest has no mean.
    square = np.sum(rest * rest, axis=-1, keepdims=True) / rest.shape[-1]
    return np.asarray(rest / np.maximum(np.sqrt(square), 1e-12))


_CROSSING_BLURS = np.array([0.005, 0.02, 0.04, 0.07, 0.1, 0.14, 0.18, 0.22, 0.27])
"""Blurs s of the modelled crossings, squares."""
_CROSSING_OVERLAPS = np.array([-0.1, -0.08, -0.06, -0.04, -0.02, 0.0, 0.02, 0.04, 0.06, 0.08, 0.1])
"""Overlaps g of the modelled crossings, squares."""
_WHOLE_REACH, BARE_REACH_IF_PRINTED = 0.5, 0.25
"""How far from the edges squares are taken to be of one colour, squares: throughout, or where
something is printed in them."""


def check_crossing(
    corners: OrientedCorners, image: GreyImage, bare_reach: float = _WHOLE_REACH
) -> tuple[bool, bool]:
    """Check whether the typical one of the corners is the crossing of two edges.

    Args:
        corners: those of a lattice.
        image: (h, w) grey levels.
        bare_reach: how far from their edges squares are known to be of one colour, squares: where
            what is printed begins nearer than elsewhere, corners count that are crossings so far.

    Returns:
        Whether it is, as far as squares are of one colour; and whether they are throughout, with
        nothing printed in them.
    """
    limit = _MAX_CROSSING_DISSIMILARITY
    for reach in sorted(
        {BARE_REACH_IF_PRINTED, min(bare_reach, BARE_REACH_IF_PRINTED)}, reverse=True
    ):
        near = _compute_typical_patch(corners.shorten_steps(reach), image)
        if _measure_dissimilarity(near, _model_crossings(reach)) > limit:
            continue
        whole = _compute_typical_patch(corners, image)
        bare = _measure_dissimilarity(whole, _model_crossings(_WHOLE_REACH)) <= limit
        off = _measure_dissimilarity(near, _model_crossings(reach, overlap=False))
        if bare or off <= _MAX_PRINTED_DISSIMILARITY:
            return True, bare
    return False, False


def is_plain_crossing(corners: OrientedCorners, image: GreyImage, is_printed: bool) -> bool:
    """Return whether the typical one of the corners is, nearby, the crossing of two edges in a
    point, where the squares neither overlap nor part as discs do; more strictly if something
    `is_printed` in the squares."""
    near = _compute_typical_patch(corners.shorten_steps(BARE_REACH_IF_PRINTED), image)
    crossings = _model_crossings(BARE_REACH_IF_PRINTED, overlap=False)
    limit = _MAX_PRINTED_DISSIMILARITY if is_printed else _MAX_DISSIMILARITY_ALONE
    return _measure_dissimilarity(near, crossings) <= limit


def find_crossings(corners: OrientedCorners, image: GreyImage, bare_reach: float) -> BoolArray:
    """Find the corners (n,) that, each by itself, look like a crossing of two edges as far as
    `bare_reach`, squares, and whose squares have the colours that their places require."""
    near = corners.shorten_steps(bare_reach)
    gap, contrast = compare_sectors(image, *near)
    patches = _compute_patches(image, *near, PATCH_POSITIONS, _LINEAR_LIGHT)
    crossings = _model_crossings(bare_reach, overlap=False)
    off = [_measure_dissimilarity(patch, crossings) for patch in patches]
    alternate = (contrast > 0) & (gap > _MIN_SECTOR_GAP * contrast)
    return np.asarray(alternate & (np.array(off) <= MAX_DISSIMILARITY))


def _compute_typical_patch(corners: OrientedCorners, image: GreyImage) -> Array:
    """Compute the median (k,) of the corners' patches, standardised."""
    return _compute_median_patch(_compute_patches(image, *corners, PATCH_POSITIONS, _LINEAR_LIGHT))


def _measure_dissimilarity(patch: Array, crossings: Array) -> float:
    """Measure the lack of correlation of a patch (k,) with the nearest of crossings (m, k)."""
    return float(1 - np.max(np.abs(crossings @ patch)) / len(patch))


@cache
def _model_crossings(bare_reach: float, overlap: bool = True) -> Array:
    """Compute the standardised patches (m, k) of modelled crossings.

    Args:
        bare_reach: how far from the edges the patch reaches, squares.
        overlap: False for crossings whose squares neither overlap nor part.
    """
    overlaps = _CROSSING_OVERLAPS if overlap else np.zeros(1)
    s1, s2, g = (x.reshape(-1, 1) for x in np.meshgrid(_CROSSING_BLURS, _CROSSING_BLURS, overlaps))
    a, b = 2 * bare_reach * PATCH_POSITIONS.T
    F = scipy.special.ndtr
    before, after = (F((g + sign * a) / s1) * F((g + sign * b) / s2) for sign in (1, -1))
    return _standardise(before + after - before * after, _LINEAR_LIGHT)

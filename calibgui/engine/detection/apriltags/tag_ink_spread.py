"""The spread of tags: how far their bright parts have grown over the dark ones, or the reverse.

What a camera records is no linear measure of light. Blurred edges then seem to lie farther in the
dark, with a curve of gamma 2.2 by 0.3 blurs, and clipping does the same where paper or ink reach
an end of the scale. Ink that spreads does the opposite. No outline tells: a smaller tag looks the
same. But within a tag bright cells grow outwards as the tag shrinks, so that all of its cells
together show how large it is. With x and y on the tag, sides from its upper left corner, and w(x,
y) the share of paper that is seen there, blurred, the level is

    I = p(x, y) w + q(x, y) (1 - w) + k w (1 - w) + h w',

p and q being polynomials, k the curve, and h w', of a blur that is wider, the halo of sharpening.
The cells have known edges x_j, and with the normal distribution Phi

    w = sum_ij c_ij X_j(x) X_i(y),    X_j(x) = Phi((x_j+1 - x) / s) - Phi((x_j - x) / s).

Where the tag lies aside of its fitted outline, by d(x, y), there is w - d . grad w. Changes of the
blur are unknown as well. All is linear.

As a rule one shift of all edges, d_x = e_x (x - 1/2) and likewise across y, holds for all tags: the
median of some of them. Where glare clips the paper, it differs from corner to corner: there d is
interpolated between those of the corners, and k differs over the tag.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine import kernels
from calibgui.engine.arrays import (
    Array,
    BoolArray,
    GreyImage,
    IntArray,
    compute_median,
)
from calibgui.engine.detection.apriltags.outline_model import LAST, NEXT
from calibgui.engine.detection.apriltags.outline_noise import MAX_TAGS
from calibgui.engine.detection.apriltags.tag_outlines import AROUND, NODE_PLACES, TagOutlines
from calibgui.engine.geometry import homography
from calibgui.engine.images.sampling import make_mesh, sample_image

_SAMPLES_PER_CELL = 4
"""Number of samples across a cell: as far to either side of its edges, which interpolation between
pixels then widens but does not move. With 3, shifts were up to 0.01 px off."""
_HALO = 2.5
"""Blur of the halos of sharpening, blurs of the edges. Without them shifts of sharpened boards were
up to 0.03 px off."""
_MAX_STEPS, _MAX_LAST_STEP = 4, 0.05
"""Number of times that tags are looked at, their corners moved, and the move up to which it is not
done again, px: the model is linear in it."""
_MAX_BLUR_DIFFERENCE = 0.1
"""Difference of a tag's blur from the usual one, over that, from which on it is looked at by
itself."""
_CLIPPED_SHARE = 0.3
"""Share of the paper beside a corner that has the image's greatest level where light is clipped."""
_RELATIVE_ERRORS, _RELATIVE_ERROR_ALONE = (0.1, 0.5), 0.3
"""Standard deviations of the shift of all tags over that shift, besides its scatter, where bright
parts have grown and where dark ones have, and of the moves of a tag's corners by themselves. On
rendered boards errors were up to 0.1 of shifts by gamma curves, and 0.3 to 0.5 of the other ones,
which sharpening and blurs of other shapes make."""
SIGMA_OF_MEDIAN = 1.4826 * 1.2533
"""Standard deviation of the median of n normal numbers, times the root of n, over the median of
their absolute deviations."""
_SIDE_EDGES = np.array([[0.0, 1.0], [1.0, 0.0], [0.0, 1.0], [1.0, 0.0]])
"""(4, 2) whether an edge is moved by e_x, and by e_y."""


class CornerMoves(NamedTuple):
    """The ways from the corners of n outlines to those of their tags."""

    move: Array
    """(n, 4, 2) px."""
    covariance: Array
    """(n, 4, 2, 2) px^2."""
    shift: Array
    """(2,) px, by which the edges of most lie within their tags, at the sides, and above and
    below."""


class _Tags(NamedTuple):
    """Tags of a board."""

    quads: Array
    """(n, 4, 2) px, their outlines."""
    bends: Array
    """(n, 16, 2) px, as of ``TagOutlines``."""
    dark: BoolArray
    """(n, k, k) True for the dark cells of each, the border included."""

    def select(self, index: BoolArray | IntArray) -> _Tags:
        """Select tags by a mask (n,) or by their indices (m,)."""
        return _Tags(self.quads[index], self.bends[index], self.dark[index])


def measure_corner_moves(
    image: GreyImage, outlines: TagOutlines, dark: BoolArray, gap: float
) -> CornerMoves:
    """Measure how far the corners of a board's tags lie from those of their outlines.

    Args:
        image: (h, w) grey levels, tags dark on bright or inversely.
        outlines: of n tags.
        dark: (n, k, k) True for the dark cells of each, the border included.
        gap: between tags, sides of a tag.
    """
    quads = outlines.corners
    is_unlike = abs(outlines.blur / compute_median(outlines.blur) - 1) > _MAX_BLUR_DIFFERENCE
    across = np.median(outlines.blurs[:, ::-1], axis=0)
    is_unlike |= _find_clipped(image, quads, gap)
    tags = _Tags(quads, outlines.bends, dark)
    alike = np.flatnonzero(~is_unlike) if not is_unlike.all() else np.arange(len(quads))
    index = alike[np.unique(np.linspace(0, len(alike) - 1, MAX_TAGS).round().astype(np.int64))]
    moves, _ = _measure_moves(image, tags.select(index), across, gap, is_shift=True)
    out = _list_outwards(quads[index])
    shifts = np.einsum("nkij,nki->nj", out, moves) / np.einsum("nkij,nkij->nj", out, out)
    shift = np.median(shifts, axis=0)
    deviation = np.median(abs(shifts - shift), axis=0)
    error = shift * np.where(shift > 0, *_RELATIVE_ERRORS)
    sd = np.hypot(SIGMA_OF_MEDIAN * deviation / len(index) ** 0.5, error)
    outwards = _list_outwards(quads)
    move, scaled = outwards @ shift, outwards * sd
    covariance = scaled @ scaled.swapaxes(2, 3)
    if is_unlike.any():
        moves_alone, its_covariance = _measure_moves(
            image, tags.select(is_unlike), across, gap, is_shift=False
        )
        square = np.sum(moves_alone**2, axis=2)[..., None, None]
        move[is_unlike] = moves_alone
        covariance[is_unlike] = its_covariance + _RELATIVE_ERROR_ALONE**2 * square * np.eye(2)
    return CornerMoves(move, covariance, shift)


def move_edges_outwards(quads: Array, shift: Array) -> Array:
    """Move the edges of tags (n, 4, 2) px outwards by `shift` (2,) px, see `CornerMoves`."""
    return np.asarray(quads + _list_outwards(quads) @ shift)


def _list_outwards(quads: Array) -> Array:
    """List the ways (n, 4, 2, 2) in which corners go if the edges at the sides of tags (n, 4, 2),
    and those above and below, move outwards by 1 px: the columns."""
    along = quads[:, NEXT] - quads
    along = along / np.linalg.norm(along, axis=2, keepdims=True)
    normal = np.stack([along[..., 1], -along[..., 0]], axis=2)
    both = np.stack([normal[:, LAST], normal], axis=2)
    moved = np.stack([_SIDE_EDGES[LAST], _SIDE_EDGES], axis=1)
    return np.linalg.solve(both, np.broadcast_to(moved, both.shape))


def _find_clipped(image: GreyImage, quads: Array, gap: float) -> BoolArray:
    """Find the tags (n,) beside a corner of which the paper, or the ink of a board printed bright
    on dark, has the greatest level of the image."""
    beside = np.array(
        [(gap / 2, gap / 2), (gap / 3, 0.1), (0.1, gap / 3), (gap / 2, 0), (0, gap / 2)]
    )
    within = np.array([(0.05, 0.05), (0.05, 0.1), (0.1, 0.05), (0.05, 0.15), (0.15, 0.05)])
    outwards = 2 * AROUND[:, None] - 1
    at = AROUND[:, None] + outwards * np.concatenate([beside, -within])
    n = len(quads)
    H = homography.fit_homography(np.broadcast_to(AROUND, (n, 4, 2)), quads, np.ones((n, 4)))
    places = homography.apply_homography(H, np.broadcast_to(at.reshape(-1, 2), (n, 40, 2)))
    is_greatest = sample_image(image, places).reshape(n, 4, 2, 5) >= image.max()
    return np.asarray((is_greatest.mean(axis=3) > _CLIPPED_SHARE).any(axis=(1, 2)))


def _measure_moves(
    image: GreyImage, tags: _Tags, blur: Array, gap: float, *, is_shift: bool
) -> tuple[Array, Array]:
    """Measure the moves (n, 4, 2) px of the corners of tags that are blurred by `blur` (2,) px
    along their rows and columns, and their covariances (n, 4, 2, 2) px^2; of all edges alike if it
    `is_shift`."""
    quads, moving = tags.quads.copy(), np.arange(len(tags.quads))
    covariance = np.empty((*quads.shape, 2))
    for _ in range(_MAX_STEPS):
        some = tags.select(moving)._replace(quads=quads[moving])
        step, covariance[moving] = _take_step(image, some, blur, gap, is_shift=is_shift)
        quads[moving] += np.clip(step, -blur.max(), blur.max())
        moving = moving[abs(step).max(axis=(1, 2)) > _MAX_LAST_STEP]
        if not len(moving):
            break
    return quads - tags.quads, covariance


def _take_step(
    image: GreyImage, tags: _Tags, blur: Array, gap: float, *, is_shift: bool
) -> tuple[Array, Array]:
    """Measure moves, and their covariances, to the first order; see `_measure_moves`."""
    side, quads = tags.dark.shape[1], tags.quads
    within = (np.arange(_SAMPLES_PER_CELL) + 0.5) / _SAMPLES_PER_CELL
    beside = min(gap / 2, 1 / side) * within
    inside = ((np.arange(side)[:, None] + within) / side).ravel()
    x = np.concatenate([-beside[::-1], inside, 1 + beside])
    length = np.linalg.norm(quads[:, NEXT] - quads, axis=2)
    blurs = blur / np.column_stack([length[:, ::2].mean(axis=1), length[:, 1::2].mean(axis=1)])
    n, power = len(quads), np.arange(4)
    H = homography.fit_homography(np.broadcast_to(AROUND, (n, 4, 2)), quads, np.ones((n, 4)))
    weights = x[:, None] ** power @ np.linalg.inv(NODE_PLACES[:, None] ** power)
    products = _sum_products(
        image, H, tags.bends, weights, tags.dark, x, blurs, _HALO * blurs, is_shift
    )
    by_level = products[:, :-1, -1]
    inverse = np.linalg.inv(products[:, :-1, :-1])
    unknowns = np.einsum("nij,nj->ni", inverse, by_level)
    contrast = (unknowns[:, 0] - unknowns[:, 1])[:, None]
    ways = _list_ways(quads, is_shift)
    count = ways.shape[3]
    step = np.einsum("nkij,nj->nki", ways, unknowns[:, -count:] / contrast)
    square = products[:, -1, -1] - np.einsum("ni,ni->n", unknowns, by_level)
    noise = (square / len(x) ** 2 / contrast[:, 0] ** 2)[:, None, None]
    of_unknowns = (noise * inverse[:, -count:, -count:])[:, None]
    return step, np.asarray(ways @ of_unknowns @ ways.swapaxes(2, 3))


def _list_ways(quads: Array, is_shift: bool) -> Array:
    """List the ways (n, 4, 2, m) px in which corners go by each of the m last unknowns: shifts and
    growth along x and y, or the moves of the corners along x, and those along y."""
    right = (quads[:, [1, 1, 2, 2]] - quads[:, [0, 0, 3, 3]])[..., None]
    down = (quads[:, [3, 2, 2, 3]] - quads[:, [0, 1, 1, 0]])[..., None]
    if is_shift:
        half = (AROUND - 0.5)[:, None]
        no_step = np.zeros_like(right)
        return np.concatenate(
            [no_step, no_step, half[..., :1] * right, half[..., 1:] * down], axis=3
        )
    each_corner = np.eye(4)[:, None]
    return np.concatenate([each_corner * right, each_corner * down], axis=3)


@kernels.with_kernel("tag_ink_spread", "sum_products")
def _sum_products(
    image: GreyImage,
    H: Array,
    bends: Array,
    weights: Array,
    dark: BoolArray,
    x: Array,
    blur: Array,
    wide: Array,
    is_shift: bool,
) -> Array:
    """Sum the products (n, m + 1, m + 1) of the m terms of the level, and of the level less one of
    the tag's, over all pairs of places across tags.

    Args:
        image: (h, w) grey levels.
        H: (n, 3, 3) from tags, sides, to the image, px.
        bends: (n, 16, 2) px, as of ``TagOutlines``.
        weights: (p, 4) of the lines of nodes in a bend at the places.
        dark: (n, k, k) cells.
        x: (p,) places across a tag, sides.
        blur: (n, 2) along x and along y, sides.
        wide: (n, 2) the same of the halos.
        is_shift: whether all edges of a tag are shifted alike.
    """
    levels = sample_image(image, _map_to_image(H, bends, weights, x))
    columns = _compute_columns(x, dark, blur, wide, is_shift)
    rows = np.concatenate([columns, (levels - levels.mean(axis=1, keepdims=True))[:, None]], axis=1)
    return np.asarray(rows @ rows.swapaxes(1, 2))


def _map_to_image(H: Array, bends: Array, weights: Array, x: Array) -> Array:
    """Map all pairs of places to the image (n, p^2, 2) px, bent by lenses; see `_sum_products`."""
    n = len(H)
    by_x, by_y, rest = np.moveaxis(H, 2, 0)[..., None, None]
    u, v, w = np.moveaxis(by_x * x + by_y * x[:, None] + rest, 1, 0)
    nodes = np.moveaxis(bends.reshape(n, 4, 4, 2), 3, 0)
    bend = weights @ nodes @ weights.T
    return np.stack([u / w + bend[0], v / w + bend[1]], axis=-1).reshape(n, -1, 2)


def _compute_columns(x: Array, dark: BoolArray, blur: Array, wide: Array, is_shift: bool) -> Array:
    """Compute the terms (n, m, p^2) of the level at all pairs of places, of which the first are
    those of paper and ink and the last those of `_list_ways`; see `_sum_products`."""
    paper = np.pad(~dark, ((0, 0), (1, 1), (1, 1)), constant_values=True).astype(np.float64)
    in_x, in_y = (_compute_shares(x, dark.shape[1], each) for each in blur.T)
    wide_x, wide_y = (_compute_shares(x, dark.shape[1], each)[0] for each in wide.T)

    def combine(rows: Array, cols: Array) -> Array:
        return np.asarray((rows @ paper @ cols.swapaxes(1, 2)).reshape(len(dark), -1))

    w, by_x, by_y = combine(in_y[0], in_x[0]), combine(in_y[0], in_x[1]), combine(in_y[1], in_x[0])
    at_x, at_y = (make_mesh(x, x).reshape(-1, 2) - 0.5).T
    ink = 1 - w
    terms = [
        *(w, ink, w * ink),
        *(at_x * w, at_y * w, at_x**2 * w, at_y**2 * w),
        *(at_x * ink, at_y * ink),
        *(combine(wide_y, wide_x), combine(in_y[0], in_x[2]), combine(in_y[2], in_x[0])),
    ]
    if is_shift:
        terms += [-by_x, -by_y, -at_x * by_x, -at_y * by_y]
    else:
        terms += [at_x * terms[2], at_y * terms[2], at_x * at_y * w]
        terms += [at_x**2 * ink, at_y**2 * ink, at_x * at_y * ink]
        nearness = [(0.5 - i * at_x) * (0.5 - j * at_y) for i, j in 1 - 2 * AROUND]
        terms += [-near * by for by in (by_x, by_y) for near in nearness]
    return np.stack(terms, axis=1)


def _compute_shares(x: Array, side: int, blur: Array) -> tuple[Array, Array, Array]:
    """Compute X_j at places `x` (p,) under blurs (n,), (n, p, side + 2) with the paper on both
    sides of the tag, and its first and second derivatives."""
    edges = np.concatenate([[-np.inf], np.arange(side + 1) / side, [np.inf]])
    s = blur[:, None, None]
    z = (edges - x[:, None]) / s
    density = np.exp(-(z**2) / 2) / (np.sqrt(2 * np.pi) * s)
    turn = np.where(np.isfinite(z), z, 0.0) * density / s
    return np.diff(scipy.special.ndtr(z)), -np.diff(density), -np.diff(turn)

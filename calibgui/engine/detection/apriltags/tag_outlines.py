"""The corners of tags from the outlines of their borders, at the Cramer-Rao bound.

A tag whose corners nothing dark touches has no edges that cross there, and no saddle points. The
whole outline then tells where its corners are (``outline_model``). Its unknowns are found by
Gauss-Newton steps, all tags at once: first of each tag by itself. Its bows are hardly told from its
corners then, which are half as uncertain again as with known bows. But the corners of all tags show
the lens (`grid_map`), and the lens bends every edge: these bows enter the last steps, trusted as
far as they agree with the tags' own.

By the inverse of the normal equations follow the covariances of the corners; to these is added by
how much edges that are bent far may differ from parabolas. The corners at both ends of an edge
share it, so that they correlate, by about -1/2 across it; the covariance of each by itself is
right. As at a crossing of edges (``x_corner_fit``) light moves the pattern, and it is moved back.
The ink's spread cannot be told from larger tags with a smaller gap, and is not.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from typing import NamedTuple

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, GreyImage, IntArray, compute_median
from calibgui.engine.corner_fit.x_corner_model import MAX_SHARP_BLUR, MIN_BLUR
from calibgui.engine.detection.apriltags.outline_model import (
    LAST,
    NEXT,
    UNKNOWNS,
    OutlineModel,
    accumulate_normal_equations,
)
from calibgui.engine.detection.apriltags.outline_noise import estimate_outline_growth
from calibgui.engine.detection.apriltags.tag_gap import measure_gap_of_tags
from calibgui.engine.features.pixel_noise import ROUNDING_VARIANCE
from calibgui.engine.geometry import homography
from calibgui.engine.images.sampling import make_mesh, sample_image
from calibgui.engine.lattices import grid_map
from calibgui.engine.lattices.grid_map import RadialHomography

_MAX_FREE_STEPS, _LAST_STEPS = 8, 2
"""Numbers of steps, each tag by itself, and with the bows that the lens of all tags gives them."""
_CLOSE_STEP, _CONVERGED_STEP = 0.15, 0.05
"""Steps of a tag's corners up to which the next, of second order, is 0.005 px, which the last steps
take up, and up to which it is nothing, px."""
_START_ROUNDS = 2
"""Number of times that edges are moved to where their profiles rise before the first step."""
_PROFILES, _SHADED_PROFILES = (12, 17), (24, 33)
"""Numbers of profiles of an edge and of the samples of each: for a start, from which steps follow,
and where the image is shaded, from which none do."""
_PARTS = 3
"""Number of parts of an edge whose profiles are averaged: as many as the ways in which it moves."""
_ALONG_MARGIN = 0.15
"""Part of an edge at both ends that has no profiles, lengths: the corners are blurred."""
_PROFILE_REACH = 0.75
"""Reach of a profile to either side, over the narrower of border and gap: what follows these is
blurred into its ends."""
_NEAR_BLURS, _NEAR_MARGIN = 3.0, 1.0
"""Greatest reach of a profile once the edge is found: blurs, and px in addition."""
_MAX_OVERSHOOT = 0.25
"""Greatest distance of a profile beyond its levels of paper and ink, over their difference: if it
is cut off there noise passes for blur."""
_INTERPOLATION = 1 / 6
"""Variance of the blur of linear interpolation between pixels, px^2."""
_BLUR_REACH, _BLUR_REACH_MARGIN = 3.0, 0.35
"""Distance over which the blur of what follows the border or the gap is felt: blurs, and px in
addition. With 1.5 blurs corners of tags of 40 px under a blur of 2 px lay 0.06 px outside; now less
than 0.01."""
_MIN_BAND_BLURS = 1.0
"""Least half width of the band that is read along an edge, blurs."""
_USUAL_BOW = 0.05
"""Standard deviation of bows before anything is known of the lens, lengths of the edge."""
_USUAL_CORRELATION, _MAX_CORRELATION = 0.5, 0.95
"""Standard deviation of the correlation of the blurs across neighbouring edges before anything is
known of it, and its greatest magnitude: that of long motion along a diagonal is nearly 1."""
_MEDIAN_CHI_SQUARE = 0.455
"""Median of the square of a normal variable of variance 1."""
_LENS_UNKNOWNS = 4
"""Number of unknowns of a lens: bows that are as many show nothing of its misfit."""
_DAMPING = 1e-9
"""Number that is added to the diagonal of the normal equations, over its largest entry."""
AROUND = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
"""(4, 2) corners of a tag from its upper left one, sides."""
NODE_PLACES = np.arange(4) / 3
"""(4,) places across a tag between which the lens is interpolated, sides."""
NODES = make_mesh(NODE_PLACES, NODE_PLACES).reshape(-1, 2)
"""(16, 2) of all pairs of these, row by row."""
_CORNER_NODES = [0, 3, 15, 12]
"""Indices of the tag's corners among them."""


@dataclass(frozen=True, eq=False, slots=True)
class TagOutlines:
    """The outlines fitted to n tags."""

    corners: Array
    """(n, 4, 2) px."""
    covariance: Array
    """(n, 4, 2, 2) of each corner, px^2."""
    blurs: Array
    """(n, 2) across the first and third, and the second and fourth edges, pixel included, px."""
    blur: Array
    """(n,) their root mean square, px."""
    contrast: Array
    """(n,) paper minus ink, grey levels; negative for bright tags on dark."""
    residual: Array
    """(n,) standard deviation of what the model leaves unexplained, grey levels."""
    lens_bows: Array
    """(n, 4) px, the bows that the lens of all tags gives the edges."""
    bends: Array
    """(n, 16, 2) px, by how much the lens moves the `NODES` of each from where the homography of
    its corners has them."""


def fit_tag_outlines(
    image: GreyImage, corners: Array, squares: IntArray, border: float, gap: float
) -> TagOutlines:
    """Fit the outlines of tags.

    Args:
        image: (h, w) grey levels.
        corners: (n, 4, 2) px, clockwise from the upper left, good to a part of the border.
        squares: (n, 2) rows and columns of the tags on the board, from 0.
        border: width of the tags' border, sides.
        gap: between tags, sides, roughly.
    """
    model = _estimate_start(image, corners, border, gap)
    n = len(corners)
    usual = _Prior(
        np.zeros((n, 4)),
        _USUAL_BOW * model.measure_edges()[0],
        np.zeros(n),
        np.full(n, _USUAL_CORRELATION),
    )
    noise = np.full(n, ROUNDING_VARIANCE)
    model, equations, square = _take_steps(image, model, usual, noise, _MAX_FREE_STEPS, _CLOSE_STEP)
    noise = np.maximum(square, ROUNDING_VARIANCE)
    places = _locate_corners(squares, measure_gap_of_tags(squares, model.corners, gap))
    variance = noise[:, None] * np.einsum("nkk->nk", _invert_part(equations, slice(16, 21)))
    bows, bow_sd, board = _estimate_bows(model, variance[:, :4], places)
    prior = _Prior(bows, bow_sd, *_pool_correlations(model.correlation, variance[:, 4]))
    model, equations, square = _take_steps(image, model, prior, noise, _LAST_STEPS, _CONVERGED_STEP)
    noise = np.maximum(square, ROUNDING_VARIANCE)
    growth = estimate_outline_growth(image, model, noise)
    pairs = _invert_part(equations, slice(8)).reshape(-1, 4, 2, 4, 2)
    covariance = np.stack([pairs[:, i, :, i] for i in range(4)], axis=1)
    contrast = model.levels[:, 0] - model.levels[:, 1]
    rise = contrast[:, 1:] / (contrast[:, :1] * model.half[:, None])
    variance = np.mean(model.blurs**2, axis=1)
    return TagOutlines(
        corners=model.corners + (variance[:, None] * rise)[:, None],
        covariance=growth * noise[:, None, None, None] * covariance
        + _compute_bend_covariances(model),
        blurs=model.blurs,
        blur=np.sqrt(variance),
        contrast=contrast[:, 0],
        residual=np.sqrt(square),
        lens_bows=prior.bows,
        bends=_compute_bends(board, places[:, 0]),
    )


def follow_shaded_outlines(
    image: GreyImage, corners: Array, bows: Array, border: float, gap: float
) -> Array:
    """Move the edges of tags to where their profiles rise, each third of an edge by its own levels
    of paper and ink: the edge of a shadow or a reflection across a tag misleads a fit of all of it.

    Args:
        image: (h, w) grey levels.
        corners: (n, 4, 2) px, as of `fit_tag_outlines`.
        bows: (n, 4) px, of the edges.
        border: width of the tags' border, sides.
        gap: between tags, sides, roughly.

    Returns:
        The corners (n, 4, 2) px.
    """
    model = replace(_start_from(corners), bows=bows)
    reach = _PROFILE_REACH * min(border, gap) * _measure_heights(model)
    for _ in range(_START_ROUNDS):
        _, offset, _ = _measure_profiles(image, model, reach, is_shaded=True)
        model = _move_edges(model, offset)
    return model.corners


def _measure_heights(model: OutlineModel) -> Array:
    """Measure the least heights (n,) px of tags over their edges."""
    _, _, normal = model.measure_edges()
    across = np.sum((model.corners[:, [2, 3, 0, 1]] - model.corners) * normal, axis=2)
    return np.asarray(across.min(axis=1))


def _locate_corners(squares: IntArray, gap: float) -> Array:
    """Return (X, Y) (n, 4, 2) on the board of the corners of the tags at `squares` (n, 2), sides of
    a tag."""
    return (1 + gap) * squares[:, None, ::-1] + AROUND


def _start_from(corners: Array) -> OutlineModel:
    """Return the model of tags with straight edges between `corners` (n, 4, 2)."""
    n = len(corners)
    unknown = np.ones(n)
    return OutlineModel(
        corners,
        np.ones((n, 2)),
        np.zeros((n, 2, 3)),
        np.zeros((n, 4)),
        np.zeros(n),
        unknown,
        unknown,
        unknown,
    )


def _estimate_start(image: GreyImage, corners: Array, border: float, gap: float) -> OutlineModel:
    """Estimate the model from profiles across the edges, to whose rise these are moved."""
    model = _start_from(corners)
    side = _measure_heights(model)
    reach = _PROFILE_REACH * min(border, gap) * side
    near = reach
    for _ in range(_START_ROUNDS):
        ends, offset, variance = _measure_profiles(image, model, near)
        model = _move_edges(model, offset)
        variance = (variance[:, :2] + variance[:, 2:]) / 2
        blurs = np.clip(np.sqrt(np.maximum(variance, 0)), MIN_BLUR, near[:, None] / 2)
        near = np.minimum(near, _NEAR_BLURS * blurs.max(axis=1) + _NEAR_MARGIN)
    levels = np.zeros((len(corners), 2, 3))
    levels[..., 0] = ends
    blur = blurs.mean(axis=1)
    felt, least = _BLUR_REACH * blur + _BLUR_REACH_MARGIN, _MIN_BAND_BLURS * blur
    return replace(
        model,
        blurs=blurs,
        levels=levels,
        inwards=np.maximum(border * side - felt, least),
        outwards=np.maximum(gap * side - felt, least),
        half=side / 2,
    )


def _compute_bends(board: RadialHomography, first: Array) -> Array:
    """Compute the bends (n, 16, 2) px of tags whose upper left corners are at `first` (n, 2) on the
    board, sides of a tag; see `TagOutlines`."""
    seen = board.locate((first[:, None] + NODES).reshape(-1, 2)).reshape(-1, len(NODES), 2)
    corners = seen[:, _CORNER_NODES]
    n = len(first)
    H = homography.fit_homography(np.broadcast_to(AROUND, (n, 4, 2)), corners, np.ones((n, 4)))
    return seen - homography.apply_homography(H, np.broadcast_to(NODES, seen.shape))


class _Prior(NamedTuple):
    """Expected bows and correlations of k tags, with their standard deviations."""

    bows: Array
    """(k, 4) px."""
    bow_sd: Array
    """(k, 4) px."""
    correlation: Array
    """(k,)"""
    correlation_sd: Array
    """(k,)"""

    def select(self, index: IntArray) -> _Prior:
        """Select the tags `index` (m,)."""
        return _Prior(*(values[index] for values in self))


def _estimate_bows(
    model: OutlineModel, variance: Array, places: Array
) -> tuple[Array, Array, RadialHomography]:
    """Estimate bows from the lens that the corners of all tags show; how far they are from those
    that were found for each tag by itself tells how well they are known.

    Args:
        model: of n tags.
        variance: (n, 4) of its bows, px^2.
        places: (n, 4, 2) of the corners on the board, sides of a tag.

    Returns:
        The bows (n, 4) px, their standard deviations (n, 4) px, and the map from the board to the
        image from which they follow.
    """
    board = grid_map.fit_radial_homography(
        places.reshape(-1, 2), model.corners.reshape(-1, 2), are_exact=True
    )
    seen, middle = (
        board.locate(at.reshape(-1, 2)).reshape(-1, 4, 2)
        for at in (places, (places + places[:, NEXT]) / 2)
    )
    along = seen[:, NEXT] - seen
    normal = np.stack([-along[..., 1], along[..., 0]], axis=2)
    normal /= np.linalg.norm(along, axis=2, keepdims=True)
    bows = np.sum(((seen + seen[:, NEXT]) / 2 - middle) * normal, axis=2)
    length = model.measure_edges()[0]
    square = (model.bows - bows) ** 2
    misfit, noise = (compute_median((each / length**2).ravel()) for each in (square, variance))
    usual = max(misfit / _MEDIAN_CHI_SQUARE - noise, noise * _LENS_UNKNOWNS / square.size)
    return bows, np.sqrt(usual) * length, board


def _pool_correlations(found: Array, variance: Array) -> tuple[Array, Array]:
    """Pool the correlations (n,) that were found for each tag by itself, with their `variance`
    (n,): a camera shakes all tags much alike. Return what each is expected to have, and the
    standard deviation of that."""
    usual = float(compute_median(found))
    square = float(compute_median((found - usual) ** 2)) / _MEDIAN_CHI_SQUARE
    noise = float(compute_median(variance))
    spread = max(square - noise, 0.0) + noise / len(found)
    return np.full(len(found), usual), np.full(len(found), np.sqrt(spread))


def _invert_part(equations: Array, part: slice) -> Array:
    """Compute the `part` of the inverse of equations (n, 21, 21) that holds the covariances of its
    unknowns, over the noise."""
    wanted = np.eye(UNKNOWNS)[:, part]
    wanted = np.broadcast_to(wanted, (len(equations), *wanted.shape))
    return np.asarray(np.linalg.solve(equations, wanted)[:, part])


def _measure_profiles(
    image: GreyImage, model: OutlineModel, reach: Array, *, is_shaded: bool = False
) -> tuple[Array, Array, Array]:
    """Measure the profiles across edges, `reach` (n,) px to both sides.

    A profile that rises from 0 to 1 is the distribution of the edge's blur; its moments follow by
    integration by parts. Where the image `is_shaded`, each profile has levels of its own, and bows
    stay as they are.

    Returns:
        Levels (n, 2) of paper and ink, offsets (n, 4, 3) px inwards of the edges at their beginning
        and end, and of their middle from the chord, and variances (n, 4) px^2 of their blur.
    """
    layout = _lay_out_profiles(is_shaded)
    samples = len(layout.integration)
    seen = _average_profiles(image, model, reach, layout.shares, samples)
    n, quarter = len(seen), samples // 4
    shape = (n, *seen.shape[1:3], 1) if is_shaded else (n, 1, 1, 1)
    paper, ink = (
        compute_median(ends.reshape(*shape[:-1], -1)).reshape(shape)
        for ends in (seen[..., :quarter], seen[..., -quarter:])
    )
    swing = np.where(ink == paper, 1.0, ink - paper)
    beyond = 0.0 if is_shaded else _MAX_OVERSHOOT
    rise = np.clip((seen - paper) / swing, -beyond, 1 + beyond)
    integral, moment = np.moveaxis(rise @ layout.integration, 3, 0)
    mean, square = 1 - integral, 1 - 2 * moment
    variance = reach[:, None] ** 2 * (square - mean**2).mean(axis=2) - _INTERPOLATION
    offset = np.zeros((*mean.shape[:2], 3))
    weights = layout.weights
    offset[..., : weights.shape[1]] = reach[:, None, None] * mean @ weights
    levels = [compute_median(each.reshape(n, -1)) for each in (paper, ink)]
    return np.column_stack(levels), offset, variance


class _ProfileLayout(NamedTuple):
    """Places and weights of the profiles across an edge."""

    shares: Array
    """(m,) where they lie along the edge, lengths."""
    integration: Array
    """(samples, 2) weights of the integral over a profile from -1 to 1, and of that times the
    place, by the trapezoidal rule."""
    weights: Array
    """(parts, k) of the offsets of an edge's parts in those of its chord's ends and, if k is 3, in
    its bow: each part feels them all."""


@cache
def _lay_out_profiles(is_shaded: bool) -> _ProfileLayout:
    """Lay out the profiles of an edge, whose bow stays as it is where the image is shaded."""
    count, samples = _SHADED_PROFILES if is_shaded else _PROFILES
    shares = np.linspace(_ALONG_MARGIN, 1 - _ALONG_MARGIN, count)
    integration = np.ones((samples, 2)) * 2 / (samples - 1)
    integration[[0, -1]] /= 2
    integration[:, 1] *= np.linspace(-1, 1, samples)
    moves = np.stack([1 - shares, shares, 4 * shares * (1 - shares)], axis=1)
    felt = moves.reshape(_PARTS, -1, 3).mean(axis=1)
    weights = np.linalg.pinv(felt[:, :2] if is_shaded else felt).T
    return _ProfileLayout(shares, integration, np.asarray(weights))


@kernels.with_kernel("tag_outlines", "average_profiles")
def _average_profiles(
    image: GreyImage, model: OutlineModel, reach: Array, share: Array, samples: int
) -> Array:
    """Average the grey levels of profiles across the edges over each third of these.

    Args:
        image: (h, w) grey levels.
        model: of n tags.
        reach: (n,) px, how far profiles reach to both sides.
        share: (m,) where along an edge they are taken, lengths.
        samples: number of samples of each.

    Returns:
        (n, 4, 3, samples)
    """
    at = model.locate_profiles(reach, share, samples)
    thirds = (*at.shape[:2], _PARTS, len(share) // _PARTS, samples)
    return np.asarray(sample_image(image, at).reshape(thirds).mean(axis=3))


def _move_edges(model: OutlineModel, offset: Array) -> OutlineModel:
    """Return the model after edges were moved inwards by `offset` (n, 4, 3) px at their beginning
    and end, and their middle from the chord."""
    _, _, normal = model.measure_edges()
    both = np.stack([normal[:, LAST], normal], axis=2)
    moved = np.stack([offset[:, LAST, 1], offset[..., 0]], axis=2)
    corners = model.corners + np.linalg.solve(both, moved[..., None])[..., 0]
    return replace(model, corners=corners, bows=model.bows - offset[..., 2])


def _compute_bend_covariances(model: OutlineModel) -> Array:
    """Compute the covariances (n, 4, 2, 2) px^2 of corners whose edges are no parabolas: the next
    terms are of the size of the bow's square over the length."""
    length, _, normal = model.measure_edges()
    aside = (model.bows**2 / length)[..., None] * normal
    of_edge = aside[..., :, None] * aside[..., None, :]
    return np.asarray(of_edge + of_edge[:, LAST])


def _take_steps(
    image: GreyImage, model: OutlineModel, prior: _Prior, noise: Array, steps: int, enough: float
) -> tuple[OutlineModel, Array, Array]:
    """Take Gauss-Newton steps until they are small.

    Args:
        image: (h, w) grey levels.
        model: of n tags.
        prior: what is known of bows and correlations.
        noise: (n,) variance of the grey levels, by which that counts.
        steps: their number, at most.
        enough: step of a tag's corners up to which it takes no other, px.

    Returns:
        The model after them, the last equations (n, 21, 21), and the mean square (n,) of what is
        left unexplained.
    """
    n = len(model.corners)
    equations, square = np.empty((n, UNKNOWNS, UNKNOWNS)), np.empty(n)
    moving = np.arange(n)
    for _ in range(steps):
        is_sharp = bool(compute_median(model.blurs.ravel()) < MAX_SHARP_BLUR)
        some = model.select(moving)
        products = accumulate_normal_equations(image, some, is_sharp)
        after, equations[moving], square[moving] = _take_step(
            some, products, prior.select(moving), noise[moving]
        )
        model = model.put(moving, after)
        moving = moving[abs(after.corners - some.corners).max(axis=(1, 2)) > enough]
        if not len(moving):
            break
    return model, equations, square


def _take_step(
    model: OutlineModel, products: Array, prior: _Prior, noise: Array
) -> tuple[OutlineModel, Array, Array]:
    """Take one Gauss-Newton step.

    Args:
        model: of n tags.
        products: (n, 22, 22) of its columns.
        prior: what is known of bows and correlations.
        noise: (n,) variance of the grey levels, by which that counts.

    Returns:
        The model after it, its equations (n, 21, 21), and the mean square (n,) of what is left
        unexplained.
    """
    N, g = products[:, :UNKNOWNS, :UNKNOWNS], products[:, :UNKNOWNS, UNKNOWNS]
    weight = np.zeros(g.shape)
    weight[:, 16:20] = noise[:, None] / prior.bow_sd**2
    weight[:, 20] = noise / prior.correlation_sd**2
    pull = np.zeros(g.shape)
    pull[:, 16:20] = weight[:, 16:20] * (prior.bows - model.bows)
    pull[:, 20] = weight[:, 20] * (prior.correlation - model.correlation)
    largest = np.einsum("nkk->nk", N).max(axis=1) + 1e-300
    diagonal = weight + _DAMPING * largest[:, None]
    equations = N + diagonal[:, None] * np.eye(UNKNOWNS)
    step = np.linalg.solve(equations, (g + pull)[..., None])[..., 0]
    explained = np.sum(step * (2 * g - np.einsum("nij,nj->ni", N, step)), axis=1)
    square = products[:, UNKNOWNS, UNKNOWNS] - explained
    count = N[:, 10, 10] + N[:, 13, 13] + 2 * N[:, 10, 13]
    square = np.maximum(square, 0.0) / np.maximum(count - UNKNOWNS, 1)
    blurs = model.blurs
    changed = np.clip(step[:, 8:10], np.maximum(-blurs / 3, MIN_BLUR - blurs), blurs / 2)
    stepped = replace(
        model,
        corners=model.corners + np.clip(step[:, :8], -1.0, 1.0).reshape(-1, 4, 2),
        blurs=blurs + changed,
        levels=model.levels + step[:, 10:16].reshape(-1, 2, 3),
        bows=model.bows + np.clip(step[:, 16:20], -1.0, 1.0),
        correlation=np.clip(model.correlation + step[:, 20], -_MAX_CORRELATION, _MAX_CORRELATION),
    )
    return stepped, equations, square

"""The corners of tags from the outlines of their borders, at the Cramer-Rao bound.

A tag whose corners nothing dark touches has no edges that cross there, and no saddle points. The
whole outline then tells where its corners are: four edges from corner to corner, bent as the
map of all tags says (`grid_map`). With p_i the corners, clockwise from the upper left one, edge i
runs from p_i to p_i+1 in the direction t_i over a length L_i, with its normal n_i inwards. A point
q lies at s_i = t_i.(q - p_i) along it and within it by

    d_i = n_i.(q - p_i) + kappa_i s_i (L_i - s_i) / 2,

kappa_i being the curvature towards n_i. Blurred, the share of ink near the corner of edges i and j
is that of a quarter of the plane,

    Q = (1 + E_i + E_j + G(d_i, d_j)) / 4,

with the blurred edge E and the blurred crossing G of ``edge_intensity``; far from the corner this
is (1 + E_i) / 2. Paper and border each have a level that varies linearly over the tag, and

    I(q) = paper(q) (1 - Q) + ink(q) Q.

The unknowns of a tag, its corners (8), the blurs of its first and third and of its second and
fourth edge, and the two levels with their gradients (6), are found by Gauss-Newton steps, all tags
at once. By the inverse of the normal equations follow the covariances of the corners. The corners
at both ends of an edge share it, so that they correlate, by about -1/2 across it; the covariance of
each by itself is right. As at a crossing of edges (``x_corner_fit``) light moves the pattern, and
it is moved back. The ink's spread cannot be told from larger tags with a smaller gap, and is not.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, BoolArray, FloatImage, GreyImage, IntArray
from calibgui.engine.detection import grid_map
from calibgui.engine.detection.apriltags.tag_gap import measure_gap_of_tags
from calibgui.engine.detection.detector_io import estimate_least_noise
from calibgui.engine.detection.edge_intensity import EdgeIntensity, compute_edge
from calibgui.engine.images.sampling import sample_image

_GAUSS_NEWTON_STEPS = 3
"""Number of steps. A fourth changes the errors of no condition of the benchmark by 0.1 %."""
_START_ROUNDS = 2
"""Number of times that edges are moved to where their profiles rise before the first step."""
_SAMPLES_ALONG, _SAMPLES_ACROSS = 24, 33
"""Numbers of samples of a profile, along its edge and across it."""
_ALONG_MARGIN = 0.15
"""Part of an edge at both ends that its profile leaves out, lengths: the corners are blurred."""
_PROFILE_REACH = 0.75
"""Reach of a profile to either side, over the narrower of border and gap: what follows these is
blurred into its ends."""
_BAND_BLURS, _BAND_MARGIN = 2.3, 0.7
"""Half width of the band that is read along an edge: blurs, and px in addition."""
_BLUR_REACH = 3.0
"""Distance, in blurs, over which the blur of what follows the border or the gap is felt. With 1.5
corners of tags of 40 px under a blur of 2 px lay 0.06 px outside; now less than 0.01."""
_MIN_BAND_BLURS = 1.0
"""Least such half width, blurs."""
_MIN_BLUR = 0.3
"""Least blur, px: that of the pixel alone is 0.29."""
_MAX_SHARP_BLUR = 0.6
"""Median blur below which the pixel's own shape matters, px."""
_MAX_PIXELS_AT_ONCE = 40_000
"""Number of pixels fitted at once."""
_UNKNOWNS = 16
"""Number of unknowns of a tag: corners 0 to 7, blurs 8 and 9, paper 10 to 12, ink 13 to 15."""
_DAMPING = 1e-9
"""Number that is added to the diagonal of the normal equations, over its largest entry."""
AROUND = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
"""(4, 2) corners of a tag from its upper left one, sides."""
_NEXT, _LAST = np.array([1, 2, 3, 0]), np.array([3, 0, 1, 2])
"""Edges that begin where each of the four ends, and that end where it begins."""


@dataclass(frozen=True, eq=False, slots=True)
class TagOutlines:
    """The outlines fitted to n tags."""

    corners: Array
    """(n, 4, 2) px."""
    covariance: Array
    """(n, 4, 2, 2) of each corner, px^2."""
    blur: Array
    """(n,) root mean square of the blurs, pixel included, px."""
    contrast: Array
    """(n,) paper minus ink, grey levels; negative for bright tags on dark."""
    residual: Array
    """(n,) standard deviation of what the model leaves unexplained, grey levels."""


@dataclass(frozen=True, eq=False, slots=True)
class _Model:
    """The model of k tags."""

    corners: Array
    """(k, 4, 2) px."""
    blurs: Array
    """(k, 2) px."""
    levels: Array
    """(k, 2, 3) of paper and ink: the level in the tag's middle and its rise over `half` px to the
    right and down."""
    curvature: Array
    """(k, 4) 1/px."""
    inwards: Array
    """(k,) how far the border is read inwards, px."""
    outwards: Array
    """(k,) how far the paper is read outwards, px."""
    half: Array
    """(k,) half the side of the tag, px."""

    def select(self, index: IntArray) -> _Model:
        """Select the tags `index` (m,)."""
        return _Model(
            *(
                values[index]
                for values in (
                    self.corners,
                    self.blurs,
                    self.levels,
                    self.curvature,
                    self.inwards,
                    self.outwards,
                    self.half,
                )
            )
        )

    def measure_edges(self) -> tuple[Array, Array, Array]:
        """Measure the lengths (k, 4) px, tangents and inward normals (k, 4, 2) of the edges."""
        along = self.corners[:, _NEXT] - self.corners
        length = np.linalg.norm(along, axis=2)
        t = along / length[..., None]
        return length, t, np.stack([-t[..., 1], t[..., 0]], axis=2)

    def measure_bands(self) -> Array:
        """Measure how far (k, 4, 2) px the edges are read outwards and inwards."""
        width = _BAND_BLURS * self.blurs[:, [0, 1, 0, 1], None] + _BAND_MARGIN
        return np.minimum(width, np.column_stack([self.outwards, self.inwards])[:, None])


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
    model = _estimate_start(image, corners, _locate_corners(squares, gap), border, gap)
    places = _locate_corners(squares, measure_gap_of_tags(squares, model.corners, gap))
    for _ in range(_GAUSS_NEWTON_STEPS):
        model = replace(model, curvature=_estimate_curvatures(model.corners, places))
        is_sharp = bool(np.median(model.blurs) < _MAX_SHARP_BLUR)
        products = _accumulate_normal_equations(image, model, is_sharp)
        model, inverse, square = _take_step(model, products)
    noise = np.maximum(square, estimate_least_noise(image))
    pairs = inverse[:, :8, :8].reshape(-1, 4, 2, 4, 2)
    covariance = np.stack([pairs[:, i, :, i] for i in range(4)], axis=1)
    contrast = model.levels[:, 0] - model.levels[:, 1]
    rise = contrast[:, 1:] / (contrast[:, :1] * model.half[:, None])
    variance = np.mean(model.blurs**2, axis=1)
    return TagOutlines(
        corners=model.corners + (variance[:, None] * rise)[:, None],
        covariance=noise[:, None, None, None] * covariance,
        blur=np.sqrt(variance),
        contrast=contrast[:, 0],
        residual=np.sqrt(square),
    )


def follow_shaded_outlines(
    image: GreyImage, corners: Array, squares: IntArray, border: float, gap: float
) -> Array:
    """Move the edges of tags to where their profiles rise, each half of an edge by its own levels
    of paper and ink: the edge of a shadow or a reflection across a tag misleads a fit of all of it.

    The arguments are those of `fit_tag_outlines`; the corners (n, 4, 2) px are returned.
    """
    n, unknown = len(corners), np.ones(len(corners))
    curvature = _estimate_curvatures(corners, _locate_corners(squares, gap))
    model = _Model(
        corners, np.ones((n, 2)), np.zeros((n, 2, 3)), curvature, unknown, unknown, unknown
    )
    reach = _PROFILE_REACH * min(border, gap) * _measure_heights(model)
    for _ in range(_START_ROUNDS):
        _, offset, _ = _measure_profiles(image, model, reach, is_shaded=True)
        model = replace(model, corners=_move_edges(model, offset))
    return model.corners


def _measure_heights(model: _Model) -> Array:
    """Measure the least heights (n,) px of tags over their edges."""
    _, _, normal = model.measure_edges()
    across = np.sum((model.corners[:, [2, 3, 0, 1]] - model.corners) * normal, axis=2)
    return np.asarray(across.min(axis=1))


def _locate_corners(squares: IntArray, gap: float) -> Array:
    """Return (X, Y) (n, 4, 2) on the board of the corners of the tags at `squares` (n, 2), sides of
    a tag."""
    return (1 + gap) * squares[:, None, ::-1] + AROUND


def _estimate_curvatures(corners: Array, places: Array) -> Array:
    """Estimate the curvatures (n, 4) 1/px of the edges, towards their inward normals, from how far
    the lens that all corners show bends them in their middles.

    A lens alone: a curvature moves the corners that it is estimated from, and a freer map, with a
    polynomial, would follow them from step to step.
    """
    board = grid_map.fit_radial_homography(
        places.reshape(-1, 2), corners.reshape(-1, 2), are_exact=True
    )
    seen, middle = (
        board.locate(at.reshape(-1, 2)).reshape(-1, 4, 2)
        for at in (places, (places + places[:, _NEXT]) / 2)
    )
    along = seen[:, _NEXT] - seen
    normal = np.stack([-along[..., 1], along[..., 0]], axis=2)
    square = np.sum(along**2, axis=2)
    bow = np.sum((middle - (seen + seen[:, _NEXT]) / 2) * normal, axis=2)
    return np.asarray(-8 * bow / square**1.5)


def _estimate_start(
    image: GreyImage, corners: Array, places: Array, border: float, gap: float
) -> _Model:
    """Estimate the model from profiles across the edges, to whose rise these are moved."""
    n = len(corners)
    curvature = _estimate_curvatures(corners, places)
    unknown = np.ones(n)
    model = _Model(
        corners, np.ones((n, 2)), np.zeros((n, 2, 3)), curvature, unknown, unknown, unknown
    )
    side = _measure_heights(model)
    reach = _PROFILE_REACH * min(border, gap) * side
    for _ in range(_START_ROUNDS):
        ends, offset, variance = _measure_profiles(image, model, reach)
        model = replace(model, corners=_move_edges(model, offset))
    variance = (variance[:, :2] + variance[:, 2:]) / 2
    blurs = np.clip(np.sqrt(np.maximum(variance, 0)), _MIN_BLUR, reach[:, None] / 2)
    levels = np.zeros((n, 2, 3))
    levels[..., 0] = ends
    felt, least = (share * blurs.mean(axis=1) for share in (_BLUR_REACH, _MIN_BAND_BLURS))
    return replace(
        model,
        blurs=blurs,
        levels=levels,
        inwards=np.maximum(border * side - felt, least),
        outwards=np.maximum(gap * side - felt, least),
        half=side / 2,
    )


def _measure_profiles(
    image: GreyImage, model: _Model, reach: Array, *, is_shaded: bool = False
) -> tuple[Array, Array, Array]:
    """Measure the profiles across edges, `reach` (n,) px to both sides.

    A profile that rises from 0 to 1 is the distribution of the edge's blur; its moments follow by
    integration by parts. Where the image `is_shaded`, each profile has levels of its own.

    Returns:
        Levels (n, 2) of paper and ink, offsets (n, 4, 2) px inwards of the edges at their beginning
        and end, and variances (n, 4) px^2 of their blur.
    """
    share = np.linspace(_ALONG_MARGIN, 1 - _ALONG_MARGIN, _SAMPLES_ALONG)
    seen = _average_profiles(image, model, reach, share, _SAMPLES_ACROSS)
    quarter = _SAMPLES_ACROSS // 4
    axes = (3,) if is_shaded else (1, 2, 3)
    paper = np.median(seen[..., :quarter], axis=axes, keepdims=True)
    ink = np.median(seen[..., -quarter:], axis=axes, keepdims=True)
    swing = np.where(ink == paper, 1.0, ink - paper)
    rise = np.clip((seen - paper) / swing, 0.0, 1.0)
    across = np.linspace(-1, 1, _SAMPLES_ACROSS)
    mean = 1 - np.trapezoid(rise, across, axis=3)
    square = 1 - 2 * np.trapezoid(across * rise, across, axis=3)
    variance = reach[:, None] ** 2 * (square - mean**2).mean(axis=2)
    middle, slope = reach[:, None] * mean.mean(axis=2), reach[:, None] * np.diff(mean)[..., 0]
    lever = slope / (1 - 2 * _ALONG_MARGIN)
    ends = np.stack([middle - lever, middle + lever], axis=2)
    levels = [np.median(each, axis=(1, 2, 3)) for each in (paper, ink)]
    return np.column_stack(levels), ends, variance


@kernels.with_kernel("tag_outlines", "average_profiles")
def _average_profiles(
    image: GreyImage, model: _Model, reach: Array, share: Array, samples: int
) -> Array:
    """Average the grey levels of profiles across the edges over either half of these.

    Args:
        image: (h, w) grey levels.
        model: of n tags.
        reach: (n,) px, how far profiles reach to both sides.
        share: (m,) where along an edge they are taken, lengths.
        samples: number of samples of each.

    Returns:
        (n, 4, 2, samples)
    """
    length, t, normal = model.measure_edges()
    s = length[..., None] * share
    bow = -model.curvature[..., None] * s * (length[..., None] - s) / 2
    d = reach[:, None, None, None] * np.linspace(-1, 1, samples)
    at = model.corners[:, :, None] + s[..., None] * t[:, :, None]
    at = at[..., None, :] + (bow[..., None] + d)[..., None] * normal[:, :, None, None]
    halves = (*at.shape[:2], 2, len(share) // 2, samples)
    return np.asarray(sample_image(image, at).reshape(halves).mean(axis=3))


def _move_edges(model: _Model, offset: Array) -> Array:
    """Return the corners (n, 4, 2) after edges were moved inwards by `offset` (n, 4, 2) px at their
    beginning and end."""
    _, _, normal = model.measure_edges()
    both = np.stack([normal[:, _LAST], normal], axis=2)
    moved = np.stack([offset[:, _LAST, 1], offset[..., 0]], axis=2)
    return np.asarray(model.corners + np.linalg.solve(both, moved[..., None])[..., 0])


@kernels.with_kernel("tag_outlines", "accumulate_normal_equations")
def _accumulate_normal_equations(image: GreyImage, model: _Model, is_sharp: bool) -> Array:
    """Accumulate the products (n, 17, 17) of the columns [J r]: derivatives of the model by the
    unknowns, and what it leaves unexplained; the products of paper's and ink's levels (10 and 13)
    sum up to the number of pixels.

    Args:
        image: (h, w) grey levels.
        model: of n tags.
        is_sharp: whether the blurs are so small that the pixel's own shape matters.
    """
    n = len(model.corners)
    products = np.zeros((n, _UNKNOWNS + 1, _UNKNOWNS + 1))
    order = np.argsort(model.half, kind="stable")
    pixels = 4 * _list_pixels(model.select(order[-1:]), 0).shape[1]
    for index in np.array_split(order, min(max(n * pixels // _MAX_PIXELS_AT_ONCE, 1), n)):
        portion = model.select(index)
        for edge in range(4):
            columns = _compute_columns(image, portion, edge, is_sharp)
            products[index] += columns @ columns.transpose(0, 2, 1)
    return products


def _list_pixels(model: _Model, edge: int) -> IntArray:
    """List the pixels (k, P, 2) in and around the band of an edge.

    An edge that runs more along u than v crosses each column of pixels once: those of its band are,
    column by column, the ones around the row where it passes; else with u and v exchanged.
    """
    length, t, _ = model.measure_edges()
    length, t = length[:, edge, None], t[:, edge]
    width = model.measure_bands()[:, edge].max(axis=1)
    tag = np.arange(len(t))
    main = np.where(abs(t[:, 0]) >= abs(t[:, 1]), 0, 1)
    along, across = t[tag, main, None], t[tag, 1 - main, None]
    begin, end = model.corners[:, edge], model.corners[:, _NEXT[edge]]
    low = np.minimum(begin, end)[tag, main] - width
    high = np.maximum(begin, end)[tag, main] + width
    x = np.floor(low)[:, None] + np.arange(int(np.max(high - low)) + 2)
    breadth = 2 * int(np.ceil(np.max(width[:, None] / abs(along)) + 0.5)) + 1
    s = (x - begin[tag, main, None]) / along
    bow = -model.curvature[:, edge, None] * s * (length - s) / 2
    # Of a normal (-t_v, t_u) the part across is t_u for an edge along u, and -t_v for one along v.
    normal = np.where(main[:, None] == 0, along, -along)
    y = begin[tag, 1 - main, None] + s * across + bow / normal
    lines = np.rint(y)[..., None] + np.arange(breadth) - breadth // 2
    columns = np.broadcast_to(x[..., None], lines.shape)
    is_flat = (main == 0)[:, None, None]
    uv = np.stack([np.where(is_flat, columns, lines), np.where(is_flat, lines, columns)], axis=-1)
    return uv.reshape(len(t), -1, 2).astype(np.int64)


def _measure_distances(model: _Model, uv: IntArray) -> tuple[FloatImage, FloatImage]:
    """Measure s over the length, and d px, (k, 4, P) of points (k, P, 2) along and within edges."""
    length, t, normal = model.measure_edges()
    middle = model.corners.mean(axis=1, keepdims=True)
    q = (uv - middle).transpose(0, 2, 1).astype(np.float32)
    corner = model.corners - middle
    s, d = (
        direction.astype(np.float32) @ q
        - np.sum(direction * corner, axis=2, keepdims=True).astype(np.float32)
        for direction in (t, normal)
    )
    share = s / length.astype(np.float32)[..., None]
    bow = (model.curvature * length**2 / 2).astype(np.float32)[..., None]
    return share, d + bow * share * (1 - share)


def _find_own_pixels(model: _Model, share: FloatImage, d: FloatImage, edge: int) -> BoolArray:
    """Return which pixels (k, P) lie in the band of an edge and in that of none before it."""
    length, bands = model.measure_edges()[0], model.measure_bands().astype(np.float32)
    own = np.ones(d[:, 0].shape, dtype=np.bool_)
    for which in range(edge + 1):
        out, inside = bands[:, which].T[..., None]
        beyond = out / length[:, which, None].astype(np.float32)
        within = (d[:, which] >= -out) & (d[:, which] <= inside)
        within &= abs(share[:, which] - 0.5) <= 0.5 + beyond
        own &= within if which == edge else ~within
    return own


def _compute_columns(image: GreyImage, model: _Model, edge: int, is_sharp: bool) -> FloatImage:
    """Compute the derivatives of the model by the unknowns, and the residual, (k, 17, P) at the
    pixels of one edge; 0 for those that do not count."""
    uv = _list_pixels(model, edge)
    share, d = _measure_distances(model, uv)
    inside = np.clip(uv, 1, np.array(image.shape[::-1]) - 2)
    counts = _find_own_pixels(model, share, d, edge) & (inside == uv).all(axis=2)
    weight = counts.astype(np.float32)
    grey = image[inside[..., 1], inside[..., 0]].astype(np.float32)

    last, following = int(_LAST[edge]), int(_NEXT[edge])
    normal = model.measure_edges()[2].astype(np.float32)
    turns = [np.sum(normal[:, edge] * normal[:, which], axis=1) for which in (last, following)]
    mine = _compute_edge(model, edge, d[:, edge], is_sharp)
    is_first = share[:, edge] < 0.5
    rho = np.where(is_first, *(turn[:, None] for turn in turns))
    # The other edge of the nearer corner is parallel to its opposite: both have one blur.
    distance = np.where(is_first, d[:, last], d[:, following])
    its = _compute_edge(model, last, distance, is_sharp)
    s1, s2 = model.blurs[:, [edge % 2, last % 2]].astype(np.float32).T[..., None]
    ink_beside, ink_here = (1 + its.value) / 2, (1 + mine.value) / 2
    x, y = d[:, edge] / s1, distance / s2
    rounding = s1 * s2 * mine.slope * its.slope / 4 * rho * (1 + rho * x * y / 2)
    Q = ink_here * ink_beside + rounding

    at = _normalise(model, uv)
    paper, ink = (model.levels[:, which].astype(np.float32)[:, None] @ at for which in (0, 1))
    swing = (ink - paper)[:, 0] * weight
    J = np.zeros((len(uv), _UNKNOWNS + 1, uv.shape[1]), dtype=np.float32)
    by_mine = swing * ink_beside * mine.slope / 2
    by_its = swing * ink_here * its.slope / 2
    for which, by_distance in (
        (edge, by_mine),
        (last, np.where(is_first, by_its, 0)),
        (following, np.where(is_first, 0, by_its)),
    ):
        # An edge follows its corners: where s is a share of its length, by 1 - s and by s.
        for axis in (0, 1):
            pull = -by_distance * normal[:, which, axis, None]
            J[:, 2 * which + axis] += pull * (1 - share[:, which])
            J[:, 2 * int(_NEXT[which]) + axis] += pull * share[:, which]
    J[:, 8 + edge % 2] = swing * ink_beside * mine.by_blur / 2
    J[:, 8 + last % 2] = swing * ink_here * its.by_blur / 2
    J[:, 10:13] = (weight * (1 - Q))[:, None] * at
    J[:, 13:16] = (weight * Q)[:, None] * at
    J[:, 16] = weight * (grey - (paper[:, 0] * (1 - Q) + ink[:, 0] * Q))
    return J


def _compute_edge(model: _Model, edge: int, distance: FloatImage, is_sharp: bool) -> EdgeIntensity:
    """Compute the blurred edge at the distances (k, P) px from an edge."""
    blur = model.blurs[:, edge % 2, None].astype(np.float32)
    if not is_sharp:
        return compute_edge(distance, blur)
    normal = model.measure_edges()[2][:, edge]
    return compute_edge(distance, blur, (abs(normal).max(axis=1) / 2).astype(np.float32)[:, None])


def _normalise(model: _Model, uv: IntArray) -> FloatImage:
    """Return (k, 3, P) ones and the places of pixels (k, P, 2) from the tag's middle, in halves of
    its side."""
    q = (uv - model.corners.mean(axis=1, keepdims=True)) / model.half[:, None, None]
    return (
        np.concatenate([np.ones_like(q[..., :1]), q], axis=2).transpose(0, 2, 1).astype(np.float32)
    )


def _take_step(model: _Model, products: Array) -> tuple[_Model, Array, Array]:
    """Take one Gauss-Newton step.

    Returns:
        The model after it, the inverse (n, 16, 16) of its equations, and the mean square (n,) of
        what is left unexplained.
    """
    N, g = products[:, :_UNKNOWNS, :_UNKNOWNS], products[:, :_UNKNOWNS, _UNKNOWNS]
    largest = np.einsum("nkk->nk", N).max(axis=1) + 1e-300
    inverse = np.linalg.inv(N + _DAMPING * largest[:, None, None] * np.eye(_UNKNOWNS))
    step = np.einsum("nij,nj->ni", inverse, g)
    square = products[:, _UNKNOWNS, _UNKNOWNS] - np.sum(step * g, axis=1)
    count = N[:, 10, 10] + N[:, 13, 13] + 2 * N[:, 10, 13]
    square = np.maximum(square, 0.0) / np.maximum(count - _UNKNOWNS, 1)
    blurs = model.blurs
    changed = np.clip(step[:, 8:10], np.maximum(-blurs / 3, _MIN_BLUR - blurs), blurs / 2)
    stepped = replace(
        model,
        corners=model.corners + np.clip(step[:, :8], -1.0, 1.0).reshape(-1, 4, 2),
        blurs=blurs + changed,
        levels=model.levels + step[:, 10:].reshape(-1, 2, 3),
    )
    return stepped, inverse, square

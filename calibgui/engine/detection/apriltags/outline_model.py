"""The model of the outlines of tags: what a pixel near them sees, and its derivatives.

Four edges lead from corner to corner of a tag, bent by the lens. With p_i the corners, clockwise
from the upper left one, edge i runs from p_i to p_i+1 in the direction t_i over a length L_i, with
its normal n_i inwards. A point q lies at the share s_i = t_i.(q - p_i) / L_i of it and within it by

    d_i = n_i.(q - p_i) + 4 b_i s_i (1 - s_i),

its bow b_i being how far outwards of the chord its middle lies. Blurred, the share of ink near the
corner of edges i and j is that of a quarter of the plane,

    Q = (1 + E_i + E_j + G(d_i, d_j)) / 4,

with the blurred edge E and the blurred crossing G of ``edge_intensity``; far from the corner this
is (1 + E_i) / 2. Paper and border each have a level that varies linearly over the tag, and

    I(q) = paper(q) (1 - Q) + ink(q) Q.

The correlation of the two edges' displacements is n_i.n_j if the blur is as wide in all directions.
If it is not, as under motion, two blurs across the edges do not say how it lies to them: motion
along one diagonal of a tag and along the other give the same two. The correlation is c more in
corners 0 and 2, and c less in 1 and 3, whose normals are turned. As it may be large then, all terms
of G up to rho^4 count, by Mehler's series

    phi_2 = phi(x) phi(y) sum of rho^n / n! He_n(x) He_n(y).

The unknowns of a tag are its corners (8), the blurs of its first and third and of its second and
fourth edge, the two levels with their gradients (6), the bows (4), and c.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, BoolArray, FloatImage, GreyImage, IntArray
from calibgui.engine.features.edge_intensity import EdgeIntensity, compute_edge

_BAND_BLURS, _BAND_MARGIN = 2.3, 0.7
"""Half width of the band that is read along an edge: blurs, and px in addition."""
_MAX_PIXELS_AT_ONCE = 40_000
"""Number of pixels fitted at once."""
UNKNOWNS = 21
"""Number of unknowns of a tag: corners 0 to 7, blurs 8 and 9, paper 10 to 12, ink 13 to 15, bows 16
to 19, correlation 20."""
NEXT, LAST = np.array([1, 2, 3, 0]), np.array([3, 0, 1, 2])
"""Edges that begin where each of the four ends, and that end where it begins."""


@dataclass(frozen=True, eq=False, slots=True)
class OutlineModel:
    """The model of k tags."""

    corners: Array
    """(k, 4, 2) px."""
    blurs: Array
    """(k, 2) px."""
    levels: Array
    """(k, 2, 3) of paper and ink: the level in the tag's middle and its rise over `half` px to the
    right and down."""
    bows: Array
    """(k, 4) px."""
    correlation: Array
    """(k,) c, by which the blurs across neighbouring edges correlate more than isotropic ones."""
    inwards: Array
    """(k,) how far the border is read inwards, px."""
    outwards: Array
    """(k,) how far the paper is read outwards, px."""
    half: Array
    """(k,) half the side of the tag, px."""

    def select(self, index: IntArray) -> OutlineModel:
        """Select the tags `index` (m,)."""
        return OutlineModel(*(getattr(self, field.name)[index] for field in fields(self)))

    def put(self, index: IntArray, some: OutlineModel) -> OutlineModel:
        """Return the model with `some` of its tags, `index` (m,), in place of its own."""
        changed = []
        for field in fields(self):
            values = getattr(self, field.name).copy()
            values[index] = getattr(some, field.name)
            changed.append(values)
        return OutlineModel(*changed)

    def measure_edges(self) -> tuple[Array, Array, Array]:
        """Measure the lengths (k, 4) px, tangents and inward normals (k, 4, 2) of the edges."""
        along = self.corners[:, NEXT] - self.corners
        length = np.linalg.norm(along, axis=2)
        t = along / length[..., None]
        return length, t, np.stack([-t[..., 1], t[..., 0]], axis=2)

    def locate_profiles(self, reach: Array, share: Array, samples: int) -> Array:
        """Locate the samples of profiles across the edges, (k, 4, m, samples, 2) px.

        Args:
            reach: (k,) px, how far profiles reach to both sides.
            share: (m,) where along an edge they are taken, lengths.
            samples: number of samples of each.
        """
        length, t, normal = self.measure_edges()
        s = length[..., None] * share
        bow = -4 * self.bows[..., None] * share * (1 - share)
        d = reach[:, None, None, None] * np.linspace(-1, 1, samples)
        at = self.corners[:, :, None] + s[..., None] * t[:, :, None]
        aside = bow[..., None] + d
        places = np.empty((*aside.shape, 2))
        for axis in (0, 1):  # quicker than over a last axis of two
            places[..., axis] = at[..., None, axis] + aside * normal[..., None, None, axis]
        return places

    def measure_bands(self) -> Array:
        """Measure how far (k, 4, 2) px the edges are read outwards and inwards."""
        width = _BAND_BLURS * self.blurs[:, [0, 1, 0, 1], None] + _BAND_MARGIN
        return np.minimum(width, np.column_stack([self.outwards, self.inwards])[:, None])


@kernels.with_kernel("tag_outlines", "accumulate_normal_equations")
def accumulate_normal_equations(image: GreyImage, model: OutlineModel, is_sharp: bool) -> Array:
    """Accumulate the products (n, 22, 22) of the columns [J r]: derivatives of the model by the
    unknowns, and what it leaves unexplained; the products of paper's and ink's levels (10 and 13)
    sum up to the number of pixels.

    Args:
        image: (h, w) grey levels.
        model: of n tags.
        is_sharp: whether the blurs are so small that the pixel's own shape matters.
    """
    n = len(model.corners)
    products = np.zeros((n, UNKNOWNS + 1, UNKNOWNS + 1))
    order = np.argsort(model.half, kind="stable")
    pixels = 4 * _list_pixels(model.select(order[-1:]), 0).shape[1]
    for index in np.array_split(order, min(max(n * pixels // _MAX_PIXELS_AT_ONCE, 1), n)):
        portion = model.select(index)
        for edge in range(4):
            columns = _compute_columns(image, portion, edge, is_sharp)
            products[index] += columns @ columns.transpose(0, 2, 1)
    return products


def _list_pixels(model: OutlineModel, edge: int) -> IntArray:
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
    begin, end = model.corners[:, edge], model.corners[:, NEXT[edge]]
    low = np.minimum(begin, end)[tag, main] - width
    high = np.maximum(begin, end)[tag, main] + width
    x = np.floor(low)[:, None] + np.arange(int(np.max(high - low)) + 2)
    breadth = 2 * int(np.ceil(np.max(width[:, None] / abs(along)) + 0.5)) + 1
    s = (x - begin[tag, main, None]) / along
    bow = -4 * model.bows[:, edge, None] * (s / length) * (1 - s / length)
    # Of a normal (-t_v, t_u) the part across is t_u for an edge along u, and -t_v for one along v.
    normal = np.where(main[:, None] == 0, along, -along)
    y = begin[tag, 1 - main, None] + s * across + bow / normal
    lines = np.rint(y)[..., None] + np.arange(breadth) - breadth // 2
    columns = np.broadcast_to(x[..., None], lines.shape)
    is_flat = (main == 0)[:, None, None]
    uv = np.stack([np.where(is_flat, columns, lines), np.where(is_flat, lines, columns)], axis=-1)
    return uv.reshape(len(t), -1, 2).astype(np.int64)


def _measure_distances(model: OutlineModel, uv: IntArray) -> tuple[FloatImage, FloatImage]:
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
    bow = 4 * model.bows.astype(np.float32)[..., None]
    return share, d + bow * share * (1 - share)


def _find_own_pixels(model: OutlineModel, share: FloatImage, d: FloatImage, edge: int) -> BoolArray:
    """Return which pixels (k, P) lie in the band of an edge and in that of none before it."""
    length, bands = model.measure_edges()[0], model.measure_bands().astype(np.float32)
    is_own = np.ones(d[:, 0].shape, dtype=np.bool_)
    for which in range(edge + 1):
        out, inside = bands[:, which].T[..., None]
        beyond = out / length[:, which, None].astype(np.float32)
        within = (d[:, which] >= -out) & (d[:, which] <= inside)
        within &= abs(share[:, which] - 0.5) <= 0.5 + beyond
        is_own &= within if which == edge else ~within
    return is_own


def _compute_columns(
    image: GreyImage, model: OutlineModel, edge: int, is_sharp: bool
) -> FloatImage:
    """Compute the derivatives of the model by the unknowns, and the residual, (k, 22, P) at the
    pixels of one edge; 0 for those that do not count."""
    uv = _list_pixels(model, edge)
    share, d = _measure_distances(model, uv)
    inside = np.clip(uv, 1, np.array(image.shape[::-1]) - 2)
    counts = _find_own_pixels(model, share, d, edge) & (inside == uv).all(axis=2)
    weight = counts.astype(np.float32)
    grey = image[inside[..., 1], inside[..., 0]].astype(np.float32)

    last, following = int(LAST[edge]), int(NEXT[edge])
    normal = model.measure_edges()[2].astype(np.float32)
    turns = [np.sum(normal[:, edge] * normal[:, which], axis=1) for which in (last, following)]
    mine = _compute_edge(model, edge, d[:, edge], is_sharp)
    is_first = share[:, edge] < 0.5
    # Corner `edge` is at the beginning of the edge, and the next one at its end.
    more = np.where(edge % 2 == 0, model.correlation, -model.correlation).astype(np.float32)
    rho = np.where(is_first, (turns[0] + more)[:, None], (turns[1] - more)[:, None])
    # The other edge of the nearer corner is parallel to its opposite: both have one blur.
    distance = np.where(is_first, d[:, last], d[:, following])
    its = _compute_edge(model, last, distance, is_sharp)
    s1, s2 = model.blurs[:, [edge % 2, last % 2]].astype(np.float32).T[..., None]
    ink_beside, ink_here = (1 + its.value) / 2, (1 + mine.value) / 2
    x, y = d[:, edge] / s1, distance / s2
    both = s1 * s2 * mine.slope * its.slope / 4
    second, third, xy = (x * x - 1) * (y * y - 1), (x * x - 3) * (y * y - 3), x * y
    rounding = both * rho * (1 + rho * (xy / 2 + rho * (second / 6 + rho * xy * third / 24)))
    by_rho = both * (1 + rho * (xy + rho * (second / 2 + rho * xy * third / 6)))
    Q = ink_here * ink_beside + rounding

    at = _normalise(model, uv)
    paper, ink = (model.levels[:, which].astype(np.float32)[:, None] @ at for which in (0, 1))
    swing = (ink - paper)[:, 0] * weight
    J = np.zeros((len(uv), UNKNOWNS + 1, uv.shape[1]), dtype=np.float32)
    by_mine = swing * ink_beside * mine.slope / 2
    by_its = swing * ink_here * its.slope / 2
    for which, by_distance in (
        (edge, by_mine),
        (last, np.where(is_first, by_its, 0)),
        (following, np.where(is_first, 0, by_its)),
    ):
        # An edge follows its corners by 1 - s and by s.
        J[:, 16 + which] += 4 * by_distance * share[:, which] * (1 - share[:, which])
        for axis in (0, 1):
            pull = -by_distance * normal[:, which, axis, None]
            J[:, 2 * which + axis] += pull * (1 - share[:, which])
            J[:, 2 * int(NEXT[which]) + axis] += pull * share[:, which]
    J[:, 8 + edge % 2] = swing * ink_beside * mine.by_blur / 2
    J[:, 8 + last % 2] = swing * ink_here * its.by_blur / 2
    J[:, 10:13] = (weight * (1 - Q))[:, None] * at
    J[:, 13:16] = (weight * Q)[:, None] * at
    J[:, 20] = swing * np.where(is_first == (edge % 2 == 0), by_rho, -by_rho)
    J[:, UNKNOWNS] = weight * (grey - (paper[:, 0] * (1 - Q) + ink[:, 0] * Q))
    return J


def _compute_edge(
    model: OutlineModel, edge: int, distance: FloatImage, is_sharp: bool
) -> EdgeIntensity:
    """Compute the blurred edge at the distances (k, P) px from an edge."""
    blur = model.blurs[:, edge % 2, None].astype(np.float32)
    if not is_sharp:
        return compute_edge(distance, blur)
    normal = model.measure_edges()[2][:, edge]
    return compute_edge(distance, blur, (abs(normal).max(axis=1) / 2).astype(np.float32)[:, None])


def _normalise(model: OutlineModel, uv: IntArray) -> FloatImage:
    """Return (k, 3, P) ones and the places of pixels (k, P, 2) from the tag's middle, in halves of
    its side."""
    q = (uv - model.corners.mean(axis=1, keepdims=True)) / model.half[:, None, None]
    return (
        np.concatenate([np.ones_like(q[..., :1]), q], axis=2).transpose(0, 2, 1).astype(np.float32)
    )

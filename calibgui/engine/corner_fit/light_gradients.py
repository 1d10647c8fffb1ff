"""The gradients of the light at corners: the board's, those of the squares beside one, its own.

The gradients gm and ga (`x_corner_model`) pull at a corner the more the longer its arms are. They
are taken from the whole board, since a corner that has them as unknowns is located 40 % worse
(`board_priors`). Four things are told here that the board does not say.

**Flat squares.** Near the edges gradients are hard to tell from a displacement, and the board as a
whole says little of them where the light varies from square to square. Away from the edges nothing
depends on the corner, and the grey level is plainly

    I(q) = m + gm.q + p' (a + ga.q),        p' = p G = +-1,

so that all that is left of the squares' quarters around the corner tells m, a, gm and ga. Their
pixels, far more than those near the edges, are read as means over cells of k x k of them, which
miss none of it: light hardly varies over a cell. What lies on a square, or ends there, such as a
finger or a shadow, is no gradient. Where the model leaves more unexplained than noise does, its
products count the less.

**Light of its own.** Where the light falls through blinds, flickers or ends at the edge of a
shadow, no polynomial over the board follows it, and corners would lie as much as 2 px aside, each
as sure of its place as any other. Such corners leave less unexplained with gradients of their own,
by more than noise would:

    F = (RSS - RSS') / 4 / (RSS' / degrees of freedom)

of the four more unknowns is 1 on average for any other. What a camera does to all corners alike, as
one that sharpens to one side, gradients explain a little of, too, and those that have them would be
moved against the others. So a corner has its own only if it leaves more unexplained than most, or
if on most of a board of plain squares gradients explain much of it. Where something is printed in
the squares less of an edge is read, and it is enough that its F stands out from the board's.

Those corners are fitted with them, and once more to the nearer half of their edges. An edge of the
light may cross the farther one, and bend the edges as no gradient does: where the two places differ
by more than noise, the nearer one counts, with the square of the difference in its covariance. So
has all that is left unexplained by more than noise. The troubles "blinds", "flicker" and "shadow"
of ``tests.benchmarks.corner_troubles`` fixed the limits, and "video" and "mosaic", whose corners
gain nothing.

**Stray light.** A lens scatters a part of the light over tens of pixels, more of it where the image
is overexposed. Around corners of plain squares that is even under point reflection, and moves none.
Tags, markers and dots in the squares are not: every corner beside them has a gradient of its own.
All corners together tell it. With its own gradients a corner lies aside, by v, of where those of
the board have it. If these are right the covariance of v is D, what more unknowns cost (Hausman
1978), and

    h = v^T D^-1 v / 2

is distributed exponentially with mean 1. Where its median over the board is H times as large, the
board's gradients err and draw corners aside with the covariance (H - 1) D. The best place is then
the share 1 - 1 / H of v away from the board's, with a covariance that is so much of D larger. What
neighbouring pixels have in common makes v larger, too: D grows by it.

Of paper that is clipped the stray light is not seen, but it moves the place along an edge where the
level leaves the clipped one. So a part of (H - 1) D is added there. D itself is too large there:
edges bend so abruptly that opposite pixels differ by more than their noise (`corner_noise`).

**Blurred light.** The model lights the blurred pattern, where a camera blurs the lit one. Under
light L that rises by l = grad L / L,

    (L f) * h = L (f * h) + s^2 L l.grad (f * h) = L (f * h)(q + s^2 l)

for a blur h of variance s^2: its far side sends in more light, and the pattern seems to stand
s^2 l farther into the dark. The corner is moved back, with l = ga / a, the relative gradient of
contrast.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.arrays import (
    Array,
    BoolArray,
    GreyImage,
    IntArray,
    compute_median,
    invert_2x2,
)
from calibgui.engine.corner_fit.corner_noise import MIN_FREEDOM
from calibgui.engine.corner_fit.edge_lens_fit import ReadEdges
from calibgui.engine.corner_fit.x_corner_model import (
    BLUR,
    LIGHT,
    UNKNOWNS,
    A,
    C,
    M,
    XCornerModel,
    accumulate_normal_equations,
)
from calibgui.engine.corner_fit.x_corner_step import take_lit_step

_MIN_GAIN = 8.0
"""Least F of the light's gradients with which a corner has its own, also over the board's
median. Sums of many pixels make it 6 by chance at one of 20 corners of "video"; with 4 its
errors grew by a fifth."""
_MIN_RELATIVE_RESIDUAL = 1.5
"""Least residual of such a corner, over the board's median, where squares are plain or its F
does not stand out ..."""
_MIN_MEDIAN_SHARE = 0.3
"""... unless that share of the squares of the residuals, or more, is explained by gradients at
half of the corners."""
_MAX_DISTANCE_OF_HALVES = 2.0
"""Greatest square of the distance between a corner fitted to its whole edges and to their
nearer half, over the sum of the latter's variances."""
_MIN_HALF_ARM = 2.0
"""Least length of a half, px; see `robust_fit`."""
_MIN_CORNERS_OF_STRAY_LIGHT = 16
"""Least number of corners that tell it."""
_LEAST_LOSS = 1e-3
"""Least variance in a direction by which gradients cost corners, over that in all."""
_MIN_STRAY_LIGHT_SIGMAS = 3.0
"""Least excess of H over 1 that is believed, standard deviations."""
_MAX_SHIFT_BY_STRAY_LIGHT = 0.05
"""Greatest median of v, px: more is no light. Photographs of small, dense squares under a
fisheye had more, and three in a hundred of their corners were drawn 0.3 px aside."""
_MAX_BELOW_CLIPPING = 0.01
"""Greatest distance of clipped paper from the image's greatest level, over that."""
_CLIPPED_SHARE = 0.45
"""Share of D that is true beside clipped paper: without stray light H was 0.1 to 0.7 on
rendered boards, 0.42 on average."""
_UNSEEN_SHARE = 0.5
"""Share of (H - 1) D that is added there. On four kinds of boards rendered with 15 % of the
light strayed over 6 to 12 px chi2 was 1.2 to 1.7 without, and on others is 0.9 to 1.6."""
_GRADIENTS = 4
"""Number of unknowns that gm and ga are."""
_STEPS = 3
"""Number of Gauss-Newton steps; a fourth moves no corner by a tenth of its standard deviation."""
_MAX_BOARD_WEIGHT = 100.0
"""Greatest weight of what the board tells of the light, over that of a corner's pixels."""
_CELLS_PER_ARM = 6
"""Number of cells along an arm."""
_MIN_CELLS = 12
"""Least number of cells from which something is read: the light has six unknowns."""
_LIGHT = 6
"""Number of columns by the light's unknowns: 1, p', q, p' q; the residual follows."""
_COLUMNS = np.r_[6, 7, UNKNOWNS + 1 : UNKNOWNS + 5, UNKNOWNS]
"""Places of these columns among those of the normal equations."""
_DAMPING = 1e-12
"""Part of their largest entry that the diagonal of the light's equations is raised by: a corner may
have all its cells on one side."""
_HALF_DIAGONAL = 0.5**0.5
"""Distance of a cell's corners from its centre, cells."""


def add_gradients(
    before: XCornerModel,
    better: XCornerModel,
    covariances: Array,
    noise: Array,
    products: Array,
) -> Array:
    """Add what the board as a whole tells of the light's gradients to the products of the pixels.

    It counts at most as a hundred times the pixels that are read at a corner: far more would be
    lost to rounding.

    Args:
        before: the model that the products belong to.
        better: the model with the gradients that the board tells.
        covariances: (2, n, 2, 2) of these gm and ga.
        noise: (n,) square of the noise, grey levels^2.
        products: (n, 14, 14) of the pixels.

    Returns:
        (n, 14, 14) the products of both.
    """
    held = products.copy()
    lacks = (
        better.level_gradient - before.level_gradient,
        better.contrast_gradient - before.contrast_gradient,
    )
    for i, (lack, covariance) in enumerate(zip(lacks, covariances, strict=True)):
        at = slice(UNKNOWNS + 1 + 2 * i, UNKNOWNS + 3 + 2 * i)
        pixels = np.trace(products[:, at, at], axis1=1, axis2=2)
        least = noise / (_MAX_BOARD_WEIGHT * np.maximum(pixels, 1e-300))
        bounded = covariance + least[:, None, None] * np.eye(2)
        weight = noise[:, None, None] * invert_2x2(bounded)
        pull = np.einsum("nij,nj->ni", weight, lack)
        held[:, at, at] += weight
        held[:, at, UNKNOWNS] += pull
        held[:, UNKNOWNS, at] += pull
    return held


def correct_for_light_told(
    model: XCornerModel, inverse: Array, better: XCornerModel, edges: ReadEdges
) -> XCornerModel:
    """Return the model with the gradients of the `better` one, and its corners where these would
    have put them.

    Away from the corner an edge's intensity rises by +-2 a across it, with the sign of s along it.
    Summed over what was read of it, |s - m| <= h, a gradient g of the level weighs on n_i by
    2 p a (h^2 + m^2) g.t_i.

    Args:
        model: after its last step.
        inverse: (n, 2, 2) the part of that step's inverse for c.
        better: the model with the gradients that follow from all of the arms.
        edges: what was read.
    """
    square = edges.half**2 + edges.middle**2
    rise = better.level_gradient - model.level_gradient
    along = np.einsum("nij,nj->ni", model.tangents(), rise)
    swing = 2 * model.sign * model.unknowns[A]
    pull = np.einsum("ni,nij->nj", swing[:, None] * square * along, edges.normals)
    unknowns = model.unknowns.copy()
    unknowns[C] += np.einsum("nij,nj->ni", inverse, pull)
    return replace(
        model,
        unknowns=unknowns,
        level_gradient=better.level_gradient,
        contrast_gradient=better.contrast_gradient,
    )


def correct_for_light(model: XCornerModel) -> XCornerModel:
    """Return the model with its corners back from where light and blur have moved them."""
    unknowns = model.unknowns.copy()
    variance = np.mean(unknowns[BLUR] ** 2, axis=1)
    unknowns[C] += (variance / unknowns[A])[:, None] * model.contrast_gradient
    return replace(model, unknowns=unknowns)


def read_between_edges(image: GreyImage, model: XCornerModel, noise: Array) -> Array:
    """Read what lies between the edges, as products like those of the edges' pixels.

    Args:
        image: (h, w) grey levels.
        model: at n corners of plain squares.
        noise: (n,) square of the noise, grey levels^2.

    Returns:
        (n, 14, 14) the products, to be added to those of `accumulate_normal_equations` of the same
        model; 0 by all unknowns but m, a, gm and ga.
    """
    side = np.maximum(model.arm.min(axis=1) // _CELLS_PER_ARM, 1).astype(np.int64)
    light = np.column_stack(
        [model.unknowns[M], model.unknowns[A], model.level_gradient, model.contrast_gradient]
    )
    sums, cells = _sum_cells(
        image, model.unknowns[C].copy(), model.find_support().pack(), model.sign, light, side
    )
    products = np.zeros((len(sums), UNKNOWNS + 5, UNKNOWNS + 5))
    readable = np.flatnonzero(cells >= _MIN_CELLS)
    if not len(readable):
        return products
    N, g = sums[readable, :_LIGHT, :_LIGHT], sums[readable, :_LIGHT, _LIGHT]
    damped = N + _DAMPING * N.max(axis=(1, 2))[:, None, None] * np.eye(_LIGHT)
    solution = np.linalg.solve(damped, g[..., None])[..., 0]
    unexplained = sums[readable, _LIGHT, _LIGHT] - np.sum(solution * g, axis=1)
    square = unexplained / (cells[readable] - _LIGHT)
    weight = np.minimum(noise[readable] / np.maximum(square, 1e-300), 1.0)
    block = np.ix_(readable, _COLUMNS, _COLUMNS)
    products[block] = weight[:, None, None] * sums[readable]
    return products


@kernels.with_kernel("light_between_edges", "sum_cells")
def _sum_cells(
    image: GreyImage, uv: Array, bands: Array, sign: Array, light: Array, side: IntArray
) -> tuple[Array, IntArray]:
    """Sum the products of the columns 1, p', q, p' q and the residual over the cells between the
    edges, times the pixels of a cell.

    Args:
        image: (h, w) grey levels.
        uv: (n, 2) the corners, px.
        bands: (n, 2, 7) of their edges, see `EdgeSupport.pack`.
        sign: (n,) p.
        light: (n, 6) m, a, gm and ga.
        side: (n,) number of pixels along a cell.

    Returns:
        (n, 7, 7) the sums, and (n,) the numbers of cells.
    """
    sums, cells = np.zeros((len(uv), _LIGHT + 1, _LIGHT + 1)), np.zeros(len(uv), np.int64)
    limit = np.array(image.shape[::-1]) - 1
    for i, k in enumerate(side):
        tangent, normal = bands[i, :, 0:2], bands[i, :, 2:4]
        curvature, arm, width = bands[i, :, 4:].T
        middle = np.rint(uv[i]).astype(np.int64)
        reach = int(np.ceil((abs(tangent) * arm[:, None]).sum(axis=0).max() / k))
        steps = np.arange(-reach, reach + 1) * k
        upper_left = middle + np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
        q = upper_left + (k - 1) / 2 - uv[i]
        s, d = q @ tangent.T, q @ normal.T
        d -= curvature / 2 * s * s
        is_flat = (abs(s) <= arm).all(axis=1) & (abs(d) > width + _HALF_DIAGONAL * k).all(axis=1)
        is_flat &= (upper_left >= 1).all(axis=1) & (upper_left + k <= limit).all(axis=1)
        q, upper_left = q[is_flat], upper_left[is_flat]
        cells[i] = len(q)
        pattern = sign[i] * np.sign(d[is_flat]).prod(axis=1)
        inside = upper_left[:, None, None] + np.stack(np.meshgrid(*[np.arange(k)] * 2), axis=-1)
        grey = image[inside[..., 1], inside[..., 0]].mean(axis=(1, 2), dtype=np.float64)
        J = np.column_stack([np.ones(len(q)), pattern, q, pattern[:, None] * q])
        J = np.column_stack([J, grey - J @ light[i]])
        sums[i] = J.T @ J * k * k
    return sums, cells


def find_uneven_light(
    products: Array,
    square: Array,
    lit_square: Array,
    least_noise: float,
    is_plain: bool,
    are_marks_removed: bool,
) -> BoolArray:
    """Find the corners (n,) that gradients of the light of their own describe clearly better.

    Args:
        products: (n, 14, 14) that the last step was taken from.
        square: (n,) mean square that it leaves unexplained.
        lit_square: (n,) what a step leaves that changes the gradients of every corner as well.
        least_noise: least square of the noise that is believed, grey levels^2.
        is_plain: whether nothing is printed in the squares: blurred, that looks like light at all
            corners.
        are_marks_removed: whether that was taken out of the image: some corners are left more of it
            than others, and none stands out.
    """
    free = products[:, 6, 6] - UNKNOWNS
    gain = free * square - (free - _GRADIENTS) * lit_square
    is_clear = gain > _MIN_GAIN * _GRADIENTS * np.maximum(lit_square, least_noise)
    # A model of as many unknowns as pixels describes anything.
    is_clear &= free - _GRADIENTS >= MIN_FREEDOM
    if not is_clear.any():
        return np.asarray(is_clear)
    share = compute_median(gain / np.maximum(free * square, least_noise))
    if is_plain and share > _MIN_MEDIAN_SHARE:
        return np.asarray(is_clear)
    F = gain / (_GRADIENTS * np.maximum(lit_square, least_noise))
    stands_out = F > _MIN_GAIN * max(float(compute_median(F)), 1.0)
    usual = float(compute_median(np.sqrt(square)))
    is_poor = np.sqrt(square) > _MIN_RELATIVE_RESIDUAL * usual
    is_marked = not is_plain and not are_marks_removed
    return np.asarray(is_clear & (is_poor | (stands_out & is_marked)))


def fit_local_light(
    image: GreyImage, model: XCornerModel, noise: float
) -> tuple[XCornerModel, Array, Array]:
    """Fit corners with gradients of the light of their own.

    Args:
        image: (h, w) grey levels.
        model: at n corners, near the solution.
        noise: square of what noise alone leaves unexplained, grey levels^2.

    Returns:
        The model, the covariance (n, 2, 2) px^2 of the corners, and the mean square (n,) of what is
        left unexplained.
    """
    whole, covariance, square = _fit_arms(image, model, model.arm)
    half = np.maximum(model.arm / 2, np.minimum(model.arm, _MIN_HALF_ARM))
    near, near_covariance, near_square = _fit_arms(image, model, half)
    apart = np.sum((near.unknowns[C] - whole.unknowns[C]) ** 2, axis=1)
    differ = apart > _MAX_DISTANCE_OF_HALVES * np.trace(near_covariance, axis1=1, axis2=2)

    def choose(one: Array, other: Array) -> Array:
        return np.where(differ.reshape(-1, *[1] * (one.ndim - 1)), one, other)

    chosen = replace(
        whole,
        unknowns=choose(near.unknowns, whole.unknowns),
        level_gradient=choose(near.level_gradient, whole.level_gradient),
        contrast_gradient=choose(near.contrast_gradient, whole.contrast_gradient),
    )
    square = choose(near_square, square)
    added = choose(apart / 2, np.zeros_like(apart)) + _estimate_pull(chosen, square - noise)
    covariance = choose(near_covariance, covariance) + added[:, None, None] * np.eye(2)
    return chosen, covariance, square


def _estimate_pull(model: XCornerModel, square: Array) -> Array:
    """Estimate the variance (n,) px^2 of corners near which the light leaves the mean `square` (n,)
    unexplained.

    Noise pulls at the pixels of an edge one by one, light at all of an arm: an error e of the grey
    level moves it by e over the slope, sqrt(2 pi) s e / 2 a, and the two arms of an edge halve the
    variance.
    """
    share = np.maximum(square, 0.0) / (2 * model.unknowns[A]) ** 2
    return np.asarray(np.pi * share * np.mean(model.unknowns[BLUR] ** 2, axis=1))


def _fit_arms(
    image: GreyImage, model: XCornerModel, arm: Array
) -> tuple[XCornerModel, Array, Array]:
    """Fit corners, as `fit_local_light`, to arms `arm` (n, 2) px of their edges.

    What is left unexplained is that before the last step: a fit that did not settle is not sure.
    """
    model = replace(model, arm=arm)
    for _ in range(_STEPS):
        products, _ = accumulate_normal_equations(image, model, odd=True)
        model, inverse, _ = take_lit_step(model, products)
    free = np.maximum(products[:, 6, 6] - UNKNOWNS - _GRADIENTS, 1)
    square = products[:, UNKNOWNS, UNKNOWNS] / free
    return model, square[:, None, None] * inverse, square


def find_clipped_corners(image: GreyImage, model: XCornerModel) -> BoolArray:
    """Find the corners (n,) whose bright squares have the greatest level of the image (h, w)."""
    bright = model.unknowns[LIGHT].sum(axis=1)
    return np.asarray(bright >= (1 - _MAX_BELOW_CLIPPING) * float(image.max()))


def estimate_stray_light(
    shift: Array, lost: Array, usable: BoolArray, clipped: BoolArray
) -> tuple[float, Array]:
    """Estimate how far corners go towards their places with gradients of their own.

    Args:
        shift: (n, 2) v, px.
        lost: (n, 2, 2) D, px^2.
        usable: (n,) the corners that are looked at.
        clipped: (n,) those of `find_clipped_corners`.

    Returns:
        The share of v, 0 where it is not clear, and (n,) how often D is to be added to the
        covariances.
    """
    number = int(np.count_nonzero(usable))
    if number < _MIN_CORNERS_OF_STRAY_LIGHT:
        return 0.0, np.zeros(len(shift))
    of_noise = np.where(clipped, _CLIPPED_SHARE, 1.0)
    v, D = shift[usable], of_noise[usable, None, None] * lost[usable]
    least = _LEAST_LOSS * np.einsum("nii->n", D) + np.finfo(np.float64).tiny
    weight = invert_2x2(D + least[:, None, None] * np.eye(2))
    h = np.einsum("ni,nij,nj->n", v, weight, v) / 2
    H = float(compute_median(h)) / np.log(2)
    # The median of n such numbers deviates from log 2 by n^-1/2.
    is_clear = H >= 1 + _MIN_STRAY_LIGHT_SIGMAS / (np.log(2) * np.sqrt(number))
    if not is_clear or compute_median(np.hypot(*v.T)) > _MAX_SHIFT_BY_STRAY_LIGHT:
        return 0.0, np.zeros(len(shift))
    share = 1 - 1 / H
    unseen = np.where(clipped, _UNSEEN_SHARE * (H - 1), 0.0)
    return share, share + of_noise * unseen


def go_to_own_light(
    model: XCornerModel, boards: XCornerModel, own: XCornerModel, share: float
) -> XCornerModel:
    """Move a model towards the light of its own corners.

    Args:
        model: at n corners, with the board's light.
        boards: the same before its edges were bent.
        own: as a step with the light's gradients among the unknowns left it.
        share: of the way from the board's light to their own.
    """
    level, contrast = (
        at_board + share * (at_own - at_board)
        for at_board, at_own in (
            (model.level_gradient, own.level_gradient),
            (model.contrast_gradient, own.contrast_gradient),
        )
    )
    unknowns = model.unknowns + share * (own.unknowns - boards.unknowns)
    return replace(model, unknowns=unknowns, level_gradient=level, contrast_gradient=contrast)

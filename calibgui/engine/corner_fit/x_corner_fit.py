"""Corners at the Cramer-Rao bound: the two blurred edges fitted to the pixels.

The unknowns of the model (`x_corner_model`), c, the edges' directions and blurs, m, a and rho, are
found by Gauss-Newton steps, all corners at once. Under point reflection about c the derivatives
by c are odd, those by all other unknowns even: they decouple, and the covariance of c is what it
would be if the rest were known, the Cramer-Rao bound

    cov c = noise^2 (sum of (grad I)(grad I)^T)^-1.

For the same reason only the odd part of what the model leaves unexplained says how well c is
known: a blur that is not Gaussian leaves an even one. So noise^2 is half the mean square
difference of opposite pixels, times what neighbouring pixels have in common (`corner_noise`). The
covariance does not contain what the model gets wrong in the same way at every corner.

What is odd too and would not decouple - curvature and the light's gradients gm, ga - comes from
the whole board (`board_priors`), as does the spread w of the ink.

Two steps near the corners give what the board needs, and the last one reads whole edges. The
direction that 9 px of an edge tell is 0.1 px off at 150 px, where the step is no longer linear: of
long edges at few corners, which depend on it, ever more is read in between. Then the board is asked
once more, and the corners follow without reading the edges again. Where corners do not tell how
long edges bend the edges' directions do (`followed_edges`). What the board leaves open of the
curvatures, which grows with the arms' length, is added to the covariance.

So does the pull of gm grow, and the board tells gm and ga with a covariance. On plain squares they
are unknowns of the last step, which the board holds, and where it leaves them open so does what
lies between the edges. Light that varies slowly is known best from the whole board, light that
varies from square to square from the squares at the corner. What is printed in squares looks like
light where it is blurred: there the gradients are the board's, but where the light ends at a corner
or strays. All this is told in `light_gradients`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace

import numpy as np

from calibgui.engine.arrays import (
    Array,
    BoolArray,
    GreyImage,
    Size,
    compute_lengths,
    compute_median,
    invert_2x2,
)
from calibgui.engine.corner_fit.board_priors import (
    MANY_CORNERS,
    BoardPriors,
    LatticePriors,
    PredictedPriors,
)
from calibgui.engine.corner_fit.corner_noise import (
    compute_rounding_variance,
    estimate_growth,
    estimate_noise,
    has_hard_edges,
    pool_noise,
)
from calibgui.engine.corner_fit.edge_lens_fit import ReadEdges, clip_arms
from calibgui.engine.corner_fit.followed_edges import EdgeGeometry
from calibgui.engine.corner_fit.light_gradients import (
    add_gradients,
    correct_for_light,
    correct_for_light_told,
    estimate_stray_light,
    find_clipped_corners,
    find_uneven_light,
    fit_local_light,
    go_to_own_light,
    read_between_edges,
)
from calibgui.engine.corner_fit.x_corner_model import (
    BLUR,
    LIGHT,
    MIN_BLUR,
    RHO,
    THETA,
    UNKNOWNS,
    A,
    C,
    M,
    XCornerModel,
    accumulate_normal_equations,
)
from calibgui.engine.corner_fit.x_corner_step import take_lit_step, take_step
from calibgui.engine.features import edge_profiles
from calibgui.engine.features.edge_profiles import EdgeProfiles
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.features.pixel_noise import ROUNDING_VARIANCE

_MIN_ARM = 8.0
"""Length up to which arms are read even where something was printed on them, px."""
_MAX_NEAR_ARM = 9.0
"""Longest arm that is read for the first approximation, px. The last one reads all of the
arms: with 18 to 74 px of them corners in 12 megapixels lay 1.2 to 1.6 times off the bound."""
_MAX_ARM_GROWTH = 6.0
"""Greatest factor by which arms grow from one approximation to the next before that."""
_MAX_SHORT_ARM = 25.0
"""Length of the arms up to which many corners tell enough of how edges bend, unless the image
cuts these, px. To follow the edges takes up to a third of the search's time."""
_MIN_INK_SPREAD = 0.002
"""Spread of the dark squares below which it counts as none, squares."""
_MAX_INK_SPREAD = 0.2
"""Spread of the dark squares beyond which it is not believed, squares."""
_BLUR_REACH = 2.0
"""Distance, in blurs, over which the blur of what follows a square's colour is felt. With 1.5
the covariances of corners between markers were 1.2 to 1.4 times too large."""
_MAX_OPEN_LIGHT = 0.02
"""Greatest growth of a corner's variance by what the board leaves open of the light, at which
that is not looked up between the edges; it saves a tenth of the time."""
_SPREAD_BLUR_REACH = 3.0
"""Distance, in blurs, over which the blur of what follows the ink's spread is felt; the spread
is far smaller than a blur."""
_MIN_SPREAD_BLURS = 2.0
"""Least width, in blurs, on either side of an edge that the spread is measured over."""


@dataclass(frozen=True, eq=False, slots=True)
class XCornerFit:
    """The model of two crossing edges fitted at n corners."""

    model: XCornerModel
    covariance: Array
    """(n, 2, 2) of c, px^2."""
    residual: Array
    """(n,) standard deviation of what the model leaves unexplained, grey levels."""
    board_residual: Array
    """(n,) what it leaves with the light of the whole board at all corners."""

    @property
    def uv(self) -> Array:
        """(n, 2) the corners, px."""
        return self.model.unknowns[C]

    @property
    def blur(self) -> Array:
        """(n,) root mean square of the edges' blurs, pixel included, px."""
        return np.sqrt(np.mean(self.model.unknowns[BLUR] ** 2, axis=1))

    @property
    def contrast(self) -> Array:
        """(n,) bright minus dark, grey levels."""
        return 2 * self.model.unknowns[A]

    @property
    def bright(self) -> Array:
        """(n,) grey levels of the bright squares."""
        return self.model.unknowns[M] + self.model.unknowns[A]

    def widen(self, displacement: Array) -> XCornerFit:
        """Return the fit with the covariances of corners that are drawn aside, by `displacement`
        (n,) px, so much larger that they expect it: its square, shared by both axes."""
        added = displacement[:, None, None] ** 2 / 2 * np.eye(2)
        return replace(self, covariance=self.covariance + added)


def replace_fits(
    fit: XCornerFit, other: XCornerFit, fitted: BoolArray, better: BoolArray
) -> XCornerFit:
    """Replace fits by others.

    Args:
        fit: at n corners.
        other: at the m of them under the mask `fitted` (n,).
        better: (m,) True where the other is taken.
    """
    at = np.flatnonzero(fitted)[better]

    def choose(mine: Array, its: Array) -> Array:
        result = mine.copy()
        result[at] = its[better]
        return result

    names = [field.name for field in fields(XCornerModel)]
    model = XCornerModel(
        **{name: choose(getattr(fit.model, name), getattr(other.model, name)) for name in names}
    )
    return XCornerFit(
        model,
        choose(fit.covariance, other.covariance),
        choose(fit.residual, other.residual),
        choose(fit.board_residual, other.board_residual),
    )


def fit_x_corners(
    image: GreyImage,
    lattice: Lattice,
    bare_reach: float = 0.5,
    bare_edge: float = 0.5,
    geometry: tuple[Array, Array] | None = None,
    priors: BoardPriors | None = None,
    are_marks_removed: bool = False,
) -> XCornerFit:
    """Fit the model at every corner of `lattice`, whose positions are the start.

    Args:
        image: (h, w) grey levels.
        lattice: the corners.
        bare_reach: how far from their edges the squares are of one colour, squares.
        bare_edge: how far from the corners edges are read, squares, unless that is too short.
        geometry: steps and curvatures of the edges, if a known camera predicts them better than
            the corners found; see ``BoardPriors.estimate_geometry``.
        priors: what is taken from the board as a whole, where its lines are not evenly spaced.
        are_marks_removed: whether what was printed in the squares was taken out of the image: what
            is left of it looks like light.
    """
    found = lattice.found
    board = priors or (
        LatticePriors(found) if geometry is None else PredictedPriors(found, geometry)
    )
    model = _estimate_start(image, lattice, board, bare_reach, bare_edge)
    arm = model.arm
    is_large = bool((arm > _MAX_NEAR_ARM).any())
    is_long = float(compute_median(arm.ravel())) > _MAX_SHORT_ARM
    model = _approach(image, model, board, is_large=is_large, is_long=is_long)
    products, odd_part = accumulate_normal_equations(image, model, odd=True)
    before = model
    model, inverse, square = take_step(before, products)
    free, free_inverse, free_square = take_lit_step(before, products)
    # What is printed looks like light where it is blurred.
    is_plain = priors is None and min(bare_reach, bare_edge) == 0.5
    has_own_light = find_uneven_light(
        products, square, free_square, ROUNDING_VARIANCE, is_plain, are_marks_removed
    )
    freedom = products[M][M] - UNKNOWNS  # the derivative by m is 1
    noise = pool_noise(estimate_noise(square, odd_part), freedom)
    noise = np.maximum(noise, ROUNDING_VARIANCE)
    covariance = noise[:, None, None] * inverse
    by_bend = np.zeros_like(covariance)
    unbent = model
    if is_large:
        edges = _list_edges(model, image.shape[::-1])
        is_told = is_long or bool(edges.middle.any())
        followed = board.follow_edges(edges, _average_sigma(covariance) if is_told else np.inf)
        better = _update_priors(model, board, arm, followed)
        bend = followed.bend - edges.measure_bend(edges.curvature)
        if is_plain:
            values = model.unknowns[LIGHT]
            covariances = board.estimate_gradient_covariances(followed.steps, values)
            held = add_gradients(before, better, covariances, noise, products)
            model, opened, _ = take_lit_step(before, held)
            opening = np.trace(opened, axis1=1, axis2=2) / np.trace(inverse, axis1=1, axis2=2)
            at = np.flatnonzero(opening > 1 + _MAX_OPEN_LIGHT)
            if len(at):
                held[at] += read_between_edges(image, before.select(at), noise[at])
                model, opened, _ = take_lit_step(before, held)
            model = _correct_for_bend(model, better, edges, bend)
            covariance = noise[:, None, None] * opened
        else:
            unbent = correct_for_light_told(model, inverse, better, edges)
            model = _correct_for_bend(unbent, better, edges, bend)
        by_bend = _compute_bend_covariance(model, followed.variance)
    if has_hard_edges(image, model):
        by_bend = by_bend + _compute_bend_covariance(model, compute_rounding_variance(model))
    growth = estimate_growth(image, model, noise, ~has_own_light)
    if not is_plain:
        lost = noise[:, None, None] * (free_inverse - inverse)
        shift = free.unknowns[C] - unbent.unknowns[C]
        clipped = find_clipped_corners(image, model)
        share, added = estimate_stray_light(shift, growth * lost, ~has_own_light, clipped)
        if share > 0:
            model = go_to_own_light(model, unbent, free, share)
            covariance = covariance + added[:, None, None] * lost
            growth = estimate_growth(image, model, noise, ~has_own_light)
    covariance = growth * covariance
    residual = np.sqrt(square)
    fit = XCornerFit(correct_for_light(model), covariance + by_bend, residual, residual)
    if not has_own_light.any():
        return fit
    lit, covariance, lit_square = fit_local_light(
        image, fit.model.select(np.flatnonzero(has_own_light)), float(square.min())
    )
    other = XCornerFit(
        correct_for_light(lit),
        growth * covariance + by_bend[has_own_light],
        np.sqrt(lit_square),
        residual[has_own_light],
    )
    return replace_fits(fit, other, has_own_light, np.ones(len(lit_square), np.bool_))


def _choose_reaches(arm: float) -> Array:
    """Choose how far, px, arms of which the longest is `arm` are read for one approximation after
    another: near the corners first, and in the end up to a third of it."""
    nearest = _MAX_NEAR_ARM
    growth = max(arm / 3 / nearest, 1.0)
    count = max(math.ceil(math.log(growth, _MAX_ARM_GROWTH)), 1)
    return nearest * growth ** (np.arange(count + 1) / count)


def _approach(
    image: GreyImage, model: XCornerModel, board: BoardPriors, *, is_large: bool, is_long: bool
) -> XCornerModel:
    """Return the model after steps from what is near the corners, its arms as they were.

    Args:
        image: (h, w) grey levels.
        model: the start.
        board: what all corners tell.
        is_large: whether arms are longer than what is read first: edges are then followed.
        is_long: whether they are so long that the edges' directions tell how they bend.
    """
    arm = model.arm
    is_few = len(arm) < MANY_CORNERS
    for i, reach in enumerate(_choose_reaches(float(arm.max()) if is_few else 0.0)):
        near = replace(model, arm=np.minimum(arm, reach))
        products, _ = accumulate_normal_equations(image, near, odd=False)
        near, inverse, square = take_step(near, products)
        sigma = _average_sigma(square[:, None, None] * inverse) if is_long else np.inf
        followed = board.follow_edges(_list_edges(near), sigma) if i and is_large else None
        model = _update_priors(near, board, arm, followed)
    return model


def _average_sigma(covariance: Array) -> float:
    """Average the standard deviations, px, of corners of `covariance` (n, 2, 2)."""
    return float(np.sqrt(compute_median(np.trace(covariance, axis1=1, axis2=2)) / 2))


def _estimate_start(
    image: GreyImage, lattice: Lattice, board: BoardPriors, bare_reach: float, bare_edge: float
) -> XCornerModel:
    """Estimate the model from the lattice and from profiles across the edges."""
    found = lattice.found
    cells = np.argwhere(found)
    n = len(cells)
    steps, curvature = board.estimate_geometry(lattice.uv[found])
    length = compute_lengths(steps)
    height = _compute_heights(steps)
    longest = np.minimum(np.maximum(bare_edge * length, _MIN_ARM), length / 2)
    unknowns = np.zeros((n, UNKNOWNS))
    unknowns[C] = lattice.uv[found]
    unknowns[THETA] = np.arctan2(steps[..., 1], steps[..., 0])
    model = XCornerModel(
        unknowns=unknowns,
        sign=np.where(lattice.dark ^ (cells.sum(axis=1) % 2 == 1), -1.0, 1.0),
        square_height=height,
        arm=longest,
        plain_width=bare_reach * height,
        curvature=curvature,
        curvature_change=np.zeros((n, 2)),
        ink_spread=np.zeros(n),
        level_gradient=np.zeros((n, 2)),
        contrast_gradient=np.zeros((n, 2)),
        blur_gradient=np.zeros((n, 2, 2)),
        height_gradient=np.zeros((n, 2, 2)),
    )
    normals = model.normals()

    def measure_profiles(bare_reach: float) -> list[EdgeProfiles]:
        return [
            edge_profiles.measure_edge_profiles(
                image,
                unknowns[C],
                steps[:, i],
                steps[:, 1 - i],
                height[:, i],
                model.sign,
                bare_reach,
            )
            for i in (0, 1)
        ]

    profiles = measure_profiles(bare_reach)
    one, other = profiles
    low, high = (one.low + other.low) / 2, (one.high + other.high) / 2
    blur = compute_median(np.stack([profile.blur for profile in profiles]))
    unknowns[BLUR] = np.clip(blur, MIN_BLUR, height / 4)
    unknowns[M], unknowns[A] = (high + low) / 2, (high - low) / 2
    unknowns[RHO] = np.sum(normals[:, 0] * normals[:, 1], axis=1)
    if bare_reach < 0.5:  # what lies beyond is blurred into the plain part
        width = model.plain_width
        narrowed = width - _BLUR_REACH * unknowns[BLUR]
        model = replace(model, plain_width=np.maximum(narrowed, width / 2))
        # It would pass for a spread, too: that is measured where nothing beyond is felt, or not.
        blurs = float(compute_median((unknowns[BLUR] / height).ravel()))
        clear = bare_reach - _SPREAD_BLUR_REACH * blurs
        if clear < _MIN_SPREAD_BLURS * blurs:
            return model
        profiles = measure_profiles(min(clear / edge_profiles.REACH_SHARE, bare_reach))
    return replace(model, ink_spread=_estimate_ink_spread(profiles))


def _estimate_ink_spread(profiles: list[EdgeProfiles]) -> Array:
    """Estimate the board's spread (n,) from the profiles of all edges, 0 unless it is clear."""
    spreads = np.column_stack([profile.spread for profile in profiles])
    known = spreads[np.isfinite(spreads)]
    if len(known) < len(spreads):  # fewer than half of the edges
        return np.zeros(len(spreads))
    middle = float(compute_median(known))
    error = 1.5 * float(compute_median(abs(known - middle))) / np.sqrt(len(known) / 2)
    least = max(3 * error, _MIN_INK_SPREAD)
    clear = _MAX_INK_SPREAD > abs(middle) > least
    return np.full(len(spreads), middle if clear else 0.0)


def _list_edges(model: XCornerModel, size: Size | None = None) -> ReadEdges:
    """List what was read of the model's edges: all of the arms, or what lies in an image of a
    size."""
    uv = model.unknowns[C]
    middle, half = np.zeros_like(model.arm), model.arm
    if size is not None:
        middle, half = clip_arms(uv, model.tangents(), model.arm, size)
    return ReadEdges(uv, model.normals(), model.curvature, model.curvature_change, middle, half)


def _compute_bend_covariance(model: XCornerModel, variance: Array) -> Array:
    """Compute what the `variance` (n, 2) px^2 of the edges' bends adds to the covariance (n, 2, 2)
    of the corners."""
    moved = invert_2x2(model.normals())
    return np.asarray((moved * variance[:, None]) @ moved.transpose(0, 2, 1))


def _update_priors(
    model: XCornerModel, board: BoardPriors, arm: Array, edges: EdgeGeometry | None = None
) -> XCornerModel:
    """Return the model with the geometry and gradients that follow from its present unknowns, and
    with the arms `arm` (n, 2) px that are to be read next. The geometry is that of `edges` if these
    were followed."""
    x = model.unknowns
    steps, curvature = (
        board.estimate_geometry(x[C])
        if edges is None
        else (edges.steps, edges.bend * 6 / model.arm**2)
    )
    height = _compute_heights(steps)
    gradients = board.estimate_gradients(steps, np.column_stack([x[M], x[A], x[BLUR], height]))
    # The edge at a fraction w of a square stands w S + w^2 S' / 2 away where the squares' height S
    # varies: w times the height half-way to it.
    normals, by_height = model.normals(), gradients[:, 4:6]
    across = np.sum(normals * by_height, axis=2, keepdims=True)
    return replace(
        model,
        square_height=height,
        arm=arm,
        curvature=curvature,
        curvature_change=np.zeros_like(curvature) if edges is None else edges.curvature_change,
        level_gradient=gradients[:, 0],
        contrast_gradient=gradients[:, 1],
        blur_gradient=gradients[:, 2:4],
        height_gradient=by_height - normals * across / 2,
    )


def _compute_heights(steps: Array) -> Array:
    """Compute the heights (n, 2) of a square over edges 1 and 2 from the `steps` (n, 2, 2) along
    them."""
    (a, b), (c, d) = steps.transpose(1, 2, 0)
    return np.asarray(abs(a * d - b * c)[:, None] / compute_lengths(steps))


def _correct_for_bend(
    model: XCornerModel, better: XCornerModel, edges: ReadEdges, bend: Array
) -> XCornerModel:
    """Return the `better` model with the unknowns and the light of `model`, and its corners where
    they would be had the edges been taken to be bent aside by `bend` (n, 2) px more."""
    unknowns = model.unknowns.copy()
    unknowns[C] -= np.einsum("nij,nj->ni", invert_2x2(edges.normals), bend)
    return replace(
        better,
        unknowns=unknowns,
        level_gradient=model.level_gradient,
        contrast_gradient=model.contrast_gradient,
    )

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
long edges bend the edges' directions do (`edge_map`). What the board leaves open of the curvatures,
which grows with the arms' length, is added to the covariance.

So does the pull of gm grow, and the board tells gm and ga with a covariance. On plain squares they
are unknowns of the last step, which the board holds, and where it leaves them open so does what
lies between the edges (`flat_squares`). Light that varies slowly is known best from the whole
board, light that varies from square to square from the squares at the corner. What is printed in
squares looks like light where it is blurred: there the gradients are the board's, but where the
light ends at a corner (`local_light`) or strays (`stray_light`), and what it leaves open of gm is
added to the covariance.

**Light.** The model lights the blurred pattern, where a camera blurs the lit one. Under light L
that rises by l = grad L / L,

    (L f) * h = L (f * h) + s^2 L l.grad (f * h) = L (f * h)(q + s^2 l)

for a blur h of variance s^2: its far side sends in more light, and the pattern seems to stand
s^2 l farther into the dark. The corner is moved back, with l = ga / a, the relative gradient of
contrast.
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
from calibgui.engine.detection.checkerboard import edge_profiles
from calibgui.engine.detection.checkerboard.board_priors import BoardPriors, PredictedBoardPriors
from calibgui.engine.detection.checkerboard.corner_noise import (
    estimate_growth,
    estimate_noise,
    pool_noise,
)
from calibgui.engine.detection.checkerboard.edge_bend import ReadEdges, clip_arms
from calibgui.engine.detection.checkerboard.edge_map import EdgeGeometry
from calibgui.engine.detection.checkerboard.edge_profiles import EdgeProfiles
from calibgui.engine.detection.checkerboard.fit_thresholds import FIT_THRESHOLDS
from calibgui.engine.detection.checkerboard.flat_squares import read_flat_squares
from calibgui.engine.detection.checkerboard.hard_edges import (
    compute_rounding_variance,
    has_hard_edges,
)
from calibgui.engine.detection.checkerboard.local_light import find_uneven_light, fit_local_light
from calibgui.engine.detection.checkerboard.stray_light import (
    estimate_stray_light,
    find_clipped_corners,
    go_to_own_light,
)
from calibgui.engine.detection.checkerboard.x_corner_model import (
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
from calibgui.engine.detection.checkerboard.x_corner_step import take_lit_step, take_step
from calibgui.engine.detection.detector_io import estimate_least_noise
from calibgui.engine.detection.lattice import Lattice

_THRESHOLDS = FIT_THRESHOLDS.edges
_MAX_BOARD_WEIGHT = 100.0
"""Greatest weight of what the board tells of the light, over that of a corner's pixels."""


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
    plain: float = 0.5,
    bare_edge: float = 0.5,
    geometry: tuple[Array, Array] | None = None,
    priors: BoardPriors | None = None,
    is_bare: bool = False,
) -> XCornerFit:
    """Fit the model at every corner of `lattice`, whose positions are the start.

    Args:
        image: (h, w) grey levels.
        lattice: the corners.
        plain: how far from their edges the squares are of one colour, squares.
        bare_edge: how far from the corners edges are read, squares, unless that is too short.
        geometry: steps and curvatures of the edges, if a known camera predicts them better than
            the corners found; see ``BoardPriors.estimate_geometry``.
        priors: what is taken from the board as a whole, where its lines are not evenly spaced.
        is_bare: whether what was printed in the squares was taken out of the image: what is left of
            it looks like light.
    """
    found = lattice.found
    board = priors or (
        BoardPriors(found) if geometry is None else PredictedBoardPriors(found, geometry)
    )
    model = _estimate_start(image, lattice, board, plain, bare_edge)
    arm = model.arm
    is_large = bool((arm > _THRESHOLDS.max_near_arm).any())
    is_long = float(compute_median(arm.ravel())) > _THRESHOLDS.max_short_arm
    model = _approach(image, model, board, is_large=is_large, is_long=is_long)
    products, odd_part = accumulate_normal_equations(image, model, odd=True)
    before = model
    model, inverse, square = take_step(before, products)
    own, own_inverse, own_square = take_lit_step(before, products)
    least_noise = estimate_least_noise(image)
    # What is printed looks like light where it is blurred.
    is_plain = priors is None and min(plain, bare_edge) == 0.5
    uneven = find_uneven_light(products, square, own_square, least_noise, is_plain, is_bare)
    freedom = products[M][M] - UNKNOWNS  # the derivative by m is 1
    noise = pool_noise(estimate_noise(square, odd_part), freedom)
    noise = np.maximum(noise, least_noise)
    covariance = noise[:, None, None] * inverse
    by_bend = np.zeros_like(covariance)
    boards = model
    if is_large:
        edges = _list_edges(model, image.shape[::-1])
        is_told = is_long or bool(edges.middle.any())
        followed = board.follow_edges(edges, _average_sigma(covariance) if is_told else np.inf)
        better = _update_priors(model, board, arm, followed)
        bend = followed.bend - edges.measure_bend(edges.curvature)
        of_level, of_contrast = board.estimate_gradient_covariances(
            followed.steps, model.unknowns[LIGHT]
        )
        if is_plain:
            told = _add_gradients(before, better, (of_level, of_contrast), noise, products)
            model, opened, _ = take_lit_step(before, told)
            opening = _compute_traces(opened) / _compute_traces(inverse)
            at = np.flatnonzero(opening > 1 + _THRESHOLDS.max_open_light)
            if len(at):
                told[at] += read_flat_squares(image, before.select(at), noise[at])
                model, opened, _ = take_lit_step(before, told)
            model = _correct_for_bend(model, better, edges, bend)
            covariance = noise[:, None, None] * opened
        else:
            boards = _correct_for_light_told(model, inverse, better, edges)
            model = _correct_for_bend(boards, better, edges, bend)
            covariance = covariance + _compute_light_covariance(model, inverse, edges, of_level)
        by_bend = _compute_bend_covariance(model, followed.variance)
    if has_hard_edges(image, model):
        by_bend = by_bend + _compute_bend_covariance(model, compute_rounding_variance(model))
    growth = estimate_growth(image, model, noise, ~uneven)
    if not is_plain:
        lost = noise[:, None, None] * (own_inverse - inverse)
        shift = own.unknowns[C] - boards.unknowns[C]
        clipped = find_clipped_corners(image, model)
        share, added = estimate_stray_light(shift, growth * lost, ~uneven, clipped)
        if share > 0:
            model = go_to_own_light(model, boards, own, share)
            covariance = covariance + added[:, None, None] * lost
            growth = estimate_growth(image, model, noise, ~uneven)
    covariance = growth * covariance
    residual = np.sqrt(square)
    fit = XCornerFit(_correct_for_light(model), covariance + by_bend, residual, residual)
    if not uneven.any():
        return fit
    lit, covariance, lit_square = fit_local_light(
        image, fit.model.select(np.flatnonzero(uneven)), float(square.min())
    )
    other = XCornerFit(
        _correct_for_light(lit),
        growth * covariance + by_bend[uneven],
        np.sqrt(lit_square),
        residual[uneven],
    )
    return replace_fits(fit, other, uneven, np.ones(len(lit_square), np.bool_))


def _choose_reaches(arm: float) -> Array:
    """Choose how far, px, arms of which the longest is `arm` are read for one approximation after
    another: near the corners first, and in the end up to a third of it."""
    nearest = _THRESHOLDS.max_near_arm
    growth = max(arm / 3 / nearest, 1.0)
    count = max(math.ceil(math.log(growth, _THRESHOLDS.max_arm_growth)), 1)
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
    is_few = len(arm) < FIT_THRESHOLDS.priors.many_corners
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
    return float(np.sqrt(compute_median(_compute_traces(covariance)) / 2))


def _compute_traces(matrices: Array) -> Array:
    """Compute the traces (n,) of matrices (n, 2, 2)."""
    return np.asarray(matrices[:, 0, 0] + matrices[:, 1, 1])


def _estimate_start(
    image: GreyImage, lattice: Lattice, board: BoardPriors, plain: float, bare_edge: float
) -> XCornerModel:
    """Estimate the model from the lattice and from profiles across the edges."""
    found = lattice.found
    cells = np.argwhere(found)
    n = len(cells)
    steps, curvature = board.estimate_geometry(lattice.uv[found])
    length = compute_lengths(steps)
    height = _compute_heights(steps)
    longest = np.minimum(np.maximum(bare_edge * length, _THRESHOLDS.min_arm), length / 2)
    unknowns = np.zeros((n, UNKNOWNS))
    unknowns[C] = lattice.uv[found]
    unknowns[THETA] = np.arctan2(steps[..., 1], steps[..., 0])
    model = XCornerModel(
        unknowns=unknowns,
        sign=np.where(lattice.dark ^ (cells.sum(axis=1) % 2 == 1), -1.0, 1.0),
        square_height=height,
        arm=longest,
        plain_width=plain * height,
        curvature=curvature,
        curvature_change=np.zeros((n, 2)),
        ink_spread=np.zeros(n),
        level_gradient=np.zeros((n, 2)),
        contrast_gradient=np.zeros((n, 2)),
        blur_gradient=np.zeros((n, 2, 2)),
        height_gradient=np.zeros((n, 2, 2)),
    )
    normals = model.normals()

    def measure_profiles(plain: float) -> list[EdgeProfiles]:
        return [
            edge_profiles.measure_edge_profiles(
                image, unknowns[C], steps[:, i], steps[:, 1 - i], height[:, i], model.sign, plain
            )
            for i in (0, 1)
        ]

    profiles = measure_profiles(plain)
    one, other = profiles
    low, high = (one.low + other.low) / 2, (one.high + other.high) / 2
    blur = compute_median(np.stack([profile.blur for profile in profiles]))
    unknowns[BLUR] = np.clip(blur, MIN_BLUR, height / 4)
    unknowns[M], unknowns[A] = (high + low) / 2, (high - low) / 2
    unknowns[RHO] = np.sum(normals[:, 0] * normals[:, 1], axis=1)
    if plain < 0.5:  # what lies beyond is blurred into the plain part
        width = model.plain_width
        narrowed = width - _THRESHOLDS.blur_reach * unknowns[BLUR]
        model = replace(model, plain_width=np.maximum(narrowed, width / 2))
        # It would pass for a spread, too: that is measured where nothing beyond is felt, or not.
        blurs = float(compute_median((unknowns[BLUR] / height).ravel()))
        clear = plain - _THRESHOLDS.spread_blur_reach * blurs
        if clear < _THRESHOLDS.min_spread_blurs * blurs:
            return model
        profiles = measure_profiles(min(clear / edge_profiles.REACH_SHARE, plain))
    return replace(model, ink_spread=_estimate_ink_spread(profiles))


def _estimate_ink_spread(profiles: list[EdgeProfiles]) -> Array:
    """Estimate the board's spread (n,) from the profiles of all edges, 0 unless it is clear."""
    spreads = np.column_stack([profile.spread for profile in profiles])
    known = spreads[np.isfinite(spreads)]
    if len(known) < len(spreads):  # fewer than half of the edges
        return np.zeros(len(spreads))
    middle = float(compute_median(known))
    error = 1.5 * float(compute_median(abs(known - middle))) / np.sqrt(len(known) / 2)
    least = max(3 * error, _THRESHOLDS.min_ink_spread)
    clear = _THRESHOLDS.max_ink_spread > abs(middle) > least
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


def _compute_light_covariance(
    model: XCornerModel, inverse: Array, edges: ReadEdges, gradient: Array
) -> Array:
    """Compute what the covariance of the level's `gradient` (n, 2, 2) adds to that of the corners
    (n, 2, 2); see `_correct_for_light_told`."""
    swing = 2 * model.sign * model.unknowns[A]
    by_gradient = np.einsum(
        "ni,nij,nik->njk", edges.half**2 + edges.middle**2, edges.normals, model.tangents()
    )
    moved = inverse @ (swing[:, None, None] * by_gradient)
    return np.asarray(moved @ gradient @ moved.transpose(0, 2, 1))


def _add_gradients(
    before: XCornerModel,
    better: XCornerModel,
    covariances: tuple[Array, Array],
    noise: Array,
    products: Array,
) -> Array:
    """Add what the board as a whole tells of the light's gradients to the products of the pixels.

    It counts at most as a hundred times the pixels that are read at a corner: far more would be
    lost to rounding.

    Args:
        before: the model that the products belong to.
        better: the model with the gradients that the board tells.
        covariances: of these gm and ga, (n, 2, 2).
        noise: (n,) square of the noise, grey levels^2.
        products: (n, 14, 14) of the pixels.

    Returns:
        (n, 14, 14) the products of both.
    """
    told = products.copy()
    lacks = (
        better.level_gradient - before.level_gradient,
        better.contrast_gradient - before.contrast_gradient,
    )
    for i, (lack, covariance) in enumerate(zip(lacks, covariances, strict=True)):
        at = slice(UNKNOWNS + 1 + 2 * i, UNKNOWNS + 3 + 2 * i)
        pixels = _compute_traces(products[:, at, at])
        least = noise / (_MAX_BOARD_WEIGHT * np.maximum(pixels, 1e-300))
        bounded = covariance + least[:, None, None] * np.eye(2)
        weight = noise[:, None, None] * invert_2x2(bounded)
        pull = np.einsum("nij,nj->ni", weight, lack)
        told[:, at, at] += weight
        told[:, at, UNKNOWNS] += pull
        told[:, UNKNOWNS, at] += pull
    return told


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


def _correct_for_light_told(
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


def _correct_for_light(model: XCornerModel) -> XCornerModel:
    """Return the model with its corners back from where light and blur have moved them."""
    unknowns = model.unknowns.copy()
    variance = np.mean(unknowns[BLUR] ** 2, axis=1)
    unknowns[C] += (variance / unknowns[A])[:, None] * model.contrast_gradient
    return replace(model, unknowns=unknowns)

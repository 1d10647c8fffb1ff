"""Is a refined lattice a board? A wrong grid is worse than none.

Textures, tilings and printed pictures have X-junctions that hang together in lattices. What tells
a board from them is that all of its corners are alike, evenly laid out and surrounded by flat
squares. The rules, in the order in which they are asked:

- every corner looks like the board's typical corner and lies where its neighbours on the lattice
  expect it (`find_sound_corners`); others are left out, and if too many are, the board is no board
  (`is_credible`);
- the corners lie on one smooth grid map, and hardly any place between them shows squares that form
  no corner (`drop_broken_lines`);
- border lines that are not full, behind the end of the board, are left out (`board_ends`);
- the edge model fitted to a corner describes it (`find_described_corners`), and those that it
  describes worse are hardly drawn aside (`find_displaced_corners`);
- the edges step from one square to the next (`has_step_edges`): waves cross likewise, only wider.

The prefilter (`prefilter`) and the test against chance (`a_contrario`) are asked as well. Their
limits and the ones here are in `thresholds`. The rules say nothing about the accuracy of a corner:
that is the covariance of its fit.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage, compute_lengths, compute_median
from calibgui.engine.detection import grid_map
from calibgui.engine.detection.checkerboard.board_ends import (
    are_in_image,
    drop_stray_lines,
    stands_alone,
)
from calibgui.engine.detection.checkerboard.corner_template import (
    compare_light,
    estimate_template,
    estimate_template_of,
    measure_light,
    orient_corners,
)
from calibgui.engine.detection.checkerboard.fit_thresholds import FIT_THRESHOLDS
from calibgui.engine.detection.checkerboard.thresholds import THRESHOLDS
from calibgui.engine.detection.checkerboard.x_corner_fit import XCornerFit
from calibgui.engine.detection.corners import find_usable_covariances
from calibgui.engine.detection.lattice import (
    Lattice,
    add_border,
    drop_isolated,
    drop_isolated_and_crop,
    estimate_steps,
    measure_in_steps,
    predict_places,
)

TOO_BLURRED = "its edges are too blurred, or too ragged, to be told from waves"
"""What speaks against a lattice of wide edges."""
DRAWN_ASIDE = "drawn aside by what is seen there"
"""The reason to reject a corner that lies where the others do not expect it."""

_PLAIN_NEAR = 0.25
"""Distance from the corners, squares, to which marks in the squares, and what hides a part of them,
do not reach."""


def find_sound_corners(
    lattice: Lattice, image: GreyImage, plain: float = 0.5, marked: Array | None = None
) -> BoolArray:
    """Find the corners of a lattice that look like the others and lie where these expect them.

    Neighbours in a line expect a corner where the line goes on as it did. Where a lens bends the
    lines so much that they mislead, the smooth grid map through all others decides, or markers.

    Args:
        lattice: refined corners.
        image: (h, w) grey levels.
        plain: distance from their edges up to which the squares are of one colour, squares.
        marked: (rows, cols, 2) px, where markers beside the corners expect them, NaN where none do.

    Returns:
        A mask (rows, cols).
    """
    lattice = drop_isolated(lattice)
    if not len(lattice):
        return lattice.found
    good = _match_template(lattice, image, plain)
    failing = len(lattice) - int(np.count_nonzero(good))
    if failing and marked is None:  # markers begin as near as that
        # Marks in the squares differ, and what covers a part of them; what is near does not.
        # Beside more corners than may fail, that has to be as like as elsewhere.
        if is_credible(failing, len(lattice)):
            limit = FIT_THRESHOLDS.template.max_dissimilarity_near
            near = good | _match_template(lattice, image, min(plain, _PLAIN_NEAR), limit)
            good |= near & ~_find_sparse_lines(near)
        elif plain == 0.5:
            good |= _match_template(lattice, image, _PLAIN_NEAR)
    # What does not look like a corner says nothing about where its neighbours should be.
    alike = lattice.select(good)
    uv, steps = alike.uv, alike.steps()
    deviation = measure_in_steps(uv - predict_places(uv), *steps)
    astray = good & (deviation >= THRESHOLDS.verification.max_deviation)
    if marked is not None:
        off = measure_in_steps(uv - marked, *steps)
        astray &= ~(off < THRESHOLDS.verification.max_deviation)
    if astray.any() and not astray[good].all():
        off = _measure_off_map(lattice.select(good & ~astray), lattice, astray)
        astray[astray] = ~(off < THRESHOLDS.verification.max_grid_map_rms)
    if not is_credible(int(np.count_nonzero(astray)), len(alike)):
        astray = _find_off_map(alike, astray)
    return np.asarray(good & ~astray)


def _measure_off_map(known: Lattice, lattice: Lattice, places: BoolArray) -> Array:
    """Measure how far the corners of a lattice at some places (rows, cols) lie from the grid map
    through those `known`, (n,) steps; NaN where there are too few to tell steps."""
    smooth = grid_map.fit_grid_map(known, are_exact=True)
    expected = smooth.locate(np.argwhere(places).astype(np.float64))
    right, down = (step[places] for step in lattice.steps())
    return measure_in_steps(lattice.uv[places] - expected, right, down)


def _find_off_map(lattice: Lattice, astray: BoolArray) -> BoolArray:
    """Find which of the corners that are `astray` (rows, cols) the grid map through all others does
    not expect either: a strong lens over few squares misleads most neighbours."""
    limit = THRESHOLDS.verification.max_grid_map_rms
    if not (_measure_off_map(lattice, lattice, astray) < limit).any():
        return astray
    astray = astray.copy()
    for place in map(tuple, np.argwhere(astray)):
        one = np.zeros_like(astray)
        one[place] = True
        astray[place] = not _measure_off_map(lattice.select(~one), lattice, one)[0] < limit
    return astray


def _find_sparse_lines(found: BoolArray) -> BoolArray:
    """Find the places (rows, cols) in whose row or column hardly any corners are `found`, as beyond
    the end of a board."""
    least = THRESHOLDS.verification.min_border_corners
    few = [found.mean(axis=axis, keepdims=True) < least for axis in (0, 1)]
    return np.asarray(few[0] | few[1])


def _match_template(
    lattice: Lattice,
    image: GreyImage,
    plain: float,
    max_dissimilarity: float = FIT_THRESHOLDS.template.max_dissimilarity,
) -> BoolArray:
    """Return a mask (rows, cols) of the corners that look like the typical one where squares are
    `plain`, see `CornerTemplate.match`."""
    corners = orient_corners(lattice).shorten_steps(plain)
    template, alike = estimate_template_of(corners, image), lattice.found
    good, _ = template.match(image, *corners, max_dissimilarity)
    if not good.all():  # a part may lie in shade
        light = measure_light(image, corners)
        good, _ = template.match(image, *corners, max_dissimilarity, light)
    alike[alike] = good
    return alike


def is_credible(failing: int, found: int) -> bool:
    """Return whether so few of the corners found fail that their board is to be trusted."""
    return failing <= THRESHOLDS.verification.max_failing_corners * found


def drop_broken_lines(lattice: Lattice, image: GreyImage) -> Lattice:
    """Drop border lines in which more places show squares that form no corner than corners.

    Something may hide a corner, but where even squares are seen that do not alternate there is
    none: beyond the border of the board, and in textures of squares at random.

    Returns:
        What is left of the lattice, without stray lines; nothing if many such places are left, or
        if the corners lie on no smooth grid map.
    """
    limits = THRESHOLDS.verification
    cells = np.argwhere(lattice.found).astype(np.float64)
    smooth = grid_map.fit_grid_map(lattice, are_exact=True)
    off = compute_lengths(smooth.locate(cells) - lattice.uv[lattice.found])
    if np.sqrt(np.mean((off / lattice.spacing()[lattice.found]) ** 2)) > limits.max_grid_map_rms:
        return drop_isolated_and_crop(lattice.select(np.zeros(lattice.shape, dtype=np.bool_)))
    broken = _find_broken_places(lattice, image)
    kept = np.ones(lattice.shape, dtype=np.bool_)
    while kept.any():
        rows, cols = np.flatnonzero(kept.any(axis=1)), np.flatnonzero(kept.any(axis=0))
        borders = ((rows[0], cols), (rows[-1], cols), (rows, cols[0]), (rows, cols[-1]))
        excess = [int(broken[line].sum() - lattice.found[line].sum()) for line in borders]
        if max(excess) <= 0:
            break
        kept[borders[int(np.argmax(excess))]] = False
    corners = np.count_nonzero(lattice.found & kept)
    if (count := np.count_nonzero(broken & kept)) > limits.max_broken_places * corners:
        is_covered = count <= limits.max_broken_places_alone * corners and stands_alone(
            lattice.select(kept), image
        )
        if not is_covered:
            kept[:] = False
    return drop_stray_lines(drop_isolated_and_crop(lattice.select(kept)), image)


def _find_broken_places(lattice: Lattice, image: GreyImage) -> BoolArray:
    """Find the places (rows, cols) inside a lattice where squares are seen but no corner."""
    right, down = lattice.steps()
    broken = ~lattice.found & np.isfinite(right + down).all(axis=2)
    places = np.argwhere(broken)
    if not len(places):
        return broken
    smooth = grid_map.fit_grid_map(lattice, are_exact=True)
    uv = smooth.locate(places.astype(np.float64))
    dark = lattice.dark ^ (places.sum(axis=1) % 2 == 1)
    contradicted = estimate_template(lattice, image).contradict(
        image, uv, right[broken], down[broken], dark
    )
    broken[broken] = contradicted & are_in_image(uv, image.shape)
    return np.asarray(broken)


def does_pattern_continue(lattice: Lattice, image: GreyImage) -> bool:
    """Return whether the pattern goes on around a lattice that could not grow there, because its
    corners look otherwise there."""
    uv = add_border(lattice.uv, 1)
    place, (right, down) = predict_places(uv), estimate_steps(uv)
    around = np.isnan(uv[..., 0]) & np.isfinite(place + right + down).all(axis=2)
    around &= are_in_image(place, image.shape)
    dark = lattice.dark ^ (np.argwhere(around).sum(axis=1) % 2 == 1)
    alternate, _ = estimate_template(lattice, image).match_colours(
        image, place[around], right[around], down[around], dark
    )
    limit = THRESHOLDS.verification.max_alternating_places * len(alternate)
    return bool(np.count_nonzero(alternate) > limit)


def find_askew_corners(fit: XCornerFit, around: Lattice, found: BoolArray) -> BoolArray:
    """Find the corners (n,), those under the mask `found`, whose fitted edges do not point to the
    neighbours in the lattice `around`: not even bent paper has such, but what lies over it has."""
    limits = THRESHOLDS.verification
    steps = np.stack([step[found] for step in around.steps()], axis=1)
    sine = np.abs(np.sum(fit.model.normals() * steps, axis=2)) / compute_lengths(steps)
    max_sine = np.maximum(
        limits.max_edge_angle_sine, limits.max_relative_edge_angle * np.median(sine, axis=0)
    )
    return np.asarray((sine > max_sine).any(axis=1))


def find_described_corners(
    fit: XCornerFit,
    lattice: Lattice,
    expected: Array | None = None,
    displacement: Array | None = None,
) -> BoolArray:
    """Find the corners of a lattice that the edge model fitted there describes.

    The fit has to stay near, its edges have to be as strong as the board's, and it may leave no
    more unexplained than elsewhere; still less if they do not point to the corner's neighbours.
    Where it is known how far the corner is drawn aside, more is tolerated.

    Args:
        fit: edge model at the lattice's n corners.
        lattice: corners before the fit.
        expected: (rows, cols, 2) px to which the edges point, the neighbours if None.
        displacement: (n,) px by which covariances will be widened, 0 if None.

    Returns:
        A mask (n,).
    """
    limits = THRESHOLDS.verification
    shift = compute_lengths(fit.uv - lattice.uv[lattice.found])
    typical = float(compute_median(fit.residual))
    around = lattice if expected is None else Lattice(expected, lattice.dark)
    spacing = around.spacing()[lattice.found]
    is_wide = np.zeros(len(fit.uv), np.bool_) if displacement is None else displacement > 0
    askew = find_askew_corners(fit, around, lattice.found) & ~is_wide
    to_contrast = np.where(is_wide, limits.max_residual_if_widened, limits.max_residual_to_contrast)
    max_residual = np.maximum(limits.max_relative_residual * typical, to_contrast * fit.contrast)
    light = compare_light(fit.bright)
    return np.asarray(
        (shift <= limit_fit_shift(spacing))
        & ~(askew & (fit.residual > limits.suspect_relative_residual * typical))
        & (fit.contrast > limits.min_relative_contrast * light * compute_median(fit.contrast))
        & (fit.residual <= max_residual)
        & find_usable_covariances(fit.covariance)
    )


def find_doubtful_lines(lattice: Lattice, residual: Array, displacement: Array) -> BoolArray:
    """Find the corners (n,) of the border lines of a lattice that are not full and all of whose
    corners the edge model describes worse than most, by its `residual` (n,), or are drawn far aside
    by a `displacement` (n,) px: such are the rims of things that lie on the board's end, and what
    meets its squares there by chance."""
    limit = THRESHOLDS.verification.max_partial_displacement * lattice.spacing()[lattice.found]
    clear = lattice.found
    clear[clear] = ~find_suspect_corners(residual) & (displacement <= limit)
    doubtful = np.zeros(lattice.shape, np.bool_)
    for line in (np.s_[0], np.s_[-1], np.s_[:, 0], np.s_[:, -1]):
        is_partial = lattice.found[line].mean() < THRESHOLDS.verification.min_full_border
        doubtful[line] |= is_partial and not clear[line].any()
    return np.asarray(doubtful[lattice.found])


def find_suspect_corners(residual: Array) -> BoolArray:
    """Find the corners (n,) that the edge model describes worse than most, by its `residual` (n,)
    there."""
    limit = THRESHOLDS.verification.suspect_relative_residual
    return np.asarray(residual > limit * compute_median(residual))


def compare_residuals(residual: Array, contrast: Array) -> Array:
    """Return the `residual` (n,) of the edge fit, less where light makes the `contrast` (n,) much
    more than that of most: what the model cannot describe of an edge, as the levels at which a
    camera is overexposed, is in proportion to it."""
    limit = THRESHOLDS.verification.max_even_contrast
    return np.asarray(residual / np.maximum(contrast / (limit * compute_median(contrast)), 1.0))


def find_displaced_corners(fit: XCornerFit, cells: Array, suspect: BoolArray) -> BoolArray:
    """Find the suspect corners that the edge model puts where the others do not expect them.

    Where the edge of a shadow or of a reflection runs through a corner there are two crossing
    edges, and something that draws them aside by much more than noise would. If all are suspect
    nothing tells.

    Args:
        fit: edge model at n corners.
        cells: (n, 2) rows and columns of these on the board.
        suspect: (n,) those that the model describes worse than most.

    Returns:
        A mask (n,).
    """
    if not suspect.any() or suspect.all():
        return np.zeros_like(suspect)
    limits = THRESHOLDS.verification
    off = measure_displacements(fit.uv, cells, ~suspect)
    usual = np.sqrt(np.mean(off[~suspect] ** 2))
    limit = max(limits.max_relative_displacement * usual, limits.max_displacement)
    return np.asarray(suspect & ~(off <= limit))


def measure_displacements(uv: Array, cells: Array, undisturbed: BoolArray) -> Array:
    """Measure how far corners lie from where the undisturbed ones expect them.

    Args:
        uv: (n, 2) px, the corners.
        cells: (n, 2) rows and columns of these on the board.
        undisturbed: (n,) those of them whose smooth grid map is taken.

    Returns:
        (n,) px.
    """
    expected = grid_map.fit_cells(cells[undisturbed], uv[undisturbed], are_exact=True).locate(cells)
    return np.asarray(compute_lengths(uv - expected))


def find_tolerable_displacements(displacement: Array, lattice: Lattice) -> BoolArray:
    """Find the corners of a lattice that are drawn aside, (n,) px, by no more than the edge fit may
    move them: with a covariance as large they are still of use."""
    return np.asarray(displacement <= limit_fit_shift(lattice.spacing()[lattice.found]))


def limit_fit_shift(spacing: Array) -> Array:
    """Return how far corners `spacing` (n,) px apart may lie from where they are expected, px."""
    limits = THRESHOLDS.verification
    return np.maximum(limits.max_fit_shift * spacing, limits.min_fit_shift_limit)


def has_step_edges(fit: XCornerFit, is_alone: bool = False, noise: float = 0.0) -> bool:
    """Return whether the squares are flat inside and step at their edges: waves cross likewise,
    only wider, and are not described by steps; `noise`, grey levels, is left out of account. A
    lattice that `is_alone`, see `board_ends`, may have edges that are less like steps, and wider,
    unless its squares overlap or part by much: that may be discs."""
    limits = THRESHOLDS.verification
    blur = _measure_blur(fit)
    unexplained = np.sqrt(np.maximum(fit.residual**2 - noise**2, 0.0))
    misfit = compute_median(unexplained / fit.contrast)
    if not is_alone:
        return bool(blur < limits.max_edge_blur and misfit < limits.max_median_misfit)
    is_even = abs(compute_median(fit.model.ink_spread)) < limits.max_spread_if_blurred
    max_blur = THRESHOLDS.prefilter.max_edge_blur_alone if is_even else limits.max_edge_blur
    return bool(blur < max_blur and misfit < limits.max_median_misfit_alone)


def are_edges_too_wide(fit: XCornerFit) -> bool:
    """Return whether edges are wider than those of any board, one that stands alone among them: see
    `has_step_edges`. The fit of all corners tells, since to leave out some hardly changes that."""
    return _measure_blur(fit) >= THRESHOLDS.prefilter.max_edge_blur_alone


def _measure_blur(fit: XCornerFit) -> float:
    """Measure the median blur of the edges in the direction in which they are wider, squares."""
    relative = fit.model.unknowns[:, 4:6] / fit.model.square_height
    return float(compute_median(relative, axis=0).max())


def fill_gaps(lattice: Lattice, shape: tuple[int, ...]) -> Lattice:
    """Fill the gaps of a lattice with the places where the neighbours expect their corners.

    Only places inside the image of `shape` (h, w) are filled, not too far from all corners.
    """
    expected = predict_places(lattice.uv)
    filled = ~lattice.found & are_in_image(expected, shape)
    return drop_isolated(Lattice(np.where(filled[..., None], expected, lattice.uv), lattice.dark))

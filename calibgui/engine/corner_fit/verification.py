"""Is a refined lattice a board? A wrong grid is worse than none.

Textures, tilings and printed pictures have X-junctions that hang together in lattices. What tells
a board from them is that all of its corners are alike, evenly laid out and surrounded by flat
squares. The rules, in the order in which they are asked:

- every corner looks like the board's typical corner and lies where its neighbours on the lattice
  expect it (`find_sound_corners`); others are left out, and if too many are, the board is no board
  (`is_credible`);
- the corners lie on one smooth grid map (`lies_on_smooth_map`);
- border lines that are not full, behind the end of the board, are left out (`board_ends`);
- the edge model fitted to a corner describes it (`find_described_corners`), and those that it
  describes worse are hardly drawn aside (`find_displaced_corners`);
- the edges step from one square to the next (`has_step_edges`): waves cross likewise, only wider.

The prefilter (`prefilter`) and the test against chance (`a_contrario`) are asked as well. The rules
say nothing about the accuracy of a corner: that is the covariance of its fit.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage, compute_lengths, compute_median
from calibgui.engine.corner_fit.x_corner_fit import XCornerFit
from calibgui.engine.features.corner_template import (
    BARE_REACH_IF_PRINTED,
    MAX_DISSIMILARITY,
    MIN_RELATIVE_CONTRAST,
    compare_light,
    estimate_template_of,
    measure_light,
    orient_corners,
)
from calibgui.engine.features.corners import find_usable_covariances
from calibgui.engine.features.lattice import (
    Lattice,
    drop_isolated,
    measure_in_steps,
    predict_places,
)
from calibgui.engine.lattices import grid_map
from calibgui.engine.lattices.board_ends import MIN_FULL_BORDER, are_in_image
from calibgui.engine.lattices.board_separation import MAX_DEVIATION
from calibgui.engine.lattices.prefilter import MAX_EDGE_BLUR, MAX_EDGE_BLUR_ALONE

_MAX_FAILING_CORNERS = 0.25
"""Share of its corners that may fail before the board does."""
_MAX_GRID_MAP_RMS = 0.1
"""Greatest rms distance of a board's corners from the smooth grid map through them, steps."""
_MAX_FIT_SHIFT = 0.1
"""Greatest distance that the edge fit may move a corner, squares ..."""
_MIN_FIT_SHIFT_LIMIT = 1.0
"""... or px, whichever is more."""
_MAX_RELATIVE_RESIDUAL = 4.0
"""Greatest residual of the edge fit, over the board's median ..."""
MAX_RESIDUAL_TO_CONTRAST = 0.15
"""... or over the corner's contrast, whichever is more ..."""
MAX_RESIDUAL_IF_WIDENED = 0.19
"""... if the covariance does not say how far the corner is drawn aside, or else this. Fixed by
the trouble "shadow" of `tests.benchmarks.corner_troubles`."""
_MAX_EDGE_ANGLE_SINE = float(np.sin(np.radians(3.0)))
"""Sine of the angle between an edge and the step to its neighbours, beyond which the edge is
askew ..."""
_MAX_RELATIVE_EDGE_ANGLE = 10.0
"""... or the same sine over the board's median, which distortion raises, whichever is more. Fixed
by the "clips" of `tests.benchmarks.corner_troubles`: 2 of 54 boards have a wrong corner without."""
_MAX_EVEN_CONTRAST = 1.5
"""Contrast of a corner, over the board's median, beyond which its light is another. Fixed by "half
in the sun" of `tests.benchmarks.corner_troubles`, of which boards are lost without."""
SUSPECT_RELATIVE_RESIDUAL = 2.5
"""Residual of the edge fit, over the board's median, beyond which a corner is dropped if its
edges are askew or if it lies astray."""
MAX_RELATIVE_DISPLACEMENT = 6.0
"""Greatest distance of a corner of such a residual from where the grid map of the others places
it, over their own rms distance from there ..."""
MAX_DISPLACEMENT = 0.03
"""... or in px, whichever is more."""
_MAX_PARTIAL_DISPLACEMENT = 0.03
"""Distance of a corner from where the others expect it, squares, beyond which it does not speak for
a border line that is not full. Fixed by the "clips" of `tests.benchmarks.corner_troubles`: without
it 3 of 40 boards have a wrong corner."""
_MAX_MEDIAN_MISFIT = 0.25
"""Greatest median residual of the edge fit over the contrast. Fixed by the "waves"."""
_MAX_MEDIAN_MISFIT_ALONE = 0.4
"""The same of a lattice that stands alone."""
_MAX_SPREAD_IF_BLURRED = 0.05
"""Greatest spread of the dark squares of such a lattice if its edges are wider than others may
be, squares: that of discs that blur has joined is 0.08 and more."""
_MAX_DISSIMILARITY_NEAR = 0.18
"""... or, near the corners of a board most of whose corners are alike, whatever shadow or dead
pixel is seen there. Those have up to 0.16; what is behind a finger 0.2 and more, or colours
that do not alternate. Fixed by the troubles "shadow", "dead pixels", "hand" and "object" of
`tests.benchmarks.corner_troubles`."""
DRAWN_ASIDE = "drawn aside by what is seen there"
"""The reason to reject a corner that lies where the others do not expect it."""


def find_sound_corners(
    lattice: Lattice, image: GreyImage, bare_reach: float = 0.5, marked: Array | None = None
) -> BoolArray:
    """Find the corners of a lattice that look like the others and lie where these expect them.

    Neighbours in a line expect a corner where the line goes on as it did. Where a lens bends the
    lines so much that they mislead, the smooth grid map through all others decides, or markers.

    Args:
        lattice: refined corners.
        image: (h, w) grey levels.
        bare_reach: distance from their edges up to which the squares are of one colour, squares.
        marked: (rows, cols, 2) px, where markers beside the corners expect them, NaN where none do.

    Returns:
        A mask (rows, cols).
    """
    lattice = drop_isolated(lattice)
    if not len(lattice):
        return lattice.found
    good = _match_template(lattice, image, bare_reach)
    failing = len(lattice) - int(np.count_nonzero(good))
    if failing and marked is None:  # markers begin as near as that
        # Marks in the squares differ, and what covers a part of them; what is near does not.
        # Beside more corners than may fail, that has to be as like as elsewhere.
        if is_credible(failing, len(lattice)):
            limit = _MAX_DISSIMILARITY_NEAR
            good |= _match_template(lattice, image, min(bare_reach, BARE_REACH_IF_PRINTED), limit)
        elif bare_reach == 0.5:
            good |= _match_template(lattice, image, BARE_REACH_IF_PRINTED)
    # What does not look like a corner says nothing about where its neighbours should be.
    alike = lattice.select(good)
    uv, steps = alike.uv, alike.steps()
    deviation = measure_in_steps(uv - predict_places(uv), *steps)
    astray = good & (deviation >= MAX_DEVIATION)
    if marked is not None:
        off = measure_in_steps(uv - marked, *steps)
        astray &= ~(off < MAX_DEVIATION)
    if astray.any() and not astray[good].all():
        off = _measure_off_map(lattice.select(good & ~astray), lattice, astray)
        astray[astray] = ~(off < _MAX_GRID_MAP_RMS)
    return np.asarray(good & ~astray)


def _measure_off_map(known: Lattice, lattice: Lattice, places: BoolArray) -> Array:
    """Measure how far the corners of a lattice at some places (rows, cols) lie from the grid map
    through those `known`, (n,) steps; NaN where there are too few to tell steps."""
    smooth = grid_map.fit_grid_map(known, are_exact=True)
    expected = smooth.locate(np.argwhere(places).astype(np.float64))
    right, down = (step[places] for step in lattice.steps())
    return measure_in_steps(lattice.uv[places] - expected, right, down)


def _match_template(
    lattice: Lattice,
    image: GreyImage,
    bare_reach: float,
    max_dissimilarity: float = MAX_DISSIMILARITY,
) -> BoolArray:
    """Return a mask (rows, cols) of the corners that look like the typical one where squares are
    `bare_reach`, see `CornerTemplate.match`."""
    corners = orient_corners(lattice).shorten_steps(bare_reach)
    template, alike = estimate_template_of(corners, image), lattice.found
    good, _ = template.match(image, *corners, max_dissimilarity)
    if not good.all():  # a part may lie in shade
        light = measure_light(image, corners)
        good, _ = template.match(image, *corners, max_dissimilarity, light)
    alike[alike] = good
    return alike


def is_credible(failing: int, found: int) -> bool:
    """Return whether so few of the corners found fail that their board is to be trusted."""
    return failing <= _MAX_FAILING_CORNERS * found


def lies_on_smooth_map(lattice: Lattice) -> bool:
    """Return whether the corners of a lattice lie on one smooth grid map."""
    cells = np.argwhere(lattice.found).astype(np.float64)
    smooth = grid_map.fit_grid_map(lattice, are_exact=True)
    off = compute_lengths(smooth.locate(cells) - lattice.uv[lattice.found])
    rms = np.sqrt(np.mean((off / lattice.spacing()[lattice.found]) ** 2))
    return bool(rms <= _MAX_GRID_MAP_RMS)


def find_askew_corners(fit: XCornerFit, lattice: Lattice) -> BoolArray:
    """Find the corners (n,) of a lattice whose fitted edges do not point to their neighbours: not
    even bent paper has such, but what lies over it has."""
    steps = np.stack([step[lattice.found] for step in lattice.steps()], axis=1)
    sine = np.abs(np.sum(fit.model.normals() * steps, axis=2)) / compute_lengths(steps)
    max_sine = np.maximum(_MAX_EDGE_ANGLE_SINE, _MAX_RELATIVE_EDGE_ANGLE * np.median(sine, axis=0))
    return np.asarray((sine > max_sine).any(axis=1))


def find_described_corners(
    fit: XCornerFit, lattice: Lattice, displacement: Array | None = None
) -> BoolArray:
    """Find the corners of a lattice that the edge model fitted there describes.

    The fit has to stay near, its edges have to be as strong as the board's, and it may leave no
    more unexplained than elsewhere, still less if they do not point to the corner's neighbours;
    where it is known how far the corner is drawn aside, more is tolerated.

    Args:
        fit: edge model at the lattice's n corners.
        lattice: corners before the fit.
        displacement: (n,) px by which covariances will be widened, 0 if None.

    Returns:
        A mask (n,).
    """
    shift = compute_lengths(fit.uv - lattice.uv[lattice.found])
    typical = float(compute_median(fit.residual))
    spacing = lattice.spacing()[lattice.found]
    is_wide = np.zeros(len(fit.uv), np.bool_) if displacement is None else displacement > 0
    askew = find_askew_corners(fit, lattice) & ~is_wide
    to_contrast = np.where(is_wide, MAX_RESIDUAL_IF_WIDENED, MAX_RESIDUAL_TO_CONTRAST)
    max_residual = np.maximum(_MAX_RELATIVE_RESIDUAL * typical, to_contrast * fit.contrast)
    light = compare_light(fit.bright)
    return np.asarray(
        (shift <= limit_fit_shift(spacing))
        & ~(askew & (fit.residual > SUSPECT_RELATIVE_RESIDUAL * typical))
        & (fit.contrast > MIN_RELATIVE_CONTRAST * light * compute_median(fit.contrast))
        & (fit.residual <= max_residual)
        & find_usable_covariances(fit.covariance)
    )


def find_doubtful_lines(lattice: Lattice, residual: Array, displacement: Array) -> BoolArray:
    """Find the corners (n,) of the border lines of a lattice that are not full and all of whose
    corners the edge model describes worse than most, by its `residual` (n,), or are drawn far aside
    by a `displacement` (n,) px: such are the rims of things that lie on the board's end, and what
    meets its squares there by chance."""
    limit = _MAX_PARTIAL_DISPLACEMENT * lattice.spacing()[lattice.found]
    clear = lattice.found
    clear[clear] = ~find_suspect_corners(residual) & (displacement <= limit)
    doubtful = np.zeros(lattice.shape, np.bool_)
    for line in (np.s_[0], np.s_[-1], np.s_[:, 0], np.s_[:, -1]):
        is_partial = lattice.found[line].mean() < MIN_FULL_BORDER
        doubtful[line] |= is_partial and not clear[line].any()
    return np.asarray(doubtful[lattice.found])


def find_suspect_corners(residual: Array) -> BoolArray:
    """Find the corners (n,) that the edge model describes worse than most, by its `residual` (n,)
    there."""
    limit = SUSPECT_RELATIVE_RESIDUAL
    return np.asarray(residual > limit * compute_median(residual))


def compare_residuals(residual: Array, contrast: Array) -> Array:
    """Return the `residual` (n,) of the edge fit, less where light makes the `contrast` (n,) much
    more than that of most: what the model cannot describe of an edge, as the levels at which a
    camera is overexposed, is in proportion to it."""
    return np.asarray(
        residual / np.maximum(contrast / (_MAX_EVEN_CONTRAST * compute_median(contrast)), 1.0)
    )


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
    off = measure_displacements(fit.uv, cells, ~suspect)
    usual = np.sqrt(np.mean(off[~suspect] ** 2))
    limit = max(MAX_RELATIVE_DISPLACEMENT * usual, MAX_DISPLACEMENT)
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
    return np.maximum(_MAX_FIT_SHIFT * spacing, _MIN_FIT_SHIFT_LIMIT)


def has_step_edges(fit: XCornerFit, is_alone: bool = False, noise: float = 0.0) -> bool:
    """Return whether the squares are flat inside and step at their edges: waves cross likewise,
    only wider, and are not described by steps; `noise`, grey levels, is left out of account. A
    lattice that `is_alone`, see `board_ends`, may have edges that are less like steps, and wider,
    unless its squares overlap or part by much: that may be discs."""
    blur = _measure_blur(fit)
    unexplained = np.sqrt(np.maximum(fit.residual**2 - noise**2, 0.0))
    misfit = compute_median(unexplained / fit.contrast)
    if not is_alone:
        return bool(blur < MAX_EDGE_BLUR and misfit < _MAX_MEDIAN_MISFIT)
    is_even = abs(compute_median(fit.model.ink_spread)) < _MAX_SPREAD_IF_BLURRED
    max_blur = MAX_EDGE_BLUR_ALONE if is_even else MAX_EDGE_BLUR
    return bool(blur < max_blur and misfit < _MAX_MEDIAN_MISFIT_ALONE)


def are_edges_too_wide(fit: XCornerFit) -> bool:
    """Return whether edges are wider than those of any board, one that stands alone among them: see
    `has_step_edges`. The fit of all corners tells, since to leave out some hardly changes that."""
    return _measure_blur(fit) >= MAX_EDGE_BLUR_ALONE


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

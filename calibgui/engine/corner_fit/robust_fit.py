"""The edge fit of a board at some of whose corners something else is seen.

A finger, the edge of a shadow, a spot of glare or a blot beside a corner draws it aside, and
misleads what is taken from the whole board. Fitted to half a square each way such a corner leaves
more unexplained than others, even if it is itself as clear as any. So it is fitted to what is near
it only, where that leaves less; so it is where the paper is bent and the edges with it. The
covariances of all of them say how far they lie from where the others expect them. Those that lie
too far for that are left out when the others are fitted.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage
from calibgui.engine.corner_fit import verification
from calibgui.engine.corner_fit.board_priors import ScatteredPriors
from calibgui.engine.corner_fit.x_corner_fit import XCornerFit, fit_x_corners, replace_fits
from calibgui.engine.features.lattice import Lattice, find_closed_corners

NEAR = 0.25
"""Distance from suspect corners beyond which nothing is looked at, squares."""
_MIN_ARM = 2.0
"""Least way along its edges that a corner is fitted to, px: a shorter one lies within the blur.
With 3 a quarter of the outermost corners of framed boards that are seen from aside were lost, and
those left had no smaller errors."""
_MIN_CORNERS = 16
"""Least number of corners that are fitted near only: their geometry comes from all of them."""
_MAX_ROUNDS = 4
"""Number of times that corners that are drawn aside are left out and the rest fitted again."""


FitCorners = Callable[[Lattice], tuple[XCornerFit, BoolArray]]
"""A function from a lattice to the edge model at its corners, and which (n,) left more unexplained
than most."""
LocateCorners = Callable[[Lattice], Array]
"""A function from a lattice to the rows and columns (n, 2) of its corners in pitches of the
board."""


def list_cells(lattice: Lattice) -> Array:
    """List the rows and columns (n, 2) of a lattice's corners, whose lines are evenly spaced."""
    return np.argwhere(lattice.found).astype(np.float64)


def fit_robustly(
    lattice: Lattice, fit_corners: FitCorners, locate: LocateCorners = list_cells
) -> tuple[XCornerFit, Array]:
    """Fit the edge model at all corners of a lattice, and find those that something draws aside.

    Args:
        lattice: refined corners.
        fit_corners: the fit at this kind of board.
        locate: where its corners lie on the board.

    Returns:
        The fit, and how far (n,) px corners are drawn aside; 0 for most.
    """
    fit, suspect = fit_corners(lattice)
    cells, is_alone = locate(lattice), ~find_closed_corners(lattice)[lattice.found]
    suspect = suspect | verification.find_displaced_corners(fit, cells, is_alone & ~suspect)
    if not suspect.any():
        return fit, np.zeros(len(lattice))
    undisturbed = lattice.found
    if verification.is_credible(int(np.count_nonzero(suspect)), len(lattice)):
        undisturbed[undisturbed] = ~suspect
    for _ in range(_MAX_ROUNDS):
        rest = lattice.select(undisturbed)
        part, in_part = fit_corners(rest)
        displaced = verification.find_displaced_corners(part, locate(rest), in_part)
        if not displaced.any():
            break
        undisturbed[undisturbed] = ~displaced
    kept = undisturbed[lattice.found]
    fit = replace_fits(fit, part, rest.found[lattice.found], np.ones(len(rest), np.bool_))
    off = verification.measure_displacements(fit.uv, cells, kept)
    # What the model describes near a corner is the corner, however paper or shutter bend the lines,
    # if its edges run along them: those of a finger do not.
    residual = verification.compare_residuals(fit.residual, fit.contrast)
    poor = verification.find_suspect_corners(residual)
    is_corner = ~(poor | is_alone | verification.find_askew_corners(fit, lattice))
    farthest = verification.limit_fit_shift(lattice.spacing()[lattice.found])
    off = np.where(is_corner, np.minimum(off, farthest), off)
    return fit, np.where(kept & ~poor, 0.0, off)


def fit_plain_corners(
    grey: GreyImage, lattice: Lattice, bare_reach: float
) -> tuple[XCornerFit, BoolArray]:
    """Fit the edge model at all corners of a checkerboard, and near those that are the better for
    it; see `FitCorners`. Edges that are too wide for any board are not looked at closer.

    Args:
        grey: (h, w) grey levels.
        lattice: refined corners.
        bare_reach: how far from the corners nothing is printed in the squares and on their edges.
    """
    fit = fit_x_corners(grey, lattice, bare_edge=bare_reach)
    if verification.are_edges_too_wide(fit):
        return fit, np.zeros(len(lattice), np.bool_)
    # What covers a part of the squares would pass for light of a corner's own.
    residual = verification.compare_residuals(fit.board_residual, fit.contrast)
    suspect = verification.find_suspect_corners(residual)
    if bare_reach > NEAR and suspect.any():
        near = fit_near(grey, lattice, NEAR, fit, suspect)
        better = near.residual < fit.residual
        fit = replace_fits(fit, near, np.ones(len(better), np.bool_), better)
    return fit, suspect


def fit_near(
    image: GreyImage,
    lattice: Lattice,
    reach: float,
    fit: XCornerFit,
    suspect: BoolArray,
) -> XCornerFit:
    """Return the fit with the suspect corners (n,) fitted to what is plain around them only, where
    that is enough.

    Args:
        image: (h, w) grey levels.
        lattice: the corners.
        reach: how far from the corners is looked, squares.
        fit: at all n corners.
        suspect: (n,) those that are fitted again.
    """
    found = lattice.found
    large = reach * lattice.spacing() > _MIN_ARM
    if np.count_nonzero(found & large) < _MIN_CORNERS:
        return fit
    places = np.argwhere(found & large)[:, ::-1].astype(np.float64)
    near = fit_x_corners(image, lattice.select(large), priors=ScatteredPriors(places, 2 * reach))
    return replace_fits(fit, near, large[found], suspect[large[found]])

"""The edge fit of a board at some of whose corners something else is seen.

A finger, the edge of a shadow or a blot beside a corner draws it aside, and misleads what is taken
from the whole board. Such corners leave more unexplained than others. They are fitted to what is
near them only if that leaves less, and the covariances of all of them say how far they lie from
where the others expect them. Those that lie too far for that are left out when the others are
fitted.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage
from calibgui.engine.detection.checkerboard import verification
from calibgui.engine.detection.checkerboard.near_fit import fit_near
from calibgui.engine.detection.checkerboard.x_corner_fit import (
    XCornerFit,
    fit_x_corners,
    replace_fits,
)
from calibgui.engine.detection.lattice import Lattice

_NEAR = 0.25
"""Distance from suspect corners beyond which nothing is looked at, squares."""
_MAX_ROUNDS = 4
"""Number of times that corners that are drawn aside are left out and the rest fitted again."""


def fit_undisturbed(grey: GreyImage, lattice: Lattice, plain: float) -> tuple[XCornerFit, Array]:
    """Fit the edge model at all corners of a lattice, and find those that something draws aside.

    Args:
        grey: (h, w) grey levels.
        lattice: refined corners.
        plain: how far from the corners nothing is printed in the squares and on their edges.

    Returns:
        The fit, and how far (n,) px corners are drawn aside; 0 for most.
    """
    fit, suspect = _fit_corners(grey, lattice, plain)
    if not suspect.any():
        return fit, np.zeros(len(lattice))
    undisturbed = lattice.found
    if verification.is_credible(int(np.count_nonzero(suspect)), len(lattice)):
        undisturbed[undisturbed] = ~suspect
    for _ in range(_MAX_ROUNDS):
        rest = lattice.select(undisturbed)
        part, in_part = _fit_corners(grey, rest, plain)
        displaced = verification.find_displaced_corners(part, rest, in_part)
        if not displaced.any():
            break
        undisturbed[undisturbed] = ~displaced
    kept = undisturbed[lattice.found]
    fit = replace_fits(fit, part, rest.found[lattice.found], np.ones(len(rest), np.bool_))
    off = verification.measure_displacements(fit.uv, lattice, undisturbed)
    # What the model describes near a corner is the corner, however paper or shutter bend the lines.
    poor = verification.find_suspect_corners(fit.residual)
    farthest = verification.limit_fit_shift(lattice.spacing()[lattice.found])
    off = np.where(poor, off, np.minimum(off, farthest))
    return fit, np.where(kept & ~poor, 0.0, off)


def _fit_corners(grey: GreyImage, lattice: Lattice, plain: float) -> tuple[XCornerFit, BoolArray]:
    """Fit the edge model at all corners of a lattice, and near those that are the better for it.

    Returns:
        The fit, and which corners (n,) left more unexplained than most at first.
    """
    fit = fit_x_corners(grey, lattice, bare_edge=plain)
    # What covers a part of the squares would pass for light of a corner's own.
    suspect = verification.find_suspect_corners(fit.board_residual)
    if plain > _NEAR and suspect.any():
        near = fit_near(grey, lattice, _NEAR, fit, suspect)
        better = near.residual < fit.residual
        fit = replace_fits(fit, near, np.ones(len(better), np.bool_), better)
    return fit, suspect

"""The corners of a ChArUco board of which too little is seen for its corners to vouch for each
other.

Beside a hand or at the end of the image a few markers are seen, and one to five corners between
them. What a board's corners are else compared with is missing: the typical corner, and a smooth
map. So each has to stand by itself: it lies where two markers meet, both of which were read, its
four squares have the colours that its place requires, it looks like a crossing of two edges and not
only like its neighbours, and the model of one describes it. The markers tell its steps. The size of
the board has to be stated: three of markers in any order agree with one of all sizes now and then.

Such corners tell no pose, but two cameras that see the same one have a ray each to it.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import BoolArray, GreyImage, GridSize, IntArray, compute_lengths
from calibgui.engine.boards.charuco import MarkerLayout
from calibgui.engine.corner_fit import verification
from calibgui.engine.corner_fit.verification import (
    MAX_RESIDUAL_IF_WIDENED,
    MAX_RESIDUAL_TO_CONTRAST,
)
from calibgui.engine.corner_fit.x_corner_fit import XCornerFit, fit_x_corners
from calibgui.engine.detection.charuco.corners_between_markers import predict_places
from calibgui.engine.detection.charuco.markers import Markers
from calibgui.engine.features import saddle
from calibgui.engine.features.corner_template import find_crossings, orient_corners
from calibgui.engine.features.corners import find_usable_covariances
from calibgui.engine.features.lattice import Lattice, measure_in_steps
from calibgui.engine.lattices import board_ends

_MAX_DEVIATION = 0.1
"""Greatest distance of a corner from where the markers predict it, steps."""
_MAX_SHARP_BLUR = 0.5
"""Greatest blur over what is plain beside an edge: more would draw the corner towards a marker,
which cannot be taken out of the image without the corners around."""
_REACH = 0.25
"""Distance from a corner of the points that its steps are measured between, squares."""


def locate_isolated_corners(
    image: GreyImage, markers: Markers[MarkerLayout], grid_size: GridSize, *, is_inverted: bool
) -> Lattice:
    """Locate the corners between two markers that were read, each by itself.

    Args:
        image: (h, w) grey levels.
        markers: those of the board.
        grid_size: the board's rows and columns of inner corners.
        is_inverted: True if the board is printed bright on dark.

    Returns:
        The lattice of the whole board with the corners that pass, and with the steps that the
        markers tell; without corners if none passes.
    """
    cells = _list_corners_between(markers.squares, grid_size)
    dark = markers.layout.first_dark != is_inverted
    predicted = _predict_with_steps(markers, cells, grid_size, dark=dark)
    inside = board_ends.are_in_image(predicted.uv, image.shape)
    predicted = _select(predicted, inside & np.isfinite(predicted.spacing()))
    if not len(predicted):
        return predicted
    is_predicted, bare_reach = predicted.found, (1 - markers.side) / 2
    spacing, uv = predicted.spacing()[is_predicted], predicted.uv.copy()
    sigma = saddle.choose_weight_sigma(2 * bare_reach * spacing)
    uv[is_predicted], good = saddle.refine_saddles(image, uv[is_predicted], sigma, spacing / 4)
    moved = Lattice(uv, dark).with_steps(*predicted.steps())
    off = measure_in_steps(uv - predicted.uv, *predicted.steps())[is_predicted]
    good &= (off < _MAX_DEVIATION) & find_crossings(orient_corners(moved), image, bare_reach)
    is_predicted[is_predicted] = good
    return _select(moved, is_predicted)


def fit_isolated_corners(
    image: GreyImage, lattice: Lattice, bare_reach: float
) -> tuple[Lattice, XCornerFit | None]:
    """Fit the model of two crossing edges at few corners, leaving out those that it does not
    describe.

    Where the edge of a shadow or of a reflection runs through a corner, the covariance expects it
    as far aside as the fit is from the saddle point.

    Args:
        image: (h, w) grey levels.
        lattice: the corners, with their steps.
        bare_reach: how far from its edges a square is of one colour, squares.

    Returns:
        The corners that the model describes, and their fit; None where it describes none.
    """
    while len(lattice):
        found = lattice.found
        steps = np.stack([step[found] for step in lattice.steps()], axis=1)
        geometry = steps, np.zeros(steps.shape[:2])
        fit = fit_x_corners(image, lattice, bare_reach, geometry=geometry)
        spacing = lattice.spacing()[found]
        shift = compute_lengths(fit.uv - lattice.uv[found])
        is_drawn = fit.residual > MAX_RESIDUAL_TO_CONTRAST * fit.contrast
        good = (
            (shift <= verification.limit_fit_shift(spacing))
            & (fit.contrast > 0)
            & (fit.residual <= MAX_RESIDUAL_IF_WIDENED * fit.contrast)
            & (fit.blur <= _MAX_SHARP_BLUR * bare_reach * spacing)
            & find_usable_covariances(fit.covariance)
        )
        if good.all():
            return lattice, fit.widen(np.where(is_drawn, shift, 0.0))
        found[found] = good
        lattice = _select(lattice, found)
    return lattice, None


def _select(lattice: Lattice, mask: BoolArray) -> Lattice:
    """Return the lattice with the corners under a mask only, and all of its steps."""
    return lattice.select(mask).with_steps(*lattice.steps())


def _list_corners_between(squares: IntArray, grid_size: GridSize) -> IntArray:
    """List row and column (n, 2) of the inner corners at which two of the marked `squares` (m, 2)
    meet."""
    rows, cols = grid_size
    marked = np.zeros((rows + 2, cols + 2), np.bool_)
    marked[tuple(squares.T)] = True
    slant = marked[:-1, :-1] & marked[1:, 1:], marked[:-1, 1:] & marked[1:, :-1]
    return np.argwhere((slant[0] | slant[1])[:rows, :cols])


def _predict_with_steps(
    markers: Markers[MarkerLayout], cells: IntArray, grid_size: GridSize, *, dark: bool
) -> Lattice:
    """Predict the corners `cells` (n, 2) of a board and their steps from the nearest markers."""
    xy = cells[:, ::-1].astype(np.float64)
    ends = _REACH * np.array([(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)])
    points = (xy[:, None] + ends).reshape(-1, 2)
    uv, right, down = np.full((3, *grid_size, 2), np.nan)
    if len(cells):
        places, _ = predict_places(points, markers.board_corners, markers.corners)
        at = tuple(cells.T)
        middle, after, before, below, above = places.reshape(-1, 5, 2).swapaxes(0, 1)
        uv[at] = middle
        right[at] = (after - before) / (2 * _REACH)
        down[at] = (below - above) / (2 * _REACH)
    return Lattice(uv, dark).with_steps(right, down)

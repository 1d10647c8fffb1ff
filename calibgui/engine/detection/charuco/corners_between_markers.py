"""The inner corners of a ChArUco board, from the markers around them.

The markers' corners, known on the board, give a homography from board to image around every inner
corner, that of the nearest markers. The corner is predicted there and found by the same means as a
checkerboard's: saddle point, test of its place among its neighbours and of the colours around it,
fit of the two edges with its covariance. Places beside markers that were not read are tried where
the corners around predict them.

A marker leaves only a margin of (1 - rho) / 2 squares of plain white beside the edges, rho being
its side over a square's: nothing beyond that is looked at.
"""

from __future__ import annotations

import numpy as np
import scipy

from calibgui.engine.arrays import Array, BoolArray, GreyImage, GridSize
from calibgui.engine.boards.charuco import MarkerLayout
from calibgui.engine.corner_fit import verification
from calibgui.engine.corner_fit.robust_fit import fit_robustly
from calibgui.engine.corner_fit.x_corner_fit import XCornerFit
from calibgui.engine.detection.charuco.marker_subtraction import Marks, fit_without_marks
from calibgui.engine.detection.charuco.markers import Markers
from calibgui.engine.detection.charuco.thresholds import CHARUCO_THRESHOLDS
from calibgui.engine.detection.detector_io import list_rejected_corners
from calibgui.engine.errors import NoBoardError, UnknownPartError
from calibgui.engine.features import saddle
from calibgui.engine.features.corners import RejectedCorner
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.geometry import homography

_MARKERS_PER_CORNER = 4
"""Number of the nearest markers whose corners place an inner corner."""
_LEAST_DISTANCE = 0.1
"""Distance from a point, in units of the board, within which markers' corners count alike."""
_MAX_ROUNDS = 8
"""Number of times that the corners beside those found are tried."""
_MAX_FITS = 4
"""Number of times that corners may be rejected and the rest fitted again."""


def predict_places(xy: Array, on_board: Array, corners: Array) -> tuple[Array, Array]:
    """Place points of a board where the nearest markers predict them.

    Args:
        xy: (n, 2) points on the board.
        on_board: (m, 4, 2) corners of the markers, in the same unit.
        corners: (m, 4, 2) px, where these are seen.

    Returns:
        Places (n, 2) px, and the distance (n,) of each point from the nearest marker's centre.
    """
    count = min(_MARKERS_PER_CORNER, len(on_board))
    nearest = scipy.spatial.cKDTree(on_board.mean(axis=1)).query(xy, np.arange(1, count + 1))
    distance, which = np.asarray(nearest[0]), np.asarray(nearest[1])
    # Coordinates are counted from the point, the place that the homography is evaluated at.
    source = (on_board[which] - xy[:, None, None]).reshape(len(xy), -1, 2)
    target = corners[which].reshape(len(xy), -1, 2)
    weights = 1 / (np.sum(source**2, axis=2) + _LEAST_DISTANCE**2)
    H = homography.fit_homography(source, target, weights)
    return homography.apply_homography(H, np.zeros((len(xy), 1, 2)))[:, 0], distance[:, 0]


def predict_corners(
    markers: Markers[MarkerLayout], grid_size: GridSize, image: GreyImage, *, is_inverted: bool
) -> Lattice:
    """Place the inner corners beside markers where the nearest markers predict them.

    Args:
        markers: those of the board.
        grid_size: the board's rows and columns of inner corners.
        image: (h, w) grey levels; corners outside of it are left out.
        is_inverted: True if the board is printed bright on dark.
    """
    xy = np.indices(grid_size).reshape(2, -1).T[:, ::-1].astype(np.float64)
    uv, distance = predict_places(xy, markers.board_corners, markers.corners)
    limit = np.array(image.shape[::-1]) - 1.0
    is_near = distance < CHARUCO_THRESHOLDS.max_placing_distance
    seen = is_near & ((uv > 0) & (uv < limit)).all(axis=1)
    uv[~seen] = np.nan
    return Lattice(uv.reshape(*grid_size, 2), dark=markers.layout.first_dark != is_inverted)


def refine_corners(
    image: GreyImage, predicted: Lattice, bare_reach: float, *, by_markers: bool = False
) -> tuple[Lattice, list[RejectedCorner]]:
    """Move corners to their saddle points and verify their places and colours.

    Args:
        image: (h, w) grey levels.
        predicted: where the corners are predicted.
        bare_reach: how far from its edges a square is of one colour, squares.
        by_markers: True if markers beside the corners predict them.

    Returns:
        The corners that pass, and the predicted ones that do not.

    Raises:
        NoBoardError: if too few corners have a saddle point.
    """
    marked = predicted.uv if by_markers else None
    lattice = predicted
    for fill in (False, True):
        # The second pass also tries the gaps where the corners found predict others.
        tried = verification.fill_gaps(lattice, image.shape) if fill else predicted
        known = tried.found & np.isfinite(tried.spacing())
        tried = tried.select(known)
        spacing = tried.spacing()[known]
        uv, converged = tried.uv.copy(), known.copy()
        sigma = saddle.choose_weight_sigma(2 * bare_reach * spacing)
        uv[known], converged[known] = saddle.refine_saddles(image, uv[known], sigma, spacing / 4)
        moved = Lattice(uv, tried.dark).select(converged)
        require_enough_corners(moved)
        lattice = moved.select(verification.find_sound_corners(moved, image, bare_reach, marked))
    lost = predicted.found & ~lattice.found
    return lattice, list_rejected_corners(predicted.uv[lost], "off place or colours")


def refine_and_extend_corners(
    image: GreyImage, predicted: Lattice, bare_reach: float
) -> tuple[Lattice, list[RejectedCorner]]:
    """Move corners to their saddle points, verify them, and try the places beside them, and beside
    these.

    Args:
        image: (h, w) grey levels.
        predicted: the lattice of the whole board, with the corners seen.
        bare_reach: how far from its edges a square is of one colour, squares.

    Raises:
        NoBoardError: if too few corners are left.
    """
    lattice, rejected = refine_corners(image, predicted, bare_reach)
    for _ in range(_MAX_ROUNDS):
        more, lost = refine_corners(image, lattice, bare_reach)
        if len(more) <= len(lattice):
            break
        lattice, rejected = more, lost
    return lattice, rejected


def fit_corners(
    image: GreyImage, lattice: Lattice, marks: Marks
) -> tuple[Lattice, XCornerFit, list[RejectedCorner]]:
    """Fit the model of two crossing edges, leaving out the corners that it does not describe.

    Args:
        image: (h, w) grey levels.
        lattice: the corners, in the lattice of the whole board.
        marks: the markers of the whole board.

    Returns:
        The corners that the model describes, their fit, and the others.

    Raises:
        NoBoardError: if too few corners are left.
    """
    rejected: list[RejectedCorner] = []
    for _ in range(_MAX_FITS):
        require_enough_corners(lattice)
        fit, displacement = fit_robustly(lattice, lambda part: _fit_all_corners(image, part, marks))
        found, uv = lattice.found, lattice.uv[lattice.found]
        described = verification.find_described_corners(fit, lattice, displacement)
        near = verification.find_tolerable_displacements(displacement, lattice)
        good = described & near
        if good.all():
            if verification.has_step_edges(fit):
                return lattice, fit.widen(displacement), rejected
            break
        rejected += list_rejected_corners(uv[~described], "not two crossing edges")
        rejected += list_rejected_corners(uv[described & ~near], verification.DRAWN_ASIDE)
        found[found] = good
        lattice = lattice.select(found)
    raise _distrust()


def _fit_all_corners(
    image: GreyImage, lattice: Lattice, marks: Marks
) -> tuple[XCornerFit, BoolArray]:
    """Fit the model at all corners, without markers that the blur brings near; see `FitCorners`."""
    fit, _ = fit_without_marks(image, lattice, marks, marks.margin)
    return fit, verification.find_suspect_corners(fit.board_residual)


def require_enough_corners(lattice: Lattice) -> None:
    """Raise NoBoardError if too few corners are found to be trusted."""
    lines = [np.count_nonzero(lattice.found.any(axis=axis)) for axis in (0, 1)]
    if len(lattice) < CHARUCO_THRESHOLDS.min_corners or min(lines) < 2:
        raise _distrust()


def _distrust() -> NoBoardError:
    """Return the error for a board of which too few corners pass."""
    return UnknownPartError(
        "Markers of the board were read, but too few corners beside them can be trusted.",
        "Take the picture again: sharp, evenly lit, and more of the board in view.",
    )

"""The inner corners of a ChArUco board, from the markers around them.

The markers' corners, known on the plate, give a homography from plate to image around every inner
corner, that of the nearest markers. The corner is expected there and found by the same means as a
checkerboard's: saddle point, test of its place among its neighbours and of the colours around it,
fit of the two edges with its covariance. Places beside markers that were not read are tried where
the corners around expect them.

A marker leaves only a margin of (1 - rho) / 2 squares of plain white beside the edges, rho being
its side over a square's: nothing beyond that is looked at.
"""

from __future__ import annotations

import numpy as np
import scipy

from calibgui.engine.arrays import GreyImage, GridSize
from calibgui.engine.detection.charuco.markers import Markers
from calibgui.engine.detection.checkerboard import saddle, verification, x_corner_fit
from calibgui.engine.detection.checkerboard.find_checkerboard import rejections
from calibgui.engine.detection.checkerboard.x_corner_fit import Fit
from calibgui.engine.detection.corners import RejectedCorner
from calibgui.engine.detection.lattice import Lattice
from calibgui.engine.errors import NoBoardError
from calibgui.engine.geometry import homography

_MIN_CORNERS = 6
_NEAREST = 4
"""Markers whose corners place an inner corner."""
_ADJACENT = 0.8
"""Farthest that one of them must be, squares."""
_ROUNDS = 4
"""How often corners may be left out and the rest fitted again."""


def expected(markers: Markers, grid_size: GridSize, image: GreyImage) -> Lattice:
    """The inner corners beside markers where the nearest markers place them, inside the image.

    Args:
        markers: of the board.
        board: its rows and columns of inner corners.
        image: (h, w) grey levels.
    """
    grid = np.indices(grid_size).reshape(2, -1).T
    xy = grid[:, ::-1].astype(np.float64)
    places = markers.places
    count = min(_NEAREST, len(places))
    near = scipy.spatial.cKDTree(places.mean(axis=1)).query(xy, np.arange(1, count + 1))
    distance, which = np.asarray(near[0]), np.asarray(near[1])
    # Around the corner: a homography moves nothing else so little.
    source = (places[which] - xy[:, None, None]).reshape(len(xy), -1, 2)
    target = markers.corners[which].reshape(len(xy), -1, 2)
    H = homography.fit_homography(source, target, np.ones(source.shape[:2]))
    uv = homography.apply(H, np.zeros((len(xy), 1, 2)))[:, 0]
    limit = np.array(image.shape[::-1]) - 1.0
    seen = (distance[:, 0] < _ADJACENT) & ((uv > 0) & (uv < limit)).all(axis=1)
    uv[~seen] = np.nan
    layout = markers.layout
    return Lattice(uv.reshape(*grid_size, 2), dark=layout.first_dark)


def located(
    image: GreyImage, places: Lattice, plain: float
) -> tuple[Lattice, list[RejectedCorner]]:
    """The corners that are where and as they must be, and the others.

    Args:
        image: (h, w) grey levels.
        places: where they are expected.
        plain: how far from its edges a square is of one colour, squares.

    Raises:
        NoBoardError: if they are too few.
    """
    lattice = places
    for again in (False, True):
        # The second time also where the corners found expect others.
        tried = verification.filled(lattice, image.shape) if again else places
        known = tried.found & np.isfinite(tried.spacing())
        tried = tried.under(known)
        spacing = tried.spacing()[known]
        uv, converged = tried.uv.copy(), known.copy()
        width = saddle.window(2 * plain * spacing)
        uv[known], converged[known] = saddle.refine_saddles(image, uv[known], width, spacing / 4)
        moved = Lattice(uv, tried.dark).under(converged)
        check_enough(moved)
        lattice = moved.under(verification.sound(moved, image, plain))
    lost = places.found & ~lattice.found
    return lattice, rejections(places.uv[lost], "off place or colours")


def fitted(
    image: GreyImage, lattice: Lattice, plain: float
) -> tuple[Lattice, Fit, list[RejectedCorner]]:
    """The edge model at the corners that it describes, and the others.

    Args, Raises: as `located`.
    """
    rejected: list[RejectedCorner] = []
    for _ in range(_ROUNDS):
        check_enough(lattice)
        fit = x_corner_fit.fit(image, lattice, plain)
        found = lattice.found
        good = verification.described(fit, lattice)
        if good.all():
            if verification.stepped(fit):
                return lattice, fit, rejected
            break
        rejected += rejections(lattice.uv[found][~good], "not two crossing edges")
        found[found] = good
        lattice = lattice.under(found)
    raise _untrusted()


def check_enough(lattice: Lattice) -> None:
    """Raise NoBoardError if too few corners are found to be trusted."""
    lines = [np.count_nonzero(lattice.found.any(axis=axis)) for axis in (0, 1)]
    if len(lattice) < _MIN_CORNERS or min(lines) < 2:
        raise _untrusted()


def _untrusted() -> NoBoardError:
    return NoBoardError(
        "Markers of a ChArUco board were read, but too few corners of its squares can be trusted.",
        "Take the picture again: sharp, evenly lit, and more of the board in view.",
    )

"""The detector of ChArUco boards: the markers say which corner is which."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, GreyImage, GridSize
from calibgui.engine.boards.charuco import LAYOUTS, Charuco, Layout, dictionary_family
from calibgui.engine.detection import region_of_interest as region
from calibgui.engine.detection.charuco.corners_between_markers import (
    check_enough,
    expected,
    fitted,
    located,
)
from calibgui.engine.detection.charuco.marker_reader import Reader, Seen
from calibgui.engine.detection.checkerboard import harris
from calibgui.engine.detection.checkerboard.find_checkerboard import grey_levels
from calibgui.engine.detection.checkerboard.x_corner_fit import Fit
from calibgui.engine.detection.corners import Corners, RejectedCorner
from calibgui.engine.detection.lattice import Lattice
from calibgui.engine.errors import NoBoardError
from calibgui.engine.images.reading import stretched

_DIFFERENT = 0.1
"""Difference of a marker's side from the stated one that is no error of measurement, squares."""


def find_charuco(
    image: npt.ArrayLike,
    pattern: Charuco,
    grid_size: GridSize | None = None,
    roi: npt.ArrayLike | None = None,
    method: str = "edges",
) -> Corners:
    """Locate the inner corners of a ChArUco board in an image; see ``find_corners``."""
    grey = grey_levels(image)
    outline = None if roi is None else region.outline(roi)
    dictionary, markers = _read(pattern, stretched(grey), grid_size, outline)
    rows, _ = np.max(markers.squares, axis=0).tolist()
    size = grid_size or (rows, markers.layout.cols - 1)
    # An even number of rows, if it begins with a white square.
    legacy = pattern.legacy if pattern.legacy is not None else not markers.layout.first_dark
    if grid_size is None and not markers.layout.first_dark and size[0] % 2 == 0:
        size = (size[0] + 1, size[1])
    plain = (1 - markers.side) / 2
    lattice, rejected = located(grey, expected(markers, size, grey), plain)
    fit = None
    if method == "edges":
        lattice, fit, more = fitted(grey, lattice, plain)
        rejected += more
    seen = Charuco(dictionary, markers.side, legacy)
    return _record(grey, lattice, fit, outline, rejected, seen)


def _read(
    pattern: Charuco, image: GreyImage, grid_size: GridSize | None, outline: Array | None
) -> Seen:
    """The dictionary and the board's markers in an 8-bit image (h, w).

    What is stated is tried first; if it does not fit, what does is told.
    """
    read = Reader(image, outline)
    layouts = _layouts(pattern, grid_size)
    found = (
        read.grid_size(pattern.dictionary, layouts) if pattern.dictionary else read.unknown(layouts)
    )
    if found is None:
        raise _wrong(pattern, read, grid_size)
    dictionary, markers = found
    if pattern.marker is not None and abs(markers.side - pattern.marker) > _DIFFERENT:
        raise NoBoardError(
            f"The markers are {markers.side:.2f} of a square, not {pattern.marker:.2f}.",
            "State the sides of marker and square as measured, or leave the marker's out.",
        )
    rows, _ = np.max(markers.squares, axis=0).tolist()
    if grid_size is not None and rows > grid_size[0]:
        raise _other_size((rows, markers.layout.cols - 1), grid_size)
    return dictionary, markers


def _layouts(pattern: Charuco, grid_size: GridSize | None) -> list[Layout]:
    """Those that what is stated allows."""
    if grid_size is None:
        return [one for one in LAYOUTS if one.first_dark or pattern.legacy is not False]
    if pattern.legacy is not None:
        return [Layout(grid_size[1] + 1, pattern.first_dark(grid_size))]
    both = (True, False) if (grid_size[0] + 1) % 2 == 0 else (True,)
    return [Layout(grid_size[1] + 1, dark) for dark in both]


def _wrong(pattern: Charuco, read: Reader, grid_size: GridSize | None) -> NoBoardError:
    """What is there instead of the board stated."""
    nothing = NoBoardError(
        "No ChArUco board was found.",
        "Take the picture again: sharp, evenly lit and near enough for its markers to be read;"
        " state dictionary and size, or leave them out.",
    )
    found = read.grid_size(pattern.dictionary, LAYOUTS) if pattern.dictionary else None
    found = found or read.unknown(LAYOUTS)
    if found is None:
        return nothing
    dictionary, markers = found
    if pattern.dictionary and dictionary_family(dictionary) != dictionary_family(
        pattern.dictionary
    ):
        return NoBoardError(
            f"The markers are of {dictionary}, not of {pattern.dictionary}.",
            "State that dictionary, or leave it out.",
        )
    rows, _ = np.max(markers.squares, axis=0).tolist()
    if grid_size is not None and (markers.layout.cols - 1 != grid_size[1] or rows > grid_size[0]):
        return _other_size((rows, markers.layout.cols - 1), grid_size)
    return NoBoardError(
        "The first square of this board is "
        + ("dark." if markers.layout.first_dark else "white, as before OpenCV 4.6."),
        "State the other layout, or leave it out.",
    )


def _other_size(found: GridSize, stated: GridSize) -> NoBoardError:
    return NoBoardError(
        f"This board has at least {found[0]} rows and exactly {found[1]} columns of inner corners, "
        f"not {stated[0]} x {stated[1]}.",
        "State the number of inner corners, rows x columns, or leave it out.",
    )


def _record(
    image: GreyImage,
    lattice: Lattice,
    fit: Fit | None,
    outline: Array | None,
    rejected: list[RejectedCorner],
    pattern: Charuco,
) -> Corners:
    """What is handed out."""
    check_enough(lattice)
    found = lattice.found
    uv = lattice.uv[found]
    corners = Corners(
        shape=lattice.shape,
        grid=np.argwhere(found),
        uv=uv,
        estimate=harris.first_estimates(image, uv, lattice.spacing()[found]),
        roi=region.around(lattice) if outline is None else outline,
        method="saddle",
        rejected=tuple(rejected),
        pattern=pattern,
    )
    if fit is None:
        return corners
    return replace(
        corners,
        method="edges",
        uv=fit.uv,
        cov=fit.covariance,
        blur=fit.blur,
        contrast=fit.contrast,
        residual=fit.residual,
    )

"""The detector of ChArUco boards: the markers tell which corner is which.

`MarkerReader` reads the board's markers and thereby finds what is not stated of dictionary, layout
and size. `corners_between_markers` predicts the inner corners from them and refines and verifies
each like a corner of a checkerboard.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, GreyImage, GridSize
from calibgui.engine.boards.charuco import (
    MARKER_LAYOUTS,
    Charuco,
    MarkerLayout,
    dictionary_family,
)
from calibgui.engine.detection import region_of_interest as region
from calibgui.engine.detection.charuco.corners_between_markers import (
    fit_corners,
    predict_corners,
    refine_corners,
    require_enough_corners,
)
from calibgui.engine.detection.charuco.marker_reader import MarkerReader, ReadBoard
from calibgui.engine.detection.charuco.thresholds import CHARUCO_THRESHOLDS
from calibgui.engine.detection.checkerboard import harris
from calibgui.engine.detection.checkerboard.x_corner_fit import XCornerFit
from calibgui.engine.detection.corners import Corners, RejectedCorner
from calibgui.engine.detection.detector_io import check_grey_levels
from calibgui.engine.detection.lattice import Lattice
from calibgui.engine.errors import NoBoardError
from calibgui.engine.images.reading import stretch_levels


def find_charuco(
    image: npt.ArrayLike,
    pattern: Charuco,
    grid_size: GridSize | None = None,
    roi: npt.ArrayLike | None = None,
    method: str = "edges",
) -> Corners:
    """Locate the inner corners of a ChArUco board in an image; see ``find_corners``."""
    grey = check_grey_levels(image)
    outline = None if roi is None else region.check_outline(roi)
    dictionary, markers = _read_board(pattern, stretch_levels(grey), grid_size, outline)
    rows, _ = np.max(markers.squares, axis=0).tolist()
    size = grid_size or (rows, markers.layout.cols - 1)
    # An even number of rows of squares, if the board begins with a white square.
    legacy = pattern.legacy if pattern.legacy is not None else not markers.layout.first_dark
    if grid_size is None and not markers.layout.first_dark and size[0] % 2 == 0:
        size = (size[0] + 1, size[1])
    plain = (1 - markers.side) / 2
    lattice, rejected = refine_corners(grey, predict_corners(markers, size, grey), plain)
    fit = None
    if method == "edges":
        lattice, fit, more = fit_corners(grey, lattice, plain)
        rejected += more
    seen = Charuco(dictionary, markers.side, legacy)
    return _assemble_corners(grey, lattice, fit, outline, rejected, seen)


def _read_board(
    pattern: Charuco, image: GreyImage, grid_size: GridSize | None, outline: Array | None
) -> ReadBoard:
    """Read the dictionary and the board's markers in an 8-bit image (h, w).

    Only what agrees with the statements in `pattern` and `grid_size` is accepted.

    Raises:
        NoBoardError: if there is no such board; the message names the one that is there instead.
    """
    reader = MarkerReader(image, outline)
    layouts = _list_layouts(pattern, grid_size)
    found = (
        reader.read_dictionary(pattern.dictionary, layouts)
        if pattern.dictionary
        else reader.search_dictionaries(layouts)
    )
    if found is None:
        raise _explain_missing_board(pattern, reader, grid_size)
    dictionary, markers = found
    if (
        pattern.marker is not None
        and abs(markers.side - pattern.marker) > CHARUCO_THRESHOLDS.max_side_difference
    ):
        raise NoBoardError(
            f"The markers are {markers.side:.2f} of a square, not {pattern.marker:.2f}.",
            "State the sides of marker and square as measured, or leave the marker's out.",
        )
    rows, _ = np.max(markers.squares, axis=0).tolist()
    if grid_size is not None and rows > grid_size[0]:
        raise _explain_other_size((rows, markers.layout.cols - 1), grid_size)
    return dictionary, markers


def _list_layouts(pattern: Charuco, grid_size: GridSize | None) -> list[MarkerLayout]:
    """List the layouts that agree with what is stated."""
    if grid_size is None:
        return [
            layout for layout in MARKER_LAYOUTS if layout.first_dark or pattern.legacy is not False
        ]
    if pattern.legacy is not None:
        return [MarkerLayout(grid_size[1] + 1, pattern.is_first_square_dark(grid_size))]
    both = (True, False) if (grid_size[0] + 1) % 2 == 0 else (True,)
    return [MarkerLayout(grid_size[1] + 1, dark) for dark in both]


def _explain_missing_board(
    pattern: Charuco, reader: MarkerReader, grid_size: GridSize | None
) -> NoBoardError:
    """Return the error that says what the image shows instead of the stated board."""
    nothing = NoBoardError(
        "No ChArUco board was found.",
        "Take the picture again: sharp, evenly lit and near enough for its markers to be read;"
        " state dictionary and size, or leave them out.",
    )
    found = (
        reader.read_dictionary(pattern.dictionary, MARKER_LAYOUTS) if pattern.dictionary else None
    )
    found = found or reader.search_dictionaries(MARKER_LAYOUTS)
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
        return _explain_other_size((rows, markers.layout.cols - 1), grid_size)
    return NoBoardError(
        "The first square of this board is "
        + ("dark." if markers.layout.first_dark else "white, as before OpenCV 4.6."),
        "State the other layout, or leave it out.",
    )


def _explain_other_size(found: GridSize, stated: GridSize) -> NoBoardError:
    """Return the error that says which size was found instead of the stated one."""
    return NoBoardError(
        f"This board has at least {found[0]} rows and exactly {found[1]} columns of inner corners, "
        f"not {stated[0]} x {stated[1]}.",
        "State the number of inner corners, rows x columns, or leave it out.",
    )


def _assemble_corners(
    image: GreyImage,
    lattice: Lattice,
    fit: XCornerFit | None,
    outline: Array | None,
    rejected: list[RejectedCorner],
    pattern: Charuco,
) -> Corners:
    """Assemble the detector's result: saddle points, or the fitted model where there is one."""
    require_enough_corners(lattice)
    found = lattice.found
    uv = lattice.uv[found]
    corners = Corners(
        shape=lattice.shape,
        grid=np.argwhere(found),
        uv=uv,
        estimate=harris.estimate_corners(image, uv, lattice.spacing()[found]),
        roi=region.find_outline(lattice) if outline is None else outline,
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

"""From an image to corners, whatever board it shows: the registry of detectors.

A detector takes an image and what is known of the board and returns `Corners`, with covariances
where its method estimates them; it raises `NoBoardError` rather than return a board that fails its
tests. It knows no camera and no solver. A new detector is a folder of its own and one entry in
`DETECTORS`, under the kind of its pattern.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Protocol

import numpy.typing as npt

from calibgui.engine.arrays import GridSize
from calibgui.engine.boards.checkerboard import CHECKERBOARD
from calibgui.engine.boards.pattern import Pattern
from calibgui.engine.detection.apriltags.find_april_grid import find_april_grid
from calibgui.engine.detection.apriltags.find_tagged_checkerboard import (
    find_tagged_checkerboard,
)
from calibgui.engine.detection.charuco.find_charuco import find_charuco
from calibgui.engine.detection.checkerboard.find_checkerboard import find_checkerboard
from calibgui.engine.detection.circles.find_circles import find_circles
from calibgui.engine.detection.circles.find_listed_circles import find_listed_circles
from calibgui.engine.detection.puzzleboard.find_puzzleboard import find_puzzleboard
from calibgui.engine.features.corners import Corners


class Detector(Protocol):
    """A function that finds the boards of one kind of pattern; see `find_corners`."""

    def __call__(
        self,
        image: npt.ArrayLike,
        pattern: Any,
        grid_size: GridSize | None,
        roi: npt.ArrayLike | None,
        method: str,
    ) -> Corners: ...


DETECTORS: Mapping[str, Detector] = MappingProxyType(
    {
        "checkerboard": find_checkerboard,
        "charuco": find_charuco,
        "circles": find_circles,
        "asymmetric-circles": find_circles,
        "listed-circles": find_listed_circles,
        "aprilgrid": find_april_grid,
        "tagged-checkerboard": find_tagged_checkerboard,
        "puzzleboard": find_puzzleboard,
    }
)
"""The detector for each kind of pattern."""


def find_corners(
    image: npt.ArrayLike,
    grid_size: GridSize | None = None,
    roi: npt.ArrayLike | None = None,
    method: str = "edges",
    pattern: Pattern = CHECKERBOARD,
) -> Corners:
    """Locate the corners of the board in an image, or the circles of a grid.

    Args:
        image: (h, w) grey levels or (h, w, 3) colours, uint8, uint16 or floating, or what
            ``read_image`` returns.
        grid_size: rows and columns of inner corners; inferred if None. A checkerboard of which only
            a part is seen then counts as what is seen of it.
        roi: (4, 2) px, points at or just outside the board's outermost corners, in order around
            it: only corners inside count, and where the pattern leaves the origin open it is the
            corner nearest to the first point.
        method: "edges", the edge model at the Cramer-Rao bound, with covariances; or "saddle",
            the paper's. Circles have but one method.
        pattern: what is printed on the board; its unknown fields are inferred.

    Returns:
        The corners, right-handed in the image, from an origin whose outer square is dark. Of a
        board that is only partly seen `complete` is false, and `relative` is true where its
        rows or columns could be counted otherwise; also of a grid of circles of unstated size that
        may go on outside of the image. Corners seen but not trusted are `rejected` with the
        reason; further boards are in `others`, but for those of much smaller squares: these are
        looked for only until the wanted board is found. The covariances are those of the noise
        alone.

    Raises:
        NoBoardError: no acceptable board, why, and what was found instead.
        ValueError: arguments that make no sense.

    A drawn board of 5 x 6 squares of 20 px has 4 x 5 inner corners, between the pixels:

    >>> import numpy as np
    >>> squares = np.indices((5, 6)).sum(axis=0) % 2
    >>> image = np.pad(np.kron(40 + 160 * squares, np.ones((20, 20))), 20, constant_values=200)
    >>> corners = find_corners(image.astype(np.uint8))
    >>> corners.shape, corners.complete
    ((4, 5), True)
    >>> corners.grid[0].tolist(), corners.uv[0].round(2).tolist()
    ([0, 0], [39.5, 39.5])
    """
    return DETECTORS[pattern.kind](image, pattern, grid_size, roi, method)

"""An image of a checkerboard without the tags in its dark squares: that of a plain one.

The bright cells of a tag are known once its number and the corners around it are (`blurred_print`).
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, GreyImage, IntArray
from calibgui.engine.boards.apriltags import load_family
from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard
from calibgui.engine.detection import grid_map
from calibgui.engine.detection.blurred_print import add_blurred_cells, subtract_change
from calibgui.engine.detection.checkerboard.x_corner_fit import XCornerFit
from calibgui.engine.detection.lattice import Lattice
from calibgui.engine.geometry import homography

_PARTS = 3
"""Number of parts of a cell along either side: seen from aside it is not square."""
_SQUARE = np.array([(0, 0), (0, 1), (1, 1), (1, 0)])
"""(4, 2) row and column of a square's corners."""


def remove_tags(
    image: GreyImage, lattice: Lattice, fit: XCornerFit, pattern: TaggedCheckerboard
) -> GreyImage:
    """Return an image without the tags beside the corners found.

    Args:
        image: (h, w) grey levels.
        lattice: the corners, in the lattice of the whole board.
        fit: the edge model at these.
        pattern: what is printed; its family, border and step are known.
    """
    values = np.full((*lattice.shape, 3), np.nan)
    values[lattice.found] = np.column_stack([fit.uv, fit.contrast])
    places = pattern.locate_tags(lattice.shape)[: len(load_family(str(pattern.family)).cells)]
    around = places[:, None] + _SQUARE
    seen = values[around[..., 0], around[..., 1]]
    numbers = np.flatnonzero(np.isfinite(seen[..., 0]).any(axis=1))
    if not len(numbers):
        return image
    seen, around = seen[numbers], around[numbers].astype(np.float64)
    expected = grid_map.fit_grid_map(lattice).locate(around.reshape(-1, 2)).reshape(-1, 4, 2)
    quads = np.where(np.isfinite(seen[..., :2]), seen[..., :2], expected)
    unit = np.broadcast_to(_SQUARE.astype(np.float64), quads.shape)
    H = homography.fit_homography(unit, quads, np.ones(quads.shape[:2]))
    cells, areas = _divide_bright_cells(pattern, numbers)
    at, scale = _map_with_area(H, cells)
    # The bright cells are as bright as the squares beside the tag's.
    is_dark = lattice.dark ^ (places[numbers].sum(axis=1) % 2 == 1)
    height = np.where(is_dark, 1.0, -1.0) * np.nanmean(seen[..., 2], axis=1)
    blur = np.full(len(numbers), np.median(fit.blur))  # one corner's takes up what disturbs it
    change = np.zeros(image.shape)
    add_blurred_cells(change, at, scale * areas, height, blur)
    return subtract_change(image, change)


def _divide_bright_cells(pattern: TaggedCheckerboard, numbers: IntArray) -> tuple[Array, Array]:
    """Divide the bright cells of the tags `numbers` (n,) into parts.

    Returns:
        The middles (n, k, 2) of the parts as row and column, and their areas (n, k), 0 where a tag
        has fewer, in units of the tag's side.
    """
    border = pattern.border or 1
    bright = ~load_family(str(pattern.family)).cells[numbers]
    cells = np.pad(bright, ((0, 0), (border, border), (border, border)))
    parts = np.kron(cells, np.ones((1, _PARTS, _PARTS), np.bool_))
    side = parts.shape[1]
    flat = parts.reshape(len(parts), -1)
    most = int(flat.sum(axis=1).max())
    chosen = np.argsort(~flat, axis=1, kind="stable")[:, :most]  # bright ones first
    middles = (np.stack(np.divmod(chosen, side), axis=-1) + 0.5) / side
    return middles, np.take_along_axis(flat, chosen, axis=1) / side**2


def _map_with_area(H: Array, points: Array) -> tuple[Array, Array]:
    """Map points (n, k, 2) by homographies (n, 3, 3), and return the areas (n, k) that a unit of
    area has there."""
    depth = points @ H[:, 2, :2, None] + H[:, None, 2, 2:]
    area = abs(np.linalg.det(H))[:, None] / abs(depth[..., 0]) ** 3
    return homography.apply_homography(H, points), area

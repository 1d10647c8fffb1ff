"""An image of a PuzzleBoard without its dots: that of a plain checkerboard.

A white dot on an edge brightens half a disc of the dark square, a dark one darkens half a disc of
the bright square; its other half has the square's colour. Place, size, colour and blur of that half
disc are known once the corners are, so that it can be computed and subtracted: blurred dots then do
not draw the corners of small squares aside.

The half disc is summed over the cells that it is divided into (`blurred_print`).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.boards.puzzleboard import DOT_DIAMETER
from calibgui.engine.detection import grid_map
from calibgui.engine.detection.blurred_print import add_blurred_cells, subtract_change
from calibgui.engine.detection.checkerboard.corner_template import orient_corners
from calibgui.engine.detection.checkerboard.edge_profiles import measure_edge_profiles
from calibgui.engine.detection.checkerboard.x_corner_fit import fit_x_corners
from calibgui.engine.detection.lattice import Lattice
from calibgui.engine.detection.puzzleboard.dot_levels import measure_dots
from calibgui.engine.detection.puzzleboard.place_decoding import (
    Dots,
    StatedBoard,
    find_place_of_print,
)

PLAIN = 0.8 * (1 - DOT_DIAMETER) / 2
"""How far from the corners squares and edges are read, squares: most of the way to the dots."""
_MAX_SHARP_BLUR = 0.2 * (1 - DOT_DIAMETER) / 2 / 2.5
"""Greatest blur, squares, at which dots begin 2.5 standard deviations beyond what is read."""
_NEARER = 0.75
"""Distance from the corners at which edges are measured for the first time, over that of a board
without dots."""
_MAX_DOUBT = 0.5
"""Greatest probability that the dots have another place on the pattern, or none, at which they are
removed: textures have none, and to compute thousands of dots takes long."""
_ROUNDS = 2
"""Number of times that contrast and blur are measured again without dots: the blur of squares of
8 px is then known to 2 %."""
_RINGS = 8
"""Number of rings of points in a half disc."""


def _divide_half_disc() -> tuple[Array, Array]:
    """Divide a half disc of a dot's radius into cells that are nearly square.

    Returns:
        The middles (k, 2) of the cells along and across the diameter and their areas (k,), in units
        of a square's side.
    """
    side = DOT_DIAMETER / 2 / _RINGS
    points, areas = [], []
    for ring in side * (np.arange(_RINGS) + 0.5):
        count = int(np.rint(np.pi * ring / side))
        angle = np.pi * (np.arange(count) + 0.5) / count
        points.append(ring * np.column_stack([np.cos(angle), np.sin(angle)]))
        areas.append(np.full(count, side * np.pi * ring / count))
    return np.concatenate(points), np.concatenate(areas)


_POINTS, _AREAS = _divide_half_disc()


def remove_blurred_dots(
    image: GreyImage, lattice: Lattice, stated: StatedBoard | None = None
) -> GreyImage:
    """Return an image without the dots of a PuzzleBoard, or as it is if they are sharp enough not
    to disturb the corners, or if what is seen between these are hardly such dots.

    Args:
        image: (h, w) grey levels.
        lattice: the board's corners.
        stated: the part of the pattern that is expected, None if that is open.

    Returns:
        (h, w) grey levels of the same type.
    """
    contrast, blur = _measure_edges(image, lattice)
    if blur <= _MAX_SHARP_BLUR * np.nanmedian(lattice.spacing()):
        return image
    dots = measure_dots(image, lattice)
    place, _ = find_place_of_print(dots, stated)
    if place.doubt > _MAX_DOUBT:
        return image
    cleaned = _subtract_dots(image, lattice, dots, contrast, blur)
    for _ in range(_ROUNDS):
        # Without dots, even roughly, the edges tell contrast and blur much better.
        fit = fit_x_corners(cleaned, lattice, bare_edge=PLAIN)
        contrast[lattice.found], blur = fit.contrast, float(np.median(fit.blur))
        cleaned = _subtract_dots(image, lattice, dots, contrast, blur)
    return cleaned


def _measure_edges(image: GreyImage, lattice: Lattice) -> tuple[Array, float]:
    """Measure the contrast (rows, cols) at the corners, NaN where there is none, and the median
    blur of their edges, px."""
    uv, right, down, dark = orient_corners(lattice)
    area = abs(right[:, 0] * down[:, 1] - right[:, 1] * down[:, 0])
    sign = np.where(dark, -1.0, 1.0)
    profiles = [
        measure_edge_profiles(
            image, uv, _NEARER * along, across, area / np.linalg.norm(along, axis=1), sign
        )
        for along, across in ((right, down), (down, right))
    ]
    contrast = np.full(lattice.shape, np.nan)
    contrast[lattice.found] = np.mean([each.high - each.low for each in profiles], axis=0)
    return contrast, float(np.median([each.blur for each in profiles]))


def _subtract_dots(
    image: GreyImage, lattice: Lattice, dots: Dots, contrast: Array, blur: float
) -> GreyImage:
    """Subtract dots from an image (h, w).

    Args:
        image: (h, w) grey levels.
        lattice: the corners.
        dots: their levels; those that are NaN are left in the image.
        contrast: (rows, cols) at the corners, grey levels.
        blur: of their edges, px.
    """
    dark = lattice.dark ^ (np.indices(lattice.shape).sum(axis=0) % 2 == 1)
    locate = grid_map.fit_grid_map(lattice).locate
    change = np.zeros(image.shape)
    for levels, half_step, after_is_dark, height in (
        (dots.right, (0.0, 0.5), dark[:, :-1], (contrast[:, 1:] + contrast[:, :-1]) / 2),
        (dots.down, (0.5, 0.0), dark[:-1], (contrast[1:] + contrast[:-1]) / 2),
    ):
        seen = np.isfinite(levels)
        # A white dot shows in the dark square, a dark one in the bright.
        side = np.where((levels > 0) == after_is_dark, 1.0, -1.0)[seen]
        _add_half_discs(
            change,
            locate,
            np.asarray(np.argwhere(seen) + half_step, dtype=np.float64),
            np.multiply.outer(side, half_step[::-1]),
            (np.sign(levels) * height)[seen],
            blur,
        )
    return subtract_change(image, change)


def _add_half_discs(
    change: Array,
    locate: Callable[[Array], Array],
    middle: Array,
    across: Array,
    height: Array,
    blur: float,
) -> None:
    """Add blurred half discs to `change` (h, w).

    Args:
        change: (h, w) grey levels.
        locate: computes the places (n, 2) px of points (n, 2) = (row, column) of the board.
        middle: (n, 2) = (row, column) of the dots.
        across: (n, 2) half a step in row and column to the side on which the half disc lies.
        height: (n,) grey levels to add inside.
        blur: standard deviation, px.
    """
    if not len(middle):
        return
    along = across[:, ::-1]
    offset = _POINTS[:, :1] * along[:, None] + _POINTS[:, 1:] * across[:, None]
    points = middle[:, None] + 2 * offset
    at = locate(points.reshape(-1, 2)).reshape(points.shape)
    ends = [locate(middle + sign * step) for step in (along, across) for sign in (1, -1)]
    step, other = ends[0] - ends[1], ends[2] - ends[3]
    area = abs(step[:, 0] * other[:, 1] - step[:, 1] * other[:, 0])
    add_blurred_cells(change, at, area[:, None] * _AREAS, height, np.full(len(at), blur))

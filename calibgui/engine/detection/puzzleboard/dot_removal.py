"""An image of a PuzzleBoard without its dots: that of a plain checkerboard.

A white dot on an edge brightens half a disc of the dark square, a dark one darkens half a disc of
the bright square; its other half has the square's colour. Place, size, colour and blur of that half
disc are known once the corners are, so that it can be computed and subtracted: blurred dots then do
not draw the corners of small squares aside.

The half disc is summed over the cells that it is divided into (`blurred_print`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage, IntArray
from calibgui.engine.boards.puzzleboard import DOT_DIAMETER
from calibgui.engine.corner_fit.x_corner_fit import fit_x_corners
from calibgui.engine.detection.blurred_print import add_blurred_cells, subtract_change
from calibgui.engine.detection.puzzleboard.dot_levels import measure_dots
from calibgui.engine.detection.puzzleboard.place_decoding import (
    Dots,
    StatedBoard,
    find_place_of_print,
)
from calibgui.engine.features.corner_template import orient_corners
from calibgui.engine.features.edge_profiles import measure_edge_profiles
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.lattices import grid_map

BARE_REACH = 0.8 * (1 - DOT_DIAMETER) / 2
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
_RINGS = 4
"""Number of rings of points in a half disc: as their points are the centroids of cells, more change
no grey level by 0.5 % of a dot's."""


def _divide_half_disc() -> tuple[Array, Array]:
    """Divide a half disc of a dot's radius into cells that are nearly square.

    Returns:
        The centroids (k, 2) of the cells along and across the diameter and their areas (k,), in
        units of a square's side.
    """
    side = DOT_DIAMETER / 2 / _RINGS
    points, areas = [], []
    for ring in side * (np.arange(_RINGS) + 0.5):
        count = int(np.rint(np.pi * ring / side))
        half = np.pi / count / 2
        angle = half * (2 * np.arange(count) + 1)
        centroid = (ring + side**2 / (12 * ring)) * np.sin(half) / half
        points.append(centroid * np.column_stack([np.cos(angle), np.sin(angle)]))
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
    half_discs = _place_half_discs(lattice, dots)
    cleaned = _subtract_half_discs(image, half_discs, contrast, blur)
    for _ in range(_ROUNDS):
        # Without dots, even roughly, the edges tell contrast and blur much better.
        fit = fit_x_corners(cleaned, lattice, bare_edge=BARE_REACH)
        contrast[lattice.found], blur = fit.contrast, float(np.median(fit.blur))
        cleaned = _subtract_half_discs(image, half_discs, contrast, blur)
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


class _HalfDiscs(NamedTuple):
    """The half discs of n dots on edges of one direction, each in k cells."""

    at: Array
    """(n, k, 2) the middles of the cells, px."""
    areas: Array
    """(n, k) of the cells, px^2."""
    sign: Array
    """(n,) 1 for white dots, -1 for dark ones."""
    ends: IntArray
    """(2, n, 2) rows and columns of the corners at either end of their edges."""


def _place_half_discs(lattice: Lattice, dots: Dots) -> list[_HalfDiscs]:
    """Place the half discs of the dots between the corners of a lattice, but for those whose level
    is NaN, along its rows and along its columns."""
    dark = lattice.dark ^ (np.indices(lattice.shape).sum(axis=0) % 2 == 1)
    locate = grid_map.fit_grid_map(lattice).locate
    return [
        _place_in_direction(locate, levels, np.array(step), after_is_dark)
        for levels, step, after_is_dark in (
            (dots.right, (0, 1), dark[:, :-1]),
            (dots.down, (1, 0), dark[:-1]),
        )
        if np.isfinite(levels).any()
    ]


def _place_in_direction(
    locate: Callable[[Array], Array], levels: Array, step: IntArray, after_is_dark: BoolArray
) -> _HalfDiscs:
    """Place the half discs of the dots on the edges that leave corners by a step.

    Args:
        locate: computes the places (n, 2) px of points (n, 2) = (row, column) of the board.
        levels: (rows, cols) of the dots.
        step: (2,) to the next row and column.
        after_is_dark: (rows, cols) True where the square after a corner, (+, +), is dark.
    """
    seen = np.isfinite(levels)
    corners = np.argwhere(seen)
    middle = corners + step / 2
    # A white dot shows in the dark square, a dark one in the bright.
    side = np.where((levels > 0) == after_is_dark, 0.5, -0.5)[seen]
    across = np.multiply.outer(side, step[::-1])
    along = across[:, ::-1]
    offset = _POINTS[:, :1] * along[:, None] + _POINTS[:, 1:] * across[:, None]
    points = middle[:, None] + 2 * offset
    ends = [locate(middle + sign * half) for half in (along, across) for sign in (1, -1)]
    right, down = ends[0] - ends[1], ends[2] - ends[3]
    area = abs(right[:, 0] * down[:, 1] - right[:, 1] * down[:, 0])
    return _HalfDiscs(
        locate(points.reshape(-1, 2)).reshape(points.shape),
        area[:, None] * _AREAS,
        np.sign(levels[seen]),
        np.stack([corners, corners + step]),
    )


def _subtract_half_discs(
    image: GreyImage, half_discs: list[_HalfDiscs], contrast: Array, blur: float
) -> GreyImage:
    """Subtract half discs from an image (h, w); `contrast` (rows, cols), grey levels, is that at
    the corners, and `blur` that of their edges, px."""
    change = np.zeros(image.shape)
    for at, areas, sign, (first, second) in half_discs:
        height = sign * (contrast[tuple(first.T)] + contrast[tuple(second.T)]) / 2
        add_blurred_cells(change, at, areas, height, np.full(len(at), blur))
    return subtract_change(image, change)

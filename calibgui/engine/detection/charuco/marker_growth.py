"""Markers and tags beside those that were read as dark quadrilaterals.

Noise, blur or what touches it breaks the outline of a marker that is well read where it is known to
lie. So the markers that agree on a board predict where their neighbours are, and these are read
there, from neighbour to neighbour: not by one level that parts dark cells from bright, which a
shadow misleads, but by the steps between neighbouring cells. Of the steps that the print of a
number has, nearly all have the right sign and the others' height; where no marker is, half of them.
What some markers left open of the layout, all of them tell.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage, IntArray
from calibgui.engine.detection.charuco.corners_between_markers import predict_places
from calibgui.engine.detection.charuco.marker_cells import measure_cells
from calibgui.engine.detection.charuco.markers import Layout, Markers
from calibgui.engine.lattices import board_ends
from calibgui.engine.lattices.region_of_interest import are_inside

MIN_RIGHT_STEPS = 0.85
"""Least share of the steps between the cells of a marker or tag that have the sign that its number
says. Where there is none half of them have, and of 50 so many never."""
_MIN_RELATIVE_SWING = 0.25
"""Least height of these steps over the median of the markers that were read as quadrilaterals:
the noise of plain paper has the right signs once in a thousand times."""
_MAX_ROUNDS = 32
"""Number of times that the neighbours of markers are read."""
TAG_NEIGHBOURS = np.array([(r, c) for r in (-1, 0, 1) for c in (-1, 0, 1) if r or c])
"""(8, 2) rows and columns from a tag of an AprilGrid to those around it."""
MARKER_NEIGHBOURS = np.array([(-2, 0), (-1, -1), (-1, 1), (0, -2), (0, 2), (1, -1), (1, 1), (2, 0)])
"""(8, 2) rows and columns from a marker in a square of a ChArUco board to those around it."""


@dataclass(frozen=True, eq=False, slots=True)
class MarkerPrints:
    """The prints of the markers of a board."""

    steps: Array
    """(m, s) the steps between neighbouring cells of each number, the border included: 1 where the
    second is brighter, -1 where it is darker, 0 where both are alike."""
    neighbours: IntArray
    """(k, 2) rows and columns from a marker to those around it."""
    side: int
    """n, number of cells along a side."""

    def rate_markers(self, image: GreyImage, read: Markers[Layout]) -> tuple[Array, Array]:
        """Rate the n markers `read` in an image (h, w), dark on bright; see `rate`."""
        seen = list_differences(measure_cells(image, read.corners, self.side))
        return self.rate(seen, read.numbers)

    def rate(self, seen: Array, numbers: IntArray) -> tuple[Array, Array]:
        """Rate differences of cells (n, s) as those of given numbers (n,).

        Returns:
            The share (n,) of the steps that have the right sign, and their mean height (n,).
        """
        printed = self.steps[numbers]
        count = np.abs(printed).sum(axis=1)
        right = (np.sum(np.sign(seen) * printed, axis=1) / count + 1) / 2
        return right, np.sum(seen * printed, axis=1) / count


def describe_prints(cells: BoolArray, neighbours: IntArray) -> MarkerPrints:
    """Describe the prints of markers whose cells (m, n, n), the border included, are True where
    dark; see `MarkerPrints`."""
    return MarkerPrints(list_differences(np.where(cells, 0.0, 1.0)), neighbours, cells.shape[1])


def list_differences(level: Array) -> Array:
    """List the differences (n, s) of neighbouring cells (n, k, k), down and to the right."""
    return np.concatenate(
        [np.diff(level, axis=axis).reshape(len(level), -1) for axis in (1, 2)], axis=1
    )


def grow_markers(
    image: GreyImage,
    readings: list[Markers[Layout]],
    prints: MarkerPrints,
    count: int | None,
    outline: Array | None,
    refine: Callable[[Array], Array] | None = None,
) -> list[Markers[Layout]]:
    """Read the markers beside those of a board, and theirs.

    Args:
        image: (h, w) grey levels, markers dark on bright.
        readings: the markers that were read, on each of the layouts that they agree with.
        prints: of all numbers.
        count: number of markers on the board, if it is known.
        outline: (k, 2) px, outline that the markers must not leave, if there is one.
        refine: moves the corners (n, 4, 2) px of quadrilaterals from where they are predicted to
            where they are seen.

    Returns:
        The markers on each of the layouts that most of them agree with.
    """
    grown = [
        each
        for alike in _group_alike(readings)
        for each in _grow_alike(image, alike, prints, count, outline, refine)
    ]
    most = max(len(each.numbers) for each in grown)
    return [each for each in grown if len(each.numbers) == most]


def tell_rows_apart(squares: IntArray, neighbours: IntArray) -> bool:
    """Return whether markers at `squares` (n, 2) are neighbours in different rows: their numbers
    tell the length of a row. Markers farther apart may agree on a wrong one by chance.

    Args:
        squares: row and column of each.
        neighbours: (k, 2) rows and columns from a marker to those around it.
    """
    away = squares - squares[:, None]
    across = neighbours[neighbours[:, 0] != 0]
    return bool((away[:, :, None] == across).all(axis=3).any())


def _group_alike(readings: list[Markers[Layout]]) -> list[list[Markers[Layout]]]:
    """Group the readings that place the same markers alike, but for where on the board."""
    groups: dict[tuple[bytes, bytes], list[Markers[Layout]]] = {}
    for reading in readings:
        relative = reading.squares - reading.squares[0]
        groups.setdefault((reading.numbers.tobytes(), relative.tobytes()), []).append(reading)
    return list(groups.values())


def _grow_alike(
    image: GreyImage,
    readings: list[Markers[Layout]],
    prints: MarkerPrints,
    count: int | None,
    outline: Array | None,
    refine: Callable[[Array], Array] | None,
) -> list[Markers[Layout]]:
    """Read the markers beside those of readings that place them alike; see `grow_markers`."""
    read = readings[0]
    layouts = [reading.layout for reading in readings]
    known = len(prints.steps) if count is None else min(count, len(prints.steps))
    places = np.stack([_locate_all(read, layout, known) for layout in layouts])
    tried = newest = read.squares
    least: float | None = None
    for _ in range(_MAX_ROUNDS):
        beside = (newest[:, None] + prints.neighbours).reshape(-1, 2)
        squares = _leave_out(np.unique(beside, axis=0), tried)
        squares = squares[_match_places(squares, places).any(axis=1)]
        if not len(squares):
            break
        if least is None:
            least = _MIN_RELATIVE_SWING * float(np.median(prints.rate_markers(image, read)[1]))
        tried = np.concatenate([tried, squares])
        wanted = _predict_markers(image.shape, read, squares, outline)
        if refine is not None:
            wanted = replace(wanted, corners=refine(wanted.corners))
        more = _read_by_steps(image, wanted, places, prints, least)
        newest = more.squares
        if not len(newest):
            break
        read = read.join(more)
    return [_place(read, layout) for layout in layouts]


def _predict_markers(
    shape: tuple[int, ...], read: Markers[Layout], squares: IntArray, outline: Array | None
) -> Markers[Layout]:
    """Predict markers at `squares` (n, 2), whose numbers are not known yet, from those beside them
    that were read; those that leave the image of `shape` (h, w) or an outline are left out."""
    numbers, corners = np.full(len(squares), -1), np.zeros((len(squares), 4, 2))
    wanted = replace(read, squares=squares, numbers=numbers, corners=corners)
    uv, _ = predict_places(wanted.board_corners.reshape(-1, 2), read.board_corners, read.corners)
    wanted = replace(wanted, corners=uv.reshape(-1, 4, 2))
    inside = board_ends.are_in_image(wanted.corners, shape).all(axis=1)
    if outline is not None:
        inside &= are_inside(outline, wanted.corners.mean(axis=1))
    return wanted.select(np.flatnonzero(inside))


def _read_by_steps(
    image: GreyImage, wanted: Markers[Layout], places: IntArray, prints: MarkerPrints, least: float
) -> Markers[Layout]:
    """Read markers where they are predicted.

    Args:
        image: (h, w) grey levels.
        wanted: the markers, whose numbers are not known yet.
        places: (k, m, 2) the squares of the numbers from 0 on each layout that the board may have.
        prints: of all numbers.
        least: height of a marker's steps.

    Returns:
        Those that were read, with their numbers.
    """
    if not len(wanted.squares):
        return wanted
    seen = list_differences(measure_cells(image, wanted.corners, prints.side))
    steps = prints.steps[: places.shape[1]]
    share = np.sign(seen) @ steps.T / np.abs(steps).sum(axis=1)
    may_be = _match_places(wanted.squares, places)
    numbers = np.where(may_be, share, -np.inf).argmax(axis=1)
    right, height = prints.rate(seen, numbers)
    good = np.flatnonzero((right > MIN_RIGHT_STEPS) & (height > least))
    return replace(wanted, numbers=numbers).select(good)


def _match_places(squares: IntArray, places: IntArray) -> BoolArray:
    """Return which numbers (n, m) may stand in squares (n, 2), given the `places` (k, m, 2) of the
    numbers on each layout that the board may have."""
    return np.asarray((places[:, None] == squares[:, None]).all(axis=3).any(axis=0))


def _locate_all(read: Markers[Layout], layout: Layout, count: int) -> IntArray:
    """Return the squares (count, 2) of all numbers on a layout, in the rows and columns of the
    markers read."""
    return layout.locate_squares(np.arange(count)) + _find_offset(read, layout)


def _find_offset(read: Markers[Layout], layout: Layout) -> IntArray:
    """Find by how many rows and columns (2,) most markers are away from their squares on a
    layout."""
    away = read.squares - layout.locate_squares(read.numbers)
    if (away == away[0]).all():
        return away[0]
    offsets, count = np.unique(away, axis=0, return_counts=True)
    return offsets[count.argmax()]


def _leave_out(squares: IntArray, tried: IntArray) -> IntArray:
    """Leave out those of the squares (n, 2) that are among `tried` (m, 2)."""
    known = set(map(tuple, tried.tolist()))
    return squares[[tuple(square) not in known for square in squares.tolist()]]


def _place(read: Markers[Layout], layout: Layout) -> Markers[Layout]:
    """Place markers, whose squares are known up to an offset, on a layout: those that agree on it,
    each number once."""
    expected = layout.locate_squares(read.numbers)
    agree = np.flatnonzero((read.squares - expected == _find_offset(read, layout)).all(axis=1))
    _, once = np.unique(read.numbers[agree], return_index=True)
    kept = agree[np.sort(once)]
    return Markers(layout, expected[kept], read.numbers[kept], read.corners[kept], read.side)

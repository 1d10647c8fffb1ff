"""Circles in places that are listed one by one: layouts that no grid of rows and columns describes.

Boards for thermal cameras have rows of 16 and 17 holes by turns; others have circles strewn over
them. Their pitch is the least distance of two circles. A circle is numbered by its place, in steps
of half a pitch along Y and along X, so that row and column are nearly in proportion to where it
lies and no two circles share them:

    row = round(2 (Y - Y_min)),    column = round(2 (X - X_min))    (X, Y in pitches).

Most rows and columns hold no circle at most of their crossings.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import numpy.typing as npt
import scipy

from calibgui.engine.arrays import Array, GridSize, IntArray
from calibgui.engine.boards.pattern import Pattern, Symmetry
from calibgui.engine.boards.printed_pattern import PrintedDiscs, PrintedPattern
from calibgui.engine.errors import CalibrationError


@dataclass(frozen=True, slots=True)
class ListedCircles:
    """The pattern of circles in places of their own.

    Lengths are ratios to the pitch, as in every pattern; `list_circles` takes millimetres.
    """

    places: tuple[tuple[float, float], ...] | None = None
    """(X, Y) of every circle, pitches, from the least X and Y on; None where they are not stated,
    and nothing can be found."""
    diameter: float | None = None
    """Ratio of the circles' diameter to the pitch; None if it is to be measured in the images."""

    def __post_init__(self) -> None:
        if self.diameter is not None and not 0 < self.diameter < 1:
            raise CalibrationError(
                f"The circles' diameter is {self.diameter:.4g} of the least distance of two, and "
                "must be above 0 and below 1, where they touch.",
                "Measure both in mm.",
            )
        if self.places is not None:
            _check_places(np.array(self.places, dtype=np.float64))

    @property
    def kind(self) -> str:
        return "listed-circles"

    @property
    def identifies_points(self) -> bool:
        return False

    @property
    def has_squares(self) -> bool:
        return False

    @property
    def half_distance(self) -> float:
        """Half the least distance of two circles, pitches: the radius at which they touch."""
        return 0.5

    @property
    def grid(self) -> IntArray:
        """(n, 2) row and column of each circle."""
        return _number(self._known_places)

    @property
    def grid_size(self) -> GridSize:
        """Numbers of rows and columns that hold all circles."""
        rows, cols = (self.grid.max(axis=0) + 1).tolist()
        return rows, cols

    @property
    def _known_places(self) -> tuple[tuple[float, float], ...]:
        if self.places is None:
            raise CalibrationError(
                "It is not known where the circles of the board lie.",
                "State the file that lists them.",
            )
        return self.places

    def list_paper(self) -> Array:
        """List displacements (8, 2) from a circle's centre to paper around it, pitches."""
        angle = np.arange(8) * np.pi / 4
        return self.half_distance * np.column_stack([np.cos(angle), np.sin(angle)])

    def list_neighbours(self) -> Array:
        """List displacements (2, 2) from a circle to its neighbours on one side, pitches: the
        nearest two that are not on one line with it, as most circles have them."""
        return _list_usual_steps(self._known_places)

    def locate_points(self, grid: Array) -> Array:
        """See ``Pattern``: where there is no circle, the place that the numbers stand for."""
        places = np.array(self._known_places)
        at = np.full(self.grid_size, -1)
        at[tuple(self.grid.T)] = np.arange(len(places))
        row, col = np.rint(grid).astype(np.int64).T
        is_inside = (row >= 0) & (row < at.shape[0]) & (col >= 0) & (col < at.shape[1])
        index = np.where(is_inside, at[row * is_inside, col * is_inside], -1)
        return np.where((index >= 0)[:, None], places[index], grid[:, ::-1] / 2)

    def symmetry(self, grid_size: GridSize) -> Symmetry:  # noqa: ARG002 - it has but one
        """See ``Pattern``."""
        turns = [quarters for quarters, _ in self.list_turns()]
        if len(turns) == 4:
            return Symmetry.QUARTER_TURN
        return Symmetry.HALF_TURN if 2 in turns else Symmetry.NONE

    def list_turns(self) -> list[tuple[int, IntArray]]:
        """List the quarters of a turn that leave the board as it is, with the circle (n,) that each
        of its circles then lies on."""
        return list(_list_turns(self._known_places))

    def complete_from(self, seen: Sequence[Pattern]) -> ListedCircles:
        """See ``Pattern``: the diameter is the median of those seen."""
        diameters = [
            pattern.diameter
            for pattern in seen
            if isinstance(pattern, ListedCircles) and pattern.diameter
        ]
        if self.diameter is not None or not diameters:
            return self
        return replace(self, diameter=round(float(np.median(diameters)), 4))

    def draw(self, grid_size: GridSize) -> PrintedPattern:  # noqa: ARG002 - it has but one
        """See ``Pattern``."""
        centres = np.array(self._known_places)
        if self.diameter is None:
            raise CalibrationError("The circles' diameter is not known.", "State it.")
        right, bottom = (centres.max(axis=0) + 1).tolist()
        return PrintedDiscs(centres, self.diameter / 2, (-1.0, -1.0, right, bottom))


def list_circles(
    places: npt.ArrayLike, diameter: float | None = None
) -> tuple[ListedCircles, float]:
    """Make a pattern of circles at places (n, 2), X right and Y down, mm, of a diameter, mm.

    Returns:
        The pattern, and its pitch in mm, the least distance of two circles: the side of a `Board`'s
        squares.

    Raises:
        CalibrationError: if there are no two circles, two in one place, or a place is no number.

    Example:
        >>> from calibgui.engine import list_circles
        >>> pattern, pitch = list_circles([(0, 0), (20, 0), (10, 15), (30, 15)], diameter=6)
        >>> pitch, pattern.grid.tolist()
        (18.027756377319946, [[0, 0], [0, 2], [2, 1], [2, 3]])
    """
    xy = np.asarray(places, dtype=np.float64)
    _check_places(xy)
    pitch = _measure_pitch(xy)
    told = tuple((float(x), float(y)) for x, y in (xy - xy.min(axis=0)) / pitch)
    return ListedCircles(told, None if diameter is None else diameter / pitch), pitch


def _check_places(xy: Array) -> None:
    """Raise CalibrationError unless `xy` are places (n, 2) of circles that lie apart."""
    remedy = "List X and Y of every circle's centre once, in mm."
    if xy.ndim != 2 or xy.shape[1] != 2 or len(xy) < 2:
        raise CalibrationError("A board of listed circles has two or more of them.", remedy)
    if not np.isfinite(xy).all():
        raise CalibrationError("A circle's place is no number.", remedy)
    if not _measure_pitch(xy) > 0:
        raise CalibrationError("Two circles of the list lie in one place.", remedy)


def _measure_pitch(xy: Array) -> float:
    return float(np.asarray(scipy.spatial.cKDTree(xy).query(xy, k=2)[0])[:, 1].min())


@lru_cache
def _number(places: tuple[tuple[float, float], ...]) -> IntArray:
    xy = np.array(places)
    steps = np.rint(2 * (xy - xy.min(axis=0))).astype(np.int64)
    return steps[:, ::-1]


@lru_cache
def _list_usual_steps(places: tuple[tuple[float, float], ...]) -> Array:
    xy = np.array(places)
    pairs = scipy.spatial.cKDTree(xy).query_pairs(2.0, output_type="ndarray")
    steps = xy[pairs[:, 1]] - xy[pairs[:, 0]]
    steps *= np.where((steps[:, :1] < 0) | ((steps[:, :1] == 0) & (steps[:, 1:] < 0)), -1, 1)
    kinds, count = np.unique(np.round(steps, 2), axis=0, return_counts=True)
    kinds = kinds[np.lexsort((np.linalg.norm(kinds, axis=1), -count))]
    aside = np.rint(2 * kinds @ np.array([-kinds[0, 1], kinds[0, 0]])) != 0
    return kinds[[0, int(np.argmax(aside))]]


@lru_cache
def _list_turns(
    places: tuple[tuple[float, float], ...],
) -> tuple[tuple[int, IntArray], ...]:
    xy = np.array(places)
    off = xy - (xy.min(axis=0) + xy.max(axis=0)) / 2
    tree, found = scipy.spatial.cKDTree(off), []
    for quarters, (c, s) in enumerate(((1, 0), (0, 1), (-1, 0), (0, -1))):
        distance, index = tree.query(off @ np.array([(c, s), (-s, c)]))
        if not np.rint(2 * distance).any():  # within the steps of the numbering
            found.append((quarters, np.asarray(index)))
    return tuple(found)

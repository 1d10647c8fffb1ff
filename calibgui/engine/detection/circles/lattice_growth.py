"""A lattice grown among points, place by place.

The points found so far predict the next ones, by continuing lines, by halving the way between
neighbours and by completing parallelograms, so that perspective and lens may change the steps from
one end to the other. Growth goes around circles that are covered. Points are complex numbers u + iv
here.
"""

from __future__ import annotations

from itertools import product
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.detection.circles.thresholds import CIRCLE_THRESHOLDS

Place = tuple[int, int]
"""Coordinates on the lattice."""
_STEPS = ((1, 0), (-1, 0), (0, 1), (0, -1))
_DIAGONALS = tuple(product((1, -1), (1, -1)))


class PointLattice(NamedTuple):
    """Points in places of a lattice."""

    places: IntArray
    """(n, 2) coordinates."""
    points: IntArray
    """(n,) index of the point at each."""

    def list_places(self) -> dict[int, Place]:
        """Return the place of each point."""
        return dict(zip(self.points.tolist(), map(tuple, self.places.tolist()), strict=True))

    def change_basis(self, by: IntArray) -> PointLattice:
        """Return the lattice with its places in the basis that `by` (2, 2) takes them to."""
        return PointLattice(self.places @ by.T, self.points)


def grow_lattice(start: PointLattice, points: Array) -> PointLattice:
    """Grow a lattice by every one of the `points` (n, 2) px that lies where it predicts one."""
    return PointLattice(*_grow(*start, points, CIRCLE_THRESHOLDS.max_prediction_error))


@kernels.with_kernel("lattice_growth", "grow")
def _grow(
    places: IntArray, chosen: IntArray, points: Array, max_error: float
) -> tuple[IntArray, IntArray]:
    """Grow a lattice.

    Args:
        places: (k, 2) that are taken in the beginning.
        chosen: (k,) index of the point at each.
        points: (n, 2) px.
        max_error: greatest distance of a point from where it is predicted, shorter steps.

    Returns:
        The places (m, 2) and the points (m,) in the end.
    """
    tree = scipy.spatial.cKDTree(points)
    z: list[complex] = (points[:, 0] + 1j * points[:, 1]).tolist()
    placed: dict[Place, int] = dict(zip(map(tuple, places.tolist()), chosen.tolist(), strict=True))
    taken, edge = set(placed.values()), list(placed)
    unpredicted: set[Place] = set()
    while edge:
        # Beside a covered circle it may take longer until the points that predict one are placed.
        beside = {(i + di, j + dj) for i, j in edge for di, dj in _STEPS} | unpredicted
        beside -= placed.keys()
        expected = [(place, _predict_point(place, placed, z)) for place in sorted(beside)]
        unpredicted = {place for place, guesses in expected if not guesses}
        # Places with the most predictions come first: a point can be taken only once.
        expected = sorted((item for item in expected if item[1]), key=lambda item: -len(item[1]))
        edge = []
        for place, guesses in expected:
            mean = sum(at for at, _ in guesses) / len(guesses)
            found = tree.query([mean.real, mean.imag])
            off, point = float(np.asarray(found[0])), int(np.asarray(found[1]))
            if off < max_error * min(step for _, step in guesses) and point not in taken:
                placed[place] = point
                taken.add(point)
                edge.append(place)
    return np.array(list(placed)), np.array(list(placed.values()))


def _predict_point(
    place: Place, placed: dict[Place, int], z: list[complex]
) -> list[tuple[complex, float]]:
    """Predict a place's point from its neighbours: positions, and the lengths of their steps."""
    i, j = place

    def at(di: int, dj: int) -> complex | None:
        index = placed.get((i + di, j + dj))
        return None if index is None else z[index]

    guesses = []
    for di, dj in _STEPS:
        next_, second = at(di, dj), at(2 * di, 2 * dj)
        if next_ is not None and second is not None:
            third = at(3 * di, 3 * dj)
            continued = 2 * next_ - second if third is None else 3 * (next_ - second) + third
            guesses.append((continued, abs(next_ - second)))
    for di, dj in _STEPS[::2]:
        before, after = at(di, dj), at(-di, -dj)
        if before is not None and after is not None:
            guesses.append(((before + after) / 2, abs(after - before) / 2))
    for di, dj in _DIAGONALS:
        along, across, diagonal = at(di, 0), at(0, dj), at(di, dj)
        if along is not None and across is not None and diagonal is not None:
            step = min(abs(along - diagonal), abs(across - diagonal))
            guesses.append((along + across - diagonal, step))
    return guesses

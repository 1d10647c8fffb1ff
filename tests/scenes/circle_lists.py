"""Boards of circles that no grid of rows and columns describes."""

from __future__ import annotations

import numpy as np

Places = list[tuple[float, float]]


def list_rows_by_turns(rows: int, longer: int, pitch: float = 20.0, first: int = 0) -> Places:
    """List circles in rows of two lengths by turns, offset by half a step, mm."""
    return [
        (pitch * (col + 0.5 * ((row + first) % 2)), 0.85 * pitch * row)
        for row in range(rows)
        for col in range(longer - (row + first) % 2)
    ]


def strew(count: int, seed: int, least: float = 18.0) -> Places:
    """List circles strewn over a board of 260 x 180 mm, no two nearer than `least`."""
    rng = np.random.default_rng(seed)
    places: Places = []
    while len(places) < count:
        x, y = (float(each) for each in rng.uniform(0, 1, 2) * (260, 180))
        if all(np.hypot(x - a, y - b) > least for a, b in places):
            places.append((x, y))
    return places

"""Faults of the board: its shape, its print, and several boards taken as one."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from calibgui.engine.arrays import Array
from tests.faults.sets import (
    FaultySet,
    PhotographedSet,
    Rng,
    draw_log,
    draw_set,
    photograph,
    state_fault,
)


def _displace_all(
    rng: Rng, what: str, displacement: Callable[[Array], Array], size: float
) -> FaultySet:
    """Photograph a board whose corners are off by `size` mm rms along a field (n, 3).

    The field is a function of the corners' places in a square from -1 to 1.
    """
    photographed = draw_set(rng)
    board = max(photographed.boards, key=len)
    middle, half = (board.min(axis=0) + board.max(axis=0)) / 2, np.ptp(board, axis=0) / 2
    # The board's size relative to the rendered one's: a real board may be smaller.
    size *= float(half.max()) / 165
    raw = displacement((board - middle) / half)
    scale = size / np.sqrt(np.mean(np.sum((raw - raw.mean(axis=0)) ** 2, axis=1)))

    def displace(xy: Array) -> Array:
        flat = np.column_stack([xy, np.zeros(len(xy))])
        return np.asarray(flat + scale * displacement((xy - middle) / half))

    views = photograph(photographed, displace=displace)
    return state_fault(photographed, views, f"{what} {size:.2f} mm")


def bow_board(rng: Rng) -> FaultySet:
    """Bow the board about an axis in any direction."""
    angle, size = rng.uniform(0, np.pi), draw_log(rng, 0.05, 3.0)

    def bow(s: Array) -> Array:
        along = s @ np.array([np.cos(angle), np.sin(angle)])
        return np.column_stack([0 * along, 0 * along, along**2])

    return _displace_all(rng, "bow of rms", bow, size)


def twist_board(rng: Rng) -> FaultySet:
    """Twist the board about its middle."""
    size = draw_log(rng, 0.05, 3.0)

    def twist(s: Array) -> Array:
        return np.column_stack([0 * s[:, 0], 0 * s[:, 0], s[:, 0] * s[:, 1]])

    return _displace_all(rng, "twist of rms", twist, size)


def bend_board(rng: Rng) -> FaultySet:
    """Bend the board anew in each view, as paper in the hand does."""
    photographed = draw_set(rng)
    board = max(photographed.boards, key=len)
    middle, half = (board.min(axis=0) + board.max(axis=0)) / 2, np.ptp(board, axis=0) / 2
    size = draw_log(rng, 0.1, 3.0) * float(half.max()) / 165
    views, K = [], len(photographed.poses)
    for k, bend in enumerate(rng.normal(0, size, (K, 3))):

        def displace(xy: Array, bend: Array = bend) -> Array:
            x, y = ((xy - middle) / half).T
            return np.column_stack([xy, np.column_stack([x * x, x * y, y * y]) @ bend])

        views += photograph(photographed.select([k]), displace=displace)
    return state_fault(photographed, views, f"bends by {size:.2f} mm from view to view")


def print_askew(rng: Rng) -> FaultySet:
    """Print the board stretched along one axis and sheared."""
    stretch, shear = draw_log(rng, 2e-4, 2e-2), draw_log(rng, 2e-4, 2e-2)
    return _stretch(rng, np.array([[1 + stretch, shear], [0.0, 1.0]]), "affine print")


def mistake_square(rng: Rng) -> FaultySet:
    """State the wrong square along one axis."""
    factor = 1 + draw_log(rng, 0.01, 0.3)
    return _stretch(rng, np.diag(rng.permutation([factor, 1.0])), "squares not square")


def _stretch(rng: Rng, matrix: Array, what: str) -> FaultySet:
    photographed = draw_set(rng)
    views = photograph(
        photographed, displace=lambda xy: np.column_stack([xy @ matrix.T, np.zeros(len(xy))])
    )
    story = f"{what} {np.round(matrix.ravel(), 4).tolist()}"
    return state_fault(photographed, views, story)


def print_roughly(rng: Rng) -> FaultySet:
    """Print every corner a little off, by the same in all views."""
    photographed = draw_set(rng)
    size = draw_log(rng, 0.002, 0.05) * photographed.square
    views = photograph(photographed, displace=roughen(photographed, size, rng))
    return state_fault(photographed, views, f"print rough by {size:.2f} mm a coordinate")


def roughen(photographed: PhotographedSet, size: float, rng: Rng) -> Callable[[Array], Array]:
    """Draw a print whose corners are off by `size` mm a coordinate, for `photograph`."""
    places = {
        tuple(p): rng.normal(0, size, 2) for p in np.unique(np.vstack(photographed.boards), axis=0)
    }

    def displace(xy: Array) -> Array:
        off = np.array([places[tuple(p)] for p in xy])
        return np.column_stack([xy + off, np.zeros(len(xy))])

    return displace


def mix_boards(rng: Rng) -> FaultySet:
    """Photograph half of the views with another print, whose squares differ.

    Squares of another size alone only move a flat board nearer; a print that was stretched as well
    (every other draw) bends the answer.
    """
    photographed = draw_set(rng)
    factor = 1 + draw_log(rng, 0.01, 0.2)
    stretch = 1 + draw_log(rng, 1e-3, 3e-2) if rng.random() < 0.5 else 1.0
    own = photograph(photographed)
    other = photograph(
        photographed,
        displace=lambda xy: np.column_stack(
            [factor * xy[:, 0], factor * stretch * xy[:, 1], np.zeros(len(xy))]
        ),
    )
    views = own[: len(own) // 2] + other[len(other) // 2 :]
    story = f"second board {factor:.3f} times as large, {stretch:.4f} times as high"
    return state_fault(photographed, views, story)

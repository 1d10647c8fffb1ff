"""Boards of which only a part is seen: off the image on 1, 2 or 3 sides, or behind something.

A corner counts as visible with a third of a square all around it in the image and uncovered.
What is found is compared with the truth up to what the part leaves open: where rows and columns
start to count, and quarter turns. A corner is wrong if it is none of the board's, lies more than
a tenth of a square off, or has another place than most corners of its board have.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from calibgui.engine.features.corners import Corners
from tests.scenes.checkerboards import Scene, draw
from tests.scenes.conditions import Conditions

Board = tuple[int, int]
SCENES = 12
"""Of each kind."""

KINDS: dict[str, dict[str, Any]] = {
    "off 1 side": {"centre": (230.0, 0.0), "turn": 30.0, "square": 36.0},
    "off 1 long side": {"centre": (0.0, 190.0), "turn": 20.0, "square": 36.0},
    "off 2 sides": {"centre": (190.0, 140.0), "turn": 180.0, "square": 40.0},
    "off 3 sides": {"centre": (0.0, 150.0), "turn": 15.0, "square": 80.0},
    "object": {"occluder": "object", "square": 40.0},
    "hand": {"occluder": "hand", "square": 40.0},
    "hand, off 1 side": {"occluder": "hand", "centre": (200.0, 0.0), "square": 40.0},
    "object, clutter": {"occluder": "object", "clutter": True, "quiet": 0.4, "square": 40.0},
}


@dataclass(frozen=True)
class Count:
    """Of corners, in one photograph or several."""

    visible: int = 0
    found: int = 0
    """Visible ones that were found in their place."""
    wrong: int = 0

    def __add__(self, other: Count) -> Count:
        return Count(
            self.visible + other.visible, self.found + other.found, self.wrong + other.wrong
        )


def scenes(kind: str, count: int) -> list[Scene]:
    """Scenes of a kind, with the board, the lens and the photograph's quality varied."""
    drawn = []
    for seed in range(count):
        rng = np.random.default_rng([seed, 7])
        varied: dict[str, Any] = {
            "grid_size": [(6, 9), (5, 7), (7, 10), (6, 8)][seed % 4],
            "tilt": rng.uniform(0, 50),
            "distortion": rng.choice([0.0, 0.3, -0.15]),
            "blur": rng.uniform(0.5, 2.0),
            "noise": rng.uniform(0.5, 6.0),
            "light": rng.uniform(0, 1),
            "parts": 2,
        }
        drawn.append(draw(Conditions(**(varied | KINDS[kind])), seed))
    return drawn


def count(scene: Scene, known: bool, seed: int = 0) -> Count:
    """What is found of the board in a photograph of `scene`, its size known or not."""
    visible = scene.visible
    try:
        corners = find_corners(
            scene.photograph(seed), scene.conditions.grid_size if known else None
        )
    except NoBoardError:
        return Count(visible=int(visible.sum()))
    right, place = compare(corners, scene, known)
    found = visible[place[right, 0], place[right, 1]].sum()
    return Count(int(visible.sum()), int(found), int(np.count_nonzero(~right)))


def compare(
    corners: Corners, scene: Scene, known: bool
) -> tuple[NDArray[np.bool_], NDArray[np.int64]]:
    """Which corners (n,) are right, and the true places (n, 2) nearest to all."""
    truth = scene.uv.reshape(-1, 2)
    distance = np.linalg.norm(corners.uv[:, None] - truth, axis=2)
    nearest = np.argmin(distance, axis=1)
    place = np.column_stack(np.divmod(nearest, scene.uv.shape[1]))
    off = distance.min(axis=1)
    at_all = off < np.maximum(scene.spacing.ravel()[nearest] / 10, 1.0)
    best = np.zeros(len(corners), np.bool_)
    for turn in _turns(scene.conditions.grid_size, known and not corners.relative):
        moved = corners.grid - place @ turn.T
        _, index, counts = np.unique(moved, axis=0, return_inverse=True, return_counts=True)
        agree = index.ravel() == np.argmax(counts)
        if agree.sum() > best.sum():
            best = agree
    return at_all & best, place


def _turns(board: Board, absolute: bool) -> list[NDArray[np.int64]]:
    """Quarter turns that a numbering may differ by; of an `absolute` one, those that the board's
    pattern hides."""
    quarter = np.array([[0, 1], [-1, 0]])
    turns = [np.linalg.matrix_power(quarter, k) for k in range(4)]
    if not absolute:
        return turns
    return turns[:1] if sum(board) % 2 else turns[::2]


def total(kind: str, known: bool, amount: int = SCENES) -> Count:
    """Over `amount` scenes of a kind."""
    return sum((count(scene, known) for scene in scenes(kind, amount)), Count())

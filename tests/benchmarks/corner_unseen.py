"""Conditions that nothing was tuned on: drawn at random over all that boards are promised under.

Image size, bits, lens, tilt, size of the squares, blur, motion, light, clutter, quiet zone, ink
and response are sampled independently, but for what no finder could see: squares are 8 px or more
across where tilt makes them narrowest on average, and blur and motion stay below a share of that.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tests.benchmarks.corner_partial import Count, count
from tests.scenes.checkerboards import Scene, draw
from tests.scenes.conditions import Conditions

SCENES = 60
_SIZES = [(640, 480), (1280, 960), (1920, 1080), (4000, 3000), (8192, 6144)]
_SHARES = [0.45, 0.3, 0.17, 0.06, 0.02]
_BLURRED = 0.12
"""Greatest blur over the narrow side of a square."""


def conditions(seed: int) -> Conditions:
    """One combination."""
    rng = np.random.default_rng([seed, 11])
    size = _SIZES[rng.choice(len(_SIZES), p=_SHARES)]
    rows = int(rng.integers(4, 9))
    grid_size = (rows, rows + int(rng.integers(1, 5)))
    tilt = float(rng.uniform(0, 70))
    narrow = np.cos(np.radians(tilt))
    largest = 0.7 * size[1] / (grid_size[1] + 1.5)
    square = float(np.exp(rng.uniform(np.log(min(10 / narrow, largest)), np.log(largest))))
    lens: dict[str, Any] = [
        {},
        {"distortion": rng.uniform(0, 0.5)},
        {"distortion": rng.uniform(-0.25, 0)},
        {"fisheye": True, "focal": rng.uniform(0.4, 0.8)},
    ][rng.integers(4)]
    return Conditions(
        grid_size=grid_size,
        size=size,
        square=square,
        tilt=tilt,
        shift=0.1 * size[1],
        blur=rng.uniform(0.4, max(min(5.0, _BLURRED * square * narrow), 0.5)),
        motion=rng.choice([0.0, 0.2 * rng.uniform() * square * narrow]),
        ink=rng.choice([0.0, rng.uniform(-0.06, 0.06)]),
        light=rng.uniform(0, 1),
        gamma=rng.uniform(1, 2.2),
        clutter=bool(rng.integers(2)),
        quiet=rng.uniform(0, 1),
        noise=rng.uniform(0.5, 8.0),
        deep=bool(rng.integers(2)),
        parts=2 if size[0] < 1500 else 1,
        **lens,
    )


@dataclass(frozen=True)
class Outcome:
    """Of photographs under unseen conditions."""

    whole: int = 0
    """Boards entirely in the image."""
    found: int = 0
    """Of these with every corner in its place and none besides."""
    corners: Count = field(default_factory=Count)

    def __add__(self, other: Outcome) -> Outcome:
        return Outcome(
            self.whole + other.whole, self.found + other.found, self.corners + other.corners
        )


def outcome(scene: Scene) -> Outcome:
    """What is found in one photograph, the board's size unknown."""
    counted = count(scene, known=False)
    whole = bool(scene.visible.all())
    right = counted.found == counted.visible and not counted.wrong
    return Outcome(int(whole), int(whole and right), counted)


def total(amount: int = SCENES) -> Outcome:
    """Over the first `amount` combinations."""
    return sum((outcome(draw(conditions(seed), seed)) for seed in range(amount)), Outcome())

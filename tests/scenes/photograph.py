"""A photograph of checkerboards with its truth, and what those of all troubles are made of."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from tests.scenes.conditions import Conditions

Array = NDArray[np.float64]
Image = NDArray[Any]
_BOARDS = ((6, 9), (5, 8), (7, 10), (8, 11), (10, 14))


@dataclass(frozen=True)
class Photograph:
    """An image of one or more boards."""

    image: Image
    boards: tuple[Array, ...]
    """(rows, cols, 2) px, the true corners of each."""
    hidden: NDArray[np.bool_] | None = None
    """(rows, cols) corners of the first board that need not be found, if there are any."""


Trouble = Callable[[int], Photograph]
"""A function from a seed to a photograph."""


def vary(seed: int, **settings: Any) -> Conditions:
    """Conditions of a board that fills much of the image, if they are not given."""
    rng = np.random.default_rng([seed, 21])
    grid_size = _BOARDS[seed % len(_BOARDS)]
    varied: dict[str, Any] = {
        "grid_size": grid_size,
        "square": rng.uniform(0.55, 0.8) * 480 / (grid_size[1] + 2),
        "tilt": rng.uniform(0, 40),
        "turn": rng.choice([15.0, 180.0]),
        "blur": rng.uniform(0.5, 1.2),
        "noise": rng.uniform(0.5, 4.0),
        "light": rng.uniform(0, 0.6),
        "parts": 2,
    }
    return Conditions(**(varied | settings))


def as_bytes(levels: Array) -> NDArray[np.uint8]:
    """Grey levels, or colours, as bytes."""
    return np.clip(np.rint(levels), 0, 255).astype(np.uint8)


def add_noise(levels: Array, noise: float, seed: int) -> Array:
    return levels + noise * np.random.default_rng([seed, 22]).standard_normal(levels.shape)


def shift_image(image: Array, by: Array) -> Array:
    """An image moved by `by` (2,) px."""
    M = np.array([[1.0, 0.0, by[0]], [0.0, 1.0, by[1]]])
    size = image.shape[::-1]
    moved = cv2.warpAffine(image, M, size, flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)
    return np.asarray(moved)


def as_grey(colour: Image) -> Image:
    return np.asarray(cv2.cvtColor(colour, cv2.COLOR_BGR2GRAY))

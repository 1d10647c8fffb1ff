"""Images without a board, some of which look much like one."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

KINDS = (
    "noise",
    "texture",
    "waves",
    "bricks",
    "polygons",
    "rectangles",
    "discs",
    "stripes",
    "halftone",
)
"""What they show; stripes are shifted from row to row, a halftone is a picture printed in dots."""


def draw_without_board(seed: int) -> NDArray[np.uint8]:
    """An image of one of the `KINDS` in turn, a little blurred and noisy."""
    rng = np.random.default_rng(seed)
    shape = (480, 640)
    v, u = np.mgrid[: shape[0], : shape[1]]
    kind = KINDS[seed % len(KINDS)]
    if kind == "noise":
        image = rng.uniform(0, 255, shape)
    elif kind == "texture":
        image = cv2.GaussianBlur(rng.normal(0, 1, shape), (0, 0), rng.uniform(1, 8))
        image = 127 + 60 * image / image.std()
    elif kind == "waves":
        a, b = rng.uniform(0.05, 0.8, 2)
        image = 127 + 60 * np.sin(a * u + rng.uniform(0, 6)) + 60 * np.sin(b * v + 0.3 * a * u)
    elif kind == "bricks":
        height, width = rng.integers(10, 40), rng.integers(20, 80)
        offset = (v // height % 2) * width // 2
        image = np.where((v % height < 3) | ((u + offset) % width < 3), 220, 90).astype(float)
    elif kind == "discs":
        turn, pitch = rng.uniform(0, np.pi), rng.uniform(12, 40)
        x, y = ((v * np.sin(turn + a) + u * np.cos(turn + a)) / pitch for a in (0, np.pi / 2))
        x = x + rng.integers(2) * np.floor(y) / 2  # every second row may be shifted
        image = np.where(np.hypot(x % 1 - 0.5, y % 1 - 0.5) < rng.uniform(0.15, 0.55), 220.0, 40.0)
    elif kind == "stripes":
        turn, width = rng.uniform(0, np.pi), rng.uniform(8, 40)
        x, y = ((v * np.sin(turn + a) + u * np.cos(turn + a)) / width for a in (0, np.pi / 2))
        x = x + rng.choice([0.25, 0.5, 0.75]) * (np.floor(y / rng.uniform(0.5, 2)) % 2)
        image = np.where(np.floor(x) % 2 == 0, 45.0, 205.0)
    elif kind == "halftone":
        turn, pitch = rng.uniform(0, np.pi), rng.uniform(1, 5)
        x, y = ((v * np.sin(turn + a) + u * np.cos(turn + a)) / pitch for a in (0, np.pi / 2))
        tone = 0.9 * np.sin(u / rng.uniform(60, 200)) * np.sin(v / rng.uniform(60, 200))
        image = np.where(np.cos(x) + np.cos(y) < 2 * tone, 205.0, 45.0)
    else:
        image = np.full(shape, 127.0)
        for _ in range(400):
            centre = rng.uniform(0, 1, 2) * shape[::-1]
            size = rng.uniform(4, 60)
            if kind == "polygons":
                polygon = centre + rng.uniform(-1, 1, (rng.integers(3, 7), 2)) * size
                cv2.fillPoly(image, [polygon.astype(np.int32)], float(rng.uniform(0, 255)))
            else:
                corner = centre.astype(int)
                far = corner + rng.integers(4, 40, 2)
                cv2.rectangle(image, corner.tolist(), far.tolist(), float(rng.uniform(0, 255)), -1)
    image = cv2.GaussianBlur(image, (0, 0), 0.7) + rng.normal(0, 3, shape)
    return np.clip(image, 0, 255).astype(np.uint8)

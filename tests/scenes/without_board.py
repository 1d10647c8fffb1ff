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


def draw_without_board(
    seed: int, shape: tuple[int, int] = (480, 640), scale: float = 1.0
) -> NDArray[np.uint8]:
    """An image (h, w) of one of the `KINDS` in turn, a little blurred and noisy; what is drawn, but
    for noise by the pixel, is `scale` times as large as in an image of 480 x 640."""
    rng = np.random.default_rng(seed)
    v, u = np.mgrid[: shape[0], : shape[1]] / scale
    kind = KINDS[seed % len(KINDS)]
    if kind == "noise":
        image = rng.uniform(0, 255, shape)
    elif kind == "texture":
        grain = rng.normal(0, 1, [round(side / scale) for side in shape])
        image = cv2.GaussianBlur(grain, (0, 0), rng.uniform(1, 8))
        image = cv2.resize(image, shape[::-1], interpolation=cv2.INTER_CUBIC)
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
        for _ in range(round(400 * image.size / (480 * 640 * scale**2))):
            centre = rng.uniform(0, 1, 2) * shape[::-1]
            size = scale * rng.uniform(4, 60)
            if kind == "polygons":
                polygon = centre + rng.uniform(-1, 1, (rng.integers(3, 7), 2)) * size
                cv2.fillPoly(image, [polygon.astype(np.int32)], float(rng.uniform(0, 255)))
            else:
                corner = centre.astype(int)
                far = corner + (scale * rng.integers(4, 40, 2)).astype(int)
                cv2.rectangle(image, corner.tolist(), far.tolist(), float(rng.uniform(0, 255)), -1)
    image = cv2.GaussianBlur(image, (0, 0), 0.7) + rng.normal(0, 3, shape)
    return np.clip(image, 0, 255).astype(np.uint8)


def draw_foliage(seed: int, shape: tuple[int, int] = (480, 640)) -> NDArray[np.uint8]:
    """An image (h, w) of leaves upon leaves: their radii r are as frequent as r^-3, so that it
    looks alike from any distance, as photographs of nature do (Lee, Mumford and Huang 2001)."""
    rng = np.random.default_rng(seed)
    image = np.full(shape, 127.0)
    count = image.size // 60
    radii = 3.0 / np.sqrt(1 - rng.uniform(0, 1 - (3.0 / (min(shape) / 6)) ** 2, count))
    centres = rng.uniform(0, 1, (count, 2)) * shape[::-1]
    for centre, radius in zip(centres.astype(int).tolist(), radii, strict=True):
        axes = (int(radius), max(1, int(radius * rng.uniform(0.2, 0.8))))
        angle, level = rng.uniform(0, 180), rng.uniform(10, 245)
        cv2.ellipse(image, centre, axes, angle, 0, 360, level, -1)
    image = cv2.GaussianBlur(image, (0, 0), 0.7) + rng.normal(0, 3, shape)
    return np.clip(image, 0, 255).astype(np.uint8)

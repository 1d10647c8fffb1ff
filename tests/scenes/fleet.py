"""Photographs of many small cameras, rendered with known truth: a folder for each."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.images.reading import write_image
from calibgui.engine.images.rendering import render_view
from tests.engine import scenes

BOARD = Board(rows=6, cols=7, square=30.0)


def make_camera(seed: int, size: tuple[int, int] = (320, 240)) -> Camera:
    """Return a camera whose focal length, centre and distortion are drawn."""
    rng = np.random.default_rng([seed, 0])
    width, height = size
    f = width * rng.uniform(0.95, 1.1)
    centre = np.array([width, height]) / 2 + rng.uniform(-0.02, 0.02, 2) * width
    k1 = rng.uniform(0.1, 0.2)
    return Camera(size, np.array([f, f * 1.005, *centre, k1, 0.03, 0.0, 0.0, 0.0, 0.0]))


def write_camera(
    folder: Path, camera: Camera, seed: int, count: int = 6, board: Board = BOARD
) -> None:
    """Write `count` photographs that a camera takes of a board to a folder, which is made."""
    folder.mkdir(parents=True)
    rng = np.random.default_rng([seed, 1])
    for number in range(1, count + 1):
        pose = scenes.looking(camera, rng, fill=(0.55, 0.7), board=board)
        image = render_view(camera, pose, board, blur=0.7, noise=1.0, seed=seed + number)
        write_image(folder / f"view{number}.png", image)


def write_fleet(folder: Path, seeds: Iterable[int]) -> None:
    """Write the photographs of one small camera for each seed to folders c0, c1, ..."""
    for seed in seeds:
        write_camera(folder / f"c{seed}", make_camera(seed), seed)

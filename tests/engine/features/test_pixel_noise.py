"""Noise between pixels: read in squares of any brightness, whatever light and waves do."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.detection.checkerboard.find_checkerboard import find_checkerboard
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.features.pixel_noise import estimate_pixel_noise
from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions

_V, _U = np.mgrid[:240.0, :320.0]
_ROWS, _COLS = np.mgrid[:8, :12]
_LATTICE = Lattice(np.stack([24.0 * _COLS + 20, 24.0 * _ROWS + 20], axis=2), True)


@pytest.mark.parametrize("noise", [0.0, 3.0, 12.0])
def test_noise_is_told_from_light_and_waves(noise: float) -> None:
    added = noise * np.random.default_rng(3).standard_normal(_V.shape)
    image = 80 + 0.2 * _U + 40 * np.sin(_U / 8) * np.sin(_V / 8) + added
    assert estimate_pixel_noise(_LATTICE, image) == pytest.approx(noise, rel=0.15, abs=0.1)


def test_too_few_squares_tell_nothing() -> None:
    image = np.random.default_rng(4).normal(100, 9, (240, 320))
    few = Lattice(_LATTICE.uv[:3, :3], True)
    assert estimate_pixel_noise(few, image) == 0.0


@pytest.mark.parametrize("seed", [0, 5])
def test_a_board_as_dark_as_its_noise_is_one(seed: int) -> None:
    scene = draw(Conditions(grid_size=(6, 9), square=30.0, tilt=20.0, blur=0.8, parts=2), seed)
    rng = np.random.default_rng(seed)
    dark = 40 + 0.16 * scene.clean + 11.0 * rng.standard_normal(scene.clean.shape)
    found = find_checkerboard(np.clip(np.rint(dark), 0, 255).astype(np.uint8))
    assert len(found.uv) == 54

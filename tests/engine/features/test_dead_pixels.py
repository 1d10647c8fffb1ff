"""Dead pixels are repaired, and nothing that a board shows is taken for one."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.features.pixel_noise import repair_dead_pixels
from tests.engine.painted_squares import alternate, paint, place
from tests.scenes.tally import judge
from tests.scenes.troubles import TROUBLES


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize(("level", "col"), [(255, 60), (0, 80)])
def test_one_or_two_pixels_that_stand_out_are_repaired(dtype: Any, level: int, col: int) -> None:
    """White ones in a dark square, black ones in a bright one."""
    image = paint(alternate(6, 9)).astype(dtype)
    damaged = image.copy()
    damaged[58, col], damaged[62, col : col + 2] = level, level
    repaired = repair_dead_pixels(damaged, place(6, 9))
    assert repaired is not None
    assert repaired.dtype == dtype
    assert np.abs(repaired.astype(float) - image).max() <= 1
    assert np.count_nonzero(repaired != damaged) == 3


def test_nothing_is_repaired_of_a_board_nor_of_its_noise() -> None:
    image = paint(alternate(6, 9))
    assert repair_dead_pixels(image, place(6, 9)) is None
    noise = np.random.default_rng(0).normal(0, 17, image.shape)  # a tenth of the contrast
    noisy = np.clip(image + noise, 0, 255).astype(np.uint8)
    assert repair_dead_pixels(noisy, place(6, 9)) is None


def test_nothing_is_repaired_of_a_texture_of_pixels() -> None:
    image = paint(alternate(6, 9))
    image[::5, ::5] = 255
    assert repair_dead_pixels(image, place(6, 9)) is None


def test_hot_pixels_cost_no_corner() -> None:
    """Of 140 corners 3 were lost: white pixels are far brighter than the paper of a dim picture."""
    photograph = TROUBLES["hot pixels"](9)
    corners = find_corners(photograph.image)
    assert judge(photograph, (corners.grid, corners.uv)).whole

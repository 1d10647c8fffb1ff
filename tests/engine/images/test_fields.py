"""One field of an interlaced frame gives the corners of the moment at which it was taken."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.boards.board import Board
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.images.fields import Field, keep_field
from tests.engine.conftest import Scene


@pytest.mark.parametrize("seed", range(10))
def test_corners_of_a_field_are_where_the_board_was_then(seed: int) -> None:
    rng = np.random.default_rng(seed)
    scene = Scene(Board(6, 9, 25.0), distance=300.0, rvec=tuple(rng.normal(0, 0.3, 3)))
    moved = replace(scene, aside=tuple(rng.uniform(1.0, 3.0, 2)))
    frame = scene.image(seed=1).copy()
    frame[1::2] = moved.image(seed=2)[1::2]
    for field, shown in ((Field.ODD, scene), (Field.EVEN, moved)):
        corners = find_corners(keep_field(frame, field), (6, 9))
        assert corners.cov is not None
        error = shown.error(corners)
        assert abs(error).max() < 0.2  # of 3 px and more
        z2 = np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error) / 2
        assert 0.3 < np.sqrt(np.mean(z2)) < 1.6


@pytest.mark.parametrize("rows", [1, 2, 5, 6])
@pytest.mark.parametrize("shape", [(3,), (3, 3)])
def test_rows_of_the_field_stay_and_straight_ramps_too(rows: int, shape: tuple[int, ...]) -> None:
    ramp = np.broadcast_to(
        np.arange(rows, dtype=np.uint16).reshape(-1, *(1 for _ in shape)) * 40, (rows, *shape)
    )
    for field, first in ((Field.ODD, 0), (Field.EVEN, 1)):
        kept = keep_field(ramp, field)
        assert kept.shape == ramp.shape and kept.dtype == ramp.dtype
        np.testing.assert_array_equal(kept[first::2], ramp[first::2])
        np.testing.assert_array_equal(kept[1:-1], ramp[1:-1])

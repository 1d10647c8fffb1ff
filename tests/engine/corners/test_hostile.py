"""No image makes the finder hang, crash or see a board that is not there."""

from __future__ import annotations

import contextlib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from numpy.typing import NDArray

from calibgui.engine.corners import find_corners
from calibgui.engine.errors import NoBoardError


@settings(max_examples=40)
@given(
    hnp.arrays(np.uint8, st.tuples(st.integers(16, 48), st.integers(16, 48))),
    st.integers(1, 8),
)
def test_any_image_gets_an_answer(image: NDArray[np.uint8], zoom: int) -> None:
    with contextlib.suppress(NoBoardError):
        find_corners(np.kron(image, np.ones((zoom, zoom), np.uint8)))


@pytest.mark.parametrize("period", [1, 2, 3, 4])
@pytest.mark.parametrize("method", ["edges", "saddle"])
def test_endless_fine_checkers(period: int, method: str) -> None:
    v, u = np.mgrid[:300, :400]
    image = (255 * ((u // period + v // period) % 2)).astype(np.uint8)
    with contextlib.suppress(NoBoardError):
        find_corners(image, method=method)


@pytest.mark.parametrize("shape", [(16, 2000), (2000, 16), (17, 17)])
def test_odd_shapes(shape: tuple[int, int]) -> None:
    image = np.random.default_rng(0).integers(0, 255, shape).astype(np.uint8)
    with pytest.raises(NoBoardError):
        find_corners(image)


def test_saturated_halves() -> None:
    image = np.zeros((200, 300), np.uint16)
    image[:, 150:] = 65535
    with pytest.raises(NoBoardError):
        find_corners(image)

"""What the search for corners holds at a time is a few times the image."""

from __future__ import annotations

import contextlib
import tracemalloc
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from calibgui.engine import kernels
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from tests.scenes.perspective import photograph_board
from tests.scenes.without_board import draw_without_board

IMAGES = {
    "noise": lambda: draw_without_board(0),
    "clutter": lambda: draw_without_board(4),
    "rectangles": lambda: draw_without_board(5),
    "waves": lambda: draw_without_board(200),
    "halftone": lambda: draw_without_board(215),
    "board": lambda: photograph_board((640, 480), (6, 9), 36, 0.8),
    "board of many squares": lambda: photograph_board((640, 480), (21, 23), 17, 2.0),
}


@pytest.mark.skipif(not kernels.COMPILED, reason="numpy holds what kernels do not")
@pytest.mark.parametrize("kind", [np.uint8, np.uint16])
@pytest.mark.parametrize("name", IMAGES)
def test_at_most_six_times_the_image(name: str, kind: type) -> None:
    image: NDArray[Any] = IMAGES[name]().astype(kind)
    with contextlib.suppress(NoBoardError):
        find_corners(image)  # compiles
    tracemalloc.start()
    with contextlib.suppress(NoBoardError):
        find_corners(image)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most <= 6 * image.nbytes

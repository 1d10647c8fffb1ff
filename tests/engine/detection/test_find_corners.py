"""The registry of detectors."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from calibgui.engine.boards.kinds import KINDS
from calibgui.engine.detection.find_corners import DETECTORS, find_corners
from calibgui.engine.images.reading import read_image, write_image


def test_every_kind_of_board_has_a_detector() -> None:
    assert list(DETECTORS) == list(KINDS)


def test_colours_are_taken_whichever_comes_first(tmp_path: Path) -> None:
    squares = np.kron(np.indices((5, 6)).sum(axis=0) % 2, np.ones((20, 20)))
    grey = np.pad(40 + 160 * squares, 20, constant_values=200).astype(np.uint8)
    colour = np.stack([grey, grey // 2 + 60, grey], axis=-1)
    found = find_corners(colour)
    np.testing.assert_array_equal(found.uv, find_corners(colour[..., ::-1]).uv)
    np.testing.assert_allclose(found.uv, find_corners(grey).uv, atol=0.02)
    write_image(tmp_path / "board.png", grey)
    photograph = read_image(tmp_path / "board.png")
    np.testing.assert_array_equal(find_corners(photograph).uv, find_corners(grey).uv)
    with pytest.raises(ValueError, match="read_image reads a file"):
        find_corners(str(tmp_path / "board.png"))

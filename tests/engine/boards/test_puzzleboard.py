"""The PuzzleBoard pattern against dots read off the authors' and another program's prints."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.boards.pattern import Symmetry
from calibgui.engine.boards.printed_pattern import PrintedSquaresAndDots
from calibgui.engine.boards.puzzleboard import CODE_LINES, MAP_DOWN, MAP_RIGHT, PuzzleBoard
from calibgui.engine.errors import CalibrationError

# The authors' generator, first corner 0 x 0: dots right of the corners of the first five rows and
# columns, and below them; 1 is white.
_RIGHT = ["1101", "1001", "1111", "1111", "1001"]
_DOWN = ["00001", "01100", "01000", "00001"]


def _read(rows: list[str]) -> np.ndarray:
    return np.array([[digit == "1" for digit in row] for row in rows])


def test_the_dots_are_those_of_the_authors() -> None:
    right, down = PuzzleBoard().read_dots((5, 5))
    np.testing.assert_array_equal(right, _read(_RIGHT))
    np.testing.assert_array_equal(down, _read(_DOWN))


@pytest.mark.parametrize("code", [MAP_DOWN, MAP_RIGHT])
def test_every_window_of_3_x_3_bits_is_unique(code: np.ndarray) -> None:
    """What the paper proves of both maps, read around in rows and columns."""
    assert code.shape == (3, 167)
    windows = {
        np.roll(code, (-r, -c), (0, 1))[:, :3].tobytes() for r in range(3) for c in range(167)
    }
    assert len(windows) == CODE_LINES


def test_a_part_has_the_dots_of_the_whole() -> None:
    whole_right, whole_down = PuzzleBoard().read_dots((CODE_LINES, CODE_LINES))
    right, down = PuzzleBoard((170, 340)).read_dots((6, 9))
    np.testing.assert_array_equal(right, whole_right[170:176, 340:348])
    np.testing.assert_array_equal(down, whole_down[170:175, 340:349])


def test_what_is_printed() -> None:
    """A dark dot has ink on both sides of its edge, a white one on neither; squares alternate."""
    pattern = PuzzleBoard((1, 0))
    right, _ = pattern.read_dots((4, 5))
    ink = pattern.draw((4, 5))
    assert isinstance(ink, PrintedSquaresAndDots)
    beside = np.array(
        [[(c + 0.5, r - 0.1), (c + 0.5, r + 0.1)] for r in range(4) for c in range(4)]
    )
    share, _ = ink.compute_ink_share(beside, np.full((16, 2, 2, 2), 1e-6))
    np.testing.assert_allclose(share, np.repeat(1.0 - right.reshape(-1, 1), 2, axis=1))
    squares = np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5)])
    share, _ = ink.compute_ink_share(squares, np.full((3, 2, 2), 1e-6))
    np.testing.assert_allclose(share, [0, 1, 0])  # 1 + 0 is odd: the first is white
    assert pattern.symmetry((5, 5)) is Symmetry.NONE


def test_parts_outside_of_the_pattern() -> None:
    with pytest.raises(CalibrationError, match="no corner 501 x 0"):
        PuzzleBoard((501, 0))
    with pytest.raises(CalibrationError, match="leaves the pattern"):
        PuzzleBoard((0, 495)).draw((5, 8))

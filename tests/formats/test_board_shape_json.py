"""The file of a board's shape reads back, refuses others, and serves a later calibration."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from calibgui.engine.boards.shape import BoardShape, BoardShapeModel
from calibgui.engine.errors import CalibrationError
from calibgui.formats.board_shape_json import read_board_shape, write_board_shape

SHAPE = BoardShape(
    BoardShapeModel.FREE,
    [[0.0, 0.0], [30.0, 0.0], [0.0, 30.0]],
    [[0.1, -0.2, 1 / 3], [0.0, 0.0, 0.0], [0.0, 0.05, -0.1]],
    np.full((3, 3), 0.01),
)


def test_reads_back_to_the_last_bit(tmp_path: Path) -> None:
    write_board_shape(SHAPE, tmp_path / "plate.json")
    back = read_board_shape(tmp_path / "plate.json")
    assert back.model is BoardShapeModel.FREE
    for name in ("nominal", "deviation", "sigma"):
        np.testing.assert_array_equal(getattr(back, name), getattr(SHAPE, name))


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("{}", "is not a board shape"),
        ('{"format": "calibgui-plate", "version": 2}', "version 2"),
        (
            '{"format": "calibgui-plate", "version": 1, "model": "free", '
            '"nominal_mm": [[0, 0]], "deviation_mm": [[0, 0]], "sigma_mm": [[0, 0, 0]]}',
            "deviation_mm",
        ),
    ],
)
def test_what_is_no_plate_is_refused(tmp_path: Path, content: str, message: str) -> None:
    (tmp_path / "plate.json").write_text(content)
    with pytest.raises(CalibrationError, match=message):
        read_board_shape(tmp_path / "plate.json")

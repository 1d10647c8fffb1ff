"""The file of a board's shape reads back, refuses others, and serves a later calibration."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibgui.engine.boards.shape import ERROR_COEFFICIENTS, BoardShape, BoardShapeModel
from calibgui.engine.errors import CalibrationError
from calibgui.formats.board_shape_json import read_board_shape, write_board_shape

SHAPE = BoardShape(
    BoardShapeModel.FREE,
    [[0.0, 0.0], [30.0, 0.0], [0.0, 30.0]],
    [[0.1, -0.2, 1 / 3], [0.0, 0.0, 0.0], [0.0, 0.05, -0.1]],
    np.full((3, 3), 0.01),
    np.diag(np.linspace(1e-6, 1e-4, ERROR_COEFFICIENTS)) + 1e-6 / 3,
    ("0123456789abcdef", "fedcba9876543210"),
)


def test_reads_back_to_the_last_bit(tmp_path: Path) -> None:
    write_board_shape(SHAPE, tmp_path / "plate.json")
    back = read_board_shape(tmp_path / "plate.json")
    assert back.model is BoardShapeModel.FREE
    assert back.views == SHAPE.views
    for name in ("nominal", "deviation", "sigma", "covariance"):
        np.testing.assert_array_equal(getattr(back, name), getattr(SHAPE, name))


def test_a_file_of_an_earlier_version_reads_without_a_covariance(tmp_path: Path) -> None:
    write_board_shape(SHAPE, tmp_path / "plate.json")
    content = json.loads((tmp_path / "plate.json").read_text())
    del content["covariance_mm2"], content["views"]
    (tmp_path / "plate.json").write_text(json.dumps(content))
    back = read_board_shape(tmp_path / "plate.json")
    assert back.covariance is None and back.views == ()


def test_what_is_no_covariance_is_refused(tmp_path: Path) -> None:
    broken = replace(SHAPE, covariance=-np.eye(ERROR_COEFFICIENTS))
    write_board_shape(broken, tmp_path / "plate.json")
    with pytest.raises(CalibrationError, match="covariance_mm2 is not a covariance"):
        read_board_shape(tmp_path / "plate.json")


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

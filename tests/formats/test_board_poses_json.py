"""Poses of the board by the names of images."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from calibgui.engine.errors import CalibrationError
from calibgui.formats.board_poses_json import read_board_poses


def test_poses_are_read_by_name(tmp_path: Path) -> None:
    file = tmp_path / "poses.json"
    content = {"a.png": {"rvec": [0.1, 0, 0], "tvec": [1, 2, 3]}}
    file.write_text(json.dumps(content))
    poses = read_board_poses(file)
    assert list(poses) == ["a.png"]
    np.testing.assert_array_equal(poses["a.png"].rvec, [0.1, 0, 0])
    np.testing.assert_array_equal(poses["a.png"].tvec, [1, 2, 3])


@pytest.mark.parametrize(
    ("content", "place"),
    [
        ({"a.png": {"rvec": [0, 0, 0]}}, "tvec"),
        ({"a.png": {"rvec": [0, 0], "tvec": [0, 0, 0]}}, r"a\.png\.rvec"),
        ([1, 2], "poses.json"),
    ],
)
def test_what_is_wrong_is_named(content: object, place: str, tmp_path: Path) -> None:
    file = tmp_path / "poses.json"
    file.write_text(json.dumps(content))
    with pytest.raises(CalibrationError, match=place) as caught:
        read_board_poses(file)
    assert str(file) in caught.value.message

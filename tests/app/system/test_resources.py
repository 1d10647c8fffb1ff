"""The program's own files."""

from __future__ import annotations

from pathlib import Path

import pytest

from calibgui.app.system.resources import find_resource, find_sample_square
from calibgui.engine.errors import CalibrationError


def test_a_resource_is_found_in_this_checkout() -> None:
    assert find_resource("schema").is_dir()


def test_a_missing_resource_is_named() -> None:
    with pytest.raises(CalibrationError, match=r"nothing\.png"):
        find_resource("nothing.png")


def test_the_samples_squares_are_known_and_no_others(tmp_path: Path) -> None:
    images = sorted(find_resource("sample").glob("*.png"))
    assert find_sample_square(images) == 25.0
    assert find_sample_square([*images, tmp_path / "other.png"]) is None
    assert find_sample_square([]) is None

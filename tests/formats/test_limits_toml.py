"""Limits: which are read, and which are refused."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from calibgui.dataset.limits import NO_LIMITS, LengthLimit, Limits
from calibgui.engine.errors import CalibrationError
from calibgui.formats.limits_toml import decode_limits, encode_limits, read_limits
from calibgui.formats.node import Node


def test_limits_are_read(tmp_path: Path) -> None:
    file = tmp_path / "limits.toml"
    file.write_text("largest_edge_error_px = 0.5\nfewest_views = 8\n")
    assert read_limits(file) == Limits(largest_edge_error_px=0.5, fewest_views=8, name="limits")
    file.write_text("")
    assert read_limits(file) == replace(NO_LIMITS, name="limits")


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("largest_edge_px = 0.5", "no limit 'largest_edge_px'"),
        ("fewest_views = '8'", "fewest_views is not a finite number"),
        ("fewest_views = true", "fewest_views is not a finite number"),
        ("least_coverage = -0.1", "least_coverage is not a number from 0 on"),
        ("least_coverage = nan", "least_coverage is not a finite number"),
        (f"fewest_views = 1{'0' * 400}", "fewest_views is not a finite number"),
        (f"fewest_views = {'[' * 3000}{']' * 3000}", "nests too deeply"),
        (f"{'a.' * 3000}b = 1", "nests too deeply"),
        ("fewest_views: 8", "not a TOML file"),
        ("length_mm = 5", "lacks a part of it"),
        ("length_mm = 0\nlargest_length_sigma_mm = 1\ndistance_mm = 1", "is of no length"),
    ],
)
def test_other_limits_are_refused_by_name(tmp_path: Path, text: str, problem: str) -> None:
    file = tmp_path / "limits.toml"
    file.write_text(text)
    with pytest.raises(CalibrationError, match=problem) as caught:
        read_limits(file)
    assert "limits.toml" in caught.value.message
    assert caught.value.hint
    with pytest.raises(CalibrationError, match=r"none\.toml"):
        read_limits(tmp_path / "none.toml")


def test_limits_of_a_result_come_back(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text("largest_length_sigma_mm = 0.1\nlength_mm = 100\ndistance_mm = 500\n")
    limits = read_limits(file)
    assert limits == Limits(length=LengthLimit(0.1, 100.0, 500.0), name="mine")
    for each in (limits, Limits(0.5, 8, 0.6, 0.2, name="all")):
        assert decode_limits(Node(encode_limits(each), "limits", "result.json")) == each
    assert decode_limits(None) is None

"""Limits: which are read, which are refused, and the sentence on each that is broken."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from calibgui.app.fleet.limits import NO_LIMITS, Limits, list_failures, read_limits
from calibgui.dataset.fleet import Change
from calibgui.engine.assessment import Grade, PixelError
from calibgui.engine.errors import CalibrationError
from tests.formats.test_fleet_ledger import DONE, FIGURES, REFUSED

KEPT = Limits(0.2, 11, 0.75, 0.3)


def test_limits_are_read(tmp_path: Path) -> None:
    file = tmp_path / "limits.toml"
    file.write_text("largest_edge_error_px = 0.5\nfewest_views = 8\n")
    assert read_limits(file) == Limits(largest_edge_error_px=0.5, fewest_views=8)
    file.write_text("")
    assert read_limits(file) == NO_LIMITS


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


def test_a_camera_at_its_limits_passes() -> None:
    assert list_failures(DONE, KEPT) == ()


@pytest.mark.parametrize(
    ("limits", "words"),
    [
        (replace(KEPT, largest_edge_error_px=0.19), ("edge", "0.2 px", "0.19 px")),
        (replace(KEPT, fewest_views=12), ("11 views", "12")),
        (replace(KEPT, least_coverage=0.8), ("75 %", "80 %")),
        (replace(KEPT, largest_change_px=0.25), ("0.3 px", "line 2/0404", "0.25 px")),
    ],
)
def test_each_broken_limit_is_named_with_the_value(limits: Limits, words: tuple[str, ...]) -> None:
    (sentence,) = list_failures(DONE, limits)
    assert all(word in sentence for word in words)


def test_what_the_uncertainties_explain_is_no_change() -> None:
    unsure = replace(DONE, change=Change("b", "", 1.0, 9.0, 1.0, 0.5))
    assert list_failures(unsure, KEPT) == ()


def test_a_camera_that_is_no_use_fails_without_limits() -> None:
    assert list_failures(REFUSED) == (REFUSED.problem,)
    bad = replace(DONE, figures=replace(FIGURES, grade=Grade.NOT_USABLE, reason="Too few views."))
    assert list_failures(bad) == ("The calibration is not usable. Too few views.",)


@pytest.mark.parametrize("error", [float("nan"), float("inf")])
def test_what_one_view_does_not_tell_is_no_number(error: float) -> None:
    figures = replace(FIGURES, error=PixelError(*[error] * 6), views=1)
    assert list_failures(replace(DONE, figures=figures), KEPT) == (
        "The error of a pixel at the image's edge is not determined, against the limit of 0.2 px.",
        "1 view is used, fewer than the limit of 11.",
    )

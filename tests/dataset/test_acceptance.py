"""The sentence on each limit that is broken."""

from __future__ import annotations

from dataclasses import replace

import pytest

from calibgui.dataset import Result
from calibgui.dataset.acceptance import list_broken_limits, list_failures, measure_length
from calibgui.dataset.fleet import Change, summarise_result
from calibgui.dataset.limits import LengthLimit, Limits
from calibgui.engine.assessment import Grade, PixelError
from tests.formats.test_fleet_ledger import DONE, FIGURES, REFUSED

KEPT = Limits(0.2, 11, 0.75, 0.3)


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


def test_a_result_is_judged_by_the_same_limits(result: Result) -> None:
    edge, covered = summarise_result(result).error.edge, summarise_result(result).coverage
    kept = Limits(1.001 * edge, len(result.used), covered, length=LengthLimit(5.0, 50.0, 600.0))
    assert list_broken_limits(result, kept) == ()
    broken = Limits(
        0.9 * edge, len(result.used) + 1, min(covered + 0.1, 1.0), length=LengthLimit(1e-6, 50, 600)
    )
    sentences = list_broken_limits(result, broken)
    assert len(sentences) == 4
    length = measure_length(result, broken)
    assert length is not None
    assert f"{length.sigma[length.worst]:.3g} mm, beyond the limit of 1e-06 mm" in sentences[-1]
    assert "50 mm at 600 mm" in sentences[-1]
    nowhere = Limits(length=LengthLimit(1.0, 5000.0, 600.0))
    assert "not determined, against" in list_broken_limits(result, nowhere)[0]

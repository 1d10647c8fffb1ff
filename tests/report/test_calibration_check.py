"""The words of a check: verdict, advice and remarks follow from the numbers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.assessment import CalibrationCheck, CheckedView, CheckVerdict, Weakness
from calibgui.engine.boards import Board, Circles
from calibgui.report.calibration_check import describe_check, describe_verdict

GOOD = CalibrationCheck(
    limit=0.5,
    rms=0.21,
    sigma_x=0.15,
    sigma_y=0.14,
    count=108,
    noise=0.15,
    change=0.1,
    change_sigma=0.05,
    whole_change=0.4,
    shift=np.array([0.3, -0.2]),
    shift_sigma=np.array([0.4, 0.4]),
    scale=1e-4,
    scale_sigma=2e-4,
    bend=0.02,
    bend_sigma=0.03,
    weakness=Weakness.SCALE,
    has_covariance=True,
    views=(CheckedView(0.21, 108, 2), CheckedView(np.nan, 0, 110, "too many do not fit")),
)
NAMES = ["a.png", "b.png"]


def words(check: CalibrationCheck) -> str:
    return " ".join(describe_check(check, NAMES).split())


@pytest.mark.parametrize(
    ("change", "sigma", "verdict"),
    [
        (0.1, 0.19, CheckVerdict.STILL_GOOD),
        (0.1, 0.21, CheckVerdict.CANNOT_TELL),
        (0.6, 0.06, CheckVerdict.CANNOT_TELL),
        (0.6, 0.04, CheckVerdict.HAS_CHANGED),
        (8.0, 4.0, CheckVerdict.CANNOT_TELL),
    ],
)
def test_verdict(change: float, sigma: float, verdict: CheckVerdict) -> None:
    check = replace(GOOD, change=change, change_sigma=sigma)
    assert check.verdict is verdict
    said = {
        CheckVerdict.STILL_GOOD: "is still good",
        CheckVerdict.CANNOT_TELL: "cannot tell",
        CheckVerdict.HAS_CHANGED: "has changed: by",
    }
    assert said[verdict] in describe_verdict(check)
    assert f"{change:.3f} ± {sigma:.3f} px" in describe_verdict(check)


@pytest.mark.parametrize(
    ("weakness", "advice"),
    [
        (Weakness.SCALE, "tilted by 30 to 45 degrees"),
        (Weakness.SHIFT, "turned by 90 degrees"),
        (Weakness.DISTORTION, "into the corners of the image"),
    ],
)
def test_what_further_pictures_should_show(weakness: Weakness, advice: str) -> None:
    assert advice in words(replace(GOOD, change_sigma=1.0, weakness=weakness))


def test_a_good_check_has_no_remarks_but_on_views_left_out() -> None:
    text = describe_check(GOOD, NAMES)
    assert max(map(len, text.splitlines())) <= 80
    assert text.count("\n- ") == 2
    assert "b.png is left out: too many do not fit." in text


def test_circles_are_called_circles() -> None:
    text = describe_check(GOOD, NAMES, Board(4, 5, 20.0, Circles()))
    assert "picture  circles" in text and "px rms at the circles" in text
    assert "corner" not in text


def test_remarks() -> None:
    assert "moved by (3.00 ± 0.40, -0.20 ± 0.40) px" in words(
        replace(GOOD, shift=np.array([3.0, -0.2]))
    )
    assert "The board is bent or twisted, by 0.200 ± 0.030 mm" in words(replace(GOOD, bend=0.2))
    assert "Is this the right file" in words(replace(GOOD, noise=3.0))
    assert "states no standard deviations" in words(replace(GOOD, has_covariance=False))


def test_all_pictures_have_their_corners_and_those_left_out_counted() -> None:
    assert "all 108 112 0.210" in words(GOOD)
    assert "noise beside change, board and poses, px along each axis 0.150" in words(GOOD)

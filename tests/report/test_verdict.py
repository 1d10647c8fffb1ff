"""The verdict in words."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from calibgui.dataset import Result
from calibgui.engine.assessment import Action, ActionKind, Grade, PixelError, Verdict
from calibgui.engine.calibration import CalibrationSettings, Cost
from calibgui.report.verdict import describe_options, describe_reason


@pytest.mark.parametrize(
    ("action", "words"),
    [
        (
            Action(ActionKind.ESTIMATE_BOARD_SHAPE, model="free"),
            "add --board-shape free --cost image --method lucchese",
        ),
        (Action(ActionKind.LEAVE_OUT_VIEWS, views=(0, 1)), "add --exclude 'a b.png' c.png"),
        (Action(ActionKind.FREE_HELD_VALUE, parameters=("fx", "k1")), "leave fx,k1 out of --fix"),
        (
            Action(ActionKind.ESTIMATE_SKEW, parameters=("skew",), model="brown-conrady"),
            "add --model brown-conrady --free skew --cost image --method lucchese",
        ),
        (Action(ActionKind.PHOTOGRAPH_MORE), ""),
    ],
)
def test_a_remedy_is_told_as_a_change_of_the_command(action: Action, words: str) -> None:
    result = SimpleNamespace(
        used=[SimpleNamespace(name="a b.png"), SimpleNamespace(name="c.png")],
        calibration=SimpleNamespace(
            cost=Cost.PAPER, settings=CalibrationSettings(method="bouguet")
        ),
    )
    assert describe_options(action, cast(Result, result)) == words


@pytest.mark.parametrize(("blur", "named"), [(3.0, True), (1.3, False)])
def test_a_blurred_photograph_that_does_no_harm_is_named(blur: float, named: bool) -> None:
    """The other photographs have a blur of 0.6 px."""
    views = [
        SimpleNamespace(name=name, corners=SimpleNamespace(blur=np.full(54, px)))
        for name, px in (("a.png", 0.6), ("b.png", blur), ("c.png", 0.6))
    ]
    result = cast(Result, SimpleNamespace(used=views))
    reason = "The photographs show nothing wrong."
    verdict = Verdict(Grade.GOOD, reason, PixelError(*[0.1] * 6), 1.0, 500.0)
    words = " b.png is blurred, which does no harm here." if named else ""
    assert describe_reason(verdict, result) == reason + words
    unusable = replace(verdict, grade=Grade.NOT_USABLE)
    assert describe_reason(unusable, result) == reason


@pytest.mark.parametrize(
    ("names", "chosen", "words"),
    [
        ([*"abcd", *(f"right [{k}].png" for k in range(5))], 5, "'right [[]*].png'"),
        (["right0.png", *(f"right{k}.png" for k in range(5))], 5, "right0.png right1.png"),
        (["left.png", *(f"right{k}.png" for k in range(3))], 3, "right0.png right1.png"),
    ],
)
def test_many_images_are_named_by_a_pattern_that_fits_no_other(
    names: list[str], chosen: int, words: str
) -> None:
    result = SimpleNamespace(
        used=[SimpleNamespace(name=name) for name in names],
        calibration=SimpleNamespace(cost=Cost.IMAGE, settings=CalibrationSettings()),
    )
    views = tuple(range(len(names) - chosen, len(names)))
    action = Action(ActionKind.LEAVE_OUT_VIEWS, views=views)
    assert describe_options(action, cast(Result, result)).startswith(f"add --exclude {words}")

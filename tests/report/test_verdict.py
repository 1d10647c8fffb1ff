"""The verdict in words."""

from __future__ import annotations

from types import SimpleNamespace
from typing import cast

import pytest

from calibgui.dataset import Result
from calibgui.engine.assessment import Action, ActionKind
from calibgui.engine.calibration import Cost
from calibgui.report.verdict import describe_options


@pytest.mark.parametrize(
    ("action", "words"),
    [
        (
            Action(ActionKind.ESTIMATE_BOARD_SHAPE, model="free"),
            "add --board-shape free --cost image --method lucchese",
        ),
        (Action(ActionKind.LEAVE_OUT_VIEWS, views=(0, 1)), "add --exclude 'a b.png' c.png"),
        (Action(ActionKind.FREE_HELD_VALUE, parameters=("fx", "k1")), "leave fx,k1 out of --fix"),
        (Action(ActionKind.PHOTOGRAPH_MORE), ""),
    ],
)
def test_a_remedy_is_told_as_a_change_of_the_command(action: Action, words: str) -> None:
    result = SimpleNamespace(
        used=[SimpleNamespace(name="a b.png"), SimpleNamespace(name="c.png")],
        calibration=SimpleNamespace(cost=Cost.PAPER, settings={"method": "bouguet"}),
    )
    assert describe_options(action, cast(Result, result)) == words

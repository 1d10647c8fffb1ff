"""A failed calibration lists the photographs that it could not use."""

from __future__ import annotations

import pytest

from calibgui.cli.console import Console
from calibgui.cli.notices import explain_solve
from calibgui.dataset import CornerSet, View, ViewStatus
from calibgui.engine.errors import CalibrationError

BLANK = View("blank.png", ViewStatus.NO_BOARD, "No checkerboard was found.")


def test_a_failure_lists_the_views_that_could_not_be_used(
    capsys: pytest.CaptureFixture[str],
) -> None:
    corner_set = CornerSet((640, 480), (BLANK,))
    with explain_solve(Console(), corner_set):
        pass
    assert capsys.readouterr() == ("", "")
    with (
        pytest.raises(CalibrationError, match="There is no view"),
        explain_solve(Console(), corner_set),
    ):
        raise CalibrationError("There is no view.", "Take one.")
    printed, problems = capsys.readouterr()
    assert printed == ""
    assert "blank.png" in problems and BLANK.reason in problems

"""The corners that a subcommand works on, and what is said of them."""

from __future__ import annotations

import argparse

import pytest

from calibgui.cli import corners
from calibgui.cli.console import Console
from calibgui.cli.corners import read_or_search
from calibgui.dataset import CornerSet
from calibgui.report.tables import WIDTH_CHARACTERS


def test_what_is_recognised_is_told_in_lines_that_fit(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    remark = f"The photographs show: {'ChArUco board, ' * 10}DICT_4X4_50."
    found = CornerSet((640, 480), (), None), [remark]
    monkeypatch.setattr(corners, "search_board", lambda *_: found)
    options = argparse.Namespace(paths=["photographs"], square=20.0, exclude=())
    assert read_or_search(options, Console()) is found[0]
    printed = capsys.readouterr().out
    assert " ".join(printed.split()) == remark
    assert max(map(len, printed.splitlines())) <= WIDTH_CHARACTERS

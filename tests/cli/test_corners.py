"""The corners that a subcommand works on, and what is said of them."""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path

import pytest

from calibgui.cli import corners
from calibgui.cli.console import Console
from calibgui.cli.corners import read_or_search
from calibgui.cli.main import main
from calibgui.dataset import CornerSet, View, ViewStatus
from calibgui.formats.corners_json import read_corners, write_corners
from calibgui.report.tables import WIDTH_CHARACTERS

_CORNERS = Path(__file__).parents[1] / "golden" / "corners.json"


@pytest.mark.parametrize("name", ["corners.vnl", "corners.csv"])
def test_corners_of_other_programs_are_taken_for_photographs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    own = read_corners(_CORNERS)
    assert own.board is not None
    corners = [
        (view.image, replace(view.corners, cov=None))
        for view in own.views
        if view.corners is not None and view.corners.complete
    ]
    views = tuple(View(image, ViewStatus.FOUND, corners=each) for image, each in corners)
    write_corners(replace(own, views=views), tmp_path / "own.json")
    rows = [
        (image, *uv, *place)
        for image, each in corners
        for uv, place in zip(each.uv.tolist(), each.grid.tolist(), strict=True)
    ]
    if name.endswith(".vnl"):
        lines = ["# filename x y", *(f"{image} {u!r} {v!r}" for image, u, v, *_ in rows)]
    else:
        lines = ["image,u,v,row,col", *(",".join(map(str, row)) for row in rows)]
    (tmp_path / name).write_text("\n".join(lines) + "\n")
    rows_and_columns, size = ("x".join(map(str, pair)) for pair in (own.board.grid_size, own.size))
    stated = ["--board", rows_and_columns, "--size", size, "--square", str(own.board.square)]
    figures = []
    for arguments in ([str(tmp_path / "own.json")], [str(tmp_path / name), *stated]):
        assert main(["calibrate", "--json", *arguments, "--as-asked", "--model", "pinhole"]) == 0
        figures.append(json.loads(capsys.readouterr().out)["camera"]["params"])
    assert figures[0] == figures[1]


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

"""rig.json: a rig comes back as it was written, and what is wrong in a file is named."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from calibgui.engine.errors import CalibrationError
from calibgui.engine.rig import LeftOutView, Mistake, RigMistake
from calibgui.formats.rig_json import read_rig, write_rig
from tests.formats.rigs import make_result, make_result_of_boards


def test_a_rig_comes_back(tmp_path: Path) -> None:
    result = make_result()
    rig = replace(
        result.rig,
        left_out=(LeftOutView(1, result.rig.instants[2], 7.5),),
        mistakes=(RigMistake(Mistake.MOVED, 1, 0, result.rig.instants[3:], 2.5),),
    )
    result = replace(result, rig=rig)
    write_rig(result, tmp_path / "rig.json")
    read = read_rig(tmp_path / "rig.json")
    write_rig(read, tmp_path / "again.json")
    assert (tmp_path / "again.json").read_text() == (tmp_path / "rig.json").read_text()
    np.testing.assert_array_equal(read.rig.covariance, rig.covariance)
    for ours, theirs in zip(rig.cameras, read.rig.cameras, strict=True):
        np.testing.assert_array_equal(ours.params, theirs.params)
    assert read.rig.left_out == rig.left_out and read.rig.mistakes == rig.mistakes
    assert read.boards == result.boards


def test_boards_come_back(tmp_path: Path) -> None:
    result = make_result_of_boards()
    write_rig(result, tmp_path / "rig.json")
    read = read_rig(tmp_path / "rig.json")
    write_rig(read, tmp_path / "again.json")
    assert (tmp_path / "again.json").read_text() == (tmp_path / "rig.json").read_text()
    ours, theirs = result.rig.placed_boards[1], read.rig.placed_boards[1]
    np.testing.assert_array_equal(ours.pose.tvec, theirs.pose.tvec)
    np.testing.assert_array_equal(result.rig.board_sigma(1), read.rig.board_sigma(1))
    assert ours.shape is not None and theirs.shape is not None
    np.testing.assert_array_equal(ours.shape.deviation, theirs.shape.deviation)
    assert {view.board for view in read.rig.views} == {0, 1}
    assert read.boards == result.boards


def test_a_file_of_a_version_with_one_board_is_read(tmp_path: Path) -> None:
    file = tmp_path / "rig.json"
    write_rig(make_result(), file)
    content = json.loads(file.read_text())
    del content["boards"]
    for view in content["views"]:
        del view["board"]
    file.write_text(json.dumps(content))
    read = read_rig(file)
    assert len(read.rig.placed_boards) == 1
    assert read.boards == make_result().boards
    assert {view.board for view in read.rig.views} == {0}


@pytest.mark.parametrize(
    ("change", "place"),
    [
        (lambda c: c["cameras"].pop(), r"views\[\d+\]\.camera"),
        (lambda c: c["cameras"][1].pop("rvec"), r"cameras\[1\]\.rvec is missing"),
        (lambda c: c["cameras"][0]["params"].update(fx=-1), r"cameras\[0\]\.params\.fx"),
        (lambda c: c["views"][3].update(camera=9), r"views\[3\]\.camera"),
        (lambda c: c["views"][3].update(instant=999), r"views\[3\]\.instant"),
        (lambda c: c["views"][3].update(board=1), r"views\[3\]\.board is not .* a board"),
        (lambda c: c["boards"][0].update(reference=1), r"boards\[0\]\.reference"),
        (lambda c: c["boards"].append(c["boards"][0]), "covariance"),
        (lambda c: c["boards"].clear(), "at least one board"),
        (lambda c: c["covariance"][0].__setitem__(0, -1.0), "covariance"),
        (lambda c: c.update(format="calibgui-result"), "is not a rig|a rig"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, change: Any, place: str) -> None:
    file = tmp_path / "rig.json"
    write_rig(make_result(), file)
    content = json.loads(file.read_text())
    change(content)
    file.write_text(json.dumps(content))
    with pytest.raises(CalibrationError, match=place):
        read_rig(file)

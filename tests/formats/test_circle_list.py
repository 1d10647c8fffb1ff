"""Lists of circles: tables and JSON, and what is wrong with them by name."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from calibgui.engine.boards import Board
from calibgui.engine.errors import CalibrationError
from calibgui.formats.circle_list import read_circle_list
from calibgui.formats.node import Node
from calibgui.formats.pattern_json import decode_board, encode_board

PLACES = [(0.0, 0.0), (20.0, 0.0), (10.0, 17.0), (30.0, 17.0)]


@pytest.mark.parametrize("head", ["x,y", "x_mm,y_mm", "X,Y", "name,x,y"])
def test_a_table_and_json_say_the_same(head: str, tmp_path: Path) -> None:
    first = "a," if head.startswith("name") else ""
    lines = [head, *(f"{first}{x},{y}" for x, y in PLACES)]
    (tmp_path / "board.csv").write_text("\n".join(lines))
    (tmp_path / "board.json").write_text(json.dumps({"circles_mm": PLACES, "diameter_mm": 9}))
    pattern, pitch = read_circle_list(tmp_path / "board.csv")
    other, same = read_circle_list(tmp_path / "board.json")
    assert pitch == same == pytest.approx(np.hypot(10, 17))
    assert pattern.places == other.places
    assert pattern.diameter is None and other.diameter == pytest.approx(9 / pitch)
    board = Board(*other.grid_size, pitch, other)
    assert decode_board(Node(json.loads(json.dumps(encode_board(board))), "", "a.json")) == board


@pytest.mark.parametrize(
    ("name", "text", "says"),
    [
        ("a.csv", "u,v\n1,2\n", "no columns x and y"),
        ("a.csv", "x,y\n1,2\n3,b\n", "a.csv, line 3"),
        ("a.csv", "x,y\n1,2\n1,2\n", "one place"),
        ("a.json", '{"circles_mm": [[1, 2], [3]]}', "circles_mm"),
        ("a.json", "{}", "circles_mm"),
    ],
)
def test_what_is_wrong_is_named(name: str, text: str, says: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(CalibrationError, match=says):
        read_circle_list(tmp_path / name)

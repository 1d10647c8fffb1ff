"""Targets of every pattern read back as they were written, and nothing else is taken for one."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from calibgui.engine.boards.april_grid import AprilGrid
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.boards.kinds import KINDS
from calibgui.engine.boards.pattern import Pattern
from calibgui.engine.boards.puzzleboard import PuzzleBoard
from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard
from calibgui.engine.errors import CalibrationError
from calibgui.formats.json_document import dumps, read_json
from calibgui.formats.pattern_json import decode_board, encode_board, encode_pattern

PATTERNS = [
    *KINDS.values(),
    Charuco("DICT_6X6_250", 0.7, True),
    Charuco(legacy=False),
    Circles(True, 0.8),
    Circles(False, 0.25),
    PuzzleBoard((50, 100)),
    AprilGrid("t25h9", 0.25, 1, True),
    AprilGrid("t36h11", 0.3, 2, False, False),
    TaggedCheckerboard("t25h7", 2, 4, False),
]


@pytest.mark.parametrize("pattern", PATTERNS)
def test_read_back(tmp_path: Path, pattern: Pattern) -> None:
    board = Board(6, 9, 12.5, pattern)
    (tmp_path / "t.json").write_text(dumps(encode_board(board)))
    assert decode_board(read_json(tmp_path / "t.json")) == board


@pytest.mark.parametrize(
    "wrong",
    [
        {"kind": "dots"},
        {"kind": "charuco", "dictionary": "DICT_3X3_50"},
        {"kind": "charuco", "marker": "big"},
        {"kind": "charuco", "marker": 1.2},
        {"kind": "circles", "diameter": 0},
        {"kind": "puzzleboard", "origin": [501, 0]},
        {"kind": "aprilgrid", "family": "t30h3"},
        {"kind": "aprilgrid", "border": 1.5},
        {"kind": "tagged-checkerboard", "step": 3},
        {"kind": "puzzleboard", "origin": [1.5, 0]},
        {},
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, wrong: dict[str, Any]) -> None:
    record = encode_board(Board(6, 9, 12.5)) | {"pattern": wrong}
    (tmp_path / "t.json").write_text(json.dumps(record))
    with pytest.raises(CalibrationError, match=r"t\.json"):
        decode_board(read_json(tmp_path / "t.json"))


def test_a_checkerboard_needs_no_pattern() -> None:
    assert "pattern" not in encode_board(Board(6, 9, 12.5))
    assert encode_pattern(KINDS["circles"]) == {"kind": "circles"}

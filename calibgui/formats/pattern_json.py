"""A board and its pattern as JSON objects, the same in every file that holds them.

rows, cols      of inner corners, or of circles
square_mm       side of a square or tag, distance of circles (of rows of an asymmetric grid)
pattern         left out for a checkerboard; else its `kind` and its known properties:
  charuco             dictionary (OpenCV's name), marker (over the square), legacy (layout),
                      first_marker (its number)
  circles             diameter (over the distance)
  asymmetric-circles  diameter (over the distance of the rows)
  listed-circles      places of the circles (X, Y, over their least distance), diameter (likewise)
  aprilgrid           family and border (cells) of the tags, spacing (gap over a tag's side),
                      from_top (the order of the tags), corner_squares (whether small dark
                      squares stand between their corners), first_tag (its number),
                      tag_turn (quarters by which each tag is turned clockwise)
  tagged-checkerboard family, border, from_top, step (squares from one tag to the next)
  puzzleboard         origin (row and column of its first corner on the whole pattern)
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from typing import Any

from calibgui.engine.arrays import GridSize
from calibgui.engine.boards import CHECKERBOARD, KINDS, Board, Pattern
from calibgui.engine.errors import CalibrationError
from calibgui.formats.node import MAX_LINES, Node


def encode_pattern(pattern: Pattern) -> dict[str, Any]:
    """Return the JSON object of a pattern."""
    usual: Any = KINDS[pattern.kind]
    known = {field.name: getattr(pattern, field.name) for field in fields(usual)}
    return {"kind": pattern.kind} | {
        name: value for name, value in known.items() if value != getattr(usual, name)
    }


def decode_pattern(node: Node | None) -> Pattern:
    """Return the pattern of a JSON object; a checkerboard if there is none."""
    if node is None:
        return CHECKERBOARD
    usual: Any = KINDS[node["kind"].choice(list(KINDS))]
    known = {}
    for field in fields(usual):
        if (value := node.get(field.name)) is not None:
            known[field.name] = _FIELD_READERS[field.name](value)
    try:
        pattern: Pattern = replace(usual, **known)
    except CalibrationError as error:
        node.fail(str(error))
    return pattern


def _read_places(node: Node) -> tuple[tuple[float, float], ...]:
    return tuple((x, y) for x, y in node.numbers(None, 2).tolist())


def _read_grid_index(node: Node) -> GridSize:
    row, col = node.integers(2).tolist()
    return row, col


_FIELD_READERS: Mapping[str, Callable[[Node], Any]] = {
    "places": _read_places,
    "dictionary": Node.text,
    "marker": Node.number,
    "legacy": Node.flag,
    "first_marker": Node.integer,
    "diameter": Node.number,
    "asymmetric": Node.flag,
    "family": Node.text,
    "spacing": Node.number,
    "border": Node.integer,
    "step": Node.integer,
    "from_top": Node.flag,
    "corner_squares": Node.flag,
    "first_tag": Node.integer,
    "tag_turn": Node.integer,
    "origin": _read_grid_index,
}
"""Functions that read a pattern's field, by its name."""


def encode_board(board: Board) -> dict[str, Any]:
    """Return the JSON object of a board."""
    record: dict[str, Any] = {"rows": board.rows, "cols": board.cols, "square_mm": board.square}
    if board.square_sigma:
        record["square_sigma_mm"] = board.square_sigma
    if board.pattern == CHECKERBOARD:
        return record
    return record | {"pattern": encode_pattern(board.pattern)}


def decode_board(node: Node | None) -> Board | None:
    """Return the board of a JSON object; None if there is none."""
    if node is None:
        return None
    rows, cols, square = node["rows"], node["cols"], node["square_mm"]
    if not square.number() > 0:
        square.fail("a length above 0")
    for side in (rows, cols):
        if not 2 <= side.integer() <= MAX_LINES:
            side.fail(f"a number of corners from 2 to {MAX_LINES}")
    pattern, sigma = decode_pattern(node.get("pattern")), decode_square_sigma(node)
    return Board(rows.integer(), cols.integer(), square.number(), pattern, sigma)


def decode_square_sigma(node: Node) -> float:
    """Return the standard deviation of the side of a board's squares, mm; 0 if not stated."""
    if (sigma := node.get("square_sigma_mm")) is None:
        return 0.0
    if not 0 <= sigma.number() < node["square_mm"].number():
        sigma.fail("a length from 0 on, below the side of a square")
    return sigma.number()

"""Every room of the engine keeps to its budget of tuned numbers.

A tuned number decides: a threshold, a share, a count. Each must be explained, tested and weighed
against all others, so that a new one takes an old one's place. If a room needs fewer, its budget
goes down with it.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ENGINE = Path(__file__).resolve().parents[1] / "calibgui" / "engine"
BUDGETS = {
    "assessment": 119,
    "boards": 12,
    "calibration": 181,
    "camera": 26,
    "capture": 14,
    "corner_fit": 110,
    "detection": 261,
    "features": 42,
    "geometry": 3,
    "hand_eye": 14,
    "images": 27,
    "kernels": 40,
    "lattices": 82,
    "redetection": 16,
    "rig": 17,
    "uncertainty": 9,
}
RECORDS = re.compile("Threshold|Limit|Tolerance")
"""What the classes are called whose fields are tuned numbers."""


def list_tuned_numbers(source: str) -> list[str]:
    """List the names of the constants of a module, and of its records' fields, that are numbers."""
    tree = ast.parse(source)
    records = [
        node for node in tree.body if isinstance(node, ast.ClassDef) and RECORDS.search(node.name)
    ]
    fields = [target for record in records for target in _list_assigned(record.body)]
    constants = [name for name in _list_assigned(tree.body) if name.strip("_").isupper()]
    return constants + fields


def _list_assigned(body: list[ast.stmt]) -> Iterator[str]:
    """List the names that statements give numbers to."""
    for statement in body:
        match statement:
            case ast.Assign(targets=[target], value=value):
                pairs = _pair(target, value)
            case ast.AnnAssign(target=target, value=ast.expr() as value):
                pairs = _pair(target, value)
            case _:
                continue
        yield from (name for name, number in pairs if _is_number(number))


def _pair(target: ast.expr, value: ast.expr) -> list[tuple[str, ast.expr]]:
    match target, value:
        case ast.Name(id=name), _:
            return [(name, value)]
        case ast.Tuple(elts=names), ast.Tuple(elts=values):
            return [pair for each in zip(names, values, strict=False) for pair in _pair(*each)]
    return []


def _is_number(value: ast.expr) -> bool:
    """Return whether an expression computes a number from numbers alone."""
    numbers = [node.value for node in ast.walk(value) if isinstance(node, ast.Constant)]
    if not numbers or not all(type(number) in (int, float) for number in numbers):
        return False
    called = {
        node.attr if isinstance(node, ast.Attribute) else node.id
        for call in ast.walk(value)
        if isinstance(call, ast.Call)
        for node in [call.func]
        if isinstance(node, ast.Attribute | ast.Name)
    }
    known = {"float", "radians", "sqrt", "deg2rad", "sin", "cos"}
    arithmetic = (ast.Constant, ast.BinOp, ast.UnaryOp, ast.Call)
    return called <= known and isinstance(value, arithmetic)


@pytest.mark.parametrize("room", BUDGETS)
def test_a_room_has_no_more_tuned_numbers_than_its_budget(room: str) -> None:
    numbers = {
        f"{file.relative_to(ENGINE)}: {name}"
        for file in sorted((ENGINE / room).rglob("*.py"))
        for name in list_tuned_numbers(file.read_text(encoding="utf-8"))
    }
    assert len(numbers) == BUDGETS[room], "a new number takes an old one's place"


def test_every_room_has_a_budget() -> None:
    rooms = {file.parent.name for file in ENGINE.glob("*/__init__.py")}
    assert rooms == BUDGETS.keys()


def test_what_counts_as_a_tuned_number() -> None:
    source = """
_MAX_ANGLE = float(np.radians(12.0))
_LEAST, MOST = 0.2, 1 / 3
NAME = "a"
_TABLE = np.array([1.0, 2.0])
lower = 3
class EdgeLimits:
    share: float = 0.5
    names: tuple[str, ...] = ()
class Record:
    share: float = 0.5
"""
    assert list_tuned_numbers(source) == ["_MAX_ANGLE", "_LEAST", "MOST", "share"]

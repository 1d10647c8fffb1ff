"""Damage to the content of a JSON file, drawn by hypothesis."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

_WRONG = st.sampled_from(
    [None, True, -1, 0, 1.5, 10**400, "", "x", [], [1], [[1, 2]], {}, {"a": 1}]
)


def mutated(content: Any, data: st.DataObject) -> Any:
    """`content` with one entry, at any depth, removed or replaced by something else."""
    holder, key = content, data.draw(st.sampled_from(_keys(content)))
    while _keys(holder[key]) and data.draw(st.integers(0, 3)):
        holder, key = holder[key], data.draw(st.sampled_from(_keys(holder[key])))
    if data.draw(st.booleans()):
        del holder[key]
    else:
        holder[key] = data.draw(_WRONG)
    return content


def _keys(value: Any) -> list[Any]:
    if isinstance(value, dict):
        return list(value)
    return list(range(len(value))) if isinstance(value, list) else []

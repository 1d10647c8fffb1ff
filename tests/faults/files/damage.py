"""Damage to files: by accident, by another program, or made to do harm.

Each kind is a function from a sound content and a generator of random numbers to a damaged one. It
looks for values in the text as JSON, YAML, TOML, XML, CSV and scripts write them, so that one kind
serves all languages; on photographs most of them are flips and insertions of bytes.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

Damage = Callable[[bytes, np.random.Generator], bytes]

_VALUE = re.compile(rb"""(?<=[\s:=,\[(>])(-?\d[\d.eE+-]*|"[^"\n]*"|true|false|null)""")
"""A number, text or word where a value may stand."""
_PLACES = (b"[", b"]", b"{", b"}", b"<", b">", b"'", b'"', b":", b",", b";", b"&", b"*", b"\n", b"")
_NOT_FINITE = (b"NaN", b"nan", b".nan", b"Infinity", b"-Infinity", b".inf", b"1e999", b"null")
_HUGE = (b"1" + b"0" * 400, b"9" * 5000, b"1e308", b"-1e308", b"1e-320", b"2147483648", b"1e18")
_TYPES = (b'"x"', b'"1"', b"true", b"null", b"[]", b"{}", b"[1]", b"[[1, 2]]", b'{"a": 1}', b"1_0")
_TYPES += (b"640.5", b"-1", b"0", b"\xc3\xa9", b"!!bool x", b"0x1F", b"1:30", b"2026-13-45")
_BRACKETS = ((b"[", b"]"), (b'{"a":', b"}"), (b"<a>", b"</a>"), (b"(", b")"))
_FILLS = (b"0", b" ", b".", b"[],", b"1,", b"-", b"\n", b'"a":1,', b"<a/>", b"%", b"'")
_DEPTHS = (51, 1000, 3000, 100_000)


def _cut(content: bytes, rng: np.random.Generator) -> bytes:
    return content[: int(rng.integers(len(content)))]


def _flip(content: bytes, rng: np.random.Generator) -> bytes:
    changed = bytearray(content)
    for place in rng.integers(len(content), size=rng.integers(1, 9)).tolist():
        changed[place] ^= 1 << int(rng.integers(8))
    return bytes(changed)


def _splice(content: bytes, rng: np.random.Generator) -> bytes:
    """Put a piece of the file, or a mark of its language, in another place."""
    start, end, place = rng.integers(len(content), size=3).tolist()
    piece = content[start : start + end % 40] if rng.random() < 0.5 else _choose(_PLACES, rng)
    gap = int(rng.integers(12))
    return content[:place] + piece + content[place + gap :]


def _put_not_finite(content: bytes, rng: np.random.Generator) -> bytes:
    return _replace_value(content, _choose(_NOT_FINITE, rng), rng)


def _put_huge(content: bytes, rng: np.random.Generator) -> bytes:
    return _replace_value(content, _choose(_HUGE, rng), rng)


def _put_other_type(content: bytes, rng: np.random.Generator) -> bytes:
    if isinstance(document := _parse(content), dict | list) and document and rng.random() < 0.5:
        holder, key = _choose_entry(document, rng)
        holder[key] = json.loads(_choose([t for t in _TYPES if t[:1] in b'"tn[{'], rng))
        return json.dumps(document).encode()
    return _replace_value(content, _choose(_TYPES, rng), rng)


def _nest(content: bytes, rng: np.random.Generator) -> bytes:
    depth = int(_choose(_DEPTHS, rng))
    opening, closing = _choose(_BRACKETS, rng)
    return _replace_value(content, opening * depth + b"1" + closing * depth, rng)


def _double_aliases(content: bytes, rng: np.random.Generator) -> bytes:
    """Define names of YAML each of which stands for ten of the one before, and use the last."""
    lines = [b"a0: &a0 [x, x, x, x, x, x, x, x, x, x]"]
    lines += [
        b"a%d: &a%d [%s]" % (k, k, b", ".join([b"*a%d" % (k - 1)] * 10)) for k in range(1, 12)
    ]
    head, found, body = content.partition(b"---\n")
    if not found:
        head, body = b"", content
    places = [match.span(1) for match in re.finditer(rb":[ \t]*([\w.-]+)(?=\n)", body)]
    start, end = _choose(places, rng) if places and rng.random() < 0.8 else (len(body), len(body))
    value = b"*a11" if end > start else b"\nmodel: *a11\n"
    body = body[:start] + value + body[end:]
    return head + found + b"\n".join(lines) + b"\n" + body


def _double_entities(content: bytes, rng: np.random.Generator) -> bytes:
    """Define entities of XML each of which stands for ten of the one before."""
    entities = b'<!ENTITY a0 "xxxxxxxxxx">'
    for k in range(1, 12):
        entities += b'<!ENTITY a%d "%s">' % (k, b"&a%d;" % (k - 1) * 10)
    head = b'<?xml version="1.0"?>\n' if rng.random() < 0.5 else b""
    body = re.sub(rb"<\?xml.*\?>\s*", b"", content)
    return head + b"<!DOCTYPE r [%s]>\n" % entities + _replace_value(body, b"&a11;", rng)


def _fill(content: bytes, rng: np.random.Generator) -> bytes:
    """Put a million of something where a value stands."""
    piece = _choose(_FILLS, rng)
    return _replace_value(content, piece * (1_000_000 // len(piece)), rng)


def _drop_entry(content: bytes, rng: np.random.Generator) -> bytes:
    """Leave out an entry of an object, or a line."""
    if isinstance(document := _parse(content), dict | list) and document:
        holder, key = _choose_entry(document, rng)
        del holder[key]
        return json.dumps(document).encode()
    lines = content.splitlines(keepends=True)
    del lines[int(rng.integers(len(lines)))]
    return b"".join(lines)


def _repeat_entry(content: bytes, rng: np.random.Generator) -> bytes:
    """Repeat a line, or the first entry of an object with another value."""
    if rng.random() < 0.5 and (found := re.search(rb'"\w+"[ ]*:', content)):
        return content[: found.start()] + found[0] + b" 1, " + content[found.start() :]
    lines = content.splitlines(keepends=True)
    k = int(rng.integers(len(lines)))
    return b"".join([*lines[: k + 1], *lines[k:]])


def _encode_otherwise(content: bytes, rng: np.random.Generator) -> bytes:
    text = content.decode("latin-1")
    name = _choose(("utf-16", "utf-32", "utf-7", "nul", "noise", "empty", "blank", "marks"), rng)
    if name == "noise":
        return rng.bytes(5000)
    if name == "marks":
        return b"\xef\xbb\xbf\xef\xbb\xbf" + content
    other = {"empty": b"", "blank": b" \n" * 9, "nul": content.replace(b"a", b"\0")}
    return other[name] if name in other else text.encode(name)


DAMAGES: Mapping[str, Damage] = {
    "cut": _cut,
    "flipped": _flip,
    "spliced": _splice,
    "not finite": _put_not_finite,
    "huge number": _put_huge,
    "other type": _put_other_type,
    "depth": _nest,
    "aliases": _double_aliases,
    "entities": _double_entities,
    "a million": _fill,
    "entry missing": _drop_entry,
    "entry twice": _repeat_entry,
    "encoding": _encode_otherwise,
}
"""Kinds of damage to a content, by their names in the campaign's table."""


def _write_zeros(file: Path) -> None:
    file.touch()
    os.truncate(file, 1 << 30)  # takes no place on the disk


PLACES: Mapping[str, Callable[[Path], object]] = {
    "1 GB of zeros": _write_zeros,
    "pipe": os.mkfifo,
    "folder": Path.mkdir,
    "link to itself": lambda file: file.symlink_to(file),
    "no file": lambda file: file,
}
"""What may be in a file's place, by its name in the campaign's table."""


def _replace_value(content: bytes, value: bytes, rng: np.random.Generator) -> bytes:
    places = [match.span(1) for match in _VALUE.finditer(content)]
    if not places:
        place = int(rng.integers(len(content) + 1))
        return content[:place] + value + content[place:]
    start, end = places[int(rng.integers(len(places)))]
    return content[:start] + value + content[end:]


def _parse(content: bytes) -> Any:
    try:
        return json.loads(content)
    except ValueError:
        return None


def _choose_entry(document: Any, rng: np.random.Generator) -> tuple[Any, Any]:
    """Choose an entry at any depth; return what holds it, and its key there."""
    holder, key = document, _choose(_list_keys(document), rng)
    while _list_keys(holder[key]) and rng.random() < 0.75:
        holder, key = holder[key], _choose(_list_keys(holder[key]), rng)
    return holder, key


def _list_keys(value: Any) -> list[Any]:
    if isinstance(value, dict):
        return list(value)
    return list(range(len(value))) if isinstance(value, list) else []


def _choose(options: Any, rng: np.random.Generator) -> Any:
    return options[int(rng.integers(len(options)))]

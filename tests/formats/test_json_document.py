"""JSON written and read: exact numbers, stable lines, and errors that say where."""

from __future__ import annotations

import json
import math
import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from calibgui.engine.arrays import freeze_array
from calibgui.engine.errors import CalibrationError
from calibgui.formats import json_document
from calibgui.formats.json_document import (
    MAX_JSON_SIZE,
    JsonWriter,
    _format_array,
    are_same_values,
    check_format,
    dumps,
    read_json,
)
from calibgui.formats.node import Node

_SCALARS = (
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text()
)
_VALUES = st.recursive(
    _SCALARS,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner, max_size=4),
    max_leaves=30,
)


@given(_VALUES)
def test_any_value_reads_back_with_the_standard_reader(value: object) -> None:
    assert json.loads(dumps(value)) == value


@given(st.lists(st.floats(), min_size=1))
def test_numbers_keep_every_bit_and_those_that_are_not_finite_become_null(
    numbers: list[float],
) -> None:
    expected = [x if math.isfinite(x) else None for x in numbers]
    assert json.loads(dumps(np.array(numbers))) == expected


def test_points_stand_on_a_line_each() -> None:
    text = dumps({"uv": np.array([[1.5, 2.0], [3.0, 0.1]]), "empty": [], "size": (640, 480)})
    assert text == '{\n "uv": [[1.5, 2.0], [3.0, 0.1]],\n "empty": [],\n "size": [640, 480]\n}'
    many = dumps({"uv": np.full((20, 2), 0.25)})
    assert many.splitlines()[2:4] == ["  [0.25, 0.25],", "  [0.25, 0.25],"]


def test_a_document_is_as_if_written_alone_whatever_was_written_before(tmp_path: Path) -> None:
    """Texts of arrays are kept for the next document: not of those that may have changed."""
    rng = np.random.default_rng(0)
    lasting = freeze_array(rng.normal(size=(20, 2)))
    changing = rng.normal(size=(20, 2))
    part = changing[:10]
    part.flags.writeable = False
    writer = JsonWriter()
    for path in (tmp_path / "first.json", tmp_path / "second.json"):
        value = {"a": lasting, "b": [{"a": lasting, "c": changing}], "d": part, "e": [part, part]}
        writer.write_file(path, value)
        assert path.read_text() == dumps(value) + "\n"
        changing += 1.0


def test_what_a_document_shares_with_the_one_before_is_not_written_anew(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    arrays = [freeze_array(np.full((20, 2), k)) for k in range(5)]
    writer = JsonWriter()
    written = []
    monkeypatch.setattr(
        json_document,
        "_format_array",
        lambda value: written.append(int(value[0, 0])) or _format_array(value),
    )
    for chosen in ([0, 1], [0, 1], [1, 2], [0, 1]):
        writer.write_file(tmp_path / "a.json", {"views": [{"uv": arrays[k]} for k in chosen]})
    assert written == [0, 1, 2, 0], "a text is dropped once a document lacks its array"


def test_file_names_of_any_kind_survive(tmp_path: Path) -> None:
    """A name that is not valid Unicode arrives from the system with surrogates."""
    names = ["Büro 日本.png", 'a"b\\c\n.png', "\udcff.png"]
    file = tmp_path / "names.json"
    file.write_text(dumps(names), encoding="utf-8")
    assert [node.text() for node in read_json(file).items()] == names
    assert "日本" in file.read_text(encoding="utf-8")


def _node(value: object) -> Node:
    return Node(value, "views[2]", "a.json")


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda: _node({})["uv"], "a.json: views[2].uv is missing"),
        (lambda: _node([])["uv"], "views[2] is not an object"),
        (lambda: _node({}).items(), "views[2] is not a list"),
        (lambda: _node(3).text(), "views[2] is not text"),
        (lambda: _node(1).flag(), "views[2] is not true or false"),
        (lambda: _node("x").choice(["y", "z"]), "views[2] is not one of y, z"),
        (lambda: _node(True).number(), "views[2] is not a finite number"),
        (lambda: _node("1").number(), "views[2] is not a finite number"),
        (lambda: _node(math.nan).number(nullable=True), "views[2] is not a finite number"),
        (lambda: _node(10**400).number(), "views[2] is not a finite number"),
        (lambda: _node(1.5).integer(), "views[2] is not an integer"),
        (lambda: _node([[1, 2], [3]]).numbers(None, 2), "views[2][1] is not a list of 2 entries"),
        (lambda: _node([[1, 2], [3, None]]).numbers(None, 2), "views[2][1][1] is not a finite"),
        (lambda: _node([[1]]).numbers(2, 1), "views[2] is not a list of 2 entries (it has 1)"),
        (lambda: _node([1, 2.5]).integers(2), "views[2] is not an array of integers"),
    ],
)
def test_errors_say_where_and_what_was_expected(ask: object, message: str) -> None:
    with pytest.raises(CalibrationError) as caught:
        ask()  # type: ignore[operator]
    assert message in caught.value.message
    assert caught.value.hint


def test_values_are_read() -> None:
    node = _node({"a": 2, "b": None, "c": [[1, None]], "d": [], "e": True, "f": "x"})
    assert node["a"].integer() == 2
    assert node.get("b") is None
    assert node.get("absent") is None
    assert math.isnan(node["b"].number(nullable=True))
    assert np.array_equal(node["c"].numbers(1, 2, nullable=True), [[1, np.nan]], equal_nan=True)
    assert node["d"].numbers(None, 2).shape == (0, 2)
    assert node["e"].flag() and node["f"].choice(["x"]) == "x"


_ROWS = st.lists(
    st.lists(st.integers(-9, 9) | st.floats(width=16) | st.booleans() | st.none(), max_size=2),
    max_size=3,
)


@given(_ROWS | st.lists(_ROWS, max_size=2) | st.just([[10**400]]) | st.just([[1], "ab", {}]))
def test_a_table_is_read_alike_as_lists_and_as_the_array_that_a_file_holds(
    tmp_path_factory: pytest.TempPathFactory, value: object
) -> None:
    file = tmp_path_factory.mktemp("table") / "a.json"
    file.write_text(json.dumps({"a": value}))

    def answer(node: Node, shape: tuple[int | None, ...]) -> object:
        try:
            return node.numbers(*shape, nullable=len(shape) == 3).tolist()
        except CalibrationError as error:
            return error.message

    tables = read_json(file)["a"], Node(value, "a", str(file))
    for shape in ((), (None,), (None, 2), (2, 1), (None, 2, 2)):
        assert repr(answer(tables[0], shape)) == repr(answer(tables[1], shape))


def test_points_of_a_file_are_an_array_at_once(tmp_path: Path) -> None:
    """As lists they would be many enough for the garbage collector to be felt."""
    file = tmp_path / "a.json"
    file.write_text('{"uv": [[1, 2.5], [3, 4]], "size": [640, 480], "mixed": [[1, true]]}')
    node = read_json(file)
    assert isinstance(node["uv"].value, np.ndarray)
    assert [row.numbers(2).tolist() for row in node["uv"].items()] == [[1.0, 2.5], [3.0, 4.0]]
    assert node["size"].value == [640, 480]
    assert node["mixed"].value == [[1, True]]


def test_values_are_the_same_number_for_number(tmp_path: Path) -> None:
    file = tmp_path / "a.json"
    file.write_text('{"a": {"uv": [[1, 2]], "o": [{"uv": [[3, 4]]}]}, "b": {"uv": [[1, 2.5]]}}')
    a, b = read_json(file)["a"].value, read_json(file)["b"].value
    assert are_same_values(a, read_json(file)["a"].value)
    assert (
        not are_same_values(a, b)
        and not are_same_values(a["uv"], b["uv"])
        and not are_same_values(a["uv"], None)
    )
    assert not are_same_values(a["o"], a["o"] * 2)


def test_a_byte_order_mark_is_no_error(tmp_path: Path) -> None:
    file = tmp_path / "bom.json"
    file.write_bytes(b"\xef\xbb\xbf[1]")
    assert read_json(file).numbers(1) == [1.0]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b'{"a": [1, 2', "is cut short in line 1"),
        (b'{"a": "x', "is cut short in line 1"),
        (b"", "is empty"),
        (b"%YAML 1.2\n---\n", "is not a JSON file"),
        (b"\x89PNG\r\n\x1a\n\xff", "is not a JSON file"),
        *((content, "is cut short") for content in (b"[12.", b"[1e-", b"[-", b"[fals", b"[1,\n")),
        (b"[" * 100_000, "nests too deeply"),
        (b"[" + b"9" * 5000 + b"]", "endless number"),
    ],
)
def test_files_that_are_not_json_are_named(tmp_path: Path, content: bytes, message: str) -> None:
    file = tmp_path / "a.json"
    file.write_bytes(content)
    with pytest.raises(CalibrationError, match=message) as caught:
        read_json(file)
    assert str(file) in caught.value.message


def test_a_missing_file_and_a_folder_are_named(tmp_path: Path) -> None:
    for path, problem in ((tmp_path / "absent.json", "does not exist"), (tmp_path, "is a folder")):
        with pytest.raises(CalibrationError, match=problem) as caught:
            read_json(path)
        assert str(path) in caught.value.message


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ({}, "is not a thing"),
        ({"format": "y", "version": 1}, "is not a thing"),
        ({"format": "x", "version": 3}, "knows versions up to 2"),
        ({"format": "x", "version": 0}, "version is not a version of this format"),
        ({"format": "x", "version": "2"}, "version is not a finite number"),
    ],
)
def test_other_formats_and_newer_versions_are_refused(content: object, message: str) -> None:
    with pytest.raises(CalibrationError, match=message):
        check_format(Node(content, "", "a.json"), "x", 2, "a thing")
    check_format(Node({"format": "x", "version": 2}, "", "a.json"), "x", 2, "a thing")


def test_a_file_too_large_for_memory_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "large.json"
    path.touch()
    os.truncate(path, MAX_JSON_SIZE + 1)  # takes no place on the disk
    with pytest.raises(CalibrationError, match=r"large\.json is too large: more than 512 MB"):
        read_json(path)

"""The gate: whatever is no text, no data or made to do harm is a refusal that names the file."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from calibgui.engine.errors import CalibrationError
from calibgui.formats.gate import MAX_DEPTH, Language, parse_number, parse_text, read_text
from calibgui.formats.json_document import parse_json
from calibgui.formats.node import Node
from calibgui.formats.opencv_storage import parse_storage
from calibgui.formats.toml_document import read_toml
from calibgui.formats.yaml_document import parse_yaml


def _raise(error: Exception) -> Callable[[str], Any]:
    def parse(_text: str) -> Any:
        raise error

    return parse


@pytest.mark.parametrize(
    ("error", "reason"),
    [
        (RecursionError(), "it nests too deeply"),
        (MemoryError(), "it takes more memory than there is"),
        (KeyError("x"), "it holds an impossible value"),
        (OverflowError(), "it holds an impossible value"),
    ],
)
def test_whatever_a_parser_raises_refuses_the_file(error: Exception, reason: str) -> None:
    with pytest.raises(CalibrationError, match=f"^a.txt is not a thing: {reason}.$") as caught:
        try:
            parse_text("x", "a.txt", Language("a thing", _raise(error), 10))
        except CalibrationError as refusal:
            raise CalibrationError(refusal.message) from refusal
    assert caught.value.__cause__


def test_a_text_that_is_too_long_is_not_parsed() -> None:
    with pytest.raises(CalibrationError, match="it is too long"):
        parse_text("x" * 11, "a.txt", Language("a thing", _raise(AssertionError()), 10))


@pytest.mark.parametrize("parse", [parse_json, parse_yaml])
def test_content_nests_up_to_a_limit(parse: Callable[[str, str], Node]) -> None:
    node = parse("[" * MAX_DEPTH + "]" * MAX_DEPTH, "a")
    assert node.items()[0].items()
    for depth in (MAX_DEPTH + 1, 400, 100_000):
        with pytest.raises(CalibrationError, match=r"^a is not .*: it nests too deeply"):
            parse("[" * depth + "]" * depth, "a")


@pytest.mark.parametrize("key", ["a", "b.c"])
def test_toml_nests_up_to_the_same_limit(tmp_path: Path, key: str) -> None:
    file = tmp_path / "a.toml"
    file.write_text(f"{key} = [[1]]")
    assert read_toml(file, 1000).members()
    for depth in (MAX_DEPTH, 3000):
        file.write_text(f"{key} = {'[' * depth}{']' * depth}")
        with pytest.raises(CalibrationError, match=r"a\.toml is not a TOML .*nests too deeply"):
            read_toml(file, 10_000)


def test_an_entry_that_is_there_twice_is_named() -> None:
    for text in ('{"a": {"b": 1, "b": 2}}', "a: {b: 1, b: 2}", "<r><b>1</b><b>2</b></r>"):
        with pytest.raises(CalibrationError, match="two entries 'b'"):
            parse_storage(text, "a.txt")


_BOMB = """<!DOCTYPE r [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">]>
<r><camera_matrix>&b;</camera_matrix></r>"""


@pytest.mark.parametrize(
    "text", [_BOMB, _BOMB.replace("DOCTYPE", "doctype"), "<r>&b;</r>", "<r>" * 100_000]
)
def test_xml_has_no_declarations_and_no_entities_of_its_own(text: str) -> None:
    with pytest.raises(CalibrationError, match=r"a\.xml is not an XML file of OpenCV"):
        parse_storage(text, "a.xml")


@pytest.mark.parametrize(
    ("make", "problem"),
    [
        (lambda file: file.write_text("{}", "utf-16"), "not text in UTF-8"),
        (lambda file: file.write_bytes(bytes(range(256))), "not text in UTF-8"),
        (lambda file: file.mkdir(), "is a folder"),
        (lambda _: None, "does not exist"),
        (lambda file: file.symlink_to(file), "cannot be read"),
        (lambda file: file.write_bytes(bytes(11)), "too large"),
    ],
)
def test_what_is_no_text_of_a_file_is_refused(
    tmp_path: Path, make: Callable[[Path], object], problem: str
) -> None:
    file = tmp_path / "a.txt"
    make(file)
    limit = 10 if problem == "too large" else 1000
    with pytest.raises(CalibrationError, match=problem) as caught:
        read_text(file, limit, "a thing")
    assert "a.txt" in caught.value.message


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no named pipes")
def test_a_pipe_is_refused_at_once(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(CalibrationError, match="a device or a pipe"):
        read_text(tmp_path / "pipe", 1000, "a thing")


def test_numbers_are_decimal_digits() -> None:
    assert [parse_number(word) for word in ("1", "-.5", "+2.e-3", "1E2")] == [1, -0.5, 2e-3, 100]
    for word in ("", "1_0", "nan", "inf", "0x1", "\u0661", "1,5", "9" * 1001):
        with pytest.raises(ValueError, match="is not a number"):
            parse_number(word)


@pytest.mark.parametrize(
    ("value", "problem"),
    [
        ([[1, 0.5], [0.4, 1]], "it is not symmetric"),
        ([[-1, 0], [0, 1]], "a variance below 0"),
        ([[1, 2], [2, 1]], "a correlation beyond 1"),
        ([[0, 0.1], [0.1, 1]], "a correlation beyond 1"),
        ([[1, None], [None, 1]], "a finite number"),
        ([[1, 0]], "a list of 2 entries"),
    ],
)
def test_a_matrix_that_is_no_covariance_is_refused(value: object, problem: str) -> None:
    with pytest.raises(CalibrationError, match=problem) as caught:
        Node(value, "view 1.cov", "a.json").covariances(2, 2)
    assert "a.json: view 1.cov" in caught.value.message


def test_covariances_are_read_with_what_is_not_determined() -> None:
    value = [[1, 1, None], [1 + 1e-9, 1, None], [None, None, None]]
    assert Node(value, "", "a.json").covariances(3, 3, nullable=True)[0, 1] == 1
    assert Node([[0, 0], [0, 0]], "", "a.json").covariances(2, 2).shape == (2, 2)


@pytest.mark.parametrize("value", [[640.5, 480], [0, 480], [640], [True, 480], [1e7, 480], "x"])
def test_sizes_of_no_image_are_refused(value: object) -> None:
    with pytest.raises(CalibrationError, match=r"a\.json: size"):
        Node(value, "size", "a.json").image_size()

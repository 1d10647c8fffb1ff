"""YAML read as data: numbers of both versions, OpenCV's tags, and nothing that runs or grows."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from calibgui.engine.errors import CalibrationError
from calibgui.formats import yaml_document
from calibgui.formats.yaml_document import format_number, parse_yaml


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_every_number_is_read_however_it_is_written(value: float) -> None:
    assert parse_yaml(f"a: {value!r}", "f")["a"].number() == value
    assert parse_yaml(f"a: {format_number(value)}", "f")["a"].number() == value


@pytest.mark.parametrize(
    ("text", "value"),
    [("1e-05", 1e-5), ("5.e-04", 5e-4), (".5e3", 500.0), ("-2E5", -2e5), ("650.", 650.0)],
)
def test_numbers_of_yaml_1_2_and_of_opencv_are_numbers(text: str, value: float) -> None:
    assert parse_yaml(f"[{text}]", "f").value == [value]


def test_opencvs_head_and_tags_are_read() -> None:
    text = "%YAML:1.0\n---\nK: !!opencv-matrix\n   rows: 1\n   data: [ 1., 2.,\n       3. ]\n"
    assert parse_yaml(text, "f").value == {"K": {"rows": 1, "data": [1.0, 2.0, 3.0]}}
    assert parse_yaml(text.replace(":1.0", " 1.0"), "f").value["K"]["rows"] == 1


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a: !!python/object/apply:os.getcwd []", "could not determine a constructor"),
        ("a: &a {b: 1}\nc:\n  <<: *a", "has the alias \\*a, and aliases are not followed"),
        ("a:\n  <<: {b: 1}", "could not determine a constructor.*merge"),
        ("a: 1\nb: 2\na: 3", "two entries 'a'"),
        ("a: !!opencv-matrix {b: 1, b: 2}", "two entries 'b'"),
        ("a: !!bool x", "an impossible value"),
        ("a: !!int ''", "an impossible value"),
        ("a: !!timestamp x", "an impossible value"),
        ("[" * 100_000, "nests too deeply"),
        ("\n".join(" " * k + "-" for k in range(100)), "nests too deeply"),
        ("a: [1, 2", "in line "),
        ("a: 2020-13-45", "an impossible value"),
        ("{a: b}: 1", "unhashable key in line 1"),
        ("a: !!opencv-matrix [1]", "a matrix is not an object in line 1"),
        ("a: 1\n---\nb: 2\n", "another document in line 2"),
        ("a: \x00", "not allowed"),
    ],
)
def test_what_is_no_plain_data_is_refused(text: str, message: str) -> None:
    with pytest.raises(CalibrationError, match=message) as caught:
        parse_yaml(text, "camera.yaml")
    assert caught.value.message.startswith("camera.yaml is not a YAML file")


def test_a_text_that_is_too_long_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(yaml_document, "MAX_YAML_LENGTH", 10)
    with pytest.raises(CalibrationError, match="too long"):
        parse_yaml("a: 12345678", "f")

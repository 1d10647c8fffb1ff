"""The picture of the rooms in CONTRIBUTING.md is what the imports are."""

from __future__ import annotations

import importlib.util
import xml.etree.ElementTree as ET
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def script() -> ModuleType:
    spec = importlib.util.spec_from_file_location("draw_rooms", ROOT / "packaging/draw_rooms.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_picture_is_the_one_that_the_script_draws(script: ModuleType) -> None:
    committed = (ROOT / "resources/images/rooms.svg").read_text(encoding="utf-8")
    assert committed == script.draw(), "draw it again: python packaging/draw_rooms.py"


def test_every_room_is_in_the_picture_once(script: ModuleType) -> None:
    rooms = [room for row in script.read_rows() for room in row]
    assert sorted(rooms) == sorted(set(script.read_imports()) - {"__main__"})
    picture = ET.fromstring(script.draw())
    headings = [text.text for text in picture.iter() if text.get("class") == "name"]
    assert len(headings) == len(rooms) + 1  # and the engine around its own


def test_an_import_that_others_stand_for_is_left_out(script: ModuleType) -> None:
    imports = {"a": {"b", "c"}, "b": {"c"}, "c": set()}
    assert script.reduce_imports(imports) == {"a": {"b"}, "b": {"c"}, "c": set()}

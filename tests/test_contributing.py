"""CONTRIBUTING.md names what there is."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
MADE_BY_TOOLS = {"dist/calibgui/", "engine/kernels/__pycache__", "resources/translations/"}


def section(heading: str) -> str:
    """Return the text below a heading, down to the next of its rank."""
    rank = heading.split()[0]
    (text,) = re.findall(rf"^{heading}\n(.*?)(?=^{rank} |\Z)", TEXT, re.MULTILINE | re.DOTALL)
    return str(text)


def exists(name: str) -> bool:
    return any(list(folder.glob(name)) for folder in (ROOT, ROOT / "calibgui", ROOT / "packaging"))


def test_files_and_folders_named_exist() -> None:
    names = set(re.findall(r"`((?:[\w.*-]+/)+(?:[\w.*-]+\.\w+)?|[\w-]+\.(?:py|toml))`", TEXT))
    assert len(names) > 60
    assert not {name for name in names - MADE_BY_TOOLS if not exists(name)}
    for picture in re.findall(r"!\[.*?\]\((.*?)\)", TEXT):
        assert (ROOT / picture).is_file(), picture


def test_the_layout_names_every_folder() -> None:
    layout = section("## Layout").partition("![")[0]
    for folder in [ROOT / "calibgui", ROOT / "calibgui/engine"]:
        for inside in folder.iterdir():
            if inside.is_dir() and not inside.name.startswith("_"):
                assert re.search(rf"^ +{inside.name}/ ", layout, re.MULTILINE), inside.name
    for file in (ROOT / "calibgui/engine").glob("[a-z]*.py"):
        assert file.name in layout


def test_the_reading_order_is_a_list_of_files() -> None:
    steps = re.findall(r"^\d\. (.*)$", section("### Reading order"), re.MULTILINE)
    assert len(steps) >= 18
    assert all(re.match(r"`[\w/]+\.py`", step) for step in steps)


def test_the_papers_equations_are_where_it_says() -> None:
    rows = re.findall(
        r"^\| (.*) \| .* \| (.*) \|$", section("### The paper's equations"), re.MULTILINE
    )
    assert len(rows) > 10
    for equations, files in rows[2:]:
        numbers = "|".join(map(re.escape, re.findall(r"\d[\d.]*|[A-F]\b", equations)))
        for file in re.findall(r"`(.*?)`", files):
            text = (ROOT / "calibgui" / file).read_text(encoding="utf-8")
            assert re.search(rf"(eq\.|paper|appendi\w+)[ \d,-]* ({numbers})\b", text), file


@pytest.mark.parametrize(
    ("module", "name"),
    [
        ("calibgui.engine.camera.model", "Lens"),
        ("calibgui.engine.camera.models", "MODELS"),
        ("calibgui.engine.calibration.methods", "METHODS"),
        ("calibgui.engine.boards.pattern", "Pattern"),
        ("calibgui.engine.boards.kinds", "KINDS"),
        ("calibgui.engine.detection.find_corners", "DETECTORS"),
        ("calibgui.engine.kernels", "with_kernel"),
        ("calibgui.formats", "EXPORTERS"),
        ("calibgui.formats.camera_import", "IMPORTERS"),
        ("calibgui.cli.parser", "COMMANDS"),
        ("calibgui.gui.panels.analysis", "MODES"),
        ("calibgui.gui.panels.panel", "Panel"),
        ("calibgui.gui.panels.latest", "Latest"),
        ("calibgui.gui.panels.services", "Services"),
        ("tests.engine.scenes", "LENSES"),
    ],
)
def test_the_recipes_name_what_there_is(module: str, name: str) -> None:
    assert f"`{name}`" in section("## How to add") + section("## Compiled kernels")
    assert hasattr(import_module(module), name)


def test_every_dependency_has_its_reason() -> None:
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    (needed,) = re.findall(r"^dependencies = \[(.*?)^\]", project, re.MULTILINE | re.DOTALL)
    table = section("## Dependencies, and the reason for each")
    reasons = "".join(re.findall(r"^\| ([^|]*) \|", table, re.MULTILINE))
    for name in re.findall(r'^    "([\w-]+)', needed, re.MULTILINE):
        assert name in reasons, name

"""The desktop entry starts what is installed, with an icon and a type of file that there are."""

from __future__ import annotations

import tomllib
from configparser import ConfigParser
from pathlib import Path
from xml.etree import ElementTree

ROOT = Path(__file__).parents[2]


def test_a_double_click_on_a_project_starts_the_program() -> None:
    parser = ConfigParser(interpolation=None)
    parser.optionxform = str  # type: ignore[assignment, method-assign]
    parser.read(ROOT / "packaging/calibgui.desktop")
    entry = parser["Desktop Entry"]
    scripts = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["scripts"]
    assert entry["Exec"].split()[0] in scripts
    assert (ROOT / f"resources/icons/{entry['Icon']}.svg").is_file()

    space = "{http://www.freedesktop.org/standards/shared-mime-info}"
    kind = ElementTree.parse(ROOT / "packaging/calibgui-mime.xml").find(f"{space}mime-type")
    assert kind is not None
    assert kind.attrib["type"] in entry["MimeType"].split(";")
    assert "calibgui.json" in [g.attrib["pattern"] for g in kind.iter(f"{space}glob")]

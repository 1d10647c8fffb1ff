"""Write into the manual what the code knows: the tables of formats, panels, commands and terms.

    python packaging/write_manual.py

In a chapter such a part stands between <!-- NAME: ... --> and <!-- end -->. The errors of formats
are those of the bundled sample.
"""

from __future__ import annotations

import argparse
import inspect
import os
import re
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.outputs.export_folder import export_all, format_error
from calibgui.app.outputs.manual import list_chapters
from calibgui.app.photographs.detection import find_views
from calibgui.app.photographs.paths import find_images
from calibgui.app.system.resources import find_resource
from calibgui.cli.parser import COMMANDS, build_parser, configure
from calibgui.formats import EXPORTERS, IMPORTERS
from calibgui.formats.rig_files import RIG_EXPORTERS

_SQUARE = 25.0
"""Side of a square of the sample's board, mm."""


def describe_formats(errors: Sequence[str]) -> str:
    """Return the table of formats with the error of each, px."""
    several = {importer.title: importer.several for importer in IMPORTERS}
    rows = []
    for exporter, error in zip(EXPORTERS.values(), errors, strict=True):
        read = {None: "no", False: "yes", True: "several"}[several.get(exporter.title)]
        facts = [exporter.readers, exporter.keeps, exporter.loses]
        rows.append([exporter.title, f"`{exporter.name}`", read, *facts, error])
    head = ["format", "name", "read", "read by", "keeps", "loses", "error"]
    return _tabulate(head, rows)


def describe_rig_formats() -> str:
    """Return the table of formats of rigs."""
    rows = [
        [exporter.title, f"`{exporter.name}`", exporter.readers, exporter.keeps]
        for exporter in RIG_EXPORTERS.values()
    ]
    return _tabulate(["file", "name", "read by", "keeps"], rows)


def measure_errors() -> list[str]:
    """Return the error of each format on the sample."""
    views = find_views(find_images([str(find_resource("sample"))]))
    result = calibrate_views(views.corner_set(_SQUARE))
    with tempfile.TemporaryDirectory() as folder:
        outcomes = export_all(result, Path(folder))
    return ["refused" if one.report is None else format_error(one.report) for one in outcomes]


def read_errors(text: str) -> list[str]:
    """Return the error of each format that stands in a chapter."""
    return re.findall(
        r"^\| .+ \| `[\w-]+` \| (?:yes|no|several) \| .* \| (\S+) \|$", text, re.MULTILINE
    )


def describe_panels() -> str:
    """Return the table of modes and their panels."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    from calibgui.gui.panels.analysis import MODES
    from calibgui.gui.panels.mode_page import describe_panel, name_panel
    from calibgui.gui.panels.modes import Mode, describe_mode, name_mode

    rows = []
    for mode in Mode:
        kinds = [kind for row in MODES.get(mode, ()) for kind in row.kinds]
        rows.append([f"**{name_mode(mode)}**", "", describe_mode(mode)])
        if len(kinds) > 1:
            rows += [["", name_panel(kind), describe_panel(kind)] for kind in kinds]
    return _tabulate(["mode", "panel", "it shows"], rows)


def describe_terms() -> str:
    """Return the table of the terms that the window explains."""
    from calibgui.gui.widgets.glossary import list_terms

    return _tabulate(["term", "meaning"], [list(row) for row in list_terms().items()])


def describe_commands() -> str:
    """Return what each command needs and does, in three lines."""
    _, parsers = build_parser()
    parts = []
    for name in COMMANDS:
        command = configure(name, parsers[name])
        says = inspect.cleandoc(command.__doc__).partition("\n\n")[0].replace("\n", " ")
        usage = parsers[name].format_short_usage().partition(" [OPTION")[0]
        parts.append(
            f"- **`{usage.removeprefix('usage: ')}`**  \n  {says}  \n"
            f"  All options: `calibgui {name} --help all`"
        )
    return "\n".join(parts)


def _tabulate(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a table in Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(cells)} |".replace("|  |", "| |") for cells in lines)


def fill(text: str, parts: dict[str, Callable[[], str]]) -> str:
    """Return a chapter with the parts that the code knows."""

    def write(found: re.Match[str]) -> str:
        return f"{found[1]}\n\n{parts[found[2]]()}\n\n<!-- end -->"

    return re.sub(r"^(<!-- (\w+): .* -->)$.*?^<!-- end -->$", write, text, flags=re.M | re.S)


def main() -> None:
    """Write the tables."""
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    parts = {
        "formats": lambda: describe_formats(measure_errors()),
        "rig_formats": describe_rig_formats,
        "panels": describe_panels,
        "commands": describe_commands,
        "terms": describe_terms,
    }
    for chapter in list_chapters():
        text = chapter.file.read_text(encoding="utf-8")
        chapter.file.write_text(fill(text, parts), encoding="utf-8")


if __name__ == "__main__":
    main()

"""Bring the window's translations up to date: collect its texts, and compile what is translated.

    python packaging/translate.py [LANGUAGE]

A language that is named is added. What is missing is translated in
resources/translations/calibgui_<language>.ts, with Qt Linguist or an editor; run it again then. A
text without a translation is shown in English.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

_ROOT = Path(__file__).resolve().parents[1]
FOLDER = _ROOT / "resources" / "translations"


def find_tool(name: str) -> str:
    """Return Qt's tool of this name, which PySide6 brings."""
    found = shutil.which(f"pyside6-{name}", path=str(Path(sys.executable).parent))
    if found is None:
        raise FileNotFoundError(f"pyside6-{name} is missing: install PySide6-Essentials")
    return found


def update(file: Path) -> None:
    """Collect the texts of the window in a file of translations, and compile it."""
    sources = sorted((_ROOT / "calibgui" / "gui").rglob("*.py"))
    names = [str(source.relative_to(_ROOT)) for source in sources]
    options = ("-no-obsolete", "-locations", "none", "-silent")
    subprocess.run(
        [find_tool("lupdate"), *names, *options, "-ts", str(file)], check=True, cwd=_ROOT
    )
    compiled = str(file.with_suffix(".qm"))
    subprocess.run([find_tool("lrelease"), str(file), "-qm", compiled, "-silent"], check=True)


def list_missing(file: Path) -> list[str]:
    """List the texts of a file that are not translated."""
    return [
        message.findtext("source") or ""
        for message in ET.parse(file).iter("message")
        if not message.findtext("translation")
    ]


def main() -> None:
    """Update all languages, and say what is missing."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("languages", nargs="*", metavar="LANGUAGE", help="to be added, as it")
    added = {FOLDER / f"calibgui_{each}.ts" for each in parser.parse_args().languages}
    for file in sorted({*FOLDER.glob("*.ts"), *added}):
        update(file)
        missing = list_missing(file)
        print(f"{file.name}: {len(missing)} texts are not translated")
        for text in missing:
            print(f"    {text}")


if __name__ == "__main__":
    main()

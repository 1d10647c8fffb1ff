"""What is given away: the wheel, the source archive, and the files that describe the program."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from email import message_from_string
from pathlib import Path

import pytest
import yaml

from calibgui import __version__

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("dist")
    command = [sys.executable, "-m", "hatchling", "build", "-d", str(folder)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.mark.slow
def test_the_wheel_holds_the_program_and_nothing_else(built: Path) -> None:
    with zipfile.ZipFile(built / f"calibgui-{__version__}-py3-none-any.whl") as wheel:
        names = {name for name in wheel.namelist() if ".dist-info/" not in name}
        metadata = message_from_string(
            wheel.read(f"calibgui-{__version__}.dist-info/METADATA").decode()
        )
    files = [*(ROOT / "calibgui").rglob("*.py"), *(ROOT / "calibgui").rglob("templates/*")]
    sources = {path.relative_to(ROOT).as_posix() for path in files}
    folders = [path for path in (ROOT / "resources").iterdir() if path.name != "images"]
    files = [path for folder in folders for path in folder.rglob("*") if path.is_file()]
    resources = {f"calibgui/{path.relative_to(ROOT).as_posix()}" for path in files}
    assert names == sources | resources | {"calibgui/py.typed"}
    assert metadata["Version"] == __version__ and metadata["License-Expression"] == "BSD-3-Clause"
    assert metadata["Description-Content-Type"] == "text/markdown"


@pytest.mark.slow
def test_the_source_archive_can_be_tested(built: Path) -> None:
    with tarfile.open(built / f"calibgui-{__version__}.tar.gz") as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    needed = ("pyproject.toml", "LICENSE", "CITATION.cff", "packaging/bootstrap.py")
    assert {*needed, "tests/conftest.py", "resources/sample/truth.json"} <= names
    assert not [name for name in names if name.endswith(".pyc")]


def test_the_citation_is_of_this_version() -> None:
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert citation["version"] == __version__ and citation["license"] == "BSD-3-Clause"
    assert {"cff-version", "message", "title", "authors"} <= citation.keys()


@pytest.mark.parametrize(
    ("tool", "options", "file", "accepted"),
    [
        ("desktop-file-validate", (), "calibgui.desktop", ""),
        # Its id cannot begin with the project's address before there is one.
        ("appstreamcli", ("validate", "--no-net"), "calibgui.metainfo.xml", "is-not-rdns"),
    ],
)
def test_desktops_take_the_description(
    tool: str, options: tuple[str, ...], file: str, accepted: str
) -> None:
    if shutil.which(tool) is None:
        pytest.skip(f"{tool} is not installed")
    command = [tool, *options, str(ROOT / "packaging" / file)]
    said = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    problems = re.findall(r"^[EW]: .*$", said, re.MULTILINE) or re.findall("error: .*", said)
    assert [line for line in problems if not accepted or accepted not in line] == []

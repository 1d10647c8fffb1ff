"""The project's own promises: nothing of one machine, commands that agree, a whole wheel."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
import tomllib
import zipfile
from importlib import import_module
from importlib.metadata import version
from pathlib import Path

import pytest

import calibgui

ROOT = Path(__file__).resolve().parents[1]


def repository_files() -> list[Path]:
    try:
        listed = subprocess.run(
            ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True
        )
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("git does not say what belongs to the repository")
    return [ROOT / name for name in listed.stdout.split("\0") if name and (ROOT / name).is_file()]


def test_no_path_of_one_machine() -> None:
    places = "|".join(("work", "root", "tmp", "home", "Users"))
    path = re.compile(rb"(?<![\w.~$}*])/(" + places.encode() + rb")/\w")
    found = [
        f"{file.relative_to(ROOT)}:{number}: {line.strip()[:80]!r}"
        for file in repository_files()
        if b"\0" not in (content := file.read_bytes())
        for number, line in enumerate(content.splitlines(), start=1)
        if path.search(line)
    ]
    assert not found, "\n".join(found)


def list_names(file: Path) -> set[str]:
    """List what a module defines or imports."""
    tree = ast.walk(ast.parse(file.read_text(encoding="utf-8")))
    kinds = ast.FunctionDef | ast.ClassDef | ast.alias
    return {
        node.id if isinstance(node, ast.Name) else node.name
        for node in tree
        if isinstance(node, kinds | ast.Name)
    }


def test_docstrings_name_modules_that_there_are() -> None:
    """In ``a.b.c`` the longest module is looked for, and then the first name after it in it."""
    modules = {path.with_suffix(""): path for path in (ROOT / "calibgui").rglob("*.py")}
    dotted = {f".{'.'.join(module.parts)}".removesuffix(".__init__"): module for module in modules}
    folders = {part for module in modules for part in module.relative_to(ROOT).parts}
    wrong = []
    for path in modules.values():
        for name in re.findall(r"``([a-z_]+(?:\.\w+)+)``", path.read_text(encoding="utf-8")):
            parts = name.split(".")
            if parts[0] not in folders or parts[-1] == "py":
                continue
            for count in range(len(parts), 0, -1):
                head = "." + ".".join(parts[:count])
                found = [modules[module] for end, module in dotted.items() if end.endswith(head)]
                if found:
                    break
            rest = parts[count : count + 1]
            if not any(set(rest) <= list_names(file) for file in found):
                wrong.append(f"{path.relative_to(ROOT)}: {name}")
    assert not wrong


def test_repository_stays_small() -> None:
    large = {
        str(file.relative_to(ROOT)): file.stat().st_size
        for file in repository_files()
        if file.stat().st_size > 2_000_000
    }
    assert not large


def test_one_version() -> None:
    assert version("calibgui") == calibgui.__version__
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert f"## [{calibgui.__version__}]" in changes


def test_the_engine_installs_without_qt() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]
    window = ("PySide6", "pyqtgraph")
    assert not [name for name in project["dependencies"] if name.startswith(window)]
    assert all(any(name.startswith(each) for name in extras["gui"]) for each in window)
    assert "calibgui[gui]" in extras["dev"]
    entry = project["gui-scripts"]["calibgui-window"]
    module, _, function = entry.partition(":")
    assert callable(getattr(import_module(module), function))


def test_readme_gives_the_commands_that_ci_runs() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert "\npython3 packaging/bootstrap.py run\n" in readme
    assert "\npython3 packaging/bootstrap.py test\n" in readme
    ci = (ROOT / ".ci" / "run").read_text(encoding="utf-8").splitlines()
    assert ci[-1] == "python3 packaging/bootstrap.py test"


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)],
        cwd=ROOT,
        capture_output=True,
        check=True,
    )
    return next(folder.glob("*.whl"))


def test_wheel_is_whole(wheel: Path) -> None:
    shipped = set(zipfile.ZipFile(wheel).namelist())
    sources = {
        str(file.relative_to(ROOT).as_posix())
        for file in (ROOT / "calibgui").rglob("*.py")
        if "__pycache__" not in file.parts
    }
    resources = {
        f"calibgui/{file.relative_to(ROOT).as_posix()}"
        for file in (ROOT / "resources").rglob("*")
        if file.is_file()
    }
    pictures = {name for name in resources if name.startswith("calibgui/resources/images/")}
    assert pictures < resources
    assert {"calibgui/py.typed"} | sources | (resources - pictures) <= shipped
    assert not pictures & shipped, "the README's pictures are of no use to the program"
    metadata = f"calibgui-{calibgui.__version__}.dist-info"
    assert f"{metadata}/licenses/LICENSE" in shipped
    assert all(name.startswith(("calibgui/", metadata)) for name in shipped)

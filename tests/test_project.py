"""The project's own promises: import rules that bite, nothing of one machine, a whole wheel."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import zipfile
from importlib.metadata import version
from pathlib import Path

import pytest

import calibgui

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the package that may be spoilt."""
    folder = tmp_path_factory.mktemp("copy")
    shutil.copytree(ROOT / "calibgui", folder / "calibgui")
    shutil.copy(ROOT / "pyproject.toml", folder)
    return folder


def lint_imports(folder: Path) -> subprocess.CompletedProcess[str]:
    program = "from importlinter.cli import lint_imports_command; lint_imports_command()"
    return subprocess.run(
        [sys.executable, "-c", program, "--no-cache"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )


def test_import_rules_hold(copy: Path) -> None:
    done = lint_imports(copy)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize(
    ("module", "imports", "contract"),
    [
        ("engine/refit.py", "calibgui.formats", "Layers"),
        ("formats/__init__.py", "calibgui.app", "Layers"),
        ("app/__init__.py", "calibgui.cli", "Layers"),
        ("engine/estimation/__init__.py", "calibgui.engine.quality", "Within the engine"),
        ("engine/frames.py", "matplotlib", "The engine needs"),
        ("engine/frames.py", "tqdm", "The engine needs"),
        ("cli/__init__.py", "PySide6.QtCore", "Qt is imported"),
        ("app/__init__.py", "pyqtgraph", "Qt is imported"),
        ("engine/frames.py", "cv2", "OpenCV is imported"),
        ("cli/__init__.py", "cv2", "OpenCV is imported"),
    ],
)
def test_import_rules_bite(copy: Path, module: str, imports: str, contract: str) -> None:
    file = copy / "calibgui" / module
    sound = file.read_text(encoding="utf-8")
    file.write_text(f"{sound}\nimport {imports}\n", encoding="utf-8")
    try:
        done = lint_imports(copy)
    finally:
        file.write_text(sound, encoding="utf-8")
    assert done.returncode == 1
    broken = re.findall(r"^(.*) BROKEN", done.stdout, re.MULTILINE)
    assert len(broken) == 1, done.stdout
    assert broken[0].startswith(contract)


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
    assert resources
    assert {"calibgui/py.typed"} | sources | resources <= shipped
    metadata = f"calibgui-{calibgui.__version__}.dist-info"
    assert f"{metadata}/licenses/LICENSE" in shipped
    assert all(name.startswith(("calibgui/", metadata)) for name in shipped)

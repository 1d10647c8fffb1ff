"""Imports point one way: each rule of import-linter is broken on a copy; circles are computed."""

from __future__ import annotations

import ast
import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from importlib import import_module
from itertools import pairwise, permutations
from pathlib import Path

import grimp
import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "calibgui"
CONTRACTS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"][
    "importlinter"
]["contracts"]
OUTER, ROOMS, FACES, INSIDE, CIRCLES = (contract["name"] for contract in CONTRACTS[:5])
ENGINE = "calibgui.engine"
FACE_FILES = [
    file
    for file in (PACKAGE / "engine").glob("*/__init__.py")
    if "load_on_demand" in file.read_text(encoding="utf-8")
]


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the package that may be spoilt."""
    folder = tmp_path_factory.mktemp("copy")
    compiled = shutil.ignore_patterns("__pycache__")
    shutil.copytree(PACKAGE, folder / "calibgui", ignore=compiled)
    shutil.copy(ROOT / "pyproject.toml", folder)
    return folder


def find_broken_contracts(folder: Path) -> tuple[set[str], str]:
    """Return the names of the contracts that the copy in `folder` breaks, and what was printed."""
    program = "from importlinter.cli import lint_imports_command; lint_imports_command()"
    done = subprocess.run(
        [sys.executable, "-c", program, "--no-cache"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    broken = set(re.findall(r"^(.*) BROKEN", done.stdout, re.MULTILINE))
    assert (done.returncode == 0) == (not broken), done.stdout + done.stderr
    return broken, done.stdout


def find_file(folder: Path, module: str) -> Path:
    """Return the file of a module in the copy in `folder`, where it is or would be."""
    file = folder / Path(*module.split("."))
    return file / "__init__.py" if file.is_dir() else file.with_suffix(".py")


def spoil(folder: Path, wrong: Iterable[tuple[str, str]], form: str) -> dict[str, str]:
    """Return what is printed of each contract once modules of the copy in `folder` import others.

    Args:
        folder: of the copy.
        wrong: (importing, imported) modules; the first are made where there are none.
        form: lines of an import, with a place for what is imported.
    """
    for importing, imported in wrong:
        with find_file(folder, importing).open("a", encoding="utf-8") as file:
            file.write(f"\n{form.format(imported)}\n")
    broken, printed = find_broken_contracts(folder)
    assert "Could not" not in printed
    _, *parts = re.split(r"^(.+)\n-{9,}\n", printed, flags=re.MULTILINE)
    sections = dict(zip(parts[::2], parts[1::2], strict=True))
    return {name: " ".join(sections[name].split()) for name in broken}


def first_module(package: str) -> str:
    """Return the first module by name below `package`, or `package` if it is a file itself."""
    folder = ROOT / Path(*package.split("."))
    if not folder.is_dir():
        return package
    files = sorted(file for file in folder.rglob("*.py") if file.stem != "__init__")
    return ".".join(files[0].relative_to(ROOT).with_suffix("").parts)


def wrong_ways(layers: list[str], prefix: str = "") -> Iterator[tuple[str, str]]:
    """Yield (importing, imported) packages: each layer from the one below, siblings both ways."""
    named = [[prefix + name for name in re.split(r"\s*[|:]\s*", layer)] for layer in layers]
    for upper, lower in pairwise(named):
        yield from ((below, above) for below in lower for above in upper)
    for siblings in named:
        yield from permutations(siblings, 2)


def test_import_rules_hold(copy: Path) -> None:
    broken, printed = find_broken_contracts(copy)
    assert not broken, printed


def test_no_layer_imports_a_higher_one(copy: Path, tmp_path: Path) -> None:
    """All wrong ways at once: each is named under the contract that it breaks."""
    shutil.copytree(copy, tmp_path, dirs_exist_ok=True)
    layers = {
        OUTER: wrong_ways(CONTRACTS[0]["layers"]),
        ROOMS: wrong_ways(CONTRACTS[1]["layers"], f"{ENGINE}."),
    }
    wrong = [
        (contract, first_module(importing), first_module(imported))
        for contract, ways in layers.items()
        for importing, imported in ways
    ]
    assert len(wrong) > 40
    told = spoil(tmp_path, [ways for _, *ways in wrong], "import {}")
    unnamed = [each for each in wrong if f"{each[1]} -> {each[2]} (" not in told[each[0]]]
    assert not unnamed


def test_rules_beside_the_layers(copy: Path, tmp_path: Path) -> None:
    """All wrong imports at once, as above; what is allowed among them is not named."""
    shutil.copytree(copy, tmp_path, dirs_exist_ok=True)
    wrong = {
        ("app.paths", f"{ENGINE}.camera.camera"): FACES,
        ("report.numbers", f"{ENGINE}.calibration.refinement.schur"): FACES,
        ("engine.geometry.frames", f"{ENGINE}.geometry"): INSIDE,
        ("engine.calibration.observations", f"{ENGINE}.camera"): INSIDE,
        ("engine.geometry.frames", "matplotlib"): "The engine draws nothing",
        ("engine.geometry.frames", "tqdm"): "The engine draws nothing",
        ("cli.console", "PySide6"): "Qt is imported",
        ("app.paths", "pyqtgraph"): "Qt is imported",
        ("engine.geometry.frames", "cv2"): "OpenCV is imported",
        ("cli.console", "cv2"): "OpenCV is imported",
        ("engine.geometry.frames", "numba"): "numba is imported",
    }
    allowed = ("app.paths", "calibgui.app.projects.document")
    added = [(f"calibgui.{importing}", imported) for importing, imported in (*wrong, allowed)]
    told = spoil(tmp_path, added, "import {}")
    for (importing, imported), contract in wrong.items():
        (said,) = (said for name, said in told.items() if name.startswith(contract))
        assert f"calibgui.{importing} -> {imported} (" in said
    assert {name.partition(":")[0] for name in told} == {
        name.partition(":")[0]
        for name in (contract["name"] for contract in CONTRACTS)
        if name.startswith(tuple(wrong.values()))
    }


def test_imports_in_functions_and_for_typing_count(copy: Path, tmp_path: Path) -> None:
    shutil.copytree(copy, tmp_path, dirs_exist_ok=True)
    form = (
        "def late() -> None:\n    import {0}\n"
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import {0}"
    )
    wrong = {
        OUTER: ("calibgui.formats.exporter", "calibgui.app.photographs.paths"),
        ROOMS: (f"{ENGINE}.errors", f"{ENGINE}.calibration.result"),
        FACES: ("calibgui.gui.app", f"{ENGINE}.camera.camera"),
    }
    circle = (f"{ENGINE}.calibration.refinement.schur", f"{ENGINE}.calibration.calibrate")
    told = spoil(tmp_path, [*wrong.values(), circle], form)
    for contract, (importing, imported) in wrong.items():
        found = rf"{re.escape(f'{importing} -> {imported}')} \(l\.\d+, l\.\d+\)"
        assert re.search(found, told[contract])
    assert told.keys() == {*wrong, CIRCLES}
    assert f"No cycles are allowed in {ENGINE}.calibration." in told[CIRCLES]


def test_a_new_room_has_to_find_its_layer(copy: Path, tmp_path: Path) -> None:
    shutil.copytree(copy, tmp_path, dirs_exist_ok=True)
    (tmp_path / "calibgui" / "engine" / "attic.py").touch()
    assert find_broken_contracts(tmp_path)[0] == {ROOMS}


def test_the_contract_knows_where_a_function_has_the_name_of_its_file() -> None:
    (faces,) = (contract for contract in CONTRACTS if contract["name"] == FACES)
    known = {line.partition(" -> ")[2] for line in faces["ignore_imports"]}
    named = set()
    for face in (PACKAGE / "engine").glob("*/__init__.py"):
        files = {file.stem for file in face.parent.glob("*.py")}
        for node in ast.walk(ast.parse(face.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom):
                taken = {alias.name for alias in node.names} & files
                named |= {f"{ENGINE}.{face.parent.name}.{name}" for name in taken}
    assert known == named


@pytest.mark.parametrize("room", ["", *sorted(face.parent.name for face in FACE_FILES)])
def test_a_face_offers_what_is_said_for_type_checkers(room: str) -> None:
    """Assert that both lists of a face agree, and that each of its names can be had."""
    name = f"{ENGINE}.{room}".rstrip(".")
    tree = ast.parse(find_file(ROOT, name).read_text(encoding="utf-8"))
    said = {
        (node.module, alias.name, alias.asname)
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(f"{name}.")
        for alias in node.names
        if alias.asname
    }
    face = import_module(name)
    assert said == {(face._file_of[each], each, each) for each in face.__all__}
    assert all(getattr(face, each) is vars(sys.modules[file])[each] for file, each, _ in said)


def test_nothing_is_taken_from_the_file_behind_a_face() -> None:
    """Assert what the contract cannot see where a function has the name of its file."""
    behind = re.compile(
        r"from calibgui\.engine\.(?!kernels)\w+\.\w+(\.\w+)* import|import calibgui\.engine\."
    )
    found = [
        f"{file.relative_to(ROOT)}: {line.strip()}"
        for file in [*PACKAGE.rglob("*.py"), *(ROOT / "packaging").glob("*.py")]
        if PACKAGE / "engine" not in file.parents
        for line in file.read_text(encoding="utf-8").splitlines()
        if behind.search(line)
    ]
    assert not found, "\n".join(found)


def test_no_import_inside_a_function_of_the_engine() -> None:
    """Assert that the engine hides none of its own imports in functions or behind TYPE_CHECKING.

    What numba needs may: the kernels are loaded when they are first called. So may the faces, which
    tell type checkers what they load on demand.
    """
    found = []
    faces = [PACKAGE / "engine" / "__init__.py", *FACE_FILES]
    for file in set((PACKAGE / "engine").rglob("*.py")) - set(faces):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        hidden = {
            inner
            for node in ast.walk(tree)
            if isinstance(node, ast.FunctionDef | ast.If)
            for inner in ast.walk(node)
            if isinstance(inner, ast.ImportFrom)
            and (inner.module or "").startswith("calibgui")
            and not (inner.module or "").startswith(f"{ENGINE}.kernels")
        }
        found += [f"{file.relative_to(ROOT)}:{node.lineno}" for node in hidden]
    assert not found, "\n".join(sorted(found))


def find_circles(imports: Mapping[str, Iterable[str]]) -> list[set[str]]:
    """Return the sets of two or more nodes that import each other, directly or through others."""
    reached: dict[str, set[str]] = {}
    for start in imports:
        found: set[str] = set()
        new = set(imports[start])
        while new:
            found |= new
            new = {after for node in new for after in imports.get(node, ())} - found
        reached[start] = found
    circles: list[set[str]] = []
    for node in imports:
        circle = {other for other in reached[node] if node in reached.get(other, ())}
        if len(circle) > 1 and circle not in circles:
            circles.append(circle)
    return circles


def test_circles_are_found() -> None:
    imports = {"a": ["b"], "b": ["c", "d"], "c": ["a"], "d": ["e"], "e": []}
    assert find_circles(imports) == [{"a", "b", "c"}]
    assert not find_circles({"a": ["b", "c"], "b": ["c"], "c": []})


@pytest.fixture(scope="module")
def graph() -> grimp.ImportGraph:
    return grimp.build_graph("calibgui", cache_dir=None)


def test_no_circle_of_files(graph: grimp.ImportGraph) -> None:
    imports = {file: graph.find_modules_directly_imported_by(file) for file in graph.modules}
    assert not find_circles(imports)


def test_no_circle_of_folders(graph: grimp.ImportGraph) -> None:
    """In each folder the files and folders in it, with all they hold, import one way."""
    circles = []
    for folder in graph.modules:
        inside = sorted(graph.find_children(folder))
        holder = {m: child for child in inside for m in {child} | graph.find_descendants(child)}
        imports: dict[str, set[str]] = {child: set() for child in inside}
        for module, child in holder.items():
            for imported in graph.find_modules_directly_imported_by(module):
                if holder.get(imported, child) != child:
                    imports[child].add(holder[imported])
        circles += find_circles(imports)
    assert not circles


def test_a_calibration_needs_no_detector(graph: grimp.ImportGraph) -> None:
    needed = graph.find_upstream_modules(f"{ENGINE}.calibration.calibrate")
    assert f"{ENGINE}.calibration.refinement.schur" in needed
    assert not {module for module in needed if module.startswith(f"{ENGINE}.detection")}


def test_tests_do_not_need_the_benchmarks() -> None:
    benchmarks = ROOT / "tests" / "benchmarks"
    found = [
        f"{file.relative_to(ROOT)}: {line}"
        for file in (ROOT / "tests").rglob("*.py")
        if benchmarks not in file.parents
        for line in file.read_text(encoding="utf-8").splitlines()
        if re.match(r"\s*(from|import) tests(\.benchmarks| import .*benchmarks)", line)
    ]
    assert not found, "\n".join(found)

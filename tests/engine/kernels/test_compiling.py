"""Kernels are compiled in little time, and kept for the next start."""

from __future__ import annotations

import ast
import gc
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import calibgui
from calibgui.engine import kernels

numba = pytest.importorskip("numba", reason="numba is not installed")


def test_a_change_to_what_a_kernel_calls_in_another_file_is_noticed(tmp_path: Path) -> None:
    package = tmp_path / "calibgui"
    source = Path(calibgui.__file__).parent
    shutil.copytree(source, package, ignore=shutil.ignore_patterns("__pycache__"))
    folder = package / "engine" / "kernels"
    (folder / "asks.py").write_text(
        "from calibgui.engine.kernels.common import compiled\n"
        "from calibgui.engine.kernels.knows import answer\n"
        "@compiled\n"
        "def asked():\n"
        "    return answer()\n",
        encoding="utf-8",
    )
    for answer in ("1", "22"):
        (folder / "knows.py").write_text(
            "from calibgui.engine.kernels.common import compiled_part\n"
            "@compiled_part\n"
            "def answer():\n"
            f"    return {answer}\n",
            encoding="utf-8",
        )
        done = subprocess.run(
            [sys.executable, "-c", f"from {kernels.__name__}.asks import asked; print(asked())"],
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": str(tmp_path)},
            capture_output=True,
            text=True,
            check=True,
        )
        assert done.stdout.strip() == answer


def _list_functions() -> list[ast.FunctionDef]:
    """List the functions of all kernels' files."""
    return [
        function
        for file in sorted(Path(kernels.__file__).parent.glob("*.py"))
        for function in ast.parse(file.read_text(encoding="utf-8")).body
        if isinstance(function, ast.FunctionDef)
    ]


def _list_marks(function: ast.FunctionDef) -> set[str]:
    """List the decorators of a function."""
    return {ast.unparse(mark) for mark in function.decorator_list}


def test_no_kernel_calls_another() -> None:
    """What is kept of a kernel is machine code, which others cannot be compiled with."""
    functions = _list_functions()
    marks = {function.name: _list_marks(function) for function in functions}
    calls = {
        (function.name, call.func.id)
        for function in functions
        if marks[function.name] & {"compiled", "compiled_part", "compiled_allocating_part"}
        for call in ast.walk(function)
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Name)
    }
    assert len(calls) > 50
    assert not [pair for pair in calls if "compiled" in marks.get(pair[1], ())]


def test_parts_that_count_no_references_return_no_array() -> None:
    """It would be freed too early; that they allocate none numba sees to."""
    parts = [each for each in _list_functions() if "compiled_part" in _list_marks(each)]
    assert len(parts) > 50
    assert not [part.name for part in parts if "Array" in ast.unparse(part.returns or part.args)]


def test_parts_become_machine_code_in_kernels_only_and_of_these_nothing_else_is_kept() -> None:
    from llvmlite.binding import parse_bitcode

    from calibgui.engine.kernels.compilation import KernelCompiler

    compiler = {"pipeline_class": KernelCompiler}
    part = numba.njit(lambda x: x + 1, no_cpython_wrapper=True, **compiler)
    outer = numba.njit(lambda x: part(x) + part(2 * x), no_cpython_wrapper=True, **compiler)
    kernel = numba.njit(lambda x: outer(x) + part(x), **compiler)
    assert kernel(1.0) == 7
    (made,), *parts = (each.overloads.values() for each in (kernel, part, outer))
    engine = made.library.codegen._engine
    assert engine.is_symbol_defined(made.fndesc.mangled_name)
    for (each,) in parts:
        assert not engine.is_symbol_defined(each.fndesc.mangled_name)
    _, _, (machine_code, code) = made.library.serialize_using_object_code()
    assert machine_code
    assert not list(parse_bitcode(code).functions)


def test_no_garbage_is_looked_for_while_a_kernel_is_compiled(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from numba.core.compiler import Compiler

    from calibgui.engine.kernels.compilation import KernelCompiler

    looked: list[bool] = []
    usual = Compiler.compile_extra

    def watch(self: Compiler, function: object) -> object:
        looked.append(gc.isenabled())
        return usual(self, function)

    monkeypatch.setattr(Compiler, "compile_extra", watch)
    assert gc.isenabled()
    assert numba.njit(lambda x: x + 1, pipeline_class=KernelCompiler)(1) == 2
    assert looked == [False]
    assert gc.isenabled()


def test_numba_looks_for_nothing_that_no_kernel_has(monkeypatch: pytest.MonkeyPatch) -> None:
    from numba.core.compiler_machinery import PassManager

    from calibgui.engine.kernels import compilation

    steps: list[set[str]] = []
    usual = PassManager.run

    def watch(self: PassManager, state: object) -> None:
        steps.append({step.__name__ for step, _ in self.passes})
        usual(self, state)

    monkeypatch.setattr(PassManager, "run", watch)
    assert numba.njit(lambda x: x + 1)(1) == 2
    assert numba.njit(lambda x: x + 1, pipeline_class=compilation.KernelCompiler)(1) == 2
    of_all, of_kernels = steps
    assert of_all - of_kernels == compilation._NEEDLESS_STEPS


def test_a_kept_kernel_is_loaded_without_what_compiling_takes(tmp_path: Path) -> None:
    (tmp_path / "asks.py").write_text(
        "from calibgui.engine.kernels.common import compiled\n"
        "@compiled\n"
        "def double(x):\n"
        "    return 2 * x\n",
        encoding="utf-8",
    )
    program = (
        "import sys, asks, numpy as np\n"
        "assert (asks.double(np.ones(3)) == 2).all()\n"
        "print('numba.np.arraymath' in sys.modules)"
    )
    ours = Path(calibgui.__file__).parents[1]
    places = {
        "PYTHONPATH": os.pathsep.join(map(str, (tmp_path, ours))),
        "NUMBA_CACHE_DIR": str(tmp_path / "kept"),
    }
    said = [
        subprocess.run(
            [sys.executable, "-c", program],
            env=os.environ | places,
            capture_output=True,
            text=True,
            check=True,
        ).stdout.strip()
        for _ in range(2)
    ]
    assert said == ["True", "False"]

"""Nobody waits for the compiler: readable functions work until their kernels are kept."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from calibgui.engine import kernels

pytest.importorskip("numba", reason="numba is not installed")

_ASK = """
import subprocess, sys
import numpy as np
from calibgui.engine import kernels
from calibgui.engine.images.sampling import sample_image

image, uv = np.arange(12, dtype=np.uint8).reshape(3, 4), np.array([[1.5, 1.0]])

def asked():
    assert sample_image(image, uv).tolist() == [5.5]
    return sample_image._kernel is not None

"""


def _run(body: str, folder: Path) -> str:
    root = str(Path(__file__).parents[3])
    places = {"PYTHONPATH": root, "NUMBA_CACHE_DIR": str(folder)}
    command = [sys.executable, "-c", _ASK + body]
    done = subprocess.run(
        command, env=os.environ | places, capture_output=True, text=True, check=True
    )
    return done.stdout.strip()


def test_a_kernel_is_used_from_when_another_process_has_compiled_it(tmp_path: Path) -> None:
    compiles = "with kernels.compile_missing():\n    assert asked()"
    body = (
        "assert not asked() and not asked()\n"
        "assert kernels.was_any_missed() and not kernels.are_all_kept()\n"
        f"subprocess.run([sys.executable, '-c', {_ASK + compiles!r}], check=True)\n"
        "print(asked())"
    )
    assert _run(body, tmp_path) == "True"
    assert _run("print(asked(), kernels.was_any_missed())", tmp_path) == "True False"


def test_a_kernel_is_compiled_once_readable_code_has_taken_as_long(tmp_path: Path) -> None:
    body = (
        "assert not asked() and 0 < kernels._spent['sampling'] < kernels._PRICE_SECONDS\n"
        "kernels._spent['sampling'] += kernels._PRICE_SECONDS\n"
        "print(asked())"
    )
    assert _run(body, tmp_path) == "True"


def test_the_time_of_functions_that_a_readable_one_returns_counts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(kernels, "_is_worth_loading", lambda _: False)
    monkeypatch.setattr(kernels, "_spent", {})

    @kernels.with_kernel("somewhere", "prepare")
    def prepare():  # type: ignore[no-untyped-def]
        return lambda x: x + 1

    step = prepare()
    before = kernels._spent["somewhere"]
    assert step(1) == 2
    assert kernels._spent["somewhere"] > before


def test_readable_code_tells_no_more_than_its_kernel_of_what_is_not_finite(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(kernels, "_is_worth_loading", lambda _: False)
    divide = kernels.with_kernel("somewhere", "divide")(lambda x: x / np.zeros(2))
    assert np.isnan(divide(np.zeros(2))).all()


def test_a_module_of_kernels_waits_for_those_that_it_calls(monkeypatch: pytest.MonkeyPatch) -> None:
    """`board_shape` has none of its own, and calls those of `normal_equations`."""
    from calibgui.engine.kernels import board_shape, common

    theirs = {board_shape.sum_products.__module__: [None]}
    monkeypatch.setattr(common, "_caches", common._caches | theirs)
    assert not common.are_kept(board_shape)

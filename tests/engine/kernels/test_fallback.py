"""What happens where kernels cannot be compiled, or not be kept."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[3]


def demo(folder: Path, *paths: Path) -> dict[str, Any]:
    """The camera of the bundled sample, from photographs to the result."""
    search = os.pathsep.join(map(str, [*paths, ROOT]))
    subprocess.run(
        [sys.executable, "-m", "calibgui", "demo", "--quiet", "-o", str(folder)],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": search},
        check=True,
    )
    content = json.loads((folder / "result.json").read_text(encoding="utf-8"))
    return content["camera"]


@pytest.mark.slow
def test_without_numba_the_result_is_the_same(tmp_path: Path) -> None:
    """In all processes: their interpreters start with numba hidden."""
    for name in ("with", "without", "hiding"):
        (tmp_path / name).mkdir()
    text = "import sys; sys.modules['numba'] = None"
    (tmp_path / "hiding" / "sitecustomize.py").write_text(text, encoding="utf-8")
    ours, theirs = demo(tmp_path / "with"), demo(tmp_path / "without", tmp_path / "hiding")
    for name, sigma in ours["sigma"].items():
        assert abs(ours["params"][name] - theirs["params"][name]) <= 0.01 * sigma, name


def test_kernels_compile_where_nothing_can_be_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    from calibgui.engine.kernels import common

    def unkept(**options: object):  # type: ignore[no-untyped-def]
        if options.pop("cache", False):
            raise RuntimeError("cannot cache function: no locator available")
        return njit(**options)

    njit = common.njit
    monkeypatch.setattr(common, "njit", unkept)

    def doubled(x):  # type: ignore[no-untyped-def]
        return 2 * x

    assert common.compiled(doubled)(1.5) == 3.0

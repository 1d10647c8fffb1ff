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


def calibrate(photographs: Path, folder: Path, *paths: Path) -> dict[str, Any]:
    """The camera of photographs, from their pixels to the result."""
    result = folder / "result.json"
    command = ["calibrate", str(photographs), "--square", "30", "--quiet", "-o", str(result)]
    search = os.pathsep.join(map(str, [*paths, ROOT]))
    subprocess.run(
        [sys.executable, "-m", "calibgui", *command],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": search},
        check=True,
    )
    content = json.loads(result.read_text(encoding="utf-8"))
    return content["camera"]


@pytest.mark.slow
def test_without_numba_the_result_is_the_same(photographs: Path, tmp_path: Path) -> None:
    """In all processes: their interpreters start with numba hidden."""
    for name in ("with", "without", "hiding"):
        (tmp_path / name).mkdir()
    text = "import sys; sys.modules['numba'] = None"
    (tmp_path / "hiding" / "sitecustomize.py").write_text(text, encoding="utf-8")
    ours = calibrate(photographs, tmp_path / "with")
    theirs = calibrate(photographs, tmp_path / "without", tmp_path / "hiding")
    for name, sigma in ours["sigma"].items():
        assert abs(ours["params"][name] - theirs["params"][name]) <= 0.01 * sigma, name


def test_kernels_compile_where_nothing_can_be_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    from calibgui.engine.kernels import common

    def find_no_place(_: object) -> None:
        raise RuntimeError("cannot cache function: no locator available")

    monkeypatch.setattr(common, "KernelCache", find_no_place)

    def doubled(x):  # type: ignore[no-untyped-def]
        return 2 * x

    assert common.compiled(doubled)(1.5) == 3.0


_SEARCH_WITHOUT_NUMBA = (
    "from pathlib import Path\n"
    "from calibgui.app.photographs.detection import find_views\n"
    "from calibgui.engine import kernels\n"
    "sample = Path('resources/sample')\n"
    "assert kernels.COMPILED\n"
    "views = find_views(sorted(sample.glob('*.png'))[:3]).views\n"
    "assert not kernels.COMPILED\n"
    "print(*(view.status.value for view in views))\n"
)


@pytest.mark.parametrize(
    ("file", "content", "reason"),
    [
        ("numba.py", "raise ImportError('Numba needs NumPy 2.3')", "needs NumPy 2.3"),
        (
            "sitecustomize.py",
            "from numba.core.codegen import CPUCodeLibrary\n"
            "del CPUCodeLibrary._optimize_final_module",
            "_optimize_final_module",
        ),
    ],
    ids=["cannot be imported", "has another inside"],
)
def test_a_numba_that_cannot_be_used_is_said_once_and_done_without(
    file: str, content: str, reason: str, tmp_path: Path
) -> None:
    """As after an update of NumPy, or of numba, of whose inside kernels make use."""
    (tmp_path / file).write_text(content, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-c", _SEARCH_WITHOUT_NUMBA],
        cwd=ROOT,
        env=os.environ | {"PYTHONPATH": os.pathsep.join([str(tmp_path), str(ROOT)])},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert set(done.stdout.split()) == {"found"}
    assert done.stderr.count(reason) == 1

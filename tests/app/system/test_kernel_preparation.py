"""What is prepared is all that the corner finder needs, and what is compiled is every kernel."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from threading import Event

import pytest

from calibgui.app.system.kernel_preparation import compile_kernels
from calibgui.engine import kernels
from calibgui.engine.errors import Cancelled

SCRIPT = """
import sys
import numpy as np
from numba.core.dispatcher import Dispatcher
from calibgui.app.system.kernel_preparation import choose_preparation, prepare_finder
from calibgui.engine.boards import KINDS, AprilGrid, Board, Circles
from calibgui.engine.camera import Camera
from calibgui.engine.detection import find_corners
from calibgui.engine.images import read_image, render_view
from calibgui.engine.kernels import compile_missing
from tests.engine import scenes

def list_kernels():
    modules = [m for name, m in sys.modules.items() if "calibgui.engine.kernels." in name]
    return {
        (name, str(types))
        for m in modules
        for name, kernel in vars(m).items()
        if isinstance(kernel, Dispatcher)
        for types in kernel.signatures
    }

photograph = read_image(sys.argv[1]).pixels
v, u = np.indices(photograph.shape)
both = np.hstack([photograph, photograph])
uneven = photograph * (0.8 + 0.2 * np.sin(u / 12) * np.sin(v / 12))
camera = Camera((480, 360), [490.0, 493.0, 236.0, 182.0, 0.15, 0.03, 0.0, 3e-4, -4e-4, 0.0])
boards = [
    Board(7, 8, 30.0, Circles(diameter=0.4)),
    Board(9, 4, 15.0, Circles(True, 0.8)),
    Board(8, 8, 30.0, AprilGrid("t36h11", 0.25, 2, False)),
    Board(8, 8, 30.0, AprilGrid("t36h11", 0.3, 2, False, False)),
]
views = [
    render_view(
        camera,
        scenes.looking(camera, np.random.default_rng(1), fill=(0.5, 0.6), board=board),
        board,
        blur=0.7,
        noise=1.0,
    )
    for board in boards
]
waiting = compile_missing()
waiting.__enter__()
for depth in (np.uint8, np.uint16):
    prepare_finder(depth)
    prepared = list_kernels()
    find_corners(photograph.astype(depth))
    find_corners(uneven.astype(depth))
    find_corners(both.astype(depth))
    print(len(prepared), *sorted(list_kernels() - prepared))
    for board, view in zip(boards, views):
        choose_preparation(board.pattern)(depth)
        prepared = list_kernels()
        find_corners(view.astype(depth), pattern=KINDS[board.pattern.kind])
        print(len(prepared), *sorted(list_kernels() - prepared))
"""

UNUSED = """
from importlib import import_module
from pkgutil import iter_modules
from calibgui.app.system.kernel_preparation import ALL_PREPARATIONS
from calibgui.engine import kernels
from calibgui.engine.kernels.compilation import KernelCache

with kernels.compile_missing():
    for prepare in ALL_PREPARATIONS:
        prepare()
for each in iter_modules(kernels.__path__):
    module = import_module(f"{kernels.__name__}.{each.name}")
    for name, kernel in vars(module).items():
        is_kernel = isinstance(getattr(kernel, "_cache", None), KernelCache)
        if is_kernel and kernel.__module__ == module.__name__ and not kernel.signatures:
            print(each.name, name)
"""


def test_a_photograph_needs_no_kernel_that_is_not_prepared() -> None:
    pytest.importorskip("numba", reason="numba is not installed")
    root = Path(__file__).parents[3]
    photograph = root / "resources" / "sample" / "view01.png"
    command = [sys.executable, "-c", SCRIPT, str(photograph)]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=True)
    lines = done.stdout.splitlines()
    assert len(lines) == 10
    for line in lines:
        count, *missing = line.split(maxsplit=1)
        assert int(count) > 0
        assert not missing


@pytest.mark.slow
def test_what_is_prepared_calls_every_kernel() -> None:
    """A kernel that is not called is not compiled, and its module never counts as kept."""
    pytest.importorskip("numba", reason="numba is not installed")
    root = Path(__file__).parents[3]
    command = [sys.executable, "-c", UNUSED]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=True)
    assert not done.stdout


@pytest.mark.slow
def test_every_kernel_is_compiled_and_kept() -> None:
    pytest.importorskip("numba", reason="numba is not installed")
    parts: list[tuple[int, int]] = []
    compile_kernels(lambda done, total: parts.append((done, total)))
    assert parts == [(k + 1, len(parts)) for k in range(len(parts))]
    assert kernels.are_all_kept()


def test_compiling_ends_at_once_when_it_is_asked_to() -> None:
    stop = Event()
    stop.set()
    with pytest.raises(Cancelled):
        compile_kernels(stop=stop)

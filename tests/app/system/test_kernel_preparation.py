"""What is prepared is all that the corner finder needs for a photograph."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = """
import sys
import numpy as np
from numba.core.dispatcher import Dispatcher
from calibgui.app.system.kernel_preparation import prepare_finder
from calibgui.engine.detection import find_corners
from calibgui.engine.images import read_image

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
uneven = photograph * (0.8 + 0.2 * np.sin(u / 12) * np.sin(v / 12))
for depth in (np.uint8, np.uint16):
    prepare_finder(depth)
    prepared = list_kernels()
    find_corners(photograph.astype(depth))
    find_corners(uneven.astype(depth))
    print(len(prepared), *sorted(list_kernels() - prepared))
"""


def test_a_photograph_needs_no_kernel_that_is_not_prepared() -> None:
    pytest.importorskip("numba", reason="numba is not installed")
    root = Path(__file__).parents[3]
    photograph = root / "resources" / "sample" / "view01.png"
    command = [sys.executable, "-c", SCRIPT, str(photograph)]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=True)
    lines = done.stdout.splitlines()
    assert len(lines) == 2
    for line in lines:
        count, *missing = line.split(maxsplit=1)
        assert int(count) > 0
        assert not missing

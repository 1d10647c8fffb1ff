"""Memory that the window no longer needs is the system's again."""

from __future__ import annotations

import subprocess
import sys

import pytest

_FREE_AMONG_OTHERS = """
import numpy as np
from pathlib import Path
from calibgui.app.system.memory import return_large_blocks

def count_resident_pages():
    return int(Path("/proc/self/statm").read_text().split()[1])

{before}
np.ones(30 << 17)  # once 31 MB were freed, smaller blocks would be kept for others
start = count_resident_pages()
freed, kept = [], []
for _ in range({count}):
    freed.append(np.ones({bytes} // 8))
    kept.append(np.ones(1 << 12))  # it lies behind, so that the heap cannot shrink
freed.clear()
print((count_resident_pages() - start) * 4096 / 1e6 - {count} * (1 << 15) / 1e6)
"""


def measure_rest(count: int, size: int, before: str = "") -> float:
    """Measure what a program holds of blocks that it has freed between others, MB.

    Args:
        count: number of the blocks.
        size: their size, bytes.
        before: what the program does before it takes them.
    """
    code = _FREE_AMONG_OTHERS.format(count=count, bytes=size, before=before)
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True)
    return float(run.stdout)


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells what is resident")
@pytest.mark.parametrize(("count", "size"), [(20, 12_000_000), (160, 1_500_000)])
def test_what_is_freed_goes_back_to_the_system(count: int, size: int) -> None:
    rest = measure_rest(count, size, "return_large_blocks()")
    assert rest < 10.0, f"of 240 MB {measure_rest(count, size):.0f} stay by default"

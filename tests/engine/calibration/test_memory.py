"""Memory grows with the views by what is measured and returned of them, and little else."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]


def resident(views: int) -> float:
    """MB that a process holds at most while it calibrates this many views of 156 corners."""
    command = [sys.executable, "-m", "tests.benchmarks.memory", str(views)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return float(done.stdout.split()[0])


@pytest.mark.slow
def test_a_view_of_156_corners_takes_less_than_50_kb() -> None:
    """Its corners and residuals alone are 10 kB; 20,000 views would need 1 GB."""
    few, many = 2000, 6000
    assert resident(many) - resident(few) < 0.05 * (many - few)

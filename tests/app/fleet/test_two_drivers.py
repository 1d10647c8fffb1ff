"""Two programs that calibrate one fleet at the same time: one ledger, as if one had done it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.app.fleet.conftest import read_results, read_rows


@pytest.mark.slow
def test_two_drivers_share_a_ledger(fleet: Path, calibrated: Path, tmp_path: Path) -> None:
    ledger = tmp_path / "fleet.db"
    command = [sys.executable, "-m", "calibgui", "batch", str(fleet), "-o", str(ledger), "-q"]
    command += ["--square", "30", "--board", "6x7", "--workers", "1"]
    drivers = [
        subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        for _ in range(2)
    ]
    for driver in drivers:
        with driver:
            _, said = driver.communicate()
        assert (driver.returncode, said) == (0, "")
    assert read_results(ledger) == read_results(calibrated)
    # One was told the board's pattern, which the digest of its settings is of.
    assert [row.figures for row in read_rows(ledger)] == [
        row.figures for row in read_rows(calibrated)
    ]

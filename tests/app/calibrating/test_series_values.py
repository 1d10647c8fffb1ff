"""The table of a series' values: a line that lacks one is named."""

from __future__ import annotations

from pathlib import Path

import pytest

from calibgui.app.calibrating.series import Scalar, read_series
from calibgui.engine.errors import CalibrationError
from tests.faults.files.readers import GOLDEN


@pytest.mark.parametrize("line", ["result.json", "result.json,", ",35", "result.json,nan", "a,1_0"])
def test_a_line_without_file_or_value_is_named(tmp_path: Path, line: str) -> None:
    (tmp_path / "values.csv").write_text(f"file,value\n{line}\n")
    with pytest.raises(CalibrationError, match=r"values\.csv, line 2: there is no file with"):
        read_series([GOLDEN / "result-1.json"], Scalar.ZOOM, tmp_path / "values.csv")

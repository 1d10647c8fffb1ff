"""Tables of pixels: what is read, and what is refused by line."""

from __future__ import annotations

from pathlib import Path

import pytest

from calibgui.engine.errors import CalibrationError
from calibgui.formats.points_csv import read_points


@pytest.mark.parametrize("names", ["u,v", "u_px,v_px", "x,y"])
def test_columns_are_found_by_name(names: str, tmp_path: Path) -> None:
    file = tmp_path / "points.csv"
    file.write_text(f"id,{names},sigma_px\na,1,2.5,0.1\nb,-3,4e1,0.2\n")
    table = read_points(file)
    assert table.uv.tolist() == [[1, 2.5], [-3, 40]]
    assert table.sigma is not None
    assert table.sigma.tolist() == [0.1, 0.2]
    assert [row["id"] for row in table.others] == ["a", "b"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no columns u and v"),
        ("u,v\n", "no columns u and v"),
        ("a,b\n1,2\n", "no columns u and v"),
        ("u,v\n1,2\n1,up\n", "line 3: 'up' in the column v is not a number"),
        ("u,v\n1\n", "line 2: '' in the column v is not a number"),
        ("u,v\nnan,2\n", "line 2: 'nan'"),
        ("u,v,sigma_px\n1,2,-1\n", "line 2: sigma_px is below 0"),
    ],
)
def test_damaged_tables_are_refused_by_name(text: str, message: str, tmp_path: Path) -> None:
    file = tmp_path / "points.csv"
    file.write_text(text)
    with pytest.raises(CalibrationError, match=rf"points\.csv.*{message}"):
        read_points(file)

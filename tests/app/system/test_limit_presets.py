"""Presets of limits: those of the program, those of the user, and files."""

from __future__ import annotations

from pathlib import Path

import pytest

from calibgui.app.system import limit_presets
from calibgui.app.system.limit_presets import find_limits, list_presets
from calibgui.engine.errors import CalibrationError


@pytest.fixture(autouse=True)
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of the user's presets."""
    monkeypatch.setattr(limit_presets, "find_presets_folder", lambda: tmp_path / "limits")
    (tmp_path / "limits").mkdir()
    return tmp_path / "limits"


def test_the_programs_presets_demand_more_from_use_to_use() -> None:
    uses = [find_limits(name) for name in ("hobby-robot", "photogrammetry", "metrology")]
    assert len(list_presets()) == 3
    edges = [limits.largest_edge_error_px or 0.0 for limits in uses]
    views = [limits.fewest_views or 0.0 for limits in uses]
    assert edges == sorted(edges, reverse=True) and views == sorted(views)
    assert uses[-1].length is not None and uses[-1].name == "metrology"


def test_own_presets_take_the_place_of_the_programs(own: Path) -> None:
    (own / "metrology.toml").write_text("fewest_views = 99")
    (own / "line-3.toml").write_text("fewest_views = 3")
    assert find_limits("metrology").fewest_views == 99
    assert find_limits("line-3").fewest_views == 3


def test_a_file_is_named_as_well_as_a_preset(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text("fewest_views = 7")
    assert find_limits(str(file)).fewest_views == 7
    with pytest.raises(CalibrationError, match="no limits of the name 'mettrology'") as caught:
        find_limits("mettrology")
    assert "hobby-robot" in caught.value.hint and "limits" in caught.value.hint

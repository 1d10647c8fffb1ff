"""What a run of the benchmark leaves behind."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np

from tests.benchmarks.corner_partial import Count
from tests.benchmarks.corner_report import Report, Score, plot, write
from tests.benchmarks.corner_unseen import Outcome

FOUND = Score(1.04, 4.1, 0.3, 1.02, 1.0, 24.0)
MISSED = Score(math.nan, math.nan, math.nan, math.nan, 0.0, 36.0)
REPORT = Report(
    {"base": {"ours": FOUND, "other": FOUND}, "blur 5": {"ours": FOUND, "other": MISSED}},
    {"hand": [Count(50, 49, 0), Count(50, 50, 1)]},
    Outcome(3, 2, Count(160, 150, 2)),
    false_boards={"halftone": 1},
)


def test_every_figure_reads_back(tmp_path: Path) -> None:
    write(tmp_path / "new", REPORT)
    content = json.loads((tmp_path / "new" / "corners.json").read_text(encoding="utf-8"))
    assert content["accuracy"]["base"]["ours"]["rmse"] == 4.1
    assert content["accuracy"]["blur 5"]["other"]["ratio"] is None
    assert content["parts"]["hand"][1] == {"visible": 50, "found": 50, "wrong": 1}
    assert content["unseen"]["corners"]["found"] == 150
    assert content["false_boards"] == {"halftone": 1}
    assert (tmp_path / "new" / "corners.png").read_bytes().startswith(b"\x89PNG")


def test_the_plot_shows_every_method_under_every_condition() -> None:
    (axes,) = plot(REPORT.accuracy).axes
    lines = {line.get_label(): line.get_ydata() for line in axes.get_lines()}
    np.testing.assert_array_equal(lines["ours"], [1.04, 1.04])
    np.testing.assert_array_equal(lines["other"], [1.04, np.nan])
    assert [tick.get_text() for tick in axes.get_xticklabels()] == ["base", "blur 5"]
    assert axes.get_yscale() == "log"

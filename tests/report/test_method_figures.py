"""The picture of methods side by side: a map and a bar for each."""

from __future__ import annotations

import io
import math
from dataclasses import replace

from calibgui.report.method_figures import draw_method_comparison
from calibgui.report.methods import format_length, list_method_rows
from tests.report.compared_methods import compare_on_a_scene


def test_every_method_has_a_map_and_a_bar_on_shared_scales() -> None:
    comparison = compare_on_a_scene()
    figure = draw_method_comparison(comparison)
    figure.savefig(io.BytesIO(), format="png")
    rows = [row for row in list_method_rows(comparison) if row.kind != "refused"]
    maps = [axes for axes in figure.axes if axes.get_title()]
    assert [axes.get_title() for axes in maps] == [
        f"{row.name}  {format_length(row.difference_rms)}" for row in rows
    ]
    assert len({axes.images[0].norm for axes in maps}) == 1
    bars = next(axes for axes in figure.axes if axes.get_xlabel() == "RMS on unseen views, px")
    labels = [label.get_text() for label in bars.get_yticklabels()]
    assert labels == [row.name for row in rows if math.isfinite(row.unseen)]


def test_a_comparison_of_few_methods_can_be_drawn() -> None:
    comparison = compare_on_a_scene()
    trial = replace(comparison.trials["lucchese"], held_out=math.nan)
    alone = replace(comparison, trials={"lucchese": trial}, lines={})
    alone = replace(alone, methods={"lucchese": alone.methods["lucchese"]})
    draw_method_comparison(alone).savefig(io.BytesIO(), format="svg")

"""Figures of the paper, against the numbers that they show."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.features.corners import Corners
from calibgui.report.figures import EXTRINSIC_NAMES, draw_corners, draw_extrinsic_errors


def test_one_outlier_does_not_crush_the_extrinsic_errors() -> None:
    errors = np.random.default_rng(0).uniform(1e-6, 1e-5, (4, 6))
    errors[2, 4] = 0.5
    figure = draw_extrinsic_errors(errors, [1, 2, 4, 5], {"most": 0.0005, "all": 0.003})
    (axes,) = figure.axes
    assert axes.get_yscale() == "log"
    series = {line.get_label(): line for line in axes.lines}
    for name, column in zip(EXTRINSIC_NAMES, errors.T, strict=True):
        x, y = np.asarray(series[name].get_data(), dtype=np.float64)
        assert x.tolist() == [1, 2, 4, 5]
        np.testing.assert_allclose(y, 100 * column)
    lines = [line for line in axes.lines if line.get_label() not in EXTRINSIC_NAMES]
    bounds = [np.asarray(line.get_ydata(), dtype=np.float64)[0] for line in lines]
    assert bounds == pytest.approx([0.05, 0.3])
    assert [text.get_text() for text in axes.texts] == ["most", "all"]
    assert [text.get_text() for text in figure.legends[0].get_texts()] == [*EXTRINSIC_NAMES]


@pytest.mark.parametrize(("method", "title"), [("edges", "edges"), ("saddle", "saddle points")])
def test_figure_6_says_what_located_the_corners(method: str, title: str) -> None:
    uv = np.array([[3.0, 4.0], [8.0, 4.0]])
    found = Corners((1, 2), np.array([[0, 0], [0, 1]]), uv, uv + 1)
    figure = draw_corners(np.zeros((12, 16)), replace(found, method=method))
    first, second = figure.axes
    assert first.get_title() == "(a) first estimates"
    assert second.get_title() == f"(b) located by {title}"

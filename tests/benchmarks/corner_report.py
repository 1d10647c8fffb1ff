"""The corner benchmark's figures as JSON and as a plot."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from tests.benchmarks.corner_partial import Count
from tests.benchmarks.corner_unseen import Outcome


@dataclass
class Score:
    """Of one method under one condition."""

    ratio: float
    """RMS error per axis over the bound's."""
    rmse: float
    """1e-3 px."""
    bias: float
    """Larger component of the mean error, 1e-3 px."""
    chi2: float
    """Mean squared error in units of the reported covariance, per degree of freedom."""
    found: float
    """Share of boards with every corner in its place."""
    milliseconds: float


@dataclass
class Report:
    """Everything that one run of the benchmark measured."""

    accuracy: dict[str, dict[str, Score]]
    """By condition and method."""
    parts: dict[str, list[Count]]
    """By kind of partly seen board, its size stated and inferred."""
    unseen: Outcome
    false_boards: dict[str, int]
    """By kind of image."""


def write(folder: Path, report: Report) -> None:
    """corners.json and corners.png in `folder`; what could not be measured is null and a gap."""
    folder.mkdir(parents=True, exist_ok=True)
    text = json.dumps(_finite(asdict(report)), indent=1, allow_nan=False)
    (folder / "corners.json").write_text(text + "\n", encoding="utf-8")
    plot(report.accuracy).savefig(folder / "corners.png", dpi=110)


def summed_up(accuracy: dict[str, dict[str, Score]]) -> str:
    """A line per method: error over the bound, boards found and time over all conditions."""
    lines = [f"{'':14}{'median':>8}{'worst':>8}{'found':>8}{'ms':>8}"]
    for name in next(iter(accuracy.values())):
        scores = [row[name] for row in accuracy.values()]
        ratios = [score.ratio for score in scores]
        found = np.mean([score.found for score in scores])
        ms = np.nanmedian([score.milliseconds for score in scores])
        lines.append(
            f"{name:14}{np.nanmedian(ratios):8.2f}{np.nanmax(ratios):8.1f}{found:8.0%}{ms:8.0f}"
        )
    return "\n".join(lines)


def plot(accuracy: dict[str, dict[str, Score]]) -> Figure:
    """Error over the bound, by condition, a line per method."""
    figure = Figure(figsize=(11, 5), layout="constrained")
    axes = figure.add_subplot()
    methods = {name: None for row in accuracy.values() for name in row}
    for name in methods:
        axes.plot(list(accuracy), [row[name].ratio for row in accuracy.values()], "o-", label=name)
    axes.axhline(1.0, color="black", linewidth=0.8)
    axes.set_yscale("log")
    axes.set_ylabel("RMS error / Cramer-Rao bound")
    axes.tick_params(axis="x", rotation=70)
    figure.legend(loc="outside right upper")
    return figure


def _finite(value: Any) -> Any:
    """`value` with None for what is not a finite number, which JSON has no word for."""
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value

"""The figure of a series: every parameter against the scalar, drawn with matplotlib."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.figure import Figure

from calibgui.engine.assessment import Series

_COLUMNS, _PANEL_INCHES = 3, (3.2, 2.4)
_DATES = 3
"""Largest number of spaces between dates below a panel."""
_STEPS = 200
"""Number of values at which the function is drawn."""


def draw_series(series: Series, label: str, write: Callable[[float], str] | None = None) -> Figure:
    """Draw the estimated parameters with one standard deviation, and the function between them.

    Args:
        series: the series.
        label: name and unit of the scalar.
        write: writes a value of the scalar on the axes, as a date; as a number if None.
    """
    known = series.settings[0].known
    free = np.flatnonzero(np.diag(known.covariance) > 0)
    rows = -(-len(free) // _COLUMNS)
    width, height = _PANEL_INCHES
    figure = Figure(figsize=(width * _COLUMNS, height * rows), layout="constrained")
    panels = np.ravel(figure.subplots(rows, _COLUMNS, sharex=True))
    values = np.array([setting.value for setting in series.settings])
    between = np.linspace(values[0], values[-1], _STEPS)
    cameras = [series.predict(float(value)) for value in between]
    for panel, i in zip(panels, free, strict=False):
        middle = np.array([one.camera.params[i] for one in cameras])
        sigma = np.array([np.sqrt(one.covariance[i, i]) for one in cameras])
        panel.fill_between(between, middle - sigma, middle + sigma, alpha=0.3, linewidth=0)
        panel.plot(between, middle)
        panel.errorbar(
            values,
            [setting.known.camera.params[i] for setting in series.settings],
            [np.sqrt(setting.known.covariance[i, i]) for setting in series.settings],
            fmt="k.",
            capsize=2,
        )
        if write is not None:
            panel.locator_params(axis="x", nbins=_DATES)
            panel.xaxis.set_major_formatter(lambda value, _: write(value))
        panel.set_title(known.camera.names[i] + (", px" if i < 4 else ""))
    for panel in panels[len(free) :]:
        panel.set_visible(False)
    for panel in panels[max(len(free) - _COLUMNS, 0) : len(free)]:
        panel.set_xlabel(label)
        panel.tick_params(labelbottom=True)
    return figure

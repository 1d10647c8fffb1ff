"""Figures of a calibration's report, as SVG: what the corners cover, and what is left of them.

Texts are outlines, so that a page needs no font for them, and what would be thousands of marks is
a picture. The same calibration gives the same bytes.
"""

from __future__ import annotations

import io
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from calibgui.dataset import Result
from calibgui.engine.arrays import Array, Size
from calibgui.engine.assessment import stack_residuals
from calibgui.engine.camera import compute_displacement
from calibgui.engine.images import make_mesh
from calibgui.engine.uncertainty import ProjectionUncertainty
from calibgui.report.document import Picture

_HALF_INCHES, _FULL_INCHES = 3.5, 7.2
"""Widths of a figure that takes half of a page, and of one that takes all of it."""
_HEIGHT_INCHES = 2.6
_AXES, _AXES_BESIDE = (0.15, 0.17, 0.67, 0.77), (0.85, 0.22, 0.025, 0.67)
"""Left, bottom, width and height of a plot and of the scale of its colours, as shares."""
_STROKE_SHARE = 0.025
"""Share of the image's width that a residual of RMS length takes."""
_MAX_MARKS = 500
"""Number of marks above which they are a picture: as outlines they would take most of the file."""
_PICTURE_DPI = 300
_INK, _BLUE, _RED, _LINE = "#20262e", "#1f5fa8", "#b3372c", "#c9d0d8"
_STYLE: Any = {
    "font.size": 8,
    "axes.edgecolor": _LINE,
    "axes.labelcolor": _INK,
    "axes.linewidth": 0.7,
    "axes.titlesize": 8,
    "text.color": _INK,
    "xtick.color": _INK,
    "ytick.color": _INK,
    "xtick.major.width": 0.7,
    "ytick.major.width": 0.7,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "svg.fonttype": "path",
    "svg.hashsalt": "calibgui",
    "savefig.dpi": _PICTURE_DPI,
}


def draw_report_figures(result: Result, uncertainty: ProjectionUncertainty) -> list[Picture]:
    """Draw the figures that take half of the page's width each."""
    with mpl.rc_context(_STYLE):
        return [
            _draw_residual_map(result),
            Picture(_draw_scatter(result), "Residuals of all corners, one colour for each view."),
            Picture(
                _draw_distortion(result),
                "Displacement by the lens' distortion, px, with the centre.",
            ),
            Picture(
                _draw_uncertainty(result, uncertainty),
                "Uncertainty of where far points are imaged, one standard deviation, px.",
            ),
        ]


def draw_views(result: Result) -> Picture:
    """Draw the RMS of every view."""
    with mpl.rc_context(_STYLE):
        figure = Figure(figsize=(_FULL_INCHES, 1.7))
        axes = figure.add_axes((0.075, 0.26, 0.92, 0.7))
        rms = [view.rms for view in result.calibration.residuals]
        places = [k + 1 for k in result.places]
        axes.bar(places, rms, color=_BLUE, width=0.7)
        axes.axhline(float(np.sqrt(np.mean(np.square(rms)))), color=_RED, linewidth=0.8)
        axes.set(xlabel="photograph", ylabel="rms, px", xlim=(0.2, len(result.views) + 0.8))
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        axes.spines[["top", "right"]].set_visible(False)
        return Picture(
            _format_svg(figure), "RMS of the residuals in each view, and of all as a line."
        )


def _draw_residual_map(result: Result) -> Picture:
    """Draw where corners were seen, with their residuals as strokes."""
    figure, axes = _make_image_axes(result.calibration.camera.size)
    uv = np.concatenate([view.uv for view in result.observations()])
    off = stack_residuals(result.calibration, on_reference=False)
    typical = float(np.sqrt(np.mean(np.sum(off**2, axis=1)))) or 1.0
    times = _STROKE_SHARE * result.calibration.camera.size[0] / typical
    axes.quiver(
        *uv.T,
        *off.T,
        angles="xy",
        color=_BLUE,
        scale=1 / times,
        scale_units="xy",
        width=0.0028,
        headwidth=3,
        headlength=3,
        headaxislength=3,
        rasterized=len(uv) > _MAX_MARKS,
    )
    words = (
        f"Corners in all views with their residuals, {float(f'{times:.2g}'):,.0f} times as long."
    )
    return Picture(_format_svg(figure), words)


def _draw_scatter(result: Result) -> str:
    """Draw the residuals in their plane."""
    figure = Figure(figsize=(_HALF_INCHES, _HEIGHT_INCHES))
    axes = figure.add_axes(_AXES)
    residuals = [view.image for view in result.calibration.residuals]
    colours = colormaps["turbo"](np.linspace(0.05, 0.95, len(residuals)))
    points = np.concatenate(residuals)
    x, y = points.T
    axes.scatter(
        x,
        y,
        s=3,
        linewidths=0,
        c=np.repeat(colours, [len(view) for view in residuals], axis=0),
        rasterized=len(points) > _MAX_MARKS,
    )
    reach = 1.05 * float(np.abs(points).max()) or 1.0
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    axes.set(xlabel="along u, px", ylabel="along v, px")
    axes.grid(color=_LINE, linewidth=0.4)
    axes.xaxis.set_major_locator(MaxNLocator(4))
    return _format_svg(figure)


def _draw_distortion(result: Result) -> str:
    """Draw lines of equal displacement."""
    camera = result.calibration.camera
    figure, axes = _make_image_axes(camera.size)
    w, h = camera.size
    u, v = np.linspace(0, w - 1, 81), np.linspace(0, h - 1, 61)
    length = compute_displacement(make_mesh(u, v), camera).length
    _fill(figure, axes, u, v, length, "Blues")
    axes.plot(*camera.centre, "+", color=_RED, markersize=8)
    return _format_svg(figure)


def _draw_uncertainty(result: Result, found: ProjectionUncertainty) -> str:
    """Draw the map of the uncertainty."""
    figure, axes = _make_image_axes(result.calibration.camera.size)
    sigma = np.array(found.worst_direction)
    _fill(figure, axes, np.asarray(found.u), np.asarray(found.v), sigma, "YlOrBr")
    return _format_svg(figure)


def _make_image_axes(size: Size) -> tuple[Figure, Axes]:
    """Make a figure in the image's proportions, v down."""
    w, h = size
    figure = Figure(figsize=(_HALF_INCHES, _HEIGHT_INCHES))
    axes = figure.add_axes(_AXES)
    axes.set(xlim=(-0.5, w - 0.5), ylim=(h - 0.5, -0.5), aspect="equal")
    axes.set(xlabel="u, px", ylabel="v, px")
    return figure, axes


def _fill(figure: Figure, axes: Axes, u: Array, v: Array, values: Array, colours: str) -> None:
    """Fill between lines of equal value, up to four times the median."""
    known = np.ma.masked_invalid(values)
    top = float(min(known.max(), 4 * np.median(known.compressed()))) if known.count() else 0.0
    levels = MaxNLocator(8).tick_values(0.0, max(top, 1e-9))
    shown = axes.contourf(u, v, known, levels=levels, extend="max", cmap=colours)
    beside = figure.add_axes(_AXES_BESIDE)
    bar = figure.colorbar(shown, cax=beside, drawedges=False)
    bar.outline.set_visible(False)


def _format_svg(figure: Figure) -> str:
    """Return a figure as SVG that is the same each time."""
    file = io.StringIO()
    metadata = {"Date": None, "Creator": None, "Format": None, "Type": None}
    figure.savefig(file, format="svg", metadata=metadata)
    text = file.getvalue()
    return text[text.index("<svg") :]

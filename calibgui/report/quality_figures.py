"""Figures about the quality of a calibration, drawn with matplotlib; most are maps of the image."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator

from calibgui.engine.arrays import Array, Size
from calibgui.engine.assessment import CameraDifference
from calibgui.engine.calibration import Observation
from calibgui.engine.uncertainty import QUANTITIES, NextView, ProjectionUncertainty, ViewCountStudy
from calibgui.report.quality import describe_distance

_WIDTH_INCHES = 6.4
"""Width of a figure of one plot."""


def draw_projection_uncertainty(
    found: ProjectionUncertainty, views: Sequence[Observation], limit: float
) -> Figure:
    """Draw projection uncertainty, the region within `limit` px, and the corners."""
    figure, axes = _make_image_axes(found.size)
    sigma = np.array(found.worst_direction)
    _fill_contours(figure, axes, found.u, found.v, sigma, "one sigma, px")
    if np.nanmin(sigma) < limit < np.nanmax(sigma):
        axes.contour(found.u, found.v, sigma, levels=[limit], colors="red", linewidths=2)
        axes.plot([], [], color="red", linewidth=2, label=f"{limit:g} px")
        axes.legend(loc="upper right")
    for view in views:
        axes.plot(*view.uv.T, ".", color="white", markersize=1.0, alpha=0.5)
    axes.set_title(
        f"Uncertainty of where points {describe_distance(found.distance)} are imaged, "
        f"median {found.median:.2g} px"
    )
    return figure


def draw_camera_difference(found: CameraDifference) -> Figure:
    """Draw the difference of two cameras, with arrows from A to B and the region compared."""
    figure, axes = _make_image_axes(found.size)
    length = np.array(found.length)
    _fill_contours(figure, axes, found.u, found.v, length, "difference, px")
    if not found.region.all():
        axes.contour(
            found.u, found.v, found.region.astype(float), levels=[0.5], colors="red", linewidths=1.5
        )
    step = (slice(2, None, 4), slice(2, None, 4))
    u, v = np.meshgrid(found.u, found.v)
    du, dv = np.moveaxis(found.vector, -1, 0)
    axes.quiver(u[step], v[step], du[step], dv[step], angles="xy", color="white", width=0.003)
    axes.set_title(
        f"B against A for points {describe_distance(found.distance)}: "
        f"median {found.median:.2g} px, rms {found.rms:.2g} px"
    )
    return figure


def draw_number_of_views(study: ViewCountStudy, limit: float) -> Figure:
    """Draw one sigma of each quantity against the number of views."""
    figure = Figure(figsize=(2 * _WIDTH_INCHES, 4.2), layout="constrained")
    for column, (axes, name) in enumerate(zip(figure.subplots(1, 3), QUANTITIES, strict=True)):
        low, middle, high = study.random[:, :, column].T
        axes.fill_between(study.counts, low, high, color="0.85", label="random, 10 to 90 %")
        axes.plot(study.counts, middle, color="0.4", label="random, median")
        axes.plot(study.counts, study.chosen[:, column], color="tab:blue", label="well chosen")
        if column < study.scatter.shape[1]:
            axes.plot(
                study.counts, study.scatter[:, column], "o", color="tab:red", markersize=4,
                label="scatter of random sets, calibrated",
            )  # fmt: skip
        axes.axhline(limit, color="tab:green", linewidth=0.8, linestyle="--", label=f"{limit:g} px")
        axes.set(xscale="log", yscale="log", xlabel="views", ylabel="one sigma, px", title=name)
        _use_plain_numbers(axes)
        axes.grid(alpha=0.3, which="both")
    figure.axes[-1].legend(*figure.axes[0].get_legend_handles_labels(), fontsize=8)
    return figure


def draw_next_views(
    proposed: Sequence[NextView], views: Sequence[Observation], size: Size
) -> Figure:
    """Draw where to hold the board next, over the corners that there are."""
    figure, axes = _make_image_axes(size)
    for view in views:
        axes.plot(*view.uv.T, ".", color="0.75", markersize=1.5)
    for number, proposal in enumerate(proposed, start=1):
        colour = f"C{number - 1}"
        axes.plot(*proposal.corners.T, ".", color=colour, markersize=3)
        outline = proposal.corners[scipy.spatial.ConvexHull(proposal.corners).vertices]
        axes.fill(*outline.T, facecolor="none", edgecolor=colour, linewidth=1.8)
        axes.plot([], [], color=colour, label=f"{number}: to {proposal.after:.2g} px")
        box = {"facecolor": "white", "edgecolor": colour}
        u, v = proposal.corners.mean(axis=0)
        axes.text(u, v, str(number), color=colour, bbox=box)
    axes.legend(loc="upper right")
    axes.set(title="Where to hold the board next", xlim=(0, size[0] - 1), ylim=(size[1] - 1, 0))
    return figure


def _make_image_axes(size: Size) -> tuple[Figure, Axes]:
    """Make a figure in the image's proportions, v down."""
    w, h = size
    figure = Figure(
        figsize=(_WIDTH_INCHES * 1.2, 0.9 * _WIDTH_INCHES * h / w + 1.0), layout="constrained"
    )
    axes = figure.subplots()
    axes.set(aspect="equal", xlabel="u, px", ylabel="v, px")
    return figure, axes


def _fill_contours(
    figure: Figure, axes: Axes, u: Array, v: Array, values: Array, label: str
) -> None:
    """Draw filled contours up to a level that leaves the image's middle readable."""
    top = float(min(np.nanmax(values), 4 * np.nanmedian(values)))
    levels = MaxNLocator(12).tick_values(0.0, max(top, 1e-9))
    shown = axes.contourf(u, v, values, levels=levels, extend="max", cmap="viridis")
    axes.invert_yaxis()
    figure.colorbar(shown, ax=axes, label=label, shrink=0.85)


def _use_plain_numbers(axes: Axes) -> None:
    """Label logarithmic axes with plain numbers instead of powers of ten."""
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
        axis.set_minor_formatter(
            FuncFormatter(lambda x, _: f"{x:g}" if str(x).lstrip("0.")[:1] in "25" else "")
        )

"""Figures of the paper, drawn with matplotlib for pages and files (the window has its own plots).

Each function returns a Figure and saves nothing. The numbers of figures are the paper's.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from calibgui.engine.arrays import Array
from calibgui.engine.assessment import (
    Histogram,
    make_component_histogram,
    make_length_histogram,
    stack_residuals,
)
from calibgui.engine.boards import BoardShape
from calibgui.engine.calibration import Calibration, Iteration, StageOne, evaluate_cosines_equation
from calibgui.engine.camera import Camera, DisplacementPart, compute_displacement
from calibgui.engine.features import Corners
from calibgui.engine.geometry import centre_of_array
from calibgui.engine.images import make_mesh

Picture = npt.NDArray[np.generic]
"""(h, w) grey or (h, w, 3) colour image of any sample type."""

_WIDTH_INCHES = 6.4
"""Width of a figure of one plot."""
LOCATED_BY = {"edges": "edges", "saddle": "saddle points", "ellipses": "ellipses"}
"""What corners are located by, as a title says it, by the method of locating them."""
EXTRINSIC_NAMES = ("ω", "φ", "θ", "tX", "tY", "tZ")
"""Names of the external parameters in the order of `PaperPose.vector`."""
_SEARCHED_ASPECTS = np.linspace(0.6, 1.4, 801)
"""Aspect ratios over which the cosines' equation is drawn."""


def _make_single_axes(height: float = 4.2) -> tuple[Figure, Axes]:
    """Make a figure of one plot, `height` inches high."""
    figure = Figure(figsize=(_WIDTH_INCHES, height), layout="constrained")
    return figure, figure.subplots()


def draw_cosines_equation(stage_one: StageOne, view: int) -> Figure:
    """Draw figure 4: g(r) of one view (counted from 1) on the paper's grid, with its root."""
    figure, axes = _make_single_axes()
    axes.axhline(0, color="0.7", linewidth=0.8)
    g = evaluate_cosines_equation(stage_one.backward, _SEARCHED_ASPECTS, on_paper_grid=True)
    axes.plot(_SEARCHED_ASPECTS, g)
    root = stage_one.aspect
    if np.isfinite(root):
        axes.plot(root, 0, "o", color="tab:red", fillstyle="none", label=f"$r_0$ = {root:.4f}")
        axes.legend()
    axes.set(xlabel="pixel aspect ratio r = fy / fx", ylabel="g(r)", title=f"View {view}")
    return figure


def draw_aspect_ratios(stage_one: Sequence[StageOne]) -> Figure:
    """Draw figure 5: the aspect ratio that each view gives by itself."""
    figure, axes = _make_single_axes()
    aspect = np.array([row.aspect for row in stage_one])
    views = np.arange(1, len(aspect) + 1)
    axes.axhline(1, color="0.7", linewidth=0.8)
    axes.plot(views, aspect, "o-", markersize=4, linewidth=0.8)
    for view in views[~np.isfinite(aspect)]:
        axes.axvline(view, color="tab:orange", linewidth=0.8, linestyle=":")
    if not np.isfinite(aspect).all():
        axes.plot([], [], ":", color="tab:orange", label="not determined by this view")
        axes.legend()
    if np.isfinite(aspect).any():
        reach = max(0.1, 1.1 * float(np.nanmax(np.abs(aspect - 1))))
        axes.set_ylim(1 - reach, 1 + reach)
    axes.set(xlabel="view", ylabel="aspect ratio fy / fx")
    return figure


def draw_corners(image: Picture, found: Corners) -> Figure:
    """Draw figure 6: region of interest with first estimates (a) and refined corners (b)."""
    figure = Figure(figsize=(2 * _WIDTH_INCHES, 5.2), layout="constrained")
    for axes, points, colour, title in zip(
        figure.subplots(1, 2),
        (found.estimate, found.uv),
        ("red", "yellow"),
        ("(a) first estimates", f"(b) located by {LOCATED_BY[found.method]}"),
        strict=True,
    ):
        _show_image(axes, image)
        if found.roi is not None:
            axes.plot(*np.vstack([found.roi, found.roi[:1]]).T, color="yellow", linewidth=1)
        axes.plot(*points.T, "+", color=colour, markersize=5, markeredgewidth=0.8)
        axes.set_title(title)
    return figure


def draw_convergence(history: Sequence[Iteration], unit: str) -> Figure:
    """Draw figure 7: the cost of Stage II against its iterations."""
    figure, axes = _make_single_axes()
    axes.semilogy([i.index for i in history], [i.cost for i in history], "o-", markersize=4)
    axes.set(xlabel="iteration", ylabel=f"cost c, {unit}²")
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.grid(alpha=0.3, which="both")
    return figure


def draw_distortion(camera: Camera) -> Figure:
    """Draw figure 8: net corrective displacement, complete (a), radial (b), decentering (c)."""
    figure = Figure(figsize=(2.6 * _WIDTH_INCHES, 4.6), layout="constrained")
    w, h = camera.size
    u, v = np.linspace(0, w - 1, 161), np.linspace(0, h - 1, 121)
    uv = make_mesh(u, v)
    sparse = uv[10:-1:20, 10:-1:20]
    for axes, part, letter in zip(figure.subplots(1, 3), DisplacementPart, "abc", strict=True):
        length = compute_displacement(uv, camera, part).length
        shown = axes.imshow(length, extent=(-0.5, w - 0.5, h - 0.5, -0.5), cmap="gray")
        if np.ptp(length) > 0:
            levels = axes.contour(u, v, length, colors="tab:blue", linewidths=0.6)
            axes.clabel(levels, fontsize=7)
        gradient = compute_displacement(sparse, camera, part).gradient
        if gradient.any():  # arrows of no length have no scale
            axes.quiver(
                *np.moveaxis(sparse, -1, 0),
                *np.moveaxis(gradient, -1, 0),
                angles="xy",
                color="tab:green",
            )
        axes.plot(*centre_of_array(camera.size), "+", color="yellow", markersize=12)
        axes.plot(*camera.centre, "x", color="red", markersize=9)
        axes.set(title=f"({letter}) {part}", xlabel="u, px", ylabel="v, px")
        figure.colorbar(shown, ax=axes, label="displacement d, px", shrink=0.75)
    return figure


def draw_image_pair(left: Picture, right: Picture, titles: tuple[str, str]) -> Figure:
    """Draw two grey images side by side (figures 9 and 13)."""
    figure = Figure(figsize=(2 * _WIDTH_INCHES, 5.2), layout="constrained")
    for axes, image, title in zip(figure.subplots(1, 2), (left, right), titles, strict=True):
        _show_image(axes, image)
        axes.set_title(title)
    return figure


def superpose_images(real: Picture, synthetic: Picture) -> Picture:
    """Superpose two images (h, w) as (h, w, 3), green and magenta, which is grey if they agree."""
    return np.stack([synthetic, real, synthetic], axis=-1)


def draw_residual_scatter(calibration: Calibration, on_reference: bool = True) -> Figure:
    """Draw the residuals of all corners, coloured by view (figures 10 and 15)."""
    figure, axes = _make_single_axes(5.2)
    colours = colormaps["turbo"](np.linspace(0.05, 0.95, len(calibration.residuals)))
    for colour, view in zip(colours, calibration.residuals, strict=True):
        points = view.reference if on_reference else view.image
        axes.plot(*points.T, ".", color=colour, markersize=2.5)
    reach = 1.05 * float(np.nanmax(np.abs(stack_residuals(calibration, on_reference))))
    names = ("Δx′", "Δy′", "reference px") if on_reference else ("Δu", "Δv", "px")
    axes.set(
        xlim=(-reach, reach),
        ylim=(-reach, reach),
        aspect="equal",
        xlabel=f"{names[0]}, {names[2]}",
        ylabel=f"{names[1]}, {names[2]}",
    )
    axes.grid(alpha=0.3)
    return figure


def draw_residual_histograms(calibration: Calibration, on_reference: bool = True) -> Figure:
    """Draw the residuals' histograms with their fits (figures 11, 12 and 16)."""
    residuals = stack_residuals(calibration, on_reference)
    names = ("Δx′", "Δy′", "e′") if on_reference else ("Δu", "Δv", "e")
    unit = "reference px" if on_reference else "px"
    histograms = (
        make_component_histogram(residuals[:, 0]),
        make_component_histogram(residuals[:, 1]),
        make_length_histogram(np.linalg.norm(residuals, axis=1)),
    )
    figure = Figure(figsize=(2.2 * _WIDTH_INCHES, 3.8), layout="constrained")
    for axes, histogram, name in zip(figure.subplots(1, 3), histograms, names, strict=True):
        _draw_histogram(axes, histogram)
        beyond = f" ({histogram.outside} farther out)" if histogram.outside else ""
        axes.set(xlabel=f"{name}, {unit}{beyond}", ylabel=f"density, 1/{unit}")
    return figure


def draw_extrinsic_errors(
    errors: Array, views: Sequence[int], bounds: Mapping[str, float]
) -> Figure:
    """Draw figure 14: relative errors of the external parameters (eq. 51), on a logarithmic axis.

    Args:
        errors: (K, 6) fractions, in the order of `EXTRINSIC_NAMES`.
        views: (K,) numbers of the views.
        bounds: fractions to draw as lines, by what is written at them.
    """
    figure, axes = _make_single_axes(4.8)
    for marker, name, column in zip("osD^v+", EXTRINSIC_NAMES, errors.T, strict=True):
        axes.semilogy(views, 100 * column, marker, label=name, markersize=4)
    for text, bound in bounds.items():
        axes.axhline(100 * bound, color="0.4", linewidth=0.8, linestyle="--")
        beside = axes.get_yaxis_transform()
        axes.text(1.01, 100 * bound, text, transform=beside, va="center", fontsize="small")
    axes.set(xlabel="view", ylabel="relative error of an external parameter, %")
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.yaxis.set_major_formatter(lambda x, _: f"{x:.9f}".rstrip("0").rstrip("."))
    axes.grid(alpha=0.3)
    figure.legend(loc="outside upper center", ncols=len(EXTRINSIC_NAMES))
    return figure


def draw_board_shape(board_shape: BoardShape) -> Figure:
    """Draw the estimated deviations of a board's corners: arrows in its plane, colour out of it."""
    figure, axes = _make_single_axes(5.2)
    d, places = board_shape.deviation, board_shape.nominal
    reach = float(np.abs(d[:, 2]).max()) or 1.0
    x, y = places.T
    dots = axes.scatter(x, y, c=d[:, 2], cmap="coolwarm", vmin=-reach, vmax=reach, s=36)
    longest = float(np.linalg.norm(d[:, :2], axis=1).max())
    if longest > 0:
        arrows = axes.quiver(x, y, *d[:, :2].T, angles="xy", width=0.003)
        axes.quiverkey(arrows, 0.88, 1.03, longest, f"{longest:.2g} mm", labelpos="E")
    axes.set(aspect="equal", xlabel="X on the board, mm", ylabel="Y on the board, mm")
    axes.margins(0.12)
    axes.invert_yaxis()
    axes.set_title(f"{board_shape.model} shape, {board_shape.rms:.2g} mm rms", loc="left")
    figure.colorbar(dots, label="out of the plane, away from the camera, mm", shrink=0.8)
    return figure


def _show_image(axes: Axes, image: Picture) -> None:
    axes.imshow(image, cmap="gray", interpolation="nearest")
    axes.set(xlabel="u, px", ylabel="v, px")


def _draw_histogram(axes: Axes, histogram: Histogram) -> None:
    axes.stairs(histogram.density, histogram.edges, fill=True, color="0.8")
    x = np.linspace(histogram.edges[0], histogram.edges[-1], 400)
    law = "Rayleigh" if histogram.is_rayleigh else "Gaussian"
    axes.plot(x, histogram.evaluate_density(x), color="tab:red", linewidth=1.2, label=law)
    axes.set_title(f"mean {histogram.mean:.4f}, SD {histogram.sd:.4f}")
    axes.legend(loc="upper right")

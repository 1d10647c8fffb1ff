"""The paper's figures, drawn with matplotlib for pages and files (the window has its own plots).

Each function returns a Figure and knows nothing of where it goes. Numbers in the names are
the paper's.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from calibgui.engine.arrays import Array
from calibgui.engine.assessment import Histogram, component_histogram, length_histogram, stacked
from calibgui.engine.boards import BoardShape
from calibgui.engine.calibration import Calibration, Iteration, StageOne, cosines_equation
from calibgui.engine.camera import Camera, Part, displacement
from calibgui.engine.detection import Corners
from calibgui.engine.geometry import centre_of_array
from calibgui.engine.images import mesh

Picture = npt.NDArray[np.generic]
"""(h, w) grey or (h, w, 3) colour image of any sample type."""

_WIDTH = 6.4
_SEARCHED = np.linspace(0.6, 1.4, 801)


def _single(height: float = 4.2) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(_WIDTH, height), layout="constrained")
    return figure, figure.subplots()


def draw_cosines_equation(stage_one: StageOne, view: int, literal: bool) -> Figure:
    """Figure 4: g(r) of one view (counted from 1) with its root."""
    figure, axes = _single()
    axes.axhline(0, color="0.7", linewidth=0.8)
    axes.plot(_SEARCHED, cosines_equation(stage_one.backward, _SEARCHED, literal))
    root = stage_one.aspect
    if np.isfinite(root):
        axes.plot(root, 0, "o", color="tab:red", fillstyle="none", label=f"$r_0$ = {root:.4f}")
        axes.legend()
    axes.set(xlabel="pixel aspect ratio r = fy / fx", ylabel="g(r)", title=f"View {view}")
    return figure


def aspect_ratios(stage_one: Sequence[StageOne]) -> Figure:
    """Figure 5: the aspect ratio that each view gives by itself."""
    figure, axes = _single()
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


def corners(image: Picture, found: Corners) -> Figure:
    """Figure 6: region of interest with first estimates (a) and refined corners (b)."""
    figure = Figure(figsize=(2 * _WIDTH, 5.2), layout="constrained")
    for axes, points, colour, title in zip(
        figure.subplots(1, 2),
        (found.estimate, found.uv),
        ("red", "yellow"),
        ("(a) first estimates", "(b) saddle points"),
        strict=True,
    ):
        _show_image(axes, image)
        if found.roi is not None:
            axes.plot(*np.vstack([found.roi, found.roi[:1]]).T, color="yellow", linewidth=1)
        axes.plot(*points.T, "+", color=colour, markersize=5, markeredgewidth=0.8)
        axes.set_title(title)
    return figure


def convergence(history: Sequence[Iteration], unit: str) -> Figure:
    """Figure 7: the cost of Stage II against its iterations."""
    figure, axes = _single()
    axes.semilogy([i.index for i in history], [i.cost for i in history], "o-", markersize=4)
    axes.set(xlabel="iteration", ylabel=f"cost c, {unit}²")
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.grid(alpha=0.3, which="both")
    return figure


def distortion(camera: Camera) -> Figure:
    """Figure 8: net corrective displacement, complete (a), radial (b) and decentering (c)."""
    figure = Figure(figsize=(2.6 * _WIDTH, 4.6), layout="constrained")
    w, h = camera.size
    u, v = np.linspace(0, w - 1, 161), np.linspace(0, h - 1, 121)
    uv = mesh(u, v)
    sparse = uv[10:-1:20, 10:-1:20]
    for axes, part, letter in zip(figure.subplots(1, 3), Part, "abc", strict=True):
        length = displacement(uv, camera, part).length
        shown = axes.imshow(length, extent=(-0.5, w - 0.5, h - 0.5, -0.5), cmap="gray")
        if np.ptp(length) > 0:
            levels = axes.contour(u, v, length, colors="tab:blue", linewidths=0.6)
            axes.clabel(levels, fontsize=7)
        gradient = displacement(sparse, camera, part).gradient
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


def image_pair(left: Picture, right: Picture, titles: tuple[str, str]) -> Figure:
    """Figures 9 and 13: two grey images side by side."""
    figure = Figure(figsize=(2 * _WIDTH, 5.2), layout="constrained")
    for axes, image, title in zip(figure.subplots(1, 2), (left, right), titles, strict=True):
        _show_image(axes, image)
        axes.set_title(title)
    return figure


def superposed(real: Picture, synthetic: Picture) -> Picture:
    """(H, W, 3) the real image in green over the synthetic in magenta: grey where they agree."""
    return np.stack([synthetic, real, synthetic], axis=-1)


def residual_scatter(calibration: Calibration, on_reference: bool = True) -> Figure:
    """Figures 10 and 15: residuals of all corners, coloured by view."""
    figure, axes = _single(5.2)
    colours = colormaps["turbo"](np.linspace(0.05, 0.95, len(calibration.residuals)))
    for colour, view in zip(colours, calibration.residuals, strict=True):
        points = view.reference if on_reference else view.image
        axes.plot(*points.T, ".", color=colour, markersize=2.5)
    reach = 1.05 * float(np.nanmax(np.abs(stacked(calibration, on_reference))))
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


def residual_histograms(calibration: Calibration, on_reference: bool = True) -> Figure:
    """Figures 11, 12 and 16: components with Gaussian fits, lengths with a Rayleigh fit."""
    residuals = stacked(calibration, on_reference)
    names = ("Δx′", "Δy′", "e′") if on_reference else ("Δu", "Δv", "e")
    unit = "reference px" if on_reference else "px"
    histograms = (
        component_histogram(residuals[:, 0]),
        component_histogram(residuals[:, 1]),
        length_histogram(np.linalg.norm(residuals, axis=1)),
    )
    figure = Figure(figsize=(2.2 * _WIDTH, 3.8), layout="constrained")
    for axes, histogram, name in zip(figure.subplots(1, 3), histograms, names, strict=True):
        _draw_histogram(axes, histogram)
        axes.set(xlabel=f"{name}, {unit}", ylabel=f"density, 1/{unit}")
    return figure


def extrinsic_errors(errors: Array) -> Figure:
    """Figure 14: relative errors of the external parameters (eq. 51), a fraction."""
    figure, axes = _single()
    axes.hist(100 * errors, bins=50, color="0.7")
    axes.set(xlabel="relative error of an external parameter, %", ylabel="count")
    return figure


def board_shape_deviations(board_shape: BoardShape) -> Figure:
    """Where the corners of an estimated plate are: arrows in the plane, colour out of it."""
    figure, axes = _single(5.2)
    d, places = board_shape.deviation, board_shape.nominal
    reach = float(np.abs(d[:, 2]).max()) or 1.0
    x, y = places.T
    dots = axes.scatter(x, y, c=d[:, 2], cmap="coolwarm", vmin=-reach, vmax=reach, s=36)
    longest = float(np.linalg.norm(d[:, :2], axis=1).max())
    if longest > 0:
        arrows = axes.quiver(x, y, *d[:, :2].T, angles="xy", width=0.003)
        axes.quiverkey(arrows, 0.88, 1.03, longest, f"{longest:.2g} mm", labelpos="E")
    axes.set(aspect="equal", xlabel="X on the plate, mm", ylabel="Y on the plate, mm")
    axes.margins(0.12)
    axes.invert_yaxis()
    axes.set_title(f"{board_shape.model} plate, {board_shape.rms:.2g} mm rms", loc="left")
    figure.colorbar(dots, label="out of the plane, away from the camera, mm", shrink=0.8)
    return figure


def _show_image(axes: Axes, image: Picture) -> None:
    axes.imshow(image, cmap="gray", interpolation="nearest")
    axes.set(xlabel="u, px", ylabel="v, px")


def _draw_histogram(axes: Axes, histogram: Histogram) -> None:
    axes.stairs(histogram.density, histogram.edges, fill=True, color="0.8")
    x = np.linspace(histogram.edges[0], histogram.edges[-1], 400)
    law = "Rayleigh" if histogram.rayleigh else "Gaussian"
    axes.plot(x, histogram.fitted(x), color="tab:red", linewidth=1.2, label=law)
    axes.set_title(f"mean {histogram.mean:.4f}, SD {histogram.sd:.4f}")
    axes.legend(loc="upper right")

"""Draw the manual's figures: boards, photographs, and what a calibration can be trusted with.

Usage: python packaging/make_figures.py [NAME ...], from anywhere; writes resources/manual/images/.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import scipy
from make_sample import BLUR, BOARD, CAMERA, LOOK, NOISE, draw_photograph, place_board
from matplotlib.collections import PatchCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle

from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.outputs.output_files import save_figure
from calibgui.app.outputs.printable_board import complete_pattern, lay_out_page
from calibgui.app.photographs.detection import find_views
from calibgui.app.photographs.paths import find_images
from calibgui.engine.assessment import compare_cameras, screen_outliers
from calibgui.engine.boards import KINDS, Board, ListedCircles
from calibgui.engine.calibration import Observation, calibrate
from calibgui.engine.camera import Camera, pixels_from_rays
from calibgui.engine.geometry import rotation_from_vector
from calibgui.engine.images import read_image, render_view
from calibgui.engine.uncertainty import (
    estimate_projection_uncertainty,
    propose_views,
    study_number_of_views,
)
from calibgui.report import figures, quality_figures

RESOURCES = Path(__file__).resolve().parents[1] / "resources"
SQUARE = 25.0
"""Side of a square of the sample's board, mm."""
_RULER = 6
"""Number of rectangles of the scale bar below a board, which come last on its page."""


def draw_bent_board() -> Figure:
    """Draw a board, bowed by 0.2 mm and printed 0.1 mm unevenly, as 20 noisy views show it."""
    rng = np.random.default_rng(1)
    board = Board(rows=7, cols=10, square=SQUARE)
    xy = board.points()
    far = (xy - xy.mean(axis=0)) / xy.max()
    bend = np.column_stack([0.1 * np.sin(5 * far[:, ::-1]), 0.6 * (far**2).sum(axis=1)])
    camera = Camera((640, 480), [660, 661, 309, 246, 0.27, 0.11, -0.06, -4e-4, 6e-4, 0])
    views = []
    for _ in range(20):
        R = rotation_from_vector(rng.uniform(-0.6, 0.6, 3))
        point = (np.column_stack([xy - xy.mean(axis=0), np.zeros(len(xy))]) + bend) @ R.T
        point = point + rng.uniform([-20, -20, 300], [20, 20, 400])
        uv = pixels_from_rays(point, camera)
        views.append(Observation(uv + rng.normal(0, 0.03, uv.shape), xy))
    board_shape = calibrate(views, camera.size, board_shape="free").board_shape
    assert board_shape is not None
    return figures.draw_board_shape(board_shape)


def draw_misplaced_corners(
    images: Sequence[str], views: Sequence[Observation], truth: Camera
) -> Figure:
    """Move one corner in twenty by 3 to 50 px, and draw one image and the effect on the camera.

    Args:
        images: paths of the images.
        views: their true corners.
        truth: camera that took the images.
    """
    rng = np.random.default_rng(4)
    spoilt, moved = [], []
    for uv, xy, _ in views:
        angle, far = rng.uniform(0, 2 * np.pi, len(uv)), rng.uniform(3, 50, len(uv))
        chosen = rng.random(len(uv)) < 0.05
        shift = np.column_stack([np.cos(angle), np.sin(angle)]) * (far * chosen)[:, None]
        spoilt.append(Observation(uv + shift, xy))
        moved.append(chosen)
    screening = screen_outliers(spoilt, truth.size)
    found = {
        "as they are": (calibrate(views, truth.size), "tab:green"),
        "5 % misplaced": (calibrate(spoilt, truth.size), "tab:red"),
        "the same, --robust": (screening.calibration, "tab:blue"),
    }
    figure = Figure(figsize=(11.0, 4.4), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.25, 1))
    worst = int(np.argmax([np.count_nonzero(chosen) for chosen in moved]))
    left.imshow(read_image(images[worst]).pixels, cmap="gray", vmin=0, vmax=255)
    kept, there, here = np.array(screening.kept[worst]), views[worst].uv, spoilt[worst].uv
    left.plot(*here[kept].T, "o", color="tab:blue", markersize=4, label="kept")
    left.plot(
        *np.stack([there[~kept], here[~kept]]).transpose(2, 0, 1), color="tab:red", linewidth=1
    )
    left.plot(*here[~kept].T, "x", color="tab:red", markersize=8, mew=2, label="left out")
    left.set(title=f"{Path(images[worst]).name}, corners", xticks=[], yticks=[])
    left.legend(loc="lower right")
    names, places = ("fx", "fy", "cx", "cy"), np.arange(4)
    for row, (label, (calibration, colour)) in enumerate(found.items()):
        right.errorbar(
            calibration.camera.params[:4] - truth.params[:4], places + 0.2 * (row - 1),
            xerr=calibration.sigma[:4], fmt="o", color=colour, capsize=3, label=label,
        )  # fmt: skip
    right.axvline(0, color="0.7", linewidth=0.8)
    right.set_xscale("symlog", linthresh=1.0)
    ticks = [-10, -1, 0, 1, 10]
    right.set_xticks(ticks, [str(tick) for tick in ticks])
    right.set(yticks=places, yticklabels=names, xlabel="off the truth, px (± one sigma)")
    right.invert_yaxis()
    right.grid(alpha=0.3, axis="x")
    right.legend(fontsize=8)
    rejected = np.concatenate([~good for good in screening.kept])
    wrong = np.concatenate(moved)
    right.set_title(
        f"{np.count_nonzero(rejected & wrong)} of {np.count_nonzero(wrong)} misplaced corners "
        f"left out, and {np.count_nonzero(rejected & ~wrong)} of {np.count_nonzero(~wrong)} others"
    )
    return figure


def draw_lens_models() -> Figure:
    """Draw how far lens models are from a simulated lens of 190 degrees, by the angle."""
    truth = Camera((1280, 960), [372, 371, 642, 476, -0.04, 3e-3, -2e-3, 1e-4], "kannala-brandt")
    views = photograph_all_around(truth)
    angle = np.deg2rad(np.linspace(0.5, 95, 190))
    around = np.deg2rad(np.arange(0, 360, 15.0))[:, None]
    rays = np.stack(
        [
            np.sin(angle) * np.cos(around),
            np.sin(angle) * np.sin(around),
            np.cos(angle) * np.ones_like(around),
        ],
        axis=-1,
    )
    figure = Figure(figsize=(9, 4.2), layout="constrained")
    axes = figure.add_subplot()
    for model in ("brown-conrady", "lucchese", "division", "scaramuzza", "ucm", "kannala-brandt"):
        camera = calibrate(views, truth.size, model=model).camera
        uv = pixels_from_rays(rays, truth)
        turn = rotation_from_vector(compare_cameras(truth, camera, views=views).turn)
        miss = np.linalg.norm(pixels_from_rays(rays @ turn.T, camera) - uv, axis=-1)
        axes.semilogy(np.rad2deg(angle), np.sqrt(np.mean(miss**2, axis=0)), label=model)
    axes.axvline(90, color="0.6", linestyle=":")
    axes.set(
        xlabel="angle off the axis, degrees",
        ylabel="distance from the true image, px",
        xlim=(0, 95),
        ylim=(1e-3, 300),
    )
    axes.grid(alpha=0.3)
    figure.legend(loc="outside right center", fontsize=9)
    return figure


def photograph_all_around(camera: Camera) -> list[Observation]:
    """Return noisy views of boards held all around a fisheye camera, 0.1 px of noise."""
    rng = np.random.default_rng(2)
    xy = Board(rows=9, cols=12, square=SQUARE).points()
    views = []
    while len(views) < 24:
        azimuth, off = rng.uniform(0, 2 * np.pi), rng.uniform(0, np.deg2rad(80))
        towards = rotation_from_vector(off * np.array([-np.sin(azimuth), np.cos(azimuth), 0.0]))
        R = towards @ rotation_from_vector(rng.uniform(-0.5, 0.5, 3))
        point = (xy - xy.mean(axis=0)) @ R[:, :2].T + towards[:, 2] * rng.uniform(150, 260)
        uv = pixels_from_rays(point, camera)
        seen = (np.abs(uv - np.array(camera.size) / 2) < np.array(camera.size) / 2).all(axis=1)
        off_axis = np.arctan2(np.linalg.norm(point[:, :2], axis=1), point[:, 2])
        seen &= off_axis < np.deg2rad(95)
        if seen.sum() > 40:
            views.append(Observation(uv[seen] + rng.normal(0, 0.1, (seen.sum(), 2)), xy[seen]))
    return views


def draw_boards() -> Figure:
    """Draw a board of each kind with its name on the command line."""
    sizes = {"aprilgrid": (6, 8), "puzzleboard": (7, 9), "asymmetric-circles": (9, 5)}
    figure = Figure(figsize=(11.0, 5.6), layout="constrained")
    for axes, (kind, pattern) in zip(figure.subplots(2, 4).flat, KINDS.items(), strict=True):
        grid_size = sizes.get(kind, (6, 9))
        if isinstance(pattern, ListedCircles):
            rows = [np.arange(9 - k % 2) + 0.5 * (k % 2) for k in range(6)]
            places = [(x, y) for y, row in enumerate(rows) for x in row]
            pattern = replace(pattern, places=tuple(places))
            grid_size = pattern.grid_size
        page = lay_out_page(Board(*grid_size, 20.0, complete_pattern(pattern, grid_size)), "A2")
        shapes = [Rectangle((x, y), w, h) for x, y, w, h in page.rectangles[:-_RULER]]
        discs = [Circle((x, y), r) for x, y, r in page.discs]
        blanks = [Circle((x, y), r) for x, y, r in page.white_discs]
        axes.add_collection(PatchCollection([*shapes, *discs], facecolor="black"))
        axes.add_collection(PatchCollection(blanks, facecolor="white"))
        axes.autoscale_view()
        axes.set_aspect("equal")
        axes.invert_yaxis()
        axes.set_axis_off()
        axes.set_title(kind, fontsize=11)
    return figure


def draw_photographs() -> Figure:
    """Draw photographs that help and others that do not, each with the reason."""
    rng = np.random.default_rng(1)
    v, u = np.mgrid[:480, :640]
    glare = np.exp(-((u - 350) ** 2 + (v - 200) ** 2) / (2 * 90.0**2))
    tilted, corner, near, turned = 2, 6, 1, 14
    """Numbers of the sample's photographs."""
    far = place_board((0, 0, 2, 0, 0, 1300))
    pictures = {
        "tilted, half of the image": draw_photograph(tilted),
        "in a corner of the image": draw_photograph(corner),
        "to the edge, tilted another way": draw_photograph(10),
        "turned by 90 degrees": draw_photograph(turned),
        "too far away, not tilted": render_view(
            CAMERA, far, BOARD, blur=BLUR, noise=NOISE, seed=1, appearance=LOOK
        ),
        "moved while it was taken": scipy.ndimage.uniform_filter1d(draw_photograph(tilted), 19),
        "a reflection on the board": np.clip(draw_photograph(near) + 320 * glare, 0, 255),
        "too dark": np.clip(draw_photograph(3) * 0.1 + rng.normal(0, 4, (480, 640)), 0, 255),
    }
    figure = Figure(figsize=(11.0, 4.9), layout="constrained")
    for k, (axes, (reason, picture)) in enumerate(
        zip(figure.subplots(2, 4).flat, pictures.items(), strict=True)
    ):
        axes.imshow(picture, cmap="gray", vmin=0, vmax=255)
        axes.set(xticks=[], yticks=[])
        axes.set_title(f"{'✓' if k < 4 else '✗'}  {reason}", fontsize=10)
        for spine in axes.spines.values():
            spine.set(color="tab:green" if k < 4 else "tab:red", linewidth=3)
    return figure


def draw_from_sample() -> dict[str, Figure]:
    """Draw what a calibration of the bundled sample can be trusted with."""
    images = find_images([str(RESOURCES / "sample")])
    result = calibrate_views(find_views(images).corner_set(SQUARE))
    calibration, views = result.calibration, result.observations()
    size = calibration.camera.size
    halves = [calibrate(views[start::2], size).camera for start in (0, 1)]
    pictures = {
        "uncertainty": quality_figures.draw_projection_uncertainty(
            estimate_projection_uncertainty(calibration, views), views, 0.01
        ),
        "difference": quality_figures.draw_camera_difference(compare_cameras(*halves)),
        "views": quality_figures.draw_number_of_views(
            study_number_of_views(calibration, views, solved=20), 0.03
        ),
        "next-views": quality_figures.draw_next_views(
            propose_views(calibration, views), views, size
        ),
    }
    truth = json.loads((RESOURCES / "sample" / "truth.json").read_text())["camera"]
    camera = Camera(size, list(truth["params"].values()))
    pictures["robust"] = draw_misplaced_corners([v.image for v in result.used], views, camera)
    return pictures


def main() -> None:
    """Draw all figures, or those that are named, and save them."""
    names = set(sys.argv[1:])
    alone = {
        "boards": draw_boards,
        "good-and-bad": draw_photographs,
        "board-shape": draw_bent_board,
        "lens-models": draw_lens_models,
    }
    pictures = {name: draw() for name, draw in alone.items() if not names or name in names}
    if not names or names - alone.keys():
        pictures |= draw_from_sample()
    for name, figure in pictures.items():
        if not names or name in names:
            save_figure(figure, RESOURCES / "manual" / "images" / f"{name}.png")


if __name__ == "__main__":
    main()

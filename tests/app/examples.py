"""A small finished project, without image files."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.calibrating.settings import Settings
from calibgui.app.projects.project import Project, add_result
from calibgui.dataset import CornerSet, Result, View, ViewStatus
from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.features.corners import Corners
from tests.engine import scenes

BOARD = Board(rows=6, cols=7, square=30.0)
CAMERA = Camera((200, 150), [200.0, 204.0, 97.0, 76.0, 0.2, 0.05, 0.0, 1e-3, -1e-3, 0.0])


@cache
def views(folder: Path) -> tuple[View, ...]:
    """Six views with corners, and an image without a board."""
    return tuple(replace(view, image=str(folder / view.image)) for view in _draw_views())


@cache
def calibrated(folder: Path) -> Project:
    """A project of those views with two results."""
    project = Project(views=views(folder), size=CAMERA.size)
    for name, result in _calibrate_views().items():
        project = add_result(project, name, replace(result, views=project.views))
    settings = replace(project.settings, fixed={"k3": None})
    first = project.views[0].image
    return replace(project, settings=settings, digests={first: "ab" * 32})


@cache
def _draw_views() -> tuple[View, ...]:
    """The views of `views`, whatever their folder."""
    rng = np.random.default_rng(3)
    poses = [scenes.looking(CAMERA, rng, fill=(0.55, 0.65), board=BOARD) for _ in range(6)]
    found = []
    for k, view in enumerate(scenes.seen(CAMERA, poses, BOARD).noisy(0.05, rng)):
        grid = np.rint(view.xy[:, ::-1] / BOARD.square)
        corners = Corners((6, 7), grid, view.uv, np.rint(view.uv), method="saddle")
        found.append(View(f"{k}.png", ViewStatus.FOUND, corners=corners))
    blank = View("blank.png", ViewStatus.NO_BOARD, "No checkerboard was found.")
    return (*found, blank)


@cache
def _calibrate_views() -> dict[str, Result]:
    """The results of `calibrated`, by name; every test has a folder of its own, but not these."""
    drawn = Project(views=_draw_views(), size=CAMERA.size)
    corner_set = CornerSet(CAMERA.size, drawn.views, drawn.board)
    return {
        name: calibrate_views(corner_set, Settings(fixed=fixed))
        for name, fixed in (("Calibration 1", {}), ("k3 held", {"k3": None}))
    }

"""A project from a result.json: what the window shows of a calibration that was made elsewhere."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

from calibgui.app.calibrating.settings import DEFAULT_MODEL, Settings
from calibgui.app.photographs.paths import is_remote
from calibgui.app.projects.project import Project
from calibgui.dataset import Result
from calibgui.engine.calibration import METHODS, Cost, recover_arguments
from calibgui.engine.camera import find_model
from calibgui.formats.camera_import import read_result_file


def make_project(path: Path, name: str) -> Project:
    """Read a result.json as a project whose only result it is, with the settings that made it.

    Args:
        path: the file; photographs are looked for from its folder.
        name: what the result is called.

    Raises:
        CalibrationError: if it cannot be read, or is no result.
    """
    result = read_result_file(path)
    views = tuple(
        view if is_remote(view.image) else replace(view, image=str(path.parent / view.image))
        for view in result.views
    )
    result = replace(result, views=views)
    settings = _recover_settings(result)
    project = Project(
        views=views,
        size=result.calibration.camera.size,
        lengths_confirmed=result.lengths_confirmed,
        limits=result.limits,
        settings=settings,
        results=MappingProxyType({name: result}),
        settings_of_results=MappingProxyType({name: settings}),
    )
    if (board := result.board) is None:
        return project
    return replace(
        project,
        pattern=board.pattern,
        grid_size=board.grid_size,
        square=board.square,
        square_sigma=board.square_sigma,
    )


def _recover_settings(result: Result) -> Settings:
    """Return the settings that make a result again from its views.

    A lens model that was chosen automatically is named, with what was held at 0 of it. Whether
    images were to be searched again is not known.
    """
    calibration = result.calibration
    arguments, stated = recover_arguments(calibration), calibration.settings
    lens, usual = find_model(calibration.camera.model), METHODS[arguments["method"]].held
    usual = lens.held if usual is None else usual
    defaults = dict(zip(lens.names, lens.defaults, strict=True))
    held = stated.fixed
    return Settings(
        cost=calibration.cost,
        # The cost "paper" takes the printed lens of the paper instead of the default.
        model=DEFAULT_MODEL if calibration.cost is Cost.PAPER else arguments["model"],
        method=arguments["method"],
        fixed={n: v for n, v in held.items() if n not in usual or v != defaults.get(n)},
        freed=tuple(name for name in usual if name not in held),
        board_shape=arguments["board_shape"],
        prior=arguments["prior"],
        robust=bool(stated.robust),
        weigh_views=bool(stated.weigh_views),
    )

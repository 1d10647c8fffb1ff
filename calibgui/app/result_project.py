"""A project from a result.json: what the window shows of a calibration that was made elsewhere."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

from calibgui.app.paths import is_remote
from calibgui.app.project import Project
from calibgui.formats.result_json import read_result


def make_project(path: Path, name: str) -> Project:
    """Read a result.json as a project whose only result it is.

    Args:
        path: the file; photographs are looked for from its folder.
        name: what the result is called.

    Raises:
        CalibrationError: if it cannot be read, or is no result.
    """
    result = read_result(path)
    views = tuple(
        view if is_remote(view.image) else replace(view, image=str(path.parent / view.image))
        for view in result.views
    )
    result = replace(result, views=views)
    project = Project(
        views=views,
        size=result.calibration.camera.size,
        lengths_confirmed=result.lengths_confirmed,
        results=MappingProxyType({name: result}),
    )
    if (board := result.board) is None:
        return project
    return replace(project, pattern=board.pattern, grid_size=board.grid_size, square=board.square)

"""A project as a JSON file beside its images.

    format, version     "calibgui-project", 3
    target              rows, cols (null: inferred from the images), square_mm, unit and
                        pattern as in ``pattern_json.py``; corners, the method of locating them
                        ("edges" where it is missing)
    size                width and height of the images, px
    settings            cost, freed, fixed (names, or an object of them with their values or
                        null); plate (a model, "auto" or a plate as in ``plate_json.py``),
                        prior_mm (in the plane and out of it, or null), robust; weigh_views and
                        once (false where they are missing)
    views               as in ``views_json.py``, and the image file's sha256 where known
    results             by name, each as a result.json is (``result_json.py``)

Paths are relative to the file's folder, with "/", so that folder and project move together.
Cannot hold: the images; undone edits.

A change that old programs could misread takes a new version: raise `VERSION` and add to
`_MIGRATIONS` the function that turns the content of the version before into the new one.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path, PurePath
from types import MappingProxyType
from typing import Any

from calibgui.app.project import Project, Unit, relocated
from calibgui.app.settings import NAMES, Settings
from calibgui.dataset.result import Result
from calibgui.dataset.view import View
from calibgui.engine.boards import CHECKERBOARD, Board, BoardShape, BoardShapeModel
from calibgui.engine.calibration import Cost
from calibgui.engine.detection import METHODS
from calibgui.formats.board_shape_json import (
    board_shape_record,
    read_board_shape_record,
    read_prior,
)
from calibgui.formats.corners_json import read_size
from calibgui.formats.json_document import Node, check_format, read, same, write
from calibgui.formats.pattern_json import pattern_record, read_pattern
from calibgui.formats.result_json import result_from, result_record
from calibgui.formats.views_json import read_views, view_record

FORMAT = "calibgui-project"
VERSION = 3
_AUTO = "auto"


def _nominal_board(content: dict[str, Any]) -> dict[str, Any]:
    """Version 1 knew no other plate, and no outliers."""
    settings = {"plate": BoardShapeModel.NOMINAL, "prior_mm": None, "robust": False}
    return content | {"version": 2, "settings": content["settings"] | settings}


def _checkerboard(content: dict[str, Any]) -> dict[str, Any]:
    """Version 2 knew no other pattern."""
    pattern = {"pattern": pattern_record(CHECKERBOARD)}
    return content | {"version": 3, "target": content["target"] | pattern}


_MIGRATIONS: Mapping[int, Callable[[dict[str, Any]], dict[str, Any]]] = {
    1: _nominal_board,
    2: _checkerboard,
}
"""By the version that they take: to the content of the next one."""


def write_project(project: Project, path: Path) -> None:
    """Write the project file, completely or not at all.

    Raises:
        CalibrationError: if it cannot be written.
    """
    write(path, project_record(project, path.parent))


def project_record(project: Project, folder: Path) -> dict[str, Any]:
    """The content of the file, with paths relative to `folder`."""
    project = _with_paths(project, lambda image: _relative(image, folder))
    rows, cols = project.grid_size or (None, None)
    square = {"square_mm": project.square, "unit": project.unit}
    pattern = {"pattern": pattern_record(project.pattern), "corners": project.method}
    return {
        "format": FORMAT,
        "version": VERSION,
        "target": {"rows": rows, "cols": cols, **square, **pattern},
        "size": project.size,
        "settings": _settings_record(project.settings),
        "views": [_view_record(view, project) for view in project.views],
        "results": {name: result_record(result) for name, result in project.results.items()},
    }


def _settings_record(settings: Settings) -> dict[str, Any]:
    board_shape, prior = settings.board_shape, settings.prior
    # Versions that knew no values read the names as long as there are none.
    at_values = any(value is not None for value in settings.fixed.values())
    return {
        "cost": settings.cost,
        "fixed": settings.fixed if at_values else list(settings.fixed),
        "freed": settings.freed,
        "plate": board_shape_record(board_shape)
        if isinstance(board_shape, BoardShape)
        else board_shape or _AUTO,
        "prior_mm": None if prior is None else (prior.in_plane, prior.out_of_plane),
        "robust": settings.robust,
        "weigh_views": settings.weigh_views,
        "once": settings.once,
    }


def read_project(path: Path, folder: Path | None = None) -> Project:
    """Read a project file.

    Args:
        path: the file.
        folder: what its paths are relative to, if not to the folder that it is in.

    Raises:
        CalibrationError: if the file cannot be read, is of another format or a newer version,
            or something in it is wrong, naming the place.
    """
    node = read(path)
    check_format(node, FORMAT, VERSION)
    project = _read(_migrated(node))
    base = (folder or path.parent).absolute()
    return _with_paths(project, lambda image: os.path.normpath(base / image))


def _migrated(node: Node) -> Node:
    content = node.value
    for version in range(content["version"], VERSION):
        content = _MIGRATIONS[version](content)
    return Node(content, node.where, node.file)


def _view_record(view: View, project: Project) -> dict[str, Any]:
    record = view_record(view, _lattice(project))
    digest = project.digests.get(view.image)
    return record if digest is None else record | {"sha256": digest}


def _lattice(project: Project) -> Board:
    """Where found corners lie on the plate: that takes the squares' side, not their number."""
    return project.board or Board(2, 2, project.square, project.pattern)


def _read(node: Node) -> Project:
    board = node["target"]
    rows, cols, size = board.get("rows"), board.get("cols"), node.get("size")
    if not (square := board["square_mm"]).number() > 0:
        square.fail("a length above 0")
    pattern = read_pattern(board["pattern"])
    views = read_views(node["views"], Board(2, 2, square.number(), pattern))
    digests = {
        view.image: digest.text()
        for view, item in zip(views, node["views"].items(), strict=True)
        if (digest := item.get("sha256"))
    }
    return Project(
        views=views,
        size=read_size(size) if size else None,
        pattern=pattern,
        grid_size=(rows.integer(), cols.integer()) if rows and cols else None,
        method=method.choice(METHODS) if (method := board.get("corners")) else METHODS[0],
        square=square.number(),
        unit=Unit(board["unit"].choice(list(Unit))),
        settings=_read_settings(node["settings"]),
        results=MappingProxyType(_read_results(node, views)),
        digests=MappingProxyType(digests),
    )


def _read_settings(node: Node) -> Settings:
    prior = node.get("prior_mm")
    return Settings(
        cost=Cost(node["cost"].choice(list(Cost))),
        fixed=_read_fixed(node["fixed"]),
        freed=tuple(name.choice(NAMES) for name in node["freed"].items()),
        board_shape=_read_board_shape(node["plate"]),
        prior=None if prior is None else read_prior(prior),
        robust=node["robust"].flag(),
        weigh_views=weigh.flag() if (weigh := node.get("weigh_views")) else False,
        once=once.flag() if (once := node.get("once")) else False,
    )


def _read_fixed(node: Node) -> dict[str, float | None]:
    if isinstance(node.value, list):
        return dict.fromkeys(name.choice(NAMES) for name in node.items())
    for name in node.members():
        Node(name, node.where, node.file).choice(NAMES)
    return {
        name: None if value.value is None else value.number()
        for name, value in node.members().items()
    }


def _read_board_shape(node: Node) -> BoardShapeModel | BoardShape | None:
    if isinstance(node.value, dict):
        return read_board_shape_record(node)
    model = node.choice([*BoardShapeModel, _AUTO])
    return None if model == _AUTO else BoardShapeModel(model)


def _read_results(node: Node, views: tuple[View, ...]) -> dict[str, Result]:
    """The results; what they and the project hold alike becomes one object, as it was."""
    own = {
        view.image: (view, {k: v for k, v in item.items() if k != "sha256"})
        for view, item in zip(views, node["views"].value, strict=True)
    }

    def shared(view: View, item: dict[str, Any]) -> View:
        mine, record = own.get(view.image, (view, {}))
        return mine if all(same(item.get(key), record[key]) for key in record) else view

    results = {}
    for name, record in node["results"].value.items():
        result = result_from(node["results"][name])
        pairs = zip(result.views, record["views"], strict=True)
        results[name] = replace(result, views=tuple(shared(*pair) for pair in pairs))
    return results


def _with_paths(project: Project, change: Callable[[str], str]) -> Project:
    images = {view.image for view in project.views}
    images |= {view.image for result in project.results.values() for view in result.views}
    return relocated(project, {image: change(image) for image in images})


def _relative(image: str, folder: Path) -> str:
    try:
        return PurePath(os.path.relpath(image, folder)).as_posix()
    except ValueError:  # on another drive
        return PurePath(image).as_posix()

"""A project as a JSON file beside its images.

    format, version     "calibgui-project", 4
    lengths_confirmed   whether the user has stated the side of a square; where missing, it is
                        as if so if there are results
    target              the board: rows, cols (null: inferred from the images), square_mm and its
                        square_sigma_mm (0 where missing), unit and
                        pattern as in ``pattern_json.py``; corners, the method of locating them
                        ("edges" where missing)
    size                width and height of the images, px
    details             texts on operator, place and so on, for a report (``dataset/details.py``);
                        what is empty may be missing
    limits              what is demanded of the camera, as in ``limits_toml.py`` (missing: nothing)
    by_hand             whether the user marks every board (false where missing)
    settings            cost, model (of the lens; "auto" if it is chosen automatically), method,
                        freed, fixed (names, or an object of them with their values or null); plate
                        (the board's shape: a model, "auto" or a shape as in
                        ``board_shape_json.py``), prior_mm (in the plane and out of it, or null),
                        robust; weigh_views, once and improve (false where missing); camera, where
                        one is held: the file that it is from with the title of its format, model,
                        size, params, covariance (or null) and circle (where it has one)
    views               as in ``views_json.py``, and sha256 of the image file where known
    results             by name, each as a result.json is (``result_json.py``)
    verdicts            by name, each as in ``verdict_json.py``, of the results that were judged
    settings_of_results by name, each as settings is, of the results whose settings are known

Paths are relative to the folder of the file, with "/", so that folder and project move together;
addresses of photographs, as http://, stay as they are.
Cannot hold: the images; undone edits.

A change that old programs could misread takes a new version: raise `VERSION` and add to
`_MIGRATIONS` the function that turns the content of the version before into the new one.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, fields, replace
from pathlib import Path, PurePath
from types import MappingProxyType
from typing import Any

from calibgui.app.calibrating.settings import (
    AUTO_MODEL,
    DEFAULT_MODEL,
    MODEL_CHOICES,
    Settings,
    list_parameters,
    read_model_choice,
)
from calibgui.app.photographs.paths import is_remote
from calibgui.app.projects.project import GRID_LINES, Project, Unit, relocate_images
from calibgui.dataset import KnownCamera, Result, View
from calibgui.dataset.details import Details
from calibgui.dataset.judging import keep_verdict, recall_verdict
from calibgui.engine.arrays import GridSize
from calibgui.engine.boards import CHECKERBOARD, Board, BoardShape, BoardShapeModel
from calibgui.engine.calibration import DEFAULT_METHOD, Cost
from calibgui.engine.calibration import METHODS as CALIBRATION_METHODS
from calibgui.engine.errors import CalibrationError
from calibgui.engine.features import METHODS
from calibgui.engine.files import open_regular
from calibgui.formats.board_shape_json import decode_board_shape, decode_prior, encode_board_shape
from calibgui.formats.json_document import JsonWriter, are_same_values, check_format, read_json
from calibgui.formats.limits_toml import decode_limits, encode_limits
from calibgui.formats.node import Node
from calibgui.formats.pattern_json import decode_pattern, decode_square_sigma, encode_pattern
from calibgui.formats.result_json import (
    decode_camera,
    decode_model,
    decode_result,
    encode_result,
)
from calibgui.formats.verdict_json import decode_verdict, encode_verdict
from calibgui.formats.views_json import decode_field, decode_views, encode_view

FORMAT = "calibgui-project"
VERSION = 4
_AUTO_BOARD_SHAPE = "auto"
_BEGINNING = 256
"""Part of a file in which its format is looked for, bytes: it comes first."""
_WRITER = JsonWriter()
"""Keeps most of the text of the last project, which is written after every edit."""


def _extend(node: Node, added: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values of an object with others added."""
    return {**{name: member.value for name, member in node.members().items()}, **added}


def _add_board_shape(content: Node) -> dict[str, Any]:
    """Turn version 1, which knew flat boards only and no outliers, into version 2."""
    settings = {"plate": BoardShapeModel.NOMINAL, "prior_mm": None, "robust": False}
    return {"version": 2, "settings": _extend(content["settings"], settings)}


def _add_pattern(content: Node) -> dict[str, Any]:
    """Turn version 2, which knew checkerboards only, into version 3."""
    pattern = {"pattern": encode_pattern(CHECKERBOARD)}
    return {"version": 3, "target": _extend(content["target"], pattern)}


def _add_model_and_method(content: Node) -> dict[str, Any]:
    """Turn version 3, in which lens model and method could not be chosen, into version 4."""
    settings = {"model": DEFAULT_MODEL, "method": DEFAULT_METHOD}
    return {"version": 4, "settings": _extend(content["settings"], settings)}


_MIGRATIONS: Mapping[int, Callable[[Node], dict[str, Any]]] = {
    1: _add_board_shape,
    2: _add_pattern,
    3: _add_model_and_method,
}
"""Functions from the content of a version, the key, to the members that the next one has anew."""


def write_project(project: Project, path: Path, folder: Path | None = None) -> None:
    """Write the project file, completely or not at all.

    Args:
        project: the project.
        path: the file.
        folder: the folder that its paths are relative to; the one that it is in if None.

    Raises:
        CalibrationError: if it cannot be written.
    """
    _WRITER.write_file(path, encode_project(project, folder or path.parent))


def encode_project(project: Project, folder: Path) -> dict[str, Any]:
    """Return the content of the file, with paths relative to `folder`."""
    project = _change_paths(project, lambda image: _make_relative(image, folder))
    rows, cols = project.grid_size or (None, None)
    board = project.board or Board(2, 2, project.square, project.pattern)
    square: dict[str, Any] = {"square_mm": project.square, "unit": project.unit}
    if project.square_sigma:
        square["square_sigma_mm"] = project.square_sigma
    pattern = {"pattern": encode_pattern(project.pattern), "corners": project.method}
    field = {} if project.field is None else {"field": project.field}
    limits = {} if project.limits is None else {"limits": encode_limits(project.limits)}
    return {
        "format": FORMAT,
        "version": VERSION,
        **field,
        "target": {"rows": rows, "cols": cols, **square, **pattern},
        "lengths_confirmed": project.lengths_confirmed,
        "size": project.size,
        "details": {name: text for name, text in asdict(project.details).items() if text},
        **limits,
        "by_hand": project.by_hand,
        "settings": _encode_settings(project.settings),
        "views": [_encode_view(view, project, board) for view in project.views],
        "results": {name: encode_result(result) for name, result in project.results.items()},
        "verdicts": {
            name: encode_verdict(verdict, result)
            for name, result in project.results.items()
            if (verdict := recall_verdict(result)) is not None
        },
        "settings_of_results": {
            name: _encode_settings(settings)
            for name, settings in project.settings_of_results.items()
        },
    }


def _encode_settings(settings: Settings) -> dict[str, Any]:
    """Encode the settings of a calibration under the keys of the file."""
    board_shape, prior = settings.board_shape, settings.prior
    # Versions that knew no values read the names as long as there are none.
    at_values = any(value is not None for value in settings.fixed.values())
    return {
        "cost": settings.cost,
        "model": settings.model or AUTO_MODEL,
        "method": settings.method,
        "fixed": settings.fixed if at_values else list(settings.fixed),
        "freed": settings.freed,
        "plate": encode_board_shape(board_shape)
        if isinstance(board_shape, BoardShape)
        else board_shape or _AUTO_BOARD_SHAPE,
        "prior_mm": None if prior is None else (prior.in_plane, prior.out_of_plane),
        "robust": settings.robust,
        "weigh_views": settings.weigh_views,
        "improve": settings.improve,
        "once": settings.once,
        **({} if settings.known is None else {"camera": _encode_known(settings.known)}),
    }


def _encode_known(known: KnownCamera) -> dict[str, Any]:
    """Encode a camera that is held."""
    camera = known.camera
    return {
        "file": known.file,
        "title": known.title,
        "model": camera.model,
        "size": camera.size,
        "params": dict(zip(camera.names, camera.params, strict=True)),
        "covariance": known.covariance,
    } | ({} if camera.circle is None else {"circle": camera.circle})


def is_project(path: Path) -> bool:
    """Return whether a file says where it begins that it is a project, whatever follows."""
    try:
        with open_regular(path) as file:
            return f'"{FORMAT}"'.encode() in file.read(_BEGINNING)
    except (CalibrationError, OSError):
        return False


def read_project(path: Path, folder: Path | None = None) -> Project:
    """Read a project file.

    Args:
        path: the file.
        folder: the folder that its paths are relative to; the one that it is in if None.

    Raises:
        CalibrationError: if the file cannot be read, is of another format or a newer version,
            or something in it is wrong; the message names the place.
    """
    node = read_json(path)
    check_format(node, FORMAT, VERSION, "a project")
    project = _decode_project(_migrate(node))
    base = (folder or path.parent).absolute()
    project = _change_paths(project, lambda image: _make_absolute(image, base))
    _check_images_differ(project, node.file)
    return project


def _check_images_differ(project: Project, file: str) -> None:
    """Raise a CalibrationError if two views are of one file, whose corners would count twice."""
    first: dict[str, int] = {}
    for k, view in enumerate(project.views):
        if first.setdefault(view.image, k) != k:
            raise CalibrationError(
                f"{file}: views {first[view.image] + 1} and {k + 1} are both of {view.image}.",
                "Delete one of the two from the file.",
            )


def _migrate(node: Node) -> Node:
    for version in range(node["version"].integer(), VERSION):
        node = Node({**node.value, **_MIGRATIONS[version](node)}, node.where, node.file)
    return node


def _encode_view(view: View, project: Project, board: Board) -> dict[str, Any]:
    """Encode a view with corners of a board, whose grid size does not change their places."""
    record = encode_view(view, board)
    digest = project.digests.get(view.image)
    return record if digest is None else record | {"sha256": digest}


def _decode_project(node: Node) -> Project:
    """Decode a file of the present version."""
    board = node["target"]
    size = node.get("size")
    if not (square := board["square_mm"]).number() > 0:
        square.fail("a length above 0")
    pattern = decode_pattern(board["pattern"])
    views = decode_views(node["views"], Board(2, 2, square.number(), pattern))
    digests = {
        view.image: digest.text()
        for view, item in zip(views, node["views"].items(), strict=True)
        if (digest := item.get("sha256"))
    }
    confirmed = node.get("lengths_confirmed")
    settings = _decode_settings(node["settings"])
    return Project(
        views=views,
        size=size.image_size() if size else None,
        pattern=pattern,
        grid_size=_decode_grid_size(board.get("rows"), board.get("cols")),
        method=method.choice(METHODS) if (method := board.get("corners")) else METHODS[0],
        field=decode_field(node.get("field")),
        square=square.number(),
        square_sigma=decode_square_sigma(board),
        details=_decode_details(node.get("details")),
        limits=decode_limits(node.get("limits")),
        by_hand=by_hand.flag() if (by_hand := node.get("by_hand")) else False,
        unit=Unit(board["unit"].choice(list(Unit))),
        lengths_confirmed=bool(node["results"].value) if confirmed is None else confirmed.flag(),
        settings=settings,
        results=MappingProxyType(_decode_results(node, views)),
        settings_of_results=MappingProxyType(_decode_settings_of_results(node, settings)),
        digests=MappingProxyType(digests),
    )


def _decode_details(node: Node | None) -> Details:
    """Return what is stated of the calibration; nothing in older projects."""
    known = {field.name for field in fields(Details)}
    stated = {} if node is None else node.members()
    return Details(**{name: text.text() for name, text in stated.items() if name in known})


def _decode_grid_size(rows: Node | None, cols: Node | None) -> GridSize | None:
    """Return the stated rows and columns; None if they are inferred from the images."""
    if rows is None or cols is None:
        return None
    for count in (rows, cols):
        if count.integer() not in GRID_LINES:
            count.fail(f"a number from {GRID_LINES.start} to {GRID_LINES[-1]}")
    return rows.integer(), cols.integer()


def _decode_settings(node: Node) -> Settings:
    """Decode the settings of a calibration."""
    prior = node.get("prior_mm")
    model = _decode_model(node["model"])
    names = list_parameters(model)
    return Settings(
        cost=Cost(node["cost"].choice(list(Cost))),
        model=model,
        method=node["method"].choice(list(CALIBRATION_METHODS)),
        fixed=_decode_fixed(node["fixed"], names),
        freed=tuple(name.choice(names) for name in node["freed"].items()),
        board_shape=_decode_board_shape(node["plate"]),
        prior=None if prior is None else decode_prior(prior),
        robust=node["robust"].flag(),
        weigh_views=weigh.flag() if (weigh := node.get("weigh_views")) else False,
        once=once.flag() if (once := node.get("once")) else False,
        improve=improve.flag() if (improve := node.get("improve")) else False,
        known=_decode_known(node.get("camera")),
    )


def _decode_known(node: Node | None) -> KnownCamera | None:
    """Decode the camera that is held; None for one that is to be calibrated."""
    if node is None:
        return None
    camera = decode_camera(node, decode_model(node["model"]), {})
    count, covariance = len(camera.params), node.get("covariance")
    return KnownCamera(
        camera,
        node["file"].text(),
        node["title"].text(),
        None if covariance is None else covariance.covariances(count, count),
    )


def _decode_settings_of_results(node: Node, now: Settings) -> dict[str, Settings]:
    """Return settings by results' names; those that equal the project's become the same object, as
    a board shape in them is compared by its identity."""
    known = node.get("settings_of_results")
    if known is None:
        return {}
    results, same = node["results"].value, node["settings"].value
    return {
        name: now if are_same_values(item.value, same) else _decode_settings(item)
        for name, item in known.members().items()
        if name in results
    }


def _decode_model(node: Node) -> str | None:
    """Return the name of the lens model to estimate, None for one that is chosen automatically."""
    try:
        return read_model_choice(node.text())
    except CalibrationError:
        node.choice([AUTO_MODEL, *MODEL_CHOICES])  # names the place, and the choices
        raise


def _decode_fixed(node: Node, names: Sequence[str]) -> dict[str, float | None]:
    if isinstance(node.value, list):
        return dict.fromkeys(name.choice(names) for name in node.items())
    for name in node.members():
        Node(name, node.where, node.file).choice(names)
    return {
        name: None if value.value is None else value.number()
        for name, value in node.members().items()
    }


def _decode_board_shape(node: Node) -> BoardShapeModel | BoardShape | None:
    if isinstance(node.value, dict):
        return decode_board_shape(node)
    model = node.choice([*BoardShapeModel, _AUTO_BOARD_SHAPE])
    return None if model == _AUTO_BOARD_SHAPE else BoardShapeModel(model)


def _decode_results(node: Node, views: tuple[View, ...]) -> dict[str, Result]:
    """Return the results; a view that equals the project's becomes the same object, as it was."""
    views_here = {
        view.image: (view, {k: v for k, v in item.items() if k != "sha256"})
        for view, item in zip(views, node["views"].value, strict=True)
    }

    def share(view: View, item: dict[str, Any]) -> View:
        here, record = views_here.get(view.image, (view, {}))
        # The places of found corners may be the board's here, and the view's own in a result.
        same = (here.points is None) is (view.points is None)
        same = same and all(are_same_values(item.get(key), record[key]) for key in record)
        return here if same else view

    results = {}
    verdicts = node.get("verdicts")
    for name, record in node["results"].members().items():
        result = decode_result(record)
        pairs = zip(result.views, record["views"].value, strict=True)
        results[name] = replace(result, views=tuple(share(*pair) for pair in pairs))
        if verdicts is not None and (verdict := verdicts.get(name)) is not None:
            keep_verdict(result, decode_verdict(verdict, result))
    return results


def _change_paths(project: Project, change: Callable[[str], str]) -> Project:
    images = {view.image for view in project.views}
    images |= {view.image for result in project.results.values() for view in result.views}
    return relocate_images(project, {image: change(image) for image in images})


def _make_absolute(image: str, folder: Path) -> str:
    return image if is_remote(image) else os.path.normpath(folder / image)


def _make_relative(image: str, folder: Path) -> str:
    if is_remote(image):
        return image
    try:
        return PurePath(os.path.relpath(image, folder)).as_posix()
    except ValueError:  # on another drive
        return PurePath(image).as_posix()

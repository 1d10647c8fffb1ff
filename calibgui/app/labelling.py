"""Counting the corners of all views alike, by their board's deviations from its drawing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from calibgui.app.calibration import short_names
from calibgui.dataset.result import Result
from calibgui.dataset.view import View
from calibgui.engine.arrays import Array
from calibgui.engine.boards import CHECKERBOARD, Ambiguity, BoardShapeModel
from calibgui.engine.calibration import Calibration, Cost, Observation, calibrate, settings_of
from calibgui.engine.detection import Corners
from calibgui.engine.redetection import Placing, identified, turned_alike

_COUNTED = "Its corners are counted as the board's deviations from its drawing tell."


def counted_alike(result: Result) -> tuple[View, ...]:
    """The views of a result with their corners counted alike, as far as that is open and the
    board's deviations from its drawing tell how."""
    board, used = result.board, result.used
    if result.calibration.cost is not Cost.IMAGE:
        return result.views
    if all(view.points is not None for view in used):
        if result.calibration.board_shape is None:
            return result.views  # which does not notice
        turned = turned_alike(_on_nominal_board(result), result.observations())
        told = dict(zip(map(id, used), turned, strict=True))
        return tuple(_turned_to(view, told.get(id(view))) for view in result.views)
    corners = [view.corners for view in used if view.corners is not None and view.points is None]
    if (
        board is None
        or board.pattern != CHECKERBOARD
        or len(corners) < len(used)
        or not any(map(_is_open, corners))
    ):
        return result.views
    placings = identified(_on_nominal_board(result), corners, board)
    placed = dict(zip(map(id, used), placings, strict=True))
    return tuple(
        _counted(view, placed[id(view)]) if id(view) in placed else view for view in result.views
    )


def _on_nominal_board(result: Result) -> Calibration:
    """Of the same views."""
    calibration = result.calibration
    if calibration.board_shape is None:
        return calibration
    settings = {**settings_of(calibration), "board_shape": BoardShapeModel.NOMINAL}
    return calibrate(result.observations(), calibration.camera.size, **settings)


def _turned_to(view: View, points: Observation | None) -> View:
    """The view with its corners at other places, if they are others."""
    if points is None or points is view.points:
        return view
    return replace(view, points=points, note=f"{view.note} {_COUNTED}".lstrip())


def about_turned(after: Sequence[View], before: Sequence[View]) -> Iterator[str]:
    """A sentence on the views whose corners were not counted by this program and are turned."""
    pairs = zip(after, before, strict=True)
    turned = [new for new, old in pairs if new is not old and new.points is not None]
    if turned:
        yield (
            f"The board is counted from the wrong end in {', '.join(short_names(turned))}, as its "
            "deviations from its drawing tell; there it is turned round."
        )


def same_places(one: Sequence[View], other: Sequence[View]) -> bool:
    """Whether two states of the same views count their corners alike."""
    pairs = zip(one, other, strict=True)
    return all(
        a is b or (a.corners and b.corners and np.array_equal(a.corners.grid, b.corners.grid))
        for a, b in pairs
    )


def recounted(view: View, before: View, after: View) -> View:
    """The view with all its corners counted as they are, without outliers, in `after`."""
    if after is before:
        return view
    if view.points is not None and before.points is not None and after.points is not None:
        xy = _carried(before.points.xy, after.points.xy, view.points.xy)
        return replace(view, points=view.points._replace(xy=xy), note=after.note)
    if view.corners is None or before.corners is None or after.corners is None:
        return view
    grids = (each.grid.astype(np.float64) for each in (before.corners, after.corners, view.corners))
    grid = _carried(*grids)
    corners = replace(
        view.corners,
        grid=np.rint(grid).astype(np.int64),
        relative=after.corners.relative,
        ambiguity=after.corners.ambiguity,
    )
    return replace(view, corners=corners, note=after.note)


def _carried(old: Array, new: Array, places: Array) -> Array:
    """Places (n, 2) after the motion that takes `old` (m, 2) to `new` (m, 2)."""

    def rows(at: Array) -> Array:
        return np.column_stack([at, np.ones(len(at))])

    return np.asarray(rows(places) @ np.linalg.lstsq(rows(old), new)[0])


def _is_open(corners: Corners) -> bool:
    return corners.relative or corners.ambiguity is not Ambiguity.NONE


def _counted(view: View, placing: Placing) -> View:
    """The view with its corners where they belong, if that was open and is certain."""
    corners = view.corners
    if corners is None or not placing.certain or not _is_open(corners):
        return view
    as_before = np.array_equal(corners.grid, placing.grid)
    corners = replace(corners, grid=placing.grid, relative=False, ambiguity=Ambiguity.NONE)
    if as_before:
        return replace(view, corners=corners)
    return replace(view, corners=corners, note=f"{view.note} {_COUNTED}".lstrip())

"""What a first calibration lets be done better: images searched again, and views counted alike.

Only those images are read again in which something may be gained: no board was found, corners are
missing that the image should show, or it is open which part of the board is seen.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from threading import Event

import numpy as np

from calibgui.app.calibration import calibrate_views, short_names
from calibgui.app.labelling import about_turned, counted_alike, recounted, same_places
from calibgui.app.settings import USUAL, Settings
from calibgui.app.workers import Crashed, spread
from calibgui.dataset.corner_set import CornerSet
from calibgui.dataset.result import Result
from calibgui.dataset.view import View, ViewStatus
from calibgui.engine.arrays import GridSize
from calibgui.engine.boards import CHECKERBOARD, Board
from calibgui.engine.calibration import Calibration, Cost, Report, Status
from calibgui.engine.camera import project_points
from calibgui.engine.detection import Corners
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import Pose
from calibgui.engine.images import read_image
from calibgui.engine.redetection import find_again
from calibgui.report.numbers import counted

_FEW = 6
"""Images up to which starting other processes takes longer than searching."""
_BORDER = 8.0
"""Width of the image's border in which no corner is missed, px."""


def calibrate_twice(
    corner_set: CornerSet,
    settings: Settings = USUAL,
    report: Report | None = None,
    stop: Event | None = None,
    search: bool = True,
) -> Result:
    """Calibrate; unless asked for once, search again, count all views alike, and calibrate again
    if that changed any.

    Args:
        corner_set, settings: as for ``calibrate_views``.
        report: told of the iterations of both.
        stop: abandons the search when set.
        search: whether images may be searched again.

    Raises:
        CalibrationError: as ``calibrate_views``.
        Cancelled: from `report`, or if `stop` was set.
    """
    result = calibrate_views(corner_set, settings, report)
    calibration = result.calibration
    ended = calibration.status is Status.STOPPED or calibration.diagnosis is not None
    if settings.once or ended:
        return result
    more, said = search_again(corner_set, result, stop) if search else (corner_set, ())
    if said:
        result = calibrate_views(more, settings, report)
    alike = counted_alike(result)
    if same_places(alike, result.views):
        result = replace(result, views=alike)
    else:
        said = (*said, *about_turned(alike, result.views))
        views = tuple(map(recounted, more.views, result.views, alike))
        result = calibrate_views(replace(more, views=views), settings, report)
    warnings = (*result.calibration.warnings, *said)
    return replace(result, calibration=replace(result.calibration, warnings=warnings))


def search_again(
    corner_set: CornerSet, result: Result, stop: Event | None = None
) -> tuple[CornerSet, tuple[str, ...]]:
    """The corners with what the calibrated camera lets be found besides.

    Args:
        corner_set: that `result` was calibrated from.
        result: of a calibration with the image cost.
        stop: abandons the search when set.

    Returns:
        The same set if nothing was gained; and what was, in a sentence or none.

    Raises:
        Cancelled: if `stop` was set.
    """
    calibration, board = result.calibration, corner_set.board
    if board is None or board.pattern != CHECKERBOARD or calibration.cost is not Cost.IMAGE:
        return corner_set, ()
    poses = dict(zip((view.image for view in result.used), calibration.poses, strict=True))
    which = [
        k
        for k, view in enumerate(corner_set.views)
        if _promising(view, board, calibration, poses.get(view.image))
    ]
    views = list(corner_set.views)
    task = partial(view_again, calibration=calibration, grid_size=(board.rows, board.cols))
    for i, view in _each(task, [views[k] for k in which], stop):
        views[which[i]] = view
    changed = [k for k in which if views[k] is not corner_set.views[k]]
    if not changed:
        return corner_set, ()
    before = [corner_set.views[k] for k in changed]
    said = _gained(before, [views[k] for k in changed])
    return replace(corner_set, views=tuple(views)), (said,)


def view_again(view: View, calibration: Calibration, grid_size: GridSize) -> View:
    """The view with the corners that the camera lets be found in its image; the same if there
    are no others than before."""
    before = view.corners
    try:
        corners = find_again(read_image(view.image).pixels, calibration, grid_size, before)
    except CalibrationError:
        return view
    if before is None:
        note = "Found with the camera known from the other images."
    elif note := ", ".join(_changes(before, corners)):
        note = f"Searched again with the camera known: {note}."
    else:
        return view
    return replace(view, status=ViewStatus.FOUND, reason="", corners=corners, note=note)


def _promising(view: View, board: Board, calibration: Calibration, pose: Pose | None) -> bool:
    """Whether another search can gain something."""
    if not view.enabled or view.points is not None or view.roi is not None:
        return False  # not wanted, not ours, or the user has said where to search
    if view.corners is None:
        return view.status is ViewStatus.NO_BOARD
    if view.corners.method != "edges" or view.corners.complete or pose is None:
        return False
    uv = project_points(board.points(), calibration.camera, pose)
    limit = np.array(calibration.camera.size) - 1 - _BORDER
    shown = np.count_nonzero(np.all((uv > _BORDER) & (uv < limit), axis=1))
    return bool(view.corners.relative or shown > len(view.corners))


def _each(
    task: partial[View], items: Sequence[View], stop: Event | None
) -> Iterator[tuple[int, View]]:
    if len(items) <= _FEW:
        for i, item in enumerate(items):
            yield i, task(item)
        return
    for i, view in spread(task, items, stop):
        if not isinstance(view, Crashed):
            yield i, view


def _changes(before: Corners, after: Corners) -> Iterator[str]:
    """What is new in the corners."""
    old, new = (set(map(tuple, corners.grid.tolist())) for corners in (before, after))
    more, fewer = len(new - old), len(old - new)
    if before.relative:  # the numbers may all be others
        more, fewer = max(len(new) - len(old), 0), max(len(old) - len(new), 0)
        if not after.relative:
            yield "its place on the board is known"
    if more:
        yield f"{counted(more, 'corner')} more"
    if fewer:
        yield f"{counted(fewer, 'corner')} left out, far from where the camera would see it"


def _gained(before: Sequence[View], after: Sequence[View]) -> str:
    """In a sentence."""
    found = [view for old, view in zip(before, after, strict=True) if old.corners is None]
    corners = sum(len(view.corners or ()) for view in after)
    corners -= sum(len(view.corners or ()) for view in before)
    text = f"Searched again with the camera known: {counted(corners, 'corner')} more in "
    text += counted(len(after), "image")
    if found:
        text += f", {', '.join(short_names(found))} for the first time"
    return text + "."

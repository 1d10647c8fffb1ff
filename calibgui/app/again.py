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
from calibgui.app.settings import USUAL, Settings
from calibgui.app.workers import Crashed, spread
from calibgui.engine.calibrate import calibrate
from calibgui.engine.corners.identity import Placing, identified
from calibgui.engine.corners.reextract import find_again
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import read_image
from calibgui.engine.imaging.maps import project_points
from calibgui.engine.quality.counting import turned_alike
from calibgui.engine.quality.repetition import settings_of
from calibgui.engine.targets.pattern import CHECKERBOARD
from calibgui.engine.types import (
    Ambiguity,
    Board,
    Calibration,
    Corners,
    Cost,
    Observation,
    PlateModel,
    Pose,
    Report,
    Status,
    Target,
    View,
    ViewStatus,
)
from calibgui.formats.corners_json import CornerSet
from calibgui.formats.result import Result
from calibgui.report.numbers import counted

_FEW = 6
"""Images up to which starting other processes takes longer than searching."""
_BORDER = 8.0
"""Width of the image's border in which no corner is missed, px."""
_COUNTED = "Its corners are counted as the board's deviations from its drawing tell."


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
    if _same_places(alike, result.views):
        result = replace(result, views=alike)
    else:
        said = (*said, *_turned(alike, result.views))
        result = calibrate_views(replace(more, views=alike), settings, report)
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
    calibration, target = result.calibration, corner_set.target
    if target is None or target.pattern != CHECKERBOARD or calibration.cost is not Cost.IMAGE:
        return corner_set, ()
    poses = dict(zip((view.image for view in result.used), calibration.poses, strict=True))
    which = [
        k
        for k, view in enumerate(corner_set.views)
        if _promising(view, target, calibration, poses.get(view.image))
    ]
    views = list(corner_set.views)
    task = partial(view_again, calibration=calibration, board=(target.rows, target.cols))
    for i, view in _each(task, [views[k] for k in which], stop):
        views[which[i]] = view
    changed = [k for k in which if views[k] is not corner_set.views[k]]
    if not changed:
        return corner_set, ()
    before = [corner_set.views[k] for k in changed]
    said = _gained(before, [views[k] for k in changed])
    return replace(corner_set, views=tuple(views)), (said,)


def counted_alike(result: Result) -> tuple[View, ...]:
    """The views of a result with their corners counted alike, as far as that is open and the
    board's deviations from its drawing tell how."""
    target, used = result.target, result.used
    if result.calibration.cost is not Cost.IMAGE:
        return result.views
    if all(view.points is not None for view in used):
        if result.calibration.plate is None:
            return result.views  # which does not notice
        turned = turned_alike(_on_nominal_plate(result), result.observations())
        told = dict(zip(map(id, used), turned, strict=True))
        return tuple(_turned_to(view, told.get(id(view))) for view in result.views)
    corners = [view.corners for view in used if view.corners is not None and view.points is None]
    if (
        target is None
        or target.pattern != CHECKERBOARD
        or len(corners) < len(used)
        or not any(map(_is_open, corners))
    ):
        return result.views
    placings = identified(_on_nominal_plate(result), corners, target)
    placed = dict(zip(map(id, used), placings, strict=True))
    return tuple(
        _counted(view, placed[id(view)]) if id(view) in placed else view for view in result.views
    )


def _on_nominal_plate(result: Result) -> Calibration:
    """Of the same views."""
    calibration = result.calibration
    if calibration.plate is None:
        return calibration
    settings = {**settings_of(calibration), "plate": PlateModel.NOMINAL}
    return calibrate(result.observations(), calibration.camera.size, **settings)


def _turned_to(view: View, points: Observation | None) -> View:
    """The view with its corners at other places, if they are others."""
    if points is None or points is view.points:
        return view
    return replace(view, points=points, note=f"{view.note} {_COUNTED}".lstrip())


def _turned(after: Sequence[View], before: Sequence[View]) -> Iterator[str]:
    """A sentence on the views whose corners were not counted by this program and are turned."""
    pairs = zip(after, before, strict=True)
    turned = [new for new, old in pairs if new is not old and new.points is not None]
    if turned:
        yield (
            f"The board is counted from the wrong end in {', '.join(short_names(turned))}, as its "
            "deviations from its drawing tell; there it is turned round."
        )


def _same_places(one: Sequence[View], other: Sequence[View]) -> bool:
    """Whether two states of the same views count their corners alike."""
    pairs = zip(one, other, strict=True)
    return all(
        a is b or (a.corners and b.corners and np.array_equal(a.corners.grid, b.corners.grid))
        for a, b in pairs
    )


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


def view_again(view: View, calibration: Calibration, board: Board) -> View:
    """The view with the corners that the camera lets be found in its image; the same if there
    are no others than before."""
    before = view.corners
    try:
        corners = find_again(read_image(view.image).pixels, calibration, board, before)
    except CalibrationError:
        return view
    if before is None:
        note = "Found with the camera known from the other images."
    elif note := ", ".join(_changes(before, corners)):
        note = f"Searched again with the camera known: {note}."
    else:
        return view
    return replace(view, status=ViewStatus.FOUND, reason="", corners=corners, note=note)


def _promising(view: View, target: Target, calibration: Calibration, pose: Pose | None) -> bool:
    """Whether another search can gain something."""
    if not view.enabled or view.points is not None or view.roi is not None:
        return False  # not wanted, not ours, or the user has said where to search
    if view.corners is None:
        return view.status is ViewStatus.NO_BOARD
    if view.corners.method != "edges" or view.corners.complete or pose is None:
        return False
    uv = project_points(target.points(), calibration.camera, pose)
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

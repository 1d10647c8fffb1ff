"""Calibration in two rounds: the first camera shows what can be found and numbered better.

After a first calibration only those images are searched again in which something may be gained: no
board was found, corners are missing that the image should show, it is open which part of the board
is seen, or few corners have edges that are bent. Then the corners of symmetric boards are labelled
alike in all views (``labelling.py``). If either changed a view, the calibration is repeated.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from threading import Event

import numpy as np

from calibgui.app.calibrating.calibration import calibrate_views, recall_lens_choice, shorten_names
from calibgui.app.calibrating.labelling import (
    carry_view_labels,
    describe_turned_boards,
    have_same_labels,
    relabel_views,
)
from calibgui.app.calibrating.settings import DEFAULT_SETTINGS, Settings
from calibgui.app.system.workers import Crashed, map_in_processes
from calibgui.dataset import CornerSet, Result, View, ViewStatus
from calibgui.engine import redetection
from calibgui.engine.arrays import GridSize
from calibgui.engine.boards import CHECKERBOARD, Board
from calibgui.engine.calibration import Calibration, Cost, Report, Status
from calibgui.engine.camera import project_points
from calibgui.engine.errors import CalibrationError, Progress
from calibgui.engine.features import Corners
from calibgui.engine.geometry import Pose
from calibgui.engine.images import read_image
from calibgui.report.numbers import format_count

_MAX_SERIAL_IMAGES = 6
"""Number of images up to which starting other processes takes longer than searching."""
_BORDER = 8.0
"""Width of the image's border in which a missing corner is not looked for, px."""

_MIN_SHIFT = 0.5
"""Shift of a corner, in its standard deviations, from which on it is worth another calibration."""


def calibrate_twice(
    corner_set: CornerSet,
    settings: Settings = DEFAULT_SETTINGS,
    report: Report | None = None,
    stop: Event | None = None,
    search: bool = True,
    progress: Progress | None = None,
) -> Result:
    """Calibrate, search images again and label views alike, and calibrate again.

    The second round is left out if the settings want one only (``Settings.once``), or if the first
    was stopped or did not determine the camera. A lens model that was chosen automatically is
    chosen anew if corners were gained.

    Args:
        corner_set, settings, progress: as for ``calibrate_views``.
        report: a function that is called with the iterations of both calibrations.
        stop: an event that abandons the search when it is set.
        search: whether images may be searched again.

    Raises:
        CalibrationError: as ``calibrate_views``.
        Cancelled: from `report` or `progress`, or if `stop` was set.
    """
    result = calibrate_views(corner_set, settings, report, progress)
    calibration = result.calibration
    is_final = calibration.status is Status.STOPPED or calibration.diagnosis is not None
    is_final |= settings.known is not None
    if settings.once or is_final:
        return result
    more, sentences = redetect_views(corner_set, result, stop) if search else (corner_set, ())
    if more is not corner_set:
        result = calibrate_views(more, settings, report, progress)
    labelled = relabel_views(result)
    if have_same_labels(labelled, result.views):
        result = replace(result, views=labelled)
    else:
        sentences = (*sentences, *describe_turned_boards(labelled, result.views))
        views = tuple(map(carry_view_labels, more.views, result.views, labelled))
        lens = recall_lens_choice(result)
        result = calibrate_views(replace(more, views=views), settings, report, lens=lens)
    warnings = (*result.calibration.warnings, *sentences)
    return replace(result, calibration=replace(result.calibration, warnings=warnings))


def redetect_views(
    corner_set: CornerSet, result: Result, stop: Event | None = None
) -> tuple[CornerSet, tuple[str, ...]]:
    """Search images again with the calibrated camera.

    Args:
        corner_set: the corners that `result` was calibrated from.
        result: the result of a calibration with the image cost.
        stop: an event that abandons the search when it is set.

    Returns:
        The corners with those that were gained, the same set if none were, and sentences that name
        the gain and the images whose search broke off.

    Raises:
        CalibrationError: if a process that searches could not be started.
        Cancelled: if `stop` was set.
    """
    calibration, board = result.calibration, corner_set.board
    if board is None or board.pattern != CHECKERBOARD or calibration.cost is not Cost.IMAGE:
        return corner_set, ()
    poses = dict(zip((view.image for view in result.used), calibration.poses, strict=True))
    chosen = [
        k
        for k, view in enumerate(corner_set.views)
        if _is_promising(view, board, calibration, poses.get(view.image))
    ]
    views = list(corner_set.views)
    task = partial(redetect_view, calibration=calibration, grid_size=(board.rows, board.cols))
    changed, lost = [], []
    for i, view in _process_views(task, [views[k] for k in chosen], stop):
        if isinstance(view, Crashed):
            lost.append(views[chosen[i]])
            continue
        # Views that come back from other processes are never the objects that were sent.
        if not _have_same_corners(view, views[chosen[i]]):
            views[chosen[i]] = view
            changed.append(chosen[i])
    sentences = (_describe_loss(lost),) if lost else ()
    if not changed:
        return corner_set, sentences
    changed.sort()
    before = [corner_set.views[k] for k in changed]
    gain = _describe_gain(before, [views[k] for k in changed])
    return replace(corner_set, views=tuple(views)), (gain, *sentences)


def redetect_view(view: View, calibration: Calibration, grid_size: GridSize) -> View:
    """Search one image again with the camera known.

    Args:
        view: the view as it was found before.
        calibration: the calibration of its camera.
        grid_size: rows and columns of the board's corners.

    Returns:
        The view with the corners that are found now; the same object if these are no others.
    """
    before = view.corners
    try:
        image = read_image(view.image, view.orientation, view.field)
        if image.size != calibration.camera.size:  # searched while the camera's was not known
            return view
        corners = redetection.redetect_corners(image.pixels, calibration, grid_size, before)
    except CalibrationError:
        return view
    if before is None:
        note = "Found with the camera known from the other images."
    elif note := ", ".join(_describe_changes(before, corners)):
        note = f"Searched again with the camera known: {note}."
    else:
        return view
    return replace(view, status=ViewStatus.FOUND, reason="", corners=corners, note=note)


def _is_promising(view: View, board: Board, calibration: Calibration, pose: Pose | None) -> bool:
    """Return whether another search may gain something."""
    if not view.enabled or view.points is not None or view.roi is not None:
        return False  # left out, given from elsewhere, or searched where the user wants it
    if view.corners is None:
        return view.status is ViewStatus.NO_BOARD
    if view.corners.method != "edges" or pose is None:
        return False
    if redetection.are_edges_bent(view.corners, calibration, pose, board):
        return True
    if view.corners.complete:
        return False
    uv = project_points(board.points(), calibration.camera, pose)
    limit = np.array(calibration.camera.size) - 1 - _BORDER
    shown = np.count_nonzero(np.all((uv > _BORDER) & (uv < limit), axis=1))
    return bool(view.corners.relative or shown > len(view.corners))


def _have_same_corners(a: View, b: View) -> bool:
    """Return whether two views of one image have exactly the same corners, or both none."""
    if a.corners is None or b.corners is None:
        return a.corners is b.corners
    return (
        a.corners.relative == b.corners.relative
        and np.array_equal(a.corners.grid, b.corners.grid)
        and np.array_equal(a.corners.uv, b.corners.uv)
    )


def _process_views(
    task: partial[View], items: Sequence[View], stop: Event | None
) -> Iterator[tuple[int, View | Crashed]]:
    """Apply a task to views, in other processes if they are many; yield index and result."""
    if len(items) <= _MAX_SERIAL_IMAGES:
        for i, item in enumerate(items):
            yield i, task(item)
        return
    yield from map_in_processes(task, items, stop)


def _describe_changes(before: Corners, after: Corners) -> Iterator[str]:
    """Name the changes from the corners found before to those found after."""
    old, new = (set(map(tuple, corners.grid.tolist())) for corners in (before, after))
    more, fewer = len(new - old), len(old - new)
    if before.relative:  # the numbers may all be others
        more, fewer = max(len(new) - len(old), 0), max(len(old) - len(new), 0)
        if not after.relative:
            yield "its place on the board is known"
    if more:
        yield f"{format_count(more, 'corner')} more"
    if fewer:
        left_out = f"{format_count(fewer, 'corner')} left out"
        yield f"{left_out}, unclear or far from where the camera would see it"
    if not more and not fewer and not before.relative and before.cov is not None:
        moved = np.linalg.norm(after.uv - before.uv, axis=1)
        sigma = np.sqrt(np.trace(before.cov, axis1=1, axis2=2) / 2)
        if np.any(moved > _MIN_SHIFT * sigma):
            yield f"corners moved by up to {moved.max():.2g} px, as their edges are bent"


def _describe_gain(before: Sequence[View], after: Sequence[View]) -> str:
    """Say in a sentence what was gained."""
    found = [view for old, view in zip(before, after, strict=True) if old.corners is None]
    corners = sum(len(view.corners or ()) for view in after)
    corners -= sum(len(view.corners or ()) for view in before)
    text = "Searched again with the camera known: "
    if corners:
        text += f"{format_count(abs(corners), 'corner')} {'more' if corners > 0 else 'fewer'}"
    else:
        text += "corners placed better"
    text += f" in {format_count(len(after), 'image')}"
    if found:
        text += f", {', '.join(shorten_names(found))} for the first time"
    return text + "."


def _describe_loss(lost: Sequence[View]) -> str:
    """Say in a sentence which images were not searched again, as the process that did died."""
    return (
        f"Searching {', '.join(shorten_names(lost))} again with the camera known broke off: what "
        "was found there before counts. Calibrate again to try it once more."
    )

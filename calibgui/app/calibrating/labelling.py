"""Labelling of the views of a result: symmetric boards are numbered alike in all of them.

Which corner is which is decided in ``engine.redetection``; here the views of a result get their
labels and a note that says so.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from calibgui.app.calibrating.calibration import shorten_names
from calibgui.dataset import Result, View
from calibgui.engine.boards import CHECKERBOARD
from calibgui.engine.calibration import Cost, Observation
from calibgui.engine.features import Corners
from calibgui.engine.redetection import (
    align_board_turns,
    apply_labels,
    calibrate_on_nominal_board,
    carry_labels,
    carry_places,
    has_open_labels,
    label_corners,
)

_NOTE = "Its corners are numbered as the board's deviations from its drawing tell."


def relabel_views(result: Result) -> tuple[View, ...]:
    """Label the corners of a result's views alike, as far as the board's deviations tell how.

    Returns:
        All views of the result. Those whose labels were known, or stay open, are the same objects.
    """
    board, used = result.board, result.used
    if result.calibration.cost is not Cost.IMAGE:
        return result.views
    if all(view.points is not None for view in used):
        if result.calibration.board_shape is None:
            return result.views  # a board without a shape hides how it is turned
        observations = result.observations()
        nominal = calibrate_on_nominal_board(result.calibration, observations)
        turned = align_board_turns(nominal, observations)
        points = dict(zip(map(id, used), turned, strict=True))
        return tuple(_replace_points(view, points.get(id(view))) for view in result.views)
    corners = [view.corners for view in used if view.corners is not None and view.points is None]
    if (
        board is None
        or board.pattern != CHECKERBOARD
        or len(corners) < len(used)
        or not any(map(has_open_labels, corners))
    ):
        return result.views
    nominal = calibrate_on_nominal_board(result.calibration, result.observations())
    labels = label_corners(nominal, corners, board)
    labelled = dict(zip(map(id, used), map(apply_labels, corners, labels), strict=True))
    return tuple(_replace_corners(view, labelled.get(id(view))) for view in result.views)


def have_same_labels(views: Sequence[View], others: Sequence[View]) -> bool:
    """Return whether two states of the same views label their corners alike."""
    pairs = zip(views, others, strict=True)
    return all(
        a is b or (a.corners and b.corners and np.array_equal(a.corners.grid, b.corners.grid))
        for a, b in pairs
    )


def carry_view_labels(view: View, before: View, after: View) -> View:
    """Label all corners of a view as those that a calibration kept were labelled anew.

    Args:
        view: the view with all its corners.
        before: the view as it was calibrated from, without outliers.
        after: the same under its new labels.
    """
    if after is before:
        return view
    if view.points is not None and before.points is not None and after.points is not None:
        xy = carry_places(before.points.xy, after.points.xy, view.points.xy)
        return replace(view, points=view.points._replace(xy=xy), note=after.note)
    if view.corners is None or before.corners is None or after.corners is None:
        return view
    corners = carry_labels(view.corners, before.corners, after.corners)
    return replace(view, corners=corners, note=after.note)


def describe_turned_boards(after: Sequence[View], before: Sequence[View]) -> Iterator[str]:
    """Name the views whose board is turned and whose corners this program did not number."""
    pairs = zip(after, before, strict=True)
    turned = [new for new, old in pairs if new is not old and new.points is not None]
    if turned:
        yield (
            f"The board is counted from the wrong end in {', '.join(shorten_names(turned))}, as "
            "its deviations from its drawing tell; there it is turned round."
        )


def _replace_points(view: View, points: Observation | None) -> View:
    """Return the view with its corners at other places on the board, if they are others."""
    if points is None or points is view.points:
        return view
    return replace(view, points=points, note=_append_note(view))


def _replace_corners(view: View, corners: Corners | None) -> View:
    """Return the view with its corners under other labels; noted if these are others."""
    if corners is None or view.corners is None or corners is view.corners:
        return view
    if np.array_equal(corners.grid, view.corners.grid):
        return replace(view, corners=corners)
    return replace(view, corners=corners, note=_append_note(view))


def _append_note(view: View) -> str:
    """Return the view's note with the sentence on its labels."""
    return f"{view.note} {_NOTE}".lstrip()

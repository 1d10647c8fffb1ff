"""A rig from the corners of its cameras: each alone first, then all together."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.calibrating.settings import Settings
from calibgui.app.photographs.detection import Detection
from calibgui.dataset import CornerSet, Result, RigPairing, RigResult, View
from calibgui.engine.boards import Board, BoardShapeModel
from calibgui.engine.calibration import Observation
from calibgui.engine.errors import CalibrationError
from calibgui.engine.rig import Rig, RigBoard, RigCamera, calibrate_rig
from calibgui.formats import ImportedCamera

CornerSets = Mapping[str, CornerSet]
"""Corners of one board by the names of the cameras."""
_MAX_RMS_RATIO = 0.8
"""Ratio of residuals with and without offsets in time up to which these are suggested."""


def search_cameras(
    pairing: RigPairing,
    search: Callable[[Sequence[str], Board | None], Detection],
    square: float | None,
    is_only: bool = True,
) -> dict[str, CornerSet]:
    """Search the photographs of all cameras for one board.

    Args:
        pairing: the cameras with their photographs.
        search: searches photographs, for a board if it is known.
        square: side of a square, mm; None if it is not stated.
        is_only: whether there is no other board, which a camera may show in place of this one.

    Raises:
        CalibrationError: from `search`, or if a camera never shows the only board.
    """
    found: dict[str, CornerSet] = {}
    board: Board | None = None
    for camera in pairing.cameras:
        try:
            detection = search([str(file) for file in camera.files.values()], board)
        except CalibrationError as error:
            if board is None or not is_only:
                raise
            raise _explain_other_board(camera.name, next(iter(found)), board) from error
        found[camera.name] = corner_set = detection.corner_set(square)
        is_shown = any(view.usable for view in corner_set.views)
        if board is not None and is_only and not is_shown:
            raise _explain_other_board(camera.name, next(iter(found)), board)
        board = board or corner_set.board  # the first camera tells it for the others
    return found


def _explain_other_board(name: str, first: str, board: Board) -> CalibrationError:
    """Say that a camera never shows the board of the first one."""
    rows, cols = board.grid_size
    return CalibrationError(
        f"{name} shows no board of {rows}x{cols} in any photograph, and {first} does.",
        "A rig takes one board before all cameras: photograph the same one, or leave out the "
        "camera that saw another.",
    )


def require_times(pairing: RigPairing) -> None:
    """Raise CalibrationError unless it is known when the photographs of all cameras were taken."""
    if not all(camera.times for camera in pairing.cameras):
        raise CalibrationError(
            "Offsets in time cannot be told in seconds: it is not known when the photographs were "
            "taken.",
            "Give their times in a table (--times FILE), or in their names.",
        )


def calibrate_photographs(
    pairing: RigPairing,
    corner_sets: Sequence[CornerSets],
    settings: Settings,
    known: Mapping[str, ImportedCamera] | None = None,
    hold: bool = False,
    estimate_offsets: bool = False,
    tell: Callable[[str], None] = lambda _: None,
    boards: Sequence[RigBoard] = (RigBoard(),),
) -> RigResult:
    """Calibrate a rig.

    Args:
        pairing: the cameras with their photographs.
        corner_sets: the corners in them, of each board.
        settings: how each camera is calibrated alone.
        known: cameras that are known beforehand, by name. One whose errors are known is estimated
            with them as prior; any other is held.
        hold: True to hold all cameras as each alone is.
        estimate_offsets: True to estimate by how much the clock of each camera is late, by the
            times of the photographs (`require_times`).
        tell: a function that is told which camera is calibrated.
        boards: what is known of the boards.

    Raises:
        CalibrationError: if a camera cannot be calibrated, naming it; or as ``calibrate_rig``.
    """
    cameras, images, observations = [], {}, {}
    for c, photographs in enumerate(pairing.cameras):
        name = photographs.name
        tell(name)
        numbers = {str(file): instant for instant, file in photographs.files.items()}
        given = (known or {}).get(name)
        seen = [corner_set[name] for corner_set in corner_sets]
        if given is None:
            camera = _calibrate_alone(name, seen, boards, numbers, settings)
        else:
            camera = _take_known(name, given, seen, numbers)
        taken = photographs.times
        times = {instant: taken[f] for instant, f in photographs.files.items() if f in taken}
        camera = replace(camera, times=times)
        cameras.append(camera.hold() if hold else camera)
        named = {instant: image for image, instant in numbers.items()}
        for b, views in enumerate(camera.views_by_board):
            for instant, view in views.items():
                images[c, instant] = named[instant]
                observations[c, b, instant] = view
    rig = calibrate_rig(cameras, None, estimate_offsets, boards)
    firsts = [next(iter(corner_set.values())) for corner_set in corner_sets]
    return RigResult(
        rig,
        pairing.instants,
        images,
        observations,
        tuple(first.board for first in firsts if first.board is not None),
        all(each.lengths_confirmed for corner_set in corner_sets for each in corner_set.values()),
        () if estimate_offsets else _suggest_offsets(cameras, boards, rig),
    )


def _suggest_offsets(
    cameras: Sequence[RigCamera], boards: Sequence[RigBoard], rig: Rig
) -> tuple[str, ...]:
    """Say in a sentence if the cameras' clocks explain that they disagree; nothing if not."""
    if not rig.disagreement:
        return ()
    try:
        moved = calibrate_rig(cameras, None, True, boards)
    except CalibrationError:  # the board was held still, or shown now and then
        return ()
    if not moved.rms < _MAX_RMS_RATIO * rig.rms:
        return ()
    return (
        "The board moved while the cameras' clocks did not agree: with one offset in time for each "
        f"camera they leave {moved.rms:.3g} px. --offsets estimates these.",
    )


def _calibrate_alone(
    name: str,
    seen: Sequence[CornerSet],
    boards: Sequence[RigBoard],
    numbers: Mapping[str, int],
    settings: Settings,
) -> RigCamera:
    """Calibrate a camera from its own photographs."""
    remedy = f"Take more of {name}, or name its camera's file: --known {name}=FILE."
    corner_set, origins = _gather_views(seen, numbers)
    shape = boards[0].shape if len(boards) == 1 else BoardShapeModel.NOMINAL
    try:
        result = _calibrate_on_shape(corner_set, settings, shape)
    except CalibrationError as error:
        raise CalibrationError(
            f"{name} alone: {error.message}", f"{error.hint} {remedy}"
        ) from error
    calibration = result.calibration
    if calibration.diagnosis is not None:
        diagnosis = calibration.diagnosis
        raise CalibrationError(f"{name} alone: {diagnosis.message}", f"{diagnosis.hint} {remedy}")
    views: list[dict[int, Observation]] = [{} for _ in seen]
    for view, observation in zip(result.used, result.observations(), strict=True):
        if _is_counted(view):
            b, instant = origins[view.image]
            views[b][instant] = observation
    return RigCamera(
        name,
        calibration.camera,
        views[0],
        calibration.fixed,
        model_error=calibration.model_error,
        others=views[1:],
    )


def _calibrate_on_shape(
    corner_set: CornerSet, settings: Settings, shape: BoardShapeModel
) -> Result:
    """Calibrate a camera on a board of a shape that is estimated with it, or on the board as drawn
    where the camera's own views do not carry that shape: those of the whole rig may."""
    try:
        return calibrate_views(corner_set, replace(settings, board_shape=shape))
    except CalibrationError:
        if shape is BoardShapeModel.NOMINAL:
            raise
        return calibrate_views(corner_set, replace(settings, board_shape=BoardShapeModel.NOMINAL))


def _gather_views(
    seen: Sequence[CornerSet], numbers: Mapping[str, int]
) -> tuple[CornerSet, dict[str, tuple[int, int]]]:
    """Gather a camera's views of all boards.

    Returns:
        The views, named after their photographs, and after their boards if there are several; and
        the numbers of board and instant by their names.
    """
    if len(seen) == 1:
        return seen[0], {image: (0, instant) for image, instant in numbers.items()}
    views, origins = [], {}
    for b, corner_set in enumerate(seen):
        for view in corner_set.views:
            if view.usable:
                image = f"{view.image} (board {b + 1})"
                points = view.observation(corner_set.board)
                views.append(replace(view, image=image, corners=None, points=points))
                origins[image] = b, numbers[view.image]
    return CornerSet(seen[0].size, tuple(views)), origins


def _take_known(
    name: str, given: ImportedCamera, seen: Sequence[CornerSet], numbers: Mapping[str, int]
) -> RigCamera:
    """Take a camera that is known from a file."""
    size = seen[0].size
    if given.camera.size != size:
        raise CalibrationError(
            f"The photographs of {name} have {size[0]} x {size[1]} px, its camera's file "
            f"{given.camera.size[0]} x {given.camera.size[1]}.",
            "Name the file of a camera with images of this size.",
        )
    first, *others = (
        {
            numbers[view.image]: view.observation(corner_set.board)
            for view in corner_set.views
            if view.usable and _is_counted(view)
        }
        for corner_set in seen
    )
    camera = RigCamera(name, given.camera, first, others=others)
    covariance = given.covariance
    if covariance is None or not np.isfinite(covariance).all():
        return camera.hold()
    errors = np.diag(covariance)
    fixed = tuple(n for n, v in zip(given.camera.names, errors, strict=True) if v == 0)
    return replace(camera, fixed=fixed, covariance=covariance)


def _is_counted(view: View) -> bool:
    """Return whether it is known which corners of the board a view shows."""
    return view.corners is None or not view.corners.relative

"""A rig from the corners of its cameras: each alone first, then all together."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.calibrating.settings import Settings
from calibgui.app.photographs.detection import Detection
from calibgui.dataset import CornerSet, RigPairing, RigResult, View
from calibgui.engine.boards import Board
from calibgui.engine.calibration import Observation
from calibgui.engine.errors import CalibrationError
from calibgui.engine.rig import Rig, RigCamera, calibrate_rig
from calibgui.formats import ImportedCamera

_MAX_RMS_RATIO = 0.8
"""Ratio of residuals with and without offsets in time up to which these are suggested."""


def search_cameras(
    pairing: RigPairing,
    search: Callable[[Sequence[str], Board | None], Detection],
    square: float | None,
) -> dict[str, CornerSet]:
    """Search the photographs of all cameras for one board.

    Args:
        pairing: the cameras with their photographs.
        search: searches photographs, for a board if it is known.
        square: side of a square, mm; None if it is not stated.

    Raises:
        CalibrationError: from `search`, or if a camera never shows the first one's board.
    """
    found: dict[str, CornerSet] = {}
    board: Board | None = None
    for camera in pairing.cameras:
        try:
            detection = search([str(file) for file in camera.files.values()], board)
        except CalibrationError as error:
            if board is None:
                raise
            raise _explain_other_board(camera.name, next(iter(found)), board) from error
        found[camera.name] = corner_set = detection.corner_set(square)
        if board is not None and not any(view.usable for view in corner_set.views):
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
    corner_sets: Mapping[str, CornerSet],
    settings: Settings,
    known: Mapping[str, ImportedCamera] | None = None,
    hold: bool = False,
    estimate_offsets: bool = False,
    tell: Callable[[str], None] = lambda _: None,
) -> RigResult:
    """Calibrate a rig.

    Args:
        pairing: the cameras with their photographs.
        corner_sets: the corners in them, by the names of the cameras.
        settings: how each camera is calibrated alone.
        known: cameras that are known beforehand, by name. One whose errors are known is estimated
            with them as prior; any other is held.
        hold: True to hold all cameras as each alone is.
        estimate_offsets: True to estimate by how much the clock of each camera is late, by the
            times of the photographs (`require_times`).
        tell: a function that is told which camera is calibrated.

    Raises:
        CalibrationError: if a camera cannot be calibrated, naming it; or as ``calibrate_rig``.
    """
    cameras, images, observations = [], {}, {}
    for c, photographs in enumerate(pairing.cameras):
        name, corner_set = photographs.name, corner_sets[photographs.name]
        tell(name)
        numbers = {str(file): instant for instant, file in photographs.files.items()}
        given = (known or {}).get(name)
        if given is None:
            camera = _calibrate_alone(name, corner_set, numbers, settings)
        else:
            camera = _take_known(name, given, corner_set, numbers)
        taken = photographs.times
        times = {instant: taken[f] for instant, f in photographs.files.items() if f in taken}
        camera = replace(camera, times=times)
        cameras.append(camera.hold() if hold else camera)
        named = {instant: image for image, instant in numbers.items()}
        for instant, view in camera.views.items():
            images[c, instant] = named[instant]
            observations[c, instant] = view
    sets = list(corner_sets.values())
    rig = calibrate_rig(cameras, estimate_offsets=estimate_offsets)
    return RigResult(
        rig,
        pairing.instants,
        images,
        observations,
        sets[0].board,
        all(corner_set.lengths_confirmed for corner_set in sets),
        () if estimate_offsets else _suggest_offsets(cameras, rig),
    )


def _suggest_offsets(cameras: Sequence[RigCamera], rig: Rig) -> tuple[str, ...]:
    """Say in a sentence if the cameras' clocks explain that they disagree; nothing if not."""
    if not rig.disagreement:
        return ()
    try:
        moved = calibrate_rig(cameras, estimate_offsets=True)
    except CalibrationError:  # the board was held still, or shown now and then
        return ()
    if not moved.rms < _MAX_RMS_RATIO * rig.rms:
        return ()
    return (
        "The board moved while the cameras' clocks did not agree: with one offset in time for each "
        f"camera they leave {moved.rms:.3g} px. --offsets estimates these.",
    )


def _calibrate_alone(
    name: str, corner_set: CornerSet, numbers: Mapping[str, int], settings: Settings
) -> RigCamera:
    """Calibrate a camera from its own photographs."""
    remedy = f"Take more of {name}, or name its camera's file: --known {name}=FILE."
    try:
        result = calibrate_views(corner_set, settings)
    except CalibrationError as error:
        raise CalibrationError(
            f"{name} alone: {error.message}", f"{error.hint} {remedy}"
        ) from error
    calibration = result.calibration
    if calibration.diagnosis is not None:
        diagnosis = calibration.diagnosis
        raise CalibrationError(f"{name} alone: {diagnosis.message}", f"{diagnosis.hint} {remedy}")
    views = {
        numbers[view.image]: observation
        for view, observation in zip(result.used, result.observations(), strict=True)
        if _is_counted(view)
    }
    return RigCamera(
        name,
        calibration.camera,
        views,
        calibration.fixed,
        model_error=calibration.model_error,
    )


def _take_known(
    name: str, given: ImportedCamera, corner_set: CornerSet, numbers: Mapping[str, int]
) -> RigCamera:
    """Take a camera that is known from a file."""
    if given.camera.size != corner_set.size:
        raise CalibrationError(
            f"The photographs of {name} have {corner_set.size[0]} x {corner_set.size[1]} px, its "
            f"camera's file {given.camera.size[0]} x {given.camera.size[1]}.",
            "Name the file of a camera with images of this size.",
        )
    views: dict[int, Observation] = {
        numbers[view.image]: view.observation(corner_set.board)
        for view in corner_set.views
        if view.usable and _is_counted(view)
    }
    covariance = given.covariance
    if covariance is None or not np.isfinite(covariance).all():
        return RigCamera(name, given.camera, views).hold()
    errors = np.diag(covariance)
    fixed = tuple(n for n, v in zip(given.camera.names, errors, strict=True) if v == 0)
    return RigCamera(name, given.camera, views, fixed, covariance)


def _is_counted(view: View) -> bool:
    """Return whether it is known which corners of the board a view shows."""
    return view.corners is None or not view.corners.relative

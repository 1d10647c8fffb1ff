"""The check of a calibration with a few new photographs of a board: is it still good?

The command line and the window ask by the same function. Nothing is calibrated, and nothing that is
stored changes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from threading import Event

from calibgui.app.calibrating.calibration import shorten_names
from calibgui.app.photographs.detection import find_views
from calibgui.dataset import CornerSet, Result, View, find_orientation
from calibgui.engine.arrays import Array
from calibgui.engine.assessment import DEFAULT_LIMIT, CalibrationCheck, check_calibration
from calibgui.engine.camera import Camera
from calibgui.engine.errors import CalibrationError

USUAL_OVERDISPERSION = 2.0
"""Ratio by which views of a printed board disagree more than noise explains, where the stored
camera does not say; calibrations from photographs find 1 to 4."""


@dataclass(frozen=True, eq=False, slots=True)
class Checked:
    """A check, with the photographs that it was made from."""

    check: CalibrationCheck
    names: tuple[str, ...]
    """Names of the photographs that show the board, in the order of the check's views."""
    corner_set: CornerSet
    """All photographs, with the reasons why some cannot be used."""


def check_with_corners(
    camera: Camera,
    covariance: Array | None,
    overdispersion: float,
    corner_set: CornerSet,
    limit: float = DEFAULT_LIMIT,
) -> Checked:
    """Check a stored camera with corners that were found in new photographs.

    Args:
        camera: the stored camera.
        covariance: (P, P) covariance of its parameters; None if it is not known.
        overdispersion: ratio by which its views disagreed more than noise explains.
        corner_set: the new photographs.
        limit: change from which the camera counts as changed, px rms.

    Raises:
        CalibrationError: if no photograph can be used.
    """
    views = [view for view in corner_set.views if view.usable]
    if not views:
        raise CalibrationError(
            "The board was found in none of the pictures.",
            "Photograph the whole board, sharp and evenly lit.",
        )
    names = shorten_names(views)
    observations = [view.observation(corner_set.board) for view in views]
    check = check_calibration(camera, observations, covariance, limit, names, overdispersion)
    return Checked(check, tuple(names), corner_set)


def check_with_photographs(
    result: Result,
    images: Sequence[Path],
    progress: Callable[[int, int, View], None] | None = None,
    stop: Event | None = None,
    limit: float = DEFAULT_LIMIT,
) -> Checked:
    """Search new photographs for the board of a result, and check its camera with them.

    Args:
        result: the calibration.
        images: files.
        progress: called after each photograph.
        stop: abandons the search when set.
        limit: change from which the camera counts as changed, px rms.

    Raises:
        CalibrationError: if the result has no board of known layout, or no photograph can be used.
        Cancelled: if `stop` was set.
    """
    board, calibration = result.board, result.calibration
    if board is None:
        raise CalibrationError(
            "It is not known which board the calibration was made with.",
            "Check with `calibgui check`, which takes corners that another program located.",
        )
    detection = find_views(
        images,
        board.grid_size,
        None,
        progress,
        stop,
        calibration.camera.size,
        find_orientation(result.used),
        pattern=board.pattern,
    )
    corner_set = detection.corner_set(board.square, board.square_sigma)
    return check_with_corners(
        calibration.camera,
        calibration.covariance,
        calibration.overdispersion,
        corner_set,
        limit,
    )

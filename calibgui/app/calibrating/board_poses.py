"""The board's pose in photographs of a camera that is known, from whatever file it was read."""

from __future__ import annotations

import numpy as np

from calibgui.dataset import CornerSet, LocatedView, PoseSet, View
from calibgui.engine.arrays import Array
from calibgui.engine.boards import Board
from calibgui.engine.calibration import locate_board
from calibgui.engine.camera import Camera
from calibgui.engine.errors import CalibrationError


def locate_boards(
    camera: Camera, corner_set: CornerSet, covariance: Array | None = None
) -> PoseSet:
    """Locate the board in every view, with the camera held.

    Args:
        camera: the camera of the photographs, and of their size.
        corner_set: the views.
        covariance: (P, P) covariance of the camera's parameters; None, or NaN in it, if it is not
            known.

    Raises:
        CalibrationError: if the photographs have another size than the camera's.
    """
    if corner_set.size != camera.size:
        (width, height), (w, h) = corner_set.size, camera.size
        raise CalibrationError(
            f"The photographs have {width} x {height} px, and the camera {w} x {h} px.",
            "Name the camera of these photographs.",
        )
    if covariance is not None and not np.isfinite(covariance).all():
        covariance = None
    views = [
        _locate_in_view(camera, view, corner_set.board, covariance)
        for view in corner_set.views
        if view.enabled
    ]
    return PoseSet(
        camera,
        tuple(views),
        corner_set.board,
        corner_set.lengths_confirmed,
        has_covariance=covariance is not None,
    )


def _locate_in_view(
    camera: Camera, view: View, board: Board | None, covariance: Array | None
) -> LocatedView:
    if not view.usable:
        return LocatedView(view.image, None, view.why_unused)
    try:
        scale_sigma = 0.0 if board is None else board.scale_sigma
        found = locate_board(camera, view.observation(board), covariance, view.name, scale_sigma)
    except CalibrationError as error:
        return LocatedView(view.image, None, str(error))
    return LocatedView(view.image, found)

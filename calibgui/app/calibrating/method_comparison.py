"""The comparison of methods side by side, on located corners or on those of a result."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from calibgui.app.calibrating.calibration import shorten_names
from calibgui.app.photographs.copies import disable_copies
from calibgui.dataset import CornerSet, Result, View
from calibgui.engine import assessment
from calibgui.engine.assessment import MethodComparison
from calibgui.engine.errors import CalibrationError, Progress
from calibgui.engine.geometry import Pose
from calibgui.engine.threads import limit_blas_threads


def compare_methods(
    corner_set: CornerSet,
    board_poses: Mapping[str, Pose] | None = None,
    progress: Progress | None = None,
) -> MethodComparison:
    """Try all methods on the usable views of a set, without copies.

    The camera that the others are compared with is the default method's.

    Args:
        corner_set: the views.
        board_poses: poses of the board in one fixed frame by the names of images, with or without
            their folders, for the direct linear transformation; None if they are not known.
        progress: a function that is told how many of how many methods are done; it may raise
            ``Cancelled``.

    Raises:
        CalibrationError, Cancelled: as ``engine.assessment.compare_methods``, or if the pose of an
            image is missing.
    """
    used = [view for view in disable_copies(corner_set).views if view.usable]
    poses = None if board_poses is None else _list_poses(used, board_poses)
    observations = [view.observation(corner_set.board) for view in used]
    with limit_blas_threads():
        return assessment.compare_methods(
            observations,
            corner_set.size,
            board_poses=poses,
            progress=progress,
            names=shorten_names(used),
        )


def compare_methods_again(
    result: Result,
    progress: Progress | None = None,
    check: Callable[[], None] | None = None,
) -> MethodComparison:
    """Try all methods on the views of a result, and compare them with its camera.

    Args:
        result: any result.
        progress, check: as for ``engine.assessment.compare_methods``.

    Raises:
        CalibrationError, Cancelled: as ``engine.assessment.compare_methods``.
    """
    camera = result.calibration.camera
    with limit_blas_threads():
        return assessment.compare_methods(
            result.observations(),
            camera.size,
            camera,
            progress=progress,
            names=shorten_names(result.used),
            check=check,
        )


def _list_poses(used: Sequence[View], board_poses: Mapping[str, Pose]) -> list[Pose]:
    """List the poses of the board in the order of the views.

    Raises:
        CalibrationError: naming the images whose poses are missing.
    """
    found = [
        board_poses.get(view.image, board_poses.get(name))
        for view, name in zip(used, shorten_names(used), strict=True)
    ]
    missing = [name for name, pose in zip(shorten_names(used), found, strict=True) if pose is None]
    if missing:
        raise CalibrationError(
            f"The board's pose is not stated for {', '.join(missing)}.",
            "State it for every image, or leave these images out.",
        )
    return [pose for pose in found if pose is not None]

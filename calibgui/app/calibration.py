"""From located corners to a result, the same for the command line and the window."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import PurePath

from threadpoolctl import threadpool_limits

from calibgui import engine
from calibgui.engine.errors import CalibrationError
from calibgui.engine.types import Cost, Report, View
from calibgui.formats.corners_json import CornerSet
from calibgui.formats.result import Result


def calibrate_views(
    corner_set: CornerSet,
    *,
    cost: Cost | str = Cost.IMAGE,
    fix: Mapping[str, float | None] | Iterable[str] = (),
    free: Iterable[str] = (),
    report: Report | None = None,
) -> Result:
    """Calibrate from the usable views of a set; the arguments are ``engine.calibrate``'s.

    Raises:
        CalibrationError: as ``engine.calibrate``, naming images, or if no view is usable.
        Cancelled: from `report`.
    """
    used = [view for view in corner_set.views if view.usable]
    if not used:
        raise CalibrationError(
            "None of the images can be used.",
            "Photograph the whole board, sharp and evenly lit, at least 3 times from different "
            "directions.",
        )
    # The matrices are small: threads would cost more than they bring.
    with threadpool_limits(1):
        calibration = engine.calibrate(
            [view.observation(corner_set.target) for view in used],
            corner_set.size,
            cost=cost,
            fix=fix,
            free=free,
            report=report,
            names=short_names(used),
        )
    return Result(calibration, corner_set.views, corner_set.target)


def short_names(views: Sequence[View]) -> list[str]:
    """The views' images without their folders, where that leaves them different."""
    names = [PurePath(view.image).name for view in views]
    return names if len(set(names)) == len(names) else [view.image for view in views]

"""The comparison of lens models side by side, on located corners or on those of a result."""

from __future__ import annotations

from calibgui.app.calibrating.calibration import shorten_names
from calibgui.app.photographs.copies import disable_copies
from calibgui.dataset import CornerSet, Result
from calibgui.engine.assessment import LensChoice, choose_lens
from calibgui.engine.calibration import METHODS, Cost, recover_arguments
from calibgui.engine.camera import PINHOLE, find_model
from calibgui.engine.errors import Progress
from calibgui.engine.threads import limit_blas_threads


def compare_lenses(corner_set: CornerSet, progress: Progress | None = None) -> LensChoice:
    """Try all lens models on the usable views of a set, without copies, and recommend one.

    Raises:
        CalibrationError, Cancelled: as ``engine.assessment.choose_lens``.
    """
    used = [view for view in disable_copies(corner_set).views if view.usable]
    observations = [view.observation(corner_set.board) for view in used]
    with limit_blas_threads():
        return choose_lens(
            observations, corner_set.size, progress=progress, names=shorten_names(used)
        )


def compare_lenses_again(result: Result, progress: Progress | None = None) -> LensChoice:
    """Try all lens models on the views of a result, calibrated as it was but for the lens.

    Focal lengths and centre are held where the user held them. The cost "paper", which has a lens
    model of its own, gives way to the error in the image, and a method that has one lens model to
    the default method.

    Raises:
        CalibrationError, Cancelled: as ``engine.assessment.choose_lens``.
    """
    settings = recover_arguments(result.calibration)
    method, model = METHODS[settings.pop("method")], settings.pop("model")
    del settings["free"]
    by_choice = set(PINHOLE) - set(find_model(model).held if method.held is None else method.held)
    settings["fix"] = {name: v for name, v in settings["fix"].items() if name in by_choice}
    if settings["cost"] is Cost.PAPER:
        settings["cost"] = Cost.IMAGE
    size = result.calibration.camera.size
    with limit_blas_threads():
        return choose_lens(result.observations(), size, progress=progress, **settings)

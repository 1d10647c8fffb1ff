"""A calibration made once more from the same views, with some of its settings changed.

It begins where the calibration ended, at its camera or at what that sees, and at its poses: no
start is looked for again, which of a wide lens takes longer than all that follows.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.methods import find_method
from calibgui.engine.calibration.methods.method import (
    start_from_calibration,
    start_from_other_model,
)
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.problem import recover_image_arguments
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.models import PINHOLE


def repeat_calibration(
    calibration: Calibration, views: Sequence[Observation], **changes: Any
) -> Calibration:
    """Repeat a calibration by the image cost and the default method.

    Args:
        calibration: a calibration with any cost.
        views: the views that it was made from.
        changes: other arguments of `calibrate` that differ; `fix` and `free` list all parameters.

    Raises:
        CalibrationError: if the views do not allow it.
    """
    settings = recover_image_arguments(calibration) | changes
    method = find_method(settings["method"])
    if settings.get("model") == calibration.camera.model:
        settings["method"] = start_from_calibration(method, calibration, range(len(views)))
    else:
        settings["method"] = start_from_other_model(method, calibration)
    return calibrate(views, calibration.camera.size, **settings)


def calibrate_by_model(
    calibration: Calibration, views: Sequence[Observation], model: str, **changes: Any
) -> Calibration:
    """Repeat a calibration with another lens model, without the errors that no cause explains.

    Args:
        calibration: a calibration with any cost; of what was held the pinhole's values still are.
        views: the views that it was made from.
        model: the lens model.
        changes: other arguments of `calibrate` that differ.

    Raises:
        CalibrationError: if the model does not follow the lens, or the views do not determine it.
    """
    fix = recover_image_arguments(calibration)["fix"] | changes.pop("fix", {})
    held = {name: value for name, value in fix.items() if name in PINHOLE}
    settings = {"model": model, "free": (), "fix": held, "model_errors": False} | changes
    return repeat_calibration(calibration, views, **settings)

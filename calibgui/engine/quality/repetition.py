"""The arguments with which a calibration can be repeated on other views of the same camera."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from calibgui.engine.types import Calibration, Observation, Plate, PlateModel, Prior


def settings_of(calibration: Calibration) -> dict[str, Any]:
    """Keyword arguments of ``calibrate``: cost, lens, held parameters with their values, plate,
    and what was known of it."""
    camera = calibration.camera
    values = dict(zip(camera.names, camera.params.tolist(), strict=True))
    held = {name: values[name] for name in calibration.fixed}
    plate: Plate | PlateModel = PlateModel.NOMINAL
    if calibration.plate is not None:
        held_plate = calibration.settings.get("plate_held", False)
        plate = calibration.plate if held_plate else calibration.plate.model
    prior = calibration.settings.get("prior_mm")
    return {
        "cost": calibration.cost,
        "model": camera.model,
        "fix": held,
        "free": [name for name in values if name not in held],
        "plate": plate,
        "prior": None if prior is None else Prior(*prior),
    }


def as_drawn(views: Sequence[Observation]) -> Plate:
    """The nominal plate of views, to be held: many calibrations on it need not doubt it anew."""
    places = np.unique(np.round(np.concatenate([view.xy for view in views]), 9), axis=0)
    none = np.zeros((len(places), 3))
    return Plate(PlateModel.NOMINAL, places, none, none)

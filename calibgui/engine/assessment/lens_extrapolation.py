"""The error of pixels beyond the corners, where the formula of a lens model is all that is known.

Where there are corners they tell what a lens does; beyond them its formula does, and another one
goes on otherwise. A standard deviation takes the formula for true and knows nothing of that. So a
model of another kind with about as many coefficients is fitted to the same corners, and how far
apart the two image the same directions counts as an error beside it.

Of 72 sets of 12 views with corners good to 0.012 px, of nine lenses and two models, the largest
error of a pixel was more than twice the largest standard deviation in 15, and up to 6.4 times; it
was at most 1.4 times the two together. Of fisheyes in a rational model, Mei's and Scaramuzza's the
first was up to 54 times, the second 1.3. It does not measure what all formulas have in common: that
a lens is smooth.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.changes.comparison import compare_cameras
from calibgui.engine.assessment.residuals.residual_statistics import summarise_residuals
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.repetition import calibrate_by_model
from calibgui.engine.calibration.result import Calibration, Cost
from calibgui.engine.camera.models import find_model
from calibgui.engine.errors import CalibrationError
from calibgui.engine.uncertainty.projection_uncertainty import make_map_grid

_BY_ANGLE = "kannala-brandt"
_OTHERS = {
    "lucchese": "brown-conrady",
    "pinhole": "brown-conrady",
    "brown-conrady": "lucchese",
    "brown-conrady-4": "lucchese",
    _BY_ANGLE: "scaramuzza",
    "kannala-brandt-decentering": "scaramuzza",
}
"""The model that is fitted beside each; beside all others a polynomial in the angle."""
_MAX_RELATIVE_RMS = 1.1
"""Residual rms of the other model, over the calibration's, up to which it fits as well. Noise and a
formula that is right make it 1.06; a model that cannot follow the lens says nothing of it."""


def map_disagreement(calibration: Calibration, views: Sequence[Observation]) -> Array:
    """Map how far (m, n) px another lens model that fits as well images the same directions from
    the pixels of a calibration; 0 where corners cover the image, and where no other is known, as
    for a spline, which has no other kind.

    Args:
        calibration: a calibration with any cost.
        views: the views that it was made from.
    """
    camera = calibration.camera
    u, v = make_map_grid(camera.size)
    none = np.zeros((len(v), len(u)))
    if calibration.cost is Cost.PAPER or find_model(camera.model).control_points is not None:
        return none
    model = _OTHERS.get(camera.model, _BY_ANGLE)
    board = calibration.board_shape
    held = {} if board is None else {"board_shape": board}
    try:
        other = calibrate_by_model(calibration, views, model, **held)
        apart = compare_cameras(camera, other.camera, views=views)
    except CalibrationError:
        return none
    rms = summarise_residuals(other.residuals).rms
    if rms > _MAX_RELATIVE_RMS * summarise_residuals(calibration.residuals).rms:
        return none
    return np.where(apart.region, 0.0, np.nan_to_num(apart.length))

"""The choice of a model of the board's shape, by what it says of views that it has not seen.

A shape with more unknowns than the views can carry lowers the residuals but raises the errors on
unseen views (``calibration/leave_one_out.py``). The comparison is paired: view by view, by the
logarithm of the ratio of these errors, and a richer model is taken only if the mean exceeds twice
its standard error and 1 %.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from calibgui.engine.arrays import Array, Size
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.leave_one_out import LeftOut, leave_views_out
from calibgui.engine.calibration.methods import find_method
from calibgui.engine.calibration.methods.method import keep_calibration
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import DEFAULT_METHOD, Calibration
from calibgui.engine.camera.models import find_model
from calibgui.engine.errors import CalibrationError
from calibgui.engine.threads import with_one_blas_thread

_MIN_GAIN_IN_STANDARD_ERRORS = 2.0
"""Mean gain over its standard error above which a richer model is taken."""
MIN_RELATIVE_GAIN = 0.01
"""Mean relative gain above which a richer model is taken."""
_MAX_DEVIATION = 0.01
"""Deviation of a board over its length, up to which its shape is estimated from where a flat board
leaves the camera. Of 24 rendered boards that were bowed by 7 to 14 % of their length, and deviated
by 1.8 % at least, that failed in 13. From the beginning the shape of 43 of 48 boards that were
bowed by 10 to 14 % was found, and of 47 from where a bowed one leaves the camera."""
_REASON_LENS = "It would stand in for the lens, which the lens model does not follow."
"""Reason why a board shape is not tried with a lens model that does not fit."""


@dataclass(frozen=True, eq=False, slots=True)
class BoardShapeChoice:
    """The model of the board's shape that predicts unseen views best."""

    model: BoardShapeModel
    """The recommended model."""
    validations: dict[BoardShapeModel, LeftOut]
    """Errors on unseen views of every model that the views can carry."""
    refused: dict[BoardShapeModel, str]
    """Reasons why the other models could not be tried, or were not."""
    nominal: Calibration
    """Calibration from all views with the board as drawn."""
    chosen: Calibration
    """Calibration from all views with the recommended model."""

    @property
    def recommendation(self) -> str:
        """Sentence that recommends a model, with its figures."""
        before = self.validations[BoardShapeModel.NOMINAL].held_out
        if (error := self.nominal.lens_error) > 0:
            lens = find_model(self.nominal.camera.model).short_title
            return (
                f"Keep the board as drawn: the lens model {lens} leaves "
                f"{error:.2g} px that it cannot follow, which a board shape would stand in for. "
                "The lens comes first: choose a model that follows it, and then the board's shape."
            )
        if self.chosen.board_shape is None:
            return (
                "Keep the board as drawn: no estimated shape predicts unseen views better than "
                f"its {before:.3f} px."
            )
        after = self.validations[self.model].held_out
        move = self.chosen.camera.params - self.nominal.camera.params
        return (
            f"Your board deviates by {self.chosen.board_shape.rms:.2f} mm rms; using the estimated "
            f"shape ({self.model}) moves fx by {move[0]:+.2g} px and the centre by "
            f"({move[2]:+.2g}, {move[3]:+.2g}) px. It lowers the error on unseen views from "
            f"{before:.3f} to {after:.3f} px, {100 * (1 - after / before):.0f} %."
        )


@with_one_blas_thread
def choose_board_shape(
    views: Sequence[Observation | tuple[Array, Array]],
    size: Size,
    nominal: Calibration | None = None,
    **settings: Any,
) -> BoardShapeChoice:
    """Try all models of the board's shape on unseen views and recommend one.

    Where the lens model does not follow the lens (``Calibration.lens_error``), a board of another
    shape predicts unseen views better, too, although the board is true: none is tried then.

    A board that is far from flat leads the camera astray: to where a shape cannot be estimated
    from. Its bow is then estimated from the beginning, and its corners from there.

    Args:
        views, size, settings: as for ``calibrate``, without `board_shape`; `names` are not used.
        nominal: a calibration of all views with the same settings and the board as drawn, if it is
            at hand.

    Raises:
        CalibrationError: as ``calibrate`` with the board as drawn, or if one of the views cannot be
            spared.
    """
    seen = [Observation(*view) for view in views]
    further = {name: settings[name] for name in settings.keys() - {"names", "method"}}
    method = find_method(settings.get("method", DEFAULT_METHOD))
    best, nominal = BoardShapeModel.NOMINAL, nominal or calibrate(seen, size, **settings)
    validations = {best: leave_views_out(nominal, seen)}
    refused: dict[BoardShapeModel, str] = {}
    extent = np.ptp(np.concatenate([view.xy for view in seen]), axis=0).max()
    is_near = nominal.board_shape_error <= _MAX_DEVIATION * extent
    chosen, start = nominal, keep_calibration(method, nominal) if is_near else method
    for model in BoardShapeModel:
        if model is BoardShapeModel.NOMINAL:
            continue
        if nominal.lens_error > 0:
            refused[model] = _REASON_LENS
            continue
        try:
            whole = calibrate(seen, size, board_shape=model, method=start, **further)
            validations[model] = leave_views_out(whole, seen)
        except CalibrationError as error:
            refused[model] = error.message
            continue
        if model is BoardShapeModel.BOW and not is_near:
            start = keep_calibration(method, whole)
        if predicts_better(validations[model].by_view, validations[best].by_view):
            best, chosen = model, whole
    return BoardShapeChoice(best, validations, refused, nominal, chosen)


def predicts_better(candidate: Array, incumbent: Array) -> bool:
    """Return whether errors (K,) are lower than others of the same views, beyond chance and 1 %."""
    gain = np.log(incumbent / candidate)
    error = gain.std(ddof=1) / np.sqrt(len(gain))
    return bool(gain.mean() > max(_MIN_GAIN_IN_STANDARD_ERRORS * error, MIN_RELATIVE_GAIN))

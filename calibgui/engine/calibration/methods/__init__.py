"""The methods of calibration, one file each: how a camera is guessed, and how the guess is refined.

To add a method, write one module with a `Method` (``method.py``) and name it in `METHODS`: solver,
comparison, command line, window and files take it from there.
"""

from __future__ import annotations

from calibgui.engine.calibration.methods.bouguet import BOUGUET, BOUGUET_K3, BOUGUET_SKEW
from calibgui.engine.calibration.methods.heikkila_silven import HEIKKILA_SILVEN
from calibgui.engine.calibration.methods.lucchese import LUCCHESE
from calibgui.engine.calibration.methods.method import Method
from calibgui.engine.calibration.methods.opencv_calibration import OPENCV
from calibgui.engine.calibration.methods.tsai import TSAI, TSAI_CLOSED_FORM
from calibgui.engine.calibration.methods.weng import WENG
from calibgui.engine.calibration.methods.zhang import ZHANG, ZHANG_ALTERNATION, ZHANG_CLOSED_FORM
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.models import MODELS
from calibgui.engine.camera.models.splined_stereographic import PREFIX
from calibgui.engine.errors import CalibrationError

METHODS: dict[str, Method] = {
    method.name: method
    for method in (
        LUCCHESE,
        BOUGUET,
        BOUGUET_SKEW,
        BOUGUET_K3,
        ZHANG,
        ZHANG_CLOSED_FORM,
        ZHANG_ALTERNATION,
        HEIKKILA_SILVEN,
        TSAI_CLOSED_FORM,
        TSAI,
        WENG,
        OPENCV,
    )
}
"""All methods by name."""


def find_method(name: str | Method) -> Method:
    """Return the method of a name; a method is returned as it is.

    Raises:
        CalibrationError: if there is no such method.
    """
    if isinstance(name, Method):
        return name
    if name not in METHODS:
        raise CalibrationError(
            f"There is no calibration method {name!r}.", f"Choose from {', '.join(METHODS)}."
        )
    return METHODS[name]


def check_method(method: Method, model: str, cost: Cost) -> None:
    """Check that a method can estimate a lens model, and minimise a cost.

    Args:
        method: the method.
        model: a key of ``camera.models.MODELS``, or the id of a splined model.
        cost: what to minimise.

    Raises:
        CalibrationError: if it cannot.
    """
    if (model if model in MODELS else PREFIX) not in method.lens_models:
        raise CalibrationError(
            f"The method {method.name!r} cannot estimate the lens model {model!r}.",
            f"Choose from {', '.join(method.lens_models)}.",
        )
    if cost not in method.costs:
        raise CalibrationError(
            f"The method {method.name!r} cannot minimise the cost {cost.value!r}.",
            f"Choose from {', '.join(c.value for c in method.costs)}.",
        )

"""Held values that the views contradict so much that no camera has them.

Such a value leaves the views undetermined, or the solve without a start. An error about the views
would send the user after photographs that are good.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any, ParamSpec, TypeVar

from calibgui.engine.calibration.refinement.levenberg_marquardt import StartError
from calibgui.engine.calibration.result import DegenerateError
from calibgui.engine.errors import CalibrationError

_P = ParamSpec("_P")
_T = TypeVar("_T")


def blame_held_values(calibrate: Callable[_P, _T]) -> Callable[_P, _T]:
    """Decorate ``calibrate`` to name held values if the views can be calibrated without them."""

    @wraps(calibrate)
    def checked(*args: _P.args, **kwargs: _P.kwargs) -> _T:
        try:
            return calibrate(*args, **kwargs)
        except (DegenerateError, StartError) as error:
            fix = kwargs.get("fix")
            if not isinstance(fix, Mapping):
                raise
            held = {name: value for name, value in fix.items() if value is not None}
            if not held:
                raise
            freed: dict[str, Any] = kwargs | {"fix": [n for n in fix if n not in held]}
            try:
                calibrate(*args, **(freed | {"report": None}))
            except CalibrationError:
                raise error from None
            listed = ", ".join(f"{name} = {value:g}" for name, value in held.items())
            raise CalibrationError(
                f"The views contradict {listed}, which is held: without it they can be calibrated.",
                f"Free {', '.join(held)}, or check where the value comes from.",
            ) from error

    return checked

"""What is asked of some views, and the checks of how it is asked."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np

from calibgui.engine.arrays import IntArray, Size
from calibgui.engine.boards.shape import BoardShape
from calibgui.engine.calibration.initialisation.stage_one import Prealignment
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.models import MODELS, parameter_names
from calibgui.engine.errors import CalibrationError

_FARTHEST = 100.0
"""Of focal lengths and coordinates of the centre that can be held, in image widths."""


class Options(NamedTuple):
    """What is asked of some views, whatever they answer."""

    size: Size
    """Of the images, px."""
    model: str
    """The lens, a key of ``lens.MODELS``."""
    cost: Cost
    scale: float
    """Reference px per mm."""
    names: tuple[str, ...]
    """(P,) of the camera's parameters."""
    held: Mapping[str, float]
    """Those that the user holds, with their values."""
    first: Prealignment
    """Stage I of the views."""
    board_shape: BoardShape | None
    """To be held."""
    settings: Mapping[str, Any]

    @property
    def free(self) -> IntArray:
        """Places of the parameters to estimate."""
        return np.flatnonzero([name not in self.held for name in self.names])


def held_parameters(
    fix: Mapping[str, float | None] | Iterable[str] | str,
    free: Iterable[str] | str,
    model: str,
    size: Size,
) -> dict[str, float | None]:
    """Names of the parameters to hold, with the values asked for, None for the default.

    Args:
        fix: those to hold.
        free: those to estimate although the lens model holds them by default.
        model: the lens, a key of ``lens.MODELS``.
        size: of the images, px.

    Raises:
        CalibrationError: for a parameter that there is not, a value that no camera has, or a
            parameter that is both held and freed.
    """
    names = parameter_names(model)
    fix, freed = ([given] if isinstance(given, str) else given for given in (fix, free))
    asked = dict(fix) if isinstance(fix, Mapping) else dict.fromkeys(fix)
    freed = set(freed)
    for name in [*asked, *freed]:
        if name not in names:
            raise CalibrationError(
                f"The lens model {model!r} has no parameter {name!r}.",
                f"Choose from {', '.join(names)}.",
            )
    for name, value in asked.items():
        if value is not None:
            _check_value(name, value, size)
    if both := freed & asked.keys():
        raise CalibrationError(
            f"{', '.join(sorted(both))} cannot be both held and freed.", "Name it once."
        )
    default = dict.fromkeys(name for name in MODELS[model].held if name not in freed)
    return default | asked


def _check_value(name: str, value: float, size: Size) -> None:
    """Refuse to hold a parameter at a value that no camera has."""
    most = _FARTHEST * max(size)
    low, high = {"f": (0.0, most), "c": (-most, most)}.get(name[0], (-np.inf, np.inf))
    if not low < value < high:
        raise CalibrationError(
            f"{name} cannot be held at {value}.",
            "Focal lengths are positive, in pixels, and the centre is near the image.",
        )

"""The options of a calibration, and the checks of the parameters that a user holds or frees."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np

from calibgui.engine.arrays import IntArray, Size
from calibgui.engine.boards.shape import BoardShape
from calibgui.engine.calibration.result import Cost, StageOneTable
from calibgui.engine.camera.models import find_model, list_parameter_names
from calibgui.engine.errors import CalibrationError

_MAX_HELD = 100.0
"""Largest focal length or coordinate of the centre that can be held, in the image's longer side."""


class Options(NamedTuple):
    """Everything that a calibration is to do with its views, whatever they turn out to say."""

    size: Size
    """Width and height of the images, px."""
    model: str
    """The lens model, a key of ``camera.models.MODELS``."""
    cost: Cost
    """The cost to minimise."""
    scale: float
    """Scale of the virtual reference image, reference px per mm."""
    names: tuple[str, ...]
    """(P,) names of the camera's parameters."""
    held: Mapping[str, float]
    """Parameters that are held, with their values."""
    stage_one: StageOneTable
    """Stage I of the views, for the result."""
    board_shape: BoardShape | None
    """A board shape to hold; None for the drawing, or if the shape is estimated."""
    settings: Mapping[str, Any]
    """The arguments of the calibration as its result records them."""

    @property
    def free(self) -> IntArray:
        """Indices of the parameters to estimate, ascending."""
        return np.flatnonzero([name not in self.held for name in self.names])


def resolve_held_parameters(
    fix: Mapping[str, float | None] | Iterable[str] | str,
    free: Iterable[str] | str,
    model: str,
    size: Size,
    default: tuple[str, ...] | None = None,
) -> dict[str, float | None]:
    """Find the parameters to hold, with the values wanted, None for the default value.

    Args:
        fix: names of parameters to hold, with or without values.
        free: names of parameters to estimate although they are held by default.
        model: the lens model, a key of ``camera.models.MODELS``.
        size: width and height of the images, px.
        default: names of the parameters that are held by default; None for those of the lens model.

    Raises:
        CalibrationError: if a parameter does not exist, is both held and freed, or is held at a
            value that no camera has.
    """
    names = list_parameter_names(model)
    fix, freed = ([given] if isinstance(given, str) else given for given in (fix, free))
    wanted = dict(fix) if isinstance(fix, Mapping) else dict.fromkeys(fix)
    freed = set(freed)
    for name in [*wanted, *freed]:
        if name not in names:
            raise CalibrationError(
                f"The lens model {model!r} has no parameter {name!r}.",
                f"Choose from {', '.join(names)}.",
            )
    for name, value in wanted.items():
        if value is not None:
            _check_value(name, value, size)
    if both := freed & wanted.keys():
        raise CalibrationError(
            f"{', '.join(sorted(both))} cannot be both held and freed.", "Name it once."
        )
    usual = find_model(model).held if default is None else default
    return dict.fromkeys(name for name in usual if name not in freed) | wanted


def _check_value(name: str, value: float, size: Size) -> None:
    """Refuse to hold a parameter at a value that no camera has."""
    most = _MAX_HELD * max(size)
    low, high = {"f": (0.0, most), "c": (-most, most)}.get(name[0], (-np.inf, np.inf))
    if not low < value < high:
        raise CalibrationError(
            f"{name} cannot be held at {value}.",
            "Focal lengths are positive, in pixels, and the centre is near the image.",
        )

"""How to calibrate, as the window keeps it and the command line is given it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from calibgui.engine.boards import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration import Cost
from calibgui.engine.camera import parameter_names
from calibgui.engine.errors import CalibrationError

NAMES = parameter_names("lucchese")
"""The intrinsics of the lens that is estimated."""


@dataclass(frozen=True, slots=True)
class Settings:
    """How to calibrate; ``again.calibrate_twice`` does."""

    cost: Cost = Cost.IMAGE
    fixed: Mapping[str, float | None] = field(default_factory=dict)
    """Intrinsics to hold, at their values unless these are left open."""
    freed: tuple[str, ...] = ()
    """Names of intrinsics to estimate that are held by default."""
    board_shape: BoardShapeModel | BoardShape | None = BoardShapeModel.NOMINAL
    """The board's shape: a model to estimate, a plate to hold, or None for the model that
    predicts unseen views best."""
    prior: BoardShapePrior | None = None
    """What is known of a free plate."""
    robust: bool = False
    """Whether to leave outliers out."""
    weigh_views: bool = False
    """Whether to weigh every view by the noise that is found in it; with the image cost only."""
    once: bool = False
    """Whether to leave out the search with the camera known, and what it would gain."""


USUAL = Settings()


def names_in(text: str) -> tuple[str, ...]:
    """The intrinsics listed in "k3, p1". Raises CalibrationError for what is none."""
    return tuple(map(_name, text.split(",")))


def held_in(text: str) -> dict[str, float | None]:
    """Intrinsics to hold, with values where given, as listed in "k3, p1=0, fx=650".

    Raises:
        CalibrationError: for what is no intrinsic, or no value of it.
    """
    parts = [part.partition("=") for part in text.split(",")]
    return {_name(name): _value(name, value) if equals else None for name, equals, value in parts}


def _name(text: str) -> str:
    name = text.strip()
    if name not in NAMES:
        raise CalibrationError(
            f"{name!r} is none of the intrinsics.", f"Choose from {', '.join(NAMES)}."
        )
    return name


def _value(name: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value) or (name.strip() in ("fx", "fy") and value <= 0):
        raise CalibrationError(
            f"{text!r} cannot be the value of {name.strip()}.", "State a number, as k3=0."
        )
    return value

"""How to calibrate, as the window keeps it and the command line is given it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from calibgui.engine.boards import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration import DEFAULT_METHOD, METHODS, Cost
from calibgui.engine.camera import MODELS, parameter_names
from calibgui.engine.errors import CalibrationError

DEFAULT_MODEL = "lucchese"
"""Name of the lens model that is estimated unless the user chooses another."""
_PAPER_MODEL = "lucchese-pixels"
"""Name of the lens model of the cost "paper", which the engine takes with that cost alone."""
MODEL_CHOICES = tuple(name for name in MODELS if name != _PAPER_MODEL)
"""Names of the lens models that the user can choose from."""


@dataclass(frozen=True, slots=True)
class Settings:
    """The settings of a calibration: the input of ``redetection.calibrate_twice``."""

    cost: Cost = Cost.IMAGE
    model: str = DEFAULT_MODEL
    """Name of the lens model, one of `MODEL_CHOICES`. The cost "paper" takes the printed lens of
    the paper instead of the default."""
    method: str = DEFAULT_METHOD
    """Name of the method of calibration, a key of ``calibration.METHODS``."""
    fixed: Mapping[str, float | None] = field(default_factory=dict)
    """Intrinsics to hold, with their values; None stands for the engine's default value."""
    freed: tuple[str, ...] = ()
    """Names of intrinsics to estimate that are held by default."""
    board_shape: BoardShapeModel | BoardShape | None = BoardShapeModel.NOMINAL
    """The board's shape: a model to estimate, a known shape to hold, or None for the model that
    predicts unseen views best."""
    prior: BoardShapePrior | None = None
    """Standard deviations that are known beforehand of a free board shape, mm."""
    robust: bool = False
    """True if outliers are to be left out."""
    weigh_views: bool = False
    """True if every view is to be weighed by the noise found in it; with the image cost only."""
    once: bool = False
    """True if images are not to be searched again with the calibrated camera."""


DEFAULT_SETTINGS = Settings()


def check_settings(settings: Settings) -> None:
    """Refuse settings that do not go together.

    Raises:
        CalibrationError: for a lens model or a method that cannot be chosen, a lens model that the
            cost "paper" does not take, a parameter that the model does not have or that is both
            held and freed, or weighing of views with a cost that knows no weights.
    """
    if settings.model not in MODEL_CHOICES:
        raise CalibrationError(
            f"The lens model {settings.model!r} cannot be chosen.",
            f"Choose from {', '.join(MODEL_CHOICES)}.",
        )
    if settings.method not in METHODS:
        raise CalibrationError(
            f"There is no calibration method {settings.method!r}.",
            f"Choose from {', '.join(METHODS)}.",
        )
    if settings.cost is Cost.PAPER and settings.model != DEFAULT_MODEL:
        raise CalibrationError(
            f"The cost 'paper' has its own lens model and cannot be combined with "
            f"{settings.model!r}.",
            "Choose the cost 'image' for this lens model.",
        )
    for name in (*settings.fixed, *settings.freed):
        check_parameter(name, settings.model)
    if both := settings.fixed.keys() & set(settings.freed):
        raise CalibrationError(
            f"{', '.join(sorted(both))} cannot be both held and freed.", "Name it once."
        )
    if settings.weigh_views and settings.cost is not Cost.IMAGE:
        raise CalibrationError(
            f"The cost {settings.cost.value!r} weighs all corners alike.",
            "Weigh views by their noise with the cost 'image'.",
        )


def check_parameter(name: str, model: str) -> None:
    """Refuse a name that is none of the parameters of a lens model.

    Raises:
        CalibrationError: with the names that there are.
    """
    names = parameter_names(model)
    if name not in names:
        raise CalibrationError(
            f"The lens model {model!r} has no parameter {name!r}.",
            f"Choose from {', '.join(names)}.",
        )


def parse_names(text: str, model: str = DEFAULT_MODEL) -> tuple[str, ...]:
    """Read a list of a lens model's parameters such as "k3, p1".

    Raises:
        CalibrationError: for a name that is none of the model's parameters.
    """
    return tuple(_parse_name(name, model) for name in text.split(","))


def parse_fixed(text: str, model: str = DEFAULT_MODEL) -> dict[str, float | None]:
    """Read a list of parameters to hold, with values where given, such as "k3, p1=0, fx=650".

    Raises:
        CalibrationError: for a name that is none of the model's parameters, or a value that the
            parameter cannot have.
    """
    fixed: dict[str, float | None] = {}
    for part in text.split(","):
        name, equals, value = part.partition("=")
        name = _parse_name(name, model)
        fixed[name] = _parse_value(name, value) if equals else None
    return fixed


def _parse_name(text: str, model: str) -> str:
    name = text.strip()
    check_parameter(name, model)
    return name


def _parse_value(name: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value) or (name in ("fx", "fy") and value <= 0):
        raise CalibrationError(
            f"{text!r} cannot be the value of {name}.", "State a number, as k3=0."
        )
    return value

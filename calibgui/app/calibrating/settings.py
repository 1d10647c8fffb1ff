"""Settings say how to calibrate, as the window keeps them and the command line is given them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from calibgui.dataset import KnownCamera
from calibgui.engine.assessment import AUTO, Change
from calibgui.engine.boards import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration import DEFAULT_METHOD, METHODS, Calibration, Cost, check_method
from calibgui.engine.camera import (
    MODELS,
    PINHOLE,
    list_parameter_names,
    resolve_model_id,
    suggest_model,
)
from calibgui.engine.errors import CalibrationError

DEFAULT_MODEL = "lucchese"
"""Name of the lens model that is estimated unless the user chooses another."""
AUTO_MODEL = "auto"
"""Word of files and of the command line for a lens model that is chosen automatically."""
_PAPER_MODEL = "lucchese-pixels"
"""Name of the lens model of the cost "paper", which the engine takes with that cost alone."""
MODEL_CHOICES = tuple(name for name in MODELS if name != _PAPER_MODEL)
"""Names of the lens models that the user can choose from, and there are splined models with other
numbers of control points."""
_MAX_LISTED = 20
"""Number of parameters that a message lists, at most."""


@dataclass(frozen=True, slots=True)
class Settings:
    """The settings of a calibration: the input of ``redetection.calibrate_twice``."""

    cost: Cost = Cost.IMAGE
    model: str | None = DEFAULT_MODEL
    """Name of the lens model, which `resolve_model_choice` takes, or None for the one that the
    views demand (``engine.assessment.choices.lens_choice``). The cost "paper" takes
    the printed lens of the paper instead of the default."""
    candidates: tuple[str, ...] = ()
    """Names of the lens models among which one is chosen where `model` is None; empty for all."""
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
    """Standard deviations of the corners of a board as drawn or of free shape that are known
    beforehand, mm."""
    robust: bool = False
    """True if outliers are to be left out."""
    weigh_views: bool = False
    """True if every view is to be weighed by the noise found in it; with the image cost only."""
    once: bool = False
    """True if images are not to be searched again with the calibrated camera."""
    improve: bool = False
    """True if what makes the camera better and needs no new photograph is carried out
    (``best_camera.py``), as far as the settings leave it open: lens model and board shape where
    they are None, and which corners and views count."""
    known: KnownCamera | None = None
    """The camera that is held, so that boards are located only and no other setting counts; None
    for one that is to be calibrated."""


DEFAULT_SETTINGS = Settings()
"""The paper's camera, as asked: nothing is chosen, and nothing is carried out."""
BEST_SETTINGS = Settings(model=None, board_shape=None, improve=True)
"""The settings that the window and the command line begin with: the best camera."""


def state_board_shape(settings: Settings, calibration: Calibration) -> Settings:
    """Return the settings with the board's shape that a calibration has, if it is to be chosen."""
    if settings.board_shape is not None:
        return settings
    return replace(
        settings, board_shape=calibration.settings.board_shape or BoardShapeModel.NOMINAL
    )


def takes_remedies(settings: Settings) -> bool:
    """Return whether lens model and board shape may change: not beside another method or cost."""
    return settings.method == DEFAULT_METHOD and settings.cost is Cost.IMAGE


def change_settings(settings: Settings, model: str, change: Change) -> Settings:
    """Return the settings with a change.

    Args:
        settings: the settings as they are.
        model: name of the lens model that the change is about.
        change: the change.
    """
    fixed, freed = settings.fixed, settings.freed
    if change.takes_image_cost:
        settings = replace(settings, cost=Cost.IMAGE, method=DEFAULT_METHOD)
    if change.lens_model is not None:
        chosen = None if change.lens_model == AUTO else change.lens_model
        settings = replace(settings, model=chosen)
        fixed, freed = {name: value for name, value in fixed.items() if name in PINHOLE}, ()
    elif change.holds_at_zero:  # a model that is chosen anew may have no such coefficient
        held = DEFAULT_MODEL if settings.cost is Cost.PAPER else model
        settings = replace(settings, model=held)
    if change.board_shape is not None:
        shape = None if change.board_shape == AUTO else BoardShapeModel(change.board_shape)
        settings = replace(settings, board_shape=shape, prior=None)
    changed = (*change.releases, *change.frees, *change.holds_at_zero)
    fixed = {name: value for name, value in fixed.items() if name not in changed}
    freed = tuple(name for name in freed if name not in changed)
    return replace(
        settings,
        fixed={**fixed, **dict.fromkeys(change.holds_at_zero, 0.0)},
        freed=(*freed, *change.frees),
        robust=settings.robust or change.leaves_out_corners,
        weigh_views=settings.weigh_views or change.weighs_views,
    )


def read_model_choice(text: str) -> str | None:
    """Read the name of a lens model as `resolve_model_choice` does; None for `AUTO_MODEL`."""
    return None if text == AUTO_MODEL else resolve_model_choice(text)


def resolve_model_choice(model: str) -> str:
    """Return the present name of a lens model that the user can choose.

    Raises:
        CalibrationError: if there is none, with the names to choose from.
    """
    hint = (
        f"{suggest_model(model)}Choose from {AUTO_MODEL}, {', '.join(MODEL_CHOICES)}; "
        "splined-stereographic-40x30-120 would be one with 40 x 30 control points over 120 degrees."
    )
    try:
        current = resolve_model_id(model)
    except CalibrationError as error:  # which lists the model of the cost "paper" as well
        raise CalibrationError(error.message, hint) from error
    if current == _PAPER_MODEL:
        raise CalibrationError(f"The lens model {model!r} cannot be chosen.", hint)
    return current


def check_settings(settings: Settings) -> None:
    """Refuse settings that do not go together.

    Raises:
        CalibrationError: for a lens model or a method that cannot be chosen, a lens model, cost,
            board shape or weighing that the method does not take, a lens model that the cost
            "paper" does not take, a parameter that the model does not have or that is both held and
            freed, or weighing of views with a cost that knows no weights.
    """
    if settings.model is not None:
        resolve_model_choice(settings.model)
    if settings.method not in METHODS:
        raise CalibrationError(
            f"There is no calibration method {settings.method!r}.",
            f"Choose from {', '.join(METHODS)}.",
        )
    if settings.cost is Cost.PAPER and settings.model != DEFAULT_MODEL:
        raise CalibrationError(
            f"The cost 'paper' has its own lens model and cannot be combined with "
            f"{settings.model or AUTO_MODEL!r}.",
            "Choose the cost 'image' for this lens model.",
        )
    _check_method(settings)
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


def _check_method(settings: Settings) -> None:
    """Refuse what the method of the settings does not take.

    Raises:
        CalibrationError: naming the method.
    """
    method = METHODS[settings.method]
    if settings.model is not None:
        check_method(method, settings.model, settings.cost)
    elif method.name != DEFAULT_METHOD:
        raise CalibrationError(
            f"The lens model is not chosen automatically for the method {method.name!r}.",
            f"Choose from {', '.join(method.lens_models)}.",
        )
    if method.is_weighted:
        return
    if settings.board_shape is not BoardShapeModel.NOMINAL:
        raise CalibrationError(
            f"The method {method.name!r} takes the board as it is drawn.",
            f"Use the method {DEFAULT_METHOD!r} with another board shape.",
        )
    if settings.weigh_views:
        raise CalibrationError(
            f"The method {method.name!r} takes all corners as equally good.",
            f"Weigh views by their noise with the method {DEFAULT_METHOD!r}.",
        )


def get_own_model(method: str) -> str:
    """Return the name of the lens model that a method, by its name, was published with."""
    return METHODS[method].lens_models[0]


def list_parameters(model: str | None) -> tuple[str, ...]:
    """List the parameters that can be held with a lens model.

    If the lens model is yet to be chosen (None), these are the ones that every model has.
    """
    return PINHOLE if model is None else list_parameter_names(model)


def check_parameter(name: str, model: str | None) -> None:
    """Refuse a name that is none of the parameters of a lens model, None for one to be chosen.

    Raises:
        CalibrationError: with the names that there are.
    """
    names = list_parameters(model)
    if name not in names:
        raise CalibrationError(
            f"The lens model is chosen automatically, and not all models have a parameter {name!r}."
            if model is None
            else f"The lens model {model!r} has no parameter {name!r}.",
            f"Choose from {_shorten_list(names)}{', or name the lens model' * (model is None)}.",
        )


def _shorten_list(names: Sequence[str]) -> str:
    """List names, the hundreds of a splined model by their first and last."""
    if len(names) > _MAX_LISTED:
        names = [*names[: _MAX_LISTED - 1], "...", names[-1]]
    return ", ".join(names)


def parse_names(text: str, model: str | None = DEFAULT_MODEL) -> tuple[str, ...]:
    """Read a list of a lens model's parameters such as "k3, p1".

    Raises:
        CalibrationError: for a name that is none of the model's parameters.
    """
    return tuple(_parse_name(name, model) for name in text.split(","))


def parse_fixed(text: str, model: str | None = DEFAULT_MODEL) -> dict[str, float | None]:
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


def _parse_name(text: str, model: str | None) -> str:
    name = text.strip()
    check_parameter(name, model)
    return name


def _parse_value(name: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    is_focal = name in ("fx", "fy")
    if not math.isfinite(value) or (is_focal and value <= 0):
        wanted = f"a number of pixels above 0, as {name}=650" if is_focal else "a number, as k3=0"
        raise CalibrationError(f"{text!r} cannot be the value of {name}.", f"State {wanted}.")
    return value

"""Lens models: the map between the measured and the ideal image, in dimensionless coordinates.

A polynomial model is closed-form in one direction only; ``camera.inverse`` supplies the other,
derivatives included. To add a model, write one module with a class that satisfies
``camera.model.Lens``, derive its Jacobians in the docstring, and name it in `MODELS`: solver, maps,
renderer and reports take it from there (CONTRIBUTING.md says what else a model needs).
"""

from __future__ import annotations

from calibgui.engine.camera.model import Lens
from calibgui.engine.camera.models.brown_conrady import BrownConrady
from calibgui.engine.camera.models.lucchese import Lucchese
from calibgui.engine.errors import CalibrationError

MODELS: dict[str, Lens] = {
    "lucchese": Lucchese(),
    "lucchese-pixels": Lucchese(radius_in_pixels=True),
    "brown-conrady": BrownConrady(),
}
"""The lens models by their ids; ``Lens.title`` is what people read."""
MODEL_ALIASES = {"opencv": "brown-conrady"}
"""Ids that models had in earlier versions, and the ids that they have now."""

PINHOLE = ("fx", "fy", "cx", "cy")
"""Names of the parameters that every camera has."""


def resolve_model_id(model: str) -> str:
    """Return the key of `MODELS` for an id, which may be one of an earlier version.

    Raises:
        CalibrationError: if there is no such model, with the list of models.
    """
    current = MODEL_ALIASES.get(model, model)
    if current not in MODELS:
        raise CalibrationError(
            f"There is no lens model {model!r}.", f"Choose from {', '.join(MODELS)}."
        )
    return current


def find_model(model: str) -> Lens:
    """Return the lens model of an id, which may be one of an earlier version.

    Raises:
        CalibrationError: if there is no such model, with the list of models.
    """
    return MODELS[resolve_model_id(model)]


def parameter_names(model: str) -> tuple[str, ...]:
    """Return the names of a camera's parameters, in the order of ``Camera.params``.

    Raises:
        CalibrationError: if there is no such model.
    """
    return (*PINHOLE, *find_model(model).names)

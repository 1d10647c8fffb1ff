"""Lens models: the map between the measured and the ideal image, in dimensionless coordinates.

A model is closed-form in one direction only; ``inverse`` supplies the other, derivatives
included. To add a model, write one module with a class that satisfies `Lens`, derive its
Jacobians in the docstring, and name it in `MODELS`: solver, maps, renderer, reports and exports
take it from there, and the tests of all models once `LENSES` of ``tests/engine/scenes.py`` has a
lens of it.
"""

from __future__ import annotations

from calibgui.engine.camera.model import Lens
from calibgui.engine.camera.models.brown_conrady import BrownConrady
from calibgui.engine.camera.models.lucchese import Lucchese
from calibgui.engine.errors import CalibrationError

MODELS: dict[str, Lens] = {
    "lucchese": Lucchese(),
    "lucchese-pixels": Lucchese(radius_in_pixels=True),
    "opencv": BrownConrady(),
}

PINHOLE = ("fx", "fy", "cx", "cy")
"""The parameters that every camera has."""


def parameter_names(model: str) -> tuple[str, ...]:
    """Names of a camera's parameters, in the order of ``Camera.params``.

    Raises:
        CalibrationError: if there is no such model.
    """
    if model not in MODELS:
        raise CalibrationError(
            f"There is no lens model {model!r}.", f"Choose from {', '.join(MODELS)}."
        )
    return (*PINHOLE, *MODELS[model].names)

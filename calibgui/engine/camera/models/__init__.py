"""Lens models: the maps between rays and image points, one model a file.

To add a model, write one module with a class that derives from ``camera.model.Lens``, derive its
derivatives in the docstring, and name it in `MODELS`: solver, maps, renderer and reports take it
from there (CONTRIBUTING.md says what else a model needs). OpenCV's tilted sensor is not among them:
it does what a rotation of the camera does.
"""

from __future__ import annotations

import difflib

from calibgui.engine.camera.model import Lens
from calibgui.engine.camera.models.brown_conrady import BrownConrady, BrownConrady4
from calibgui.engine.camera.models.division import Division
from calibgui.engine.camera.models.double_sphere import DoubleSphere
from calibgui.engine.camera.models.eucm import ExtendedUnified
from calibgui.engine.camera.models.kannala_brandt import KannalaBrandt
from calibgui.engine.camera.models.lucchese import Lucchese
from calibgui.engine.camera.models.mei import Mei
from calibgui.engine.camera.models.pinhole import Pinhole
from calibgui.engine.camera.models.rational import Rational
from calibgui.engine.camera.models.scaramuzza import Scaramuzza
from calibgui.engine.camera.models.splined_stereographic import (
    DEFAULT_FOV,
    DEFAULT_CONTROL_POINTS,
    PREFIX,
    SplinedStereographic,
    find_splined_model,
)
from calibgui.engine.camera.models.thin_prism import ThinPrism
from calibgui.engine.camera.models.ucm import Unified
from calibgui.engine.errors import CalibrationError

MODELS: dict[str, Lens] = {
    "lucchese": Lucchese(),
    "lucchese-pixels": Lucchese(radius_in_pixels=True),
    "pinhole": Pinhole(),
    "brown-conrady-4": BrownConrady4(),
    "brown-conrady": BrownConrady(),
    "rational": Rational(),
    "thin-prism": ThinPrism(),
    "kannala-brandt": KannalaBrandt(),
    "kannala-brandt-decentering": KannalaBrandt(decentering=True),
    "ucm": Unified(),
    "eucm": ExtendedUnified(),
    "double-sphere": DoubleSphere(),
    "mei": Mei(),
    "division": Division(),
    "scaramuzza": Scaramuzza(),
    PREFIX: SplinedStereographic(*DEFAULT_CONTROL_POINTS, DEFAULT_FOV),
}
"""The lens models by their ids; ``Lens.title`` is what people read. `find_model` also knows splined
models with other numbers of control points."""
MODEL_ALIASES = {"opencv": "brown-conrady"}
"""Ids that models had in earlier versions, and the ids that they have now."""

_NAMES_ELSEWHERE = {
    "kannala-brandt": ("fisheye", "equidistant", "equi", "kb4", "opencv-fisheye"),
    "brown-conrady": ("plumb-bob", "opencv5", "brown"),
    "brown-conrady-4": ("radtan", "opencv4"),
    "rational": ("rational-polynomial", "radtan8", "opencv8", "full-opencv"),
    "thin-prism": ("opencv12",),
    "double-sphere": ("ds",),
    "mei": ("omni", "omnidir"),
    "scaramuzza": ("ocam", "ocamcalib"),
}
"""Names that other programs have for the models, by ours."""

PINHOLE = ("fx", "fy", "cx", "cy")
"""Names of the parameters that every camera has."""


def find_model(model: str) -> Lens:
    """Return the lens model of an id, which may be one of an earlier version.

    Raises:
        CalibrationError: if there is no such model, with the list of models.
    """
    current = MODEL_ALIASES.get(model, model)
    lens = MODELS.get(current) or find_splined_model(current)
    if lens is None:
        raise CalibrationError(
            f"There is no lens model {model!r}.",
            f"{suggest_model(model)}Choose from {', '.join(MODELS)}; {PREFIX}-30x20-150 is the "
            "splined model of 30 x 20 control points over 150 degrees, and there is one for any "
            "such numbers.",
        )
    return lens


def suggest_model(name: str) -> str:
    """Return the question whether a model was meant by a name that is not its own, with a blank
    after it; empty if none is like it."""
    plain = name.lower().replace("_", "-")
    meant = [model for model, names in _NAMES_ELSEWHERE.items() if plain in names]
    meant += difflib.get_close_matches(plain, MODELS, n=1)
    return f"Did you mean {meant[0]}? " if meant else ""


def resolve_model_id(model: str) -> str:
    """Return the present id of a lens model for one that may be of an earlier version.

    It is a key of `MODELS`, or the id of a splined model without leading zeros.

    Raises:
        CalibrationError: if there is no such model, with the list of models.
    """
    current, lens = MODEL_ALIASES.get(model, model), find_model(model)
    if current not in MODELS and isinstance(lens, SplinedStereographic):
        return lens.id
    return current


def list_parameter_names(model: str) -> tuple[str, ...]:
    """Return the names of a camera's parameters, in the order of ``Camera.params``.

    Raises:
        CalibrationError: if there is no such model.
    """
    return (*PINHOLE, *find_model(model).names)

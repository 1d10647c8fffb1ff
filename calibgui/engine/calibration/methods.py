"""The methods of calibration: how a camera is first guessed, and how the guess is refined.

Every method takes the same two steps. Its initialisation turns corners into a camera and poses
that are near enough for an iteration to start from; its refinement moves them to the minimum of a
cost. All else (checks of the views, covariances, the diagnosis of degenerate views, the board's
shape) is the same for all methods and lies in ``calibrate.py``. A further method is one more entry
of `METHODS`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

from calibgui.engine.arrays import Size
from calibgui.engine.calibration.initialisation.stage_one import (
    StageOneRegistration,
    register_views,
)
from calibgui.engine.calibration.initialisation.start import (
    convert_to_paper_frame,
    initialise_stage_two,
)
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.options import Options
from calibgui.engine.calibration.refinement.bundle_adjustment import (
    reweight_and_solve,
    solve_stage_two,
)
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import Cost, Report
from calibgui.engine.camera.models import MODELS
from calibgui.engine.camera.models.splined_stereographic import PREFIX
from calibgui.engine.errors import CalibrationError

DEFAULT_METHOD = "lucchese"
"""Name of the method that `calibrate` uses unless told otherwise."""


class Initialisation(NamedTuple):
    """The start of a refinement."""

    registration: StageOneRegistration
    """Stage I of every view. Its residuals also tell which views no flat board explains."""
    state: State
    """Camera and poses."""
    held: dict[str, float]
    """Values of the parameters that are held."""


class Refinement(NamedTuple):
    """The minimum of a method's cost."""

    observations: Observations
    """The views with the weights that the minimum was found with."""
    solution: Solution


@dataclass(frozen=True, slots=True)
class Method:
    """A method of calibration, as data and two functions."""

    name: str
    """Key in `METHODS`, as arguments and files name it."""
    title: str
    """Name that a user reads."""
    source: str
    """Publication that describes the method."""
    lens_models: tuple[str, ...]
    """Keys of ``camera.models.MODELS`` that the method can estimate."""
    costs: tuple[Cost, ...]
    """Costs that the refinement can minimise."""
    initialise: Callable[
        [Observations, Size, str, float, Mapping[str, float | None], Sequence[str]], Initialisation
    ]
    """Guess camera and poses.

    Arguments: the views; the images' size, px; the lens model; the reference image's scale, px per
    mm; the parameters to hold, with a value or None for the default; the views' names.
    """
    refine: Callable[[Observations, State, Options, Report | None, int], Refinement]
    """Move a guess to the minimum.

    Arguments: the views, whitened if they have covariances; the guess; the options; the function to
    report iterations to; the largest number of iterations of a solve.
    """


def find_method(name: str, model: str, cost: Cost) -> Method:
    """Look a method up, and check that it can do what is wanted of it.

    Args:
        name: a key of `METHODS`.
        model: the lens model to estimate, a key of ``camera.models.MODELS`` or a splined model.
        cost: what to minimise.

    Raises:
        CalibrationError: if there is no such method, or if it knows neither the model nor the cost.
    """
    if name not in METHODS:
        raise CalibrationError(
            f"There is no calibration method {name!r}.", f"Choose from {', '.join(METHODS)}."
        )
    method = METHODS[name]
    if (model if model in MODELS else PREFIX) not in method.lens_models:
        raise CalibrationError(
            f"The method {name!r} cannot estimate the lens model {model!r}.",
            f"Choose from {', '.join(method.lens_models)}.",
        )
    if cost not in method.costs:
        raise CalibrationError(
            f"The method {name!r} cannot minimise the cost {cost.value!r}.",
            f"Choose from {', '.join(method.costs)}.",
        )
    return method


def _initialise_lucchese(
    observations: Observations,
    size: Size,
    model: str,
    scale: float,
    held: Mapping[str, float | None],
    names: Sequence[str],
) -> Initialisation:
    """Register every view on the reference plane (Stage I), then solve for one camera (3.5)."""
    registration = register_views(*convert_to_paper_frame(observations, scale, size, names))
    state, values = initialise_stage_two(observations, registration, size, model, held)
    return Initialisation(registration, state, values)


def _refine_lucchese(
    observations: Observations,
    start: State,
    options: Options,
    report: Report | None,
    max_iterations: int,
) -> Refinement:
    """Solve Stage II, again with the models' own errors in the weights if corners are weighted."""
    solve = partial(
        solve_stage_two,
        model=options.model,
        cost=options.cost,
        scale=options.scale,
        free=options.free,
        report=report,
        max_iterations=max_iterations,
    )
    solution = solve(observations, start)
    if observations.whitening is not None:
        observations, solution = reweight_and_solve(observations, solution, options.model, solve)
    return Refinement(observations, solution)


METHODS: Mapping[str, Method] = {
    DEFAULT_METHOD: Method(
        name=DEFAULT_METHOD,
        title="Lucchese: views registered one by one, then all together",
        source="L. Lucchese, Geometric calibration of digital cameras through multi-view "
        "rectification, Image and Vision Computing 23 (2005) 517-539",
        lens_models=tuple(MODELS),
        costs=tuple(Cost),
        initialise=_initialise_lucchese,
        refine=_refine_lucchese,
    )
}
"""All methods by name."""

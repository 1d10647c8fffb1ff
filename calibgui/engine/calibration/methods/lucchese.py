"""Lucchese's method (2005): views registered one by one, then all together.

Stage I registers every view on a virtual reference plane with a centre and a coefficient of
distortion of its own (``initialisation/stage_one.py``). One camera for all follows in closed form
(section 3.5 of the paper, ``initialisation/start.py``). Stage II refines it with all poses
(section 4.3, ``refinement/``).
"""

from __future__ import annotations

from calibgui.engine.calibration.initialisation.start import initialise_stage_two
from calibgui.engine.calibration.methods.method import (
    Given,
    Initialisation,
    Method,
    Refinement,
    bind_solver,
    hold_at_defaults,
    refine_by_bundle_adjustment,
)
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.options import Options
from calibgui.engine.calibration.refinement.bundle_adjustment import reweight_and_solve
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import Cost, Report
from calibgui.engine.camera.models import MODELS


def _initialise(given: Given) -> Initialisation:
    """Make one camera from Stage I of views spread over all (3.5)."""
    state = initialise_stage_two(
        given.observations, given.spread_registration, given.size, given.model, given.held
    )
    return hold_at_defaults(state, given)


def _refine(
    observations: Observations,
    start: State,
    options: Options,
    report: Report | None,
    max_iterations: int,
) -> Refinement:
    """Solve Stage II, again with the models' own errors in the weights if corners are weighted."""
    first = refine_by_bundle_adjustment(observations, start, options, report, max_iterations)
    if observations.whitening is None:
        return first
    solve = bind_solver(options, report, max_iterations)
    return Refinement(*reweight_and_solve(observations, first.solution, options.model, solve))


LUCCHESE = Method(
    name="lucchese",
    label="Lucchese",
    title="Lucchese: each view, then all together",
    source="L. Lucchese, Geometric calibration of digital cameras through multi-view "
    "rectification, Image and Vision Computing 23 (2005) 517-539",
    limits="It estimates every lens model, from corners weighted by their covariances.",
    lens_models=tuple(MODELS),
    initialise=_initialise,
    refine=_refine,
    costs=tuple(Cost),
    is_weighted=True,
)
"""The method."""

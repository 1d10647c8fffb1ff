"""Lucchese's method (2005): views registered one by one, then all together.

Stage I registers every view on a virtual reference plane with a centre and a coefficient of
distortion of its own (``initialisation/stage_one.py``). One camera for all follows in closed form
(section 3.5 of the paper, ``initialisation/start.py``). Stage II refines it with all poses
(section 4.3, ``refinement/``).
"""

from __future__ import annotations

from calibgui.engine.calibration.initialisation.start import initialise_stage_two
from calibgui.engine.calibration.methods.method import (
    Initialisation,
    Method,
    Problem,
    Refinement,
    bind_solver,
    hold_at_defaults,
    refine_by_bundle_adjustment,
)
from calibgui.engine.calibration.refinement.bundle_adjustment import reweight_and_solve
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import DEFAULT_METHOD, Cost, Report
from calibgui.engine.camera.models import MODELS


def _initialise(problem: Problem) -> Initialisation:
    """Make one camera from Stage I of views spread over all (3.5)."""
    state = initialise_stage_two(
        problem.observations, problem.stage_one.of_spread, problem.size, problem.model, problem.held
    )
    return hold_at_defaults(state, problem)


def _refine(problem: Problem, start: State, report: Report | None) -> Refinement:
    """Solve Stage II, again with the models' own errors in the weights if corners are weighted."""
    first = refine_by_bundle_adjustment(problem, start, report)
    if problem.prepared.whitening is None:
        return first
    solve = bind_solver(problem, report)
    return Refinement(*reweight_and_solve(problem.prepared, first.solution, problem.model, solve))


LUCCHESE = Method(
    name=DEFAULT_METHOD,
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

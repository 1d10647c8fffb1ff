"""The contract of a calibration method: the problem that it takes, and its two steps.

Its initialisation turns corners into a camera and poses; its refinement moves them, mostly to the
minimum of a cost. All else (checks of the views, covariances, the diagnosis of degenerate views,
the board's shape) is the same for all methods: ``calibrate.py`` tells it in order. Functions that
methods share stand here as well.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, IntArray, Size
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration.board_shape.parametrisation import place_on_board_shape
from calibgui.engine.calibration.initialisation.stage_one import (
    StageOneRegistration,
    register_views,
)
from calibgui.engine.calibration.initialisation.start import (
    convert_to_paper_frame,
    start_from_camera,
)
from calibgui.engine.calibration.observations import Observations, select_spread_views
from calibgui.engine.calibration.refinement.bundle_adjustment import solve_stage_two
from calibgui.engine.calibration.refinement.levenberg_marquardt import (
    Solution,
    StartError,
    minimise,
)
from calibgui.engine.calibration.refinement.residuals import State, build_stage_two
from calibgui.engine.calibration.refinement.whitening import whiten_observations
from calibgui.engine.calibration.result import (
    Calibration,
    CalibrationSettings,
    Cost,
    Report,
    Status,
)
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import find_model, list_parameter_names
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector, vector_from_rotation

_MAX_START_VIEWS = 25
"""Number of views that Stage I is made of before the start, at most: their medians of centre and
first coefficient serve all views."""


@dataclass(frozen=True, eq=False)
class RegisteredViews:
    """Stage I of the views, carried out when somebody first needs it."""

    observations: Observations
    scale: float
    size: Size
    facing: float

    @cached_property
    def of_all(self) -> StageOneRegistration:
        """Stage I of every view, by which misfits are told and reports drawn."""
        return self._register(self.observations)

    @cached_property
    def of_spread(self) -> StageOneRegistration:
        """Stage I of some views, spread evenly over all: enough to start from."""
        if len(self.observations.uv) <= _MAX_START_VIEWS:
            return self.of_all
        return self._register(select_spread_views(self.observations, _MAX_START_VIEWS))

    def _register(self, views: Observations) -> StageOneRegistration:
        return register_views(*convert_to_paper_frame(views, self.scale, self.size, self.facing))


@dataclass(frozen=True, eq=False, kw_only=True)
class Problem:
    """The problem of a calibration: the views, and what is wanted of them (``problem.py``)."""

    observations: Observations
    """The views as they came, on the board as it is drawn."""
    view_names: Sequence[str]
    """Names of the views for messages."""
    scale: float
    """Scale of the virtual reference image, reference px per mm."""
    facing: float
    """The side of the board that all views show, from ``start.check_facing``."""
    size: Size
    """Width and height of the images, px."""
    method: Method
    """The method."""
    model: str
    """The lens model, a key of ``camera.models.MODELS``."""
    cost: Cost
    """The cost to minimise."""
    held: Mapping[str, float | None]
    """Parameters to hold, with a value, or None until the method has chosen one."""
    board_shape: BoardShapeModel | BoardShape
    """The model of the board's shape to estimate, or a shape to hold."""
    prior: BoardShapePrior | None
    """What is known beforehand of the board's deviations from its drawing."""
    model_errors: bool
    """True if the uncertainties count what the models of board, lens and views miss."""
    max_iterations: int
    """Largest number of iterations of a solve."""

    @property
    def parameters(self) -> tuple[str, ...]:
        """(P,) names of the camera's parameters."""
        return list_parameter_names(self.model)

    @property
    def free(self) -> IntArray:
        """Indices of the parameters to estimate, ascending."""
        return np.flatnonzero([name not in self.held for name in self.parameters])

    @property
    def free_parameters(self) -> tuple[str, ...]:
        """Names of the parameters to estimate."""
        return tuple(name for name in self.parameters if name not in self.held)

    @property
    def held_shape(self) -> BoardShape | None:
        """The board's shape if it is held."""
        return self.board_shape if isinstance(self.board_shape, BoardShape) else None

    @property
    def estimated_shape(self) -> BoardShapeModel:
        """The model of the board's shape to estimate; nominal if there is nothing to estimate."""
        shape = self.board_shape
        return BoardShapeModel.NOMINAL if isinstance(shape, BoardShape) else shape

    @property
    def settings(self) -> CalibrationSettings:
        """The record of the problem in its result."""
        shape = self.board_shape
        return CalibrationSettings(
            cost=self.cost,
            model=self.model,
            fixed={name: value for name, value in self.held.items() if value is not None},
            max_iterations=self.max_iterations,
            board_shape=shape.model if isinstance(shape, BoardShape) else shape,
            is_board_shape_held=isinstance(shape, BoardShape),
            prior=self.prior,
            method=self.method.name,
        )

    @cached_property
    def prepared(self) -> Observations:
        """The views as a solver takes them: on the board that is held, whitened."""
        shape, views = self.held_shape, self.observations
        views = views if shape is None else place_on_board_shape(views, shape)
        # The covariances are of corners in the image.
        return whiten_observations(views) if self.cost is Cost.IMAGE else views

    @cached_property
    def stage_one(self) -> RegisteredViews:
        """Stage I of the views."""
        return RegisteredViews(self.observations, self.scale, self.size, self.facing)

    def make_camera(self, state: State) -> Camera:
        """Make the camera of a state."""
        return Camera(self.size, state.params, self.model)


class Initialisation(NamedTuple):
    """The state that a refinement starts from."""

    state: State
    """Camera and poses."""
    held: dict[str, float]
    """Values of the parameters that are held."""
    remarks: tuple[str, ...] = ()
    """Sentences on the views that the camera and the poses do not say; the result repeats them."""


class Refinement(NamedTuple):
    """The end of a method."""

    observations: Observations
    """The views with the weights that the solution was found with."""
    solution: Solution


def list_no_remarks(calibration: Calibration) -> tuple[str, ...]:  # noqa: ARG001 - of the contract
    """Return no remarks."""
    return ()


@dataclass(frozen=True, kw_only=True)
class Description:
    """The texts that tell a user about a method."""

    name: str
    """Key in the table of methods, as arguments and files name it."""
    label: str
    """Name that a user reads in a table, at most 20 letters."""
    title: str
    """Name that a user reads, with what the method does."""
    source: str
    """Publication that describes the method."""
    limits: str
    """Sentence on what the method assumes or cannot estimate."""


@dataclass(frozen=True, kw_only=True)
class Method(Description):
    """A method that calibrates a camera, as data and two functions."""

    lens_models: tuple[str, ...]
    """Keys of ``camera.models.MODELS`` that the method can estimate; the first is its own."""
    initialise: Callable[[Problem], Initialisation]
    """Guess camera and poses.

    Raises:
        StartError: if the views allow no guess.
    """
    refine: Callable[[Problem, State, Report | None], Refinement]
    """Move a guess to the method's estimate, reporting iterations."""
    held: tuple[str, ...] | None = None
    """Names of the parameters that are held unless the user frees them; None for those of the lens
    model."""
    costs: tuple[Cost, ...] = (Cost.IMAGE,)
    """Costs that the refinement can minimise."""
    is_weighted: bool = False
    """True if the method weights corners by their covariances; others take all as equally good."""
    is_minimum: bool = True
    """True if the estimate is the minimum of the cost, whose normal equations tell its covariance.
    The covariance of any other is simulated (``simulated_covariance.py``)."""
    list_remarks: Callable[[Calibration], tuple[str, ...]] = list_no_remarks
    """Return sentences on a result of this method that its figures do not say."""


def start_from_calibration(
    method: Method, calibration: Calibration, views: Sequence[int]
) -> Method:
    """Return the method with the camera and the poses of a calibration in place of its guess.

    It saves the guess where views are calibrated again with the same lens model. A method that does
    not minimise a cost is returned as it is: its guess is part of its estimate.

    Args:
        method: the method of the calibration.
        calibration: a calibration of all views.
        views: those of its views, in order, that the method is used on; some may repeat.
    """
    if not method.is_minimum:
        return method
    R, T = _stack_poses([calibration.poses[k] for k in views])
    values = dict(zip(calibration.camera.names, calibration.camera.params.tolist(), strict=True))

    def initialise(problem: Problem) -> Initialisation:
        state = State(calibration.camera.params.copy(), R.copy(), T.copy())
        return hold_parameters(state, problem.model, problem.held, values)

    return replace(method, initialise=initialise)


def start_from_other_model(method: Method, calibration: Calibration) -> Method:
    """Return the method with a guess from what a camera of another lens model sees.

    It saves the guess where several lens models are calibrated from the same views. Where the
    camera misses the corners, or the model cannot see as it does, the method guesses by itself.

    Args:
        method: the method; one that does not minimise a cost is returned as it is.
        calibration: a calibration of the same views.
    """
    if not method.is_minimum:
        return method
    R, T = _stack_poses(calibration.poses)

    def initialise(problem: Problem) -> Initialisation:
        state = start_from_camera(
            problem.observations, calibration.camera, R, T, problem.model, problem.held
        )
        return method.initialise(problem) if state is None else hold_at_defaults(state, problem)

    return replace(method, initialise=initialise)


def _stack_poses(poses: Sequence[Pose]) -> tuple[Array, Array]:
    """Return the rotations (K, 3, 3) and the translations (K, 3) of poses."""
    R = rotation_from_vector(np.array([pose.rvec for pose in poses]))
    return R, np.array([pose.tvec for pose in poses])


def keep_calibration(method: Method, calibration: Calibration) -> Method:
    """Return the method with the minimum that a calibration of the same views has found.

    It saves the solve where different shapes of the board are estimated beside one camera.

    Args:
        method: the method of the calibration; one that does not minimise a cost is returned as it
            is.
        calibration: a calibration by the image cost, with the board as drawn.
    """
    if not method.is_minimum:
        return method

    def refine(problem: Problem, start: State, report: Report | None) -> Refinement:
        observations = whiten_observations(problem.prepared, calibration.model_error**2)
        return Refinement(observations, evaluate_state(problem, observations, start, report))

    return replace(
        start_from_calibration(method, calibration, range(len(calibration.poses))), refine=refine
    )


def hold_at_defaults(state: State, problem: Problem) -> Initialisation:
    """Return a start whose held parameters have the wanted values, or else the lens model's."""
    lens = find_model(problem.model)
    start = state._replace(params=state.params.copy())  # those of a camera are read-only
    defaults = dict(zip(lens.names, lens.defaults, strict=True))
    return hold_parameters(start, problem.model, problem.held, defaults)


def hold_parameters(
    state: State, model: str, held: Mapping[str, float | None], defaults: Mapping[str, float]
) -> Initialisation:
    """Return a start whose held parameters have the wanted values, or else their defaults.

    Args:
        state: camera and poses; its camera's parameters are changed.
        model: the lens model.
        held: parameters to hold, with a value or None for the default.
        defaults: defaults; the state's own value where there is none.
    """
    names = list_parameter_names(model)
    values: dict[str, float] = {}
    for name, wanted in held.items():
        index = names.index(name)
        default = defaults.get(name, float(state.params[index]))
        state.params[index] = values[name] = default if wanted is None else float(wanted)
    return Initialisation(state, values)


def check_ideal_lens(problem: Problem, method: str, coefficients: tuple[str, ...]) -> None:
    """Check that nobody wants distortion of a method that knows none.

    Args:
        problem: what the initialisation starts from.
        method: what the message calls the method.
        coefficients: names of the coefficients, which must all be held at 0.

    Raises:
        CalibrationError: if one is to be estimated, or is held at another value.
    """
    for name in coefficients:
        if name not in problem.held or problem.held[name] not in (None, 0.0):
            raise CalibrationError(
                f"{method} knows no distortion: {name} is 0 in it.",
                f"Hold {name} at 0, or choose the method 'zhang'.",
            )


def bind_solver(problem: Problem, report: Report | None) -> Callable[..., Solution]:
    """Return `solve_stage_two` with everything but the views and the state to begin from."""
    return partial(
        solve_stage_two,
        model=problem.model,
        cost=problem.cost,
        scale=problem.scale,
        free=problem.free,
        report=report,
        max_iterations=problem.max_iterations,
    )


def refine_by_bundle_adjustment(
    problem: Problem, start: State, report: Report | None
) -> Refinement:
    """Minimise the cost over the free parameters and all poses."""
    observations = problem.prepared
    return Refinement(observations, bind_solver(problem, report)(observations, start))


def keep_start(problem: Problem, start: State, report: Report | None) -> Refinement:
    """Take the start for the estimate: the refinement of a method in closed form."""
    observations = problem.prepared
    return Refinement(observations, evaluate_state(problem, observations, start, report))


def evaluate_state(
    problem: Problem, observations: Observations, state: State, report: Report | None = None
) -> Solution:
    """Evaluate the cost and its normal equations at a state that no solver of ours has found.

    The history is this evaluation, whose step and damping are 0.

    Raises:
        StartError: if the camera does not image all corners.
    """
    free = problem.free
    evaluate = build_stage_two(observations, problem.model, problem.cost, problem.scale, free)
    try:
        found = minimise(evaluate, state, free, observations.count, 0.0, max_iterations=0)
    except StartError as error:
        raise StartError(
            "The estimated camera does not image all corners.",
            "Choose another method, or leave out views that are hard to see.",
        ) from error
    iteration = replace(found.history[0], damping=0.0)
    if report is not None:
        report(iteration)
    return found._replace(history=(iteration,), status=Status.CONVERGED)


def subtract_states(a: State, b: State) -> tuple[Array, Array]:
    """Return the step from state b to a: (P,) parameters, and (K, 6) small motions (w, tau)."""
    w = vector_from_rotation(a.R @ np.swapaxes(b.R, 1, 2))
    return a.params - b.params, np.hstack([w, a.T - b.T])

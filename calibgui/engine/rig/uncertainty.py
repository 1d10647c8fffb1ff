"""The covariances of a rig's parameters tell how far it is to be trusted.

Corners' noise alone gives sigma^2 S^-1 (``calibration/refinement/covariances.py``), with the
board's pose at every instant eliminated. It holds if the errors of an instant's corners are
independent, which they are not where two photographs were not taken at the same moment, or the
board bends in the hand: all corners of the instant then pull together. How much the instants
disagree is measured as that of one camera's views is (``calibration/overdispersion.py``), and the
covariance clustered by instants takes the place of the noise's where it is larger.

An error that all instants share, such as that of the side of a square, is not in it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.boards.shape import BoardShape
from calibgui.engine.calibration.board_shape.estimate import (
    MIN_INFORMATION,
    refuse_undetermined,
    remove_gauge,
)
from calibgui.engine.calibration.observations import slice_views
from calibgui.engine.calibration.overdispersion import (
    measure_disagreement,
    reduce_products,
    widen_board_shape,
)
from calibgui.engine.calibration.refinement.covariances import (
    invert_information,
    measure_precision,
)
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.refinement.schur import eliminate_poses
from calibgui.engine.camera.models import list_parameter_names
from calibgui.engine.errors import CalibrationError
from calibgui.engine.rig.joint_solve import compute_instant_products
from calibgui.engine.rig.problem import RigProblem

_POSE_NAMES = ("pose", "pose", "pose", "place", "place", "place", "offset in time")


class RigCovariance(NamedTuple):
    """The covariances of a rig, and the shapes of its boards with theirs."""

    covariance: Array
    """(n, n) of all parameters, in the order of the layout."""
    noise_covariance: Array
    """(n, n) the same from the corners' noise alone."""
    noise: float
    """Standard deviation of one coordinate of a residual, px."""
    disagreement: float
    """See ``Rig.disagreement``."""
    shapes: tuple[BoardShape | None, ...]
    """See ``PlacedBoard.shape``."""


def estimate_rig_covariance(
    problem: RigProblem, solution: Solution, names: Sequence[str], boards: Sequence[str]
) -> RigCovariance:
    """Estimate the covariances of a rig.

    Args:
        problem, solution: the joint solve.
        names, boards: names of the cameras and boards, for messages.

    Raises:
        CalibrationError: if the views leave a parameter open; the message names it.
    """
    unknown = _name_unknowns(problem, names, boards)
    tolerated = np.full(len(unknown), np.inf)
    precision = measure_precision(solution.normal, unknown, problem.corners, tolerated)
    if precision.undetermined:
        listed = ", ".join(dict.fromkeys(each.name for each in precision.undetermined))
        raise CalibrationError(
            f"The views leave open: {listed}.",
            "Give each camera as an earlier calibration has it and hold it, or take pictures with "
            "the board tilted in different directions.",
        )
    if problem.placed < len(problem.free):
        _check_shapes(problem, solution)
    whole, unknowns, P = precision.shared, 0.0, problem.placed
    for board, place in zip(problem.boards, problem.find_columns().deviations, strict=True):
        if board.deviations is not None:
            known = whole[np.ix_(place, place)] / precision.variance
            unknowns += board.count - float(np.sum(known * board.stiffness))
            whole = remove_gauge(whole, board.deviations.G, slice(place[0], place[-1] + 1))
    following = _find_motions(problem, whole)
    R, h = _reduce_instants(problem, solution.state, following)
    coordinates = 2 * problem.corners - 6 * problem.count
    added, ratio = measure_disagreement(
        R,
        h,
        whole[:P, :P],
        precision.variance,
        coordinates - P - unknowns,
        unknowns / coordinates,
    )
    return RigCovariance(
        _spread(problem, whole[:P, :P] + added),
        _spread(problem, whole[:P, :P]),
        float(np.sqrt(precision.variance)),
        ratio,
        _describe_shapes(problem, solution.state, whole, following, added),
    )


def _find_motions(problem: RigProblem, covariance: Array) -> list[Array | None]:
    """Find how the corners of boards follow the other unknowns, (corners, 3, n) mm per unit; None
    of a board as drawn."""
    others = covariance[: problem.placed, : problem.placed]
    return [
        None
        if board.deviations is None
        else board.deviations.B @ np.linalg.solve(others, covariance[: problem.placed, place]).T
        for board, place in zip(problem.boards, problem.find_columns().deviations, strict=True)
    ]


def _describe_shapes(
    problem: RigProblem,
    state: State,
    covariance: Array,
    following: Sequence[Array | None],
    added: Array,
) -> tuple[BoardShape | None, ...]:
    """Describe the shapes that were found, with errors that allow for the instants' disagreement
    `added` about the other unknowns."""
    shapes: list[BoardShape | None] = []
    columns = problem.find_columns().deviations
    for b, (board, motion) in enumerate(zip(problem.boards, following, strict=True)):
        if board.deviations is None or motion is None:
            shapes.append(None)
            continue
        deviation = board.deviations.B @ state.params[problem.locate_deviations(b)]
        own = covariance[np.ix_(columns[b], columns[b])]
        shapes.append(widen_board_shape(board.deviations.describe(deviation, own), motion, added))
    return tuple(shapes)


def _check_shapes(problem: RigProblem, solution: Solution) -> None:
    """Refuse shapes of boards that views determine by the prior alone that they state."""
    U = solution.normal.U.copy()
    for board, place in zip(problem.boards, problem.find_columns().deviations, strict=True):
        if board.deviations is not None:
            G, shape = board.deviations.G, board.deviations.shape
            U[np.ix_(place, place)] += G @ G.T - board.stiffness
    reduced = eliminate_poses(solution.normal._replace(U=U))
    if invert_information(reduced)[1] < MIN_INFORMATION:
        raise refuse_undetermined(shape)


def _reduce_instants(
    problem: RigProblem, state: State, following: Sequence[Array | None]
) -> tuple[Array, Array]:
    """Compute the information (N, n, n) and the pull (N, n) of each instant on the shared unknowns,
    the boards' poses eliminated, and their deviations by what they do as these move."""
    n = problem.placed
    R, h = np.empty((problem.count, n, n)), np.empty((problem.count, n))
    for part in slice_views(problem.count):
        instants = np.arange(part.start, part.stop)
        products = compute_instant_products(problem, state, instants, following)
        R[part], h[part], _ = reduce_products(products, n)
    return R, h


def _name_unknowns(
    problem: RigProblem, names: Sequence[str], boards: Sequence[str]
) -> tuple[str, ...]:
    """Name the unknowns that instants share, as "fx of left"."""
    named: list[str] = []
    for name, camera in zip(names, problem.cameras, strict=True):
        own = list_parameter_names(camera.model)
        named += [f"{own[i]} of {name}" for i in camera.free]
        named += [f"{_POSE_NAMES[i]} of {name}" for i in camera.unknown]
    for name, board in zip(boards, problem.boards, strict=True):
        named += [f"{_POSE_NAMES[i]} of {name}" for i in board.unknown]
    for name, board in zip(boards, problem.boards, strict=True):
        named += [f"shape of {name}"] * board.count
    return tuple(named)


def _spread(problem: RigProblem, covariance: Array) -> Array:
    """Return a covariance of the unknowns among all parameters of the layout, 0 for held ones."""
    whole, free = np.zeros((problem.layout.size,) * 2), problem.free[: problem.placed]
    whole[np.ix_(free, free)] = covariance
    return whole

"""The shapes of a rig's boards, estimated with cameras, poses and instants.

All cameras see the same board, so that its deviations from the drawing are one more set of shared
unknowns of the joint solve. Model, gauge and prior are those of one camera's calibration
(``calibration/board_shape/``): scale and place of a board are those of its drawing, and the
variances of a free board's deviations are what the views tell.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.board_shape.estimate import (
    SOLVES,
    allow_deviations,
    check_views,
    relearn_variances,
)
from calibgui.engine.calibration.board_shape.parametrisation import index_board_points
from calibgui.engine.calibration.refinement.covariances import (
    estimate_variance,
    invert_information,
)
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution
from calibgui.engine.calibration.refinement.schur import eliminate_poses
from calibgui.engine.calibration.result import Report
from calibgui.engine.errors import CalibrationError
from calibgui.engine.rig.joint_solve import solve_jointly
from calibgui.engine.rig.problem import BoardProblem, RigProblem, SightProblem


def solve_shapes(
    problem: RigProblem,
    nominal: Solution,
    shapes: Sequence[BoardShapeModel],
    report: Report | None,
) -> tuple[RigProblem, Solution]:
    """Solve a rig with the shapes of its boards, from the solution for boards as drawn.

    Args:
        problem: the rig, its boards as drawn.
        nominal: its solution, which is returned if no shape is to be estimated.
        shapes: the deviations of each board that are estimated.
        report: a function that takes each iteration; it returns False to stop.

    Raises:
        CalibrationError: if the views are too few for a shape; the message says why.
    """
    if all(shape is BoardShapeModel.NOMINAL for shape in shapes):
        return problem, nominal
    for b, shape in enumerate(shapes):
        if shape is not BoardShapeModel.NOMINAL:
            problem = _allow_shape(problem, b, shape)
    added = sum(board.count for board in problem.boards)
    params = np.append(nominal.state.params, np.zeros(added))
    solution = nominal._replace(state=nominal.state._replace(params=params))
    known = problem.placed + nominal.normal.pose.size
    sigma2 = estimate_variance(nominal.normal.cost, problem.corners, known)
    for _ in range(SOLVES if BoardShapeModel.FREE in shapes else 1):
        boards = [
            board
            if board.deviations is None
            else replace(board, stiffness=board.deviations.make_stiffness(sigma2))
            for board in problem.boards
        ]
        problem = replace(problem, boards=tuple(boards))
        solution = solve_jointly(problem, solution.state, report)
        inverse = invert_information(eliminate_poses(solution.normal))[0]
        columns = problem.find_columns().deviations
        prior = sum(
            float(np.sum(inverse[np.ix_(place, place)] * board.stiffness))
            for place, board in zip(columns, problem.boards, strict=True)
        )
        sigma2 = estimate_variance(solution.normal.cost, problem.corners, known + added - prior)
        boards = [
            _learn_variances(board, solution.state.params[problem.locate_deviations(b)], spread)
            for b, (board, spread) in enumerate(
                (board, sigma2 * inverse[np.ix_(place, place)])
                for place, board in zip(columns, problem.boards, strict=True)
            )
        ]
        problem = replace(problem, boards=tuple(boards))
    return problem, solution


def _allow_shape(problem: RigProblem, b: int, shape: BoardShapeModel) -> RigProblem:
    """Return the problem with the deviations of board `b` that a model of its shape allows."""
    of_board = [sight for sight in problem.sights if sight.board == b]
    points, corners = _index_corners(of_board)
    shown = sum(
        np.bincount(corner[sight.observations.mask > 0], minlength=len(points))
        for sight, corner in zip(of_board, corners, strict=True)
    )
    try:
        check_views(sum(map(len, corners)), np.asarray(shown), shape, None)
    except CalibrationError as error:
        raise CalibrationError(f"Shape of a board: {error.message}", error.hint) from error
    indexed = iter(corners)
    sights = tuple(
        replace(sight, corner=next(indexed)) if sight.board == b else sight
        for sight in problem.sights
    )
    # How large deviations are is learnt from the first solution, which takes none for unlikely.
    boards = list(problem.boards)
    boards[b] = replace(boards[b], deviations=allow_deviations(shape, points, np.full(3, np.inf)))
    return replace(problem, sights=sights, boards=tuple(boards))


def _index_corners(sights: Sequence[SightProblem]) -> tuple[Array, list[IntArray]]:
    """Find the distinct corners (n, 2) of a board, mm, and which of them those of sights are."""
    own = [index_board_points(sight.observations) for sight in sights]
    points, place = np.unique(
        np.concatenate([points for points, _ in own]).round(9), axis=0, return_inverse=True
    )
    starts = np.cumsum([0, *(len(points) for points, _ in own)])
    return points, [
        place.ravel()[start + index] for start, (_, index) in zip(starts, own, strict=False)
    ]


def _learn_variances(board: BoardProblem, q: Array, covariance: Array) -> BoardProblem:
    """Return a board with what its deviations q (Q,) tell of those of a free one."""
    deviations = board.deviations
    if deviations is None or deviations.shape is not BoardShapeModel.FREE:
        return board
    variances = relearn_variances(deviations.points, q, covariance)
    return replace(
        board, deviations=allow_deviations(deviations.shape, deviations.points, variances)
    )

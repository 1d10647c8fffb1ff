"""The calibration of a rig: from cameras that are known alone to cameras that stand to each other.

1. Each camera alone says where each board was in each of its views (``alone.py``).
2. What most instants say of pairs of cameras, and of boards, is found, the pairs are joined to a
   tree (``consensus.py``, ``joining.py``), and views that contradict the others are left out
   (``agreement.py``).
3. All is solved together from there (``joint_solve.py``), with the shapes of the boards if they are
   to be estimated (``board_shapes.py``).
4. How much the instants disagree says how far the result is to be trusted (``uncertainty.py``).

Steps 1 and 2 take what a camera sees of a board for a camera of its own: a sight.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, IntArray
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution
from calibgui.engine.calibration.refinement.residuals import State, compute_misses
from calibgui.engine.calibration.result import Cost, Report
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import vector_from_rotation
from calibgui.engine.rig.agreement import Agreement, describe_pairs, find_agreement, list_turns
from calibgui.engine.rig.alone import CameraAlone, locate_views, see_alone
from calibgui.engine.rig.board_shapes import solve_shapes
from calibgui.engine.rig.joining import Joined, Sight, join_rig, list_sights, pair_sights
from calibgui.engine.rig.joint_solve import place_corners, solve_jointly
from calibgui.engine.rig.mistakes import find_mistakes
from calibgui.engine.rig.problem import BoardProblem, CameraProblem, RigProblem, SightProblem
from calibgui.engine.rig.records import (
    Layout,
    LeftOutView,
    Mistake,
    PlacedBoard,
    Rig,
    RigBoard,
    RigCamera,
    RigMistake,
    RigPair,
    RigView,
)
from calibgui.engine.rig.time_offsets import Motion, find_motions, hold_board_still
from calibgui.engine.rig.uncertainty import estimate_rig_covariance
from calibgui.engine.threads import with_one_blas_thread

_OWN = tuple(range(7))
"""Indices of the pose, and of the offset in time, among a camera's unknowns."""
_ROUNDS = 3
"""Number of solves where cameras are late: what contradicts the others shows once the offsets are
known, to some tenths after the first."""
_ONE_BOARD = (RigBoard(),)


@with_one_blas_thread
def calibrate_rig(
    cameras: Sequence[RigCamera],
    report: Report | None = None,
    estimate_offsets: bool = False,
    boards: Sequence[RigBoard] = _ONE_BOARD,
) -> Rig:
    """Calibrate a rig: how its cameras stand to each other, and all parameters together.

    Args:
        cameras: the cameras as they are known, with their views by instants. The rig's frame is
            that of the first one.
        report: a function that takes each iteration of the joint solve; it returns False to stop.
        estimate_offsets: True to estimate by how much the clock of each camera is late, from a
            board that moves; views without one before and one after then take no part.
        boards: the boards as they are known, in the order of ``RigCamera.views_by_board``. They
            stand fast to each other, and where is estimated unless it is stated.

    Raises:
        CalibrationError: if there are fewer than two cameras, a view cannot be used, the cameras
            fall apart into groups that nothing joins, a board is never seen, or the views leave a
            parameter open; the message names what.
        Cancelled: from `report`.
    """
    if len(cameras) < 2:
        raise CalibrationError(
            "A rig has at least two cameras.", "Name the photographs of each camera."
        )
    sights, seen = list_sights(cameras, boards)
    instants = sorted({instant for part in seen for instant in part.views})
    alone = see_alone(seen, instants)
    motions = hold_board_still(alone)
    if estimate_offsets:
        instants, alone, motions = find_motions(seen, instants, alone)
    # Several boards are told apart by marks, which tell the end that they are counted from, too.
    turns = list_turns(alone) if len(boards) == 1 else [np.eye(3)]
    offsets = np.zeros(len(cameras))
    for _ in range(_ROUNDS if estimate_offsets else 1):
        still = [
            motion.move_back(part, offsets[sight.camera])
            for motion, part, sight in zip(motions, alone, sights, strict=True)
        ]
        joined = join_rig(cameras, boards, sights, still, turns)
        still = joined.express(sights, still)
        relations = [joined.cameras[sight.camera] for sight in sights]
        agreement = find_agreement(still, relations, turns, len(instants))
        views = _take_views(sights, alone, agreement, turns, motions)
        problem = _state_problem(
            cameras, boards, joined, tuple(views.values()), agreement, len(instants), motions
        )
        start = _find_start(cameras, joined, sights, still, agreement, offsets)
        solution = solve_jointly(problem, start, report)
        offsets = solution.state.params[[*map(problem.layout.offset, range(len(cameras)))]]
    problem, solution = solve_shapes(problem, solution, [board.shape for board in boards], report)
    tree = pair_sights(sights, still)
    pairs = describe_pairs(still, relations, turns, agreement, tree)
    rms = {
        s: _measure_alone(problem, solution.state, sight, seen[s], alone[s], agreement.kept[s])
        for s, sight in zip(views, problem.sights, strict=True)
    }
    rig = _assemble(cameras, boards, joined, instants, turns, agreement, rms, problem, solution)
    left_out = _list_left_out(sights, alone, agreement, instants)
    mistakes = find_mistakes(
        seen, still, relations, turns, agreement, instants, rig.disagreement > 0, tree
    )
    return replace(
        rig,
        pairs=_pair_cameras(sights, pairs),
        left_out=left_out,
        mistakes=_blame_cameras(sights, mistakes),
    )


def _take_views(
    sights: Sequence[Sight],
    alone: Sequence[CameraAlone],
    agreement: Agreement,
    turns: Sequence[Array],
    motions: Sequence[Motion],
) -> dict[int, SightProblem]:
    """Take the views that go together, by the numbers of the sights that have any."""
    taken = {}
    for s, (sight, part) in enumerate(zip(sights, alone, strict=True)):
        kept, turned = agreement.kept[s], agreement.turn[s]
        if kept.any():
            taken[s] = SightProblem(
                *sight,
                _turn_views(part.observations, turned, turns).select_views(kept),
                part.poses.instant[kept],
                motions[s].velocity[kept],
                motions[s].lag[kept],
            )
    return taken


def _state_problem(
    cameras: Sequence[RigCamera],
    boards: Sequence[RigBoard],
    joined: Joined,
    views: tuple[SightProblem, ...],
    agreement: Agreement,
    count: int,
    motions: Sequence[Motion],
) -> RigProblem:
    """State the joint problem of the views that go together."""
    own = _OWN[: 6 + any(motion.is_moving for motion in motions)]
    problems = tuple(
        CameraProblem(
            camera.camera.model,
            camera.free,
            np.array(own if c else (), dtype=np.int64),
            _make_prior(camera, agreement.noise),
        )
        for c, camera in enumerate(cameras)
    )
    placed = tuple(
        BoardProblem(
            np.array(
                () if joined.references[b] == b or board.pose is not None else _OWN[:6], np.int64
            )
        )
        for b, board in enumerate(boards)
    )
    layout = Layout(tuple(len(camera.camera.params) for camera in cameras), len(boards))
    return RigProblem(problems, placed, views, layout, count)


def _make_prior(camera: RigCamera, variance: float) -> tuple[Array, Array] | None:
    """Return the values of a camera's parameters and their stiffness in px^2; None without any.

    Raises:
        CalibrationError: if the covariance that is given is not positive definite.
    """
    if camera.covariance is None or not camera.free.size:
        return None
    among = np.ix_(camera.free, camera.free)
    stiffness = np.zeros((len(camera.camera.params),) * 2)
    try:
        np.linalg.cholesky(camera.covariance[among])
    except np.linalg.LinAlgError as error:
        raise CalibrationError(
            f"The covariance of {camera.name} leaves some of its parameters without an error.",
            "Hold these parameters, or the whole camera.",
        ) from error
    stiffness[among] = variance * np.linalg.inv(camera.covariance[among])
    return camera.camera.params, stiffness


def _turn_views(
    observations: Observations, turned: IntArray, turns: Sequence[Array]
) -> Observations:
    """Return views with their corners counted from the end that the others count from."""
    if not turned.any():
        return observations
    xy = observations.xy.copy()
    for number, motion in enumerate(turns):
        here = turned == number
        xy[here, :, :2] = (xy[here, :, :2] - motion[:2, 2]) @ motion[:2, :2]
    return replace(observations, xy=xy)


def _find_start(
    cameras: Sequence[RigCamera],
    joined: Joined,
    sights: Sequence[Sight],
    still: Sequence[CameraAlone],
    agreement: Agreement,
    offsets: Array,
) -> State:
    """Return the state that the views agree about, with the boards where each base sees them."""
    params = [
        np.concatenate([camera.camera.params, vector_from_rotation(R), T, [late]])
        for camera, (R, T), late in zip(cameras, joined.cameras, offsets.tolist(), strict=True)
    ]
    for relation in joined.boards[1:]:
        M, A = relation.invert()
        params.append(np.concatenate([vector_from_rotation(M), A]))
    count = len(agreement.base)
    R, T = np.empty((count, 3, 3)), np.empty((count, 3))
    for s, (sight, part) in enumerate(zip(sights, still, strict=True)):
        at = part.poses.instant
        is_base = agreement.base[at] == s
        back = part.poses.select(np.flatnonzero(is_base)).see_from(
            joined.cameras[sight.camera].invert()
        )
        R[back.instant], T[back.instant] = back.R, back.T
    return State(np.concatenate(params), R, T)


def _measure_alone(
    problem: RigProblem,
    state: State,
    sight: SightProblem,
    camera: RigCamera,
    alone: CameraAlone,
    kept: BoolArray,
) -> Array:
    """Measure the root mean square residuals, px, of the views that are kept of a sight with its
    camera alone, on the board of the shape that was found."""
    alone = alone.select(np.flatnonzero(kept))
    if problem.boards[sight.board].deviations is not None:
        observations = place_corners(problem, state, sight)[1]
        alone = locate_views(camera, observations, sight.instant)
    return alone.compute_rms()


def _assemble(
    cameras: Sequence[RigCamera],
    boards: Sequence[RigBoard],
    joined: Joined,
    instants: Sequence[int],
    turns: Sequence[Array],
    agreement: Agreement,
    rms: Mapping[int, Array],
    problem: RigProblem,
    solution: Solution,
) -> Rig:
    """Assemble the rig that was found; `rms` has the residuals of each sight's camera alone, px."""
    names = tuple(camera.name for camera in cameras)
    found = estimate_rig_covariance(problem, solution, names, [board.name for board in boards])
    state, layout = solution.state, problem.layout
    views = []
    for s, sight in zip(rms, problem.sights, strict=True):
        own, there = place_corners(problem, state, sight)
        misses = compute_misses(own, there, problem.cameras[sight.camera].model, Cost.IMAGE)
        for k, view in enumerate(np.flatnonzero(agreement.kept[s]).tolist()):
            turn = turns[agreement.turn[s][view]]
            views.append(
                RigView(
                    sight.camera,
                    instants[sight.instant[k]],
                    misses[k, there.corners_of(k)],
                    float(rms[s][k]),
                    float(np.sqrt(agreement.cost[s][view] / 6)),
                    float(np.degrees(np.arctan2(turn[1, 0], turn[0, 0]))) % 360,
                    sight.board,
                )
            )
    return Rig(
        names=names,
        cameras=tuple(
            replace(camera.camera, params=state.params[layout.camera(c)])
            for c, camera in enumerate(cameras)
        ),
        poses=tuple(Pose(*np.split(state.params[layout.pose(c)], 2)) for c in range(len(cameras))),
        offsets=np.array([state.params[layout.offset(c)] for c in range(len(cameras))]),
        covariance=found.covariance,
        noise_covariance=found.noise_covariance,
        instants=tuple(instants),
        boards=tuple(map(Pose, vector_from_rotation(state.R), state.T)),
        views=tuple(views),
        noise=found.noise,
        disagreement=found.disagreement,
        status=solution.status,
        pairs=(),
        placed_boards=tuple(
            PlacedBoard(
                board.name,
                Pose(*np.split(state.params[layout.board(b)] if b else np.zeros(6), 2)),
                joined.references[b],
                found.shapes[b],
            )
            for b, board in enumerate(boards)
        ),
    )


def _list_left_out(
    sights: Sequence[Sight],
    alone: Sequence[CameraAlone],
    agreement: Agreement,
    instants: Sequence[int],
) -> tuple[LeftOutView, ...]:
    """List the views that contradict the others."""
    left_out = []
    for s, (sight, part) in enumerate(zip(sights, alone, strict=True)):
        for view in np.flatnonzero(~agreement.kept[s]).tolist():
            at = part.poses.instant[view]
            both = part.observations.mask[view].sum() + _count_corners(alone, agreement, at)
            error = float(np.sqrt(agreement.cost[s][view] / both))
            left_out.append(LeftOutView(sight.camera, instants[at], error, sight.board))
    return tuple(left_out)


def _count_corners(alone: Sequence[CameraAlone], agreement: Agreement, at: int) -> float:
    """Return the number of corners in the view that those of an instant are compared with."""
    base = alone[int(agreement.base[at])]
    view = int(np.searchsorted(base.poses.instant, at))
    return float(base.observations.mask[view].sum())


def _pair_cameras(sights: Sequence[Sight], pairs: Sequence[RigPair]) -> tuple[RigPair, ...]:
    """Return pairs of sights as pairs of cameras, each the first time that it occurs."""
    found: dict[tuple[int, int], RigPair] = {}
    for pair in pairs:
        a, b = sights[pair.first].camera, sights[pair.second].camera
        if a != b and (b, a) not in found:
            found.setdefault((a, b), replace(pair, first=a, second=b))
    return tuple(found.values())


def _blame_cameras(
    sights: Sequence[Sight], mistakes: Sequence[RigMistake]
) -> tuple[RigMistake, ...]:
    """Return mistakes in sights as mistakes in cameras, those of one kind together.

    Boards that moved against each other explain all views that agree less than others.
    """
    found: dict[tuple[Mistake, int, int, float], RigMistake] = {}
    for mistake in mistakes:
        kind, camera, other = (
            mistake.kind,
            *(sights[s].camera for s in (mistake.camera, mistake.other)),
        )
        if kind is Mistake.MOVED and camera == other:
            kind = Mistake.BOARDS_MOVED
        ratio = mistake.value if kind is Mistake.OTHER_SCALE else 0.0
        before = found.get((kind, camera, other, ratio))
        numbers = {*mistake.instants, *(before.instants if before else ())}
        found[kind, camera, other, ratio] = RigMistake(
            kind, camera, other, tuple(sorted(numbers)), mistake.value
        )
    kinds = {kind for kind, *_ in found}
    unexplained = {Mistake.OTHER_INSTANT, Mistake.LESS_AGREEMENT}
    dropped = unexplained if Mistake.BOARDS_MOVED in kinds else set()
    return tuple(mistake for mistake in found.values() if mistake.kind not in dropped)

"""The calibration of a rig: from cameras that are known alone to cameras that stand to each other.

1. Each camera alone says where the board was in each of its views (``alone.py``).
2. What most instants say of each pair of cameras is found, the pairs are joined to a tree
   (``consensus.py``), and views that contradict the others are left out (``agreement.py``).
3. All is solved together from there (``joint_solve.py``).
4. How much the instants disagree says how far the result is to be trusted (``uncertainty.py``).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution
from calibgui.engine.calibration.refinement.residuals import State, compute_misses
from calibgui.engine.calibration.result import Cost, Report
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import vector_from_rotation
from calibgui.engine.rig.agreement import (
    Agreement,
    describe_pairs,
    find_agreement,
    join_cameras,
    list_turns,
)
from calibgui.engine.rig.alone import CameraAlone, see_alone
from calibgui.engine.rig.consensus import Relation
from calibgui.engine.rig.joint_solve import (
    CameraProblem,
    RigProblem,
    place_views,
    solve_jointly,
)
from calibgui.engine.rig.mistakes import find_mistakes
from calibgui.engine.rig.records import Layout, LeftOutView, Rig, RigCamera, RigPair, RigView
from calibgui.engine.rig.time_offsets import Motion, find_motions, hold_board_still
from calibgui.engine.rig.uncertainty import estimate_rig_covariance
from calibgui.engine.threads import with_one_blas_thread

_OWN = tuple(range(7))
"""Indices of the pose, and of the offset in time, among a camera's unknowns."""
_ROUNDS = 3
"""Number of solves where cameras are late: what contradicts the others shows once the offsets are
known, to some tenths after the first."""


@with_one_blas_thread
def calibrate_rig(
    cameras: Sequence[RigCamera], report: Report | None = None, estimate_offsets: bool = False
) -> Rig:
    """Calibrate a rig: how its cameras stand to each other, and all parameters together.

    Args:
        cameras: the cameras as they are known, with their views by instants. The rig's frame is
            that of the first one.
        report: a function that takes each iteration of the joint solve; it returns False to stop.
        estimate_offsets: True to estimate by how much the clock of each camera is late, from a
            board that moves; views without one before and one after then take no part.

    Raises:
        CalibrationError: if there are fewer than two cameras, a view cannot be used, the cameras
            fall apart into groups that never see the board together, or the views leave a parameter
            open; the message names what.
        Cancelled: from `report`.
    """
    if len(cameras) < 2:
        raise CalibrationError(
            "A rig has at least two cameras.", "Name the photographs of each camera."
        )
    instants = sorted({instant for camera in cameras for instant in camera.views})
    alone = see_alone(cameras, instants)
    motions = hold_board_still(alone)
    if estimate_offsets:
        instants, alone, motions = find_motions(cameras, instants, alone)
    turns, offsets = list_turns(alone), np.zeros(len(cameras))
    for _ in range(_ROUNDS if estimate_offsets else 1):
        still = [
            motion.move_back(part, late)
            for motion, part, late in zip(motions, alone, offsets.tolist(), strict=True)
        ]
        relations = join_cameras(cameras, still, turns)
        agreement = find_agreement(still, relations, turns, len(instants))
        problem = _state_problem(cameras, alone, agreement, turns, len(instants), motions)
        start = _find_start(cameras, still, relations, agreement, offsets)
        solution = solve_jointly(problem, start, report)
        offsets = solution.state.params[[*map(problem.layout.offset, range(len(cameras)))]]
    pairs = describe_pairs(still, relations, turns, agreement)
    rig = _assemble(cameras, instants, alone, turns, agreement, pairs, problem, solution)
    mistakes = find_mistakes(
        cameras, still, relations, turns, agreement, instants, rig.disagreement > 0
    )
    return replace(rig, mistakes=mistakes)


def _state_problem(
    cameras: Sequence[RigCamera],
    alone: Sequence[CameraAlone],
    agreement: Agreement,
    turns: Sequence[Array],
    count: int,
    motions: Sequence[Motion],
) -> RigProblem:
    """State the joint problem of the views that go together."""
    problems = []
    for c, (camera, part) in enumerate(zip(cameras, alone, strict=True)):
        kept, turned = agreement.kept[c], agreement.turn[c]
        observations = _turn_views(part.observations, turned, turns).select_views(kept)
        problems.append(
            CameraProblem(
                camera.camera.model,
                observations,
                part.poses.instant[kept],
                motions[c].velocity[kept],
                motions[c].lag[kept],
                camera.free,
                np.array(_OWN[: 6 + motions[c].is_moving] if c else (), dtype=np.int64),
                _make_prior(camera, agreement.noise),
            )
        )
    layout = Layout(tuple(len(camera.camera.params) for camera in cameras))
    return RigProblem(tuple(problems), layout, count)


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
    alone: Sequence[CameraAlone],
    relations: Sequence[Relation],
    agreement: Agreement,
    offsets: Array,
) -> State:
    """Return the state that the views agree about, with the board where each base sees it."""
    params = np.concatenate(
        [
            np.concatenate([camera.camera.params, vector_from_rotation(R), T, [late]])
            for camera, (R, T), late in zip(cameras, relations, offsets.tolist(), strict=True)
        ]
    )
    count = len(agreement.base)
    R, T = np.empty((count, 3, 3)), np.empty((count, 3))
    for c, (part, relation) in enumerate(zip(alone, relations, strict=True)):
        at = part.poses.instant
        is_base = agreement.base[at] == c
        back, place = relation.invert()
        R[at[is_base]] = back @ part.poses.R[is_base]
        T[at[is_base]] = part.poses.T[is_base] @ back.T + place
    return State(params, R, T)


def _assemble(
    cameras: Sequence[RigCamera],
    instants: Sequence[int],
    alone: Sequence[CameraAlone],
    turns: Sequence[Array],
    agreement: Agreement,
    pairs: tuple[RigPair, ...],
    problem: RigProblem,
    solution: Solution,
) -> Rig:
    """Assemble the rig that was found."""
    names = tuple(camera.name for camera in cameras)
    found = estimate_rig_covariance(problem, solution, names)
    state, layout = solution.state, problem.layout
    views, left_out = [], []
    for c, part in enumerate(alone):
        own = problem.cameras[c]
        misses = compute_misses(
            place_views(problem, state, c), own.observations, own.model, Cost.IMAGE
        )
        rms, kept = part.compute_rms(), np.flatnonzero(agreement.kept[c])
        for k, view in enumerate(kept.tolist()):
            turn = turns[agreement.turn[c][view]]
            views.append(
                RigView(
                    c,
                    instants[part.poses.instant[view]],
                    misses[k, own.observations.corners_of(k)],
                    float(rms[view]),
                    float(np.sqrt(agreement.cost[c][view] / 6)),
                    float(np.degrees(np.arctan2(turn[1, 0], turn[0, 0]))) % 360,
                )
            )
        for view in np.flatnonzero(~agreement.kept[c]).tolist():
            at = part.poses.instant[view]
            both = part.observations.mask[view].sum() + _count_corners(alone, agreement, at)
            error = float(np.sqrt(agreement.cost[c][view] / both))
            left_out.append(LeftOutView(c, instants[at], error))
    poses = [np.split(state.params[layout.pose(c)], 2) for c in range(len(cameras))]
    return Rig(
        names=names,
        cameras=tuple(
            replace(camera.camera, params=state.params[layout.camera(c)])
            for c, camera in enumerate(cameras)
        ),
        poses=tuple(Pose(rvec, tvec) for rvec, tvec in poses),
        offsets=np.array([state.params[layout.offset(c)] for c in range(len(cameras))]),
        covariance=found.covariance,
        noise_covariance=found.noise_covariance,
        instants=tuple(instants),
        boards=tuple(map(Pose, vector_from_rotation(state.R), state.T)),
        views=tuple(views),
        noise=found.noise,
        disagreement=found.disagreement,
        status=solution.status,
        pairs=pairs,
        left_out=tuple(left_out),
    )


def _count_corners(alone: Sequence[CameraAlone], agreement: Agreement, at: int) -> float:
    """Return the number of corners in the view that those of an instant are compared with."""
    base = alone[int(agreement.base[at])]
    view = int(np.searchsorted(base.poses.instant, at))
    return float(base.observations.mask[view].sum())

"""Hand and eye in closed form: a start, and the measure of how well poses fit.

With H_k = base_from_hand, C_k = cam_from_board, X = hand_from_camera and W = base_from_board

    H_k X C_k = W        for every pose k.

*Rotations.* Three ways, of which the one that scatters least is taken:

1.  All turns (Shah 2013, "Solving the robot-world/hand-eye calibration problem using the Kronecker
    product"). As vec(R_W) = (R_Hk (x) R_Ck^T) vec(R_X), row by row, the largest singular value of
    the sum of these matrices is the number of poses, and its singular vectors are R_X and R_W to a
    factor.
2.  The axis that most turns have, which is all that a robot of four axes offers. With
    A = R_Hi^T R_Hj and B = R_Ci R_Cj^T, A = R_X B R_X^T, so that the skew parts are a = R_X b. The
    largest singular vectors u, v of the sum of a b^T answer each other, u = R_X v, and leave a turn
    psi about u open. R_X is linear in (cos psi, sin psi), which are solved for together with the
    translations.
3.  No turn at all: t_Hi - t_Hj = R_H R_X (t_Cj - t_Ci), the rotation from one set of points to
    another.

*Translations* are linear: R_Hk t_X - t_W = -t_Hk - R_Hk R_X t_Ck. Of what is open the shortest
solution is taken.

The *scatter* says how well all fits: the board's points should lie at the same places
W_k = H_k X C_k of the base for all k. It is the root mean square distance from their means, mm.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.geometry.rotations import make_cross_matrix
from calibgui.engine.hand_eye.motions import Motions, project_on_rotations


class ClosedForm(NamedTuple):
    """Hand and eye from poses of a robot and of a board."""

    X: Motions
    """hand_from_camera."""
    W: Motions
    """base_from_board."""
    scatter: float
    """Root mean square distance of the board's points in the base from their means, mm."""


def solve_closed_form(robot: Motions, boards: Motions, points: Array) -> ClosedForm:
    """Solve H_k X C_k = W for X and W.

    Args:
        robot: H_k, base_from_hand.
        boards: C_k, cam_from_board.
        points: (n, 3) points of the board, whose scatter is measured, mm.
    """
    rotations = [
        _rotate_by_all_turns(robot, boards),
        _rotate_by_axis(robot, boards),
        _rotate_by_translations(robot, boards),
    ]
    found = [_place(R, robot, boards, points) for R in rotations]
    return min(found, key=lambda each: each.scatter)


def _rotate_by_all_turns(robot: Motions, boards: Motions) -> Array:
    """Return R_X (3, 3) from turns about several axes."""
    M = np.einsum("kij,kml->iljm", robot.R, boards.R).reshape(9, 9)
    X = np.linalg.svd(M)[2][0].reshape(3, 3)
    return project_on_rotations(X * np.sign(np.linalg.det(X)))


def _rotate_by_axis(robot: Motions, boards: Motions) -> Array:
    """Return R_X (3, 3) from turns about one axis, and the translations."""
    K = len(robot.R)
    first = np.tile(np.arange(K), 2)  # each pose with the next, and with one half the list away
    then = np.concatenate([np.roll(np.arange(K), 1), np.roll(np.arange(K), K // 2)])
    A = np.swapaxes(robot.R[first], 1, 2) @ robot.R[then]
    B = boards.R[first] @ np.swapaxes(boards.R[then], 1, 2)
    U, _, V = np.linalg.svd(_take_skew_part(A).T @ _take_skew_part(B))
    u, v = U[:, 0], V[0]
    # A turn that takes v to u: the rest of the two frames is any right-handed one.
    start = np.column_stack([u, U[:, 1], np.cross(u, U[:, 1])]) @ np.array(
        [v, V[1], np.cross(v, V[1])]
    )
    along = np.outer(u, u) @ start  # R_X = along + cos psi (start - along) + sin psi [u]x start
    parts = [start - along, make_cross_matrix(u) @ start]
    moved = [(robot.R @ (part @ boards.t[..., None]))[..., 0] for part in [along, *parts]]
    solution = _solve_translations(robot, moved[0], np.stack(moved[1:], axis=-1))
    cosine, sine = solution[6:] / (np.hypot(*solution[6:]) or 1.0)
    return project_on_rotations(along + cosine * parts[0] + sine * parts[1])


def _take_skew_part(R: Array) -> Array:
    """Return (..., 3) the axis times twice the sine of rotations (..., 3, 3)."""
    skew = np.swapaxes(R, -1, -2) - R
    return np.asarray(skew[..., [1, 2, 0], [2, 0, 1]])


def _rotate_by_translations(robot: Motions, boards: Motions) -> Array:
    """Return R_X (3, 3) from motions without turns."""
    hand = (np.swapaxes(robot.R, 1, 2) @ (robot.t - robot.t.mean(axis=0))[..., None])[..., 0]
    eye = boards.t.mean(axis=0) - boards.t
    return project_on_rotations(hand.T @ eye)


def _solve_translations(robot: Motions, moved: Array, others: Array | None = None) -> Array:
    """Return t_X, t_W (6,) and the factors of `others` (K, 3, n), by least squares.

    Args:
        robot: H_k.
        moved: (K, 3) R_Hk R_X t_Ck.
        others: (K, 3, n) what is to be added to `moved`, each to a factor; None for nothing.
    """
    columns = [robot.R, np.broadcast_to(-np.eye(3), robot.R.shape)]
    matrix = np.concatenate(columns if others is None else [*columns, others], axis=-1)
    right = -(robot.t + moved)
    return np.asarray(np.linalg.lstsq(matrix.reshape(-1, matrix.shape[-1]), right.ravel())[0])


def measure_scale(R_X: Array, robot: Motions, boards: Motions) -> float:
    """Measure how many times as far away as stated the boards are, by the robot's motions.

    It is the factor of t_Ck with which the translations are solved best.
    """
    moved = (robot.R @ (R_X @ boards.t[..., None]))[..., 0]
    return 1.0 + float(_solve_translations(robot, moved, moved[..., None])[6])


def _place(R_X: Array, robot: Motions, boards: Motions, points: Array) -> ClosedForm:
    """Add the translations and W to a rotation of X, and measure the scatter."""
    moved = (robot.R @ (R_X @ boards.t[..., None]))[..., 0]
    X = Motions(R_X, _solve_translations(robot, moved)[:3])
    places = robot.after(X).after(boards)
    W = Motions(project_on_rotations(places.R.mean(axis=0)), places.t.mean(axis=0))
    corners = places.move(points)
    off = corners - corners.mean(axis=0)
    return ClosedForm(X, W, float(np.sqrt(np.mean(np.sum(off**2, axis=-1)))))

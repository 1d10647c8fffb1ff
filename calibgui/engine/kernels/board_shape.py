"""The plate's part of the normal equations, compiled.

``plate.deviations.corner_products``, and ``problem.view_products`` of a plate that follows the
camera.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.kernels.common import BLOCK, compiled, gram, in_blocks, plain
from calibgui.engine.kernels.normal_equations import Views, image, jacobian, workspace
from calibgui.engine.kernels.polynomial_lens import Eq10Camera


@compiled
def _by_corner(R, by_pose, C):  # type: ignore[no-untyped-def]
    """Rows of C (3, 2N): derivatives by the corner's place on the plate, from those by the pose."""
    for a in range(3):
        r0, r1, r2 = R[0, a], R[1, a], R[2, a]
        for i in range(C.shape[1]):
            C[a, i] = r0 * by_pose[3, i] + r1 * by_pose[4, i] + r2 * by_pose[5, i]


@compiled
def _products(camera, backward, R, T, uv, xyz, weight, whitened, rows, index, A, D, total):  # type: ignore[no-untyped-def]
    """Fill A (K, P + 7, P + 7) as in Stage II; add up D (K, n, 3, 6) and total (n, 3, P + 4)."""
    K, _, N = uv.shape
    P = rows.shape[0]
    work, J, C = workspace(N), np.empty((P + 7, 2 * N)), np.empty((3, 2 * N))
    for view in range(K):
        good = image(camera, backward, R[view], T[view], uv[view], xyz[view], work)
        jacobian(camera, backward, uv[view], weight[view], whitened, rows, work, J)
        gram(J, A[view])
        if not good:
            A[view, -1, -1] = np.inf
        _by_corner(R[view], J[P : P + 6], C)
        for i in range(N):
            corner = index[view, i]
            for a in range(3):
                cu, cv = C[a, i], C[a, N + i]
                for m in range(P):
                    total[corner, a, m] += cu * J[m, i] + cv * J[m, N + i]
                total[corner, a, P] += cu * J[P + 6, i] + cv * J[P + 6, N + i]
                for m in range(3):
                    total[corner, a, P + 1 + m] += cu * C[m, i] + cv * C[m, N + i]
                for m in range(6 if D.size else 0):
                    D[view, corner, a, m] += cu * J[P + m, i] + cv * J[P + m, N + i]


def products(
    lens: Eq10Camera,
    R: Array,
    T: Array,
    views: Views,
    rows: IntArray,
    index: IntArray,
    count: int,
    with_poses: bool,
) -> tuple[Array, Array, Array]:
    """Products of the columns [camera, pose, r] of some views and of those of the plate's corners.

    Args:
        lens: the camera.
        R: (K, 3, 3) rotations.
        T: (K, 3) translations, mm.
        views: what was measured.
        rows: (P,) places of the free parameters in ``lens.camera``.
        index: (K, N) which of the plate's corners each observation is.
        count: n, their number.
        with_poses: whether to return the second of the results; nothing otherwise.

    Returns:
        (K, P + 7, P + 7) of the first columns with each other; (K, n, 3, 6) of the three columns
        of each corner with the pose's; (n, 3, P + 4) of these with the camera's, with r and with
        themselves, summed over the views.
    """
    K, P = len(R), len(rows)
    A, D = np.empty((K, P + 7, P + 7)), np.zeros((K if with_poses else 0, count, 3, 6))
    totals = np.zeros((-(-K // BLOCK), count, 3, P + 4))
    R, T = plain(R), plain(T)
    uv, xyz, weight = views
    whitened = weight.shape[2] > 0

    def run(part: slice) -> None:
        _products(
            *lens, R[part], T[part], uv[part], xyz[part], weight[part], whitened, rows,
            index[part], A[part], D[part if with_poses else slice(0)], totals[part.start // BLOCK],
        )  # fmt: skip

    in_blocks(K, run)
    return A, D, totals.sum(axis=0)


@compiled
def _followed(camera, backward, R, T, uv, xyz, weight, whitened, rows, index, motion, A):  # type: ignore[no-untyped-def]
    """Fill A (K, P + 7, P + 7) as in Stage II, where corners move by motion (n, 3, P)."""
    K, _, N = uv.shape
    P = rows.shape[0]
    work, J, C = workspace(N), np.empty((P + 7, 2 * N)), np.empty((3, 2 * N))
    for view in range(K):
        good = image(camera, backward, R[view], T[view], uv[view], xyz[view], work)
        jacobian(camera, backward, uv[view], weight[view], whitened, rows, work, J)
        _by_corner(R[view], J[P : P + 6], C)
        for i in range(2 * N):
            moved = motion[index[view, i % N]]
            for m in range(P):
                J[m, i] += C[0, i] * moved[0, m] + C[1, i] * moved[1, m] + C[2, i] * moved[2, m]
        gram(J, A[view])
        if not good:
            A[view, -1, -1] = np.inf


def followed(
    lens: Eq10Camera,
    R: Array,
    T: Array,
    views: Views,
    rows: IntArray,
    index: IntArray,
    motion: Array,
) -> Array:
    """(K, P + 7, P + 7) products of the columns [camera, pose, r] where the plate follows.

    Args:
        lens: the camera.
        R: (K, 3, 3) rotations.
        T: (K, 3) translations, mm.
        views: what was measured.
        rows: (P,) places of the free parameters in ``lens.camera``.
        index: (K, N) which of the plate's corners each observation is.
        motion: (n, 3, P) of the corners with the free parameters, mm.
    """
    A = np.empty((len(R), len(rows) + 7, len(rows) + 7))
    R, T, motion = plain(R), plain(T), plain(motion)
    uv, xyz, weight = views
    whitened = weight.shape[2] > 0

    def run(part: slice) -> None:
        _followed(
            *lens, R[part], T[part], uv[part], xyz[part], weight[part], whitened, rows,
            index[part], motion, A[part],
        )  # fmt: skip

    in_blocks(len(R), run)
    return A

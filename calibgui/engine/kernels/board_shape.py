"""The board shape's part of the normal equations, compiled.

The readable references are ``calibration.board_shape.parametrisation.iterate_corner_products`` and
``calibration.refinement.residuals.compute_view_products``.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.kernels.cameras import CameraTuple, PackedCamera, find_rows, pack_camera
from calibgui.engine.kernels.common import (
    VIEWS_PER_BLOCK,
    compiled,
    compiled_part,
    gram,
    make_contiguous,
    run_in_blocks,
)
from calibgui.engine.kernels.normal_equations import (
    CameraAndPoses,
    MeasuredViews,
    Views,
    fill_jacobian,
    make_workspace,
    pack_views,
    project_view,
    sum_products,
)

_CORNERS_TOGETHER = 5_000
"""Number of the board's corners, in all views, whose products with the poses are held at once;
0.7 MB, which stay in the processor's cache until they are used."""


class BoardMotion(Protocol):
    """The fields of ``calibration.refinement.residuals.BoardMotion``."""

    @property
    def motion(self) -> Array: ...
    @property
    def corner(self) -> IntArray: ...


@compiled_part
def _differentiate_by_corner(R: Array, by_pose: Array, C: Array) -> None:
    """Fill C (3, 2N) with derivatives by the corner's place on the board, from by_pose (6, 2N)."""
    for a in range(3):
        r0, r1, r2 = R[0, a], R[1, a], R[2, a]
        for i in range(C.shape[1]):
            C[a, i] = r0 * by_pose[3, i] + r1 * by_pose[4, i] + r2 * by_pose[5, i]


@compiled_part
def _add_products(C: Array, row: Array, out: Array, m: int) -> None:
    """Add to the rows m of out (3, M, n) the products of those of C (3, 2n) with a row (2n,), those
    of u and of v together."""
    n = out.shape[2]
    # Slices, and not indices, so that the compiler sees what it can vectorise.
    u, v, out0, out1, out2 = row[:n], row[n:], out[0, m], out[1, m], out[2, m]
    u0, u1, u2, v0, v1, v2 = C[0, :n], C[1, :n], C[2, :n], C[0, n:], C[1, n:], C[2, n:]
    for i in range(n):
        out0[i] += u0[i] * u[i] + v0[i] * v[i]
        out1[i] += u1[i] * u[i] + v1[i] * v[i]
        out2[i] += u2[i] * u[i] + v2[i] * v[i]


@compiled
def _sum_corner_views(
    camera: CameraTuple,
    kind: int,
    of_rays: bool | None,
    R: Array,
    T: Array,
    uv: Array,
    xyz: Array,
    weight: Array,
    whitened: bool,
    rows: IntArray,
    A: Array,
    D: Array,
    total: Array,
) -> None:
    """Fill A (K, P + 7, P + 7) as in Stage II and D (K, 3, 6, n); add to total (3, P + 4, n)."""
    K, _, N = uv.shape
    P = rows.shape[0]
    work, J, C = make_workspace(N), np.empty((P + 7, 2 * N)), np.empty((3, 2 * N))
    for view in range(K):
        good = project_view(camera, kind, of_rays, R[view], T[view], uv[view], xyz[view], work)
        fill_jacobian(camera, kind, of_rays, uv[view], weight[view], whitened, rows, work, J)
        gram(J, A[view])
        if not good:
            A[view, -1, -1] = np.inf
        _differentiate_by_corner(R[view], J[P : P + 6], C)
        for m in range(P):
            _add_products(C, J[m], total, m)
        _add_products(C, J[P + 6], total, P)
        for m in range(3):
            _add_products(C, C[m], total, P + 1 + m)
        if D.size:
            D[view] = 0.0
            for m in range(6):
                _add_products(C, J[P + m], D[view], m)


def _arrange_by_corner(views: Views, index: IntArray, count: int) -> Views:
    """Arrange views by the board's corners: (K, ., n), those that a view does not show weigh 0."""
    K, N = index.shape
    if N == count and (index == index[0]).all() and len(np.unique(index[0])) == count:
        order = np.argsort(index[0])
        return Views(*(np.take(array, order[: array.shape[2]], axis=2) for array in views))
    uv, xyz = (np.repeat(array[..., :1], count, axis=2) for array in (views.uv, views.xyz))
    weight, given = np.zeros((K, 4, count)), views.weight
    if not given.size:
        given = np.broadcast_to(np.array([1.0, 0, 0, 1])[:, None], (K, 4, N))
    view, place = np.nonzero((given != 0).any(axis=1))
    for whole, array in ((uv, views.uv), (xyz, views.xyz), (weight, given)):
        whole[view, :, index[view, place]] = array[view, :, place]
    return Views(uv, xyz, weight)


def _sum_corner_products(
    lens: PackedCamera,
    R: Array,
    T: Array,
    views: Views,
    rows: IntArray,
    index: IntArray,
    D: Array,
) -> tuple[Array, Array]:
    """Return products of the columns [camera, pose, r] of some views and of the board's corners.

    Args:
        lens: the camera.
        R: (K, 3, 3) rotations.
        T: (K, 3) translations, mm.
        views: the measured corners.
        rows: (P,) places of the free parameters in ``lens.camera``.
        index: (K, N) number of the board's corner that each observation shows.
        D: (K, 3, 6, n) the products of the three columns of each corner with the pose's, which are
            filled in; none, (0, 3, 6, n), if they are not wanted.

    Returns:
        (K, P + 7, P + 7) of the first columns with each other; (n, 3, P + 4) of the corners'
        columns with the camera's, with r and with themselves, summed over the views.
    """
    K, P, count = len(R), len(rows), D.shape[-1]
    A = np.empty((K, P + 7, P + 7))
    totals = np.zeros((-(-K // VIEWS_PER_BLOCK), 3, P + 4, count))
    R, T = make_contiguous(R), make_contiguous(T)
    uv, xyz, weight = _arrange_by_corner(views, index, count)
    whitened = weight.shape[2] > 0

    def run(part: slice) -> None:
        _sum_corner_views(
            *lens, R[part], T[part], uv[part], xyz[part], weight[part], whitened, rows,
            A[part], D[part],
            totals[part.start // VIEWS_PER_BLOCK],
        )  # fmt: skip

    run_in_blocks(K, run)
    return A, np.moveaxis(totals.sum(axis=0), -1, 0)


@compiled
def _sum_moving_views(
    camera: CameraTuple,
    kind: int,
    of_rays: bool | None,
    R: Array,
    T: Array,
    uv: Array,
    xyz: Array,
    weight: Array,
    whitened: bool,
    rows: IntArray,
    index: IntArray,
    motion: Array,
    A: Array,
) -> None:
    """Fill A (K, P + 7, P + 7) as in Stage II, where corners move by motion (n, 3, P)."""
    K, _, N = uv.shape
    P = rows.shape[0]
    work, J, C = make_workspace(N), np.empty((P + 7, 2 * N)), np.empty((3, 2 * N))
    for view in range(K):
        good = project_view(camera, kind, of_rays, R[view], T[view], uv[view], xyz[view], work)
        fill_jacobian(camera, kind, of_rays, uv[view], weight[view], whitened, rows, work, J)
        _differentiate_by_corner(R[view], J[P : P + 6], C)
        for i in range(2 * N):
            moved = motion[index[view, i % N]]
            for m in range(P):
                J[m, i] += C[0, i] * moved[0, m] + C[1, i] * moved[1, m] + C[2, i] * moved[2, m]
        gram(J, A[view])
        if not good:
            A[view, -1, -1] = np.inf


def _sum_moving_products(
    lens: PackedCamera,
    R: Array,
    T: Array,
    views: Views,
    rows: IntArray,
    index: IntArray,
    motion: Array,
) -> Array:
    """Return (K, P + 7, P + 7) products of the columns [camera, pose, r] of a board that moves.

    Args:
        lens: the camera.
        R: (K, 3, 3) rotations.
        T: (K, 3) translations, mm.
        views: the measured corners.
        rows: (P,) places of the free parameters in ``lens.camera``.
        index: (K, N) number of the board's corner that each observation shows.
        motion: (n, 3, P) motion of the corners per unit of each free parameter, mm.
    """
    A = np.empty((len(R), len(rows) + 7, len(rows) + 7))
    R, T, motion = make_contiguous(R), make_contiguous(T), make_contiguous(motion)
    uv, xyz, weight = views
    whitened = weight.shape[2] > 0

    def run(part: slice) -> None:
        _sum_moving_views(
            *lens, R[part], T[part], uv[part], xyz[part], weight[part], whitened, rows,
            index[part], motion, A[part],
        )  # fmt: skip

    run_in_blocks(len(R), run)
    return A


def compute_view_products(
    state: CameraAndPoses,
    observations: MeasuredViews,
    model: str,
    free: IntArray,
    following: BoardMotion | None = None,
) -> Array:
    """Compute ``calibration.refinement.residuals.compute_view_products``."""
    lens, rows = pack_camera(model, state.params), find_rows(model, free)
    views = pack_views(observations)
    if following is None:
        return sum_products(lens, state.R, state.T, views, rows)
    return _sum_moving_products(
        lens, state.R, state.T, views, rows, following.corner, following.motion
    )


def iterate_corner_products(
    state: CameraAndPoses,
    observations: MeasuredViews,
    model: str,
    free: IntArray,
    index: IntArray,
    count: int,
    with_poses: bool = True,
) -> Iterator[tuple[slice, Array, Array, Array]]:
    """Compute ``calibration.board_shape.parametrisation.iterate_corner_products``."""
    lens, rows = pack_camera(model, state.params), find_rows(model, free)
    K, together = len(index), max(_CORNERS_TOGETHER // count, 1)
    # One array for all parts: new memory costs more than what is computed in it.
    held = np.empty((min(together, K) if with_poses else 0, 3, 6, count))
    for begin in range(0, K, together):
        part = slice(begin, min(begin + together, K))
        views, D = pack_views(observations.select_views(part)), held[: part.stop - begin]
        A, total = _sum_corner_products(
            lens, state.R[part], state.T[part], views, rows, index[part], D
        )
        yield part, A, np.moveaxis(D, -1, 1), total

"""Stage II's residuals and normal equations with the image cost, compiled.

The readable reference, which this file is tested against, is ``calibration.refinement.residuals``.

All polynomial lens models are eq. 10's (``polynomial_lens.py``): the paper's corrects, and is
inverted from the measured corner; the others distort. With M = d(measured) / d(ideal) the
derivatives by the coefficients are -M basis(measured) for the first and S basis(ideal) for the
others, with S = [1 skew; 0 1]. The lenses of ``ray_lenses.py`` image points, with the derivatives
by the point and by the coefficients. Padded corners carry zero weight.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.kernels.cameras import (
    BACKWARD,
    CameraTuple,
    PackedCamera,
    find_rows,
    is_of_rays,
    pack_camera,
)
from calibgui.engine.kernels.common import (
    VIEWS_PER_BLOCK,
    compiled,
    compiled_allocating_part,
    compiled_part,
    gram,
    make_contiguous,
    run_in_blocks,
)
from calibgui.engine.kernels.polynomial_lens import add_skew, distort, invert
from calibgui.engine.kernels.ray_lenses import find_rays, image_points
from calibgui.engine.kernels.views import CameraAndPoses, MeasuredViews, Views, pack_views

Workspace = tuple[Array, Array, Array, Array, Array, Array, Array, Array, Array]
Blocks = tuple[Array, Array, Array, Array, Array, Array]
"""U, W, V, the shared gradient, the poses' gradients and the views' costs."""


@compiled_part
def _differentiate_by_params(
    fc: tuple[float, float, float, float, float], base: Array, lead: Array, d: Array, F: Array
) -> None:
    """Fill the rows of F (17, 2N) with derivatives of u (first N), v by fx, fy, cx, cy, k and skew.

    `base` (2, N) is where the basis is evaluated, `lead` (4, N) what multiplies it.
    """
    fx, fy, p1, p2, p3 = fc
    n = d.shape[1]
    # Slices, and not indices, so that the compiler sees what it can vectorise.
    base0, base1, d0, d1 = base[0], base[1], d[0], d[1]
    # Not F[0, :n] = d0: its message about unlike shapes would be compiled, too.
    for i in range(n):
        F[0, i], F[1, n + i], F[10, i] = d0[i], d1[i], fx * d1[i]
    for row in range(2):
        f, lead0, lead1 = (fx if row == 0 else fy), lead[2 * row], lead[2 * row + 1]
        half = slice(0, n) if row == 0 else slice(n, 2 * n)
        F4, F5, F6 = F[4, half], F[5, half], F[6, half]
        F7, F8, F9 = F[7, half], F[8, half], F[9, half]
        for i in range(n):
            x, y = base0[i], base1[i]
            xx, yy, xy = x * x, y * y, x * y
            r2 = xx + yy
            q = 1 + p3 * r2
            c, e = f * lead0[i], f * lead1[i]
            b = r2 * (c * x + e * y)
            F4[i], F5[i], F6[i] = b, r2 * b, r2 * r2 * b
            g0, g1, g2 = q * (r2 + 2 * xx), 2 * q * xy, q * (r2 + 2 * yy)
            F7[i], F8[i] = c * g0 + e * g1, c * g1 + e * g2
            lx = r2 * (p1 * (r2 + 2 * xx) + 2 * p2 * xy)
            ly = r2 * (2 * p1 * xy + p2 * (r2 + 2 * yy))
            F9[i] = c * lx + e * ly


@compiled_part
def _differentiate_by_pose(
    fx: float, fy: float, rotated: Array, n: Array, M: Array, inverse_depth: Array, J: Array
) -> None:
    """Fill the rows of J (6, 2N) with derivatives by (w, tau): by w they are the cross product of
    R X and d(u, v)/dX_cam."""
    N = n.shape[1]
    n0, n1 = n[0], n[1]
    rotated0, rotated1, rotated2 = rotated[0], rotated[1], rotated[2]
    for row in range(2):
        scale, M0, M1 = (fx if row == 0 else fy), M[2 * row], M[2 * row + 1]
        half = slice(0, N) if row == 0 else slice(N, 2 * N)
        J0, J1, J2 = J[0, half], J[1, half], J[2, half]
        J3, J4, J5 = J[3, half], J[4, half], J[5, half]
        for i in range(N):
            a0, a1, a2 = rotated0[i], rotated1[i], rotated2[i]
            f = scale * inverse_depth[i]
            c0, c1 = f * M0[i], f * M1[i]
            c2 = -(c0 * n0[i] + c1 * n1[i])
            J0[i], J1[i], J2[i] = a1 * c2 - a2 * c1, a2 * c0 - a0 * c2, a0 * c1 - a1 * c0
            J3[i], J4[i], J5[i] = c0, c1, c2


@compiled_part
def _turn_ray_slopes(fx: float, fy: float, rotated: Array, G: Array, J: Array) -> None:
    """Fill the rows of J (6, 2N) as `_differentiate_by_pose`, from G (6, N) = dd/dX_cam."""
    N = G.shape[1]
    for i in range(N):
        a0, a1, a2 = rotated[0, i], rotated[1, i], rotated[2, i]
        for row in range(2):
            f = fx if row == 0 else fy
            c0, c1, c2 = f * G[3 * row, i], f * G[3 * row + 1, i], f * G[3 * row + 2, i]
            j = i + row * N
            J[0, j], J[1, j], J[2, j] = a1 * c2 - a2 * c1, a2 * c0 - a0 * c2, a0 * c1 - a1 * c0
            J[3, j], J[4, j], J[5, j] = c0, c1, c2


@compiled_part
def _whiten(weight: Array, J: Array) -> None:
    """Multiply J (M, 2N) with the corners' whitening (4, N): w00, w01, w10, w11."""
    N = weight.shape[1]
    w0, w1, w2, w3 = weight[0], weight[1], weight[2], weight[3]
    for m in range(J.shape[0]):
        Ju, Jv = J[m, :N], J[m, N:]
        for i in range(N):
            u, v = Ju[i], Jv[i]
            Ju[i] = w0[i] * u + w1[i] * v
            Jv[i] = w2[i] * u + w3[i] * v


@compiled_allocating_part
def _make_workspace(N: int) -> Workspace:
    """Return the arrays of one view that later calls fill: R X, 1 / depth, n, d, M, lead, F,
    X_cam and dd/dX_cam."""
    rotated, inverse_depth, n, d = np.empty((3, N)), np.empty(N), np.empty((2, N)), np.empty((2, N))
    M, lead, F = np.empty((4, N)), np.zeros((4, N)), np.zeros((17, 2 * N))
    lead[0, :] = 1.0
    lead[3, :] = 1.0
    F[2, :N] = 1.0
    F[3, N:] = 1.0
    return rotated, inverse_depth, n, d, M, lead, F, np.empty((3, N)), np.empty((6, N))


@compiled_part
def _project_view(
    camera: CameraTuple,
    kind: int,
    R: Array,
    T: Array,
    uv: Array,
    xyz: Array,
    work: Workspace,
) -> bool:
    """Fill in the images d of one view's corners, with what `_fill_jacobian` needs; return whether
    all corners have an image. For a polynomial lens these are the rays n and M = dd/dn."""
    rotated, inverse_depth, n, d, M, _, F, point, G = work
    fx, fy, cx, cy = camera[:4]
    X, Y, Z = xyz[0], xyz[1], xyz[2]
    N = Z.shape[0]
    for row in range(3):
        r0, r1, r2 = R[row, 0], R[row, 1], R[row, 2]
        for i in range(N):
            rotated[row, i] = r0 * X[i] + r1 * Y[i] + r2 * Z[i]
    if is_of_rays(kind):
        for row in range(3):
            for i in range(N):
                point[row, i] = rotated[row, i] + T[row]
        return image_points(kind, camera, point, d, G, M, F)
    behind = False
    for i in range(N):
        depth = rotated[2, i] + T[2]
        behind |= not depth > 0
        inverse_depth[i] = 1 / depth
        n[0, i] = (rotated[0, i] + T[0]) * inverse_depth[i]
        n[1, i] = (rotated[1, i] + T[1]) * inverse_depth[i]
    if kind == BACKWARD:
        for i in range(N):
            d[0, i] = (uv[0, i] - cx) / fx
            d[1, i] = (uv[1, i] - cy) / fy
        return invert(n, camera[4:10], d, M) and not behind
    distort(n, camera[4:10], d, M)
    add_skew(camera[10], d, M)
    return not behind


@compiled_part
def _fill_jacobian(
    camera: CameraTuple,
    kind: int,
    uv: Array,
    weight: Array,
    whitened: bool,
    rows: IntArray,
    work: Workspace,
    J: Array,
) -> None:
    """Fill J (P + 7, 2N) with the whitened [J_free J_pose r] of the view last projected."""
    rotated, inverse_depth, n, d, M, lead, F, _, G = work
    fx, fy, cx, cy = camera[:4]
    p1, p2, p3, skew = camera[7:11]
    P, N = rows.shape[0], uv.shape[1]
    if is_of_rays(kind):
        for i in range(N):
            F[0, i], F[1, N + i] = d[0, i], d[1, i]
        _turn_ray_slopes(fx, fy, rotated, G, J[P : P + 6])
    else:
        if kind == BACKWARD:
            for j in range(4):
                for i in range(N):
                    lead[j, i] = -M[j, i]
        else:
            lead[1, :] = skew
        base = d if kind == BACKWARD else n
        _differentiate_by_params((fx, fy, p1, p2, p3), base, lead, d, F)
        _differentiate_by_pose(fx, fy, rotated, n, M, inverse_depth, J[P : P + 6])
    for j in range(P):
        row = rows[j]
        for i in range(2 * N):
            J[j, i] = F[row, i]
    ru, rv = J[P + 6, :N], J[P + 6, N:]
    for i in range(N):
        ru[i] = cx + fx * d[0, i] - uv[0, i]
        rv[i] = cy + fy * d[1, i] - uv[1, i]
    if whitened:
        _whiten(weight, J)


@compiled_part
def _differentiate_by_corner(R: Array, by_pose: Array, C: Array) -> None:
    """Fill C (3, 2N) with derivatives by the corner's place on the board, from by_pose (6, 2N)."""
    for a in range(3):
        r0, r1, r2 = R[0, a], R[1, a], R[2, a]
        for i in range(C.shape[1]):
            C[a, i] = r0 * by_pose[3, i] + r1 * by_pose[4, i] + r2 * by_pose[5, i]


@compiled_part
def _move_corners(C: Array, index: IntArray, motion: Array, J: Array) -> None:
    """Add to J what the P parameters do by moving the corners index (N,) by motion (n, 3, P)."""
    N, P = index.shape[0], motion.shape[2]
    for i in range(2 * N):
        moved = motion[index[i % N]]
        for m in range(P):
            J[m, i] += C[0, i] * moved[0, m] + C[1, i] * moved[1, m] + C[2, i] * moved[2, m]


@compiled_part
def _add_corner_products(C: Array, row: Array, out: Array, m: int) -> None:
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
def _sum_views(
    camera: CameraTuple,
    kind: int,
    R: Array,
    T: Array,
    uv: Array,
    xyz: Array,
    weight: Array,
    whitened: bool,
    rows: IntArray,
    index: IntArray,
    motion: Array,
    by_pose: Array,
    total: Array,
    out: Array,
) -> None:
    """Fill out (K, P + 7, P + 7) with the products of the rows of each view's J, and do what
    `BoardCorners` says of arrays that are not empty; total is (1, 3, P + 4, n)."""
    K, _, N = uv.shape
    P = rows.shape[0]
    work, J, C = _make_workspace(N), np.empty((P + 7, 2 * N)), np.empty((3, 2 * N))
    for view in range(K):
        good = _project_view(camera, kind, R[view], T[view], uv[view], xyz[view], work)
        _fill_jacobian(camera, kind, uv[view], weight[view], whitened, rows, work, J)
        if motion.size or total.size:
            _differentiate_by_corner(R[view], J[P : P + 6], C)
        if motion.size:
            _move_corners(C, index[view], motion, J)
        gram(J, out[view])
        if not good:
            out[view, -1, -1] = np.inf
        if total.size:
            for m in range(P + 4):
                j = P + 6 if m == P else m
                _add_corner_products(C, C[m - P - 1] if m > P else J[j], total[0], m)
        if by_pose.size:
            by_pose[view] = 0.0
            for m in range(6):
                _add_corner_products(C, J[P + m], by_pose[view], m)


@compiled
def _linearise_views(
    camera: CameraTuple,
    kind: int,
    R: Array,
    T: Array,
    uv: Array,
    xyz: Array,
    weight: Array,
    rows: IntArray,
    residual: Array,
    by_params: Array,
    by_pose: Array,
) -> None:
    """Fill residual (K, N, 2), by_params (K, N, 2, P) and by_pose (K, N, 2, 6), not whitened; NaN
    for a view with corners that have no image."""
    K, _, N = uv.shape
    P = rows.shape[0]
    work, J = _make_workspace(N), np.empty((P + 7, 2 * N))
    for view in range(K):
        good = _project_view(camera, kind, R[view], T[view], uv[view], xyz[view], work)
        _fill_jacobian(camera, kind, uv[view], weight[view], False, rows, work, J)
        lost = 0.0 if good else np.nan
        for i in range(N):
            for row in range(2):
                j = i + row * N
                residual[view, i, row] = J[P + 6, j] + lost
                for m in range(P):
                    by_params[view, i, row, m] = J[m, j] + lost
                for m in range(6):
                    by_pose[view, i, row, m] = J[P + m, j] + lost


@compiled
def _compute_residuals(
    camera: CameraTuple,
    kind: int,
    R: Array,
    T: Array,
    uv: Array,
    xyz: Array,
    seen: Array,
    registered: Array,
) -> None:
    """Fill seen and, unless it is empty, registered (K, N, 2); NaN for a view with corners that
    have no image."""
    K, _, N = uv.shape
    fx, fy, cx, cy = camera[:4]
    skew = camera[10]
    work = _make_workspace(N)
    _, _, n, d, M, _, F, point, G = work
    goal, ray = np.empty((2, N)), np.ones((3, N))
    for view in range(K):
        good = _project_view(camera, kind, R[view], T[view], uv[view], xyz[view], work)
        for i in range(N):
            seen[view, i, 0] = uv[view, 0, i] - cx - fx * d[0, i]
            seen[view, i, 1] = uv[view, 1, i] - cy - fy * d[1, i]
            goal[0, i] = (uv[view, 0, i] - cx) / fx
            goal[1, i] = (uv[view, 1, i] - cy) / fy
        if registered.shape[0] == 0:
            if not good:
                seen[view] = np.nan
            continue
        if is_of_rays(kind):
            for row in range(3):
                for i in range(N):
                    ray[row, i] = point[row, i]
            good &= find_rays(kind, camera, goal, ray, d, G, M, F)
        elif kind == BACKWARD:
            distort(goal, camera[4:10], ray, M)
        else:
            for i in range(N):
                goal[0, i] -= skew * goal[1, i]
                ray[0, i], ray[1, i] = n[0, i], n[1, i]
            good &= invert(goal, camera[4:10], ray, M)
        r, t = R[view], T[view]
        t0 = r[0, 0] * t[0] + r[1, 0] * t[1] + r[2, 0] * t[2]
        t1 = r[0, 1] * t[0] + r[1, 1] * t[1] + r[2, 1] * t[2]
        t2 = r[0, 2] * t[0] + r[1, 2] * t[1] + r[2, 2] * t[2]
        for i in range(N):
            x, y, z = ray[0, i], ray[1, i], ray[2, i]
            X, Y, Z = xyz[view, 0, i], xyz[view, 1, i], xyz[view, 2, i]
            distance = (Z + t2) / (r[0, 2] * x + r[1, 2] * y + r[2, 2] * z)
            good &= distance > 0  # the ray leads to the board
            registered[view, i, 0] = distance * (r[0, 0] * x + r[1, 0] * y + r[2, 0] * z) - t0 - X
            registered[view, i, 1] = distance * (r[0, 1] * x + r[1, 1] * y + r[2, 1] * z) - t1 - Y
        if not good:
            seen[view] = np.nan
            registered[view] = np.nan


class BoardCorners(NamedTuple):
    """The work of the kernel on the n corners of the board; none with empty arrays."""

    corner: IntArray = np.empty((0, 0), np.int64)
    """(K, N) number of the board's corner that each observation shows, if corners move."""
    motion: Array = np.empty((0, 0, 0))
    """(n, 3, P) motion of the corners per unit of each free parameter, mm, which the derivatives by
    these parameters are to contain."""
    by_pose: Array = np.empty((0, 0, 0, 0))
    """(K, 3, 6, n) receives the products of the three columns of each corner with the pose's."""
    totals: Array = np.empty((0, 0, 0, 0))
    """(blocks of views, 3, P + 4, n) to which the products of the corners' columns with the
    camera's, with r and with themselves are added."""


NO_CORNERS = BoardCorners()
"""Nothing to be done about the corners."""


def sum_products(
    lens: PackedCamera,
    R: Array,
    T: Array,
    views: Views,
    rows: IntArray,
    corners: BoardCorners = NO_CORNERS,
) -> Array:
    """Return (K, P + 7, P + 7) products of the columns [J_free J_pose r] of each view.

    The squared residual, the last entry, is infinite for views with no prediction.

    Args:
        lens: the camera.
        R: (K, 3, 3) rotations.
        T: (K, 3) translations, mm.
        views: the measured corners.
        rows: (P,) places of the free parameters in ``lens.camera``.
        corners: what to do about the corners of the board. With products by corner all views show
            all corners, in the same order.
    """
    out = np.empty((len(R), len(rows) + 7, len(rows) + 7))
    R, T = make_contiguous(R), make_contiguous(T)
    uv, xyz, weight = views
    whitened = weight.shape[2] > 0

    def run(part: slice) -> None:
        block = part.start // VIEWS_PER_BLOCK
        _sum_views(
            *lens, R[part], T[part], uv[part], xyz[part], weight[part], whitened, rows,
            corners.corner[part], corners.motion, corners.by_pose[part],
            corners.totals[block : block + 1], out[part],
        )  # fmt: skip

    run_in_blocks(len(R), run)
    return out


def prepare_blocks(
    observations: MeasuredViews,
    model: str,
    cost: object,  # noqa: ARG001 - the reference's arguments
    scale: float,  # noqa: ARG001
    free: IntArray,
) -> Callable[[CameraAndPoses], Blocks]:
    """Compute ``calibration.refinement.residuals.prepare_blocks`` for the image cost."""
    views, rows, P = pack_views(observations), find_rows(model, free), len(free)

    def blocks_at(state: CameraAndPoses) -> Blocks:
        A = sum_products(pack_camera(model, state.params), state.R, state.T, views, rows)
        total = A.sum(axis=0)  # in a fixed order, whichever thread made them
        return (
            total[:P, :P],
            A[:, :P, P:-1],
            A[:, P:-1, P:-1],
            total[:P, -1],
            A[:, P:-1, -1],
            A[:, -1, -1],
        )

    return blocks_at


def linearise_image_residuals(
    state: CameraAndPoses, observations: MeasuredViews, model: str
) -> tuple[Array, Array, Array]:
    """Compute ``calibration.refinement.residuals.linearise_image_residuals``.

    Where Newton's method does not reach one corner the whole view is NaN.
    """
    lens, (uv, xyz, weight) = pack_camera(model, state.params), pack_views(observations)
    R, T = make_contiguous(state.R), make_contiguous(state.T)
    rows = find_rows(model, np.arange(len(state.params)))
    residual = np.empty(observations.uv.shape)
    by_params, by_pose = (np.empty((*residual.shape, count)) for count in (len(rows), 6))

    def run(part: slice) -> None:
        _linearise_views(
            *lens, R[part], T[part], uv[part], xyz[part], weight[part], rows,
            residual[part], by_params[part], by_pose[part],
        )  # fmt: skip

    run_in_blocks(len(R), run)
    return residual, by_params, by_pose


def compute_residuals(
    state: CameraAndPoses,
    observations: MeasuredViews,
    model: str,
    cost: object,  # noqa: ARG001 - the reference's arguments
) -> tuple[Array, Array]:
    """Compute ``calibration.refinement.residuals.compute_residuals`` for the image cost.

    Where Newton's method does not reach one corner the whole view is NaN.
    """
    seen, registered = (np.empty(observations.uv.shape) for _ in range(2))
    _fill_residuals(state, observations, model, seen, registered)
    return seen, registered


def compute_misses(
    state: CameraAndPoses,
    observations: MeasuredViews,
    model: str,
    cost: object,  # noqa: ARG001 - the reference's arguments
) -> Array:
    """Compute ``calibration.refinement.residuals.compute_misses`` for the image cost.

    Where Newton's method does not reach one corner the whole view is NaN.
    """
    missed = np.empty(observations.uv.shape)
    _fill_residuals(state, observations, model, missed, missed[:0])
    return missed


def _fill_residuals(
    state: CameraAndPoses, observations: MeasuredViews, model: str, seen: Array, registered: Array
) -> None:
    """Fill in residuals (K, N, 2) in the image and, unless it is empty, on the board."""
    lens, (uv, xyz, _) = pack_camera(model, state.params), pack_views(observations)
    R, T = make_contiguous(state.R), make_contiguous(state.T)

    def run(part: slice) -> None:
        _compute_residuals(
            *lens, R[part], T[part], uv[part], xyz[part], seen[part], registered[part]
        )

    run_in_blocks(len(R), run)

"""Stage II's normal equations of a splined lens with the image cost, compiled.

The readable reference, which this file is tested against, is
``calibration.refinement.local_support``; the lens is ``camera.models.splined_stereographic``.

A corner depends on 16 control points. With B_i their weights in it, both coordinates alike, and
with M = w^T w its weight, the products of the derivatives by the control points i and j are
B_i B_j diag(f) M diag(f): one product and three sums for four entries of U. The sums are kept for
each control point i and its 25 neighbours j that follow it, and spread over U at the end.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.kernels.common import (
    VIEWS_PER_BLOCK,
    compiled,
    make_contiguous,
    run_in_blocks,
)
from calibgui.engine.kernels.normal_equations import (
    Blocks,
    CameraAndPoses,
    MeasuredViews,
    pack_views,
)


class SplinedLens(Protocol):
    """The fields of ``camera.models.splined_stereographic.SplinedStereographic`` that are read."""

    @property
    def Nx(self) -> int: ...  # noqa: N802 - mrcal's symbol
    @property
    def Ny(self) -> int: ...  # noqa: N802 - mrcal's symbol
    @property
    def pitch(self) -> float: ...
    @property
    def limit(self) -> Array: ...


@compiled
def _weigh_neighbours(x: float, values: Array, slopes: Array) -> None:
    """Fill in the weights (4,) of a cubic B-spline at x, from 0 to 1, and their slopes."""
    y = 1 - x
    values[0], values[3] = y * y * y / 6, x * x * x / 6
    values[1] = (3 * x * x * x - 6 * x * x + 4) / 6
    values[2] = (3 * y * y * y - 6 * y * y + 4) / 6
    slopes[0], slopes[3] = -y * y / 2, x * x / 2
    slopes[1] = (3 * x * x - 4 * x) / 2
    slopes[2] = (4 * y - 3 * y * y) / 2


@compiled
def _project_corner(
    p: Array, control: Array, grid: Array, weights: Array, spline: Array, image: Array, J: Array
) -> int:
    """Fill in the image d (2,) of a ray p (3,) and its derivative J (2, 3), and the weights (16,).

    It returns the index of the first control point, -1 for a ray without an image. `control` is
    (Ny, Nx, 2), `grid` holds pitch and both limits of u, and `spline` (4, 4) is overwritten.
    """
    Ny, Nx, _ = control.shape
    X, Y, Z = p[0], p[1], p[2]
    square = X * X + Y * Y
    length = np.sqrt(square + Z * Z)
    m = square / (length - Z) if Z < 0 else length + Z
    px, py = X / m, Y / m
    if not (abs(2 * px) <= grid[1] and abs(2 * py) <= grid[2]):
        return -1
    x, y = 2 * px / grid[0] + 0.5 * (Nx - 1), 2 * py / grid[0] + 0.5 * (Ny - 1)
    ix, iy = min(max(int(x), 1), Nx - 3), min(max(int(y), 1), Ny - 3)
    _weigh_neighbours(x - ix, spline[0], spline[1])
    _weigh_neighbours(y - iy, spline[2], spline[3])
    cx = cy = cxx = cxy = cyx = cyy = 0.0
    for j in range(4):
        for i in range(4):
            w = spline[2, j] * spline[0, i]
            by_x, by_y = spline[2, j] * spline[1, i], spline[3, j] * spline[0, i]
            dx, dy = control[iy - 1 + j, ix - 1 + i, 0], control[iy - 1 + j, ix - 1 + i, 1]
            weights[4 * j + i] = w
            cx += w * dx
            cy += w * dy
            cxx += by_x * dx
            cxy += by_y * dx
            cyx += by_x * dy
            cyy += by_y * dy
    image[0], image[1] = 2 * px + cx, 2 * py + cy
    h = 1 / grid[0]
    a, b, c, d = 1 + h * cxx, h * cxy, h * cyx, 1 + h * cyy
    qx, qy, f = X / length, Y / length, 2 / m
    uxx, uxy, uyx, uyy = f * (1 - px * qx), -f * px * qy, -f * py * qx, f * (1 - py * qy)
    uxz, uyz = -2 * px / length, -2 * py / length
    J[0, 0], J[0, 1], J[0, 2] = a * uxx + b * uyx, a * uxy + b * uyy, a * uxz + b * uyz
    J[1, 0], J[1, 1], J[1, 2] = c * uxx + d * uyx, c * uxy + d * uyy, c * uxz + d * uyz
    return (iy - 1) * Nx + ix - 1


@compiled
def _differentiate_by_pose(rotated: Array, fx: float, fy: float, J: Array, by_pose: Array) -> None:
    """Fill in by_pose (2, 6), derivatives of the pixel by (w, tau), from J (2, 3) by the ray."""
    for row in range(2):
        f = fx if row == 0 else fy
        c0, c1, c2 = f * J[row, 0], f * J[row, 1], f * J[row, 2]
        by_pose[row, 0] = rotated[1] * c2 - rotated[2] * c1
        by_pose[row, 1] = rotated[2] * c0 - rotated[0] * c2
        by_pose[row, 2] = rotated[0] * c1 - rotated[1] * c0
        by_pose[row, 3], by_pose[row, 4], by_pose[row, 5] = c0, c1, c2


@compiled
def _add_neighbours(
    first: int, Nx: int, weights: Array, m00: float, m01: float, m11: float, near: Array
) -> None:
    """Add the products of a corner's weights (16,), times its M, to the sums of control points."""
    for i in range(16):
        point, offset = first + Nx * (i // 4) + i % 4, 3 - i % 4
        for below in range(4 - i // 4):
            begin = 4 * (i // 4 + below)
            for j in range(4):
                product = weights[i] * weights[begin + j]
                near[point, below, 0, offset + j] += m00 * product
                near[point, below, 1, offset + j] += m01 * product
                near[point, below, 2, offset + j] += m11 * product


@compiled
def _sum_views(
    core: Array,
    control: Array,
    grid: Array,
    R: Array,
    T: Array,
    uv: Array,
    xyz: Array,
    weight: Array,
    column: IntArray,
    near: Array,
    shared_rows: Array,
    W: Array,
    V: Array,
    pose: Array,
    costs: Array,
) -> None:
    """Add up the sums of some views; see `prepare_local_blocks`.

    near (Nx Ny, 4, 3, 7) takes B_i B_j M for the control point j that lies 0 to 3 rows below i and
    -3 to 3 columns right of it. shared_rows (5, P) takes the products of fx, fy, cx, cy and of the
    residual with the free parameters. `column` holds the place of each parameter among the free
    ones, -1 for those that are held.
    """
    K, _, N = uv.shape
    Nx = control.shape[1]
    fx, fy, cx, cy = core
    first_row = 0 if (column[:4] >= 0).any() else 4
    p, rotated, image, J = np.empty(3), np.empty(3), np.empty(2), np.empty((2, 3))
    weights, spline = np.empty(16), np.empty((4, 4))
    by_pose, weighed = np.empty((2, 6)), np.empty((2, 6))
    # Derivatives of the pixel by the 4 + 2 * 16 parameters that a corner depends on, and the
    # residual; the places of these parameters.
    D, place = np.zeros((2, 37)), np.empty(36, np.int64)
    D[0, 2] = D[1, 3] = 1.0
    place[:4] = column[:4]
    for view in range(K):
        total = 0.0
        for n in range(N):
            for row in range(3):
                r0, r1, r2 = R[view, row, 0], R[view, row, 1], R[view, row, 2]
                rotated[row] = r0 * xyz[view, 0, n] + r1 * xyz[view, 1, n] + r2 * xyz[view, 2, n]
                p[row] = rotated[row] + T[view, row]
            m00, m01, m11 = 1.0, 0.0, 1.0
            if weight.shape[2]:
                w0, w1, w2, w3 = weight[view, :, n]
                m00, m01, m11 = w0 * w0 + w2 * w2, w0 * w1 + w2 * w3, w1 * w1 + w3 * w3
            first = _project_corner(p, control, grid, weights, spline, image, J)
            if first < 0:
                total = np.inf
                break
            _differentiate_by_pose(rotated, fx, fy, J, by_pose)
            ru, rv = cx + fx * image[0] - uv[view, 0, n], cy + fy * image[1] - uv[view, 1, n]
            eu, ev = m00 * ru + m01 * rv, m01 * ru + m11 * rv
            total += ru * eu + rv * ev
            D[0, 0], D[1, 1], D[0, 36], D[1, 36] = image[0], image[1], ru, rv
            for i in range(16):
                D[0, 4 + 2 * i], D[1, 5 + 2 * i] = fx * weights[i], fy * weights[i]
                point = first + Nx * (i // 4) + i % 4
                place[4 + 2 * i], place[5 + 2 * i] = column[4 + 2 * point], column[5 + 2 * point]
            for a in range(6):
                weighed[0, a] = m00 * by_pose[0, a] + m01 * by_pose[1, a]
                weighed[1, a] = m01 * by_pose[0, a] + m11 * by_pose[1, a]
                pose[view, a] += by_pose[0, a] * eu + by_pose[1, a] * ev
            for a in range(6):
                for b in range(6):
                    V[view, a, b] += by_pose[0, a] * weighed[0, b] + by_pose[1, a] * weighed[1, b]
            for c in range(first_row, 36):
                j = place[c]
                if j >= 0:
                    for a in range(6):
                        W[view, j, a] += D[0, c] * weighed[0, a] + D[1, c] * weighed[1, a]
            for row in range(first_row, 5):
                d0, d1 = (D[0, 36], D[1, 36]) if row == 4 else (D[0, row], D[1, row])
                s0, s1 = m00 * d0 + m01 * d1, m01 * d0 + m11 * d1
                for c in range(first_row, 36):
                    if place[c] >= 0:
                        shared_rows[row, place[c]] += s0 * D[0, c] + s1 * D[1, c]
            _add_neighbours(first, Nx, weights, m00, m01, m11, near)
        costs[view] = total


@compiled
def _spread_neighbours(
    fx: float, fy: float, near: Array, Nx: int, column: IntArray, U: Array
) -> None:
    """Fill the rows and columns of the control points in U (P, P), which is 0 elsewhere."""
    count = near.shape[0]
    for i in range(count):
        iu, iv = column[4 + 2 * i], column[5 + 2 * i]
        for below in range(4):
            for right in range(-3 if below else 0, 4):
                ix = i % Nx + right
                j = i + Nx * below + right
                if j >= count or ix < 0 or ix >= Nx:
                    continue
                ju, jv = column[4 + 2 * j], column[5 + 2 * j]
                a = fx * fx * near[i, below, 0, right + 3]
                b = fx * fy * near[i, below, 1, right + 3]
                c = fy * fy * near[i, below, 2, right + 3]
                if iu >= 0 and ju >= 0:
                    U[iu, ju] = U[ju, iu] = a
                if iu >= 0 and jv >= 0:
                    U[iu, jv] = U[jv, iu] = b
                if iv >= 0 and ju >= 0:
                    U[iv, ju] = U[ju, iv] = b
                if iv >= 0 and jv >= 0:
                    U[iv, jv] = U[jv, iv] = c


def prepare_local_blocks(
    observations: MeasuredViews, lens: SplinedLens, free: IntArray
) -> Callable[[CameraAndPoses], Blocks]:
    """Compute ``calibration.refinement.local_support.prepare_local_blocks``."""
    P, count = len(free), lens.Nx * lens.Ny
    uv, xyz, weight = pack_views(observations)
    column = np.full(4 + 2 * count, -1)
    column[free] = np.arange(P)
    grid = np.array([lens.pitch, *lens.limit])

    def blocks_at(state: CameraAndPoses) -> Blocks:
        core, control = (
            state.params[:4].copy(),
            state.params[4:].reshape(lens.Ny, lens.Nx, 2).copy(),
        )
        R, T = make_contiguous(state.R), make_contiguous(state.T)
        K = len(R)
        W, V, pose, costs = np.zeros((K, P, 6)), np.zeros((K, 6, 6)), np.zeros((K, 6)), np.empty(K)
        blocks = -(-K // VIEWS_PER_BLOCK)
        near, rows = np.zeros((blocks, count, 4, 3, 7)), np.zeros((blocks, 5, P))

        def run(part: slice) -> None:
            block = part.start // VIEWS_PER_BLOCK
            _sum_views(
                core,
                control,
                grid,
                R[part],
                T[part],
                uv[part],
                xyz[part],
                weight[part],
                column,
                near[block],
                rows[block],
                W[part],
                V[part],
                pose[part],
                costs[part],
            )

        run_in_blocks(K, run)
        # Summed over blocks in a fixed order, whichever thread made them.
        *of_core, shared = rows.sum(axis=0)
        U = np.zeros((P, P))
        _spread_neighbours(core[0], core[1], near.sum(axis=0), lens.Nx, column, U)
        for parameter, row in enumerate(of_core):
            if column[parameter] >= 0:
                U[column[parameter]] = U[:, column[parameter]] = row
        return U, W, V, shared, pose, costs

    return blocks_at

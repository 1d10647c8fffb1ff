"""A splined lens: its surface, and Stage II's normal equations with the image cost, compiled.

The readable reference, which this file is tested against, is
``calibration.refinement.local_support``; the lens is ``camera.models.splined_stereographic``.

A corner depends on 16 control points. With B_i their weights in it, both coordinates alike, and
with M = w^T w its weight, the products of the derivatives by the control points i and j are
B_i B_j diag(f) M diag(f): one product and three sums for four entries of U. The sums are kept for
each control point i and its 25 neighbours j that follow it, and spread over U at the end.

The surface and its inverse by Newton's method serve the lens model itself, for many points.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.kernels.common import (
    VIEWS_PER_BLOCK,
    compiled,
    compiled_part,
    make_contiguous,
    run_in_blocks,
)
from calibgui.engine.kernels.normal_equations import Blocks
from calibgui.engine.kernels.views import CameraAndPoses, MeasuredViews, pack_views


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
    @property
    def edge(self) -> Array: ...


@compiled_part
def _weigh_neighbours(x: float, values: Array, slopes: Array) -> None:
    """Fill in the weights (4,) of a cubic B-spline at x, from 0 to 1, and their slopes."""
    y = 1 - x
    values[0], values[3] = y * y * y / 6, x * x * x / 6
    values[1] = (3 * x * x * x - 6 * x * x + 4) / 6
    values[2] = (3 * y * y * y - 6 * y * y + 4) / 6
    slopes[0], slopes[3] = -y * y / 2, x * x / 2
    slopes[1] = (3 * x * x - 4 * x) / 2
    slopes[2] = (4 * y - 3 * y * y) / 2


@compiled_part
def _evaluate_surface(
    ux: float, uy: float, control: Array, grid: Array, spline: Array, weights: Array, surface: Array
) -> int:
    """Fill in the surface at u: c (2,), then dc/du row by row; and the weights (16,).

    It returns the index of the first control point, -1 for u beyond the outermost ones. `control`
    is (Ny, Nx, 2), `grid` holds pitch and both limits of u, and `spline` (4, 4) is overwritten.
    """
    Ny, Nx, _ = control.shape
    if not (abs(ux) <= grid[1] and abs(uy) <= grid[2]):
        return -1
    x, y = ux / grid[0] + 0.5 * (Nx - 1), uy / grid[0] + 0.5 * (Ny - 1)
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
    h = 1 / grid[0]
    surface[0], surface[1] = cx, cy
    surface[2], surface[3], surface[4], surface[5] = h * cxx, h * cxy, h * cyx, h * cyy
    return (iy - 1) * Nx + ix - 1


@compiled_part
def _project_corner(
    p: Array,
    control: Array,
    grid: Array,
    weights: Array,
    spline: Array,
    surface: Array,
    image: Array,
    J: Array,
) -> int:
    """Fill in the image d (2,) of a ray p (3,) and its derivative J (2, 3), and the weights (16,).

    It returns -1 for a ray without an image, otherwise the index of the first control point; see
    `_evaluate_surface`.
    """
    X, Y, Z = p[0], p[1], p[2]
    square = X * X + Y * Y
    length = np.sqrt(square + Z * Z)
    m = square / (length - Z) if Z < 0 else length + Z
    px, py = X / m, Y / m
    first = _evaluate_surface(2 * px, 2 * py, control, grid, spline, weights, surface)
    if first < 0:
        return -1
    image[0], image[1] = 2 * px + surface[0], 2 * py + surface[1]
    a, b, c, d = 1 + surface[2], surface[3], surface[4], 1 + surface[5]
    qx, qy, f = X / length, Y / length, 2 / m
    uxx, uxy, uyx, uyy = f * (1 - px * qx), -f * px * qy, -f * py * qx, f * (1 - py * qy)
    uxz, uyz = -2 * px / length, -2 * py / length
    J[0, 0], J[0, 1], J[0, 2] = a * uxx + b * uyx, a * uxy + b * uyy, a * uxz + b * uyz
    J[1, 0], J[1, 1], J[1, 2] = c * uxx + d * uyx, c * uxy + d * uyy, c * uxz + d * uyz
    return first


@compiled
def _evaluate_surfaces(control: Array, grid: Array, u: Array, surface: Array) -> None:
    """Fill in the surface (n, 6) at u (n, 2), NaN beyond the outermost control points."""
    spline, weights = np.empty((4, 4)), np.empty(16)
    for n in range(len(u)):
        at = surface[n]
        if _evaluate_surface(u[n, 0], u[n, 1], control, grid, spline, weights, at) < 0:
            at[:] = np.nan


@compiled_part
def _measure_miss(
    u: Array, d: Array, control: Array, grid: Array, spline: Array, weights: Array, found: Array
) -> float:
    """Fill in u + c(u) - d (2,), then its derivative by u row by row; return its length or NaN."""
    if _evaluate_surface(u[0], u[1], control, grid, spline, weights, found) < 0:
        return np.nan
    found[0] += u[0] - d[0]
    found[1] += u[1] - d[1]
    found[2] += 1
    found[5] += 1
    length: float = np.hypot(found[0], found[1])
    return length


@compiled
def _iterate_newton(
    control: Array, grid: Array, edge: Array, limits: Array, d: Array, u: Array, found: Array
) -> None:
    """Move u (n, 2) by Newton's method; see `iterate_newton`.

    found (n, 6) takes the misses and their derivatives.
    """
    spline, weights, trial, there = np.empty((4, 4)), np.empty(16), np.empty(2), np.empty(6)
    max_iterations, min_share, max_step, max_miss = limits
    for n in range(len(d)):
        at = found[n]
        miss, share = _measure_miss(u[n], d[n], control, grid, spline, weights, at), 1.0
        if not np.isfinite(miss):
            at[:] = np.nan
            continue
        for _ in range(int(max_iterations)):
            determinant = at[2] * at[5] - at[3] * at[4]
            x = (at[3] * at[1] - at[5] * at[0]) / determinant
            y = (at[4] * at[0] - at[2] * at[1]) / determinant
            trial[0] = min(max(u[n, 0] + share * x, -edge[0]), edge[0])
            trial[1] = min(max(u[n, 1] + share * y, -edge[1]), edge[1])
            left = _measure_miss(trial, d[n], control, grid, spline, weights, there)
            is_better = left < miss
            if is_better:
                u[n], at[:], miss, share = trial, there, left, min(2 * share, 1.0)
            else:
                share /= 4
            size = 1 + np.hypot(u[n, 0], u[n, 1])
            is_moving = np.hypot(x, y) > max_step * size
            is_moving &= is_better or miss > 0.1 * max_miss * size
            if not is_moving or share <= min_share:
                break


def evaluate_surface(lens: SplinedLens, u: Array, k: Array) -> tuple[Array, Array]:
    """Compute ``camera.models.splined_stereographic.evaluate_surface``."""
    control, grid = k.reshape(lens.Ny, lens.Nx, 2).copy(), np.array([lens.pitch, *lens.limit])
    surface = np.empty((*u.shape[:-1], 6))
    _evaluate_surfaces(control, grid, make_contiguous(u.reshape(-1, 2)), surface.reshape(-1, 6))
    return surface[..., :2], surface[..., 2:].reshape(*u.shape, 2)


def iterate_newton(
    lens: SplinedLens, u: Array, d: Array, k: Array, limits: Array
) -> tuple[Array, Array, Array]:
    """Compute ``camera.models.splined_stereographic.iterate_newton``."""
    control, grid = k.reshape(lens.Ny, lens.Nx, 2).copy(), np.array([lens.pitch, *lens.limit])
    u, found = u.copy(), np.empty((len(d), 6))
    _iterate_newton(control, grid, lens.edge.copy(), limits.copy(), make_contiguous(d), u, found)
    return u, found[:, :2], found[:, 2:].reshape(-1, 2, 2)


@compiled_part
def _differentiate_by_pose(rotated: Array, fx: float, fy: float, J: Array, by_pose: Array) -> None:
    """Fill in by_pose (2, 6), derivatives of the pixel by (w, tau), from J (2, 3) by the ray."""
    for row in range(2):
        f = fx if row == 0 else fy
        c0, c1, c2 = f * J[row, 0], f * J[row, 1], f * J[row, 2]
        by_pose[row, 0] = rotated[1] * c2 - rotated[2] * c1
        by_pose[row, 1] = rotated[2] * c0 - rotated[0] * c2
        by_pose[row, 2] = rotated[0] * c1 - rotated[1] * c0
        by_pose[row, 3], by_pose[row, 4], by_pose[row, 5] = c0, c1, c2


@compiled_part
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


@compiled_part
def _add_control_points(
    first: int,
    Nx: int,
    weights: Array,
    column: IntArray,
    by_u: Array,
    by_v: Array,
    W: Array,
    shared: Array,
) -> None:
    """Add a corner's products of control points with pose and residual to W (P, 6), shared (P,).

    by_u and by_v (7,) are the products of M and of f with the pose's six derivatives and the
    residual, for d_x and d_y.
    """
    for i in range(16):
        point, w = first + Nx * (i // 4) + i % 4, weights[i]
        ju, jv = column[4 + 2 * point], column[5 + 2 * point]
        if ju >= 0:
            for a in range(6):
                W[ju, a] += w * by_u[a]
            shared[ju] += w * by_u[6]
        if jv >= 0:
            for a in range(6):
                W[jv, a] += w * by_v[a]
            shared[jv] += w * by_v[6]


@compiled_part
def _add_core(
    first: int,
    Nx: int,
    weights: Array,
    column: IntArray,
    core: Array,
    image: Array,
    m: tuple[float, float, float],
    weighed: Array,
    W: Array,
    shared_rows: Array,
) -> None:
    """Add a corner's products of fx, fy, cx, cy with everything to W (P, 6), shared_rows (5, P)."""
    for row in range(4):
        axis, at = row % 2, column[row]
        if at < 0:
            continue
        d = image[axis] if row < 2 else 1.0
        for a in range(6):
            W[at, a] += d * weighed[axis, a]
        shared_rows[4, at] += d * weighed[axis, 6]
        by_u, by_v = (d * m[0], d * m[1]) if axis == 0 else (d * m[1], d * m[2])
        for other in range(4):
            if column[other] >= 0:
                e = image[other % 2] if other < 2 else 1.0
                shared_rows[row, column[other]] += e * (by_u if other % 2 == 0 else by_v)
        for i in range(16):
            point = first + Nx * (i // 4) + i % 4
            ju, jv = column[4 + 2 * point], column[5 + 2 * point]
            if ju >= 0:
                shared_rows[row, ju] += by_u * core[0] * weights[i]
            if jv >= 0:
                shared_rows[row, jv] += by_v * core[1] * weights[i]


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
    has_core = (column[:4] >= 0).any()
    p, rotated, image, J = np.empty(3), np.empty(3), np.empty(2), np.empty((2, 3))
    weights, spline, surface = np.empty(16), np.empty((4, 4)), np.empty(6)
    # Derivatives by the pose, and the residual; the same times M; the same times f.
    by_pose, weighed, scaled = np.empty((2, 7)), np.empty((2, 7)), np.empty((2, 7))
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
            first = _project_corner(p, control, grid, weights, spline, surface, image, J)
            if first < 0:
                total = np.inf
                break
            _differentiate_by_pose(rotated, fx, fy, J, by_pose)
            by_pose[0, 6] = cx + fx * image[0] - uv[view, 0, n]
            by_pose[1, 6] = cy + fy * image[1] - uv[view, 1, n]
            for a in range(7):
                weighed[0, a] = m00 * by_pose[0, a] + m01 * by_pose[1, a]
                weighed[1, a] = m01 * by_pose[0, a] + m11 * by_pose[1, a]
                scaled[0, a], scaled[1, a] = fx * weighed[0, a], fy * weighed[1, a]
            total += by_pose[0, 6] * weighed[0, 6] + by_pose[1, 6] * weighed[1, 6]
            for a in range(6):
                for b in range(6):
                    V[view, a, b] += by_pose[0, a] * weighed[0, b] + by_pose[1, a] * weighed[1, b]
                pose[view, a] += by_pose[0, a] * weighed[0, 6] + by_pose[1, a] * weighed[1, 6]
            _add_control_points(
                first, Nx, weights, column, scaled[0], scaled[1], W[view], shared_rows[4]
            )
            if has_core:
                m = (m00, m01, m11)
                _add_core(first, Nx, weights, column, core, image, m, weighed, W[view], shared_rows)
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

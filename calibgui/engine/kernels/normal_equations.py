"""Stage II's normal equations with the image cost, compiled.

The same sums as ``arrow.normal_equations`` over ``stage_two.image_residual``, which stay as the
readable reference that this file is tested against.

Both polynomial lens models are eq. 10's (``eq10.py``): the paper's corrects, and is inverted from
the measured corner; the other distorts. With M = d(measured) / d(ideal) the derivatives by the
coefficients are -M basis(measured) for the first and basis(ideal) for the second.
Padded corners carry zero weight.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.kernels.common import compiled, gram, in_blocks, plain
from calibgui.engine.kernels.polynomial_lens import Eq10Camera, distort, invert


@compiled
def _by_params(fc, base, lead, d, F):  # type: ignore[no-untyped-def]
    """Rows of F (10, 2N): derivatives of u (first N) and v by fx, fy, cx, cy and eq. 10's k.

    `base` (2, N) is where the basis is evaluated, `lead` (4, N) what multiplies it.
    """
    fx, fy, p1, p2, p3 = fc
    n = d.shape[1]
    for i in range(n):
        x, y = base[0, i], base[1, i]
        xx, yy, xy = x * x, y * y, x * y
        r2 = xx + yy
        q = 1 + p3 * r2
        c, e = fx * lead[0, i], fx * lead[1, i]
        g, h = fy * lead[2, i], fy * lead[3, i]
        F[0, i], F[1, n + i] = d[0, i], d[1, i]
        b0, b1 = r2 * (c * x + e * y), r2 * (g * x + h * y)
        F[4, i], F[4, n + i] = b0, b1
        F[5, i], F[5, n + i] = r2 * b0, r2 * b1
        F[6, i], F[6, n + i] = r2 * r2 * b0, r2 * r2 * b1
        g0, g1, g2 = q * (r2 + 2 * xx), 2 * q * xy, q * (r2 + 2 * yy)
        F[7, i], F[7, n + i] = c * g0 + e * g1, g * g0 + h * g1
        F[8, i], F[8, n + i] = c * g1 + e * g2, g * g1 + h * g2
        lx = r2 * (p1 * (r2 + 2 * xx) + 2 * p2 * xy)
        ly = r2 * (2 * p1 * xy + p2 * (r2 + 2 * yy))
        F[9, i], F[9, n + i] = c * lx + e * ly, g * lx + h * ly


@compiled
def _by_pose(fx, fy, rotated, n, M, inverse_depth, J):  # type: ignore[no-untyped-def]
    """Rows of J (6, 2N): derivatives by (w, tau), the cross product of R X and d(u, v)/dX_cam."""
    N = n.shape[1]
    for i in range(N):
        a0, a1, a2 = rotated[0, i], rotated[1, i], rotated[2, i]
        for row in range(2):
            f = (fx if row == 0 else fy) * inverse_depth[i]
            c0, c1 = f * M[2 * row, i], f * M[2 * row + 1, i]
            c2 = -(c0 * n[0, i] + c1 * n[1, i])
            j = i + row * N
            J[0, j], J[1, j], J[2, j] = a1 * c2 - a2 * c1, a2 * c0 - a0 * c2, a0 * c1 - a1 * c0
            J[3, j], J[4, j], J[5, j] = c0, c1, c2


@compiled
def _whiten(weight, J):  # type: ignore[no-untyped-def]
    """J (M, 2N) times the corners' whitening (4, N): w00, w01, w10, w11."""
    N = weight.shape[1]
    for m in range(J.shape[0]):
        for i in range(N):
            u, v = J[m, i], J[m, N + i]
            J[m, i] = weight[0, i] * u + weight[1, i] * v
            J[m, N + i] = weight[2, i] * u + weight[3, i] * v


@compiled
def workspace(N):  # type: ignore[no-untyped-def]
    """What `image` and `jacobian` need for a view: R X, 1 / depth, n, d, M, lead and F."""
    rotated, inverse_depth, n, d = np.empty((3, N)), np.empty(N), np.empty((2, N)), np.empty((2, N))
    M, lead, F = np.empty((4, N)), np.zeros((4, N)), np.zeros((10, 2 * N))
    lead[0, :] = 1.0
    lead[3, :] = 1.0
    F[2, :N] = 1.0
    F[3, N:] = 1.0
    return rotated, inverse_depth, n, d, M, lead, F


@compiled
def image(camera, backward, R, T, uv, xyz, work):  # type: ignore[no-untyped-def]
    """Rays n of one view's corners, their images d and M = dd/dn; whether all have one."""
    rotated, inverse_depth, n, d, M, _, _ = work
    fx, fy, cx, cy = camera[:4]
    X, Y, Z = xyz[0], xyz[1], xyz[2]
    N = Z.shape[0]
    for row in range(3):
        r0, r1, r2 = R[row, 0], R[row, 1], R[row, 2]
        for i in range(N):
            rotated[row, i] = r0 * X[i] + r1 * Y[i] + r2 * Z[i]
    behind = False
    for i in range(N):
        depth = rotated[2, i] + T[2]
        behind |= not depth > 0
        inverse_depth[i] = 1 / depth
        n[0, i] = (rotated[0, i] + T[0]) * inverse_depth[i]
        n[1, i] = (rotated[1, i] + T[1]) * inverse_depth[i]
    if backward:
        for i in range(N):
            d[0, i] = (uv[0, i] - cx) / fx
            d[1, i] = (uv[1, i] - cy) / fy
        return invert(n, camera[4:], d, M) and not behind
    distort(n, camera[4:], d, M)
    return not behind


@compiled
def jacobian(camera, backward, uv, weight, whitened, rows, work, J):  # type: ignore[no-untyped-def]
    """Rows of J (P + 7, 2N): whitened [J_free J_pose r] of the view that `image` has seen."""
    rotated, inverse_depth, n, d, M, lead, F = work
    fx, fy, cx, cy, _, _, _, p1, p2, p3 = camera
    P, N = rows.shape[0], uv.shape[1]
    if backward:
        for j in range(4):
            for i in range(N):
                lead[j, i] = -M[j, i]
    _by_params((fx, fy, p1, p2, p3), d if backward else n, lead, d, F)
    for j in range(P):
        row = rows[j]
        for i in range(2 * N):
            J[j, i] = F[row, i]
    _by_pose(fx, fy, rotated, n, M, inverse_depth, J[P : P + 6])
    for i in range(N):
        J[P + 6, i] = cx + fx * d[0, i] - uv[0, i]
        J[P + 6, N + i] = cy + fy * d[1, i] - uv[1, i]
    if whitened:
        _whiten(weight, J)


@compiled
def _products(camera, backward, R, T, uv, xyz, weight, whitened, rows, out):  # type: ignore[no-untyped-def]
    """Fill out (K, P + 7, P + 7) with the products of the rows of each view's J."""
    K, _, N = uv.shape
    work, J = workspace(N), np.empty((rows.shape[0] + 7, 2 * N))
    for view in range(K):
        good = image(camera, backward, R[view], T[view], uv[view], xyz[view], work)
        jacobian(camera, backward, uv[view], weight[view], whitened, rows, work, J)
        gram(J, out[view])
        if not good:
            out[view, -1, -1] = np.inf


@compiled
def _residuals(camera, backward, R, T, uv, xyz, seen, registered):  # type: ignore[no-untyped-def]
    """Fill seen and registered (K, 2, N); NaN for a view with corners that have no image."""
    K, _, N = uv.shape
    fx, fy, cx, cy = camera[:4]
    work = workspace(N)
    _, _, n, d, M, _, _ = work
    goal, ideal = np.empty((2, N)), np.empty((2, N))
    for view in range(K):
        good = image(camera, backward, R[view], T[view], uv[view], xyz[view], work)
        for i in range(N):
            seen[view, 0, i] = uv[view, 0, i] - cx - fx * d[0, i]
            seen[view, 1, i] = uv[view, 1, i] - cy - fy * d[1, i]
            goal[0, i] = (uv[view, 0, i] - cx) / fx
            goal[1, i] = (uv[view, 1, i] - cy) / fy
        if backward:
            distort(goal, camera[4:], ideal, M)
        else:
            for i in range(N):
                ideal[0, i], ideal[1, i] = n[0, i], n[1, i]
            good &= invert(goal, camera[4:], ideal, M)
        r, t = R[view], T[view]
        t0 = r[0, 0] * t[0] + r[1, 0] * t[1] + r[2, 0] * t[2]
        t1 = r[0, 1] * t[0] + r[1, 1] * t[1] + r[2, 1] * t[2]
        t2 = r[0, 2] * t[0] + r[1, 2] * t[1] + r[2, 2] * t[2]
        for i in range(N):
            x, y = ideal[0, i], ideal[1, i]
            X, Y, Z = xyz[view, 0, i], xyz[view, 1, i], xyz[view, 2, i]
            depth = (Z + t2) / (r[0, 2] * x + r[1, 2] * y + r[2, 2])
            registered[view, 0, i] = depth * (r[0, 0] * x + r[1, 0] * y + r[2, 0]) - t0 - X
            registered[view, 1, i] = depth * (r[0, 1] * x + r[1, 1] * y + r[2, 1]) - t1 - Y
        if not good:
            seen[view] = np.nan
            registered[view] = np.nan


class Views(NamedTuple):
    """K views as the kernels take them."""

    uv: Array
    """(K, 2, N) measured corners, px."""
    xyz: Array
    """(K, 3, N) plate points, mm."""
    weight: Array
    """(K, 4, N) whitening of the corners, 0 for padding; (K, 4, 0) if all weigh 1."""


def products(lens: Eq10Camera, R: Array, T: Array, views: Views, rows: IntArray) -> Array:
    """(K, P + 7, P + 7) products of the columns [J_free J_pose r] of each view.

    Args:
        lens: the camera.
        R: (K, 3, 3) rotations.
        T: (K, 3) translations, mm.
        views: what was measured.
        rows: (P,) places of the free parameters in ``lens.camera``.

    Returns:
        The squared residual, the last entry, is infinite for views with no prediction.
    """
    out = np.empty((len(R), len(rows) + 7, len(rows) + 7))
    R, T = plain(R), plain(T)
    uv, xyz, weight = views
    whitened = weight.shape[2] > 0

    def run(part: slice) -> None:
        _products(
            *lens, R[part], T[part], uv[part], xyz[part], weight[part], whitened, rows, out[part]
        )

    in_blocks(len(R), run)
    return out


def residuals(lens: Eq10Camera, R: Array, T: Array, views: Views) -> tuple[Array, Array]:
    """(K, 2, N) measured minus predicted corners, px, and the same on the plate, mm.

    The second are where the measured corners' rays meet the plate, minus where the corners
    are, on the plane through each corner that is parallel to the plate's. Not whitened.
    """
    R, T = plain(R), plain(T)
    uv, xyz, _ = views
    seen, registered = np.empty_like(uv), np.empty_like(uv)

    def run(part: slice) -> None:
        _residuals(*lens, R[part], T[part], uv[part], xyz[part], seen[part], registered[part])

    in_blocks(len(R), run)
    return seen, registered

"""Lens models that are not eq. 10's, compiled: image points with all derivatives.

The readable counterparts are ``camera.models.kannala_brandt`` (with and without decentering),
``rational`` and ``thin_prism``, which is the former with more terms, and ``ucm``, ``eucm`` and
``double_sphere``, which are one formula here: a ray is shifted along the axis by xi times its
length, and then imaged as in the extended unified model,

    zeta = Z + xi |r|,    w = sqrt(beta R^2 + zeta^2),    D = alpha w + (1 - alpha) zeta,
    d = (X, Y) / D,

with beta = 1 for the double sphere, xi = 0 for the other two.

Rows of F are filled in loops of their own: the compiler makes no vector instructions of a loop that
writes to many arrays.
"""

from __future__ import annotations

from math import pi, sqrt

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.kernels.cameras import QUOTIENT, UNIFIED, CameraTuple
from calibgui.engine.kernels.common import compiled_part

_TINY = 1e-200
"""Square of a distance from the axis, mm^2, that counts as 0 and may be divided by."""
_TAN_22_5 = 0.41421356237309503
"""tan(22.5 degrees), the largest x whose arctangent is taken by the polynomial."""
_ARCTANGENT = tuple(
    np.polynomial.Chebyshev.interpolate(
        lambda s: sum((-1) ** (k + 1) * s**k / (2 * k + 3) for k in range(40)),
        10,
        domain=[0.0, _TAN_22_5**2],
    )
    .convert(kind=np.polynomial.Polynomial)
    .coef.tolist()
)
"""Coefficients of (arctan(x) / x - 1) / x^2, interpolated as a polynomial of x^2; the arctangent is
exact to rounding."""


@compiled_part
def compute_angle(R: float, Z: float) -> float:
    """Compute atan2(R, Z) for R > 0 without a branch, which the compiler can vectorise.

    The angle with the nearest of the axes and diagonals is at most 22.5 degrees.
    """
    c0, c1, c2, c3, c4, c5, c6, c7, c8, c9, c10 = _ARCTANGENT
    height = abs(Z)
    small, large = min(R, height), max(R, height)
    is_diagonal = small > _TAN_22_5 * large
    x = (small - large if is_diagonal else small) / (small + large if is_diagonal else large)
    s = x * x
    s2 = s * s
    # Estrin's scheme: short chains of products.
    low = (c0 + c1 * s) + (c2 + c3 * s) * s2
    middle = (c4 + c5 * s) + (c6 + c7 * s) * s2
    high = (c8 + c9 * s) + c10 * s2
    s4 = s2 * s2
    angle = x + x * s * (low + s4 * (middle + s4 * high))
    angle += pi / 4 if is_diagonal else 0.0
    angle = pi / 2 - angle if height < R else angle
    return pi - angle if Z < 0 else angle


@compiled_part
def image_kannala_brandt(
    camera: CameraTuple, P: Array, d: Array, G: Array, base: Array, F: Array
) -> bool:
    """Fill in the images of points by Kannala and Brandt's model with decentering.

    Args:
        camera: fx, fy, cx, cy, k1, k2, k3, k4, p1, p2.
        P: (3, N) points in the camera frame, mm.
        d: (2, N) receives their images.
        G: (6, N) receives the derivatives of d1 and d2 by the point.
        base: (4, N) receives what the derivatives by the coefficients are made of.
        F: (17, 2N) receives in rows 4 to 9 the derivatives of u (first N), v by the coefficients.

    Returns:
        Whether all points have an image.
    """
    fx, fy, _, _, k1, k2, k3, k4, p1, p2 = camera[:10]
    N = P.shape[1]
    missing = 0.0
    for i in range(N):
        X, Y, Z = P[0, i], P[1, i], P[2, i]
        R2 = X * X + Y * Y
        missing += 0.0 if (Z > 0) | (R2 > _TINY) else 1.0
        R = sqrt(R2 + _TINY)
        theta = compute_angle(R, Z)
        inverse = 1 / R
        e0, e1 = X * inverse, Y * inverse
        stretch = theta * inverse
        x, y = stretch * X, stretch * Y
        square = 1 / (R2 + Z * Z)
        bend = Z * square - stretch

        xx, yy, xy = x * x, y * y, x * y
        r2 = xx + yy
        scale = 1 + r2 * (k1 + r2 * (k2 + r2 * (k3 + r2 * k4)))
        slope = 2 * (k1 + r2 * (2 * k2 + r2 * (3 * k3 + r2 * 4 * k4)))
        g0, g1, g2 = r2 + 2 * xx, 2 * xy, r2 + 2 * yy
        d[0, i] = x * scale + p1 * g1 + p2 * g0
        d[1, i] = y * scale + p1 * g2 + p2 * g1
        j00 = scale + xx * slope + 2 * p1 * y + 6 * p2 * x
        j01 = xy * slope + 2 * p1 * x + 2 * p2 * y
        j11 = scale + yy * slope + 6 * p1 * y + 2 * p2 * x

        m0, m1 = j00 * e0 + j01 * e1, j01 * e0 + j11 * e1
        G[0, i], G[1, i] = stretch * j00 + bend * m0 * e0, stretch * j01 + bend * m0 * e1
        G[3, i], G[4, i] = stretch * j01 + bend * m1 * e0, stretch * j11 + bend * m1 * e1
        G[2, i], G[5, i] = -m0 * R * square, -m1 * R * square

        base[0, i], base[1, i], base[2, i] = x, y, r2
    for i in range(N):
        F[4, i], F[4, N + i] = fx * base[0, i] * base[2, i], fy * base[1, i] * base[2, i]
    for row in range(5, 8):
        for i in range(N):
            F[row, i], F[row, N + i] = base[2, i] * F[row - 1, i], base[2, i] * F[row - 1, N + i]
    for i in range(N):
        x, y, r2 = base[0, i], base[1, i], base[2, i]
        F[8, i], F[8, N + i] = 2 * fx * x * y, fy * (r2 + 2 * y * y)
        F[9, i], F[9, N + i] = fx * (r2 + 2 * x * x), 2 * fy * x * y
    return missing == 0


@compiled_part
def image_unified(camera: CameraTuple, P: Array, d: Array, G: Array, base: Array, F: Array) -> bool:
    """Fill in the images of points by the unified models.

    Args:
        camera: fx, fy, cx, cy, xi, alpha, beta.
        P: (3, N) points in the camera frame, mm.
        d: (2, N) receives their images.
        G: (6, N) receives the derivatives of d1 and d2 by the point.
        base: (4, N) receives what the derivatives by the coefficients are made of.
        F: (17, 2N) receives in rows 4 to 6 the derivatives of u (first N), v by the coefficients.

    Returns:
        Whether all points have an image.
    """
    fx, fy, _, _, xi, alpha, beta = camera[:7]
    limit = alpha / (1 - alpha) if alpha <= 0.5 else (1 - alpha) / alpha
    N = P.shape[1]
    missing = 0.0
    for i in range(N):
        X, Y, Z = P[0, i], P[1, i], P[2, i]
        R2 = X * X + Y * Y
        length = sqrt(R2 + Z * Z)
        zeta = Z + xi * length
        w = sqrt(beta * R2 + zeta * zeta)
        D = alpha * w + (1 - alpha) * zeta
        missing += 0.0 if (zeta > -limit * w) & (D > 0) & (length + xi * Z > 0) else 1.0
        inverse = 1 / D
        x, y = X * inverse, Y * inverse
        d[0, i], d[1, i] = x, y
        by_zeta = alpha * zeta / w + 1 - alpha
        sideways = alpha * beta / w + by_zeta * xi / length
        a, b = X * sideways * inverse, Y * sideways * inverse
        c = by_zeta * (1 + xi * Z / length) * inverse
        G[0, i], G[1, i], G[2, i] = inverse - x * a, -x * b, -x * c
        G[3, i], G[4, i], G[5, i] = -y * a, inverse - y * b, -y * c
        base[0, i], base[1, i] = by_zeta * length * inverse, (w - zeta) * inverse
        base[2, i] = alpha * R2 / (2 * w) * inverse
    for row in range(3):
        for i in range(N):
            F[4 + row, i] = -fx * d[0, i] * base[row, i]
            F[4 + row, N + i] = -fy * d[1, i] * base[row, i]
    return (missing == 0) & (beta > 0)


@compiled_part
def image_quotient(
    camera: CameraTuple, P: Array, d: Array, G: Array, base: Array, F: Array
) -> bool:
    """Fill in the images of points by OpenCV's rational model with the terms of a thin prism.

    Args:
        camera: fx, fy, cx, cy, k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4, skew, square of the
            radius at the pole.
        P: (3, N) points in the camera frame, mm.
        d: (2, N) receives their images.
        G: (6, N) receives the derivatives of d1 and d2 by the point.
        base: (4, N) receives what the derivatives by the coefficients are made of.
        F: (17, 2N) receives in rows 4 to 16 the derivatives of u (first N), v by the coefficients.

    Returns:
        Whether all points have an image.
    """
    fx, fy, _, _, k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4, skew, pole = camera
    N = P.shape[1]
    missing = 0.0
    for i in range(N):
        depth = P[2, i]
        inverse = 1 / depth
        x, y = P[0, i] * inverse, P[1, i] * inverse
        xx, yy, xy = x * x, y * y, x * y
        s = xx + yy
        missing += 0.0 if (depth > 0) & (s < pole) else 1.0
        below = 1 / (1 + s * (k4 + s * (k5 + s * k6)))
        g = (1 + s * (k1 + s * (k2 + s * k3))) * below
        slope = k1 + s * (2 * k2 + s * 3 * k3) - g * (k4 + s * (2 * k5 + s * 3 * k6))
        slope *= 2 * below
        across = g * y + p1 * (s + 2 * yy) + 2 * p2 * xy + s * (s3 + s4 * s)
        d[0, i] = g * x + 2 * p1 * xy + p2 * (s + 2 * xx) + s * (s1 + s2 * s) + skew * across
        d[1, i] = across
        prism0, prism1 = 2 * (s1 + 2 * s2 * s), 2 * (s3 + 2 * s4 * s)
        mixed = xy * slope + 2 * p1 * x + 2 * p2 * y
        j10, j11 = mixed + prism1 * x, g + yy * slope + 6 * p1 * y + 2 * p2 * x + prism1 * y
        j00 = g + xx * slope + 2 * p1 * y + 6 * p2 * x + prism0 * x + skew * j10
        j01 = mixed + prism0 * y + skew * j11
        G[0, i], G[1, i], G[2, i] = j00 * inverse, j01 * inverse, -(j00 * x + j01 * y) * inverse
        G[3, i], G[4, i], G[5, i] = j10 * inverse, j11 * inverse, -(j10 * x + j11 * y) * inverse
        base[0, i], base[1, i], base[2, i], base[3, i] = x, y, below, g
    for row in range(2):
        # What dxd and dyd count for in u, then in v.
        c, e = (fx, fx * skew) if row == 0 else (0.0, fy)
        for i in range(N):
            x, y, j = base[0, i], base[1, i], i + row * N
            s = x * x + y * y
            F[4, j] = s * base[2, i] * (c * x + e * y)
            F[5, j], F[8, j] = s * F[4, j], s * s * F[4, j]
            F[12, j], F[13, j], F[14, j], F[15, j] = c * s, c * s * s, e * s, e * s * s
        for i in range(N):
            x, y, g, j = base[0, i], base[1, i], base[3, i], i + row * N
            s = x * x + y * y
            F[6, j] = 2 * c * x * y + e * (s + 2 * y * y)
            F[7, j] = c * (s + 2 * x * x) + 2 * e * x * y
            F[9, j], F[10, j], F[11, j] = -g * F[4, j], -g * F[5, j], -g * F[8, j]
    for i in range(N):
        F[16, i], F[16, N + i] = fx * d[1, i], 0.0
    return missing == 0


@compiled_part
def image_points(
    kind: int, camera: CameraTuple, P: Array, d: Array, G: Array, base: Array, F: Array
) -> bool:
    """Fill in the images of points by a lens of one of the kinds, as the functions above."""
    if kind == UNIFIED:
        return image_unified(camera, P, d, G, base, F)
    if kind == QUOTIENT:
        return image_quotient(camera, P, d, G, base, F)
    return image_kannala_brandt(camera, P, d, G, base, F)


@compiled_part
def find_rays(
    kind: int, camera: CameraTuple, goal: Array, P: Array, d: Array, G: Array, base: Array, F: Array
) -> bool:
    """Turn points P (3, N) into rays of length 1 whose images are goal (2, N), by Newton's method.

    With a1, a2 the rows of G and m = goal - d, the ray b changes by (m1 a2 x b + m2 b x a1) / det,
    det = b . (a1 x a2) (``camera.tangent``). As the inverse of eq. 10 the iteration takes one more
    step after all steps together are below 1e-7, and a ray with det < 0 lies beyond the fold. The
    other arrays are filled as by `image_points`.

    Returns:
        Whether all rays were found.
    """
    last = False
    for _ in range(20):
        for i in range(P.shape[1]):
            inverse = 1 / sqrt(P[0, i] * P[0, i] + P[1, i] * P[1, i] + P[2, i] * P[2, i])
            P[0, i], P[1, i], P[2, i] = P[0, i] * inverse, P[1, i] * inverse, P[2, i] * inverse
        if not image_points(kind, camera, P, d, G, base, F):
            return False
        moved, folds = 0.0, 0.0
        for i in range(P.shape[1]):
            x, y, z = P[0, i], P[1, i], P[2, i]
            p0, p1, p2, q0, q1, q2 = G[0, i], G[1, i], G[2, i], G[3, i], G[4, i], G[5, i]
            c0, c1, c2 = q1 * z - q2 * y, q2 * x - q0 * z, q0 * y - q1 * x
            e0, e1, e2 = y * p2 - z * p1, z * p0 - x * p2, x * p1 - y * p0
            det = p0 * c0 + p1 * c1 + p2 * c2
            folds += 0.0 if det > 0 else 1.0
            m0, m1 = (goal[0, i] - d[0, i]) / det, (goal[1, i] - d[1, i]) / det
            s0, s1, s2 = m0 * c0 + m1 * e0, m0 * c1 + m1 * e1, m0 * c2 + m1 * e2
            P[0, i], P[1, i], P[2, i] = x + s0, y + s1, z + s2
            moved += s0 * s0 + s1 * s1 + s2 * s2
        if last:
            return folds == 0
        last = moved < 1e-14
    return False

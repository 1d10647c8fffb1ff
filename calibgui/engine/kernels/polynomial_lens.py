"""The polynomial of eq. 10 and its inverse, compiled.

The readable counterparts are ``camera.models.lucchese`` and ``camera.inverse``. The coefficients
are ordered as k1, k2, k3, p1, p2, p3. The paper's lens model is this polynomial from measured to
ideal points; Brown and Conrady's are it from ideal to measured ones, with a skew after it
(``camera.skew``), and the pinhole is one of these.
"""

from __future__ import annotations

from calibgui.engine.arrays import Array
from calibgui.engine.kernels.common import compiled_part

Coefficients = tuple[float, float, float, float, float, float]
"""k1, k2, k3, p1, p2, p3 of eq. 10."""


@compiled_part
def eq10(
    x: float,
    y: float,
    k1: float,
    k2: float,
    k3: float,
    p1: float,
    p2: float,
    p3: float,
) -> tuple[float, float, float, float, float, float]:
    """Evaluate psi1, psi2 and their derivatives by x and y, as ``camera.models.lucchese``."""
    xx, yy, xy = x * x, y * y, x * y
    r2 = xx + yy
    rho = r2 * (k1 + r2 * (k2 + r2 * k3))
    slope = k1 + r2 * (2 * k2 + 3 * r2 * k3)
    lx = p1 * (r2 + 2 * xx) + 2 * p2 * xy
    ly = 2 * p1 * xy + p2 * (r2 + 2 * yy)
    q = 1 + p3 * r2
    cross = 2 * xy * slope + 2 * q * (p1 * y + p2 * x)
    return (
        x + x * rho + q * lx,
        y + y * rho + q * ly,
        1 + rho + 2 * xx * slope + 2 * x * p3 * lx + q * (6 * p1 * x + 2 * p2 * y),
        cross + 2 * y * p3 * lx,
        cross + 2 * x * p3 * ly,
        1 + rho + 2 * yy * slope + 2 * y * p3 * ly + q * (2 * p1 * x + 6 * p2 * y),
    )


@compiled_part
def distort(n: Array, k: Coefficients, d: Array, M: Array) -> None:
    """Fill d (2, N) with eq10(n) and M (4, N) with dd/dn, for n (2, N)."""
    k1, k2, k3, p1, p2, p3 = k
    for i in range(n.shape[1]):
        d[0, i], d[1, i], M[0, i], M[1, i], M[2, i], M[3, i] = eq10(
            n[0, i], n[1, i], k1, k2, k3, p1, p2, p3
        )


@compiled_part
def add_skew(skew: float, d: Array, M: Array) -> None:
    """Turn measured points d (2, N) without skew, and M (4, N) = dd/dn, into those with it."""
    if skew != 0:
        for i in range(d.shape[1]):
            d[0, i] += skew * d[1, i]
            M[0, i] += skew * M[2, i]
            M[1, i] += skew * M[3, i]


@compiled_part
def invert(n: Array, k: Coefficients, d: Array, M: Array) -> bool:
    """Solve eq10(d) = n from the given d, fill M with dd/dn; return whether all points converged.

    After a step of Newton's method of at most 1e-7, all points together, the error is its square;
    one more step with the same M takes it below rounding. A point that ends beyond the fold of
    eq. 10, where det < 0, has no inverse. Sums instead of a maximum and a truth value let the
    loop become vector instructions.
    """
    k1, k2, k3, p1, p2, p3 = k
    for _ in range(20):
        moved, folds = 0.0, 0.0
        for i in range(n.shape[1]):
            e0, e1, j00, j01, j10, j11 = eq10(d[0, i], d[1, i], k1, k2, k3, p1, p2, p3)
            det = 1 / (j00 * j11 - j01 * j10)
            folds += 0.0 if det > 0 else 1.0
            m00, m01, m10, m11 = j11 * det, -j01 * det, -j10 * det, j00 * det
            e0 -= n[0, i]
            e1 -= n[1, i]
            s0, s1 = m00 * e0 + m01 * e1, m10 * e0 + m11 * e1
            d[0, i] -= s0
            d[1, i] -= s1
            M[0, i], M[1, i], M[2, i], M[3, i] = m00, m01, m10, m11
            moved += s0 * s0 + s1 * s1
        if moved < 1e-14:
            for i in range(n.shape[1]):
                e0, e1, _, _, _, _ = eq10(d[0, i], d[1, i], k1, k2, k3, p1, p2, p3)
                e0 -= n[0, i]
                e1 -= n[1, i]
                d[0, i] -= M[0, i] * e0 + M[1, i] * e1
                d[1, i] -= M[2, i] * e0 + M[3, i] * e1
            return folds == 0
    return False

"""The factors of small matrices such as the poses' blocks, compiled, and the Schur complement where
each view touches few of the shared parameters.

The readable references are ``calibration.refinement.schur.invert_roots`` and ``subtract_squares``.

A view whose block Wk has n rows that are not 0 changes n^2 entries of the (P, P) matrix. For a
splined lens n is a sixth of P, while a product of dense matrices forms all P^2 for every view. The
rows come in runs of neighbours, along which the innermost loop goes.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.kernels.common import compiled, compiled_part, make_contiguous


@compiled
def _invert_roots(V: Array, roots: Array) -> bool:
    """Fill in roots (K, n, n), 0 so far, from V (K, n, n); return whether all V are positive."""
    K, n, _ = V.shape
    for k in range(K):
        L, inverse = V[k], roots[k]
        for j in range(n):
            for i in range(j, n):
                total = L[i, j]
                for m in range(j):
                    total -= L[i, m] * L[j, m]
                if i > j:
                    L[i, j] = total / L[j, j]
                elif total <= 0:
                    return False
                else:
                    L[j, j] = np.sqrt(total)
        for j in range(n):
            inverse[j, j] = 1 / L[j, j]
            for i in range(j + 1, n):
                total = 0.0
                for m in range(j, i):
                    total -= L[i, m] * inverse[m, j]
                inverse[i, j] = total / L[i, i]
    return True


def invert_roots(V: Array) -> Array:
    """Compute ``calibration.refinement.schur.invert_roots``."""
    roots = np.zeros(V.shape)
    if not _invert_roots(np.array(V, order="C"), roots):
        raise np.linalg.LinAlgError("A matrix is not positive definite")
    return roots


@compiled_part
def _find_touched(W: Array, touched: IntArray) -> int:
    """Fill in the numbers of the rows of W (P, 6) that are not 0; return how many there are."""
    count = 0
    for j in range(len(W)):
        is_touched = False
        for a in range(6):
            is_touched |= W[j, a] != 0
        if is_touched:
            touched[count] = j
            count += 1
    return count


@compiled_part
def _multiply_roots(root: Array, W: Array, touched: IntArray, Y: Array) -> None:
    """Fill in Y (6, m), L^-1 Wk^T for the m rows of W (P, 6) that are touched."""
    for n in range(len(touched)):
        for a in range(6):
            total = 0.0
            for b in range(a + 1):
                total += root[a, b] * W[touched[n], b]
            Y[a, n] = total


@compiled
def _subtract_squares(W: Array, roots: Array, S: Array) -> None:
    """Subtract sum_k Wk Vk^-1 Wk^T from S (P, P), on its diagonal and to the right of it."""
    K, P, _ = W.shape
    whole, places, products = np.empty((6, P)), np.empty(P, np.int64), np.empty(P)
    for k in range(K):
        m = _find_touched(W[k], places)
        _multiply_roots(roots[k], W[k], places[:m], whole)
        for n in range(m):
            y0, y1, y2, y3, y4, y5 = whole[:, n]
            # Slices, and not indices, so that the compiler sees what it can vectorise.
            Y0, Y1, Y2 = whole[0, n:m], whole[1, n:m], whole[2, n:m]
            Y3, Y4, Y5 = whole[3, n:m], whole[4, n:m], whole[5, n:m]
            for j in range(m - n):
                products[j] = (
                    y0 * Y0[j] + y1 * Y1[j] + y2 * Y2[j] + y3 * Y3[j] + y4 * Y4[j] + y5 * Y5[j]
                )
            row = S[places[n]]
            for j in range(m - n):
                row[places[n + j]] -= products[j]


@compiled
def _mirror(S: Array) -> None:
    """Copy what is to the right of the diagonal of S (P, P) below it, tile by tile."""
    P = len(S)
    for top in range(0, P, 32):
        for left in range(0, top + 1, 32):
            for i in range(top, min(top + 32, P)):
                for j in range(left, min(left + 32, i)):
                    S[i, j] = S[j, i]


def subtract_squares(U: Array, W: Array, roots: Array) -> Array:
    """Compute ``calibration.refinement.schur.subtract_squares``."""
    S = np.array(U, order="C")
    _subtract_squares(make_contiguous(W), make_contiguous(roots), S)
    _mirror(S)
    return S

"""The Schur complement where each view touches few of the shared parameters, compiled.

The readable reference is ``calibration.refinement.schur.subtract_squares``.

A view whose block Wk has n rows that are not 0 changes n^2 entries of the (P, P) matrix. For a
splined lens n is a sixth of P, while a product of dense matrices forms all P^2 for every view. The
rows come in runs of neighbours, along which the innermost loop goes.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.kernels.common import compiled, make_contiguous


@compiled
def _subtract_squares(W: Array, roots: Array, S: Array) -> None:
    """Subtract sum_k Wk Vk^-1 Wk^T from S (P, P), from its diagonal on to the right."""
    K, P, _ = W.shape
    Y, begins, ends = np.empty((6, P)), np.empty(P, np.int64), np.empty(P, np.int64)
    for k in range(K):
        runs, end = 0, -1
        for j in range(P):
            is_touched = False
            for a in range(6):
                is_touched |= W[k, j, a] != 0
            if not is_touched:
                continue
            for a in range(6):
                total = 0.0
                for b in range(a + 1):
                    total += roots[k, a, b] * W[k, j, b]
                Y[a, j] = total
            if j != end:
                begins[runs] = j
                runs += 1
            end = j + 1
            ends[runs - 1] = end
        for run in range(runs):
            for i in range(begins[run], ends[run]):
                y0, y1, y2, y3, y4, y5 = Y[0, i], Y[1, i], Y[2, i], Y[3, i], Y[4, i], Y[5, i]
                for other in range(run, runs):
                    begin, end = i if other == run else begins[other], ends[other]
                    # Slices, and not indices, so that the compiler sees what it can vectorise.
                    row, Y0, Y1, Y2 = (
                        S[i, begin:end],
                        Y[0, begin:end],
                        Y[1, begin:end],
                        Y[2, begin:end],
                    )
                    Y3, Y4, Y5 = Y[3, begin:end], Y[4, begin:end], Y[5, begin:end]
                    for j in range(end - begin):
                        row[j] -= (
                            y0 * Y0[j]
                            + y1 * Y1[j]
                            + y2 * Y2[j]
                            + y3 * Y3[j]
                            + y4 * Y4[j]
                            + y5 * Y5[j]
                        )


def subtract_squares(U: Array, W: Array, roots: Array) -> Array:
    """Compute ``calibration.refinement.schur.subtract_squares``."""
    S = np.array(U, order="C")
    _subtract_squares(make_contiguous(W), make_contiguous(roots), S)
    for i in range(len(S)):
        S[i + 1 :, i] = S[i, i + 1 :]
    return S

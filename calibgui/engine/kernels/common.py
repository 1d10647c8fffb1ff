"""What the compiled kernels share.

Their layout makes them fast: the Jacobian of one view is kept transposed, one parameter a row,
so that every loop runs over the corners without a branch and the compiler turns it into vector
instructions, and the products of the rows are formed four at a time while they are in the
processor's first cache. Each view's result is independent of every other's, and callers add
them in a fixed order: nothing depends on the number of threads.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from numba import njit

_MATHS = {"contract", "nsz", "arcp", "reassoc"}
"""Freedoms that the compiler needs to vectorise sums; infinities and NaN stay as they are."""
THREADS = 2
BLOCK = 64
"""Views that one thread takes at a time."""
_WORTH = 4
"""Blocks below which starting threads costs more than they save."""


def compiled(function: Callable[..., Any]) -> Any:
    """The function compiled, and kept for the next start where there is a place to keep it."""
    options: dict[str, Any] = {"fastmath": _MATHS, "error_model": "numpy", "nogil": True}
    try:
        return njit(cache=True, **options)(function)
    except RuntimeError:  # neither the package's folder nor the user's cache can be written
        return njit(**options)(function)


def in_blocks(count: int, run: Callable[[slice], None]) -> None:
    """Call `run` for consecutive slices of `count` views, on all threads."""
    blocks = [slice(begin, min(begin + BLOCK, count)) for begin in range(0, count, BLOCK)]
    if len(blocks) < _WORTH or THREADS == 1:
        for block in blocks:
            run(block)
        return
    with ThreadPoolExecutor(THREADS) as pool:
        list(pool.map(run, blocks))


@compiled
def gram(J, out):  # type: ignore[no-untyped-def]
    """out = J J^T for J (M, n), four products at a time."""
    M, n = J.shape
    for a in range(M):
        ja = J[a]
        b = a
        while b + 3 < M:
            j0, j1, j2, j3 = J[b], J[b + 1], J[b + 2], J[b + 3]
            s0 = s1 = s2 = s3 = 0.0
            for i in range(n):
                v = ja[i]
                s0 += v * j0[i]
                s1 += v * j1[i]
                s2 += v * j2[i]
                s3 += v * j3[i]
            out[a, b] = out[b, a] = s0
            out[a, b + 1] = out[b + 1, a] = s1
            out[a, b + 2] = out[b + 2, a] = s2
            out[a, b + 3] = out[b + 3, a] = s3
            b += 4
        while b < M:
            jb = J[b]
            s0 = 0.0
            for i in range(n):
                s0 += ja[i] * jb[i]
            out[a, b] = out[b, a] = s0
            b += 1

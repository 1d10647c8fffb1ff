"""The parts that the compiled kernels share: compilation, threads, and small linear algebra.

The kernels' layout makes them fast: the Jacobian of one view is kept transposed, one parameter a
row, so that every loop runs over the corners without a branch and the compiler turns it into
vector instructions, and the products of the rows are formed nine at a time while they are in the
processor's first cache. Each view's result is independent of every other's, and callers add
them in a fixed order: nothing depends on the number of threads.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any, ParamSpec, TypeVar

import numpy as np
import numpy.typing as npt
from llvmlite.binding import get_host_cpu_name
from numba import __version__ as numba_version
from numba import config, njit

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.kernels.compilation import KernelCache, KernelCompiler

_P = ParamSpec("_P")
_T = TypeVar("_T")

_Floats = npt.NDArray[np.floating[Any]]
"""Arrays of float32."""
_Ints = npt.NDArray[np.signedinteger[Any]]
"""Arrays of int64."""
_FAST_MATHS = {"contract", "nsz", "arcp", "reassoc"}
"""Freedoms that the compiler needs to vectorise sums; infinities and NaN stay as they are."""
_OPTIONS: dict[str, Any] = {
    "fastmath": _FAST_MATHS,
    "error_model": "numpy",
    "no_cfunc_wrapper": True,  # C never calls them by a pointer
    "pipeline_class": KernelCompiler,
}
THREADS = min(os.cpu_count() or 1, 8)
"""Number of threads that kernels share their views among."""
VIEWS_PER_BLOCK = 64
"""Number of views that one thread takes at a time."""
_MAX_SWEEPS = 30
"""Number of sweeps of rotations that an eigenvector may take; five are usual."""
_NEGLIGIBLE = 1e-36
"""Sum of squares aside the diagonal, over that on it, at which a matrix counts as diagonal."""
_caches: dict[str, list[KernelCache | None]] = {}
"""The folders in which the kernels of each imported module are kept; None for one without."""
_places: set[str] = set()
"""Folders of these."""
_NEXT = np.uintp(1)
_NO = np.float32(0)
_MIN_BLOCKS_FOR_THREADS = 4
"""Number of blocks below which starting threads costs more than they save."""


def compiled(function: Callable[_P, _T]) -> Callable[_P, _T]:
    """Compile a function, and keep the result for the next start if there is a place to keep it."""
    compiled_function: Any = njit(nogil=True, **_OPTIONS)(function)
    usual, config.CACHE_DIR = config.CACHE_DIR, _find_cache_folder()
    cache = None
    try:
        # Neither the package's folder nor the user's cache may be one that can be written.
        with contextlib.suppress(RuntimeError):
            cache = compiled_function._cache = KernelCache(function)
            _places.add(cache.cache_path)
    finally:
        config.CACHE_DIR = usual
    _caches.setdefault(function.__module__, []).append(cache)
    kernel: Callable[_P, _T] = compiled_function
    return kernel


def compiled_part(function: Callable[_P, _T]) -> Callable[_P, _T]:
    """Compile a function that only compiled ones call.

    It lacks the code by which Python calls it, which takes as long to compile as a short function,
    and is kept as a part of those that call it. It does not count references to arrays, each of
    which would take as long as twenty products; so it cannot allocate any, which numba sees to, and
    must not return one.
    """
    part: Callable[_P, _T] = njit(no_cpython_wrapper=True, _nrt=False, **_OPTIONS)(function)
    return part


def compiled_allocating_part(function: Callable[_P, _T]) -> Callable[_P, _T]:
    """Compile a function that only compiled ones call, and that allocates arrays."""
    part: Callable[_P, _T] = njit(no_cpython_wrapper=True, **_OPTIONS)(function)
    return part


@cache
def _find_cache_folder() -> str:
    """Return a folder that serves these sources, this numba and this processor only.

    Numba compiles a kernel anew if its own file has changed, but not if another file has changed
    from which the kernel calls a function.
    """
    here = Path(__file__).parent
    sources = b"".join(file.read_bytes() for file in sorted(here.glob("*.py")))
    machine = f"{numba_version} {sys.implementation.cache_tag} {get_host_cpu_name()}"
    state = hashlib.sha256(sources + machine.encode()).hexdigest()[:16]
    return str(Path(config.CACHE_DIR or here / "__pycache__") / f"calibgui-{state}")


def read_keeping_state() -> int:
    """Return a number that changes when a kernel is kept that was not before."""
    return sum(os.stat(place).st_mtime_ns for place in _places)  # noqa: PTH116 - in a microsecond


def are_kept(module: ModuleType) -> bool:
    """Return whether the kernels of a module are kept on disk, each for some kind of arguments, and
    those of the modules that it has functions from."""
    makers = {module.__name__, *(getattr(each, "__module__", "") for each in vars(module).values())}
    caches = [cache for maker in makers for cache in _caches.get(maker, ())]
    return all(cache is not None and cache.is_filled() for cache in caches)


def run_in_blocks(count: int, run: Callable[[slice], None]) -> None:
    """Call `run` for consecutive slices of `count` views, on all threads."""
    blocks = [
        slice(begin, min(begin + VIEWS_PER_BLOCK, count))
        for begin in range(0, count, VIEWS_PER_BLOCK)
    ]
    if len(blocks) < _MIN_BLOCKS_FOR_THREADS or THREADS == 1:
        for block in blocks:
            run(block)
        return
    with ThreadPoolExecutor(THREADS) as pool:
        list(pool.map(run, blocks))


def make_contiguous(array: Array) -> Array:
    """Return a contiguous writable float64 array, a copy of `array` if need be.

    Numba would compile a kernel anew for each other kind of array.
    """
    if array.flags.carray and array.dtype == np.float64:
        return array
    return np.array(array, dtype=np.float64, order="C")


def make_read_only(image: GreyImage) -> GreyImage:
    """Return a contiguous read-only view of an image, a copy of it if need be.

    Numba would compile a kernel anew for an image that may be written.
    """
    view = np.ascontiguousarray(image).view()
    view.flags.writeable = False
    return view


@compiled_part
def gram(J: Array, out: Array) -> None:
    """Fill out (M, M) with J J^T for J (M, n), three rows by three; the last row fills up."""
    M, n = J.shape
    for a in range(0, M, 3):
        a1, a2 = min(a + 1, M - 1), min(a + 2, M - 1)
        p0, p1, p2 = J[a], J[a1], J[a2]
        for b in range(a, M, 3):
            b1, b2 = min(b + 1, M - 1), min(b + 2, M - 1)
            q0, q1, q2 = J[b], J[b1], J[b2]
            s00 = s01 = s02 = s10 = s11 = s12 = s20 = s21 = s22 = 0.0
            for i in range(n):
                x, y, z, u, v, w = p0[i], p1[i], p2[i], q0[i], q1[i], q2[i]
                s00 += x * u
                s01 += x * v
                s02 += x * w
                s10 += y * u
                s11 += y * v
                s12 += y * w
                s20 += z * u
                s21 += z * v
                s22 += z * w
            out[a, b], out[a, b1], out[a, b2] = s00, s01, s02
            out[a1, b], out[a1, b1], out[a1, b2] = s10, s11, s12
            out[a2, b], out[a2, b1], out[a2, b2] = s20, s21, s22
    for a in range(M):
        for b in range(a):
            out[a, b] = out[b, a]


@compiled_part
def add_products(w: _Floats, stride: int, rows: _Ints, count: int, m: int, out: Array) -> None:
    """Add to out (M, M) the products of the first `count` of `rows`, which ascend, three by three:
    on its diagonal and below, and some above. Rows of w have m numbers and begin `stride` apart."""
    for i in range(0, count, 3):
        a, a1, a2 = rows[i], rows[min(i + 1, count - 1)], rows[min(i + 2, count - 1)]
        p0, p1, p2 = w[a * stride :], w[a1 * stride :], w[a2 * stride :]
        for j in range(0, i + 1, 3):
            b, b1, b2 = rows[j], rows[min(j + 1, count - 1)], rows[min(j + 2, count - 1)]
            q0, q1, q2 = w[b * stride :], w[b1 * stride :], w[b2 * stride :]
            s00 = s01 = s02 = s10 = s11 = s12 = s20 = s21 = s22 = _NO
            for k in range(m):
                x, y, z, t, u, v = p0[k], p1[k], p2[k], q0[k], q1[k], q2[k]
                s00 += x * t
                s01 += x * u
                s02 += x * v
                s10 += y * t
                s11 += y * u
                s12 += y * v
                s20 += z * t
                s21 += z * u
                s22 += z * v
            # Where a row fills up its three its products are there already.
            out[a, b] += s00
            if b1 > b:
                out[a, b1] += s01
            if b2 > b1:
                out[a, b2] += s02
            if a1 > a:
                out[a1, b] += s10
                if b1 > b:
                    out[a1, b1] += s11
                if b2 > b1:
                    out[a1, b2] += s12
            if a2 > a1:
                out[a2, b] += s20
                if b1 > b:
                    out[a2, b1] += s21
                if b2 > b1:
                    out[a2, b2] += s22


@compiled_part
def interpolate(g: GreyImage, i: int, j: int, a: float, b: float) -> float:
    """Interpolate g bilinearly at (i + a, j + b), with a and b from 0 to 1."""
    # Numbers without a sign are not asked whether they count from the end.
    left, above = np.uintp(i), np.uintp(j)
    right, below = left + _NEXT, above + _NEXT
    value: float = (1 - b) * ((1 - a) * g[above, left] + a * g[above, right]) + b * (
        (1 - a) * g[below, left] + a * g[below, right]
    )
    return value


@compiled_part
def bilinear(g: GreyImage, u: float, v: float) -> float:
    """Interpolate g bilinearly at (u, v), the border replicated; NaN where u or v is NaN."""
    height, width = g.shape
    u, v = min(max(u, 0.0), width - 1.0), min(max(v, 0.0), height - 1.0)
    i = min(int(u), width - 2) if u > 0 else 0
    j = min(int(v), height - 2) if v > 0 else 0
    return interpolate(g, i, j, u - i, v - j)


@compiled_part
def factor(N: Array) -> None:
    """Turn N into L below and D on the diagonal, N = L D L^T."""
    for j in range(N.shape[0]):
        for k in range(j):
            N[j, j] -= N[j, k] * N[j, k] * N[k, k]
        for i in range(j + 1, N.shape[0]):
            for k in range(j):
                N[i, j] -= N[i, k] * N[j, k] * N[k, k]
            N[i, j] /= N[j, j]


@compiled_part
def substitute(L: Array, b: Array) -> None:
    """Turn b into the solution of N x = b, given the factors of N."""
    n = b.shape[0]
    for i in range(n):
        for k in range(i):
            b[i] -= L[i, k] * b[k]
    for i in range(n):
        b[i] /= L[i, i]
    for i in range(n - 1, -1, -1):
        for k in range(i):  # along a row, whose entries lie side by side
            b[k] -= L[i, k] * b[i]


@compiled_part
def find_least_eigenvector(N: Array, V: Array) -> int:
    """Fill the columns of V (n, n) with the eigenvectors of the symmetric N (n, n); return the
    number of that for its least eigenvalue.

    Jacobi's rotations (Golub and Van Loan 2013, section 8.5) leave the eigenvalues on the diagonal
    of N.
    """
    n = N.shape[0]
    for p in range(n):
        for q in range(n):
            V[p, q] = 1.0 if p == q else 0.0
    for _ in range(_MAX_SWEEPS):
        aside = total = 0.0
        for p in range(n):
            total += N[p, p] * N[p, p]
            for q in range(p):
                aside += N[p, q] * N[p, q]
        if aside <= _NEGLIGIBLE * total:
            break
        for p in range(n):
            for q in range(p):
                if N[p, q] == 0:
                    continue
                theta = (N[q, q] - N[p, p]) / (2 * N[p, q])
                t = 1 / (abs(theta) + np.sqrt(theta * theta + 1))
                c = 1 / np.sqrt(t * t + 1)
                s = t * c if theta >= 0 else -t * c
                for k in range(n):
                    N[k, p], N[k, q] = c * N[k, p] - s * N[k, q], s * N[k, p] + c * N[k, q]
                for k in range(n):
                    N[p, k], N[q, k] = c * N[p, k] - s * N[q, k], s * N[p, k] + c * N[q, k]
                    V[k, p], V[k, q] = c * V[k, p] - s * V[k, q], s * V[k, p] + c * V[k, q]
    least = 0
    for k in range(1, n):
        if N[k, k] < N[least, least]:
            least = k
    return least

"""The homography and the radial lens of a grid map, compiled: ``lattices.grid_map``."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.kernels.common import (
    compiled,
    compiled_allocating_part,
    compiled_part,
    factor,
    find_least_eigenvector,
    gram,
    make_contiguous,
    substitute,
)

_HOMOGRAPHY_DAMPING = 1e-15 / 3
"""The part of the trace that ``geometry.homography`` adds to the diagonal of equations."""


@compiled_part
def _fill_rows(x: Array, u: Array, A: Array, centre: Array, bend: Array, J: Array) -> None:
    """Fill J (15, 2n): how the places of cells vary with the 14 parameters, and what they miss."""
    n = len(x)
    for i in range(n):
        d0, d1 = u[i, 0] - centre[0], u[i, 1] - centre[1]
        r = d0 * d0 + d1 * d1
        v2 = 1 + r * (bend[0] + r * (bend[1] + r * bend[2]))
        slope = 2 * (bend[0] + r * (2 * bend[1] + r * 3 * bend[2]))
        w = A[2, 0] * d0 + A[2, 1] * d1 + A[2, 2] * v2
        c0 = (A[0, 0] * d0 + A[0, 1] * d1 + A[0, 2] * v2) / w
        c1 = (A[1, 0] * d0 + A[1, 1] * d1 + A[1, 2] * v2) / w
        h0, h1 = (A[0, 2] - c0 * A[2, 2]) / w, (A[1, 2] - c1 * A[2, 2]) / w
        a = (A[0, 0] - c0 * A[2, 0]) / w + slope * h0 * d0
        b = (A[0, 1] - c0 * A[2, 1]) / w + slope * h0 * d1
        c = (A[1, 0] - c1 * A[2, 0]) / w + slope * h1 * d0
        d = (A[1, 1] - c1 * A[2, 1]) / w + slope * h1 * d1
        det = a * d - b * c
        for row, p, q in ((i, d / det, -b / det), (n + i, -c / det, a / det)):
            # (p, q) takes a difference of cells to one of places, along u and along v.
            s = -(p * c0 + q * c1)
            J[0, row], J[1, row], J[2, row] = p * d0 / w, p * d1 / w, p * v2 / w
            J[3, row], J[4, row], J[5, row] = q * d0 / w, q * d1 / w, q * v2 / w
            J[6, row], J[7, row], J[8, row] = s * d0 / w, s * d1 / w, s * v2 / w
            J[9, row], J[10, row] = (-1.0, 0.0) if row < n else (0.0, -1.0)
            h = p * h0 + q * h1
            J[11, row], J[12, row], J[13, row] = h * r, h * r * r, h * r * r * r
            J[14, row] = p * (c0 - x[i, 0]) + q * (c1 - x[i, 1])


@compiled_allocating_part
def _refine_lens(
    x: Array, u: Array, A: Array, centre: Array, bend: Array, steps: int, damping: float
) -> None:
    """Bring A to norm 1, and move A, centre and bend by Gauss-Newton steps."""
    J, sums = np.empty((15, 2 * len(x))), np.empty((15, 15))
    N, g = np.empty((14, 14)), np.empty(14)
    square = 0.0
    for i in range(3):
        for j in range(3):
            square += A[i, j] * A[i, j]
    for i in range(3):
        for j in range(3):
            A[i, j] /= np.sqrt(square)
    for _ in range(steps):
        _fill_rows(x, u, A, centre, bend, J)
        gram(J, sums)
        trace = 0.0
        for k in range(14):
            trace += sums[k, k]
            g[k] = sums[14, k]
            for i in range(14):
                N[k, i] = sums[k, i]
        for k in range(14):
            N[k, k] += damping * trace
        factor(N)
        substitute(N, g)
        for k in range(9):
            A[k // 3, k % 3] -= g[k]
        for k in range(2):
            centre[k] -= g[9 + k]
        for k in range(3):
            bend[k] -= g[11 + k]


@compiled_part
def _stretch(far: float, w: float, bend: Array, steps: int) -> float:
    """Compute |d| / |e| for an ideal point e, `far` px from the centre, of last coordinate w."""
    l1, l2, l3 = bend[0], bend[1], bend[2]
    is_beyond = w < 0 and l1 < 0
    if is_beyond:
        far = -far
    root = 1 + np.sqrt(max(1 - 4 * l1 * far * far, 0.0))
    x = root / (2 * l1 * far) if is_beyond else 2 * far / root
    for _ in range(steps):
        r = x * x
        inverse = 1 + r * (l1 + r * (l2 + r * l3))
        slope = 2 * x * (l1 + r * (2 * l2 + r * 3 * l3))
        x -= (x - far * inverse) / (1 - far * slope)
    scale: float = x / (1.0 if far == 0 else far)
    return scale


@compiled
def _invert_lens(e: Array, w: Array, bend: Array, steps: int, out: Array) -> None:
    """Fill out (n, 2)."""
    for i in range(len(e)):
        far = np.sqrt(e[i, 0] * e[i, 0] + e[i, 1] * e[i, 1])
        scale = _stretch(far, w[i], bend, steps)
        out[i, 0], out[i, 1] = scale * e[i, 0], scale * e[i, 1]


@compiled_part
def _locate(H: Array, centre: Array, bend: Array, cells: Array, steps: int, out: Array) -> None:
    """Fill out (n, 2)."""
    is_bent = bend[0] != 0 or bend[1] != 0 or bend[2] != 0
    for i in range(len(cells)):
        x, y = cells[i, 0], cells[i, 1]
        w = H[2, 0] * x + H[2, 1] * y + H[2, 2]
        e0 = (H[0, 0] * x + H[0, 1] * y + H[0, 2]) / w
        e1 = (H[1, 0] * x + H[1, 1] * y + H[1, 2]) / w
        scale = _stretch(np.sqrt(e0 * e0 + e1 * e1), w, bend, steps) if is_bent else 1.0
        out[i, 0], out[i, 1] = centre[0] + scale * e0, centre[1] + scale * e1


@compiled
def _locate_cells(
    H: Array, centre: Array, bend: Array, cells: Array, steps: int, out: Array
) -> None:
    """Fill out (n, 2)."""
    _locate(H, centre, bend, cells, steps, out)


@compiled
def _differentiate_map(
    H: Array, bend: Array, cells: Array, steps: int, first: Array, second: Array
) -> None:
    """Fill first and second (n, 2, 2)."""
    l1, l2, l3 = bend[0], bend[1], bend[2]
    is_bent = bend[0] != 0 or bend[1] != 0 or bend[2] != 0
    for i in range(len(cells)):
        x, y = cells[i, 0], cells[i, 1]
        w = H[2, 0] * x + H[2, 1] * y + H[2, 2]
        e0 = (H[0, 0] * x + H[0, 1] * y + H[0, 2]) / w
        e1 = (H[1, 0] * x + H[1, 1] * y + H[1, 2]) / w
        scale = _stretch(np.sqrt(e0 * e0 + e1 * e1), w, bend, steps) if is_bent else 1.0
        d0, d1 = scale * e0, scale * e1
        r = d0 * d0 + d1 * d1
        k = 1 / (1 + r * (l1 + r * (l2 + r * l3)))
        bend1, bend2 = l1 + r * (2 * l2 + r * 3 * l3), 2 * l2 + 6 * l3 * r
        by_r, by_r2 = -bend1 * k * k, (2 * bend1 * bend1 * k - bend2) * k * k
        # E', which is symmetric
        a, b, c = k + 2 * by_r * d0 * d0, 2 * by_r * d0 * d1, k + 2 * by_r * d1 * d1
        det = a * c - b * b
        for axis in range(2):
            rise = H[2, axis] / w
            p0, p1 = H[0, axis] / w - e0 * rise, H[1, axis] / w - e1 * rise
            u0, u1 = (c * p0 - b * p1) / det, (a * p1 - b * p0) / det
            # e'' - E''(u', u')
            along = d0 * u0 + d1 * u1
            outward = 4 * by_r2 * along * along + 2 * by_r * (u0 * u0 + u1 * u1)
            q0 = -2 * p0 * rise - outward * d0 - 4 * by_r * along * u0
            q1 = -2 * p1 * rise - outward * d1 - 4 * by_r * along * u1
            first[i, axis, 0], first[i, axis, 1] = u0, u1
            second[i, axis, 0] = (c * q0 - b * q1) / det
            second[i, axis, 1] = (a * q1 - b * q0) / det


@compiled_allocating_part
def _solve_ratios(s: Array, t: Array, damping: float, M: Array) -> None:
    """Fill M (3, k) such that the places t (n, 2) are (M s)[:2] / (M s)[2], by least squares, for
    the rows s (n, k)."""
    n, k = s.shape
    sums, solved, N = np.zeros((4, k, k)), np.empty((2, k, k)), np.empty((k, k))
    for i in range(n):
        x, y = t[i, 0], t[i, 1]
        for a in range(k):
            for b in range(a + 1):
                product = s[i, a] * s[i, b]
                sums[0, a, b] += product
                sums[1, a, b] += x * product
                sums[2, a, b] += y * product
                sums[3, a, b] += (x * x + y * y) * product
    trace = 0.0
    for a in range(k):
        trace += sums[0, a, a]
        for b in range(a):
            for j in range(4):
                sums[j, b, a] = sums[j, a, b]
    for a in range(k):
        sums[0, a, a] += damping * trace
    factor(sums[0])
    for j in range(2):
        for a in range(k):  # columns a of S^-1 Sx and of S^-1 Sy
            for b in range(k):  # in one assignment, numba would compile its message on wrong shapes
                solved[j, a, b] = sums[1 + j, a, b]
            substitute(sums[0], solved[j, a])
    for a in range(k):
        for b in range(k):
            N[a, b] = sums[3, a, b]
            for c in range(k):
                N[a, b] -= sums[1, a, c] * solved[0, b, c] + sums[2, a, c] * solved[1, b, c]
    V = sums[3]
    least = find_least_eigenvector(N, V)
    for a in range(k):
        M[2, a] = V[a, least]
        M[0, a] = M[1, a] = 0.0
    for a in range(k):
        for b in range(k):
            M[0, b] += solved[0, a, b] * M[2, a]
            M[1, b] += solved[1, a, b] * M[2, a]


@compiled_part
def _normalise(points: Array, out: Array, mean: Array) -> float:
    """Fill out (m, 2) with points of zero mean and unit rms, and mean (2,) with their mean; return
    their rms about it. Of points (n, 2) the m are spread over all."""
    n, m = len(points), len(out)
    u0 = u1 = square = 0.0
    for i in range(m):
        j = i * (n - 1) // max(m - 1, 1)
        out[i, 0], out[i, 1] = points[j, 0], points[j, 1]
        u0 += out[i, 0] / m
        u1 += out[i, 1] / m
    for i in range(m):
        out[i, 0] -= u0
        out[i, 1] -= u1
        square += out[i, 0] * out[i, 0] + out[i, 1] * out[i, 1]
    spread: float = np.sqrt(square / (2 * m))
    for i in range(m):
        out[i, 0] /= spread
        out[i, 1] /= spread
    mean[0], mean[1] = u0, u1
    return spread


@compiled_part
def _measure_misfit(places: Array, u: Array) -> float:
    """Return the rms of the differences (n, 2)."""
    square = 0.0
    for i in range(len(u)):
        p, q = places[i, 0] - u[i, 0], places[i, 1] - u[i, 1]
        square += p * p + q * q
    rms: float = np.sqrt(square / (2 * len(u)))
    return rms


@compiled_part
def _invert(A: Array, out: Array) -> None:
    """Fill out (3, 3) with the inverse of the first three columns of A (3, ...)."""
    for i in range(3):
        for j in range(3):
            a, b, c, d = (i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3
            out[j, i] = A[a, c] * A[b, d] - A[a, d] * A[b, c]
    det = A[0, 0] * out[0, 0] + A[0, 1] * out[1, 0] + A[0, 2] * out[2, 0]
    for i in range(3):
        for j in range(3):
            out[i, j] /= det


@compiled_allocating_part
def _solve_homography(x: Array, u: Array, H: Array) -> None:
    """Fill H (3, 3), which takes x (n, 2) to u (n, 2)."""
    s = np.empty((len(x), 3))
    for i in range(len(x)):
        s[i, 0], s[i, 1], s[i, 2] = x[i, 0], x[i, 1], 1.0
    _solve_ratios(s, u, _HOMOGRAPHY_DAMPING, H)


@compiled_allocating_part
def _solve_division_model(x: Array, u: Array, damping: float, A: Array, centre: Array) -> float:
    """Fill A and centre of ``_solve_division_model`` of the reference, and return its l1."""
    n = len(u)
    s, M, inverse = np.empty((n, 4)), np.empty((3, 4)), np.empty((3, 3))
    for i in range(n):
        s[i, 0] = u[i, 0] * u[i, 0] + u[i, 1] * u[i, 1]
        s[i, 1], s[i, 2], s[i, 3] = u[i, 0], u[i, 1], 1.0
    _solve_ratios(s, x, damping, M)
    _invert(M, inverse)
    a = inverse[0, 0] * M[0, 3] + inverse[0, 1] * M[1, 3] + inverse[0, 2] * M[2, 3]
    for k in range(2):
        row = inverse[k + 1]
        centre[k] = -(row[0] * M[0, 3] + row[1] * M[1, 3] + row[2] * M[2, 3])
    l1: float = 1 / (a + centre[0] * centre[0] + centre[1] * centre[1])
    for i in range(3):
        A[i, 0], A[i, 1] = M[i, 1] + 2 * M[i, 0] * centre[0], M[i, 2] + 2 * M[i, 0] * centre[1]
        A[i, 2] = M[i, 0] / l1
    return l1


@compiled_part
def _find_side(A: Array, centre: Array, bend: Array, u: Array) -> float:
    """Return the sign of w at most of the points u (n, 2)."""
    count = 0
    for i in range(len(u)):
        p, q = u[i, 0] - centre[0], u[i, 1] - centre[1]
        r = p * p + q * q
        v2 = 1 + r * (bend[0] + r * (bend[1] + r * bend[2]))
        count += 1 if A[2, 0] * p + A[2, 1] * q + A[2, 2] * v2 > 0 else -1
    return 1.0 if count >= 0 else -1.0


@compiled
def _fit_map(
    cells: Array,
    uv: Array,
    min_points: int,
    min_misfit: float,
    max_ratio: float,
    max_points: int,
    steps: int,
    inversion_steps: int,
    damping: float,
    H: Array,
    centre: Array,
    bend: Array,
) -> None:
    """Fill H (3, 3), centre (2,) and bend (3,)."""
    n = len(cells)
    x, u, places = np.empty((n, 2)), np.empty((n, 2)), np.empty((n, 2))
    mean, origin, lens = np.empty(2), np.empty(2), np.zeros(3)
    scale, unit = _normalise(cells, x, mean), _normalise(uv, u, origin)
    M = np.empty((3, 3))
    _solve_homography(x, u, M)
    _locate(M, centre, lens, x, inversion_steps, places)  # which no lens needs
    misfit = _measure_misfit(places, u)
    is_bent = n >= min_points and misfit >= min_misfit
    misfit *= unit
    if is_bent:
        if n > max_points:
            x, u = np.empty((max_points, 2)), np.empty((max_points, 2))
            scale, unit = _normalise(cells, x, mean), _normalise(uv, u, origin)
        A, middle, inverse = np.empty((3, 3)), np.empty(2), np.empty((3, 3))
        lens[0] = _solve_division_model(x, u, damping, A, middle)
        if steps:
            _refine_lens(x, u, A, middle, lens, steps, damping)
        _invert(A, inverse)
        side = _find_side(A, middle, lens, u)
        for i in range(3):
            for j in range(3):
                inverse[i, j] *= side
        _locate(inverse, middle, lens, x, inversion_steps, places)
        # Not finite is not better.
        is_bent = unit * _measure_misfit(places, u) < max_ratio * misfit
        if is_bent:
            M = inverse
            for k in range(2):
                centre[k] = origin[k] + unit * middle[k]
            for k in range(3):
                bend[k] = lens[k] / unit ** (2 * k + 2)
    for i in range(3):
        rise = unit if i < 2 else 1.0
        shift = 0.0 if is_bent or i == 2 else origin[i]
        # A homography alone counts from the image's origin.
        for j in range(3):
            H[i, j] = rise * M[i, j] + shift * M[2, j]
        H[i, 0], H[i, 1] = H[i, 0] / scale, H[i, 1] / scale
        H[i, 2] -= H[i, 0] * mean[0] + H[i, 1] * mean[1]
    if not is_bent:
        last = H[2, 2]
        for i in range(3):
            for j in range(3):
                H[i, j] /= last


def fit_map(
    cells: Array,
    uv: Array,
    min_points: int,
    min_misfit: float,
    max_ratio: float,
    max_points: int,
    steps: int,
    inversion_steps: int,
    damping: float,
) -> tuple[Array, Array, Array]:
    """Compute ``lattices.grid_map._fit_map``."""
    H, centre, bend = np.empty((3, 3)), np.zeros(2), np.zeros(3)
    _fit_map(
        make_contiguous(cells), make_contiguous(uv), min_points, min_misfit, max_ratio, max_points,
        steps, inversion_steps, damping, H, centre, bend,
    )  # fmt: skip
    return H, centre, bend


def invert_lens(e: Array, w: Array, bend: Array, steps: int) -> Array:
    """Compute ``lattices.grid_map._invert_lens``."""
    out = np.empty((len(e), 2))
    _invert_lens(make_contiguous(e), make_contiguous(w), make_contiguous(bend), steps, out)
    return out


def locate_cells(H: Array, centre: Array, bend: Array, cells: Array, steps: int) -> Array:
    """Compute ``lattices.grid_map._locate_cells``."""
    out = np.empty((len(cells), 2))
    H, centre, bend, cells = map(make_contiguous, (H, centre, bend, cells))
    _locate_cells(H, centre, bend, cells, steps, out)
    return out


def differentiate_map(H: Array, bend: Array, cells: Array, steps: int) -> tuple[Array, Array]:
    """Compute ``lattices.grid_map._differentiate_map``."""
    first, second = np.empty((2, len(cells), 2, 2))
    H, bend, cells = map(make_contiguous, (H, bend, cells))
    _differentiate_map(H, bend, cells, steps, first, second)
    return first, second

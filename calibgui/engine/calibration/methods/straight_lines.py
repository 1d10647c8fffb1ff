"""Rows and columns of a board as lines that a correction of the lens must make straight.

With the measured point (u, v) px, the middle of the image (u0, v0) and half its diagonal h, all is
computed in d = ((u, v) - (u0, v0)) / h, where parameters and points are of order 1. The correction
about the centre c is

    x = d1 - c1,   y = d2 - c2,   r2 = (x / a)^2 + y^2,   g = 1 + k1 r2 + k2 r2^2,   n = g (x, y),

with the aspect a, the width of a pixel against its height as the distortion sees it. Near the
centre it neither stretches nor shrinks, whatever its parameters. Its derivative is

    A = dn/dd = g I + (k1 + 2 k2 r2) (x, y)^T (2 x / a^2, 2 y).

A line of the corrected image, m . n = rho with m = (-sin phi, cos phi), is a curve of the measured
one. The distance of a point from that curve is, to first order (Sampson 1982),

    e = (m . n - rho) / s,      s = |A^T m|.

The division by the stretch s across the line matters. Without it the sum of squares is made smaller
by any correction that shrinks the image, because the corners' noise shrinks with it: with noise of
0.5 px in four views, the mean of 100 estimates of k1 was low by 0.6 of their standard deviation and
that of k2 high by 0.4. With it noise counts alike in all corners and under all corrections, and
both means were within 0.02 of the truth.

The sum of e^2 over all points is minimised over (phi, rho) of every line and the free parameters
q by Gauss-Newton. The distances from a line depend on its own (phi, rho) only, so that these are
projected out: with the derivatives L of one line's e by (phi, rho) and their basis Q,

    dq = least squares of  (I - Q Q^T) J dq = -(I - Q Q^T) e,      J = de/dq,

and (phi, rho) follow by back-substitution. Derivatives are taken by a complex step (Squire and
Trapp, SIAM Review 40 (1998) 110-112), which is exact to rounding. A correction that folds at a
point is refused, and a step that would not lessen the sum is halved.

The covariance of q is that of these equations. A point counts in its row and in its column; that
their two distances share its noise where they are not at right angles is neglected: the covariance
with it differed by 1 % at most in views tilted by 40 to 60 degrees.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.observations import Observation, pack_observations
from calibgui.engine.errors import CalibrationError

IDENTITY = np.array([0.0, 0.0, 0.0, 0.0, 1.0])
"""Parameters q = (c1, c2, k1, k2, a) of the correction that changes nothing."""

_MIN_POINTS = 4
"""Number of points of a row or column from which on it counts as a line."""
_GAP = 0.1
"""Difference of X or Y, in distances of neighbouring points, that separates columns or rows."""
_STEP = 1e-30
"""Length of the complex step, whose square vanishes beside 1."""
_MAX_ITERATIONS, _MAX_HALVINGS = 100, 12
"""Numbers of Gauss-Newton steps, and of halvings of one, at most."""
_MIN_DECREASE, _MIN_DECREASE_PER_POINT = 1e-10, 1e-28
"""Decrease of the sum of squares in a step, relative to it and per point, below which the fit has
converged; the second is the rounding of coordinates of order 1."""
_MIN_SINGULAR_VALUE = 1e-7
"""Least singular value of the derivatives, per root of the number of points, of a determined
correction: parameters and coordinates are of order 1."""


class Lines(NamedTuple):
    """Points of L lines of up to N points each."""

    uv: Array
    """(L, N, 2) points, px; short lines are padded with copies of their first point."""
    mask: Array
    """(L, N) 1 for a point, 0 for padding."""


class LineFit(NamedTuple):
    """A correction of the lens, and the lines that it makes as straight as they can be."""

    q: Array
    """(5,) c1, c2, k1, k2, a."""
    free: IntArray
    """(P,) places in q of the parameters that were estimated."""
    line: Array
    """(L, 2) phi, rho."""
    mask: Array
    """(L, N) 1 for a point, 0 for padding."""
    e: Array
    """(L, N) distances of the points; 0 for padding."""
    J: Array
    """(L N, P) derivatives of `e` by the free parameters, the lines being fitted each time."""
    iterations: int
    """Number of Gauss-Newton steps."""
    converged: bool
    """True if a further step would change nothing."""

    @property
    def noise(self) -> float:
        """Standard deviation of the distances, allowing for the parameters fitted to them."""
        count = self.mask.sum() - self.line.size - len(self.free)
        return float(np.sqrt(self.cost / count))

    @property
    def rms(self) -> float:
        """Root mean square of the distances."""
        return float(np.sqrt(self.cost / self.mask.sum()))

    @property
    def covariance(self) -> Array:
        """(P, P) covariance of the free parameters by the noise of the points."""
        return np.asarray(np.linalg.inv(self.J.T @ self.J) * self.noise**2)

    @property
    def is_determined(self) -> bool:
        """True if the points determine all free parameters."""
        least = np.linalg.svd(self.J, compute_uv=False)[-1]
        return bool(least > _MIN_SINGULAR_VALUE * np.sqrt(self.mask.sum()))

    @property
    def cost(self) -> float:
        """Sum of the squared distances."""
        return float(np.sum(self.e**2))


def collect_lines(views: Sequence[Observation | tuple[Array, Array]]) -> Lines:
    """Collect the rows and columns of at least four points in every view.

    Args:
        views: the views. Boards may be partly seen, and their rows offset like those of an
            asymmetric grid of circles; covariances are not used.

    Raises:
        CalibrationError: if a view cannot be used (``pack_observations``), or none has a line.
    """
    observations = pack_observations(views)
    found: list[Array] = []
    for k in range(len(observations.uv)):
        part = observations.corners_of(k)
        uv, xy = observations.uv[k, part], observations.xy[k, part, :2]
        neighbours = np.asarray(scipy.spatial.cKDTree(xy).query(xy, k=2)[0])[:, 1]
        gap = _GAP * float(np.median(neighbours))
        found += [uv[places] for axis in (1, 0) for places in _split_places(xy[:, axis], gap)]
    if not found:
        raise CalibrationError(
            f"No view shows {_MIN_POINTS} corners in a row.",
            "Show more of the board, or take a board with more corners.",
        )
    counts = np.array([len(points) for points in found])
    is_point = np.arange(counts.max()) < counts[:, None]
    uv = np.repeat(np.array([points[:1] for points in found]), counts.max(), axis=1)
    uv[is_point] = np.concatenate(found)
    return Lines(uv, is_point.astype(np.float64))


def _split_places(coordinate: Array, gap: float) -> list[IntArray]:
    """Return the indices of points of like coordinate (n,), where there are enough of them."""
    order = np.argsort(coordinate, kind="stable")
    ends = np.flatnonzero(np.diff(coordinate[order]) > gap) + 1
    return [places for places in np.split(order, ends) if len(places) >= _MIN_POINTS]


def correct_points(d: Array, q: Array) -> tuple[Array, Array]:
    """Return corrected points n (..., 2) about the centre, and A = dn/dd (..., 2, 2).

    Args:
        d: (..., 2) measured points, in half diagonals from the middle of the image.
        q: (5,) c1, c2, k1, k2, a; they may be complex.
    """
    c, (k1, k2, a) = q[:2], q[2:]
    xy = d - c
    across = xy / np.array([a * a, 1.0])
    r2 = np.sum(xy * across, axis=-1)
    g, slope = 1 + r2 * (k1 + r2 * k2), k1 + 2 * k2 * r2
    A = g[..., None, None] * np.eye(2) + xy[..., None] * (
        2 * slope[..., None, None] * across[..., None, :]
    )
    return g[..., None] * xy, A


def measure_distances(d: Array, q: Array, line: Array) -> Array:
    """Return the distances e (L, N) of points (L, N, 2) from lines (L, 2).

    Arguments may be complex, hence no norm is taken. A point where the correction folds has
    infinite distance.
    """
    n, A = correct_points(d, q)
    m = _make_normals(line)
    Am = np.einsum("lnij,li->lnj", A, m)
    e = (np.einsum("lni,li->ln", n, m) - line[:, 1:]) / np.sqrt(np.sum(Am * Am, axis=-1))
    is_folded = (A[..., 0, 0] * A[..., 1, 1] - A[..., 0, 1] * A[..., 1, 0]).real <= 0
    return np.where(is_folded, np.inf, e)


def _make_normals(line: Array) -> Array:
    """Return m (L, 2) of lines (L, 2)."""
    return np.stack([-np.sin(line[:, 0]), np.cos(line[:, 0])], axis=-1)


def fit_each_line(d: Array, mask: Array, q: Array) -> Array:
    """Return phi, rho (L, 2) of the line nearest to the corrected points of each line.

    With the moments V of the points about their mean, tan 2 phi = 2 Vxy / (Vxx - Vyy) (as
    Devernay and Faugeras 2001).
    """
    n, _ = correct_points(d, q)
    count = mask.sum(axis=1)
    mean = np.sum(mask[..., None] * n, axis=1) / count[:, None]
    x, y = np.moveaxis(mask[..., None] * (n - mean[:, None]), -1, 0)
    Vxx, Vyy, Vxy = np.sum(x * x, axis=1), np.sum(y * y, axis=1), np.sum(x * y, axis=1)
    phi = 0.5 * np.arctan2(2 * Vxy, Vxx - Vyy)
    return np.stack([phi, np.cos(phi) * mean[:, 1] - np.sin(phi) * mean[:, 0]], axis=-1)


def solve_lines(d: Array, mask: Array, start: Array, free: IntArray) -> LineFit:
    """Minimise the squared distances of points from lines over lines and free parameters.

    Args:
        d: (L, N, 2) measured points, in half diagonals from the middle of the image.
        mask: (L, N) 1 for a point, 0 for padding.
        start: (5,) parameters of the correction, which must not fold at any point.
        free: (P,) places in q of the parameters to estimate; none to fit the lines only.
    """
    q, line, iterations = start.copy(), fit_each_line(d, mask, start), 0
    while True:
        e, by_line, by_q = _differentiate(d, mask, q, line, free)
        step = _solve_step(e, by_line, by_q)
        limit = max(_MIN_DECREASE * np.sum(e**2), _MIN_DECREASE_PER_POINT * mask.sum())
        taken = None
        if step.decrease > limit and iterations < _MAX_ITERATIONS:
            taken = _halve_step(d, mask, q, line, step, free)
        if taken is None:
            converged = bool(step.decrease <= limit)
            return LineFit(q, free, line, mask, e, step.J, iterations, converged)
        q, line = taken
        iterations += 1


class _Step(NamedTuple):
    """A Gauss-Newton step."""

    q: Array
    """(P,) change of the free parameters."""
    line: Array
    """(L, 2) change of phi, rho."""
    J: Array
    """(L N, P) derivatives by the free parameters with phi, rho projected out."""
    decrease: float
    """Decrease of the sum of squares that the linear model promises."""


def _solve_step(e: Array, by_line: Array, by_q: Array) -> _Step:
    """Solve the linear model of the distances (L, N), by derivatives (L, N, 2) and (L, N, P)."""
    Q, R = np.linalg.qr(by_line)
    J = (by_q - Q @ (np.swapaxes(Q, 1, 2) @ by_q)).reshape(e.size, by_q.shape[2])
    dq = np.asarray(np.linalg.lstsq(J, -e.ravel(), rcond=None)[0], dtype=np.float64)
    miss = (e + by_q @ dq)[..., None]
    along = np.swapaxes(Q, 1, 2) @ miss
    d_line = np.asarray(-np.linalg.solve(R, along)[..., 0], dtype=np.float64)
    decrease = np.sum(e**2) - np.sum((miss - Q @ along) ** 2)
    return _Step(dq, d_line, J, float(decrease))


def _halve_step(
    d: Array, mask: Array, q: Array, line: Array, step: _Step, free: IntArray
) -> tuple[Array, Array] | None:
    """Return q and lines after the step, or as small a part of it as lessens the sum of squares."""
    before = np.sum((mask * measure_distances(d, q, line)) ** 2)
    for halvings in range(_MAX_HALVINGS):
        part = 0.5**halvings
        moved = q.copy()
        moved[free] += part * step.q
        lines = line + part * step.line
        distances = measure_distances(d, moved, lines)
        if np.isfinite(distances).all() and np.sum((mask * distances) ** 2) < before:
            return moved, lines
    return None


def _differentiate(
    d: Array, mask: Array, q: Array, line: Array, free: IntArray
) -> tuple[Array, Array, Array]:
    """Return e (L, N), and its derivatives by (phi, rho) (L, N, 2) and free parameters (L, N, P).

    All lines are stepped at once, because each moves its own points only.
    """
    by_line = np.empty((*mask.shape, 2))
    for i, step in enumerate(_STEP * 1j * np.eye(2)):
        by_line[..., i] = measure_distances(d, q, line + step).imag
    by_q = np.empty((*mask.shape, len(free)))
    for i, step in enumerate(_STEP * 1j * np.eye(len(q))[free]):
        by_q[..., i] = measure_distances(d, q + step, line).imag
    weight = mask[..., None] / _STEP
    return mask * measure_distances(d, q, line), weight * by_line, weight * by_q

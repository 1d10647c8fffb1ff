"""The deviations of a board from its drawing that a prior is stated for.

A deviation is a polynomial of the place on the board along one of the board's axes. The polynomials
p_j are orthonormal over the board's corners, so that those along the three axes are orthonormal
deviations, and most of them are free of the gauge as they are: motions, turns and scaling of a
board are of the first degree. Out of the plane, all of the first degree are motions and turns; in
the plane, the constants are, and of the first degree one combination is a turn and another is the
scaling, which leaves two, the board's shear and the ratio of its sides.

Sums over the corners are therefore formed with the polynomials first, one matrix product for all
axes, and the gauge is taken out of the sums.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, IntArray

MAX_DEGREE, SMOOTH_DEGREE = 7, 2
"""Degrees of the polynomials in all, and of those of flatness and print."""
FLATNESS, PRINT, ROUGH = 0, 1, 2
"""The kinds of deviation: smooth out of the plane, smooth in the plane, and all others."""
_UPPER = np.triu_indices(3)
_SYMMETRIC = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])
"""Places of a symmetric matrix's entries in its upper triangle."""
_EXPONENTS = np.array([(d - j, j) for d in range(MAX_DEGREE + 1) for j in range(d + 1)])
"""Exponents of x and y in the polynomials, of ascending degree."""
_MIN_DIAGONAL = 1e-6
"""Part of a polynomial that is new beside those before it, below which it is left out."""


class Deviations(NamedTuple):
    """Deviations B (n, 3, Q) of a board's n corners, orthonormal and free of the gauge."""

    polynomials: Array
    """(n, m) values p_j at the corners, of ascending degree."""
    linear: Array
    """(2 l, 2 l - 2) deviations in the plane, in the l polynomials of the first degree along the
    two axes."""
    kind: IntArray
    """(Q,) kind of each deviation: `FLATNESS`, `PRINT` or `ROUGH`."""

    def contract(self, D: Array, out: Array | None = None) -> Array:
        """Return the sums over the corners of D_i^T B_i (..., c, Q), for D (..., n, 3, c).

        They are filled in `out`, if it is given.
        """
        last = D.ndim - 1
        by_corner = D.transpose(*range(last - 2), last - 1, last, last - 2)
        sums = by_corner.reshape(-1, D.shape[-3]) @ self.polynomials
        return self._take_gauge_out(sums.reshape(*by_corner.shape[:-1], -1), out)

    def contract_twice(self, H: Array) -> Array:
        """Return the sum over the corners of B_i^T H_i B_i (Q, Q), for H (n, 3, 3)."""
        p = self.polynomials
        m = p.shape[1]
        weighted = np.ascontiguousarray(H[:, _UPPER[0], _UPPER[1]].T)[..., None] * p
        sums = (p.T @ weighted)[_SYMMETRIC].swapaxes(1, 2)
        half = self._take_gauge_out(sums.reshape(3, m * 3, m)).reshape(m, 3, -1)
        return self._take_gauge_out(half.transpose(1, 2, 0))

    def _take_gauge_out(self, sums: Array, out: Array | None = None) -> Array:
        """Return the (..., c, Q) sums of the deviations from those (..., 3, c, m) of all
        polynomials along all axes, in `out` if it is given."""
        rows = len(self.linear)
        first, others = sums[..., 1 : 1 + rows // 2], sums[..., 1 + rows // 2 :]
        in_plane = np.stack([first[..., 0, :, :], first[..., 1, :, :]], axis=-1)
        shape = in_plane.shape[:-2]
        linear = (in_plane.reshape(-1, rows) @ self.linear).reshape(*shape, -1)
        along = (others[..., axis, :, :] for axis in range(3))
        return np.concatenate([linear, *along], axis=-1, out=out)


def make_deviations(points: Array) -> Deviations:
    """Make the deviations of a board of corners (n, 2), mm."""
    low, high = points.min(axis=0), points.max(axis=0)
    x, y = ((2 * points - low - high) / np.maximum(high - low, np.finfo(float).tiny)).T
    of_x, of_y = (np.vander(values, MAX_DEGREE + 1, increasing=True) for values in (x, y))
    columns, degrees = of_x[:, _EXPONENTS[:, 0]] * of_y[:, _EXPONENTS[:, 1]], _EXPONENTS.sum(axis=1)
    columns /= np.maximum(np.sqrt(np.sum(columns * columns, axis=0)), np.finfo(float).tiny)
    # A column that depends on those before it would take a direction away from those behind.
    while True:
        q, r = np.linalg.qr(columns)
        dependent = np.flatnonzero(np.abs(np.diag(r)) < _MIN_DIAGONAL)
        lost = dependent[:1] if dependent.size else np.arange(q.shape[1], columns.shape[1])
        if not lost.size:
            break
        columns, degrees = np.delete(columns, lost, axis=1), np.delete(degrees, lost)
    first = q[:, degrees == 1]
    centred = first.T @ (points - points.mean(axis=0))  # (l, 2) the places in these polynomials
    turn, scaling = centred[:, ::-1] * [-1, 1], centred
    gauge = np.stack([turn.ravel(), scaling.ravel()], axis=1)
    linear = np.linalg.qr(gauge, mode="complete")[0][:, 2:]
    is_rough = degrees[degrees > 1] > SMOOTH_DEGREE
    kinds = [np.where(is_rough, ROUGH, smooth) for smooth in (PRINT, PRINT, FLATNESS)]
    return Deviations(q, linear, np.concatenate([np.full(linear.shape[1], PRINT), *kinds]))


def split_by_kind(deviations: Deviations) -> tuple[Array, Array]:
    """Return orthonormal bases (3n, m) of the deviations in `FLATNESS` and in `PRINT`."""
    size = 3 * len(deviations.polynomials)
    whole = deviations.contract(np.eye(size).reshape(-1, 3, size))
    return whole[:, deviations.kind == FLATNESS], whole[:, deviations.kind == PRINT]

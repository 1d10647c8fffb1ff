"""A plane lattice in perspective, through a lens that bends it or not.

Perspective takes the cell (col, row) to the ideal point e from the lens's centre c, a homography H.
Where wide-angle lenses bend what is straight by much, polynomials of the cell follow badly; a few
coefficients of a radial lens do most of it, from the point d = u - c in the image by

    e = k d,   k = 1 / (1 + l1 r + l2 r^2 + l3 r^3),   r = |d|^2.

With l1 alone (the division model: Fitzgibbon 2001) (d, 1 / k) is linear in (|u|^2, u, v, 1), and so
is the cell,

    (col, row, 1) ~ M (|u|^2, u, v, 1),

which is solved like a homography's equations. With A = H^-1, of columns a1 to a3, M consists of
m0 = l1 a3, m1 = a1 - 2 cu m0, m2 = a2 - 2 cv m0 and

    m3 = (1 / l1 - |c|^2) m0 - cu m1 - cv m2,

three equations that give c and l1. From there Gauss-Newton steps lead to the least squares of the
distances in the image, all coefficients free.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibgui.engine.estimation import homography
from calibgui.engine.types import Array

_BENT = 0.005
"""Rms distance of corners from their homography beyond which a lens is looked for, over that from
their mean."""
_BETTER = 0.5
"""Part of that distance that a lens must leave at most."""
_ENOUGH = 16
"""Corners from which on a lens may be told."""
_MOST = 400
"""Corners, spread over the lattice, that a lens is fitted to."""
_COEFFICIENTS = 3
_STEPS = 3
"""Of Gauss-Newton."""
_NEWTON = 5
"""Steps in which the point in the image is found from the ideal one."""
_DAMPING = 1e-13
"""What is added to the diagonal of equations, over its sum."""


@dataclass(frozen=True, eq=False, slots=True)
class Perspective:
    """Of a lattice's cells."""

    H: Array
    """(3, 3) ideal points from (col, row), px from the centre."""
    centre: Array
    """(2,) of the lens, px."""
    bend: Array
    """(3,) l1 to l3 of the lens, by powers of px^2; 0 where it bends nothing."""

    def at(self, cells: Array) -> Array:
        """(n, 2) px of the cells (n, 2) = (col, row)."""
        return self.seen(homography.apply(self.H, cells))

    def seen(self, e: Array) -> Array:
        """(n, 2) px of ideal points (n, 2)."""
        return self.centre + (self._bent(e) if self.bend.any() else e)

    def derivatives(self, cells: Array) -> tuple[Array, Array]:
        """First and second derivatives (n, 2, 2) of `at` by column and by row.

        With e = a / w, a and w linear in the cell, e' = (a' - e w') / w and e'' = -2 e' w' / w.
        Through the lens u' = D' e' and u'' = D' e'' + D''(e', e').
        """
        H = self.H
        e = homography.apply(H, cells)
        w = (cells @ H[2, :2] + H[2, 2])[:, None, None]
        e1 = (H[:2, :2].T - e[:, None] * H[2, :2, None]) / w
        e2 = -2 * e1 * H[2, :2, None] / w
        if not self.bend.any():
            return e1, e2
        D1, D2 = self.bending(e)
        second = np.einsum("nijk,naj,nak->nai", D2, e1, e1)
        return np.einsum("nij,naj->nai", D1, e1), np.einsum("nij,naj->nai", D1, e2) + second

    def bending(self, e: Array) -> tuple[Array, Array]:
        """Derivatives D' (n, 2, 2) and D'' (n, 2, 2, 2) of `seen` by the ideal points `e` (n, 2).

        Those of its inverse e = E(d) = k d are, with k' and k'' by r,

            E_i,j = k 1_ij + 2 k' d_i d_j
            E_i,jk = 4 k'' d_i d_j d_k + 2 k' (1_ij d_k + 1_ik d_j + 1_jk d_i),

        1_ij being 1 where i = j and else 0. From E(D(e)) = e follow D' = E'^-1 and
        D'' = -D' E''(D', D').
        """
        d = self._bent(e) if self.bend.any() else e
        k, by_r, by_r2 = _scale(np.sum(d * d, axis=1), self.bend)
        one = np.eye(2)
        first = k[:, None, None] * one + 2 * by_r[:, None, None] * d[:, :, None] * d[:, None]
        mixed = one[:, :, None] * d[:, None, None]
        mixed = mixed + mixed.transpose(0, 1, 3, 2) + mixed.transpose(0, 3, 1, 2)
        cubic = np.einsum("ni,nj,nk->nijk", d, d, d)
        second = 4 * by_r2[:, None, None, None] * cubic + 2 * by_r[:, None, None, None] * mixed
        D1 = np.asarray(np.linalg.inv(first), dtype=np.float64)
        D2 = -np.einsum("nil,nlab,naj,nbk->nijk", D1, second, D1, D1, optimize=True)
        return D1, np.asarray(D2)

    def _bent(self, e: Array) -> Array:
        """Points (n, 2) px from the centre where the lens shows the ideal points (n, 2).

        Newton's steps on |d| = |e| / k lead there from where l1 alone would show them.
        """
        far = np.linalg.norm(e, axis=1)
        l1, l2, l3 = self.bend
        x = 2 * far / (1 + np.sqrt(np.maximum(1 - 4 * l1 * far**2, 0.0)))
        with np.errstate(all="ignore"):  # beyond where the lens reaches
            for _ in range(_NEWTON):
                r = x * x
                inverse = 1 + r * (l1 + r * (l2 + r * l3))
                slope = 2 * x * (l1 + r * (2 * l2 + r * 3 * l3))
                x = x - (x - far * inverse) / (1 - far * slope)
        return np.asarray(e * (x / np.maximum(far, 1e-300))[:, None])


def _scale(r: Array, bend: Array) -> tuple[Array, Array, Array]:
    """k and its first and second derivatives by r, each (n,)."""
    l1, l2, l3 = bend
    inverse = 1 + r * (l1 + r * (l2 + r * l3))
    by_r, by_r2 = l1 + r * (2 * l2 + r * 3 * l3), 2 * l2 + 6 * l3 * r
    k = 1 / inverse
    return k, -by_r * k**2, (2 * by_r**2 * k - by_r2) * k**2


def fitted(cells: Array, uv: Array) -> Perspective:
    """The perspective of cells (n, 2) = (col, row) seen at `uv` (n, 2) px; with a lens only if that
    leaves much less."""
    none = np.zeros(_COEFFICIENTS)
    plain = Perspective(homography.dlt(cells, uv, np.ones(len(uv))), np.zeros(2), none)
    left = _rms(plain.at(cells) - uv)
    if len(uv) < _ENOUGH or left < _BENT * _rms(uv - uv.mean(axis=0)):
        return plain
    some = np.linspace(0, len(uv) - 1, min(len(uv), _MOST)).astype(np.int64)
    (x, mean, scale), (u, origin, unit) = _normalised(cells[some]), _normalised(uv[some])
    bent = _by_division(x, u)
    bent = None if bent is None else _nearest(x, u, bent)
    # Not finite is not better.
    if bent is None or not unit * _rms(bent.at(x) - u) < _BETTER * left:
        return plain
    to_normal = np.diag([1 / scale, 1 / scale, 1.0])
    to_normal[:2, 2] = -mean / scale
    return Perspective(
        np.diag([unit, unit, 1.0]) @ bent.H @ to_normal,
        origin + unit * bent.centre,
        bent.bend / unit ** np.arange(2.0, 2 * _COEFFICIENTS + 1, 2),
    )


def _by_division(x: Array, u: Array) -> Perspective | None:
    """The closed solution with one coefficient, if there is one, points (n, 2) normalised."""
    lifted = np.column_stack([np.sum(u * u, axis=1), u, np.ones(len(u))])
    S, Sx, Sy, Sq = (
        (lifted * factor[:, None]).T @ lifted
        for factor in (np.ones(len(x)), x[:, 0], x[:, 1], np.sum(x * x, axis=1))
    )
    # For a given third row of M the others follow: it is an eigenvector, as in `homography.dlt`.
    inverse = np.linalg.inv(S + _DAMPING * np.trace(S) * np.eye(4))
    third = np.linalg.eigh(Sq - Sx @ inverse @ Sx - Sy @ inverse @ Sy)[1][:, 0]
    M = np.stack([inverse @ Sx @ third, inverse @ Sy @ third, third])
    try:
        a, *minus_centre = np.linalg.solve(M[:, :3], M[:, 3])
        centre = -np.array(minus_centre)
        l1 = 1 / (a + centre @ centre)
        A = np.column_stack([M[:, 1:3] + 2 * np.outer(M[:, 0], centre), M[:, 0] / l1])
        return Perspective(np.linalg.inv(A), centre, np.array([l1, 0.0, 0.0]))
    except np.linalg.LinAlgError:
        return None


def _nearest(x: Array, u: Array, start: Perspective) -> Perspective | None:
    """The perspective nearest to points `u` (n, 2), from one that is near; both normalised; None if
    the steps lead nowhere.

    The cell q / w, (q, w) = A v, v = (d, 1 / k), is compared with its own; its derivative by u
    takes the difference to the image.
    """
    A, centre, bend = np.linalg.inv(start.H), start.centre, start.bend
    A /= np.linalg.norm(A)
    n, k = len(x), np.arange(1, _COEFFICIENTS + 1)
    for _ in range(_STEPS):
        d = u - centre
        r = np.sum(d * d, axis=1)
        powers = r[:, None] ** k
        slope = (r[:, None] ** (k - 1) * k) @ bend
        v = np.column_stack([d, 1 + powers @ bend])
        q = v @ A.T
        w = q[:, 2:]
        cell = q[:, :2] / w
        # The derivatives of the cell q / w are those of q less the cell times those of w, over w.
        rows = (A[:2] - cell[..., None] * A[2]) / w[..., None]
        by_u = rows[..., :2] + 2 * rows[..., 2:] * (slope[:, None] * d)[:, None]
        by_A = np.zeros((n, 2, 3, 3))
        by_A[:, 0, 0] = by_A[:, 1, 1] = v / w
        by_A[:, :, 2] = -cell[..., None] * (v / w)[:, None]
        by_bend = rows[..., 2:] * powers[:, None]
        J = np.concatenate([by_A.reshape(n, 2, 9), -by_u, by_bend], axis=2)
        try:
            J, off = np.linalg.solve(by_u, J), np.linalg.solve(by_u, (cell - x)[..., None])
            flat = J.reshape(2 * n, -1)
            N = flat.T @ flat
            step = np.linalg.solve(
                N + _DAMPING * np.trace(N) * np.eye(len(N)), flat.T @ off.ravel()
            )
        except np.linalg.LinAlgError:
            return None
        A = A - step[:9].reshape(3, 3)
        centre, bend = centre - step[9:11], bend - step[11:]
    return Perspective(np.linalg.inv(A), centre, bend)


def _normalised(points: Array) -> tuple[Array, Array, float]:
    """Points (n, 2) of zero mean and unit spread, and both as they were."""
    mean = points.mean(axis=0)
    spread = _rms(points - mean)
    return (points - mean) / spread, mean, spread


def _rms(offset: Array) -> float:
    return float(np.sqrt(np.mean(offset**2)))

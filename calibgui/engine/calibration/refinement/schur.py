"""Normal equations in the shape of an arrow, solved by way of the Schur complement.

Bundle adjustment has a few parameters that all views share and a pose for every view. Solving
for all of them at once would cost the cube of the number of views. But every residual depends on
the shared parameters and on one view's pose only, so that

              [ U    W1 .. WK ]                U  = sum_k Jc_k^T Jc_k     (P, P)
    J^T J  =  [ W1^T V1       ]                Wk = Jc_k^T Jp_k           (P, 6)
              [ ..       ..   ]                Vk = Jp_k^T Jp_k           (6, 6)
              [ WK^T       VK ]

Eliminating the poses (Triggs et al. 2000, section 6) leaves the Schur complement

    S = U - sum_k Wk Vk^-1 Wk^T,      S dc = -(gc - sum_k Wk Vk^-1 gk),
    dk = -Vk^-1 (gk + Wk^T dc),

a cost linear in the number of views. S is scaled to a unit diagonal of J^T J before it is solved.
The sums come from ``residuals.py``, or from the problem of the board's shape.

A kernel subtracts the squares where there are few parameters, and where a view's corners touch few
of them, those of a splined lens: of a Wk that is mostly 0 it takes what is not. The coefficients of
such a lens that no corner at all touches are coupled by the prior only (``prior.py``), dx of a
control point with its dy: S falls apart into a dense block and blocks of 1 x 1 and 2 x 2
(`find_pairs`), of which only the first is factorised.

The poses are eliminated although there are nearly as many unknowns of poses, 6 K, as coefficients
are touched, P, and U is banded. With m coefficients touched by a view, products and factors take

    3 K m^2 + P^3 / 6

multiplications. If the banded U, with b entries beside its diagonal, was factorised first, they
would be

    P b^2 / 2 + 6 K P b + 18 K^2 P + 36 K^3,

of which most are the products of W with U^-1 W. For 100 views and 30 x 20 control points, b = 127,
that is 3.4e8 against 3.5e8 if all are touched, P = 1200 and m = 400, and less if not all are.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.kernels import with_kernel

_VIEWS_PER_ELIMINATION = 1024
"""Number of views whose poses are eliminated together, which bounds the memory."""
_MAX_FEW_PARAMETERS = 30
"""Number of shared parameters up to which many small products take longer than their numbers."""
_MIN_SPARSE_PARAMETERS = 100
"""Number of shared parameters from which it counts how many of them a view touches."""
_MAX_SPARSE_SQUARE = 0.15
"""Mean square of the part of the parameters that a view touches, up to which it pays to leave out
what is 0: dense products are six times as fast for each number."""
_ROUNDING = 1e-12
"""Damping that makes a pose's singular block regular."""


class NormalEquations(NamedTuple):
    """The blocks of J^T J and J^T r, for the free shared parameters."""

    U: Array
    """(P, P) block of the shared parameters."""
    W: Array
    """(K, P, 6) blocks between the shared parameters and each pose."""
    V: Array
    """(K, 6, 6) block of each pose."""
    shared: Array
    """(P,) gradient gc by the shared parameters."""
    pose: Array
    """(K, 6) gradient gk by each pose."""
    cost: float
    """The sum of squares r^T r."""
    costs: Array
    """(K,) the sum of squares of each view."""
    prior: scipy.sparse.coo_array | None = None
    """(P, P) part of U that is not the corners' but known beforehand (``prior.py``); None for 0."""
    prior_cost: float = 0.0
    """The cost of the prior, whose derivative `shared` includes; `cost` is the corners' alone."""

    @property
    def total_cost(self) -> float:
        """The cost that is minimised."""
        return self.cost + self.prior_cost


class Reduced(NamedTuple):
    """The normal equations of the shared parameters, after the poses are eliminated."""

    S: Array
    """(P, P) Schur complement."""
    W: Array
    """(K, P, 6) blocks between the shared parameters and each pose."""
    roots: Array
    """(K, 6, 6) L^-1 for Vk = L L^T."""
    unit: Array
    """(P,) factors that scale J^T J to a unit diagonal."""

    @property
    def scaled(self) -> Array:
        """(P, P) S in these units."""
        return self.scale_block(None)

    def scale_block(self, chosen: IntArray | None) -> Array:
        """Return S for the `chosen` parameters (n, n), None for all, in these units."""
        S, unit = self.S, self.unit
        if chosen is not None:
            S, unit = S.take(chosen, 0).take(chosen, 1), unit[chosen]
        scaled = S * unit
        scaled *= unit[:, None]
        return scaled

    def reduce_gradient(self, shared: Array, pose: Array) -> Array:
        """Return what is left of the gradient by the shared parameters (P,), `shared` and `pose`
        (K, 6) being those of all unknowns."""
        return np.asarray(shared - (self.W @ _solve_poses(self.roots, pose))[..., 0].sum(axis=0))

    def solve_poses(self, pose: Array, by_shared: Array) -> Array:
        """Return the poses' part (K, 6) of (J^T J)^-1 times a vector, from its poses' part (K, 6)
        and the shared parameters' part (P,) of the product."""
        return np.asarray(_solve_poses(self.roots, pose - by_shared @ self.W)[..., 0])


class FactorisedSystem(NamedTuple):
    """Reduced normal equations with the factors that solve them."""

    reduced: Reduced
    inverse: Callable[[Array], Array]
    """Function that multiplies a (P,) vector by S^-1; if S is singular it returns the shortest
    solution in the scaled units."""

    def solve(self, shared: Array, pose: Array) -> tuple[Array, Array]:
        """Multiply (J^T J)^-1 by a vector of all unknowns, (P,) shared and (K, 6) poses."""
        by_shared = self.inverse(self.reduced.reduce_gradient(shared, pose))
        return by_shared, self.reduced.solve_poses(pose, by_shared)


class Pairs(NamedTuple):
    """The parameters that S couples with one neighbour at most, and their part of S^-1."""

    coupled: IntArray | None
    """Indices of all other parameters, ascending; None if there are no pairs."""
    alone: IntArray
    """(n,) indices of the parameters in pairs."""
    partner: IntArray
    """(n,) index of the parameter that each is coupled with; its own if there is none."""
    diagonal: Array
    """(n,) entries of S^-1 on the diagonal."""
    beside: Array
    """(n,) entries of S^-1 between each of them and its partner, 0 if there is none."""

    def multiply(self, right: Array, product: Array) -> None:
        """Fill in their part of S^-1 times `right` (P,) in `product` (P,)."""
        product[self.alone] = self.diagonal * right[self.alone] + self.beside * right[self.partner]

    def fill_in(self, inverse: Array) -> None:
        """Fill in their entries of S^-1 in `inverse` (P, P), 0 so far."""
        inverse[self.alone, self.partner] = self.beside
        inverse[self.alone, self.alone] = self.diagonal


def sum_costs(costs: Array) -> tuple[float, Array]:
    """Return the sum of the views' costs (K,), and these; infinite where they have no value."""
    costs = np.where(np.isfinite(costs), costs, np.inf)
    return float(costs.sum()), costs


def eliminate_poses(normal: NormalEquations, damping: float = 0.0) -> Reduced:
    """Eliminate the poses, with J^T J damped by lambda diag(J^T J) (Marquardt 1963).

    With Vk = L L^T, Wk Vk^-1 Wk^T is the square of L^-1 Wk^T.
    """
    V, diagonal = normal.V, normal.U.diagonal()
    if damping:
        V = V * (1 + damping * np.eye(6))
    roots = invert_pose_roots(V)
    S = subtract_squares(normal.U, normal.W, roots)
    S.flat[:: len(S) + 1] += damping * diagonal
    unit = 1 / np.sqrt(np.maximum(diagonal, 1e-300))
    return Reduced(S, normal.W, roots, unit)


def invert_pose_roots(V: Array) -> Array:
    """Compute L^-1 (K, 6, 6) for the poses' blocks V = L L^T (K, 6, 6), also where one is open."""
    try:
        return invert_roots(V)
    except np.linalg.LinAlgError:  # a view leaves its pose open, such as far out of a poor camera
        V = V * (1 + _ROUNDING * np.eye(6)) + np.finfo(float).tiny * np.eye(6)
        return invert_roots(V)


@with_kernel("schur", "invert_roots")
def invert_roots(V: Array) -> Array:
    """Compute L^-1 (K, n, n) for V = L L^T (K, n, n).

    For small matrices that takes a tenth of the time of ``np.linalg.inv``.

    Raises:
        LinAlgError: if a V is not positive definite.
    """
    return np.asarray(np.linalg.inv(np.linalg.cholesky(V)))


def _touches_few_parameters(U: Array, W: Array, _roots: Array) -> bool:
    """Return whether the blocks W have so few rows, or so many of 0, that a kernel is faster."""
    if len(U) < _MIN_SPARSE_PARAMETERS:
        return len(U) <= _MAX_FEW_PARAMETERS
    touched = np.count_nonzero(W[..., -1], axis=1) / len(U)
    return bool(np.mean(touched**2) < _MAX_SPARSE_SQUARE)


@with_kernel("schur", "subtract_squares", _touches_few_parameters)
def subtract_squares(U: Array, W: Array, roots: Array) -> Array:
    """Compute the Schur complement U - sum_k Wk Vk^-1 Wk^T (P, P).

    Args:
        U: (P, P) block of the shared parameters.
        W: (K, P, 6) blocks between these and each pose.
        roots: (K, 6, 6) L^-1 for Vk = L L^T.
    """
    S = None
    for begin in range(0, len(W), _VIEWS_PER_ELIMINATION):
        views = slice(begin, begin + _VIEWS_PER_ELIMINATION)
        Y = roots[views] @ np.swapaxes(W[views], 1, 2)
        Y = Y.reshape(6 * len(Y), len(U))
        # In place where it can be: with hundreds of parameters new memory costs more than sums.
        S = np.subtract(U if S is None else S, square := Y.T @ Y, out=square)
    assert S is not None
    return S


def find_pairs(S: Array) -> Pairs:
    """Find the parameters that S (P, P) couples with one neighbour at most, if P is large."""
    nowhere, nothing = np.zeros(0, dtype=np.intp), np.zeros(0)
    if len(S) < _MIN_SPARSE_PARAMETERS:
        return Pairs(None, nowhere, nowhere, nothing, nothing)
    a, between = np.diag(S), np.concatenate([[0.0], np.diag(S, 1), [0.0]])
    before, after = between[:-1], between[1:]
    partner = np.arange(len(S)) - (before != 0) + (after != 0)
    b = before + after
    c = np.where(b != 0, a[partner], 1.0)
    determinant = a * c - b * b
    count, own = np.count_nonzero(S, axis=1), 1 + (b != 0)
    is_alone = (count == own) & (count[partner] == own) & (a > 0) & (determinant > 0)
    alone, coupled = np.flatnonzero(is_alone), np.flatnonzero(~is_alone)
    return Pairs(
        coupled if alone.size else None,
        alone,
        partner[alone],
        c[alone] / determinant[alone],
        -b[alone] / determinant[alone],
    )


def factorise(reduced: Reduced) -> FactorisedSystem:
    """Factorise S by Cholesky's method, or take its pseudo-inverse if it is singular."""
    if not len(reduced.unit):
        return FactorisedSystem(reduced, lambda right: right)
    pairs, unit = find_pairs(reduced.S), reduced.unit
    chosen = slice(None) if pairs.coupled is None else pairs.coupled
    # S is symmetric: its transpose is in the order that LAPACK works in, without a copy.
    factor, failed = scipy.linalg.lapack.dpotrf(
        reduced.scale_block(pairs.coupled).T, overwrite_a=True
    )
    if not failed:

        def multiply(right: Array) -> Array:
            product = np.empty_like(right)
            pairs.multiply(right, product)
            scaled = (unit * right)[chosen]
            product[chosen] = unit[chosen] * scipy.linalg.lapack.dpotrs(factor, scaled)[0]
            return product

        return FactorisedSystem(reduced, multiply)
    inverse = np.linalg.pinv(reduced.scaled, rcond=1e-15, hermitian=True)
    return FactorisedSystem(reduced, lambda right: unit * (inverse @ (unit * right)))


def solve_reduced(normal: NormalEquations, reduced: Reduced) -> tuple[Array, Array]:
    """Return the step to the minimum of the linear model: (P,) shared and (K, 6) poses."""
    by_shared, by_pose = factorise(reduced).solve(normal.shared, normal.pose)
    return -by_shared, -by_pose


def solve_normal_equations(normal: NormalEquations, damping: float) -> tuple[Array, Array]:
    """Return the damped step: (P,) shared and (K, 6) poses."""
    return solve_reduced(normal, eliminate_poses(normal, damping))


def _solve_poses(roots: Array, right: Array) -> Array:
    """Return (K, 6, 1) Vk^-1 times `right` (K, 6)."""
    return np.asarray(np.swapaxes(roots, 1, 2) @ (roots @ right[..., None]))

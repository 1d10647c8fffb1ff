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

A view whose corners touch few of the parameters, those of a splined lens, has a Wk that is mostly
0, and then a kernel subtracts what is not 0.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array
from calibgui.engine.kernels import with_kernel

_VIEWS_PER_ELIMINATION = 1024
"""Number of views whose poses are eliminated together, which bounds the memory."""
_MIN_SPARSE_PARAMETERS = 100
"""Number of shared parameters from which it counts how many of them a view touches."""
_MAX_SPARSE_SQUARE = 0.1
"""Mean square of the part of the parameters that a view touches, up to which it pays to leave out
what is 0: dense products are ten times as fast for each number."""
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
    prior: Array | None = None
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
    gradient: Array
    """(P,) gc - sum_k Wk Vk^-1 gk."""
    roots: Array
    """(K, 6, 6) L^-1 for Vk = L L^T."""
    unit: Array
    """(P,) factors that scale J^T J to a unit diagonal."""

    @property
    def scaled(self) -> Array:
        """(P, P) S in these units."""
        scaled = self.S * self.unit
        scaled *= self.unit[:, None]
        return scaled

    def add_stiffness(self, stiffness: Array) -> Reduced:
        """Return these equations with (P, P) `stiffness` added to U."""
        unit = 1 / np.sqrt(self.unit**-2 + np.diag(stiffness))
        return self._replace(S=self.S + stiffness, unit=unit)


class FactorisedSystem(NamedTuple):
    """Reduced normal equations with the factors that solve them."""

    reduced: Reduced
    inverse: Callable[[Array], Array]
    """Function that multiplies a (P,) vector by S^-1, both scaled; if S is singular it returns the
    shortest solution."""

    def with_gradient_of(self, normal: NormalEquations) -> FactorisedSystem:
        """Return the same J^T J with the gradient of other normal equations close by."""
        gradient = _reduce_gradient(normal, self.reduced.roots)
        return self._replace(reduced=self.reduced._replace(gradient=gradient))

    def solve_step(self, normal: NormalEquations) -> tuple[Array, Array]:
        """Return the step to the minimum of the linear model: (P,) shared and (K, 6) poses."""
        _, gradient, roots, unit = self.reduced
        shared = -unit * self.inverse(unit * gradient)
        right = normal.pose + np.tensordot(normal.W, shared, axes=([1], [0]))
        return shared, -_solve_poses(roots, right)[..., 0]


def sum_costs(costs: Array) -> tuple[float, Array]:
    """Return the sum of the views' costs (K,), and these; infinite where they have no value."""
    costs = np.where(np.isfinite(costs), costs, np.inf)
    return float(costs.sum()), costs


def eliminate_poses(normal: NormalEquations, damping: float = 0.0) -> Reduced:
    """Eliminate the poses, with J^T J damped by lambda diag(J^T J) (Marquardt 1963).

    With Vk = L L^T, Wk Vk^-1 Wk^T is the square of L^-1 Wk^T.
    """
    V = normal.V * (1 + damping * np.eye(6))
    try:
        roots = np.asarray(np.linalg.inv(np.linalg.cholesky(V)))
    except np.linalg.LinAlgError:  # a view leaves its pose open, such as far out of a poor camera
        V = V * (1 + _ROUNDING * np.eye(6)) + np.finfo(float).tiny * np.eye(6)
        roots = np.asarray(np.linalg.inv(np.linalg.cholesky(V)))
    diagonal, S = np.diag(normal.U), subtract_squares(normal.U, normal.W, roots)
    S[np.diag_indices_from(S)] += damping * diagonal
    unit = 1 / np.sqrt(np.maximum(diagonal, 1e-300))
    return Reduced(S, _reduce_gradient(normal, roots), roots, unit)


def _touches_few_parameters(U: Array, W: Array, _roots: Array) -> bool:
    """Return whether the blocks W have so many rows of 0 that their kernel is faster."""
    if len(U) < _MIN_SPARSE_PARAMETERS:
        return False
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


def factorise(reduced: Reduced) -> FactorisedSystem:
    """Factorise S by Cholesky's method, or take its pseudo-inverse if it is singular."""
    if not len(reduced.unit):
        return FactorisedSystem(reduced, lambda right: right)
    # S is symmetric: its transpose is in the order that LAPACK works in, without a copy.
    factor, failed = scipy.linalg.lapack.dpotrf(reduced.scaled.T, overwrite_a=True)
    if not failed:
        return FactorisedSystem(reduced, lambda right: scipy.linalg.lapack.dpotrs(factor, right)[0])
    inverse = np.linalg.pinv(reduced.scaled, rcond=1e-15, hermitian=True)
    return FactorisedSystem(reduced, lambda right: inverse @ right)


def solve_reduced(normal: NormalEquations, reduced: Reduced) -> tuple[Array, Array]:
    """Return the step to the minimum of the linear model: (P,) shared and (K, 6) poses."""
    return factorise(reduced).solve_step(normal)


def solve_normal_equations(normal: NormalEquations, damping: float) -> tuple[Array, Array]:
    """Return the damped step: (P,) shared and (K, 6) poses."""
    return solve_reduced(normal, eliminate_poses(normal, damping))


def _reduce_gradient(normal: NormalEquations, roots: Array) -> Array:
    """Return (P,) gc - sum_k Wk Vk^-1 gk."""
    by_pose = normal.W @ _solve_poses(roots, normal.pose)
    return np.asarray(normal.shared - by_pose[..., 0].sum(axis=0))


def _solve_poses(roots: Array, right: Array) -> Array:
    """Return (K, 6, 1) Vk^-1 times `right` (K, 6)."""
    return np.asarray(np.swapaxes(roots, 1, 2) @ (roots @ right[..., None]))

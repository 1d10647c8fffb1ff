"""Arrow-shaped normal equations: shared parameters, and a pose for every view.

Every residual depends on the shared parameters and on one view's pose only, so that

              [ U    W1 .. WK ]                U  = sum_k Jc_k^T Jc_k     (P, P)
    J^T J  =  [ W1^T V1       ]                Wk = Jc_k^T Jp_k           (P, 6)
              [ ..       ..   ]                Vk = Jp_k^T Jp_k           (6, 6)
              [ WK^T       VK ]

Eliminating the poses leaves the Schur complement

    S = U - sum_k Wk Vk^-1 Wk^T,      S dc = -(gc - sum_k Wk Vk^-1 gk),
    dk = -Vk^-1 (gk + Wk^T dc),

a cost linear in the number of views. S is scaled to a unit diagonal of J^T J before it is solved.

Where the sums come from is the caller's choice: `normal_equations` adds them up from residuals
and derivatives, in chunks of views so that memory does not grow with their number; ``kernels``
does the same compiled.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.observations import chunks
from calibgui.engine.calibration.refinement.residuals import Linearised, State

_ELIMINATED = 1024
"""Views whose poses are eliminated together, which bounds the memory that takes."""

Linearise = Callable[[State, slice], Linearised]
"""Whitened residuals of a slice of the views, zero (with zero derivatives) for padding."""
NormalAt = Callable[[State], "NormalEquations"]
"""The normal equations of the free parameters; infinite cost where a corner has no prediction."""


class NormalEquations(NamedTuple):
    """The blocks of J^T J and J^T r, for the free shared parameters."""

    U: Array
    W: Array
    V: Array
    shared: Array
    """(P,) gradient."""
    pose: Array
    """(K, 6) gradient."""
    cost: float
    """r^T r."""
    costs: Array
    """(K,) of each view."""


class Reduced(NamedTuple):
    """What is left of the normal equations without the poses."""

    S: Array
    """(P, P) Schur complement."""
    gradient: Array
    """(P,) gc - sum_k Wk Vk^-1 gk."""
    roots: Array
    """(K, 6, 6) L^-1 for Vk = L L^T."""
    unit: Array
    """(P,) what scales J^T J to a unit diagonal."""

    @property
    def scaled(self) -> Array:
        """(P, P) S in these units."""
        scaled = self.S * self.unit
        scaled *= self.unit[:, None]
        return scaled

    def stiffened(self, added: Array) -> Reduced:
        """With (P, P) added to the shared parameters' block of J^T J."""
        unit = 1 / np.sqrt(self.unit**-2 + np.diag(added))
        return self._replace(S=self.S + added, unit=unit)


class Factored(NamedTuple):
    """What solves reduced normal equations."""

    reduced: Reduced
    inverse: Callable[[Array], Array]
    """From (P,) to S^-1 times it, both scaled; the shortest solution if S is singular."""

    def at(self, normal: NormalEquations) -> Factored:
        """The same J^T J with the gradient of normal equations close by."""
        gradient = _gradient(normal, self.reduced.roots)
        return self._replace(reduced=self.reduced._replace(gradient=gradient))

    def step(self, normal: NormalEquations) -> tuple[Array, Array]:
        """The step to the minimum of the linear model: (P,) shared and (K, 6) poses."""
        _, gradient, roots, unit = self.reduced
        shared = -unit * self.inverse(unit * gradient)
        right = normal.pose + np.tensordot(normal.W, shared, axes=([1], [0]))
        return shared, -_by_own_block(roots, right)[..., 0]


def normal_equations(linearise: Linearise, state: State, free: IntArray) -> NormalEquations:
    """Accumulate J^T J and J^T r over the views, chunk by chunk."""
    K, P = len(state.R), len(free)
    U, W, V = np.zeros((P, P)), np.empty((K, P, 6)), np.empty((K, 6, 6))
    shared, pose, costs = np.zeros(P), np.empty((K, 6)), np.empty(K)
    for views in chunks(K):
        with np.errstate(all="ignore"):  # a wild trial overflows; its cost says so
            r, by_params, by_pose = linearise(state, views)
            k = len(r)
            r = r.reshape(k, -1, 1)
            Jc = by_params.reshape(k, -1, by_params.shape[-1])[..., free]
            Jp = by_pose.reshape(k, -1, 6)
            costs[views] = np.sum(r * r, axis=(1, 2))
            JcT, JpT = np.swapaxes(Jc, 1, 2), np.swapaxes(Jp, 1, 2)
            U += (JcT @ Jc).sum(axis=0)
            W[views], V[views] = JcT @ Jp, JpT @ Jp
            shared += (JcT @ r)[..., 0].sum(axis=0)
            pose[views] = (JpT @ r)[..., 0]
    return NormalEquations(U, W, V, shared, pose, *summed(costs))


def summed(costs: Array) -> tuple[float, Array]:
    """The sum of the views' costs, and these; infinite where they have no value."""
    costs = np.where(np.isfinite(costs), costs, np.inf)
    return float(costs.sum()), costs


def schur(normal: NormalEquations, damping: float = 0.0) -> Reduced:
    """Eliminate the poses. With Vk = L L^T, Wk Vk^-1 Wk^T is the square of L^-1 Wk^T."""
    V = normal.V * (1 + damping * np.eye(6))
    roots = np.asarray(np.linalg.inv(np.linalg.cholesky(V)))
    diagonal, S = np.diag(normal.U), None
    for begin in range(0, len(V), _ELIMINATED):
        views = slice(begin, begin + _ELIMINATED)
        Y = roots[views] @ np.swapaxes(normal.W[views], 1, 2)
        Y = Y.reshape(6 * len(Y), len(diagonal))
        # In place where it can be: with hundreds of parameters new memory costs more than sums.
        S = np.subtract(normal.U if S is None else S, square := Y.T @ Y, out=square)
    assert S is not None
    S[np.diag_indices_from(S)] += damping * diagonal
    unit = 1 / np.sqrt(np.maximum(diagonal, 1e-300))
    return Reduced(S, _gradient(normal, roots), roots, unit)


def step(normal: NormalEquations, reduced: Reduced) -> tuple[Array, Array]:
    """The step to the minimum of the linear model: (P,) shared and (K, 6) poses."""
    return factored(reduced).step(normal)


def factored(reduced: Reduced) -> Factored:
    """Ready to be solved."""
    if not len(reduced.unit):
        return Factored(reduced, lambda right: right)
    # S is symmetric: its transpose is in the order that LAPACK works in, without a copy.
    factor, failed = scipy.linalg.lapack.dpotrf(reduced.scaled.T, overwrite_a=True)
    if not failed:
        return Factored(reduced, lambda right: scipy.linalg.lapack.dpotrs(factor, right)[0])
    inverse = np.linalg.pinv(reduced.scaled, rcond=1e-15, hermitian=True)
    return Factored(reduced, lambda right: inverse @ right)


def _gradient(normal: NormalEquations, roots: Array) -> Array:
    """(P,) gc - sum_k Wk Vk^-1 gk."""
    by_pose = normal.W @ _by_own_block(roots, normal.pose)
    return np.asarray(normal.shared - by_pose[..., 0].sum(axis=0))


def _by_own_block(roots: Array, right: Array) -> Array:
    """(K, 6, 1) Vk^-1 times (K, 6)."""
    return np.asarray(np.swapaxes(roots, 1, 2) @ (roots @ right[..., None]))


def solve(normal: NormalEquations, damping: float) -> tuple[Array, Array]:
    """The damped step: (P,) shared and (K, 6) poses."""
    return step(normal, schur(normal, damping))

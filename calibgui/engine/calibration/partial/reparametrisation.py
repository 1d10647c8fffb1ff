"""Reparametrisation of a camera by quantities that views leave open one by one.

Seen from straight above, a board tells fy/fx, the lens's centre and its curvature in pixels,
whatever fx may be: what is open is fx with fy and all coefficients in step. In

    q = (f, a, cx, cy, kappa),      fx = f,  fy = a f,  k_j = kappa_j f^power_j,

it is f alone, the rest being as in the paper's units. (Where fy alone is held, f is fy and a is
fx/fy.) With C = d(parameters)/dq the normal equations in q are C^T U C, C^T W and C^T g.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.methods.method import Problem
from calibgui.engine.calibration.refinement.residuals import NormalAt, State
from calibgui.engine.calibration.refinement.schur import NormalEquations
from calibgui.engine.camera.models import find_model


class Quantities(NamedTuple):
    """The quantities q of a camera, in the order of its parameters."""

    base: int
    """Index of f: 0 for fx, 1 for fy."""
    powers: Array
    """(P - 4,) power of f in each coefficient; 0 for a coefficient that is held as it is."""

    @classmethod
    def of_problem(cls, problem: Problem) -> Quantities:
        """Return the quantities of a problem: parameters that are held stay as they are."""
        powers = np.array(find_model(problem.model).powers, dtype=np.float64)
        powers[~np.isin(np.arange(4, len(problem.parameters)), problem.free)] = 0.0
        return cls(int("fy" in problem.held and "fx" not in problem.held), powers)

    def to_params(self, q: Array) -> Array:
        """Convert q (P,) to the camera's parameters (P,)."""
        f, params = q[self.base], q.copy()
        params[1 - self.base] *= f
        params[4:] *= f**self.powers
        return params

    def from_params(self, params: Array) -> Array:
        """Convert a camera's parameters (P,) to q (P,)."""
        f, q = params[self.base], params.copy()
        q[1 - self.base] /= f
        q[4:] /= f**self.powers
        return q

    def differentiate(self, q: Array) -> Array:
        """Return the derivatives (P, P) of the parameters by q."""
        f, other = q[self.base], 1 - self.base
        J = np.diag(np.concatenate([np.ones(4), f**self.powers]))
        J[other, other], J[other, self.base] = f, q[other]
        J[4:, self.base] = self.powers * J[4:, 4:].diagonal() * q[4:] / f
        return J

    def name_of(self, i: int, names: tuple[str, ...]) -> str:
        """Return the name of quantity i: a parameter's name, or "fy/fx" for the ratio."""
        return f"{names[i]}/{names[self.base]}" if i == 1 - self.base else names[i]


def reparametrise(normal_at: NormalAt, quantities: Quantities, free: IntArray) -> NormalAt:
    """Restate a problem in q.

    Args:
        normal_at: the normal equations of all the camera's parameters.
        quantities: the quantities.
        free: indices of the quantities that may move.
    """

    def at(state: State) -> NormalEquations:
        normal = normal_at(state._replace(params=quantities.to_params(state.params)))
        C = quantities.differentiate(state.params)[:, free]
        return normal._replace(U=C.T @ normal.U @ C, W=C.T @ normal.W, shared=normal.shared @ C)

    return at

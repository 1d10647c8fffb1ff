"""A camera in quantities that views leave open one by one, not only in combination.

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
from calibgui.engine.calibration.options import Options
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.refinement.schur import NormalAt, NormalEquations
from calibgui.engine.camera.models import MODELS


class Quantities(NamedTuple):
    """The coordinates q of a camera, in the places of its parameters."""

    base: int
    """Place of f: 0 for fx, 1 for fy."""
    powers: Array
    """(P - 4,) of f in each coefficient; 0 for one that is held as it is."""

    @classmethod
    def of(cls, asked: Options) -> Quantities:
        """Those of what is asked: what the user holds is held as it is."""
        powers = np.array(MODELS[asked.model].powers, dtype=np.float64)
        powers[~np.isin(np.arange(4, len(asked.names)), asked.free)] = 0.0
        return cls(int("fy" in asked.held and "fx" not in asked.held), powers)

    def params(self, q: Array) -> Array:
        """The camera's parameters (P,)."""
        f, params = q[self.base], q.copy()
        params[1 - self.base] *= f
        params[4:] *= f**self.powers
        return params

    def by_params(self, params: Array) -> Array:
        """q (P,) of a camera's parameters."""
        f, q = params[self.base], params.copy()
        q[1 - self.base] /= f
        q[4:] /= f**self.powers
        return q

    def jacobian(self, q: Array) -> Array:
        """(P, P) derivative of the parameters by q."""
        f, other = q[self.base], 1 - self.base
        J = np.diag(np.concatenate([np.ones(4), f**self.powers]))
        J[other, other], J[other, self.base] = f, q[other]
        J[4:, self.base] = self.powers * J[4:, 4:].diagonal() * q[4:] / f
        return J

    def name(self, i: int, names: tuple[str, ...]) -> str:
        """What quantity i is called: a parameter's name, or the ratio of focal lengths."""
        return f"{names[i]}/{names[self.base]}" if i == 1 - self.base else names[i]


def in_quantities(normal_at: NormalAt, quantities: Quantities, free: IntArray) -> NormalAt:
    """The problem in q, of which the `free` may move, from one of all the camera's parameters."""

    def at(state: State) -> NormalEquations:
        normal = normal_at(state._replace(params=quantities.params(state.params)))
        C = quantities.jacobian(state.params)[:, free]
        return normal._replace(U=C.T @ normal.U @ C, W=C.T @ normal.W, shared=normal.shared @ C)

    return at

"""Steps from the factors of an earlier state, corrected by what gradients have shown since then.

With hundreds of parameters, those of a splined lens, factors of J^T J take several times as long as
the normal equations themselves. Slight steps leave J^T J nearly as it is, but two things make steps
from kept factors, and Gauss-Newton steps altogether, approach the minimum by a constant factor
only: the change of J^T J that there is, and the second derivatives of the residuals, which J^T J
leaves out and which count in directions that the views hardly determine.

Both are seen in pairs of a step s and the change y = H s of the gradient along it. L-BFGS (Nocedal
1980; Nocedal and Wright 2006, algorithm 7.4) corrects H0^-1, here (J^T J)^-1 from the factors, by
some last pairs so that it maps each y to its s:

    q = g,      a_i = s_i^T q / s_i^T y_i,      q <- q - a_i y_i         from the last to the first,
    r = H0^-1 q,      r <- r + s_i (a_i - y_i^T r / s_i^T y_i)       from the first to the last,

and the step is -r. Pairs with s^T y <= 0 are left out, so that it leads downhill.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.refinement.schur import FactorisedSystem, NormalEquations

MAX_PAIRS = 3
"""Number of last pairs that correct a step: with ten, splined lenses take as many steps."""


class KeptFactors:
    """Factors of the normal equations at some state, and the steps taken since then."""

    def __init__(self, factors: FactorisedSystem, max_pairs: int = MAX_PAIRS) -> None:
        """Keep factors; steps are corrected by at most so many pairs, not at all by 0."""
        self._factors, self._max_pairs = factors, max_pairs
        self._pairs: list[tuple[Array, Array]] = []
        self._last: tuple[Array, Array] | None = None

    def solve_step(self, normal: NormalEquations) -> tuple[Array, Array]:
        """Return the step from a state: (P,) shared and (K, 6) poses.

        The step that was returned before has to have led to this state.

        Args:
            normal: the normal equations at the state, of which the gradient counts.
        """
        if not self._max_pairs:
            by_shared, by_pose = self._factors.solve(normal.shared, normal.pose)
            return -by_shared, -by_pose
        P, K = len(normal.shared), len(normal.pose)
        gradient = np.concatenate([normal.shared, normal.pose.ravel()])
        self._add_pair(gradient)
        q, shares = gradient, []
        for s, y in reversed(self._pairs):
            shares.append((s @ q) / (s @ y))
            q = q - shares[-1] * y
        by_shared, by_pose = self._factors.solve(q[:P], q[P:].reshape(K, 6))
        r = np.concatenate([by_shared, by_pose.ravel()])
        for (s, y), share in zip(self._pairs, reversed(shares), strict=True):
            r += s * (share - (y @ r) / (s @ y))
        self._last = -r, gradient
        return -r[:P], -r[P:].reshape(K, 6)

    def _add_pair(self, gradient: Array) -> None:
        """Add the pair of the last step, at whose end the gradient is as given."""
        if self._last is None:
            return
        step, before = self._last
        change = gradient - before
        if step @ change > 0:
            self._pairs = [*self._pairs, (step, change)][-self._max_pairs :]

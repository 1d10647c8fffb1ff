"""The prior: knowledge of a camera's coefficients before the corners, as a part of the cost.

Corners leave some coefficients of a splined lens open: control points that none of them touches,
and what a rotation of the camera does. The lens model then says with which quadratic form k^T Q k
coefficients are pulled towards 0 (``camera.model.Lens.compute_stiffness``): rows of a linear
regression that are not corners. With g its gradient, halved as J^T r is, it adds

    Q to U,        g = Q k to the shared gradient,        k^T Q k to the cost

for the coefficients that are free. The normal equations hold its cost apart from the corners',
whose residuals alone say how large the noise is (``covariances.py``).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.refinement.schur import NormalEquations

_FIRST_COEFFICIENT = 4
"""Index of the first lens coefficient among the camera's parameters."""


class Prior(NamedTuple):
    """A prior on the lens coefficients, of which some are free.

    Its matrices are sparse: a coefficient is pulled together with few others.
    """

    stiffness: scipy.sparse.coo_array
    """(C, C) the matrix Q of all coefficients."""
    among_free: scipy.sparse.coo_array
    """(P, P) the same for the free parameters, 0 for those that are no coefficients."""
    coefficients: IntArray
    """Indices of the free coefficients among all of them."""
    columns: IntArray
    """Places of the free coefficients among the free parameters."""

    def add_to(self, normal: NormalEquations, params: Array) -> NormalEquations:
        """Add the prior to normal equations of the corners alone, whose U is overwritten.

        Args:
            normal: the normal equations at some state.
            params: the camera's parameters there.
        """
        k = params[_FIRST_COEFFICIENT:]
        pull = self.stiffness @ k
        U, shared = normal.U, normal.shared.copy()
        U[self.among_free.coords] += self.among_free.data
        shared[self.columns] += pull[self.coefficients]
        return normal._replace(
            U=U, shared=shared, prior=self.among_free, prior_cost=float(k @ pull)
        )


def make_prior(stiffness: Array, free: IntArray) -> Prior:
    """Return the prior with a matrix Q (C, C) where the parameters with indices `free` (P,) are."""
    columns = np.flatnonzero(free >= _FIRST_COEFFICIENT)
    coefficients = free[columns] - _FIRST_COEFFICIENT
    place = np.full(len(stiffness), -1)
    place[coefficients] = columns
    # Of held coefficients it is a constant, and not worth a search of so large a matrix.
    whole = scipy.sparse.coo_array(stiffness if columns.size else stiffness.shape)
    row, column = (place[index] for index in whole.coords)
    kept = (row >= 0) & (column >= 0)
    among_free = scipy.sparse.coo_array(
        (whole.data[kept], (row[kept], column[kept])), (len(free), len(free))
    )
    return Prior(whole, among_free, coefficients, columns)

"""Where the board as a whole expects its corners.

The positions of a plane lattice are those of its perspective P (`perspective`) plus what the lens
has bent otherwise, a polynomial p of low degree in column and row:

    uv = P(col, row) + p(col, row).

It reaches over gaps, where a corner has no neighbours left to predict it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibgui.engine.corners import perspective
from calibgui.engine.corners.lattice import Lattice
from calibgui.engine.corners.perspective import Perspective
from calibgui.engine.types import Array, IntArray

_DEGREES = np.array([(1, 16), (2, 20), (3, 26), (4, 45)])
"""Degree of the polynomial, and the corners from which on it is used."""


@dataclass(frozen=True, eq=False, slots=True)
class Sheet:
    """A lattice's smooth positions."""

    flat: Perspective
    centre: Array
    half: Array
    """(2,) the cells (row, col) that the polynomial counts from and in."""
    powers: IntArray
    """(terms, 2) of row and column."""
    coefficients: Array
    """(terms, 2) px."""

    def at(self, cells: Array) -> Array:
        """Positions (n, 2) px of the cells (n, 2) = (row, col), found or not."""
        bent = _basis(cells, self.centre, self.half, self.powers) @ self.coefficients
        return self.flat.at(cells[:, ::-1]) + bent


def fitted(lattice: Lattice) -> Sheet:
    """The sheet through the corners of `lattice`."""
    cells = np.argwhere(lattice.found).astype(np.float64)
    uv = lattice.uv[lattice.found]
    flat = perspective.fitted(cells[:, ::-1], uv)
    degree = int(_DEGREES[_DEGREES[:, 1] <= len(cells), 0].max(initial=0))
    powers = np.argwhere(np.ones((degree + 1, degree + 1)))
    powers = powers[powers.sum(axis=1) <= degree]
    centre = cells.mean(axis=0)
    half = np.maximum(np.ptp(cells, axis=0) / 2, 1.0)
    basis = _basis(cells, centre, half, powers)
    # Of powers that the cells do not tell apart the least-squares solution of least norm.
    coefficients = np.linalg.lstsq(basis, uv - flat.at(cells[:, ::-1]))[0]
    return Sheet(flat, centre, half, powers, np.asarray(coefficients, dtype=np.float64))


def _basis(cells: Array, centre: Array, half: Array, powers: IntArray) -> Array:
    """(n, terms) the polynomial's terms."""
    x = np.polynomial.polynomial.polyvander((cells - centre) / half, int(powers.max()))
    return np.asarray(x[:, 0, powers[:, 0]] * x[:, 1, powers[:, 1]])

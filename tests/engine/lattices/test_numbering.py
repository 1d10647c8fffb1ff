"""Lattices turned by quarters."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.features.lattice import Lattice
from calibgui.engine.lattices.numbering import turn_lattice


@pytest.mark.parametrize("quarters", range(-4, 5))
def test_a_turned_lattice_begins_at_another_corner(quarters: int) -> None:
    uv = np.random.default_rng(0).uniform(0, 100, (3, 4, 2))
    turned = turn_lattice(Lattice(uv, dark=True), quarters)
    np.testing.assert_array_equal(turned.uv, np.rot90(uv, quarters))
    # Of 3 x 4 corners the squares at the ends of a diagonal differ.
    assert turned.dark == (quarters % 4 in (0, 1))
    back = turn_lattice(turned, -quarters)
    np.testing.assert_array_equal(back.uv, uv)
    assert back.dark

"""The saddle point, the Harris estimate, and the order of a lattice."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import erf

from calibgui.engine.arrays import Array
from calibgui.engine.features import harris, saddle
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.lattices.numbering import list_numberings, turn_lattice


def crossing(centre: Array, angle: float = 0.5) -> Array:
    """A 41 x 41 image of two perpendicular blurred edges crossing at `centre`."""
    v, u = np.mgrid[:41, :41] - 0.0
    du, dv = u - centre[0], v - centre[1]
    d1 = du * np.cos(angle) + dv * np.sin(angle)
    d2 = -du * np.sin(angle) + dv * np.cos(angle)
    return np.asarray(127 + 80 * erf(d1) * erf(d2))


@settings(max_examples=30)
@given(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(0, 3))
def test_saddle_has_no_bias_with_the_phase(du: float, dv: float, angle: float) -> None:
    centre = np.array([20 + du, 20 + dv])
    start = np.array([[20.0, 20.0]])
    uv, good = saddle.refine_saddles(
        crossing(centre, angle), start, np.array([1.5]), np.array([3.0])
    )
    assert good[0]
    np.testing.assert_allclose(uv[0], centre, atol=0.01)


def test_no_saddle_is_said() -> None:
    v, u = np.mgrid[:41, :41] - 20.0
    start = np.array([[20.0, 20.0]])
    for image in (np.exp(-(u * u + v * v) / 20), erf(u), np.zeros((41, 41))):
        uv, good = saddle.refine_saddles(image, start, np.array([1.5]), np.array([3.0]))
        assert not good[0]
        np.testing.assert_array_equal(uv, start)


def test_harris_is_near() -> None:
    centre = np.array([20.3, 19.6])
    estimate = harris.estimate_corners(crossing(centre), np.array([[21.0, 20.0]]), np.array([20.0]))
    assert np.abs(estimate[0] - centre).max() <= 1
    np.testing.assert_array_equal(estimate, np.rint(estimate))


def lattice_of(rows: int, cols: int, dark: bool) -> Lattice:
    n, m = np.meshgrid(np.arange(cols), np.arange(rows))
    return Lattice(np.stack([30.0 * n + 5, 30.0 * m + 5], axis=-1), dark)


@given(st.integers(3, 7), st.integers(3, 7), st.booleans(), st.integers(0, 3))
def test_numbering_does_not_depend_on_how_the_lattice_was_walked(
    rows: int, cols: int, dark: bool, quarters: int
) -> None:
    lattice = lattice_of(rows, cols, dark)
    first = list_numberings(lattice, None)[0]
    again = list_numberings(turn_lattice(lattice, quarters), None)[0]
    np.testing.assert_array_equal(first.lattice.uv, again.lattice.uv)
    assert first.lattice.dark == again.lattice.dark
    if (rows + cols) % 2:
        assert first.lattice.dark


@pytest.mark.parametrize(("rows", "cols", "ways"), [(6, 9, 1), (6, 8, 2), (5, 5, 4), (6, 6, 4)])
def test_a_whole_board_has_as_many_numberings_as_symmetries(
    rows: int, cols: int, ways: int
) -> None:
    assert len(list_numberings(lattice_of(rows, cols, True), (rows, cols))) == ways


def test_a_partial_board_keeps_its_colours() -> None:
    part: Any = lattice_of(4, 9, False)
    for way in list_numberings(part, (6, 9)):
        assert way.lattice.dark == (sum(way.offset) % 2 == 0)

"""What is taken from the board as a whole stays so where the board is seen in part."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from calibgui.engine.corner_fit.board_priors import LatticePriors, ScatteredPriors

TAIL = {(0, c) for c in range(1, 9)} | {(1, 6), (1, 8)}
COLUMN = {(r, 8) for r in range(6)}


@pytest.mark.parametrize("missing", [set(), TAIL, COLUMN, TAIL | COLUMN])
@pytest.mark.parametrize("degree", [1, 7])
def test_gradients_do_not_run_away_where_lines_are_short(
    missing: set[tuple[int, int]], degree: int
) -> None:
    found = np.ones((7, 9), np.bool_)
    for place in missing:
        found[place] = False
    row, col = np.argwhere(found).T.astype(np.float64)
    step = 30.0
    steps = np.broadcast_to(step * np.eye(2), (len(row), 2, 2))
    x = col / 8
    values = np.column_stack([100 * x**degree, 2 * row])
    values += 1e-3 * np.random.default_rng(0).standard_normal(values.shape)
    got = LatticePriors(found).estimate_gradients(steps, values)
    expected = np.zeros((len(row), 2, 2))
    expected[:, 0, 0] = 100 * degree * x ** (degree - 1) / 8 / step
    expected[:, 1, 1] = 2 / step
    np.testing.assert_allclose(got, expected, atol=0.05)


def test_light_that_breaks_does_not_ring() -> None:
    """Half of the board in shadow: the gradients are those on either side of the shadow's edge."""
    found = np.ones((6, 9), np.bool_)
    row, col = np.argwhere(found).T.astype(np.float64)
    steps = np.broadcast_to(30.0 * np.eye(2), (len(row), 2, 2))
    shadow = col + row / 2 > 5.2
    smooth = 100 + 2 * col + 0.05 * row**2
    values = np.column_stack([smooth, np.where(shadow, 0.4, 1.0) * smooth])
    values += 0.01 * np.random.default_rng(0).standard_normal(values.shape)
    whole, broken = LatticePriors(found).estimate_gradients(steps, values).transpose(1, 0, 2)
    np.testing.assert_allclose(whole[:, 0], 2 / 30, atol=2e-3)
    expected = np.where(shadow, 0.4, 1.0)[:, None] * whole
    np.testing.assert_allclose(broken, expected, atol=0.01)


@pytest.mark.parametrize("degree", [1, 4])
def test_gradients_scatter_as_their_covariance_says(degree: int) -> None:
    found = np.ones((6, 9), np.bool_)
    row, col = np.argwhere(found).T.astype(np.float64)
    steps = np.broadcast_to(np.array([[30.0, 5.0], [-8.0, 25.0]]), (len(row), 2, 2))
    smooth = 20 * (col / 8) ** degree + 30 * (row / 5) ** degree
    priors, rng = LatticePriors(found), np.random.default_rng(0)
    right = priors.estimate_gradients(steps, smooth[:, None])[:, 0]
    deviations = []
    for _ in range(300):
        values = smooth + 0.05 * rng.standard_normal(len(smooth))
        error = priors.estimate_gradients(steps, values[:, None])[:, 0] - right
        (covariance,) = priors.estimate_gradient_covariances(steps, values[:, None])
        inverse = np.linalg.inv(covariance)
        deviations.append(np.mean(np.einsum("ni,nij,nj->n", error, inverse, error) / 2))
    assert 0.8 < np.mean(deviations) < 1.25


def test_the_break_of_light_does_not_widen_gradients_elsewhere() -> None:
    """The scatter about a polynomial that cannot follow made them 30 times as wide."""
    found = np.ones((7, 10), np.bool_)
    cell = np.argwhere(found)[:, ::-1].astype(np.float64)
    noise = 0.3 * np.random.default_rng(2).standard_normal(len(cell))
    values = np.where(cell @ [1.0, 0.4] > 5.3, 60.0, 100.0) + noise
    steps = np.tile(20 * np.eye(2), (len(cell), 1, 1))
    even = 100 + noise
    covariances = LatticePriors(found).estimate_gradient_covariances(
        steps, np.column_stack([values, even])
    )
    expected = 2 * (0.3 / 20) ** 2
    pair = np.tile(expected * np.eye(2), (70, 1, 1))
    np.testing.assert_allclose(covariances[0], pair, atol=expected)
    assert np.trace(covariances[1], axis1=1, axis2=2).max() < expected  # nothing breaks there


def test_light_that_breaks_does_not_ring_between_uneven_lines() -> None:
    """Corners of tags lie a tag and a gap apart in turn; the polynomial alone was 10 levels a
    unit off at half of them."""
    line = np.repeat(np.arange(5) * 1.3, 2) + np.tile([0.0, 1.0], 5)
    places = np.stack(np.meshgrid(line, line[:8]), axis=-1).reshape(-1, 2)
    across = places @ np.array([1.0, 0.3]) - 4.03
    ramp = 2.0 * places[:, 1]
    noise = 0.05 * np.random.default_rng(3).standard_normal(len(places))
    values = np.where(across > 0, 60.0, 100.0) + ramp + noise
    steps = np.tile(np.eye(2), (len(places), 1, 1))
    gradient = ScatteredPriors(places, 1.0).estimate_gradients(steps, values[:, None])[:, 0]
    # The shadow's edge may pass a corner on both sides.
    assert np.quantile(abs(gradient - [0.0, 2.0]).max(axis=1), 0.9) < 1.0


def test_the_steps_of_few_corners_follow_a_strong_lens() -> None:
    """With no corner in one place at the border, by which no polynomial followed it."""

    def see(cells: NDArray[np.float64]) -> NDArray[np.float64]:
        q = (cells - [1.5, 1.0]) / 2
        q = q / (1 + q @ np.array([0.15, 0.1]))[:, None]
        return 300 + 200 * q * (1 - 0.12 * np.sum(q**2, axis=1, keepdims=True))

    found = np.ones((3, 4), dtype=np.bool_)
    found[2, 0] = False
    cells = np.argwhere(found)[:, ::-1].astype(np.float64)
    ends = [[see(cells + end * axis) for end in (-0.01, 0.01)] for axis in np.eye(2)]
    true = np.stack([(after - before) / 0.02 for before, after in ends], axis=1)
    steps, _ = LatticePriors(found).estimate_geometry(see(cells))
    np.testing.assert_allclose(steps, true, atol=10.0)

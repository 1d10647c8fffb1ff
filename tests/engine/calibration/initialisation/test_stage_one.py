"""Stage I: its Jacobian, exact recovery, and independence of the views from each other."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.initialisation.stage_one import register_points, register_views
from calibgui.engine.geometry import homography, rotations
from tests.engine.scenes import BOARD, central_differences, relative

CENTRE, K1 = np.array([-16.5, -2.9]), 5.9e-7


def z_r(rng: np.random.Generator) -> Array:
    """(11,) unknowns of a view in units of the points' spread."""
    H = np.eye(3) + rng.uniform(-0.3, 0.3, size=(3, 3))
    return np.array([0.05, -0.03, 0.06, *H[:2, 0], *H[:2, 1], *H[:2, 2], *H[2, :2]])


def test_registration_is_eq_31_to_33() -> None:
    rng = np.random.default_rng(0)
    z = z_r(rng)
    xp, yp, k1, a11, a21, a12, a22, d1, d2, c1, c2 = z
    for x, y in rng.uniform(-1, 1, size=(20, 2)):
        r2 = (x - xp) ** 2 + (y - yp) ** 2
        psi1, psi2 = x + k1 * r2 * (x - xp), y + k1 * r2 * (y - yp)
        P = c1 * (psi1 - xp) + c2 * (psi2 - yp) + 1
        expected = [(a11 * psi1 + a12 * psi2 + d1) / P, (a21 * psi1 + a22 * psi2 + d2) / P]
        xi, _ = register_points(z[None], np.array([[[x, y]]]))
        np.testing.assert_allclose(xi[0, 0], expected, rtol=1e-14)


def test_jacobian_against_differences() -> None:
    """With the term of P that the printed (B1) leaves out."""
    rng = np.random.default_rng(1)
    x = rng.uniform(-1, 1, size=(1, 30, 2))
    z = z_r(rng)
    numeric = central_differences(lambda q: register_points(q[None], x)[0], z, 1e-3)
    # P stays above 0.3, so fifth derivatives below 1e3: 1e-12 of truncation times that.
    assert relative(register_points(z[None], x)[1], numeric) < 1e-8


def views(count: int, noise: float = 0.0) -> tuple[Array, Array, Array]:
    """Corners of a board seen through k1 alone, their reference points, and a full mask."""
    rng = np.random.default_rng(7)
    xy = (BOARD.points() - [165.0, 120.0]) * [1.0, -1.0]
    measured = []
    for _ in range(count):
        angles = rng.uniform(-0.5, 0.5, size=3)
        R = rotations.rotation_from_paper_angles(*angles)
        point = np.column_stack([xy, np.zeros(len(xy))]) @ R.T + [0.0, 0.0, 550.0]
        ideal = 650.0 * point[:, :2] / point[:, 2:]
        d = ideal.copy()
        for _ in range(60):  # eq. 31 inverted by fixed point: psi - xp = d (1 + k1 r2)
            d = ideal / (1 + K1 * np.sum(d**2, axis=1, keepdims=True))
        measured.append(d + CENTRE + rng.normal(scale=noise, size=d.shape) if noise else d + CENTRE)
    return np.stack(measured), np.stack([xy] * count), np.ones((count, len(xy)))


def test_exact_views_are_recovered() -> None:
    measured, reference, mask = views(6)
    found = register_views(measured, reference, mask)
    assert found.converged.all()
    assert (found.iterations <= 15).all()
    # A view's centre is the worst determined of its unknowns.
    np.testing.assert_allclose(found.centre, np.tile(CENTRE, (6, 1)), atol=1e-4)
    np.testing.assert_allclose(found.k1, K1, rtol=1e-5)
    assert (found.rms < 1e-8).all()
    corrected = measured - CENTRE
    corrected *= 1 + K1 * np.sum(corrected**2, axis=-1, keepdims=True)
    np.testing.assert_allclose(
        homography.apply_homography(found.forward, corrected), reference, atol=1e-5
    )


def test_spread_is_the_scatter_under_noise() -> None:
    draws = []
    for seed in range(60):
        measured, reference, mask = views(1)
        rng = np.random.default_rng(seed)
        found = register_views(
            measured + rng.normal(scale=0.1, size=measured.shape), reference, mask
        )
        draws.append([*found.centre[0], found.k1[0], *found.spread[0]])
    table = np.array(draws)
    ratio = table[:, :3].std(axis=0) / table[:, 3:].mean(axis=0)
    # Residuals are registered on the plane, where noise is not quite uniform; 60 draws: 9 %.
    np.testing.assert_allclose(ratio, 1.0, atol=0.35)


@pytest.mark.parametrize("k", [0, 3])
def test_views_do_not_influence_each_other(k: int) -> None:
    measured, reference, mask = views(5, noise=0.3)
    mask = mask.copy()
    mask[k, 50:] = 0.0
    together = register_views(measured, reference, mask)
    alone = register_views(
        measured[k : k + 1, :50], reference[k : k + 1, :50], mask[k : k + 1, :50]
    )
    np.testing.assert_allclose(together.centre[k], alone.centre[0], rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(together.k1[k], alone.k1[0], rtol=1e-6)
    assert together.iterations[k] == alone.iterations[0]

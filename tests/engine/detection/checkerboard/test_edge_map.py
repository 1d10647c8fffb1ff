"""Curvatures from corners and directions of edges, against those of a lens in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from calibgui.engine.detection.checkerboard.board_priors import compute_curvatures
from calibgui.engine.detection.checkerboard.edge_map import EdgeGeometry, fit_edge_map
from tests.scenes.camera import Camera
from tests.scenes.conditions import Conditions

Array = NDArray[np.float64]
SIGMA = 0.004
"""Standard deviation of a corner, px."""


def draw_edges(camera: Camera, grid_size: tuple[int, int]) -> tuple[Array, Array, Array, Array]:
    """Corners, normals of their edges, curvatures, and arms of half a square."""
    row, col = np.indices(grid_size).reshape(2, -1).astype(float)
    step = 0.01
    at, right, left, down, up = (
        camera.image_from_board(col + step * x, row + step * y)
        for x, y in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1))
    )
    first = np.stack([right - left, down - up], axis=1) / (2 * step)
    second = np.stack([right + left - 2 * at, down + up - 2 * at], axis=1) / step**2
    length = np.linalg.norm(first, axis=2)
    x, y = np.moveaxis(first / length[..., None], 2, 0)
    normals = np.stack([-y, x], axis=2) * np.array([[1.0], [-1.0]])
    return at, normals, compute_curvatures(first, second), length / 2


def measure(grid_size: tuple[int, int], rng: np.random.Generator, **lens: Any) -> list[Array]:
    """What errors of the curvatures amount to at the corners, and the standard deviations that are
    claimed for that, both in standard deviations of the corners."""
    conditions = Conditions(grid_size=grid_size, square=100.0, turn=30.0, **lens)
    at, normals, kappa, arm = draw_edges(Camera(conditions, rng), grid_size)
    off = SIGMA * rng.standard_normal(at.shape)
    turned = 3**0.5 * SIGMA / arm * rng.standard_normal(arm.shape)
    tangents = np.stack([normals[..., 1], -normals[..., 0]], axis=2)
    got = fit_edge_map(
        np.ones(grid_size, np.bool_), at + off, normals + turned[..., None] * tangents, arm, kappa
    )
    third = arm**2 / 6 / SIGMA
    return [(got.curvature - kappa) * third, np.sqrt(got.variance) * third]


@pytest.mark.parametrize("distortion", [0.03, 0.065, 0.43])
@pytest.mark.parametrize("grid_size", [(3, 4), (4, 4), (4, 5), (5, 6)])
def test_a_few_edges_tell_how_they_bend(grid_size: tuple[int, int], distortion: float) -> None:
    rng = np.random.default_rng(0)
    results = [measure(grid_size, rng, distortion=distortion) for _ in range(20)]
    moved, claimed = (np.concatenate(values) for values in zip(*results, strict=True))
    assert np.sqrt(np.mean(moved**2)) < 0.6
    assert np.mean(moved**2 / (1 + claimed**2)) < 0.25  # beside the corners' own


def test_corners_that_a_wrong_curvature_moved_tell_the_same() -> None:
    grid_size = (4, 5)
    camera = Camera(
        Conditions(grid_size=grid_size, square=100.0, distortion=0.05), np.random.default_rng(1)
    )
    at, normals, kappa, arm = draw_edges(camera, grid_size)

    def fit(taken: Array) -> EdgeGeometry:
        """With corners where edges of the curvatures `taken` have the same mean."""
        bend = arm**2 / 6 * (kappa - taken)
        uv = at + np.linalg.solve(normals, bend[..., None])[..., 0]
        return fit_edge_map(np.ones(grid_size, np.bool_), uv, normals, arm, taken)

    right, wrong = fit(kappa), fit(np.zeros_like(kappa))
    shift = (wrong.curvature - right.curvature) * arm**2 / 6
    assert np.abs(kappa * arm**2 / 6).max() > 0.03
    assert np.abs(shift).max() < 2e-3


def test_a_handful_of_corners_has_a_geometry_too() -> None:
    """Six corners in three lines carry no cubic."""
    found = np.array([[1, 1, 0], [1, 1, 1], [0, 0, 1]], np.bool_)
    camera = Camera(Conditions(grid_size=(3, 3), square=100.0), np.random.default_rng(1))
    at, normals, kappa, arm = (values[found.ravel()] for values in draw_edges(camera, (3, 3)))
    got = fit_edge_map(found, at, normals, arm, kappa)
    assert np.abs(got.curvature * arm**2 / 6).max() < 1e-3
    assert np.isfinite(got.variance).all()

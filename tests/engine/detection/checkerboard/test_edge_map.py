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


def read_edges(
    camera: Camera, grid_size: tuple[int, int], normals: Array, kappa: Array, arm: Array
) -> tuple[Array, Array]:
    """What is left of the edges' means, px, and slopes by parabolas of the right curvatures: under
    a strong lens edges are none."""
    row, col = np.indices(grid_size).reshape(2, -1).astype(float)
    t, s = np.linspace(-0.65, 0.65, 66), np.linspace(-1.0, 1.0, 201)
    mean, slope = np.zeros_like(arm), np.zeros_like(arm)
    for edge, (x, y) in enumerate(((1, 0), (0, 1))):
        seen = camera.image_from_board(col[:, None] + x * t, row[:, None] + y * t)
        seen -= camera.image_from_board(col, row)[:, None]
        for i, n in enumerate(normals[:, edge]):
            along, across = seen[i] @ np.array([n[1], -n[0]]), seen[i] @ n
            order = np.argsort(along)
            off = np.interp(s * arm[i, edge], along[order], across[order])
            off -= kappa[i, edge] * (s * arm[i, edge]) ** 2 / 2
            mean[i, edge] = off.mean()
            slope[i, edge] = off @ s / (s @ s) / arm[i, edge]
    return mean, slope


def measure(
    grid_size: tuple[int, int],
    square: float,
    rng: np.random.Generator,
    sigma: float = SIGMA,
    **lens: Any,
) -> list[Array]:
    """The errors of corners that are known to `sigma` px, and the standard deviations that are
    claimed for what errors of the curvatures add, both in standard deviations of the corners."""
    height = 6.3 * square
    conditions = Conditions(
        grid_size=grid_size, square=square, size=(int(4 / 3 * height), int(height)), **lens
    )
    camera = Camera(conditions, rng)
    at, normals, kappa, arm = draw_edges(camera, grid_size)
    mean, slope = read_edges(camera, grid_size, normals, kappa, arm)
    off = mean + sigma * rng.standard_normal(arm.shape)
    turned = 3**0.5 * sigma / arm * rng.standard_normal(arm.shape) - slope
    tangents = np.stack([normals[..., 1], -normals[..., 0]], axis=2)
    got = fit_edge_map(
        np.ones(grid_size, np.bool_),
        at + np.linalg.solve(normals, off[..., None])[..., 0],
        normals + turned[..., None] * tangents,
        arm,
        kappa,
    )
    third = arm**2 / 6
    error = off - (got.curvature - kappa) * third
    return [error / sigma, np.sqrt(got.variance) * third / sigma]


@pytest.mark.parametrize("distortion", [0.0, 0.065, 0.43])
@pytest.mark.parametrize("square", [60.0, 250.0])
@pytest.mark.parametrize("grid_size", [(3, 3), (3, 4), (4, 4), (5, 6)])
def test_a_few_edges_tell_how_they_bend(
    grid_size: tuple[int, int], square: float, distortion: float
) -> None:
    rng = np.random.default_rng(1)
    results = [measure(grid_size, square, rng, distortion=distortion) for _ in range(30)]
    error, claimed = (np.concatenate(values) for values in zip(*results, strict=True))
    assert np.sqrt(np.mean(error**2)) < 1.2
    assert 0.8 < np.mean(error**2 / (1 + claimed**2)) < 1.2


@pytest.mark.parametrize("grid_size", [(3, 3), (3, 4), (4, 4)])
def test_edges_beside_the_axis_of_a_strong_lens_tell_it_too(grid_size: tuple[int, int]) -> None:
    """There a first step towards the lens leads far beyond it."""
    rng, square = np.random.default_rng(5), 300.0
    conditions = {"distortion": 0.43, "shift": 90.0, "centre": (1.4 * square, 0.7 * square)}
    results = [measure(grid_size, square, rng, sigma=0.0014, **conditions) for _ in range(30)]
    error, claimed = (np.concatenate(values) for values in zip(*results, strict=True))
    assert np.sqrt(np.mean(error**2)) < 1.12
    assert 0.8 < np.mean(error**2 / (1 + claimed**2)) < 1.15


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

"""Curvatures from corners and directions of edges, against those of a lens in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from calibgui.engine.corner_fit.board_priors import LatticePriors, compute_curvatures
from calibgui.engine.corner_fit.edge_lens_fit import ReadEdges, clip_arms
from calibgui.engine.corner_fit.followed_edges import EdgeGeometry, follow_edges
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


def list_edges(at: Array, normals: Array, kappa: Array, arm: Array) -> ReadEdges:
    """Parabolas of curvatures `kappa` read over arms to both sides."""
    return ReadEdges(at, normals, kappa, np.zeros_like(arm), np.zeros_like(arm), arm)


def read_edges(camera: Camera, cells: Array, edges: ReadEdges) -> tuple[Array, Array]:
    """What is left of the edges' means, px, and slopes at cells (col, row) by parabolas of the
    right curvatures: under a strong lens edges are none."""
    col, row = cells.T
    t, s = np.linspace(-0.65, 0.65, 66), np.linspace(-1.0, 1.0, 201)
    mean, slope = np.zeros_like(edges.half), np.zeros_like(edges.half)
    tangents = edges.compute_tangents()
    for edge, (x, y) in enumerate(((1, 0), (0, 1))):
        seen = camera.image_from_board(col[:, None] + x * t, row[:, None] + y * t)
        seen -= camera.image_from_board(col, row)[:, None]
        for i, n in enumerate(edges.normals[:, edge]):
            along, across = seen[i] @ tangents[i, edge], seen[i] @ n
            order, half = np.argsort(along), edges.half[i, edge]
            place = edges.middle[i, edge] + s * half
            off = np.interp(place, along[order], across[order])
            off -= edges.curvature[i, edge] * place**2 / 2
            mean[i, edge] = off.mean()
            slope[i, edge] = off @ s / (s @ s) / half
    return mean, slope


def measure(
    grid_size: tuple[int, int],
    square: float,
    rng: np.random.Generator,
    sigma: float = SIGMA,
    kind: type[Camera] = Camera,
    rows: float = 6.3,
    **lens: Any,
) -> list[Array]:
    """The errors of corners that are known to `sigma` px, and the standard deviations that are
    claimed for what errors of the curvatures add, both in standard deviations of the corners, in an
    image as high as so many `rows`."""
    height = rows * square
    conditions = Conditions(
        grid_size=grid_size, square=square, size=(int(4 / 3 * height), int(height)), **lens
    )
    camera, size = kind(conditions, rng), np.array(conditions.size)
    at, normals, kappa, arm = draw_edges(camera, grid_size)
    seen = np.all((at > 8) & (at < size - 9), axis=1)
    whole = list_edges(at[seen], normals[seen], kappa[seen], arm[seen])
    middle, half = clip_arms(whole.uv, whole.compute_tangents(), whole.half, conditions.size)
    edges = whole._replace(middle=middle, half=half)
    cells = np.argwhere(np.ones(grid_size))[seen, ::-1].astype(float)
    mean, slope = read_edges(camera, cells, edges)
    known = sigma * np.sqrt(whole.half / half)
    mean += known * rng.standard_normal(half.shape)
    slope -= 3**0.5 * known / half * rng.standard_normal(half.shape)
    off = mean - middle * slope
    got = LatticePriors(seen.reshape(grid_size)).follow_edges(
        edges._replace(
            uv=edges.uv + np.linalg.solve(edges.normals, off[..., None])[..., 0],
            normals=edges.normals - slope[..., None] * edges.compute_tangents(),
        ),
        sigma,
    )
    error = off - (got.bend - edges.measure_bend(edges.curvature))
    sigmas = known * np.sqrt(1 + 3 * (middle / half) ** 2)
    return [error / sigmas, np.sqrt(got.variance) / sigmas]


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


@pytest.mark.parametrize(
    "lens", [{}, {"distortion": 0.136}, {"distortion": 0.43}, {"k1": -0.3, "focal": 1.0}]
)
def test_edges_that_the_image_cuts_tell_it_too(lens: dict[str, float]) -> None:
    """In the image's corners a strong lens has more than three coefficients, or four."""
    rng = np.random.default_rng(1)
    results = [measure((6, 9), 250.0, rng, sigma=0.0015, **lens) for _ in range(10)]
    error, claimed = (np.concatenate(values) for values in zip(*results, strict=True))
    assert np.sqrt(np.mean(error**2)) < 1.06
    assert 0.8 < np.mean(error**2 / (1 + claimed**2)) < 1.1


def test_many_corners_leave_it_to_their_edges_where_they_do_not_tell() -> None:
    """At the ends of lines polynomials through the corners alone are up to nine standard deviations
    off."""
    rng, lens = np.random.default_rng(1), {"k1": -0.25, "focal": 0.8, "turn": 10.0}
    results = [measure((8, 11), 210.0, rng, sigma=0.0018, rows=11.0, **lens) for _ in range(4)]
    error, claimed = (np.concatenate(values) for values in zip(*results, strict=True))
    assert np.sqrt(np.mean(error**2)) < 1.06
    assert 0.8 < np.mean(error**2 / (1 + claimed**2)) < 1.1


class UnevenPaper(Camera):
    """A camera before paper whose print is displaced in waves by up to 0.001 squares."""

    def image_from_board(self, x: Array, y: Array) -> Array:
        along, down = 1.2 * x + 0.9 * y, 1.3 * y - 0.8 * x
        return super().image_from_board(x + 0.001 * np.sin(along), y + 0.001 * np.sin(down))


@pytest.mark.parametrize("distortion", [0.0, 0.2])
def test_edges_on_uneven_paper_are_followed_along_their_lines(distortion: float) -> None:
    """Bends that no map draws: they would leave errors of three standard deviations and more."""
    rng, lens = np.random.default_rng(1), {"distortion": distortion, "turn": 10.0}
    results = [
        measure((6, 9), 150.0, rng, sigma=0.0018, kind=UnevenPaper, **lens) for _ in range(6)
    ]
    error, claimed = (np.concatenate(values) for values in zip(*results, strict=True))
    assert np.sqrt(np.mean(error**2)) < 1.15
    assert 0.8 < np.mean(error**2 / (1 + claimed**2)) < 1.15


def test_arms_are_clipped_to_what_is_read_of_the_image() -> None:
    corner = np.array([[30.0, 10.0]])
    tangents = np.array([[[1.0, 0.0], [-0.6, 0.8]]])
    middle, half = clip_arms(corner, tangents, np.array([[40.0, 50.0]]), (200, 100))
    # Pixels 1 to 198 and 1 to 98 are read.
    assert middle - half == pytest.approx(np.array([[-29.0, -9.0 / 0.8]]))
    assert middle + half == pytest.approx(np.array([[40.0, 29.0 / 0.6]]))


def test_a_line_meets_the_corner_of_a_bent_edge_as_far_off_as_stated() -> None:
    middle, half, kappa = 30.0, 50.0, 0.002
    s = np.linspace(middle - half, middle + half, 20001)
    line = np.polynomial.Polynomial.fit(s, kappa * s**2 / 2, 1)
    one = np.ones((1, 2))
    edges = ReadEdges(one, np.ones((1, 2, 2)), 0 * one, 0 * one, middle * one, half * one)
    assert edges.measure_bend(kappa * one) == pytest.approx(line(0.0) * one, rel=2e-3)


def test_edges_tell_how_their_curvature_changes() -> None:
    grid_size = (3, 3)
    camera = Camera(
        Conditions(grid_size=grid_size, square=300.0, size=(2200, 2200), distortion=0.43),
        np.random.default_rng(3),
    )
    at, normals, kappa, arm = draw_edges(camera, grid_size)
    edges = list_edges(at, normals, kappa, arm)
    cells = np.argwhere(np.ones(grid_size))[:, ::-1].astype(float)
    mean, slope = read_edges(camera, cells, edges)
    seen = edges._replace(
        uv=at + np.linalg.solve(normals, mean[..., None])[..., 0],
        normals=normals - slope[..., None] * edges.compute_tangents(),
    )
    right = 10 * slope / arm**2  # of the cubic to which the nearest line is so inclined
    got = follow_edges(np.ones(grid_size, np.bool_), seen).curvature_change
    assert abs(right * arm**3 / 6).max() > 0.02
    assert np.abs((got - right) * arm**3 / 6).max() < 0.002


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
        edges = list_edges(uv, normals, taken, arm)
        return follow_edges(np.ones(grid_size, np.bool_), edges)

    right, wrong = fit(kappa), fit(np.zeros_like(kappa))
    shift = wrong.bend - right.bend
    assert np.abs(kappa * arm**2 / 6).max() > 0.03
    assert np.abs(shift).max() < 2e-3


def test_a_handful_of_corners_has_a_geometry_too() -> None:
    """Six corners in three lines carry no cubic."""
    found = np.array([[1, 1, 0], [1, 1, 1], [0, 0, 1]], np.bool_)
    camera = Camera(Conditions(grid_size=(3, 3), square=100.0), np.random.default_rng(1))
    at, normals, kappa, arm = (values[found.ravel()] for values in draw_edges(camera, (3, 3)))
    got = follow_edges(found, list_edges(at, normals, kappa, arm))
    assert np.abs(got.bend).max() < 1e-3
    assert np.isfinite(got.variance).all()


@pytest.mark.parametrize("seed", range(4))
def test_perspective_bends_no_edges(seed: int) -> None:
    """Polynomials of cells may take a part of the homography: what is straight remains so. Corners
    of a board at 70 degrees that the image cut were moved by 0.03 px, five standard deviations."""
    camera = Camera(Conditions(tilt=65.0, square=45.0), np.random.default_rng(103))
    at, normals, _, _ = draw_edges(camera, (6, 9))
    rng = np.random.default_rng(seed)
    turn = rng.normal(0, 0.005 * 3**0.5 / 25, (54, 2, 1))
    turned = normals + turn * np.stack([normals[..., 1], -normals[..., 0]], axis=-1)
    nothing = np.zeros((54, 2))
    edges = ReadEdges(
        at + rng.normal(0, 0.005, at.shape),
        turned / np.linalg.norm(turned, axis=2, keepdims=True),
        nothing,
        nothing,
        nothing,
        np.tile([25.0, 14.0], (54, 1)),
    )
    geometry = follow_edges(np.ones((6, 9), dtype=np.bool_), edges)
    assert np.abs(geometry.bend).max() < 0.002

"""Grids among points: tilted, bent, with other points around."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from calibgui.engine.arrays import Array, GridSize
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.detection.circles.grid_labelling import find_lattice, label_grid, list_boxes

BOARDS = [(4, 5), (7, 10), (11, 4), (9, 9), (6, 4)]
given_any_grid = given(
    grid_size=st.sampled_from(BOARDS),
    asymmetric=st.booleans(),
    stated=st.booleans(),
    tilt=st.floats(0.0, 0.9),
    seed=st.integers(0, 10_000),
)


def imaged(grid_size: GridSize, asymmetric: bool, rng: np.random.Generator, tilt: float) -> Array:
    """(rows * cols, 2) px of a grid that a camera with a barrel lens sees, within 2 % of a step."""
    places = Circles(asymmetric).locate_points(np.indices(grid_size).reshape(2, -1).T.astype(float))
    flat = places - places.mean(axis=0)
    flat /= np.abs(flat).max()
    about = rng.uniform(0, 2 * np.pi)
    turn = Rotation.from_rotvec([0.0, 0.0, rng.uniform(0, 2 * np.pi)])
    turn = Rotation.from_rotvec([tilt * np.cos(about), tilt * np.sin(about), 0.0]) * turn
    x, y, z = turn.apply(np.column_stack([flat, 0 * flat[:, 0]])).T
    n = np.column_stack([x, y]) / (z + 3.0)[:, None]
    uv = 800 * n * (1 - 0.5 * np.sum(n**2, axis=1, keepdims=True)) + [640, 480]
    apart = np.linalg.norm(uv[:, None] - uv, axis=2)
    return uv + 0.02 * apart[apart > 0].min() * rng.standard_normal(uv.shape)


def around(uv: Array, rng: np.random.Generator) -> Array:
    """Ten points at random, all outside of the grid's circumscribed circle."""
    middle = uv.mean(axis=0)
    radius = np.linalg.norm(uv - middle, axis=1).max() * rng.uniform(1.3, 2.0, 10)
    angle = rng.uniform(0, 2 * np.pi, 10)
    return middle + radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])


def distances(places: Array) -> Array:
    return np.asarray(np.linalg.norm(places[:, None] - places, axis=2))


@given_any_grid
def test_a_grid_is_found_among_other_points(
    grid_size: GridSize, asymmetric: bool, stated: bool, tilt: float, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    uv = imaged(grid_size, asymmetric, rng, tilt)
    order = rng.permutation(len(uv) + 10)
    points = np.vstack([uv, around(uv, rng)])[order]
    grid = label_grid(points, grid_size if stated else None, asymmetric=asymmetric)
    assert grid is not None and grid.is_full
    which = order[grid.points]
    assert sorted(which) == list(range(len(uv)))
    assert grid.places.shape == (grid_size if stated or asymmetric else tuple(sorted(grid_size)))
    # However it is counted, it is the same grid.
    pattern = Circles(asymmetric)
    counted = pattern.locate_points(np.indices(grid.places.shape).reshape(2, -1).T.astype(float))
    true = pattern.locate_points(np.indices(grid_size).reshape(2, -1).T.astype(float))[which]
    np.testing.assert_allclose(distances(counted), distances(true), atol=1e-9)


def test_strays_beside_the_grid_are_not_of_it() -> None:
    uv = np.indices((6, 6)).reshape(2, -1).T * 40.0
    beside = np.array([[240.0, 80.0], [240.0, 120.0], [-40.0, 0.0]])
    grid = label_grid(np.vstack([uv, beside]), None, asymmetric=False)
    assert grid is not None
    assert sorted(grid.points) == list(range(36))


@pytest.mark.parametrize("stated", [None, (6, 10)])
def test_a_part_of_a_grid_is_not_taken_for_the_whole(stated: GridSize | None) -> None:
    """A shadow or a hand hides what joins it to the rest."""
    row, col = np.indices((6, 10)).reshape(2, -1)
    uv = np.column_stack([col, row]) * 40.0
    most_of_the_lower_rows = (row > 2) & (col > 3)
    band = (row + col == 6) | (row + col == 7)
    for hidden in ((col == 4) | (col == 5), band, most_of_the_lower_rows):
        assert label_grid(uv[~hidden], stated, asymmetric=False) is None


def test_a_line_across_a_grid_is_grown_over() -> None:
    """A cable hides one circle of every row."""
    row, col = np.indices((6, 10)).reshape(2, -1)
    seen = np.column_stack([col, row])[row + col != 6] * 40.0
    grid = label_grid(seen, None, asymmetric=False)
    assert grid is not None
    assert grid.places.shape == (6, 10) and len(grid) == 54


def test_under_a_fisheye_a_part_is_not_taken_for_the_whole() -> None:
    """There the lattice goes on where the homography of the part does not expect it."""
    row, col = np.indices((7, 9)).reshape(2, -1)
    x, y = (col - 1.0) * 0.35, (row - 1.0) * 0.35
    radius = np.hypot(x, y) + 1e-9
    uv = np.column_stack([x, y]) * (200 * np.arctan(radius) / radius)[:, None]
    seen = uv[~((row > 2) & (col > 3))]
    assert label_grid(seen, None, asymmetric=False) is None


def test_an_asymmetric_grid_is_no_symmetric_one_turned() -> None:
    row, col = np.indices((11, 4)).reshape(2, -1)
    uv = Circles(asymmetric=True).locate_points(np.column_stack([row, col]).astype(float)) * 30.0
    seen = uv[~((row < 4) & (np.abs(uv[:, 0] - 120) <= 30))]
    assert label_grid(seen, None, asymmetric=False) is None


def test_a_small_grid_must_be_stated() -> None:
    points = np.indices((3, 3)).reshape(2, -1).T * 40.0
    stated = label_grid(points, (3, 3), asymmetric=False)
    assert stated is not None
    assert sorted(stated.points) == list(range(9))
    assert label_grid(points, None, asymmetric=False) is None


@pytest.mark.parametrize("asymmetric", [False, True])
def test_scattered_points_are_no_grid(asymmetric: bool) -> None:
    for seed in range(20):
        points = np.random.default_rng(seed).uniform(0, 1000, (120, 2))
        assert label_grid(points, None, asymmetric=asymmetric) is None
    assert label_grid(points[:5], None, asymmetric=asymmetric) is None


@given_any_grid
def test_circles_keep_their_places_when_others_are_covered(
    grid_size: GridSize, asymmetric: bool, stated: bool, tilt: float, seed: int
) -> None:
    """Wherever they lie, also at the border and in the grid's corners."""
    rng = np.random.default_rng(seed)
    uv = imaged(grid_size, asymmetric, rng, tilt)
    seen = np.sort(rng.permutation(len(uv))[len(uv) // 20 :])
    grid = label_grid(uv[seen], grid_size if stated else None, asymmetric=asymmetric)
    assert grid is not None and len(grid) == len(seen) and not grid.is_full
    assert grid.places.shape == (grid_size if stated or asymmetric else tuple(sorted(grid_size)))
    pattern = Circles(asymmetric)
    counted = pattern.locate_points(np.argwhere(grid.places >= 0).astype(float))
    whole = pattern.locate_points(np.indices(grid_size).reshape(2, -1).T.astype(float))
    np.testing.assert_allclose(distances(counted), distances(whole[seen[grid.points]]), atol=1e-9)


def test_a_border_line_with_few_circles_is_left_out_unless_its_size_is_stated() -> None:
    row, col = np.indices((6, 9)).reshape(2, -1)
    uv = np.column_stack([col, row]) * 40.0
    seen = uv[(col < 8) | (row < 2)]
    counted = label_grid(seen, None, asymmetric=False)
    assert counted is not None
    assert counted.places.shape == (6, 8) and counted.left_out == 2
    stated = label_grid(seen, (6, 9), asymmetric=False)
    assert stated is not None
    assert stated.places.shape == (6, 9) and len(stated) == len(seen)


def test_no_box_is_listed_upside_down_too() -> None:
    """Each takes as long to look at as the labels of a grid."""
    points = imaged((4, 6), False, np.random.default_rng(0), 0.3)
    lattice = find_lattice(points)
    assert lattice is not None
    boxes = [box for box in list_boxes(lattice, asymmetric=False) if (box >= 0).all()]
    assert sorted(box.shape for box in boxes) == [(4, 6), (6, 4)]

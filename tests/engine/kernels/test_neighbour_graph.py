"""The compiled graph of neighbours and walks against the readable ones."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from calibgui.engine import kernels, opencv
from calibgui.engine.arrays import GreyImage, Int32Array
from calibgui.engine.kernels import neighbour_graph as kernel
from calibgui.engine.lattices import neighbour_graph, x_junctions
from calibgui.engine.lattices.x_junctions import CROSSING_TOLERANCE
from tests.engine.kernels.conftest import make_callable
from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions


@pytest.mark.parametrize("clutter", [False, True])
def test_the_same_lattices(clutter: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = Conditions(size=(320, 240), square=20.0, noise=4.0, clutter=clutter)
    saddles = x_junctions.find_saddles(draw(scene, 3).photograph(0), 8.0)
    passed, found = x_junctions.classify_saddles(saddles)
    compiled = neighbour_graph.find_lattices(saddles.select(passed), found, 8)
    monkeypatch.setattr(kernels, "COMPILED", False)
    readable = neighbour_graph.find_lattices(saddles.select(passed), found, 8)
    assert len(compiled[0]) >= 50
    assert [lattice.dark for lattice in compiled] == [lattice.dark for lattice in readable]
    for one, other in zip(compiled, readable, strict=True):
        np.testing.assert_array_equal(one.uv, other.uv)


def draw_noise() -> tuple[GreyImage, x_junctions.Junctions]:
    """A smoothed image and what might be its junctions, two of them in one place."""
    rng = np.random.default_rng(4)
    smooth, _ = opencv.blur_image(rng.integers(0, 255, (100, 150)).astype(np.uint8), 1.5)
    n = 2000
    edges = rng.uniform((0, np.pi / 2), (0.6, 0.6 + np.pi / 2), (n, 2))
    edges[::2] += np.pi / 2
    uv = rng.uniform(0, (149, 99), (n, 2))
    uv[1] = uv[0]
    return smooth, x_junctions.Junctions(uv, edges, rng.uniform(1, 30, n))


def choose(function: Callable[..., Int32Array]) -> Int32Array:
    """The neighbours that the junctions in noise choose."""
    smooth, junctions = draw_noise()
    along = neighbour_graph._compute_directions(junctions)
    limits = float(np.cos(np.radians(20.0))), float(np.cos(np.radians(25.0))), 0.25
    places = np.array([0.3, 0.5, 0.7])
    return function(smooth, junctions.uv, along, junctions.contrast, 12, places, limits)


def test_the_same_neighbours_in_noise() -> None:
    readable = choose(neighbour_graph._choose_neighbours.reference)
    assert np.count_nonzero(readable >= 0) > 100
    np.testing.assert_array_equal(choose(neighbour_graph._choose_neighbours.kernel), readable)


def test_only_edges_that_are_seen_from_both_ends_link() -> None:
    crossing, places = CROSSING_TOLERANCE, np.array([0.3, 0.5, 0.7])
    ends = neighbour_graph._link_neighbours(*draw_noise(), crossing, places).ravel()
    linked = np.flatnonzero(ends >= 0)
    assert 20 < len(linked) < np.count_nonzero(choose(neighbour_graph._choose_neighbours) >= 0)
    np.testing.assert_array_equal(ends[ends[linked]], linked)


@pytest.mark.parametrize("extent", [(149.0, 99.0), (149.0, 0.0), (0.0, 0.0)])
@pytest.mark.parametrize("crowd", [0.0, 0.9])
@pytest.mark.parametrize("n", [2, 14, 400])
def test_the_same_junctions_are_nearest(n: int, crowd: float, extent: tuple[float, float]) -> None:
    rng = np.random.default_rng(6)
    uv = rng.uniform(0, 1, (n, 2)) * extent
    uv[rng.random(n) < crowd] *= 0.01
    distance = np.linalg.norm(uv[:, None] - uv, axis=2)
    np.fill_diagonal(distance, np.inf)
    lowest, side, start, member = kernel.sort_points(uv)
    near, squared = np.empty(12, dtype=np.int64), np.empty(12)
    find_nearest = make_callable(kernel._find_nearest)
    for i in range(n):
        count = find_nearest(uv, i, lowest, side, start, member, near, squared)
        assert count == min(n - 1, 12)
        assert i not in near[:count]
        np.testing.assert_allclose(np.sqrt(squared[:count]), np.sort(distance[i])[:count])
        np.testing.assert_allclose(distance[i, near[:count]], np.sort(distance[i])[:count])


def test_the_same_walks(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(1)
    ends = np.full(800, -1, dtype=np.int32)
    one, other = rng.permutation(800)[:400].reshape(2, -1)
    ends[one], ends[other] = other, one
    ends = ends.reshape(-1, 4)
    closing = neighbour_graph._find_closing_edges(ends)
    compiled = list(neighbour_graph._split_components(ends, closing))
    monkeypatch.setattr(kernels, "COMPILED", False)
    np.testing.assert_array_equal(neighbour_graph._find_closing_edges(ends), closing)
    readable = list(neighbour_graph._split_components(ends, closing))
    assert len(readable) == len(compiled) > 0
    assert 0 < sum(len(nodes) for nodes, _ in readable) < 200
    for a, b in zip(compiled, readable, strict=True):
        for x, y in zip(a, b, strict=True):
            np.testing.assert_array_equal(x, y)


def test_of_junctions_in_one_place_the_first_is_laid_out() -> None:
    uv = np.arange(10.0).reshape(5, 2)
    placed = np.array([(0, 0, 0), (0, 1, 0), (1, 0, 1), (0, 1, 0), (1, 0, 1)], np.int32)
    lattice = neighbour_graph._lay_out(uv, placed, (2, 2))
    np.testing.assert_array_equal(lattice.uv, [[uv[0], uv[1]], [uv[2], [np.nan, np.nan]]])
    assert lattice.dark  # as three of the five say

"""The compiled links and walks against the readable ones."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine import kernels, opencv
from calibgui.engine.corners import junctions, links
from tests.benchmarks.corner_scenes import Conditions, draw


@pytest.mark.parametrize("clutter", [False, True])
def test_the_same_lattices(clutter: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = Conditions(size=(320, 240), square=20.0, noise=4.0, clutter=clutter)
    saddles = junctions.find_saddles(draw(scene, 3).photograph(0), 8.0)
    passed, found = junctions.classify(saddles.smooth, saddles.uv, 8.0)
    compiled = links.find_lattices(saddles.under(passed), found, 8)
    monkeypatch.setattr(kernels, "COMPILED", False)
    readable = links.find_lattices(saddles.under(passed), found, 8)
    assert len(compiled[0]) >= 50
    assert [lattice.dark for lattice in compiled] == [lattice.dark for lattice in readable]
    for one, other in zip(compiled, readable, strict=True):
        np.testing.assert_array_equal(one.uv, other.uv)


def test_the_same_neighbours_in_noise(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(4)
    smooth = opencv.smooth(rng.uniform(0, 255, (100, 150)).astype(np.float32), 1.5)
    n = 2000
    edges = rng.uniform((0, np.pi / 2), (0.6, 0.6 + np.pi / 2), (n, 2))
    edges[::2] += np.pi / 2
    uv = rng.uniform(0, (149, 99), (n, 2))
    uv[1] = uv[0]
    found = junctions.Junctions(uv, edges, rng.uniform(1, 30, n))
    compiled = links._link(smooth, found)
    monkeypatch.setattr(kernels, "COMPILED", False)
    readable = links._link(smooth, found)
    assert np.count_nonzero(readable[0] >= 0) > 100
    np.testing.assert_array_equal(compiled, readable)


def test_the_same_walks(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(1)
    n = 200
    neighbour, back = np.full((n, 4), -1), rng.integers(0, 4, (n, 4))
    linked = rng.random((n, 4)) < 0.4
    neighbour[linked] = rng.integers(0, n, np.count_nonzero(linked))
    compiled = links._walk(neighbour, back)
    monkeypatch.setattr(kernels, "COMPILED", False)
    readable = links._walk(neighbour, back)
    assert len(readable) == len(compiled) > 0
    for one, other in zip(compiled, readable, strict=True):
        for a, b in zip(one, other, strict=True):
            np.testing.assert_array_equal(a, b)

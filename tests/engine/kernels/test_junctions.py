"""The compiled peaks and ring test against the readable ones."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine import kernels, opencv
from calibgui.engine.corners import junctions
from calibgui.engine.opencv import Image32
from tests.benchmarks.corner_scenes import Conditions, draw


def board() -> Image32:
    scene = Conditions(size=(320, 240), square=22.0, noise=6.0, clutter=True)
    return opencv.smooth(draw(scene, 1).photograph(0), 1.0)


def noise() -> Image32:
    return opencv.smooth(np.random.default_rng(2).integers(0, 256, (480, 640), np.uint8), 1.0)


@pytest.mark.parametrize("most", [3000, 50])
@pytest.mark.parametrize(
    "image", [board(), noise(), noise()[:9, :8].copy()], ids=["board", "noise", "9x8"]
)
def test_the_same_peaks(image: Image32, most: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(junctions, "MAX_CANDIDATES", most)
    compiled = junctions._compiled_peaks(image, 4.0)
    readable = junctions._peaks(image, 4.0)
    # Equally strong ones may come in another order, as float32 rounds.
    assert len(set(compiled) ^ set(readable)) <= 2
    assert np.count_nonzero(compiled != readable) <= len(readable) / 10


@pytest.mark.parametrize("image", [board(), noise()], ids=["board", "noise"])
def test_the_same_saddle_points(image: Image32) -> None:
    where = junctions._peaks(image, 4.0)
    (uv, strength), expected = (
        find(image, where) for find in (junctions._compiled_stationary, junctions._stationary)
    )
    np.testing.assert_allclose(strength, expected[1], rtol=1e-4)  # differences in float32
    near = np.isfinite(strength)
    assert 0 < np.count_nonzero(near)
    np.testing.assert_allclose(uv[near], expected[0][near], atol=1e-4)


@pytest.mark.parametrize("image", [board(), noise()], ids=["board", "noise"])
def test_the_same_rings(image: Image32, monkeypatch: pytest.MonkeyPatch) -> None:
    saddles = junctions.find_saddles(image, 20.0)
    uv = np.concatenate([saddles.uv, [[0.0, 0.0], [-3.0, 5.0], [319.0, 239.0]]])
    compiled, seen = junctions.classify(image, uv, 20.0)
    monkeypatch.setattr(kernels, "COMPILED", False)
    readable, expected = junctions.classify(image, uv, 20.0)
    assert readable.sum() >= 20
    np.testing.assert_array_equal(compiled, readable)
    np.testing.assert_allclose(seen.uv, expected.uv)
    np.testing.assert_allclose(seen.edges, expected.edges, atol=1e-6)
    np.testing.assert_allclose(seen.contrast, expected.contrast, rtol=1e-6)

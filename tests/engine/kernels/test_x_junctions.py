"""The compiled peaks and ring test against the readable ones."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from calibgui.engine import kernels, opencv
from calibgui.engine.arrays import GreyImage
from calibgui.engine.detection.checkerboard import x_junctions
from tests.benchmarks.corner_scenes import Conditions, draw


def grid_size() -> GreyImage:
    scene = Conditions(size=(320, 240), square=22.0, noise=6.0, clutter=True)
    return draw(scene, 1).photograph(0)


def noise() -> GreyImage:
    return np.random.default_rng(2).integers(0, 256, (480, 640), np.uint8)


IMAGES = {
    "grid_size": grid_size(),
    "noise": noise(),
    "9x8": noise()[:9, :8],
    "16 bits": grid_size().astype(np.uint16),
}


@pytest.fixture(params=IMAGES)
def image(request: pytest.FixtureRequest) -> GreyImage:
    return IMAGES[request.param]


@pytest.mark.parametrize("most", [3000, 50])
def test_the_same_peaks(image: GreyImage, most: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(x_junctions, "MAX_CANDIDATES", most)
    smooth, levels = opencv.smooth(image, 1.0)
    compiled, readable = (
        find(smooth, 4.0 * levels**2) for find in (x_junctions._compiled_peaks, x_junctions._peaks)
    )
    # Equally strong ones may come in another order, as float32 rounds.
    assert len(set(compiled) ^ set(readable)) <= 2
    assert np.count_nonzero(compiled != readable) <= len(readable) / 10


def test_the_same_saddle_points(image: GreyImage) -> None:
    smooth, levels = opencv.smooth(image, 1.0)
    where = x_junctions._peaks(smooth, 4.0 * levels**2)
    (uv, near), expected = (
        find(smooth, where) for find in (x_junctions._compiled_stationary, x_junctions._stationary)
    )
    np.testing.assert_array_equal(near, expected[1])
    assert near.any() or image.size < 100
    np.testing.assert_allclose(uv[near], expected[0][near], atol=1e-4)  # differences in float32


def test_the_same_rings(image: GreyImage, monkeypatch: pytest.MonkeyPatch) -> None:
    saddles = x_junctions.find_saddles(image, 20.0)
    uv = np.concatenate([saddles.uv, [[0.0, 0.0], [-3.0, 5.0], [319.0, 239.0]]])
    saddles = dataclasses.replace(saddles, uv=uv)
    compiled, seen = x_junctions.classify(saddles)
    monkeypatch.setattr(kernels, "COMPILED", False)
    readable, expected = x_junctions.classify(saddles)
    assert readable.sum() >= 20 or image.size < 100
    np.testing.assert_array_equal(compiled, readable)
    np.testing.assert_allclose(seen.uv, expected.uv)
    np.testing.assert_allclose(seen.edges, expected.edges, atol=1e-6)
    np.testing.assert_allclose(seen.contrast, expected.contrast, rtol=1e-6)

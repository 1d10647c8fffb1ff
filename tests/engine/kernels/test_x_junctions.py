"""The compiled peaks and ring test against the readable ones."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from calibgui.engine import kernels, opencv
from calibgui.engine.arrays import GreyImage
from calibgui.engine.lattices import x_junctions
from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions


def draw_board() -> GreyImage:
    scene = Conditions(size=(320, 240), square=22.0, noise=6.0, clutter=True)
    return draw(scene, 1).photograph(0)


def draw_noise() -> GreyImage:
    return np.random.default_rng(2).integers(0, 256, (480, 640), np.uint8)


IMAGES = {
    "board": draw_board(),
    "noise": draw_noise(),
    "9x8": draw_noise()[:9, :8],
    "16 bits": draw_board().astype(np.uint16),
}


@pytest.fixture(params=IMAGES)
def image(request: pytest.FixtureRequest) -> GreyImage:
    return IMAGES[request.param]


@pytest.mark.parametrize("max_count", [3000, 50])
def test_the_same_peaks(image: GreyImage, max_count: int) -> None:
    smooth, levels = opencv.blur_image(image, 1.0)
    find = x_junctions._find_peaks
    compiled, readable = (
        f(smooth, 4.0 * levels**2, max_count) for f in (find.kernel, find.reference)
    )
    # Equally strong ones may come in another order, as float32 rounds.
    assert len(set(compiled) ^ set(readable)) <= 2
    assert np.count_nonzero(compiled != readable) <= len(readable) / 10


@pytest.mark.parametrize("max_count", [3000, 50])
def test_the_first_of_equally_strong_peaks(max_count: int) -> None:
    squares = 40 + 160 * (np.indices((30, 40)).sum(axis=0) % 2).astype(np.uint8)
    image = np.kron(squares, np.ones((16, 16), np.uint8))  # four pixels around each corner
    smooth, levels = opencv.blur_image(image, 1.0)
    find = x_junctions._find_peaks
    peaks = find.kernel(smooth, 4.0 * levels**2, max_count)
    np.testing.assert_array_equal(peaks, find.reference(smooth, 4.0 * levels**2, max_count))
    assert len(peaks) == min(29 * 39, max_count)


def test_the_same_saddle_points(image: GreyImage) -> None:
    smooth, levels = opencv.blur_image(image, 1.0)
    where = x_junctions._find_peaks.reference(smooth, 4.0 * levels**2, 3000)
    refine = x_junctions._refine_stationary
    (uv, near), expected = (f(smooth, where, 3, 1.5) for f in (refine.kernel, refine.reference))
    np.testing.assert_array_equal(near, expected[1])
    assert near.any() or image.size < 100
    np.testing.assert_allclose(uv[near], expected[0][near], atol=1e-4)  # differences in float32


def test_the_same_rings(image: GreyImage, monkeypatch: pytest.MonkeyPatch) -> None:
    saddles = x_junctions.find_saddles(image, 20.0)
    uv = np.concatenate([saddles.uv, [[0.0, 0.0], [-3.0, 5.0], [319.0, 239.0]]])
    saddles = dataclasses.replace(saddles, uv=uv)
    compiled, seen = x_junctions.classify_saddles(saddles)
    monkeypatch.setattr(kernels, "COMPILED", False)
    readable, expected = x_junctions.classify_saddles(saddles)
    assert readable.sum() >= 20 or image.size < 100
    np.testing.assert_array_equal(compiled, readable)
    np.testing.assert_allclose(seen.uv, expected.uv)
    np.testing.assert_allclose(seen.edges, expected.edges, atol=1e-6)
    np.testing.assert_allclose(seen.contrast, expected.contrast, rtol=1e-6)

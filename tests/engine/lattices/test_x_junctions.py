"""X-junctions of an image, whatever its bits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy
from numpy.typing import NDArray

from calibgui.engine import kernels
from calibgui.engine.lattices.x_junctions import Junctions, classify_saddles, find_saddles
from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions


def find_junctions(image: NDArray[Any], floor: float) -> Junctions:
    return classify_saddles(find_saddles(image, floor))[1]


def test_the_same_junctions_in_more_bits() -> None:
    scene = Conditions(size=(320, 240), square=20.0, noise=4.0, clutter=True)
    image: NDArray[np.uint8] = draw(scene, 3).photograph(0)
    few, many = (
        find_junctions(image, 8.0),
        find_junctions(image.astype(np.uint16) * np.uint16(257), 8.0 * 257),
    )
    distance, _ = scipy.spatial.cKDTree(few.uv).query(many.uv)
    assert len(few) > 54
    assert np.mean(distance < 0.02) > 0.97
    assert abs(len(few) - len(many)) <= 0.03 * len(few)


@pytest.mark.parametrize("compiled", [True, False])
def test_one_junction_where_pixels_are_equally_strong(
    compiled: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(kernels, "COMPILED", compiled and kernels.COMPILED)
    v, u = np.mgrid[:200, :240] // 20
    image = np.where((u + v) % 2 == 0, 40, 210).astype(np.uint8)
    uv = find_junctions(image, 8.0).uv
    assert len(uv) == 9 * 11
    np.testing.assert_allclose(uv, 20 * np.rint((uv + 0.5) / 20) - 0.5, atol=0.1)


def test_between_pixels_junctions_are_where_the_edges_cross() -> None:
    for seed in range(8):
        scene = draw(Conditions(size=(320, 240), square=22.0, noise=0.0, blur=0.7), seed)
        truth = scipy.spatial.cKDTree(scene.uv[scene.visible])
        distance, _ = truth.query(find_junctions(scene.photograph(0), 8.0).uv)
        corners = distance < 1.0
        assert np.count_nonzero(corners) == len(truth.data)
        assert np.sqrt(np.mean(distance[corners] ** 2)) < 0.03

"""The compiled model of crossing edges against the readable one."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np
import pytest

from calibgui.engine import kernels
from calibgui.engine.corner_fit import corner_noise, x_corner_step
from calibgui.engine.corner_fit.x_corner_model import (
    EdgeSupport,
    XCornerModel,
    accumulate_normal_equations,
    accumulate_scores,
)
from calibgui.engine.detection.find_corners import find_corners
from tests.engine.kernels.conftest import make_callable
from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions


@pytest.mark.parametrize(
    "scene",
    [
        {},
        {"blur": 0.1},  # the pixel's own box counts
        {"blur": 0.7, "blur_end": 3.0, "light": 1.0},
        {"distortion": 0.5},
        {"ink": 0.05},
        {"ink": -0.05, "blur": 0.2},
        {"square": 30.0, "grid_size": (9, 12), "turn": 20.0},  # leaves the image
    ],
    ids=str,
)
@pytest.mark.parametrize("kind", [np.uint8, np.uint16])
def test_compiled_and_readable_find_the_same(
    scene: dict[str, Any], kind: type, monkeypatch: pytest.MonkeyPatch
) -> None:
    usual = {"size": (320, 240), "square": 20.0, "shift": 5.0, "grid_size": (5, 6)}
    image = draw(Conditions(**{**usual, **scene}), 3).photograph(0).astype(kind)
    compiled = find_corners(image)
    monkeypatch.setattr(kernels, "COMPILED", False)
    readable = find_corners(image)
    assert compiled.shape == readable.shape
    np.testing.assert_array_equal(compiled.grid, readable.grid)
    np.testing.assert_allclose(compiled.uv, readable.uv, atol=2e-5)  # sums in float32
    assert compiled.cov is not None
    assert readable.cov is not None
    scale = np.trace(readable.cov, axis1=1, axis2=2)[:, None, None]
    assert (np.abs(compiled.cov - readable.cov) < 2e-3 * scale).all()
    for quantity in ("residual", "blur", "contrast"):
        pair = getattr(compiled, quantity), getattr(readable, quantity)
        np.testing.assert_allclose(*pair, rtol=1e-3)


@pytest.mark.parametrize(
    "scene", [{}, {"ink": 0.05}, {"square": 60.0, "size": (480, 360), "grid_size": (3, 4)}], ids=str
)
def test_the_same_scores_of_lines(scene: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    seen = []
    monkeypatch.setattr(
        corner_noise,
        "accumulate_scores",
        lambda *args: seen.append(args) or accumulate_scores(*args),
    )
    usual = {"size": (320, 240), "square": 20.0, "shift": 5.0, "grid_size": (5, 6), "parts": 2}
    find_corners(draw(Conditions(**{**usual, **scene}), 3).photograph(0))
    mine, its = accumulate_scores.kernel(*seen[0]), accumulate_scores.reference(*seen[0])
    for i in range(2):
        scale = abs(its[:, :, i]).max()
        np.testing.assert_allclose(mine[:, :, i] / scale, its[:, :, i] / scale, atol=1e-4)


def test_the_same_step_of_the_unknowns() -> None:
    rng = np.random.default_rng(0)
    n = 50
    J = rng.normal(size=(n, 30, 10)) * 10.0 ** rng.uniform(-2, 2, 10)
    J[..., 6] = 1.0  # the derivative by m
    J[0, :, 3] = J[0, :, 2]  # not to be told apart
    J[1] = 0.0  # no pixel was read
    products = J.transpose(0, 2, 1) @ J
    x = rng.normal(size=(n, 9))
    x[:, 4:6] = rng.uniform(0.3, 2.0, (n, 2))
    x[:, 8] = rng.uniform(-0.9, 0.9, n)
    upright = [0.0, np.pi / 2]  # one difference of the blurs cannot be seen then
    for directions in (rng.uniform(-np.pi, np.pi, (n, 2)), np.tile(upright, (n, 1))):
        x[:, 2:4] = directions
        arguments = x, products, np.arange(10), *x_corner_step.DAMPING, 0.3, 0.03, 0.95, 0.3
        step = x_corner_step._step_unknowns
        mine, its = step.kernel(*arguments), step.reference(*arguments)
        assert np.isfinite(mine[0]).all()
        for one, other in zip(mine, its, strict=True):
            np.testing.assert_allclose(one[1:], other[1:], rtol=1e-6, atol=1e-12)


def test_long_arms_hold_no_grey_level_where_it_is() -> None:
    rng = np.random.default_rng(0)
    J = rng.normal(size=(1, 2000, 10))
    J[..., :6] *= 1e4  # pixels of 16 bits
    J[..., 2:4] *= 300.0  # so many px from the corner
    J[..., 6] = 1.0
    J[..., 9] = 5.0  # all of them are brighter
    x = np.array([[0.0, 0.0, 0.0, np.pi / 2, 1.0, 1.0, 100.0, 50.0, 0.0]])
    products = J.transpose(0, 2, 1) @ J
    arguments = x, products, np.arange(10), *x_corner_step.DAMPING, 0.3, 0.03, 0.95, 0.3
    stepped, _, _ = x_corner_step._step_unknowns.reference(*arguments)
    assert stepped[0, 6] == pytest.approx(105.0, abs=0.01)


@pytest.mark.parametrize(("arm", "thinned"), [(60.0, 1), (250.0, 4), (1000.0, 16)])
def test_the_same_pairs_of_pixels_tell_the_noise(arm: float, thinned: int) -> None:
    rng = np.random.default_rng(0)
    n = 3
    unknowns = np.tile([1050.0, 1050.0, 0.2, np.pi / 2, 2.0, 2.0, 100.0, 50.0, 0.0], (n, 1))
    unknowns[:, :2] += rng.uniform(-3, 3, (n, 2))
    model = XCornerModel(
        unknowns=unknowns,
        sign=np.ones(n),
        square_height=np.full((n, 2), 2 * arm),
        arm=np.full((n, 2), arm),
        plain_width=np.full((n, 2), arm),
        curvature=np.zeros((n, 2)),
        curvature_change=np.zeros((n, 2)),
        ink_spread=np.zeros(n),
        level_gradient=np.zeros((n, 2)),
        contrast_gradient=np.zeros((n, 2)),
        blur_gradient=np.zeros((n, 2, 2)),
        height_gradient=np.zeros((n, 2, 2)),
    )
    image = rng.integers(0, 256, (2100, 2100), dtype=np.uint8)
    arguments = image, model, True
    products, compiled = accumulate_normal_equations.kernel(*arguments)
    _, readable = accumulate_normal_equations.reference(*arguments)
    np.testing.assert_allclose(compiled[:, 0], readable[:, 0], rtol=5e-3)  # pixels at the borders
    np.testing.assert_allclose(compiled[:, 1], readable[:, 1], rtol=5e-3)
    np.testing.assert_allclose(compiled[:, 1], products[:, 6, 6] / 2 / thinned, rtol=0.02)


@pytest.mark.parametrize("bent", [0.0, 0.002, 0.02])
@pytest.mark.parametrize("longest", [1.0, 8.0, 60.0])
def test_support_holds_every_pixel_once_and_within_its_bounds(bent: float, longest: float) -> None:
    rng = np.random.default_rng(0)
    n = 200
    angle = (
        rng.uniform(0, np.pi, (n, 1)) + np.array([0, np.pi / 2]) + rng.uniform(-0.7, 0.7, (n, 2))
    )
    tangent = np.stack([np.cos(angle), np.sin(angle)], axis=2)
    normal = np.stack([-tangent[..., 1], tangent[..., 0]], axis=2)
    arm = longest * rng.uniform(0.2, 1, (n, 2))
    support = EdgeSupport(
        uv=rng.uniform(0, 300, (n, 2)),
        tangent=tangent,
        normal=normal,
        curvature=rng.normal(0, bent, (n, 2)),
        arm=arm,
        width=rng.uniform(0.7, np.maximum(arm / 2, 1.0)),
    )
    image = rng.integers(0, 256, (300, 300), dtype=np.uint8)
    compiled = import_module("calibgui.engine.kernels.edge_bands")
    packed, read = support.pack(), make_callable(compiled.read_bands)
    bounds = make_callable(compiled.bound_pixels), make_callable(compiled.bound_offsets)
    readable, _, counts = support.read(image)
    for i in range(n):
        most, farthest = (bound(packed[i : i + 1]) for bound in bounds)
        offset, grey = np.zeros((2, most), np.int32), np.zeros(most, np.float32)
        number = read(image, support.uv[i], packed[i], offset, grey)
        assert number <= most
        assert abs(offset).max() <= farthest
        pixels = offset[:, :number].T + np.rint(support.uv[i]).astype(np.int64)
        np.testing.assert_array_equal(grey[:number], image[pixels[:, 1], pixels[:, 0]])
        seen = set(map(tuple, pixels.tolist()))
        assert len(seen) == number
        if not bent:  # the readable ones in float32
            others = set(map(tuple, readable[i][counts[i] > 0].tolist()))
            assert len(seen ^ others) <= 1


def test_nothing_is_read_at_a_corner_that_is_not_finite() -> None:
    image = np.random.default_rng(0).integers(0, 256, (100, 100), dtype=np.uint8)
    unknowns = np.tile([50.0, 50.0, 0.2, np.pi / 2, 2.0, 2.0, 100.0, 50.0, 0.0], (3, 1))
    unknowns[0, 0], unknowns[1, 4] = np.nan, np.inf
    model = XCornerModel(
        unknowns=unknowns,
        sign=np.ones(3),
        square_height=np.full((3, 2), 20.0),
        arm=np.full((3, 2), 10.0),
        plain_width=np.full((3, 2), np.inf),
        curvature=np.zeros((3, 2)),
        curvature_change=np.zeros((3, 2)),
        ink_spread=np.zeros(3),
        level_gradient=np.zeros((3, 2)),
        contrast_gradient=np.zeros((3, 2)),
        blur_gradient=np.zeros((3, 2, 2)),
        height_gradient=np.zeros((3, 2, 2)),
    )
    products, odd_part = accumulate_normal_equations.kernel(image, model, True)
    alone = model.select(np.array([2]))
    expected, expected_odd = accumulate_normal_equations.kernel(image, alone, True)
    assert not products[:2].any()
    assert not odd_part[:2].any()
    np.testing.assert_array_equal(products[2:], expected)
    np.testing.assert_array_equal(odd_part[2:], expected_odd)
    assert expected_odd[0, 1] > 50

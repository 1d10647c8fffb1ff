"""The lens models: values from the printed formulae, derivatives, and inverses up to the fold."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from calibgui.engine.arrays import Array
from calibgui.engine.camera.model import Lens
from calibgui.engine.camera.models import MODELS
from calibgui.engine.camera.models.brown_conrady import BrownConrady
from calibgui.engine.camera.models.lucchese import Lucchese
from tests.engine.scenes import LENSES, central_differences, relative

STRONG = np.array([0.27, 0.2, -0.1, 2e-3, -3e-3, 0.5])
BARREL = np.array([-0.3, 0.11, 2e-3, -3e-3, -0.02])
POINTS = np.random.default_rng(3).uniform(-0.5, 0.5, size=(40, 2))
CASES = [
    pytest.param(Lucchese(), STRONG, id="lucchese"),
    pytest.param(Lucchese(), -0.5 * STRONG, id="lucchese, pincushion"),
    pytest.param(Lucchese(), np.zeros(6), id="lucchese, none"),
    pytest.param(BrownConrady(), BARREL, id="brown-conrady"),
    pytest.param(BrownConrady(), np.zeros(5), id="opencv, none"),
    *(pytest.param(MODELS[model], np.array(k), id=f"{model}, all") for model, k in LENSES.items()),
]


def test_correct_is_eq_9_to_11() -> None:
    k1, k2, k3, p1, p2, p3 = STRONG
    for x, y in POINTS:
        r2 = x**2 + y**2
        rho, q = k1 * r2 + k2 * r2**2 + k3 * r2**3, 1 + p3 * r2
        expected = [
            x + x * rho + q * (p1 * (r2 + 2 * x**2) + 2 * p2 * x * y),
            y + y * rho + q * (2 * p1 * x * y + p2 * (r2 + 2 * y**2)),
        ]
        got = Lucchese().correct(np.array([x, y]), STRONG).points
        np.testing.assert_allclose(got, expected, atol=1e-15)


def test_distort_is_opencvs() -> None:
    points = np.column_stack([POINTS, np.ones(len(POINTS))])
    expected = cv2.projectPoints(points, np.zeros(3), np.zeros(3), np.eye(3), BARREL)[0]
    np.testing.assert_allclose(
        BrownConrady().distort(POINTS, BARREL).points, expected.reshape(-1, 2), atol=1e-14
    )


@pytest.mark.parametrize("direction", ["correct", "distort"])
@pytest.mark.parametrize(("lens", "k"), CASES)
def test_derivatives_against_differences(lens: Lens, k: Array, direction: str) -> None:
    mapping = getattr(lens, direction)
    by_point = central_differences(lambda e: mapping(POINTS + e, k).points, np.zeros(2), 2e-4)
    by_k = central_differences(lambda c: mapping(POINTS, c).points, k, 2e-4)
    mapped = mapping(POINTS, k)
    # Near a fold the inverse's fifth derivatives reach 1e5: a short step, and h^4 times that.
    assert relative(mapped.by_point, by_point) < 1e-9
    assert relative(mapped.by_coefficients, by_k) < 1e-9


def test_models_keep_the_shape_of_stacks() -> None:
    for lens in MODELS.values():
        k = np.full(len(lens.names), 1e-3)
        for direction in (lens.correct, lens.distort):
            for shape in ((2,), (0, 2), (3, 4, 2)):
                mapped = direction(np.full(shape, 0.1), k)
                assert mapped.points.shape == shape
                assert mapped.by_point.shape == (*shape, 2)
                assert mapped.by_coefficients.shape == (*shape, len(k))


def regular(lens: Lucchese, k: Array, d: Array) -> Array:
    """Whether the map stays invertible, by a margin, all the way from the origin to d."""
    J = lens.correct(np.linspace(0, 1, 65)[:, None, None] * d, k).by_point
    det, trace = np.linalg.det(J), np.trace(J, axis1=-2, axis2=-1)
    return ((det > 0.05) & (trace > 0)).all(axis=0)


coefficients = st.builds(
    lambda *k: np.array(k),
    st.floats(-0.6, 0.6),
    st.floats(-0.4, 0.4),
    st.floats(-0.2, 0.2),
    st.floats(-5e-3, 5e-3),
    st.floats(-5e-3, 5e-3),
    st.floats(-1.0, 1.0),
)


@given(coefficients)
def test_the_inverse_returns_wherever_there_is_one(k: Array) -> None:
    lens = Lucchese()
    axis = np.linspace(-1.2, 1.2, 25)
    d = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
    inside = regular(lens, k, d)
    assume(inside.sum() > 10)
    d = d[inside]
    back = lens.distort(lens.correct(d, k).points, k).points
    # The residual converges to 1e-15; the margin 0.05 of the determinant enlarges it 20 times.
    np.testing.assert_allclose(back, d, atol=1e-13)


@given(coefficients)
def test_whatever_the_inverse_returns_is_one(k: Array) -> None:
    lens = Lucchese()
    axis = np.linspace(-3, 3, 25)
    n = np.stack(np.meshgrid(axis, axis), axis=-1)
    mapped = lens.distort(n, k)
    there = np.isfinite(mapped.points).all(axis=-1)
    np.testing.assert_allclose(lens.correct(mapped.points[there], k).points, n[there], atol=1e-12)
    assert np.isnan(mapped.by_point[~there]).all()
    assert np.isnan(mapped.by_coefficients[~there]).all()


def test_beyond_the_fold_there_is_no_point() -> None:
    """r (1 - 0.3 r^2) has its largest value, 2/3 r, at r = 1 / sqrt(0.9)."""
    k = np.array([-0.3, 0, 0, 0, 0, 0])
    end = 2 / 3 / np.sqrt(0.9)
    r = np.array([0.0, 0.5, 0.999, 0.999999, 1.000001, 1.001, 2.0, 30.0]) * end
    points = np.column_stack([0.6 * r, -0.8 * r])
    found = Lucchese().distort(points, k).points
    np.testing.assert_array_equal(np.isfinite(found[:, 0]), r < end)
    assert (np.hypot(*found[:4].T) < 1 / np.sqrt(0.9)).all()


def test_a_lens_that_unfolds_again_is_not_followed_there() -> None:
    """r (1 - 0.5 r^2 + 0.1 r^4) folds at r = 1, value 0.6, and grows again from sqrt(2)."""
    k = np.array([-0.5, 0.1, 0, 0, 0, 0])
    found = Lucchese().distort(np.array([[0.59, 0.0], [0.61, 0.0], [2.0, 0.0]]), k).points
    assert found[0, 0] < 1
    assert np.isnan(found[1:]).all()


def test_strong_barrel_reaches_the_corner() -> None:
    """The ideal point of a wide lens lies far beyond where its own polynomial folds."""
    k = np.array([0.2, 0.17, -0.08, 0, 0, 0])
    d = np.array([[0.9, 0.6], [1.0, 0.0]])
    n = Lucchese().correct(d, k).points
    np.testing.assert_allclose(Lucchese().distort(n, k).points, d, atol=1e-14)


def test_numbers_that_are_none_stay_none() -> None:
    for lens in MODELS.values():
        k = np.full(len(lens.names), 1e-3)
        assert np.isnan(lens.correct(np.array([np.nan, 0.1]), k).points).any()
        assert np.isnan(lens.distort(np.array([np.nan, 0.1]), k).points).any()

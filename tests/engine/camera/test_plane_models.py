"""The lens models of the plane z = 1: values from the printed formulae and from OpenCV, derivatives
of both directions, and inverses up to the fold or the pole."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from calibgui.engine.arrays import Array
from calibgui.engine.camera.models import MODELS
from calibgui.engine.camera.models.brown_conrady import BrownConrady, BrownConrady4
from calibgui.engine.camera.models.lucchese import Lucchese
from calibgui.engine.camera.models.pinhole import Pinhole
from calibgui.engine.camera.models.rational import Rational
from calibgui.engine.camera.models.thin_prism import ThinPrism
from calibgui.engine.camera.plane import PlaneLens
from tests.engine.scenes import LENSES, central_differences, relative

STRONG = np.array([0.27, 0.2, -0.1, 2e-3, -3e-3, 0.5])
BARREL = np.array([-0.3, 0.11, 2e-3, -3e-3, -0.02, 0.0])
RATIONAL = np.array([0.4, 0.2, 2e-3, -3e-3, 0.02, 0.7, 0.3, 0.05, 0.0])
THIN_PRISM = np.array([*RATIONAL[:-1], 3e-3, -2e-3, -4e-3, 5e-3, 0.0])
POINTS = np.random.default_rng(3).uniform(-0.5, 0.5, size=(40, 2))
CASES = [
    pytest.param(Lucchese(), STRONG, id="lucchese"),
    pytest.param(Lucchese(), -0.5 * STRONG, id="lucchese, pincushion"),
    pytest.param(BrownConrady(), BARREL, id="brown-conrady"),
    pytest.param(Rational(), RATIONAL, id="rational"),
    pytest.param(ThinPrism(), THIN_PRISM, id="thin-prism"),
    *(
        pytest.param(lens, np.array(LENSES[model]), id=f"{model}, sample")
        for model, lens in MODELS.items()
        if isinstance(lens, PlaneLens)
    ),
    *(
        pytest.param(lens, np.array(lens.defaults), id=f"{model}, none")
        for model, lens in MODELS.items()
        if isinstance(lens, PlaneLens)
    ),
]
OPENCV = [
    pytest.param(BrownConrady4(), BARREL[[0, 1, 2, 3, 5]], id="brown-conrady-4"),
    pytest.param(BrownConrady(), BARREL, id="brown-conrady"),
    pytest.param(Rational(), RATIONAL, id="rational"),
    pytest.param(ThinPrism(), THIN_PRISM, id="thin-prism"),
]


def project_with_opencv(k: Array, f: float) -> Array:
    """The image of `POINTS` on the plane z = 1, px, for OpenCV's coefficients; centre at 0."""
    rays = np.column_stack([POINTS, np.ones(len(POINTS))])
    projected = cv2.projectPoints(rays, np.zeros(3), np.zeros(3), np.diag([f, f, 1.0]), k)[0]
    return np.asarray(projected.reshape(-1, 2))


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


@pytest.mark.parametrize(("lens", "k"), OPENCV)
def test_distort_is_opencvs(lens: PlaneLens, k: Array) -> None:
    f = 1000.0
    np.testing.assert_allclose(
        f * lens.distort(POINTS, k).points, project_with_opencv(k[:-1], f), atol=1e-9
    )


@pytest.mark.parametrize(("lens", "k"), OPENCV)
def test_skew_shifts_a_point_along_its_row(lens: PlaneLens, k: Array) -> None:
    """u = cx + fx (x + skew y), as in Bouguet's toolbox."""
    x, y = project_with_opencv(k[:-1], 1.0).T
    k = np.array([*k[:-1], 0.03])
    expected = np.column_stack([x + 0.03 * y, y])
    np.testing.assert_allclose(lens.distort(POINTS, k).points, expected, atol=1e-14)
    np.testing.assert_allclose(lens.correct(expected, k).points, POINTS, atol=1e-14)


def test_a_pinhole_changes_nothing() -> None:
    for direction in (Pinhole().correct, Pinhole().distort):
        np.testing.assert_array_equal(direction(POINTS, np.zeros(0)).points, POINTS)


@pytest.mark.parametrize("direction", ["correct", "distort"])
@pytest.mark.parametrize(("lens", "k"), CASES)
def test_derivatives_against_differences(lens: PlaneLens, k: Array, direction: str) -> None:
    mapping = getattr(lens, direction)
    by_point = central_differences(lambda e: mapping(POINTS + e, k).points, np.zeros(2), 2e-4)
    mapped = mapping(POINTS, k)
    # Near a fold the inverse's fifth derivatives reach 1e5: a short step, and h^4 times that.
    assert relative(mapped.by_point, by_point) < 1e-9
    if k.size:
        by_k = central_differences(lambda c: mapping(POINTS, c).points, k, 2e-4)
        assert relative(mapped.by_coefficients, by_k) < 1e-9


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


def test_a_quotient_ends_at_its_pole() -> None:
    """1 / (1 - r^2 / 4) is infinite at r = 2, and negative beyond."""
    k = np.array([0, 0, 0, 0, 0, -0.25, 0, 0, 0])
    r = np.array([0.0, 1.0, 1.9, 1.99999, 2.00001, 3.0, 40.0])
    points = np.column_stack([0.6 * r, -0.8 * r])
    found = Rational().distort(points, k)
    for values in found:
        np.testing.assert_array_equal(np.isfinite(values).reshape(7, -1).all(axis=1), r < 2)
    measured = found.points[:4]
    np.testing.assert_allclose(np.hypot(*measured.T), r[:4] / (1 - r[:4] ** 2 / 4), rtol=1e-10)
    np.testing.assert_allclose(Rational().correct(measured, k).points, points[:4], atol=1e-13)


def test_beyond_a_second_pole_there_is_no_image_either() -> None:
    """1 / ((1 - r^2 / 4) (1 - r^2 / 9)) is positive again from r = 3 on."""
    k = np.array([0, 0, 0, 0, 0, -13 / 36, 1 / 36, 0, 0])
    n = np.array([[1.5, 0.0], [2.5, 0.0], [4.0, 0.0]])
    found = Rational().distort(n, k).points
    np.testing.assert_array_equal(np.isfinite(found[:, 0]), [True, False, False])
    np.testing.assert_allclose(Rational().correct(found[:1], k).points, n[:1], atol=1e-14)


@pytest.mark.parametrize("lens", [Rational(), ThinPrism()])
def test_a_quotient_folds_where_its_slope_is_0(lens: PlaneLens) -> None:
    """r (1 + 0.1 r^2) / (1 + 0.5 r^2 + 0.2 r^4) has its largest value where a table has it."""
    k = np.zeros(len(lens.names))
    k[[0, 5, 6]] = 0.1, 0.5, 0.2
    table = np.linspace(0, 4, 400001)
    curve = table * (1 + 0.1 * table**2) / (1 + 0.5 * table**2 + 0.2 * table**4)
    fold, largest = table[curve.argmax()], curve.max()
    share = np.array([0.5, 0.9, 0.99999, 1.00001, 1.2])
    measured = np.column_stack([0.6 * largest * share, 0.8 * largest * share])
    ideal = lens.correct(measured, k)
    np.testing.assert_array_equal(np.isfinite(ideal.points[:, 0]), share < 1)
    assert np.isnan(ideal.by_point[share > 1]).all()
    assert (np.hypot(*ideal.points[share < 1].T) < fold).all()
    np.testing.assert_allclose(lens.distort(ideal.points[:3], k).points, measured[:3], atol=1e-13)
    beyond = lens.distort(np.array([1.2 * fold, 0.0]), k).points  # a solver passes through here
    np.testing.assert_allclose(beyond, [np.interp(1.2 * fold, table, curve), 0.0], atol=1e-9)


quotients = st.builds(
    lambda *k: np.array([k[0], k[1], k[6], k[7], *k[2:6], k[8]]),
    *[st.floats(-0.1, 0.5)] * 3,
    *[st.floats(0.0, 1.0)] * 3,
    *[st.floats(-5e-3, 5e-3)] * 2,
    st.floats(-0.05, 0.05),
)


@given(quotients)
def test_the_inverse_of_a_quotient_returns_up_to_the_fold(k: Array) -> None:
    axis = np.linspace(-2, 2, 13)
    n = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
    path = Rational().distort(np.linspace(0, 1, 65)[:, None, None] * n, k).by_point
    n = n[(np.linalg.det(path) > 0.05).all(axis=0)]
    back = Rational().correct(Rational().distort(n, k).points, k).points
    np.testing.assert_allclose(back, n, atol=1e-12)


NEAR_ZERO = np.array(
    [-13.238113, -98.012135, 0, 0, 1357.782415, -13.050801, -102.363353, 1383.055291, 0.0]
)
"""A published calibration: numerator and denominator both come down to 3e-4 at r = 0.293, while
their quotient grows everywhere."""


def test_a_quotient_of_what_is_nearly_zero_has_its_rays() -> None:
    numerator, denominator = ([1.0, *NEAR_ZERO[places]] for places in ([0, 1, 4], [5, 6, 7]))
    r = np.linspace(0.0, 0.45, 4001)
    shares = [np.polynomial.polynomial.polyval(r**2, c) for c in (numerator, denominator)]
    measured = r * shares[0] / shares[1]
    assert (np.diff(measured) > 0).all()
    ideal = Rational().correct(np.column_stack([measured, 0 * r]), NEAR_ZERO).points
    np.testing.assert_allclose(ideal[:, 0], r, atol=1e-10)


@given(
    s=st.floats(0.02, 1.0),
    least=st.floats(-7.0, 0.0).map(lambda power: 10**power),
    slope=st.floats(-0.1, 0.5),
    shifts=st.tuples(*[st.floats(-0.2, 0.2)] * 3),
    tangential=st.tuples(*[st.floats(-2e-3, 2e-3)] * 2),
)
def test_a_quotient_that_grows_has_rays_everywhere(
    s: float, least: float, slope: float, shifts: Array, tangential: Array
) -> None:
    """The denominator comes down to `least` at r^2 = s, and the numerator near there."""

    def make_cubic(s: float, least: float, slope: float) -> Array:
        quadratic = np.array([s * s * (1 + least), -2 * s, 1.0])
        return np.convolve(quadratic / quadratic[0], [1.0, slope])

    D = make_cubic(s, least, slope / s)
    N = make_cubic(
        s * (1 + shifts[0] * least**0.75), least * (1 + shifts[1]), slope / s + shifts[2]
    )
    r = np.linspace(0.0, 1.5 * np.sqrt(s), 20001)
    values = [np.polynomial.polynomial.polyval(r**2, c) for c in (N, D)]
    assume((values[1] > 0).all())
    assume((np.diff(r * values[0] / values[1]) > 0).all())
    k = np.array([N[1], N[2], *tangential, N[3], *D[1:], 0.0])
    n = r[::40, None] * np.array([0.6, -0.8])
    mapped = Rational().distort(n, k)
    n = n[np.minimum.accumulate(np.linalg.det(mapped.by_point)) > 0]  # as far as the fold
    back = Rational().correct(mapped.points[: len(n)], k).points
    # Rounding of the denominator, 1e-15, is enlarged by 1 / least, and little by the slope.
    np.testing.assert_allclose(back, n, atol=1e-14 / least + 1e-11)

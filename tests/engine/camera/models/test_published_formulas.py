"""Lens models of wide views against their published formulas, coded here one point at a time."""

from __future__ import annotations

from math import acos, atan, atan2, cos, hypot, pi, sin, sqrt

import cv2
import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.camera.models import MODELS

MEI = np.array([1.44, -0.48, 0.06, 1e-3, -2e-3])
KANNALA_BRANDT = np.array([-0.051, -1.5e-4, -2.7e-3, 2.1e-4])


def spread_rays(limit: float, count: int = 60) -> Array:
    """Rays of several lengths up to `limit` degrees off the axis."""
    rng = np.random.default_rng(5)
    theta = np.deg2rad(np.linspace(0.01, limit, count))
    phi, length = rng.uniform(-pi, pi, count), rng.uniform(0.3, 30, count)
    across = np.sin(theta) * length
    return np.stack([across * np.cos(phi), across * np.sin(phi), np.cos(theta) * length], axis=-1)


def project_ucm(ray: Array, alpha: float) -> tuple[float, float]:
    """Usenko et al. 2018, eq. 8."""
    x, y, z = ray
    depth = alpha * sqrt(x * x + y * y + z * z) + (1 - alpha) * z
    return x / depth, y / depth


def project_eucm(ray: Array, alpha: float, beta: float) -> tuple[float, float]:
    """Usenko et al. 2018, eq. 19 and 20."""
    x, y, z = ray
    depth = alpha * sqrt(beta * (x * x + y * y) + z * z) + (1 - alpha) * z
    return x / depth, y / depth


def project_double_sphere(ray: Array, xi: float, alpha: float) -> tuple[float, float]:
    """Usenko et al. 2018, eq. 40 to 42."""
    x, y, z = ray
    d1 = sqrt(x * x + y * y + z * z)
    d2 = sqrt(x * x + y * y + (xi * d1 + z) ** 2)
    depth = alpha * d2 + (1 - alpha) * (xi * d1 + z)
    return x / depth, y / depth


def project_mei(
    ray: Array, xi: float, k1: float, k2: float, p1: float, p2: float
) -> tuple[float, float]:
    """Mei and Rives 2007, with the sphere first; p1 and p2 as Kalibr and OpenCV have them."""
    x, y, z = ray / np.linalg.norm(ray)
    x, y = x / (z + xi), y / (z + xi)
    r2 = x * x + y * y
    stretch = 1 + k1 * r2 + k2 * r2 * r2
    return (
        x * stretch + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
        y * stretch + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y,
    )


def project_decentered(
    ray: Array, k1: float, k2: float, k3: float, k4: float, p1: float, p2: float
) -> tuple[float, float]:
    """COLMAP's THIN_PRISM_FISHEYE without thin prisms, its coefficients in the order k1 to k4."""
    x, y, z = ray
    theta, phi = atan2(hypot(x, y), z), atan2(y, x)
    u, v = theta * cos(phi), theta * sin(phi)
    r2 = theta**2
    radial = k1 * r2 + k2 * r2**2 + k3 * r2**3 + k4 * r2**4
    return (
        u + u * radial + 2 * p1 * u * v + p2 * (r2 + 2 * u * u),
        v + v * radial + 2 * p2 * u * v + p1 * (r2 + 2 * v * v),
    )


@pytest.mark.parametrize(
    ("model", "function", "k", "limit"),
    [
        ("ucm", project_ucm, [0.62], 127),
        ("ucm", project_ucm, [0.4], 131),
        ("eucm", project_eucm, [0.58, 1.1], 137),
        ("eucm", project_eucm, [0.45, 0.8], 130),
        ("double-sphere", project_double_sphere, [-0.2, 0.59], 125),
        ("double-sphere", project_double_sphere, [0.3, 0.3], 131),
        ("mei", project_mei, MEI, 133),
        ("kannala-brandt-decentering", project_decentered, [*KANNALA_BRANDT, 1e-3, -2e-3], 179),
    ],
)
def test_projection_is_the_published_one(model: str, function, k, limit: float) -> None:  # type: ignore[no-untyped-def]
    rays = spread_rays(limit)
    expected = [function(ray, *k) for ray in rays]
    found = MODELS[model].project(rays, np.array(k)).points
    np.testing.assert_allclose(found, expected, rtol=1e-11, atol=1e-14)


def test_kannala_brandt_is_opencvs_both_ways() -> None:
    K = np.array([[1000.0, 0.0, 640.0], [0.0, 1000.0, 480.0], [0.0, 0.0, 1.0]])
    rays = spread_rays(88)
    pixels = cv2.fisheye.projectPoints(rays[:, None], np.zeros(3), np.zeros(3), K, KANNALA_BRANDT)[
        0
    ][:, 0]
    d = MODELS["kannala-brandt"].project(rays, KANNALA_BRANDT).points
    np.testing.assert_allclose(1000 * d + K[:2, 2], pixels, atol=1e-9)

    rays = spread_rays(75)
    pixels = 1000 * MODELS["kannala-brandt"].project(rays, KANNALA_BRANDT).points + K[:2, 2]
    criteria = (cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 100, 1e-14)
    plane = cv2.fisheye.undistortPoints(pixels[:, None], K, KANNALA_BRANDT, criteria=criteria)
    seen = MODELS["kannala-brandt"].unproject((pixels - K[:2, 2]) / 1000, KANNALA_BRANDT).rays
    np.testing.assert_allclose(seen[:, :2] / seen[:, 2:], plane[:, 0], rtol=1e-9)


def test_kannala_brandt_behind_90_degrees_is_the_polynomial_of_the_angle() -> None:
    k1, k2, k3, k4 = KANNALA_BRANDT
    for theta in np.deg2rad([90.0, 100.0, 120.0, 179.0]):
        length = theta + k1 * theta**3 + k2 * theta**5 + k3 * theta**7 + k4 * theta**9
        ray = np.array([0.6 * sin(theta), -0.8 * sin(theta), cos(theta)])
        found = MODELS["kannala-brandt"].project(ray, KANNALA_BRANDT).points
        np.testing.assert_allclose(found, [0.6 * length, -0.8 * length], atol=1e-13)


def test_ucm_is_unprojected_as_published() -> None:
    """Usenko et al. 2018, eq. 14 to 17, whose xi is alpha / (1 - alpha)."""
    alpha = 0.62
    xi = alpha / (1 - alpha)
    for u, v in np.random.default_rng(2).uniform(-1.2, 1.2, size=(30, 2)):
        mx, my = u * (1 - alpha), v * (1 - alpha)
        r2 = mx * mx + my * my
        factor = (xi + sqrt(1 + (1 - xi * xi) * r2)) / (1 + r2)
        found = MODELS["ucm"].unproject(np.array([u, v]), np.array([alpha])).rays
        np.testing.assert_allclose(found, [factor * mx, factor * my, factor - xi], atol=1e-14)


def test_double_sphere_is_unprojected_as_published() -> None:
    """Usenko et al. 2018, eq. 46 to 50."""
    xi, alpha = -0.2, 0.59
    for u, v in np.random.default_rng(2).uniform(-1.0, 1.0, size=(30, 2)):
        r2 = u * u + v * v
        mz = (1 - alpha**2 * r2) / (alpha * sqrt(1 - (2 * alpha - 1) * r2) + 1 - alpha)
        factor = (mz * xi + sqrt(mz * mz + (1 - xi * xi) * r2)) / (mz * mz + r2)
        found = MODELS["double-sphere"].unproject(np.array([u, v]), np.array([xi, alpha])).rays
        np.testing.assert_allclose(found, [factor * u, factor * v, factor * mz - xi], atol=1e-14)


@pytest.mark.parametrize("k1", [-0.4, -0.05, 0.1])
def test_division_is_unprojected_as_published(k1: float) -> None:
    """Fitzgibbon 2001: the undistorted point is the distorted one over 1 + k1 r^2."""
    for u, v in np.random.default_rng(2).uniform(-0.9, 0.9, size=(30, 2)):
        plane = np.array([u, v]) / (1 + k1 * (u * u + v * v))
        ray = np.append(plane, 1.0) / sqrt(1 + plane @ plane)
        found = MODELS["division"].unproject(np.array([u, v]), np.array([k1])).rays
        np.testing.assert_allclose(found, ray, atol=1e-15)


def test_scaramuzza_is_matlabs() -> None:
    """MATLAB's mapping coefficients in pixels; the angle's radius is a root of its polynomial."""
    a0, a2, a3, a4 = 350.0, -1.1e-3, 6e-7, -9e-10
    k = np.array([a2 * a0, a3 * a0**2, a4 * a0**3])
    for u, v in np.random.default_rng(2).uniform(-500, 500, size=(30, 2)):
        radius = hypot(u, v)
        ray = np.array([u, v, a0 + a2 * radius**2 + a3 * radius**3 + a4 * radius**4])
        ray /= np.linalg.norm(ray)
        found = MODELS["scaramuzza"].unproject(np.array([u, v]) / a0, k).rays
        np.testing.assert_allclose(found, ray, atol=1e-14)
        # The point's radius r is where the ray through it rises as this one does.
        roots = np.roots([a4, a3, a2, -ray[2] / hypot(ray[0], ray[1]), a0])
        r = min(roots[(roots.imag == 0) & (roots.real > 0)].real)
        projected = MODELS["scaramuzza"].project(7 * ray, k).points
        assert a0 * np.linalg.norm(projected) == pytest.approx(r, rel=1e-9)


def test_the_unified_models_are_one() -> None:
    """UCM is EUCM for beta = 1, the double sphere for xi = 0, and Mei's without distortion."""
    alpha = 0.62
    xi = alpha / (1 - alpha)
    rays = spread_rays(120)
    expected = MODELS["ucm"].project(rays, np.array([alpha])).points
    for model, k, focal in [
        ("eucm", [alpha, 1.0], 1.0),
        ("double-sphere", [0.0, alpha], 1.0),
        ("double-sphere", [xi, 0.0], 1 + xi),
        ("mei", [xi, 0.0, 0.0, 0.0, 0.0], 1 + xi),
    ]:
        lens = MODELS[model]
        found = lens.project(rays, np.array(k)).points
        np.testing.assert_allclose(focal * found, expected, rtol=1e-12, atol=1e-15)
        back = lens.unproject(expected / focal, np.array(k)).rays
        length = np.linalg.norm(rays, axis=-1, keepdims=True)
        np.testing.assert_allclose(back, rays / length, atol=1e-13)


def test_what_no_coefficient_bends_is_a_known_projection() -> None:
    """Equidistant, stereographic (UCM, alpha = 1/2), orthographic (alpha = 1) and perspective."""
    theta = np.deg2rad([0.0, 20.0, 60.0, 85.0])
    rays = np.stack([np.sin(theta), np.zeros(4), np.cos(theta)], axis=-1)
    for model, k, radius in [
        ("kannala-brandt", np.zeros(4), theta),
        ("kannala-brandt-decentering", np.zeros(6), theta),
        ("ucm", [0.5], 2 * np.tan(theta / 2)),
        ("ucm", [1.0], np.sin(theta)),
        ("ucm", [0.0], np.tan(theta)),
        ("division", [0.0], np.tan(theta)),
        ("division", [-0.25], 2 * np.tan(theta / 2)),
        ("scaramuzza", np.zeros(3), np.tan(theta)),
        ("scaramuzza", [-0.25, 0.0, 0.0], 2 * np.tan(theta / 2)),
    ]:
        found = MODELS[model].project(rays, np.array(k)).points
        np.testing.assert_allclose(found[:, 0], radius, rtol=1e-13)


def find_ucm_limit(alpha: float) -> float:
    return acos(-alpha / (1 - alpha) if alpha <= 0.5 else -(1 - alpha) / alpha)


def find_double_sphere_limit(xi: float, alpha: float) -> float:
    """Where (c + xi)^2 = w1^2 (1 + 2 xi c + xi^2), c = cos(theta): the unified model's limit.

    Usenko et al. 2018, eq. 43 to 45, and Basalt stop some degrees before.
    """
    w1 = alpha / (1 - alpha) if alpha <= 0.5 else (1 - alpha) / alpha
    limit = acos(-xi * (1 - w1 * w1) - w1 * sqrt(1 - xi * xi * (1 - w1 * w1)))
    assert limit > acos(-(w1 + xi) / sqrt(2 * w1 * xi + xi * xi + 1))
    return limit


@pytest.mark.parametrize(
    ("model", "k", "limit"),
    [
        ("ucm", [0.62], find_ucm_limit(0.62)),
        ("ucm", [0.3], find_ucm_limit(0.3)),
        ("ucm", [0.0], pi / 2),
        ("ucm", [1.0], pi / 2),
        # Z = -q w meets the ray where tan^2 = (1 / q^2 - 1) / beta.
        ("eucm", [0.6, 1.3], pi - atan(sqrt((1.5**2 - 1) / 1.3))),
        ("double-sphere", [-0.2, 0.59], find_double_sphere_limit(-0.2, 0.59)),
        ("double-sphere", [0.3, 0.3], find_double_sphere_limit(0.3, 0.3)),
        ("double-sphere", [3.07, 0.02], acos(-1 / 3.07)),
        ("mei", MEI, acos(-1 / MEI[0])),
        ("mei", [0.8, 0.0, 0.0, 0.0, 0.0], acos(-0.8)),
        # (d, 1 + k1 d^2) at d = 1 / sqrt(k1).
        ("division", [0.2], atan(1 / (2 * sqrt(0.2)))),
        ("division", [0.0], pi / 2),
        ("scaramuzza", [0.2, 0.0, 0.0], atan(1 / (2 * sqrt(0.2)))),
        # 1 - 2 a3 d^3 = 0, where the ray is (d, 1.5).
        ("scaramuzza", [0.0, 0.1, 0.0], atan(5 ** (1 / 3) / 1.5)),
    ],
)
def test_rays_beyond_the_limit_have_no_point(model: str, k: list[float], limit: float) -> None:
    theta = np.array([0.0, limit - 1e-5, limit + 1e-5, (limit + pi) / 2, pi])
    rays = np.stack([0.8 * np.sin(theta), -0.6 * np.sin(theta), np.cos(theta)], axis=-1)
    points, by_ray, by_k = MODELS[model].project(rays, np.array(k))
    known = [True, True, False, False, False]
    np.testing.assert_array_equal(np.isfinite(points).all(axis=-1), known)
    np.testing.assert_array_equal(np.isfinite(by_ray).all(axis=(-1, -2)), known)
    np.testing.assert_array_equal(np.isfinite(by_k).all(axis=(-1, -2)), known)
    assert np.isnan(by_ray[2:]).all()
    assert np.isnan(by_k[2:]).all()


@pytest.mark.parametrize(
    ("model", "k", "limit"),
    [
        # theta - theta^3 / 12 is largest at theta = 2, where it is 4/3.
        ("kannala-brandt", [-1 / 12, 0.0, 0.0, 0.0], 4 / 3),
        ("kannala-brandt-decentering", [-1 / 12, 0.0, 0.0, 0.0, 0.0, 0.0], 4 / 3),
        # It grows again beyond, but that is another branch.
        ("kannala-brandt", [-1 / 12, 0.0, 0.0, 2e-5], None),
        ("kannala-brandt", [0.0, 0.0, 0.0, 0.0], pi),
        ("kannala-brandt-decentering", [0.0, 0.0, 0.0, 0.0, 0.0, 0.0], pi),
        ("ucm", [0.62], 1 / sqrt(0.24)),
        ("eucm", [0.62, 1.3], 1 / sqrt(0.24 * 1.3)),
        ("division", [0.2], 1 / sqrt(0.2)),
        ("scaramuzza", [0.0, 0.1, 0.0], 5 ** (1 / 3)),
        ("mei", [0.7, -1 / 3, 0.0, 0.0, 0.0], 2 / 3),
    ],
)
def test_points_beyond_the_limit_have_no_ray(
    model: str, k: list[float], limit: float | None
) -> None:
    if limit is None:
        theta = np.linspace(0, 2.3, 200001)
        limit = float(np.max(theta + k[0] * theta**3 + k[3] * theta**9))
    radius = limit * np.array([0.0, 0.5, 1 - 1e-5, 1 + 1e-5, 1.5, 40.0])
    d = np.stack([0.8 * radius, -0.6 * radius], axis=-1)
    rays, by_point, by_k = MODELS[model].unproject(d, np.array(k))
    known = radius < limit
    np.testing.assert_array_equal(np.isfinite(rays).all(axis=-1), known)
    np.testing.assert_array_equal(np.isfinite(by_point).all(axis=(-1, -2)), known)
    assert np.isnan(rays[~known]).all()
    assert np.isnan(by_point[~known]).all()
    assert np.isnan(by_k[~known]).all()

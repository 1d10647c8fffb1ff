"""The splined model: against SciPy's B-splines, mrcal, differences, and its own inverse."""

from __future__ import annotations

import numpy as np
import pytest
import scipy

from calibgui.engine.arrays import Array
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import MODELS, find_model, resolve_model_id
from calibgui.engine.camera.models.splined_stereographic import (
    SplinedStereographic,
    rays_from_stereographic,
    stereographic_from_rays,
)
from calibgui.engine.camera.projection import pixels_from_rays, rays_from_pixels
from calibgui.engine.errors import CalibrationError
from tests.engine.scenes import central_differences, relative
from tests.formats.readers import in_other_python

WIDE = SplinedStereographic(10, 7, 200)
"""100 degrees to either side, 114 up to the outermost control points; 69 and 92 up and down."""
NARROW = SplinedStereographic(6, 5, 60)
LENSES = [WIDE, NARROW]
_MRCAL = """
import json, sys
import mrcal
import numpy as np

model = "LENSMODEL_SPLINED_STEREOGRAPHIC_order=3_Nx=%d_Ny=%d_fov_x_deg=%d" % tuple(
    json.loads(sys.argv[1]))
intrinsics, rays = np.array(json.loads(sys.argv[2])), np.array(json.loads(sys.argv[3]))
count = len(rays) // 2
frames = np.tile([0.1, 0.1, 0.0, 0.0, 0.0, 1.0], (3, 1))
which = np.array([[view, 0, -1] for view in range(3)], dtype=np.int32)
_, x, _, _ = mrcal.optimizer_callback(
    intrinsics[None], np.zeros((0, 6)), frames, np.zeros((0, 3)), np.ones((3, 4, 5, 3)), which,
    None, None, model, imagersizes=np.array([[1000, 800]], dtype=np.int32),
    calibration_object_spacing=0.01, do_optimize_intrinsics_core=False,
    do_optimize_calobject_warp=False, do_apply_regularization=True, no_factorization=True)
seen = mrcal.project(rays, model, intrinsics)
back = mrcal.unproject(seen, model, intrinsics, normalize=True)
print(json.dumps({
    "seen": seen.tolist(),
    "back": back.tolist(),
    "knots": [knots.tolist() for knots in mrcal.knots_for_splined_models(model)],
    "pull": float(np.sum(x[3 * 4 * 5 * 2:] ** 2)),
}))
"""


def make_coefficients(lens: SplinedStereographic) -> Array:
    return np.random.default_rng(2).normal(0, 0.05 * lens.pitch, len(lens.names))


def spread_rays(lens: SplinedStereographic, count: int = 60, part: float = 0.99) -> Array:
    """Rays of several lengths all over the surface, the first on the axis."""
    rng = np.random.default_rng(4)
    u = part * lens.edge * rng.uniform(-1, 1, (count, 2))
    u[0] = 0.0
    return rays_from_stereographic(u)[0] * rng.uniform(0.5, 20, (count, 1))


def evaluate_by_scipy(lens: SplinedStereographic, ray: Array, k: Array) -> Array:
    """The image of a ray by the printed formulas, from all control points."""
    theta, phi = np.arctan2(np.hypot(*ray[:2]), ray[2]), np.arctan2(ray[1], ray[0])
    u = 2 * np.tan(theta / 2) * np.array([np.cos(phi), np.sin(phi)])
    per_u = (lens.Nx - 3) / (2 * 2 * np.tan(np.deg2rad(lens.fov) / 4))
    weights = [
        # The basis function of control point i reaches from i - 2 to i + 2; scipy, too, continues
        # the outermost polynomials.
        scipy.interpolate.BSpline(np.arange(-2.0, count + 2.0), np.eye(count), 3)(
            u[axis] * per_u + (count - 1) / 2
        )
        for axis, count in enumerate((lens.Nx, lens.Ny))
    ]
    return u + np.einsum("i,j,jik->k", *weights, k.reshape(lens.Ny, lens.Nx, 2))


@pytest.mark.parametrize("lens", LENSES)
def test_the_surface_is_scipys(lens: SplinedStereographic) -> None:
    k, rays = make_coefficients(lens), spread_rays(lens)
    expected = [evaluate_by_scipy(lens, ray, k) for ray in rays]
    np.testing.assert_allclose(lens.project(rays, k).points, expected, atol=2e-15)


@pytest.mark.parametrize("lens", LENSES)
def test_it_is_mrcals_model(lens: SplinedStereographic) -> None:
    k, rays = make_coefficients(lens), spread_rays(lens)
    params = np.concatenate([[900.0, 910.0, 500.0, 400.0], k])
    theirs = in_other_python(
        _MRCAL,
        [lens.Nx, lens.Ny, lens.fov],
        params.tolist(),
        rays.tolist(),
        needs="import mrcal",
    )
    camera = Camera((1000, 800), params, lens.id)
    seen = pixels_from_rays(rays, camera)
    np.testing.assert_allclose(seen, theirs["seen"], atol=1e-9)
    # mrcal stops its iteration at a millionth of a pixel or so.
    np.testing.assert_allclose(rays_from_pixels(seen, camera), theirs["back"], atol=1e-7)
    knots = lens.locate_control_points()
    np.testing.assert_allclose(knots[0, :, 0], theirs["knots"][0], atol=1e-14)
    np.testing.assert_allclose(knots[:, 0, 1], theirs["knots"][1], atol=1e-14)
    assert k @ lens.compute_stiffness(3 * 4 * 5) @ k == pytest.approx(theirs["pull"], rel=1e-12)


@pytest.mark.parametrize("lens", LENSES)
def test_derivatives_against_differences(lens: SplinedStereographic) -> None:
    k = make_coefficients(lens)
    rays = rays_from_stereographic(stereographic_from_rays(spread_rays(lens, part=0.97))[0])[0]
    imaged = lens.project(rays, k)
    # The third derivative jumps between cells: differences across an edge are h^2 off.
    by_ray = central_differences(lambda e: lens.project(rays + e, k).points, np.zeros(3), 2e-5)
    by_k = central_differences(lambda c: lens.project(rays, c).points, k, 1e-2)
    assert relative(imaged.by_ray, by_ray) < 1e-8
    assert relative(imaged.by_coefficients, by_k) < 1e-12
    d = imaged.points
    seen = lens.unproject(d, k)
    by_d = central_differences(lambda e: lens.unproject(d + e, k).rays, np.zeros(2), 2e-5)
    by_k = central_differences(lambda c: lens.unproject(d, c).rays, k, 2e-5)
    assert relative(seen.by_point, by_d) < 1e-8
    assert relative(seen.by_coefficients, by_k) < 1e-8
    np.testing.assert_allclose((imaged.by_ray @ rays[..., None])[..., 0], 0, atol=1e-14)


def test_derivatives_on_the_axis_at_90_degrees_and_beyond() -> None:
    k = make_coefficients(WIDE)
    rays = np.array([[0, 0, 2.0], [1e-9, 0, 1], [1, 0, 0], [-0.9, 0.1, 0], [1, 0.2, -0.25]])
    imaged = WIDE.project(rays, k)
    expected = [evaluate_by_scipy(WIDE, ray, k) for ray in rays]
    np.testing.assert_allclose(imaged.points, expected, atol=2e-15)
    by_ray = central_differences(lambda e: WIDE.project(rays + e, k).points, np.zeros(3), 1e-4)
    assert relative(imaged.by_ray, by_ray) < 1e-9
    unit = rays / np.linalg.norm(rays, axis=1, keepdims=True)
    np.testing.assert_allclose(WIDE.unproject(imaged.points, k).rays, unit, atol=1e-15)


@pytest.mark.parametrize("lens", LENSES)
def test_the_inverse_returns_up_to_the_edge(lens: SplinedStereographic) -> None:
    k = make_coefficients(lens)
    u = np.stack(np.meshgrid(*(np.linspace(-edge, edge, 41) for edge in lens.edge)), axis=-1)
    rays = rays_from_stereographic(u)[0]
    d = lens.project_points(rays, k)
    back, by_d = lens.unproject_points(d, k)
    np.testing.assert_allclose(back, rays, atol=1e-12)
    np.testing.assert_allclose(lens.project_points(back, k), d, atol=1e-12)
    np.testing.assert_array_equal(by_d, lens.unproject(d, k).by_point)


def test_a_strong_correction_is_inverted() -> None:
    """A perspective lens of 140 degrees is far from the stereographic projection."""
    lens = SplinedStereographic(16, 12, 150)
    u = np.stack(np.meshgrid(*(np.linspace(-e, e, 60) for e in lens.edge)), axis=-1).reshape(-1, 2)
    rays = rays_from_stereographic(u)[0]
    d = np.where(rays[:, 2:] > np.cos(np.deg2rad(80)), rays[:, :2] / rays[:, 2:], np.nan)
    k = lens.fit_to_rays(rays, d)
    inner = rays[:, 2] > np.cos(np.deg2rad(70))
    seen = lens.project_points(rays[inner], k)
    np.testing.assert_allclose(seen, d[inner], atol=0.05)
    np.testing.assert_allclose(lens.unproject_points(seen, k)[0], rays[inner], atol=1e-12)


def test_beyond_the_control_points_there_is_nothing() -> None:
    k = make_coefficients(NARROW)
    for u in ([1.01, 0.0], [0.3, -1.01], [9.0, 9.0]):
        ray = rays_from_stereographic(u * NARROW.edge)[0]
        for part in NARROW.project(ray, k):
            assert np.isnan(part).all()
        assert np.isnan(NARROW.project_points(ray, k)).all()
    for backwards in ([0.0, 0.0, 0.0], [0.0, 0.0, -1.0], [np.nan, 0.0, 1.0]):
        assert np.isnan(WIDE.project(np.array(backwards), make_coefficients(WIDE)).points).all()
    for part in NARROW.unproject(np.array([5.0, 0.0]), k):
        assert np.isnan(part).all()
    assert np.isnan(NARROW.unproject(np.array([np.nan, 0.0]), k).rays).all()


def test_behind_a_fold_there_are_no_rays() -> None:
    """d = u - 0.6 u^2 along x, but for a constant, grows up to 5/12 at u = 5/6 and then turns."""
    knots = WIDE.locate_control_points()
    k = np.stack([-0.6 * knots[..., 0] ** 2, 0 * knots[..., 1]], axis=-1).ravel()
    shift = WIDE.project_points(np.array([0.0, 0.0, 1.0]), k)
    u = np.array([[-1.0, 0.2], [0.5, 0.2], [0.83, 0.0], [0.84, 0.0], [1.1, 0.2]])
    d = WIDE.project_points(rays_from_stereographic(u)[0], k)
    np.testing.assert_allclose((d - shift)[:, 0], u[:, 0] - 0.6 * u[:, 0] ** 2, atol=1e-14)
    d = np.vstack([d, np.add(shift, [5 / 12 + 1e-6, 0.0])])
    seen = WIDE.unproject(d, k)
    before = np.minimum(u, [5 / 3, 9.0] - u * [1, 0])
    np.testing.assert_allclose(seen.rays[:5], rays_from_stereographic(before)[0], atol=1e-12)
    for part in seen:
        assert np.isnan(part[5]).all()


def test_the_sheet_around_the_axis_is_inverted() -> None:
    """A surface that folds twice images other rays at the same places; none of them is meant."""
    k = np.zeros((WIDE.Ny, WIDE.Nx, 2))
    k[:, WIDE.locate_control_points()[0, :, 0] > 0.55 * WIDE.edge[0], 0] = -1.7
    at = np.stack(np.meshgrid(np.linspace(-0.7, 0.2, 30), np.linspace(-0.5, 0.5, 20)), axis=-1)
    rays = rays_from_stereographic((at * WIDE.edge).reshape(-1, 2))[0]
    images = WIDE.project_points(rays, k.ravel())
    beyond = rays_from_stereographic(WIDE.edge * [0.97, 0.1])[0]
    other = WIDE.project_points(beyond, k.ravel())
    assert np.hypot(*(images - other).T).min() < WIDE.pitch  # the second sheet lies over the first
    np.testing.assert_allclose(WIDE.unproject_points(images, k.ravel())[0], rays, atol=1e-12)


def test_a_mirrored_image_has_no_rays() -> None:
    k = -2 * NARROW.locate_control_points().ravel()
    ray = np.array([0.1, 0.05, 1.0])
    d = NARROW.project_points(ray, k)
    np.testing.assert_allclose(d, -stereographic_from_rays(ray)[0], atol=1e-15)
    for part in NARROW.unproject(d, k):
        assert np.isnan(part).all()


def test_it_keeps_the_shape_of_stacks() -> None:
    k = make_coefficients(NARROW)
    for shape in ((), (0,), (3, 4)):
        rays = np.broadcast_to([0.1, 0.05, 1.0], (*shape, 3))
        imaged = NARROW.project(rays, k)
        assert imaged.points.shape == (*shape, 2)
        assert imaged.by_ray.shape == (*shape, 2, 3)
        assert imaged.by_coefficients.shape == (*shape, 2, 60)
        seen = NARROW.unproject(imaged.points, k)
        assert seen.rays.shape == (*shape, 3)
        assert seen.by_point.shape == (*shape, 3, 2)
        assert seen.by_coefficients.shape == (*shape, 3, 60)


def test_a_fit_finds_the_surface_where_there_are_rays() -> None:
    """Left of the middle: there the coefficients come back, elsewhere they stay small."""
    k, rays = make_coefficients(WIDE), spread_rays(WIDE, 3000)
    rays = rays[rays[:, 0] < 0]
    fitted = WIDE.fit_to_rays(rays, WIDE.project_points(rays, k))
    far_left = np.arange(WIDE.Nx) < WIDE.Nx // 2 - 1
    miss = (fitted - k).reshape(WIDE.Ny, WIDE.Nx, 2)
    assert np.abs(miss[1:-1, far_left][:, 1:]).max() < 1e-3 * WIDE.pitch
    assert np.abs(fitted.reshape(miss.shape)[:, -2:]).max() < 1e-12
    again = WIDE.fit_to_rays(np.vstack([rays, rays[:1]]), np.full((len(rays) + 1, 2), np.nan))
    np.testing.assert_array_equal(again, 0.0)


def test_a_fit_is_the_dense_least_squares_solution() -> None:
    rng = np.random.default_rng(8)
    rays, zero = spread_rays(NARROW, 300), np.zeros(len(NARROW.names))
    target = NARROW.project_points(rays, make_coefficients(NARROW)) + rng.normal(0, 1e-3, (300, 2))
    start = NARROW.project(rays, zero)
    A = start.by_coefficients.reshape(600, -1)
    Q = 1e-6 * NARROW.compute_stiffness(300)
    expected = np.linalg.solve(A.T @ A + Q, A.T @ (target - start.points).ravel())
    np.testing.assert_allclose(NARROW.fit_to_rays(rays, target), expected, atol=1e-10)


def test_ids_name_the_numbers() -> None:
    lens = find_model("splined-stereographic-30x20-150")
    assert isinstance(lens, SplinedStereographic)
    assert (lens.Nx, lens.Ny, lens.fov, len(lens.names)) == (30, 20, 150, 1200)
    assert lens.names[:3] == ("dx_0_0", "dy_0_0", "dx_0_1")
    assert lens.names[-1] == "dy_19_29"
    assert find_model("splined-stereographic-30x20-150") is lens
    assert resolve_model_id("splined-stereographic-08x06-090") == "splined-stereographic-8x6-90"
    default = MODELS["splined-stereographic"]
    assert isinstance(default, SplinedStereographic)
    assert default.id == "splined-stereographic-16x11-120"
    assert resolve_model_id("splined-stereographic") == "splined-stereographic"


@pytest.mark.parametrize(
    "model",
    [
        "splined-stereographic-3x9-90",
        "splined-stereographic-99x99-90",
        "splined-stereographic-9x9-360",
        "splined-stereographic-9x9-0",
        "splined-stereographic-9x9",
        "splined-stereographic-9x9-90.5",
        "splined",
    ],
)
def test_ids_that_name_no_model(model: str) -> None:
    with pytest.raises(CalibrationError, match="There is no"):
        find_model(model)

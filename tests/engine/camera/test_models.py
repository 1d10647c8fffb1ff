"""What holds for every lens model: two maps of rays and points, inverse to each other, with their
derivatives, on the axis, at 90 degrees and beyond, as far as the lens of `LENSES` sees."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.camera.model import Lens
from calibgui.engine.camera.models import MODELS, find_model, suggest_model
from calibgui.engine.camera.models.lucchese import Lucchese
from calibgui.engine.camera.plane import PlaneLens
from calibgui.engine.errors import CalibrationError
from tests.engine.scenes import LENSES, central_differences

AZIMUTHS = np.linspace(0, 2 * np.pi, 16, endpoint=False) + 0.1
every_model = pytest.mark.parametrize("model", list(LENSES))
EPSILON = np.finfo(float).eps


def rays_at(angles: Array | float, azimuths: Array = AZIMUTHS) -> Array:
    """(n, m, 3) rays at n angles to the axis and m azimuths, radians."""
    theta, phi = np.atleast_1d(angles)[:, None], azimuths[None, :]
    return np.stack(
        [np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta) + 0 * phi], axis=-1
    )


def sample(model: str) -> tuple[Lens, Array]:
    """A model, and coefficients with all of it at work."""
    return find_model(model), np.array(LENSES[model], dtype=np.float64)


@cache
def widest(model: str) -> float:
    """The largest angle to the axis up to which the sample lens is one-to-one, radians.

    There the derivative by the direction of the ray changes its orientation, or ends.
    """
    lens, k = sample(model)
    angles = np.deg2rad(np.arange(0.05, 180, 0.1))
    phi, theta = np.meshgrid(AZIMUTHS, angles)
    outward = np.stack(
        [np.cos(theta) * np.cos(phi), np.cos(theta) * np.sin(phi), -np.sin(theta)], axis=-1
    )
    around = np.stack([-np.sin(phi), np.cos(phi), 0 * phi], axis=-1)
    by_ray = lens.project(rays_at(angles), k).by_ray
    (a, b), (c, d) = np.moveaxis(by_ray @ np.stack([outward, around], axis=-1), (-2, -1), (0, 1))
    inside = (a * d - b * c > 0).all(axis=1)
    return float(np.pi if inside.all() else angles[np.argmin(inside)])


def seen(model: str, share: float) -> Array:
    """(n, 16, 3) rays on the axis, near it, and up to a share of the largest angle."""
    angles = np.array([0.0, 1e-9, 1e-5, *np.linspace(0.02, 1.0, 12) * share * widest(model)])
    if share * widest(model) > np.pi / 2:
        angles = np.append(angles, [np.pi / 2 - 1e-9, np.pi / 2, np.pi / 2 + 1e-9])
    rays = rays_at(angles)
    rays[angles == np.pi / 2, :, 2] = 0.0
    return rays


def check(analytic: Array, f: Callable[[Array], Array], x: Array) -> None:
    """Compare derivatives (angles, azimuths, ..., n) of f at x (n,) with central differences.

    The steps move no point by more than 1e-4; the differences are off by its fourth power, and by
    the rounding of what they are the differences of. Each angle has its own scale, as derivatives
    grow by orders of magnitude towards the edge of a wide lens.
    """
    most = np.abs(analytic).max(axis=tuple(range(analytic.ndim - 1)), initial=1.0)
    numeric = central_differences(f, x, 1e-4 / most) if x.size else analytic
    for i, (ours, theirs) in enumerate(zip(analytic / most, numeric / most, strict=True)):
        limit = 1e-8 * np.abs(theirs).max(initial=0.0) + 1e-10
        assert np.abs(ours - theirs).max(initial=0.0) < limit, f"angle {i}"


@pytest.mark.parametrize(
    ("name", "model"),
    [("fisheye", "kannala-brandt"), ("plumb_bob", "brown-conrady"), ("kanala", "kannala-brandt")],
)
def test_a_name_that_others_have_or_that_is_mistyped_is_understood(name: str, model: str) -> None:
    with pytest.raises(CalibrationError) as caught:
        find_model(name)
    assert caught.value.hint.startswith(f"Did you mean {model}? Choose from ")
    assert suggest_model("thing") == ""


def test_there_is_a_lens_of_every_model() -> None:
    for model in MODELS:
        assert any(name.startswith(model) for name in LENSES), model


@every_model
def test_names_and_what_is_said_of_them(model: str) -> None:
    lens, k = sample(model)
    assert lens.title
    assert len(k) == len(lens.names) == len(set(lens.names)) == len(lens.powers)
    assert len(lens.defaults) == len(lens.names)
    assert set(lens.asymmetric) <= set(lens.names)
    assert set(lens.held) <= {*lens.names, "fx", "fy", "cx", "cy"}


@every_model
def test_wide_models_see_beyond_90_degrees(model: str) -> None:
    lens, _ = sample(model)
    if isinstance(lens, PlaneLens):
        assert widest(model) < np.deg2rad(90.1)
    else:
        assert widest(model) > np.deg2rad(60)
    if model in ("kannala-brandt", "ucm", "eucm", "double-sphere", "mei", "scaramuzza"):
        assert widest(model) > np.deg2rad(100)


@every_model
def test_project_and_unproject_are_inverse(model: str) -> None:
    lens, k = sample(model)
    rays = seen(model, 0.97)
    imaged = lens.project(rays, k)
    back = lens.unproject(imaged.points, k)
    np.testing.assert_allclose(np.linalg.norm(back.rays, axis=-1), 1.0, atol=4 * EPSILON)
    np.testing.assert_allclose(back.rays, rays, atol=1e-12)
    again = lens.project(back.rays, k).points
    scale = 1 + np.abs(imaged.points).max(axis=-1, keepdims=True)  # a plane's d grows with tan
    np.testing.assert_allclose((again - imaged.points) / scale, 0.0, atol=1e-12)


@every_model
def test_derivatives_of_the_inverse_undo_those_of_the_projection(model: str) -> None:
    lens, k = sample(model)
    imaged = lens.project(seen(model, 0.95), k)
    back = lens.unproject(imaged.points, k)
    product = imaged.by_ray @ back.by_point
    np.testing.assert_allclose(product, np.broadcast_to(np.eye(2), product.shape), atol=1e-10)
    change = imaged.by_ray @ back.by_coefficients + imaged.by_coefficients
    scale = np.abs(imaged.by_coefficients).max(initial=1.0)
    np.testing.assert_allclose(change / scale, 0.0, atol=1e-10)
    radial = np.swapaxes(back.rays[..., None], -1, -2) @ back.by_point  # rays stay of length 1
    np.testing.assert_allclose(radial, 0.0, atol=1e-12)


@every_model
def test_only_the_direction_of_a_ray_counts(model: str) -> None:
    lens, k = sample(model)
    rays = seen(model, 0.95)
    imaged = lens.project(rays, k)
    scale = np.abs(imaged.by_ray).max(axis=(-1, -2), keepdims=True)[..., 0]
    along = (imaged.by_ray @ rays[..., None])[..., 0]
    np.testing.assert_allclose(along / scale, 0.0, atol=1e-14)
    for length in (1e-3, 700.0):
        longer = lens.project(length * rays, k)
        np.testing.assert_allclose(longer.points, imaged.points, rtol=1e-12, atol=1e-14)
        np.testing.assert_allclose(length * longer.by_ray / scale[..., None],
                                   imaged.by_ray / scale[..., None], atol=1e-12)  # fmt: skip
        np.testing.assert_allclose(
            longer.by_coefficients, imaged.by_coefficients, rtol=1e-11, atol=1e-13
        )


@every_model
def test_derivatives_of_the_projection_against_differences(model: str) -> None:
    lens, k = sample(model)
    rays = seen(model, 0.85)
    imaged = lens.project(rays, k)
    check(imaged.by_ray, lambda e: lens.project(rays + e, k).points, np.zeros(3))
    check(imaged.by_coefficients, lambda c: lens.project(rays, c).points, k)


@every_model
def test_derivatives_of_the_inverse_against_differences(model: str) -> None:
    lens, k = sample(model)
    d = lens.project(seen(model, 0.85), k).points
    back = lens.unproject(d, k)
    check(back.by_point, lambda e: lens.unproject(d + e, k).rays, np.zeros(2))
    check(back.by_coefficients, lambda c: lens.unproject(d, c).rays, k)


@every_model
def test_the_axis_is_imaged_at_the_centre(model: str) -> None:
    lens, k = sample(model)
    np.testing.assert_array_equal(lens.project(np.array([0.0, 0.0, 2.0]), k).points, [0.0, 0.0])
    np.testing.assert_array_equal(lens.unproject(np.zeros(2), k).rays, [0.0, 0.0, 1.0])


@every_model
def test_a_lens_without_its_asymmetric_coefficients_is_symmetric(model: str) -> None:
    lens, k = sample(model)
    k[[name in lens.asymmetric for name in lens.names]] = 0.0
    angles = np.linspace(0.05, 0.9, 9) * min(widest(model), 1.2)
    d = lens.project(rays_at(angles), k).points
    radius = np.linalg.norm(d, axis=-1)
    np.testing.assert_allclose(radius, np.broadcast_to(radius[:, :1], radius.shape), rtol=1e-12)
    np.testing.assert_allclose(np.arctan2(d[..., 1], d[..., 0]) % (2 * np.pi),
                               np.broadcast_to(AZIMUTHS, radius.shape), atol=1e-12)  # fmt: skip


@every_model
def test_stacks_keep_their_shape(model: str) -> None:
    lens, k = sample(model)
    for shape in ((), (0,), (3, 4)):
        imaged = lens.project(np.full((*shape, 3), [0.1, -0.2, 1.0]), k)
        back = lens.unproject(np.full((*shape, 2), 0.1), k)
        assert imaged.points.shape == (*shape, 2)
        assert imaged.by_ray.shape == (*shape, 2, 3)
        assert imaged.by_coefficients.shape == (*shape, 2, len(k))
        assert back.rays.shape == (*shape, 3)
        assert back.by_point.shape == (*shape, 3, 2)
        assert back.by_coefficients.shape == (*shape, 3, len(k))


@every_model
def test_arguments_stay_as_they_are(model: str) -> None:
    lens, k = sample(model)
    rays, d = seen(model, 0.9), np.array([[0.1, np.nan], [0.2, 0.3]])
    kept = rays.copy(), d.copy(), k.copy()
    for values in (rays, d, k):
        values.flags.writeable = False
    lens.project(rays, k)
    lens.unproject(d, k)
    for values, before in zip((rays, d, k), kept, strict=True):
        np.testing.assert_array_equal(values, before)


@every_model
def test_what_has_no_value_is_nan_with_all_derivatives(model: str) -> None:
    lens, k = sample(model)
    good = np.array([0.1, 0.2, 1.0])
    rays = np.array([good, np.zeros(3), [np.nan, 0.1, 1.0], [0.1, 0.1, np.nan], good])
    d = np.array([[0.1, 0.2], [np.nan, 0.1], [0.1, np.nan], [0.1, 0.2]])
    for values in lens.project(rays, k):
        flat = values.reshape(len(rays), -1)
        assert np.isnan(flat[1:4]).all()
        np.testing.assert_array_equal(flat[[0, 4]], values.reshape(len(rays), -1)[[0, 0]])
        assert np.isfinite(flat[0]).all()
    for values in lens.unproject(d, k):
        flat = values.reshape(len(d), -1)
        assert np.isnan(flat[1:3]).all()
        assert np.isfinite(flat[[0, 3]]).all()


@every_model
def test_far_points_have_no_ray_or_the_ray_that_is_imaged_there(model: str) -> None:
    lens, k = sample(model)
    if isinstance(lens, Lucchese):  # it corrects in closed form, beyond its fold, too
        return
    radius = np.linspace(0.5, 12.0, 40)[:, None]
    d = np.stack([radius * np.cos(AZIMUTHS), radius * np.sin(AZIMUTHS)], axis=-1)
    rays, *derivatives = lens.unproject(d, k)
    there = np.isfinite(rays).all(axis=-1)
    for values in derivatives:
        assert np.isnan(values[~there]).all()
    # Near a fold a point's last bits move its ray by their square root, but not the ray's point.
    np.testing.assert_allclose(lens.project(rays[there], k).points, d[there], atol=1e-10)


@pytest.mark.parametrize("model", [m for m in LENSES if isinstance(find_model(m), PlaneLens)])
def test_models_of_the_plane_see_nothing_behind_them(model: str) -> None:
    lens, k = sample(model)
    behind = np.array([[0.1, 0.2, -1.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
    for values in lens.project(behind, k):
        assert np.isnan(values).all()


@every_model
def test_what_a_start_needs_names_coefficients_of_the_model(model: str) -> None:
    lens = find_model(model)
    named = {*lens.held_at_start, *lens.least_at_start, *lens.asymmetric}
    for trials in (lens.valley, lens.conversion_starts):
        if trials is not None:
            named.add(trials.coefficient)
            assert list(trials.values) == sorted(trials.values)
    assert named <= set(lens.names)
    assert not named & set(lens.held) - set(lens.asymmetric)


@pytest.mark.parametrize(
    "model", ["lucchese", "lucchese-pixels", "brown-conrady-4", "brown-conrady"]
)
def test_the_first_coefficient_of_closed_form_models_is_the_corrections_k1(model: str) -> None:
    """To first order, but for a factor."""
    lens = find_model(model)
    assert isinstance(lens, PlaneLens)
    d = np.random.default_rng(0).uniform(-0.4, 0.4, (50, 2))
    k = np.zeros(len(lens.names))
    k[0] = 1e-6
    change = (lens.correct(d, k).points - d) / (k[0] * np.sum(d**2, axis=1, keepdims=True) * d)
    assert lens.closed_form_factor is not None
    assert lens.closed_form_factor * change == pytest.approx(1.0, abs=1e-5)


@every_model
def test_a_model_images_nothing_beyond_its_edge(model: str) -> None:
    lens, k = sample(model)
    if lens.edge is None:
        assert lens.control_points is None
        return
    for axis in range(2):
        u = np.zeros((2, 2))
        u[:, axis] = lens.edge[axis] * np.array([0.999, 1.001])
        rays = np.column_stack([u, 1 - np.sum(u**2, axis=1) / 4])  # u = 2 (X, Y) / (|r| + Z)
        assert np.isfinite(lens.project_points(rays, k)).all(axis=1).tolist() == [True, False]

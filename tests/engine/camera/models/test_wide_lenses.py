"""Lens models of wide views: derivatives in all directions, and inverses wherever they exist."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from calibgui.engine.arrays import Array
from calibgui.engine.camera.model import Lens
from calibgui.engine.camera.models import MODELS
from tests.engine.scenes import central_differences, relative

EXAMPLES = {
    "kannala-brandt": (-0.02, 1e-3, -1e-3, 1e-4),
    "kannala-brandt-decentering": (-0.02, 1e-3, -1e-3, 1e-4, 2e-3, -3e-3),
    "ucm": (0.6,),
    "eucm": (0.58, 1.1),
    "double-sphere": (-0.2, 0.57),
    "mei": (1.2, -0.2, 0.03, 1e-3, -2e-3),
    "division": (-0.3,),
    "scaramuzza": (-0.35, 0.03, -0.02),
}
"""A lens of each model that sees 110 degrees off the axis."""
CASES = [pytest.param(MODELS[model], np.array(k), id=model) for model, k in EXAMPLES.items()]
ANGLES = np.array([0.0, 1e-9, 1e-4, 1.0, 30.0, 60.0, 89.999999, 90.0, 90.000001, 105.0])
"""Degrees off the axis."""


def make_rays(degrees: Array) -> Array:
    """(n, 3) rays of length 1; those of 90 degrees have Z = 0 exactly."""
    theta, phi = np.deg2rad(degrees), 1.0 + np.arange(len(degrees))
    Z = np.where(degrees == 90, 0.0, np.cos(theta))
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), Z], axis=-1)


def make_steps(lens: Lens) -> Array:
    """(C,) steps of the coefficients that all move image points by some 1e-4."""
    return 2e-4 / 3.0 ** np.array(lens.powers)


@pytest.mark.parametrize(("lens", "k"), CASES)
@pytest.mark.parametrize("length", [1.0, 40.0])
def test_derivatives_of_the_projection(lens: Lens, k: Array, length: float) -> None:
    rays = length * make_rays(ANGLES)
    imaged = lens.project(rays, k)
    by_ray = central_differences(
        lambda e: lens.project(rays + length * e, k).points, np.zeros(3), 5e-4
    )
    by_k = central_differences(lambda k: lens.project(rays, k).points, k, make_steps(lens))
    # Scaramuzza's r^3 has a jump in its third derivative on the axis: step^2 times a3 = 1e-8.
    tolerance = 2e-8 if lens is MODELS["scaramuzza"] else 1e-9
    assert relative(imaged.by_ray * length, by_ray) < tolerance
    assert relative(imaged.by_coefficients, by_k) < 1e-9
    np.testing.assert_allclose(imaged.by_ray @ rays[..., None], 0.0, atol=1e-13)


@pytest.mark.parametrize(("lens", "k"), CASES)
def test_derivatives_of_the_unprojection(lens: Lens, k: Array) -> None:
    d = lens.project(make_rays(ANGLES), k).points
    seen = lens.unproject(d, k)
    by_point = central_differences(lambda e: lens.unproject(d + e, k).rays, np.zeros(2), 2e-4)
    by_k = central_differences(lambda k: lens.unproject(d, k).rays, k, make_steps(lens))
    assert relative(seen.by_point, by_point) < 1e-8
    assert relative(seen.by_coefficients, by_k) < 1e-8
    np.testing.assert_allclose(np.linalg.norm(seen.rays, axis=-1), 1.0, atol=1e-15)


@pytest.mark.parametrize(("lens", "k"), CASES)
def test_round_trip(lens: Lens, k: Array) -> None:
    rays = make_rays(np.append(ANGLES, 110.0))
    d = lens.project(rays, k).points
    back = lens.unproject(d, k).rays
    assert measure_angles(back, rays).max() < 1e-13
    np.testing.assert_allclose(lens.project(3 * back, k).points, d, atol=1e-13)


@pytest.mark.parametrize(("lens", "k"), CASES)
def test_the_axis_is_imaged_at_the_centre(lens: Lens, k: Array) -> None:
    imaged = lens.project(np.array([0.0, 0.0, 2.0]), k)
    np.testing.assert_array_equal(imaged.points, 0.0)
    np.testing.assert_array_equal(imaged.by_coefficients, 0.0)
    assert imaged.by_ray[0, 0] == imaged.by_ray[1, 1] > 0
    np.testing.assert_allclose(lens.unproject(np.zeros(2), k).rays, [0.0, 0.0, 1.0], atol=1e-15)


@pytest.mark.parametrize(("lens", "k"), CASES)
def test_what_is_no_direction_has_no_point(lens: Lens, k: Array) -> None:
    for ray in ([0.0, 0.0, 0.0], [0.0, 0.0, -1.0], [np.nan, 0.1, 1.0]):
        for part in lens.project(np.array(ray), k):
            assert np.isnan(part).any()
    assert np.isnan(lens.unproject(np.array([np.nan, 0.1]), k).rays).all()


@pytest.mark.parametrize(("lens", "k"), CASES)
@pytest.mark.parametrize("shape", [(), (0,), (3, 4)])
def test_stacks_keep_their_shape(lens: Lens, k: Array, shape: tuple[int, ...]) -> None:
    imaged = lens.project(np.full((*shape, 3), 0.5), k)
    seen = lens.unproject(np.full((*shape, 2), 0.1), k)
    assert [part.shape for part in imaged] == [
        (*shape, 2),
        (*shape, 2, 3),
        (*shape, 2, len(lens.names)),
    ]
    assert [part.shape for part in seen] == [
        (*shape, 3),
        (*shape, 3, 2),
        (*shape, 3, len(lens.names)),
    ]


@pytest.mark.parametrize("lens", [pytest.param(MODELS[m], id=m) for m in EXAMPLES])
def test_the_default_lens_is_symmetric_and_round_trips(lens: Lens) -> None:
    k = np.array(lens.defaults)
    assert len(lens.names) == len(lens.powers) == len(k)
    assert set(lens.asymmetric) == {name for name in lens.names if name.startswith("p")}
    rays = make_rays(np.linspace(0, 80, 20))
    d = lens.project(rays, k).points
    # Without asymmetric coefficients the point lies in the direction of the ray.
    np.testing.assert_allclose(d[:, 0] * rays[:, 1], d[:, 1] * rays[:, 0], atol=1e-15)
    assert measure_angles(lens.unproject(d, k).rays, rays).max() < 1e-14


def measure_angles(a: Array, b: Array) -> Array:
    """(n,) angles between rays of length 1, rad."""
    return 2 * np.arcsin(np.linalg.norm(a - b, axis=-1) / 2)


def around(*ranges: tuple[float, float]) -> st.SearchStrategy[Array]:
    return st.tuples(*(st.floats(*r) for r in ranges)).map(np.array)


P = (-5e-3, 5e-3)
PLAUSIBLE = {
    "kannala-brandt": around((-0.3, 0.3), (-0.1, 0.1), (-0.03, 0.03), (-0.01, 0.01)),
    "kannala-brandt-decentering": around(
        (-0.3, 0.3), (-0.1, 0.1), (-0.03, 0.03), (-0.01, 0.01), P, P
    ),
    "ucm": around((0.0, 1.0)),
    "eucm": around((0.0, 1.0), (0.3, 3.0)),
    "double-sphere": around((-0.95, 4.0), (0.0, 1.0)),
    "mei": around((0.0, 4.0), (-0.6, 0.6), (-0.3, 0.3), P, P),
    "division": around((-1.0, 1.0)),
    "scaramuzza": around((-1.0, 0.5), (-0.3, 0.3), (-0.3, 0.3)),
}
AXIS = np.linspace(-2.5, 2.5, 21)
GRID = np.stack(np.meshgrid(AXIS, AXIS), axis=-1).reshape(-1, 2)


@given(st.data())
@pytest.mark.parametrize("model", EXAMPLES)
def test_every_ray_found_is_imaged_at_its_point(model: str, data: st.DataObject) -> None:
    lens, k = MODELS[model], data.draw(PLAUSIBLE[model])
    seen = lens.unproject(GRID, k)
    known = np.isfinite(seen.rays).all(axis=-1)
    assert known[len(GRID) // 2]
    assert np.isnan(seen.by_point[~known]).all()
    back = lens.project(seen.rays[known], k)
    # Rounding of the ray, 2e-16, enlarged by the slope of the projection.
    slope = np.linalg.norm(back.by_ray, axis=(-1, -2))
    assert (np.abs(back.points - GRID[known]).max(axis=-1) < 1e-13 + 1e-15 * slope).all()


@given(st.data())
@pytest.mark.parametrize("model", EXAMPLES)
def test_every_ray_that_is_imaged_before_the_fold_is_found(model: str, data: st.DataObject) -> None:
    """Before the fold the image grows with the angle along every meridian, by a margin."""
    lens, k = MODELS[model], data.draw(PLAUSIBLE[model])
    theta = np.deg2rad(np.linspace(0, 175, 176))
    sine, cosine = np.sin(theta), np.cos(theta)
    for phi in (0.0, 2.0, 4.0):
        c, s = np.cos(phi), np.sin(phi)
        rays = np.stack([sine * c, sine * s, cosine], axis=-1)
        imaged = lens.project(rays, k)
        near = np.abs(imaged.points).max(axis=-1) < 1e3
        onward = np.stack([cosine * c, cosine * s, -sine], axis=-1)
        side = np.array([-s, c, 0.0])
        J = np.where(near[:, None, None], imaged.by_ray, np.nan) @ np.stack(
            np.broadcast_arrays(onward, side), axis=-1
        )
        det = J[:, 0, 0] * J[:, 1, 1] - J[:, 0, 1] * J[:, 1, 0]
        trace = J[:, 0, 0] * c + J[:, 1, 0] * s
        regular = np.isfinite(det) & (det > 0.02) & (trace > 0.05)
        inside = np.logical_and.accumulate(regular)
        back = lens.unproject(imaged.points[inside], k).rays
        assert measure_angles(back, rays[inside]).max(initial=0.0) < 1e-12

"""The plane across a ray."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from calibgui.engine.geometry.directions import make_tangent_basis

components = st.floats(-1, 1)


@given(st.tuples(components, components, components).filter(lambda r: np.linalg.norm(r) > 1e-3))
def test_the_basis_is_orthonormal_and_across_the_ray(given_ray: tuple[float, ...]) -> None:
    ray = np.array(given_ray) / np.linalg.norm(given_ray)
    whole = np.column_stack([make_tangent_basis(ray), ray])
    np.testing.assert_allclose(whole.T @ whole, np.eye(3), atol=1e-14)


def test_the_axis_both_ways_and_the_plane_across_it_have_one() -> None:
    rays = np.array([[0, 0, 1.0], [0, 0, -1.0], [1.0, 0, 0], [0, -1.0, 0.0], [-1.0, 0, -0.0]])
    basis = make_tangent_basis(rays)
    np.testing.assert_allclose(np.einsum("nij,ni->nj", basis, rays), 0, atol=1e-15)

"""The cosines' equation on exact homographies: the truth where they hold it, NaN elsewhere."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.initialisation import single_view_pose
from calibgui.engine.geometry import homography, rotations

FX = 650.0
T = np.array([0.08, -0.05, 0.3])


def backward(omega: float, phi: float, theta: float, aspect: float = 1.0) -> Array:
    """Eq. 17-21 in exact numbers: board (units of L + f) to image, principal point at zero."""
    R = rotations.rotation_from_paper_angles(omega, phi, theta)
    K = np.diag([FX, FX * aspect, 1.0])
    M = K @ np.column_stack([R[:, 0], R[:, 1], R[:, 2] + T])
    # Reference coordinates are fx times the board's, as the paper's grid is in pixels.
    return homography.scale_to_unit_last(M @ np.diag([1 / FX, 1 / FX, 1.0]))


tilts = st.floats(0.1, 0.8).flatmap(lambda a: st.sampled_from([a, -a]))


@given(tilts, tilts, st.floats(-0.7, 0.7), st.floats(0.7, 1.4))
def test_exact_view_gives_the_truth(omega: float, phi: float, theta: float, aspect: float) -> None:
    view = single_view_pose.estimate_view_geometry(backward(omega, phi, theta, aspect))
    assert view.aspect == pytest.approx(aspect, rel=1e-8)
    assert (view.omega, view.phi, view.theta) == pytest.approx((omega, phi, theta), abs=1e-7)
    assert (view.fx, view.fy) == pytest.approx((FX, FX * aspect), rel=1e-7)
    np.testing.assert_allclose(view.t, T, atol=1e-7)


# g has two zeros here, 1 and 1.0004, between neighbouring nodes of the search.
@example(0.18382627636758334, 0.123046875, 0.4211510315739817)
@given(tilts, tilts, st.floats(-0.7, 0.7))
def test_literal_form_is_right_for_square_pixels(omega: float, phi: float, theta: float) -> None:
    H = backward(omega, phi, theta)
    root = single_view_pose.solve_aspect_ratio(H, on_paper_grid=True)
    # At the truth g is zero; where another zero lies closer to 1 there is none closer than this.
    assert root == pytest.approx(1.0, abs=1e-6)
    view = single_view_pose.estimate_view_geometry(H, on_paper_grid=True)
    assert (view.omega, view.phi, view.theta) == pytest.approx((omega, phi, theta), abs=1e-5)


def test_the_closed_form_is_the_root_of_g() -> None:
    H = backward(0.4, -0.3, 0.2, 1.2)
    r = single_view_pose.solve_aspect_ratio(H)
    assert single_view_pose.evaluate_cosines_equation(H, np.array([r]))[0] == pytest.approx(
        0.0, abs=1e-12
    )
    g = single_view_pose.evaluate_cosines_equation(H, np.array([0.9 * r, 1.1 * r]))
    assert g[0] * g[1] < 0


def test_g_is_eq_27() -> None:
    H = backward(0.4, -0.3, 0.2, 1.2)
    r = np.linspace(0.8, 1.3, 6)
    det = H[0, 0] * H[1, 1] - H[0, 1] * H[1, 0]
    expected = det * np.cos(0.3) * np.cos(0.2) ** 2 - r * H[0, 0] ** 2 * np.cos(0.4)
    np.testing.assert_allclose(
        single_view_pose.evaluate_cosines_equation(H, r), expected, atol=1e-12
    )


@pytest.mark.parametrize("on_paper_grid", [False, True])
@pytest.mark.parametrize("theta", [0.0, 0.3])
@pytest.mark.parametrize("tilt", [(0.0, 0.0), (0.4, 0.0), (0.0, -0.4)])
def test_frontal_views_and_tilts_about_one_axis_say_nothing(
    tilt: tuple[float, float], theta: float, on_paper_grid: bool
) -> None:
    view = single_view_pose.estimate_view_geometry(backward(*tilt, theta), on_paper_grid)
    assert np.isnan([view.omega, view.aspect, view.fx, view.fy]).all()
    assert np.isnan(view.t).all()


def test_imaginary_angles_are_nan() -> None:
    """A homography that no camera with square axes could have made."""
    H = backward(0.3, 0.3, 0.2)
    H[1, 0] += 0.8
    assert np.isnan(single_view_pose.solve_aspect_ratio(H))
    assert np.isnan(single_view_pose.evaluate_cosines_equation(H, np.array([1.0]))).all()

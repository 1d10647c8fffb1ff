"""Maps between measured and ideal pixels against OpenCV, eq. 10 and central differences."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from calibgui.engine.arrays import Array
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import (
    DisplacementPart,
    compute_displacement,
    distort_points,
    project_points,
    undistort_points,
)
from calibgui.engine.geometry.frames import array_from_paper, paper_from_array
from calibgui.engine.geometry.pose import Pose
from tests.engine.scenes import barrel, brown, central_differences

PAPER = np.array(
    [-16.48, -2.90, 5.71e-7, 6.05e-13, -2.06e-18, -6.34e-7, -1.06e-6, 1.37e-6, 656.66, 657.83]
)
"""Table 2."""
OTHER = np.array([[500.0, 0.0, 400.0], [0.0, 480.0, 300.0], [0.0, 0.0, 1.0]])
CAMERAS = {
    "barrel": barrel(),
    "tall pixels": barrel(aspect=1.3),
    "pixel radius": Camera((640, 480), barrel(aspect=0.9).params, "lucchese-pixels"),
    "brown-conrady": brown(aspect=1.1),
}


def intrinsics_from_paper(values: Array, size: tuple[int, int]) -> Array:
    """The paper's ten intrinsics in the array frame: inverse to `paper_from_intrinsics`."""
    xp, yp, *coefficients, fx, fy = values
    powers = np.array([2.0, 4.0, 6.0, 1.0, 1.0, 2.0])
    signs = np.array([1.0, 1.0, 1.0, 1.0, -1.0, 1.0])
    cx, cy = array_from_paper(np.array([xp, yp]), size)
    return np.concatenate([[fx, fy, cx, cy], signs * fx**powers * np.asarray(coefficients)])


def grid(step: int = 80) -> Array:
    return np.stack(np.meshgrid(np.arange(0, 640, step), np.arange(0, 480, step)), axis=-1) * 1.0


@pytest.mark.parametrize("camera", CAMERAS.values(), ids=CAMERAS)
@pytest.mark.parametrize("matrix", [None, OTHER], ids=["own", "other"])
def test_round_trip(camera: Camera, matrix: Array | None) -> None:
    ideal = undistort_points(grid(), camera, matrix)
    assert np.abs(ideal - grid()).max() > 1
    np.testing.assert_allclose(distort_points(ideal, camera, matrix), grid(), atol=1e-9)


@given(
    k1=st.floats(-0.5, 0.6),
    k2=st.floats(-0.3, 0.5),
    p=st.tuples(st.floats(-2e-3, 2e-3), st.floats(-2e-3, 2e-3)),
)
def test_round_trip_of_any_lens(k1: float, k2: float, p: tuple[float, float]) -> None:
    camera = Camera((640, 480), [600.0, 610.0, 315.0, 245.0, k1, k2, 0.0, *p, 0.0])
    ideal = undistort_points(grid(), camera)
    known = np.isfinite(ideal).all(axis=-1)
    assert known[3, 4]
    np.testing.assert_allclose(distort_points(ideal[known], camera), grid()[known], atol=1e-9)


def test_agrees_with_opencv() -> None:
    camera = brown()
    K, k = camera.matrix, np.array(camera.coefficients[:5])
    measured = distort_points(grid(), camera)
    n = np.concatenate([(grid() - K[:2, 2]) / camera.focal, np.ones((6, 8, 1))], axis=-1)
    projected = cv2.projectPoints(n.reshape(-1, 3), np.zeros(3), np.zeros(3), K, k)[0]
    np.testing.assert_allclose(measured.reshape(-1, 2), projected.reshape(-1, 2), atol=1e-9)
    pose = Pose([0.3, -0.2, 0.1], [-100.0, -80.0, 500.0])
    xy = grid().reshape(-1, 2) / 2
    board_shape = np.column_stack([xy, np.zeros(len(xy))])
    projected = cv2.projectPoints(board_shape, np.array(pose.rvec), np.array(pose.tvec), K, k)[0]
    np.testing.assert_allclose(
        project_points(xy, camera, pose), projected.reshape(-1, 2), atol=1e-9
    )


def test_what_has_no_inverse_is_nan() -> None:
    # r (1 - r^2 / 2) folds at r = sqrt(2/3): 490 px from the centre, where it reaches 326 px.
    camera = Camera((1600, 1200), [600.0, 600.0, 800.0, 600.0, -0.5, 0, 0, 0, 0, 0])
    fold = 600 * np.sqrt(2 / 3)
    reach = fold * 2 / 3
    measured = np.array([[800 + fold - 1, 600.0], [800 + fold + 1, 600.0], [800.0, 1199.0]])
    np.testing.assert_array_equal(
        np.isfinite(undistort_points(measured, camera)[:, 0]), [True, False, False]
    )
    ideal = np.array([[800 + reach - 0.01, 600.0], [800 + reach + 0.01, 600.0], [np.nan, 0.0]])
    np.testing.assert_array_equal(
        np.isfinite(distort_points(ideal, camera)[:, 0]), [True, False, False]
    )


def test_points_behind_the_camera_have_no_pixel() -> None:
    pose = Pose([0.0, 1.2, 0.0], [0.0, 0.0, 100.0])
    uv = project_points([[0.0, 0.0], [200.0, 0.0]], barrel(), pose)
    np.testing.assert_array_equal(np.isfinite(uv[:, 0]), [True, False])


def test_empty_and_single_points() -> None:
    assert undistort_points(np.empty((0, 2)), barrel()).shape == (0, 2)
    assert distort_points([3.0, 4.0], barrel()).shape == (2,)


@pytest.mark.parametrize("part", DisplacementPart)
def test_displacement_is_equation_10(part: DisplacementPart) -> None:
    """In the paper's frame and pixel units, with its Table 2 and square pixels."""
    table = PAPER.copy()
    table[9] = table[8]
    xp, yp, k1, k2, k3, p1, p2, p3 = table[:8]
    size = (640, 480)
    camera = Camera(size, intrinsics_from_paper(table, size))
    x, y = np.moveaxis(paper_from_array(grid(), size), -1, 0)
    dx, dy = x - xp, y - yp
    r2 = dx**2 + dy**2
    rho, q = k1 * r2 + k2 * r2**2 + k3 * r2**3, 1 + p3 * r2
    radial = np.stack([dx * rho, dy * rho], axis=-1)
    decentering = np.stack(
        [
            q * (p1 * (r2 + 2 * dx**2) + 2 * p2 * dx * dy),
            q * (2 * p1 * dx * dy + p2 * (r2 + 2 * dy**2)),
        ],
        axis=-1,
    )
    expected = {"complete": radial + decentering, "radial": radial, "decentering": decentering}
    moved = grid() + compute_displacement(grid(), camera, part).vector
    np.testing.assert_allclose(
        moved, array_from_paper(np.stack([x, y], axis=-1) + expected[part], size), atol=1e-9
    )


def test_the_papers_displacement_in_the_image_corners() -> None:
    # "In the four corners, the corrective displacement is of the order of 40 pixels."
    camera = Camera((640, 480), intrinsics_from_paper(PAPER, (640, 480)))
    corners = compute_displacement([[0, 0], [639, 0], [0, 479], [639, 479]], camera).length
    assert np.all((corners > 30) & (corners < 50))


@pytest.mark.parametrize("camera", CAMERAS.values(), ids=CAMERAS)
@pytest.mark.parametrize("part", DisplacementPart)
def test_gradients(camera: Camera, part: DisplacementPart) -> None:
    for uv in grid(160).reshape(-1, 2):
        at = compute_displacement(uv, camera, part)
        by_pixel = central_differences(
            lambda x: compute_displacement(x, camera, part).vector, uv, step=1e-2
        )
        gradient = central_differences(
            lambda x: compute_displacement(x, camera, part).length, uv, step=1e-2
        )
        # Truncation: step^2 / 6 times third derivatives of order 1e-6 / px^2, and
        # rounding: 1e-13 px over the step.
        np.testing.assert_allclose(at.by_pixel, by_pixel, atol=1e-9)
        np.testing.assert_allclose(at.gradient, gradient, atol=1e-9)


def test_the_gradient_where_there_is_no_displacement() -> None:
    camera = barrel()
    np.testing.assert_array_equal(compute_displacement(camera.centre, camera).gradient, [0.0, 0.0])


def test_a_fisheye_has_no_displacement_from_80_degrees_on() -> None:
    """An equidistant lens of f = 100 px images 80 degrees at 139.6 px, a pinhole at 567.1 px."""
    camera = Camera((640, 480), [100, 100, 320, 240, 0, 0, 0, 0], "kannala-brandt")
    uv = 320 + np.array([[100.0, 0], [139.0, 0], [140.0, 0], [300.0, 0], [320.0, 0]]) - [0, 80]
    length = compute_displacement(uv, camera).length
    np.testing.assert_allclose(length[:2], 100 * np.tan([1.0, 1.39]) - [100, 139])
    assert np.isnan(length[2:]).all()

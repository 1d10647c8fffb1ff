"""Undistorted images against OpenCV, rendered views and linear ramps."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import distort_points, undistort_points
from calibgui.engine.camera.image_circle import ImageCircle
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.images.hidden_angles import describe_hidden_angles
from calibgui.engine.images.rectification import rectify_image
from calibgui.engine.images.rendering import compute_irradiance
from calibgui.engine.images.undistortion import (
    FieldOfView,
    choose_ideal_cameras,
    undistort_image,
)
from tests.engine.scenes import barrel, brown

BOARD = Board(7, 10, 25.0)
POSE = Pose([0.4, -0.3, 0.1], [-110.0, -80.0, 420.0])
PINCUSHION = Camera((640, 480), [500.0, 520.0, 330.0, 228.0, -0.15, 0.02, 0, 2e-3, -3e-3, 0])
FOLDING = Camera((640, 480), [400.0, 400.0, 320.0, 240.0, -0.9, 0, 0, 0, 0, 0])
CAMERAS = {"barrel": barrel(), "pincushion": PINCUSHION, "brown-conrady": brown(aspect=1.2)}


def ideal_matrix(
    camera: Camera, view: FieldOfView | str, size: tuple[int, int] | None = None
) -> Array:
    """The matrix of the perspective image."""
    return choose_ideal_cameras(camera, view, size)[""].matrix


def ramps(camera: Camera) -> Array:
    """An image (h, w, 2) float32 whose levels are the pixel's own u and v."""
    return np.stack(np.meshgrid(*map(np.arange, camera.size)), axis=-1).astype(np.float32)


@pytest.mark.parametrize("camera", CAMERAS.values(), ids=CAMERAS)
@pytest.mark.parametrize("view", FieldOfView)
def test_every_pixel_comes_from_its_place(camera: Camera, view: FieldOfView) -> None:
    result = undistort_image(ramps(camera), camera, view)
    ideal = ramps(camera).astype(float)
    expected = distort_points(ideal, camera, result.matrix)
    # Half a pixel of border is replicated: ramps cannot show where in it the source lies.
    expected = np.clip(expected, 0, np.array(camera.size) - 1)
    # OpenCV 4 rounds the source to 1/32 px; the interpolated map adds 0.005.
    np.testing.assert_allclose(
        result.image[result.valid], expected[result.valid], atol=1 / 64 + 0.006
    )
    assert not result.image[~result.valid].any()


@pytest.mark.parametrize("camera", CAMERAS.values(), ids=CAMERAS)
@pytest.mark.parametrize("size", [None, (500, 700)])
def test_all_shows_every_measured_pixel_and_fills_the_image(
    camera: Camera, size: tuple[int, int] | None
) -> None:
    matrix = ideal_matrix(camera, FieldOfView.ALL, size)
    w, h = camera.size
    u, v = np.linspace(-0.5, w - 0.5, 200), np.linspace(-0.5, h - 0.5, 150)
    ideal = undistort_points(np.stack(np.meshgrid(u, v), axis=-1), camera, matrix)
    out = np.array(size or camera.size)
    spare = np.minimum(ideal.min(axis=(0, 1)) + 0.5, out - 0.5 - ideal.max(axis=(0, 1)))
    assert spare.min() == pytest.approx(0.0, abs=0.01)
    assert spare.max() >= 0
    assert matrix[1, 1] / matrix[0, 0] == pytest.approx(camera.focal[1] / camera.focal[0])


@pytest.mark.parametrize("camera", CAMERAS.values(), ids=CAMERAS)
@pytest.mark.parametrize("size", [None, (300, 420)])
def test_no_border_has_none_and_loses_little(camera: Camera, size: tuple[int, int] | None) -> None:
    result = undistort_image(ramps(camera), camera, "no-border", size)
    assert result.valid.all()
    w, h = size or camera.size
    u, v = np.linspace(-0.5, w - 0.5, 200), np.linspace(-0.5, h - 0.5, 150)
    measured = distort_points(np.stack(np.meshgrid(u, v), axis=-1), camera, result.matrix)
    to_edge = np.minimum(measured + 0.5, np.array(camera.size) - 0.5 - measured)
    assert to_edge.min() == pytest.approx(0.0, abs=0.01)


def test_same_scale_keeps_the_focal_lengths_and_the_middle() -> None:
    camera = barrel()
    np.testing.assert_array_equal(ideal_matrix(camera, "same-scale"), camera.matrix)
    wider = ideal_matrix(camera, "same-scale", (700, 500))
    np.testing.assert_array_equal(wider[:2, 2], camera.centre + np.array([30, 10]))


def test_agrees_with_opencv() -> None:
    camera = brown()
    image = compute_irradiance(camera, POSE, BOARD, blur=2.0).astype(np.uint8)
    result = undistort_image(image, camera, FieldOfView.SAME_SCALE)
    theirs = cv2.undistort(image, camera.matrix, np.array(camera.coefficients[:5]))
    difference = result.image.astype(int) - theirs
    assert np.abs(difference[result.valid]).max() <= 2


@pytest.mark.parametrize("camera", [barrel(), PINCUSHION], ids=["barrel", "pincushion"])
def test_an_undistorted_view_is_that_of_a_pinhole(camera: Camera) -> None:
    view = compute_irradiance(camera, POSE, BOARD, blur=2.0).astype(np.float32)
    result = undistort_image(view, camera, FieldOfView.ALL)
    K = result.matrix
    pinhole = Camera(camera.size, [K[0, 0], K[1, 1], K[0, 2], K[1, 2], 0, 0, 0, 0, 0, 0])
    ideal = compute_irradiance(pinhole, POSE, BOARD, blur=2.0 * K[0, 0] / camera.focal[0])
    # The lens also stretches the blur, and interpolation adds some.
    difference = (result.image - ideal)[result.valid]
    assert np.sqrt(np.mean(difference**2)) < 1.5
    assert abs(difference.mean()) < 0.05


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32])
@pytest.mark.parametrize("channels", [(), (3,)], ids=["grey", "colour"])
def test_type_and_channels_are_kept(dtype: type, channels: tuple[int, ...]) -> None:
    image = np.full((480, 640, *channels), 77, dtype)
    result = undistort_image(image, barrel())
    assert (result.image.dtype, result.image.shape) == (image.dtype, image.shape)
    assert np.all(result.image[result.valid] == 77)
    assert np.all(result.image[~result.valid] == 0)
    assert not result.valid.all()


def test_a_lens_that_folds_within_the_image() -> None:
    for view in (FieldOfView.ALL, FieldOfView.NO_BORDER):
        with pytest.raises(CalibrationError, match="folds over"):
            undistort_image(ramps(FOLDING), FOLDING, view)
    valid = undistort_image(ramps(FOLDING), FOLDING, FieldOfView.SAME_SCALE).valid
    assert valid[240, 320]
    assert not valid[0, 0]


def test_an_image_of_another_size_is_refused() -> None:
    for work in (
        lambda image: undistort_image(image, barrel()),
        lambda image: rectify_image(image, barrel(), POSE, (0, 0, 1, 1), 10.0),
    ):
        with pytest.raises(CalibrationError, match="480 x 640 pixels, the camera 640 x 480"):
            work(np.zeros((640, 480), np.uint8))


def test_an_unknown_view_is_named() -> None:
    with pytest.raises(CalibrationError, match="everything"):
        ideal_matrix(barrel(), "everything")


def test_what_the_lens_does_not_light_is_not_shown() -> None:
    """The fitted image ends at the circle, and one without a border lies within it."""
    params = [520.0, 522.0, 318.0, 242.0, -0.35, 0.12, 0.0, 0.0]
    camera = Camera((640, 480), params, "brown-conrady-4", ImageCircle(320.0, 240.0, 215.0))
    lit = camera.lights(np.stack(np.meshgrid(np.arange(640), np.arange(480)), axis=-1))
    photograph = np.where(lit, 200, 0).astype(np.uint8)
    ideals = choose_ideal_cameras(camera)
    assert describe_hidden_angles(camera, ideals).endswith(
        "everything that the lens sees is shown."
    )
    fitted = undistort_image(photograph, camera).image > 100
    assert 420 <= fitted.any(axis=1).sum() <= 480
    assert undistort_image(photograph, camera, "no-border").image.min() > 100


def test_a_lens_that_folds_within_its_circle_is_refused() -> None:
    params = [300.0, 300.0, 320.0, 240.0, -0.6, 0.0, 0.0, 0.0]
    camera = Camera((640, 480), params, "brown-conrady-4", ImageCircle(320.0, 240.0, 235.0))
    with pytest.raises(CalibrationError, match="folds over"):
        choose_ideal_cameras(camera)


@pytest.mark.parametrize("view", ["all", "no-border", "same-scale"])
@pytest.mark.parametrize("aspect", [2.0, 1.5, 1.33, 910 / 834, 0.75, 1.0])
def test_square_pixels(view: str, aspect: float) -> None:
    """The output is stretched, and every pixel of it has the light of its own ray."""
    camera = brown(aspect)
    u, v = np.meshgrid(*(np.arange(side, dtype=np.float32) for side in camera.size))
    made = undistort_image(np.stack([u, v], -1), camera, view, square_pixels=True)
    height, width = made.image.shape[:2]
    assert made.matrix[0, 0] == pytest.approx(made.matrix[1, 1])
    assert (width, height) == (
        round(640 * max(aspect, 1.0)),
        round(480 * max(1 / aspect, 1.0)),
    )
    rows, columns = np.nonzero(made.valid)
    rays = np.column_stack([columns, rows, np.ones(len(rows))]) @ np.linalg.inv(made.matrix).T
    seen = pixels_from_rays(rays, camera)
    inside = ((seen > 1) & (seen < np.array(camera.size) - 2)).all(axis=1)
    assert inside.mean() > 0.9
    np.testing.assert_allclose(made.image[rows, columns][inside], seen[inside], atol=0.1)

"""Sensor modes: the stream's camera sees what the camera sees, mapped."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from calibgui.engine.camera import (
    Camera,
    ImageCircle,
    SensorMode,
    pixels_from_rays,
    rays_from_pixels,
)
from calibgui.engine.errors import CalibrationError
from tests.engine.scenes import LENSES, VGA, example

WHOLE = SensorMode.identity(VGA)
MODES = {
    "scaled": WHOLE.scale(0.5),
    "enlarged": WHOLE.scale(1.7),
    "binned": WHOLE.bin_pixels(3),
    "cropped": WHOLE.crop(17, 60, (600, 361)),
    "cropped-and-scaled": WHOLE.crop(0, 60, (640, 360)).resize((1280, 720)),
    "turned": WHOLE.flip(along_u=True, along_v=True),
    "mirrored": WHOLE.flip(along_u=True),
    "upside-down": WHOLE.flip(along_v=True),
    "all": WHOLE.crop(10, 20, (600, 400)).bin_pixels(2).flip(along_u=True).scale(1.3),
}
SQUEEZED = {"squeezed": WHOLE.resize((480, 480))}


def seen(camera: Camera) -> np.ndarray:
    """Pixels all over the image, and a little beyond, that have a ray."""
    uv = np.random.default_rng(1).uniform(-0.05, 1.05, (400, 2)) * VGA
    uv = uv[np.isfinite(rays_from_pixels(uv, camera)).all(axis=1)]
    assert len(uv) > 300
    return uv


@pytest.mark.parametrize("mode", MODES | SQUEEZED)
@pytest.mark.parametrize("model", LENSES)
def test_mapping_what_is_projected_is_projecting_what_is_mapped(model: str, mode: str) -> None:
    camera, sensor_mode = example(model, aspect=1.02), (MODES | SQUEEZED)[mode]
    if model == "lucchese-pixels" and mode == "squeezed":
        with pytest.raises(CalibrationError, match="radius in pixels"):
            sensor_mode.adapt_camera(camera)
        return
    stream = sensor_mode.adapt_camera(camera)
    rays = rays_from_pixels(seen(camera), camera)
    expected = sensor_mode.map_points(pixels_from_rays(rays, camera))
    mirrored = rays * np.append(np.sign(sensor_mode.factor), 1.0)
    np.testing.assert_allclose(pixels_from_rays(mirrored, stream), expected, atol=1e-9)
    back = sensor_mode.invert().adapt_camera(stream)
    assert back.size == camera.size
    np.testing.assert_allclose(back.params, camera.params, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("mode", MODES)
def test_covariance_is_carried_over(mode: str) -> None:
    camera, sensor_mode = example("thin-prism"), MODES[mode]
    rng = np.random.default_rng(2)
    root = rng.normal(size=(len(camera.params),) * 2) * 1e-3
    moved = [
        sensor_mode.adapt_camera(Camera(VGA, camera.params + step, camera.model)).params
        - sensor_mode.adapt_camera(camera).params
        for step in root.T
    ]
    np.testing.assert_allclose(
        sensor_mode.adapt_covariance(root @ root.T, camera.model),
        np.transpose(moved) @ moved,
        atol=1e-12,
    )


def test_half_an_image_is_that_of_opencv() -> None:
    """A dot is where the map says, in an image that OpenCV scales and one that is cut."""
    image = np.zeros((480, 640), np.float32)
    dot = np.exp(
        -np.sum(
            (np.stack(np.meshgrid(np.arange(640), np.arange(480)), -1) - [401.3, 200.6]) ** 2, -1
        )
        / 50
    )
    image[:] = dot
    half = cv2.resize(image, (320, 240), interpolation=cv2.INTER_AREA)
    cut = image[60:420, 100:]
    for mode, made in ((WHOLE.scale(0.5), half), (WHOLE.crop(100, 60, (540, 360)), cut)):
        assert made.shape[::-1] == mode.size
        weight = made / made.sum()
        v, u = np.indices(made.shape)
        centre = np.array([np.sum(weight * u), np.sum(weight * v)])
        np.testing.assert_allclose(centre, mode.map_points([401.3, 200.6]), atol=1e-3)


def test_the_reported_numbers() -> None:
    camera = Camera(VGA, [660, 662, 309, 246], "pinhole")
    np.testing.assert_allclose(
        WHOLE.scale(0.5).adapt_camera(camera).params, [330, 331, 309.5 / 2 - 0.5, 246.5 / 2 - 0.5]
    )
    cropped = WHOLE.crop(0, 60, (640, 360))
    np.testing.assert_allclose(cropped.adapt_camera(camera).params, [660, 662, 309, 186])
    np.testing.assert_array_equal(cropped.region, [[0, 639], [60, 419]])


def test_modes_follow_each_other() -> None:
    first = WHOLE.crop(10, 20, (600, 400)).bin_pixels(2)
    second = SensorMode.identity(first.size).flip(along_v=True).scale(1.5)
    both = first.then(second)
    uv = np.random.default_rng(0).uniform(0, 640, (20, 2))
    np.testing.assert_allclose(both.map_points(uv), second.map_points(first.map_points(uv)))
    assert both.size == (450, 300)
    assert both.is_mirrored
    assert not first.is_mirrored
    assert WHOLE.flip(along_u=True).then(WHOLE.flip(along_u=True)).is_identity


@pytest.mark.parametrize(
    "make",
    [
        lambda: WHOLE.crop(100, 0, (600, 400)),
        lambda: WHOLE.crop(-1, 0, (600, 400)),
        lambda: WHOLE.scale(1e-4),
        lambda: WHOLE.bin_pixels(1000),
        lambda: SensorMode(VGA, VGA, np.array([np.nan, 1.0]), np.zeros(2)),
    ],
)
def test_impossible_modes_are_refused(make: object) -> None:
    assert callable(make)
    with pytest.raises(CalibrationError):
        make()


def test_the_image_circle_is_mapped() -> None:
    params = [500.0, 500.0, 320.0, 240.0]
    camera = Camera((640, 480), params, "pinhole", ImageCircle(310.0, 250.0, 200.0))
    mode = SensorMode.identity(camera.size).crop(100, 60, (400, 400)).scale(0.5).flip(along_u=True)
    stream = mode.adapt_camera(camera)
    uv = np.random.default_rng(1).uniform(0, 479, (200, 2))
    np.testing.assert_array_equal(camera.lights(uv), stream.lights(mode.map_points(uv)))
    assert SensorMode.identity(camera.size).resize((640, 960)).adapt_camera(camera).circle is None

"""Conversion of cameras by their rays: the stated error is the true one, at the stated place."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.calibration.conversion import convert_camera, find_followed_angle
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import MODELS
from calibgui.engine.camera.projection import pixels_from_rays, rays_from_pixels
from calibgui.engine.errors import CalibrationError
from tests.engine.scenes import example

SIZE = (1000, 800)
WIDE = {
    "kannala-brandt": Camera(
        SIZE, [330, 330, 503, 396, -0.02, 2e-3, -1e-3, 1e-4], "kannala-brandt"
    ),
    "double-sphere": Camera(SIZE, [330, 330, 503, 396, -0.2, 0.58], "double-sphere"),
    "eucm": Camera(SIZE, [330, 330, 503, 396, 0.62, 1.1], "eucm"),
    "mei": Camera(SIZE, [700, 700, 503, 396, 1.2, -0.02, 0.01, 1e-4, 2e-4], "mei"),
    "scaramuzza": Camera(SIZE, [330, 330, 503, 396, -0.2, 0.02, -0.01], "scaramuzza"),
}
"""Lenses of 160 degrees and more across the image."""


def true_error(a: Camera, b: Camera, angle: float = np.inf) -> float:
    """Largest distance over random pixels whose rays are within an angle from the axis."""
    uv = np.random.default_rng(0).uniform((0, 0), np.array(a.size) - 1, (20000, 2))
    rays = rays_from_pixels(uv, a)
    inside = np.arctan2(np.hypot(rays[:, 0], rays[:, 1]), rays[:, 2]) <= angle
    return float(np.linalg.norm(pixels_from_rays(rays, b) - uv, axis=1)[inside].max())


@pytest.mark.parametrize("target", WIDE)
@pytest.mark.parametrize("source", WIDE)
def test_wide_models_into_each_other(source: str, target: str) -> None:
    found = convert_camera(WIDE[source], target)
    assert found.camera.model == target
    assert found.share > 0.999
    truth = true_error(WIDE[source], found.camera)
    assert truth <= found.largest_error * 1.01 + 1e-9
    assert truth >= found.largest_error * 0.5 - 1e-9
    assert found.largest_error < 40
    assert found.rms_error < 5
    assert found.rms_error <= found.largest_error
    at_worst = rays_from_pixels(found.worst, WIDE[source])
    there = np.linalg.norm(pixels_from_rays(at_worst, found.camera) - found.worst)
    assert there == pytest.approx(found.largest_error, abs=1e-9)


@pytest.mark.parametrize("model", [name for name in MODELS if "pixels" not in name])
def test_every_model_follows_a_usual_lens(model: str) -> None:
    camera = example("kannala-brandt-decentering")
    found = convert_camera(camera, model)
    assert true_error(camera, found.camera) <= found.largest_error * 1.01 + 1e-9
    symmetric = model in (
        "division",
        "ucm",
        "eucm",
        "double-sphere",
        "scaramuzza",
        "kannala-brandt",
    )
    coarse = symmetric or model in ("brown-conrady-4", "pinhole")
    assert found.largest_error < {"pinhole": 50}.get(model, 1.1 if coarse else 0.15)


def test_asymmetric_coefficients_are_converted() -> None:
    camera = example("lucchese")
    found = convert_camera(camera, "brown-conrady")
    named = dict(zip(found.camera.names, found.camera.params, strict=True))
    assert abs(named["p1"]) > 1e-4
    assert abs(named["p2"]) > 1e-4
    assert found.largest_error < 0.1


def test_skew_is_converted() -> None:
    camera = example("brown-conrady")
    found = convert_camera(camera, "rational")
    assert found.largest_error < 1e-6
    assert found.camera.params[-1] == pytest.approx(camera.params[-1])


def test_there_and_back() -> None:
    camera = WIDE["kannala-brandt"]
    there = convert_camera(camera, "scaramuzza")
    back = convert_camera(there.camera, "kannala-brandt")
    assert true_error(camera, back.camera) <= there.largest_error + back.largest_error


def test_a_special_case_is_found_again() -> None:
    unified = Camera(SIZE, [330, 330, 503, 396, 0.6], "ucm")
    for model in ("eucm", "double-sphere"):
        assert convert_camera(unified, model).largest_error < 1e-6


def test_its_own_model_is_the_camera_itself() -> None:
    found = convert_camera(WIDE["mei"], "mei")
    assert found.camera is WIDE["mei"]
    assert found.largest_error < 1e-9


def test_a_pinhole_cannot_show_180_degrees() -> None:
    camera = WIDE["kannala-brandt"]
    whole = convert_camera(camera, "pinhole")
    assert not np.isfinite(whole.largest_error)
    assert np.degrees(whole.angle) > 90
    angle = find_followed_angle(camera, "pinhole", 0.3)
    assert angle is not None
    part = convert_camera(camera, "pinhole", angle)
    assert part.largest_error <= 0.3
    assert 0 < part.share < 0.2
    assert part.angle <= angle
    assert true_error(camera, part.camera, angle) <= 0.33
    wider = convert_camera(camera, "pinhole", 1.3 * angle)
    assert wider.largest_error > 0.3


def test_a_region_without_pixels() -> None:
    with pytest.raises(CalibrationError, match="Hardly a pixel"):
        convert_camera(WIDE["mei"], "ucm", 1e-4)


def test_the_region_is_outlined() -> None:
    camera = WIDE["kannala-brandt"]
    found = convert_camera(camera, "eucm", np.radians(40))
    rays = rays_from_pixels(found.region, camera)
    angles = np.degrees(np.arctan2(np.hypot(rays[:, 0], rays[:, 1]), rays[:, 2]))
    assert angles.max() <= 40
    assert angles.min() > 35

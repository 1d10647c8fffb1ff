"""Cameras of every lens model for the tests of exporters and importers, and rays to project."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import find_model
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.geometry.rotations import rotation_from_vector
from tests.engine import scenes

_ANGLES = np.deg2rad([0.0, 5.0, 25.0, 44.0])
_WIDE_ANGLES = np.deg2rad([0.0, 5.0, 25.0, 44.0, 70.0, 88.0])


def _rays(angles: Array) -> Array:
    theta, phi = (x.ravel() for x in np.meshgrid(angles, np.linspace(0.1, 6.0, 7)))
    rays = np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])
    return rays.T * np.linspace(0.5, 3.0, len(theta))[:, None]


RAYS = _rays(_ANGLES)
"""(n, 3) directions up to 44 degrees off the axis, of different lengths."""
WIDE_RAYS = _rays(_WIDE_ANGLES)
"""(n, 3) directions up to 88 degrees off the axis, of different lengths."""
PERSPECTIVE = ("pinhole", "brown-conrady-4", "brown-conrady", "rational", "thin-prism")


def example(model: str, skew: float = 0.0) -> Camera:
    """A camera with all coefficients of its model at work, pixels that are not square."""
    coefficients = list(scenes.LENSES[model])
    if "skew" in find_model(model).names:
        coefficients[-1] = skew
    return Camera((640, 480), [310.0, 300.0, 318.25, 243.5, *coefficients], model)


def splined() -> Camera:
    """A camera of mrcal's splined model."""
    model = "splined-stereographic-11x8-150"
    count = len(find_model(model).names)
    shifts = np.random.default_rng(5).normal(scale=0.02, size=count)
    return Camera((640, 480), [310.0, 300.0, 318.25, 243.5, *shifts], model)


def rays_for(camera: Camera) -> Array:
    """Rays that a camera's model images."""
    return RAYS if camera.model in PERSPECTIVE else WIDE_RAYS


def holding(result: Result, camera: Camera) -> Result:
    """A result with another camera: what an exporter holds it writes without looking further."""
    count = len(camera.params)
    calibration = replace(
        result.calibration,
        camera=camera,
        sigma=np.full(count, 0.5),
        covariance=np.eye(count),
        noise_covariance=0.25 * np.eye(count),
        fixed=(),
        settings=replace(result.calibration.settings, fixed={}),
    )
    return replace(result, calibration=calibration)


def seen_points(result: Result, calibration: Calibration) -> list[tuple[Array, Array]]:
    """The board's points (n, 3), mm, of each used view and their pixels (n, 2) by a calibration."""
    board = [np.pad(view.xy, ((0, 0), (0, 1))) for view in result.observations()]
    return [
        (
            points,
            pixels_from_rays(
                points @ rotation_from_vector(pose.rvec).T + pose.tvec, calibration.camera
            ),
        )
        for points, pose in zip(board, calibration.poses, strict=True)
    ]

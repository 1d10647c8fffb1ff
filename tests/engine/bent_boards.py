"""Calibrations of a camera with boards that are not as drawn, again and again with fresh noise.

What a calibration states of its errors is compared with what they are: of the shape that it has
estimated itself, or that it was given and that came from the same views or from others.
"""

from __future__ import annotations

from enum import StrEnum
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays, rays_from_pixels
from calibgui.engine.geometry.rotations import rotation_from_vector
from tests.engine.scenes import BOARD, barrel, scene

NOISE = 0.1
"""Standard deviation of a corner's coordinate, px."""
NAMES = ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "ray x", "ray y")
"""The quantities that are compared: intrinsics, and the direction of sight of a pixel."""
_PIXEL = (60.0, 50.0)
_STEP = 1e-6


class Use(StrEnum):
    """The ways in which a calibration gets the shape of its board."""

    FREE = "estimated with the camera"
    OTHERS = "held, from other views"
    SAME = "held, from the same views"


class Draws(NamedTuple):
    """Errors of calibrations, and the standard deviations that they state."""

    errors: Array
    """(D, 10) found minus true value of `NAMES`."""
    sigmas: Array
    """(D, 10) stated standard deviations."""

    @property
    def ratios(self) -> Array:
        """(10,) stated standard deviations over the root mean square of the errors."""
        return np.asarray(self.sigmas.mean(axis=0) / np.sqrt(np.mean(self.errors**2, axis=0)))


class Bend(NamedTuple):
    """How far boards of a kind deviate from their drawing, mm rms along each axis."""

    flatness: float = 0.0
    """Bow and twist out of the plane."""
    print: float = 0.0
    """Quadratic deviations in the plane."""
    roughness: float = 0.0
    """Deviations from corner to corner, in the plane and out of it."""

    def draw(self, rng: np.random.Generator) -> Array:
        """(n, 3) deviations of a board of this kind."""
        xy = BOARD.points()
        x, y = (2 * (xy - xy.mean(axis=0)) / np.ptp(xy, axis=0)).T
        quadratic = np.stack([x**2, x * y, y**2], axis=1)
        smooth = (quadratic - quadratic.mean(axis=0)) / quadratic.std(axis=0)
        d = smooth @ rng.normal(size=(3, 3)) / np.sqrt(3)
        rough = rng.normal(0, self.roughness, (len(xy), 3))
        return np.asarray(d * [self.print, self.print, self.flatness] + rough)


def draw_calibrations(bend: Bend, use: Use, count: int, views: int = 12) -> Draws:
    """Calibrate from views of a new board with fresh noise, `count` times.

    Args:
        bend: how far the boards deviate.
        use: how the calibration gets the board's shape.
        count: number of draws.
        views: number of views of the calibration, and of those that another's shape comes from.
    """
    camera, poses = barrel(), scene(barrel(), 2 * views, seed=6).poses
    xy = BOARD.points()
    errors, sigmas = [], []
    for seed in range(count):
        rng = np.random.default_rng(seed)
        places = np.column_stack([xy, np.zeros(len(xy))]) + bend.draw(rng)
        drawn = []
        for pose in poses:
            points = places @ rotation_from_vector(pose.rvec).T + pose.tvec
            uv = pixels_from_rays(points, camera) + rng.normal(0, NOISE, xy.shape)
            drawn.append(Observation(uv, xy))
        ours = drawn[::2]
        of_shape = drawn[1::2] if use is Use.OTHERS else ours
        found = calibrate(of_shape, camera.size, board_shape="free")
        if use is not Use.FREE:
            assert found.board_shape is not None
            found = calibrate(ours, camera.size, board_shape=found.board_shape)
        error, sigma = _compare(found, camera)
        errors.append(error)
        sigmas.append(sigma)
    return Draws(np.array(errors), np.array(sigmas))


def _compare(found: Calibration, truth: Camera) -> tuple[Array, Array]:
    """Return error and stated standard deviation of `NAMES`."""
    chosen = [found.camera.names.index(name) for name in NAMES[:8]]
    params, steps = found.camera.params, _STEP * np.maximum(np.abs(found.camera.params), 1e-3)
    ray = _find_ray(found.camera)
    by_params = np.stack(
        [
            (_find_ray(Camera(truth.size, params + step, truth.model)) - ray) / step.sum()
            for step in np.diag(steps)
        ],
        axis=1,
    )
    of_ray = np.sqrt(np.diag(by_params @ found.covariance @ by_params.T))
    return (
        np.append((params - truth.params)[chosen], ray - _find_ray(truth)),
        np.append(found.sigma[chosen], of_ray),
    )


def _find_ray(camera: Camera) -> Array:
    """(2,) tangents of the direction in which a pixel sees."""
    x, y, z = rays_from_pixels(np.array([_PIXEL]), camera)[0]
    return np.array([x / z, y / z])

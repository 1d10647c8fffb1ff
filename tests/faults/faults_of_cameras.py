"""Faults of the camera: its lens, its shutter, and settings that change between photographs."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.camera import Camera
from tests.engine.scenes import VGA, barrel
from tests.faults.faults_of_boards import roughen
from tests.faults.sets import (
    FaultySet,
    PhotographedSet,
    Rng,
    change_camera,
    draw_log,
    draw_rendered_set,
    draw_set,
    photograph,
    state_fault,
)


def widen_lens(rng: Rng) -> FaultySet:
    """Calibrate a fisheye with the default lens model, or a lens with distortion with none."""
    photographed, story, model = _draw_wide_lens(rng)
    return state_fault(photographed, photograph(photographed), story, model=model)


def widen_lens_and_roughen_print(rng: Rng) -> FaultySet:
    """Calibrate a lens as `widen_lens` does, and the shape of a rough board with it."""
    photographed, story, model = _draw_wide_lens(rng)
    size = draw_log(rng, 0.05, 0.5)
    views = photograph(photographed, displace=roughen(photographed, size, rng))
    story = f"{story}, print rough by {size:.2f} mm, estimated"
    return state_fault(photographed, views, story, model=model, board_shape="free")


def _draw_wide_lens(rng: Rng) -> tuple[PhotographedSet, str, str]:
    """Draw photographs, the story of their lens, and a model that does not follow it."""
    if rng.random() < 0.5:
        focal, first = draw_log(rng, 180, 500), rng.uniform(-0.08, 0.02)
        lens = np.array([focal, focal, 312.0, 246.0, first, 4e-3, -3e-3, 4e-4])
        photographed = draw_rendered_set(rng, Camera(VGA, lens, "kannala-brandt"))
        story, model = f"fisheye of fx {focal:.0f}, default model", "lucchese"
    else:
        strength = draw_log(rng, 0.01, 1.0)
        params = barrel().params.copy()
        params[4:] *= strength
        photographed = draw_rendered_set(rng, Camera(VGA, params))
        story, model = f"distortion {strength:.3f} times barrel, pinhole", "pinhole"
    return photographed, story, model


def roll_shutter(rng: Rng) -> FaultySet:
    """Move the camera in another direction in each view while the rows are read."""
    photographed = draw_set(rng)
    size, height = draw_log(rng, 0.3, 10.0), photographed.camera.size[1]
    motion = rng.normal(0, size / np.sqrt(2), (len(photographed.poses), 2))

    def shift(k: int, uv: Array) -> Array:
        return np.asarray(uv + (uv[:, 1:] / height - 0.5) * motion[k])

    views = photograph(photographed, shift=shift)
    story = f"rows shift by {size:.1f} px rms from the first to the last"
    return state_fault(photographed, views, story)


def shear_images(rng: Rng) -> FaultySet:
    """Shift the rows of all images sideways in proportion, as where a camera turns evenly."""
    photographed = draw_set(rng)
    size, height = draw_log(rng, 0.3, 10.0), photographed.camera.size[1]
    motion = size if rng.random() < 0.5 else -size

    def shift(_: int, uv: Array) -> Array:
        return np.asarray(uv + (uv[:, 1:] / height - 0.5) * [motion, 0.0])

    views = photograph(photographed, shift=shift)
    return state_fault(photographed, views, f"rows shift by {size:.1f} px, alike in all views")


def roll_images(rng: Rng) -> FaultySet:
    """Turn the rows of all images alike in proportion, as where a camera rolls about its axis.

    Lenses are decentred by as much as a roll of 0.2 degrees.
    """
    photographed = draw_set(rng)
    degrees = draw_log(rng, 0.4, 3.0) * float(rng.choice([-1, 1]))
    views = photograph(photographed, shift=make_roll(photographed.camera, degrees))
    return state_fault(photographed, views, f"rows roll by {degrees:.2f} degrees in all views")


def make_roll(camera: Camera, degrees: float | Array) -> Callable[[int, Array], Array]:
    """Make the shift of corners where the camera rolls between its first row and its last.

    Args:
        camera: the camera.
        degrees: the angle, of all views or (K,) of each.
    """

    def shift(k: int, uv: Array) -> Array:
        angle = np.deg2rad(degrees if isinstance(degrees, float) else degrees[k])
        x, y = (uv - camera.centre).T
        row = y
        for _ in range(20):  # a corner is turned as the row is that it comes to lie in
            turn = angle * row / camera.size[1]
            row = np.sin(turn) * x + np.cos(turn) * y
        return np.asarray(
            camera.centre + np.column_stack([np.cos(turn) * x - np.sin(turn) * y, row])
        )

    return shift


def scale_images(rng: Rng) -> FaultySet:
    """Displace corners by where they lie between the rows that the image was made of."""
    photographed = draw_set(rng)
    period = rng.uniform(1.2, 3.0)
    size = draw_log(rng, 1.0, 4.0) * photographed.level

    def shift(_: int, uv: Array) -> Array:
        between = (uv[:, 1] / period) % 1 - 0.5
        return np.asarray(uv + np.column_stack([0 * between, size * np.sqrt(12) * between]))

    views = photograph(photographed, shift=shift)
    return state_fault(photographed, views, f"{size:.2f} px rms with a period of {period:.2f} px")


def refocus(rng: Rng) -> FaultySet:
    """Let the focus change the focal length from view to view."""
    photographed = draw_set(rng)
    size = draw_log(rng, 5e-4, 3e-2)
    factors = 1 + rng.normal(0, size, len(photographed.poses))
    return _photograph_with_focal_lengths(photographed, factors, f"focus changes f by {size:.2%}")


def zoom(rng: Rng) -> FaultySet:
    """Zoom after half of the views; the truth lies in the middle, as neither half is right."""
    photographed = draw_set(rng)
    factor, count = 1 + draw_log(rng, 0.002, 0.3), len(photographed.poses)
    factors = np.where(np.arange(count) < count // 2, 1.0, factor) / np.sqrt(factor)
    return _photograph_with_focal_lengths(photographed, factors, f"zoom by {factor:.3f} halfway")


def stabilise(rng: Rng) -> FaultySet:
    """Shift every image, as stabilisation does that holds the picture still."""
    photographed = draw_set(rng)
    size = draw_log(rng, 0.5, 30.0)
    shifts = rng.normal(0, size, (len(photographed.poses), 2))
    views = photograph(photographed, shift=lambda k, uv: np.asarray(uv + shifts[k]))
    return state_fault(photographed, views, f"images shifted by {size:.1f} px rms")


def _photograph_with_focal_lengths(
    photographed: PhotographedSet, factors: Array, story: str
) -> FaultySet:
    camera = photographed.camera
    cameras = [change_camera(camera, fx=f, fy=f) for f in factors.tolist()]
    views = photograph(photographed, cameras)
    return state_fault(photographed, views, story)


def mix_cameras(rng: Rng) -> FaultySet:
    """Take some views with another camera of the same kind."""
    photographed = draw_set(rng)
    camera, size = photographed.camera, draw_log(rng, 0.002, 0.1)
    fx, fy, cx, cy, k1 = 1 + rng.normal(0, size, 5)
    other = change_camera(camera, fx=fx, fy=fx * (1 + 0.1 * (fy - 1)), cx=cx, cy=cy, k1=k1)
    count = len(photographed.poses)
    odd = rng.choice(count, int(rng.integers(1, count // 2 + 1)), replace=False)
    cameras = [other if k in odd else camera for k in range(count)]
    views = photograph(photographed, cameras)
    story = f"{len(odd)} of {count} views by a camera that differs by {size:.1%}"
    return state_fault(photographed, views, story)


def correct_some(rng: Rng) -> FaultySet:
    """Take away the distortion, or part of it, from some views, as phones and programs do."""
    photographed = draw_set(rng)
    camera, part = photographed.camera, rng.uniform(0.3, 1.0)
    factors = np.where(np.arange(len(camera.params)) < 4, 1.0, 1 - part)
    other = Camera(camera.size, camera.params * factors, camera.model)
    count = len(photographed.poses)
    odd = rng.choice(count, int(rng.integers(2, count // 2 + 1)), replace=False)
    views = photograph(photographed, [other if k in odd else camera for k in range(count)])
    story = f"{len(odd)} of {count} views without {part:.0%} of the distortion"
    return state_fault(photographed, views, story)


def hold_value(rng: Rng) -> FaultySet:
    """Hold fx or k1 at a wrong value."""
    photographed = draw_set(rng)
    truth = dict(zip(photographed.camera.names, photographed.camera.params.tolist(), strict=True))
    sign = 1.0 if rng.random() < 0.5 else -1.0
    if rng.random() < 0.5:
        held = {"fx": truth["fx"] * (1 + draw_log(rng, 0.003, 0.8)) ** sign}
    else:
        held = {"k1": truth["k1"] + sign * draw_log(rng, 0.03, 50.0)}
    ((name, value),) = held.items()
    story = f"{name} held at {value:.4g} for {truth[name]:.4g}"
    return state_fault(photographed, photograph(photographed), story, fix=held)

"""Photographs of checkerboards that people have and that finders have lost, with their truth.

Each of the `TROUBLES` is a function from a seed to a `Photograph`; size, pose, blur and noise of
the board vary with the seed, and so does the trouble. Those of cameras, boards and places have
files of their own.
"""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np

from tests.scenes.camera import Camera
from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions
from tests.scenes.creases import draw_corner_of_room
from tests.scenes.photograph import (
    Photograph,
    Trouble,
    add_noise,
    as_bytes,
    as_grey,
    shift_image,
    vary,
)
from tests.scenes.troubles_of_boards import BOARDS
from tests.scenes.troubles_of_cameras import CAMERAS
from tests.scenes.troubles_of_places import PLACES


def _plain(settings: dict[str, Any]) -> Trouble:
    """Photographs under the `settings` alone."""

    def photograph(seed: int) -> Photograph:
        scene = draw(vary(seed, **settings), seed)
        return Photograph(scene.photograph(seed), (scene.uv,))

    return photograph


def interlaced(seed: int) -> Photograph:
    """Odd and even rows taken one after the other, 0.3 to 4 px apart, mostly sideways. The truth
    is in the middle."""
    rng = np.random.default_rng([seed, 23])
    scene = draw(vary(seed), seed)
    motion = rng.uniform(0.3, 4.0) * np.array([1.0, rng.uniform(-0.3, 0.3)])
    image = shift_image(scene.clean, motion / 2)
    image[1::2] = shift_image(scene.clean, -motion / 2)[1::2]
    return Photograph(as_bytes(add_noise(image, scene.conditions.noise, seed)), (scene.uv,))


def halos(seed: int) -> Photograph:
    """A video signal sharpened to one side: behind every edge it overshoots for 1.5 to 3 px, in
    interlaced frames of motion up to 2.5 px."""
    rng = np.random.default_rng([seed, 24])
    scene = draw(vary(seed), seed)
    motion = np.array([rng.uniform(0.0, 1.25), 0.0])
    image = shift_image(scene.clean, motion)
    image[1::2] = shift_image(scene.clean, -motion)[1::2]
    noisy = add_noise(image, scene.conditions.noise / 2, seed)
    before = shift_image(noisy, np.array([rng.uniform(1.5, 3.0), 0.0]))
    return Photograph(as_bytes(noisy + rng.uniform(0.3, 0.8) * (noisy - before)), (scene.uv,))


def crease(seed: int) -> Photograph:
    """Two boards on two walls, 0.1 to 1 square of paper between them."""
    rng = np.random.default_rng([seed, 25])
    rows = int(rng.integers(5, 8))
    cols = (int(rng.integers(4, 8)), int(rng.integers(4, 8)))
    gap = rng.uniform(0.05, 0.5, 2)
    square = 420 / (sum(cols) + 4)
    conditions = Conditions(
        grid_size=(rows, cols[0]),
        square=square,
        tilt=rng.uniform(20, 40),
        turn=8.0,
        centre=(-square * (cols[1] / 2 + 1) * 0.8, 0.0),
        blur=rng.uniform(0.5, 1.0),
        noise=rng.uniform(0.5, 3.0),
        parts=2,
    )
    for k in range(1000):
        levels, boards = draw_corner_of_room(
            conditions, cols, gap, rng.uniform(50, 100), 1000 * seed + k
        )
        uv = np.concatenate([board.reshape(-1, 2) for board in boards])
        steps = [np.linalg.norm(np.diff(b, axis=a), axis=2).min() for b in boards for a in (0, 1)]
        if (uv > 15).all() and (uv < np.array([625, 465])).all() and min(steps) > 10:
            break
    return Photograph(as_bytes(add_noise(levels, conditions.noise, seed)), boards)


def curved(seed: int) -> Photograph:
    """A board under a fisheye, near and slanted: in some corners its edges cross at 25 to 40
    degrees."""
    rng = np.random.default_rng([seed, 26])
    while True:
        conditions = vary(
            seed,
            fisheye=True,
            focal=rng.uniform(0.25, 0.4),
            tilt=rng.uniform(35, 65),
            turn=180.0,
            square=rng.uniform(24, 50),
            shift=60.0,
        )
        pose = int(rng.integers(1 << 30))
        camera = Camera(conditions, np.random.default_rng(pose))
        rows, cols = conditions.grid_size
        x, y = np.meshgrid(np.arange(-1.0, cols + 1), np.arange(-1.0, rows + 1))
        uv = camera.image_from_board(x, y)
        inside = (uv > 8).all() and (uv < np.array(conditions.size) - 9).all()
        right, down = np.diff(uv, axis=1)[1:-1], np.diff(uv, axis=0)[:, 1:-1]
        steps = [np.linalg.norm(step, axis=2) for step in (right, down)]
        if not inside or min(step.min() for step in steps) < 9:
            continue
        a, b = right[:, 1:], down[1:]
        sine = abs(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]) / (steps[0][:, 1:] * steps[1][1:])
        if 25 < np.degrees(np.arcsin(sine.min())) < 40:
            scene = draw(conditions, pose)
            return Photograph(scene.photograph(seed), (scene.uv,))


def blurred(seed: int) -> Photograph:
    """A board out of focus, blurred by 5 px, with squares of 24 to 38 px."""
    rng = np.random.default_rng([seed, 34])
    grid_size = ((6, 9), (5, 8), (5, 7))[seed % 3]
    scene = draw(vary(seed, blur=5.0, square=rng.uniform(24, 38), grid_size=grid_size), seed)
    return Photograph(scene.photograph(seed), (scene.uv,))


def video(seed: int) -> Photograph:
    """A frame of a film: blocks of 8 x 8 px of few coefficients, colours at half the resolution."""
    rng = np.random.default_rng([seed, 27])
    scene = draw(vary(seed), seed)
    noisy = add_noise(scene.clean, scene.conditions.noise, seed)
    colour = as_bytes(noisy[..., None] * rng.uniform(0.7, 1.0, 3))
    quality = [cv2.IMWRITE_JPEG_QUALITY, int(rng.integers(12, 40))]
    coded = cv2.imencode(".jpg", colour, quality)[1]
    return Photograph(as_grey(cv2.imdecode(coded, cv2.IMREAD_COLOR)), (scene.uv,))


def mosaic(seed: int) -> Photograph:
    """Colours interpolated from a Bayer mosaic, under light that is not white."""
    rng = np.random.default_rng([seed, 28])
    scene = draw(vary(seed), seed)
    gains = rng.uniform(0.5, 1.0, 3)
    raw = scene.clean.copy()
    for row, col, channel in ((0, 0, 2), (0, 1, 1), (1, 0, 1), (1, 1, 0)):
        raw[row::2, col::2] *= gains[channel]
    raw = as_bytes(add_noise(raw, scene.conditions.noise, seed))
    return Photograph(as_grey(cv2.cvtColor(raw, cv2.COLOR_BayerBG2BGR)), (scene.uv,))


def raw_mosaic(seed: int) -> Photograph:
    """A Bayer mosaic read as grey levels: red and blue pixels are darker than their neighbours."""
    rng = np.random.default_rng([seed, 29])
    scene = draw(vary(seed), seed)
    raw = scene.clean.copy()
    raw[::2, ::2] *= rng.uniform(0.7, 0.95)
    raw[1::2, 1::2] *= rng.uniform(0.7, 0.95)
    return Photograph(as_bytes(add_noise(raw, scene.conditions.noise, seed)), (scene.uv,))


def thermal(seed: int) -> Photograph:
    """16 bits of which 100 to 400 levels are used, blurred, with noise by columns, often
    inverted."""
    rng = np.random.default_rng([seed, 30])
    scene = draw(vary(seed, blur=rng.uniform(1.2, 2.0)), seed)
    contrast = rng.uniform(100, 400)
    levels = contrast * (scene.clean - 45) / 160 * rng.choice([-1.0, 1.0])
    levels += 0.03 * contrast * rng.standard_normal(levels.shape)
    levels += 0.015 * contrast * rng.standard_normal(levels.shape[1])
    return Photograph(np.rint(8000 + levels).astype(np.uint16), (scene.uv,))


def infrared(seed: int) -> Photograph:
    """8 bits in which ink is hardly darker than paper: 12 to 30 grey levels."""
    rng = np.random.default_rng([seed, 31])
    dark = rng.uniform(60, 150)
    settings = {"dark": dark, "bright": dark + rng.uniform(12, 30), "noise": rng.uniform(0.5, 2.0)}
    scene = draw(vary(seed, **settings), seed)
    return Photograph(scene.photograph(seed), (scene.uv,))


def inverted(seed: int) -> Photograph:
    """Bright squares on dark paper."""
    scene = draw(vary(seed), seed)
    return Photograph(255 - scene.photograph(seed), (scene.uv,))


def screen(seed: int) -> Photograph:
    """A board on a screen whose pixels beat with the camera's."""
    rng = np.random.default_rng([seed, 32])
    scene = draw(vary(seed), seed)
    v, u = np.mgrid[: scene.clean.shape[0], : scene.clean.shape[1]]
    beat = np.zeros(scene.clean.shape)
    for turn in rng.uniform(0, np.pi) + np.array([0.0, np.pi / 2]):
        wave = rng.uniform(6, 60)
        warp = rng.uniform(0.5, 2.0) * np.sin(u / rng.uniform(80, 200) + v / rng.uniform(80, 200))
        phase = 2 * np.pi * (np.cos(turn) * u + np.sin(turn) * v) / wave
        beat += np.sin(phase + warp + rng.uniform(0, 6))
    lit = scene.clean * (1 + rng.uniform(0.05, 0.15) * beat)
    return Photograph(as_bytes(add_noise(lit, scene.conditions.noise, seed)), (scene.uv,))


def glass(seed: int) -> Photograph:
    """A board behind a pane, which reflects lamps and windows and doubles the board faintly."""
    rng = np.random.default_rng([seed, 33])
    scene = draw(vary(seed), seed)
    ghost = rng.uniform(0.03, 0.12)
    image = scene.clean + ghost * shift_image(scene.clean, rng.uniform(-4, 4, 2))
    reflected = np.zeros(image.shape)
    for _ in range(rng.integers(1, 4)):
        centre = rng.uniform(0.1, 0.9, 2) * image.shape[::-1]
        polygon = centre + rng.uniform(40, 160) * rng.uniform(-1, 1, (4, 2))
        cv2.fillConvexPoly(reflected, cv2.convexHull(polygon.astype(np.int32)), rng.uniform(15, 60))
    image += cv2.GaussianBlur(reflected, (0, 0), rng.uniform(2, 10))
    return Photograph(as_bytes(add_noise(image, scene.conditions.noise, seed)), (scene.uv,))


TROUBLES: dict[str, Trouble] = {
    "interlaced": interlaced,
    "halos to one side": halos,
    "crease": crease,
    "curved": curved,
    "marks in squares": _plain({"marks": True}),
    "blur 5 px": blurred,
    "ink -8 %": _plain({"ink": -0.08}),
    "ink 8 %": _plain({"ink": 0.08}),
    "video": video,
    "mosaic": mosaic,
    "raw mosaic": raw_mosaic,
    "thermal": thermal,
    "infrared": infrared,
    "inverted": inverted,
    "screen": screen,
    "glass": glass,
    **CAMERAS,
    **BOARDS,
    **PLACES,
}
"""What troubles the finder, by name."""

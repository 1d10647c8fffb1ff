"""Photographs of boards that the camera, its light or its hold has spoilt, with their truth."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
from scipy.ndimage import map_coordinates

from tests.scenes.camera import Camera
from tests.scenes.checkerboards import Scene, draw
from tests.scenes.photograph import Array, Image, Photograph, Trouble, add_noise, as_bytes, vary


def _scene(seed: int, **settings: Any) -> tuple[Scene, np.random.Generator]:
    """A scene under varied conditions, and what the trouble's numbers are drawn from."""
    return draw(vary(seed, **settings), seed), np.random.default_rng([seed, 40])


def _finish(scene: Scene, levels: Array, seed: int, **known: Any) -> Photograph:
    """The photograph of a scene of which the grey `levels` have been changed."""
    return Photograph(
        as_bytes(add_noise(levels, scene.conditions.noise, seed)), (scene.uv,), **known
    )


def _jpeg(image: Image, quality: int) -> Image:
    coded = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, quality])[1]
    return np.asarray(cv2.imdecode(coded, cv2.IMREAD_GRAYSCALE))


def _spread(levels: Array, sigma: float) -> Array:
    return np.asarray(cv2.GaussianBlur(levels, (0, 0), sigma))


def _sharpen(levels: Array, sigma: float, amount: float) -> Array:
    return levels + amount * (levels - _spread(levels, sigma))


def bend_image(scene: Scene, offset: Callable[[Array, Array], tuple[Array, Array]]) -> Photograph:
    """The noiseless photograph that shows at (u, v) what the scene has at (u, v) + `offset`."""
    v, u = np.mgrid[: scene.clean.shape[0], : scene.clean.shape[1]].astype(np.float64)
    du, dv = offset(u, v)
    uv = scene.uv.copy()
    for _ in range(50):
        uv = scene.uv - np.stack(offset(uv[..., 0], uv[..., 1]), axis=-1)
    return Photograph(map_coordinates(scene.clean, (v + dv, u + du), mode="nearest"), (uv,))


def glare(seed: int) -> Photograph:
    """Lamps that a glossy board reflects: white spots of 1 to 3 squares with halos around."""
    scene, rng = _scene(seed)
    square = scene.conditions.square
    light = np.zeros(scene.clean.shape)
    for _ in range(rng.integers(1, 4)):
        corner = scene.uv[tuple(rng.integers(0, n) for n in scene.uv.shape[:2])]
        axes = rng.uniform(0.5, 1.5, 2) * square
        centre = tuple(map(int, corner + rng.uniform(-1, 1, 2) * square))
        axes = tuple(map(int, axes))
        cv2.ellipse(light, centre, axes, rng.uniform(0, 180), 0, 360, rng.uniform(300, 900), -1)
    light = _spread(light, rng.uniform(1, 5)) + 0.05 * _spread(light, 2 * square)
    at = np.clip(np.rint(scene.uv), 0, np.array(scene.conditions.size) - 1).astype(int)
    lit = cv2.dilate(light, np.ones((2 * int(square / 3) + 1,) * 2))[at[..., 1], at[..., 0]]
    return _finish(scene, scene.clean + light, seed, hidden=lit > 40)


def zoomed(seed: int) -> Photograph:
    """A digital zoom of 2 or 3, sharpened beyond what is there."""
    rng = np.random.default_rng([seed, 41])
    zoom = float(rng.choice([2, 3]))
    conditions = vary(seed)
    width, height = conditions.size
    small = draw(
        vary(
            seed,
            size=(round(width / zoom), round(height / zoom)),
            square=1.2 * conditions.square / zoom,
            shift=5.0,
        ),
        seed,
    )
    levels = add_noise(small.clean, conditions.noise / 2, seed)
    kind = rng.choice([cv2.INTER_CUBIC, cv2.INTER_LINEAR, cv2.INTER_LANCZOS4])
    large = cv2.resize(levels, conditions.size, interpolation=int(kind))
    image = as_bytes(_sharpen(large, rng.uniform(1.0, 2.5), rng.uniform(0.8, 2.5)))
    scale = np.array(conditions.size) / np.array(small.conditions.size)
    return Photograph(image, ((small.uv + 0.5) * scale - 0.5,))


def repeated(seed: int) -> Photograph:
    """Pixels binned by 2 x 2, or left out, and repeated to the old size."""
    scene, rng = _scene(seed)
    image = add_noise(scene.clean, scene.conditions.noise, seed)
    height, width = image.shape
    size = (width // 2, height // 2)
    if rng.random() < 0.5:
        small, uv = cv2.resize(image, size, interpolation=cv2.INTER_AREA), scene.uv
    else:
        small, uv = image[::2, ::2], scene.uv + 0.5
    image = np.repeat(np.repeat(small, 2, axis=0), 2, axis=1)
    return Photograph(as_bytes(image), (uv,))


def webcam(seed: int) -> Photograph:
    """320 x 240 pixels: soft, noisy, sharpened and compressed."""
    rng = np.random.default_rng([seed, 42])
    grid_size = ((6, 9), (5, 8), (4, 6), (7, 10))[seed % 4]
    scene = draw(
        vary(
            seed,
            size=(320, 240),
            grid_size=grid_size,
            square=rng.uniform(0.6, 0.85) * 240 / (grid_size[1] + 2),
            shift=8.0,
            blur=rng.uniform(0.8, 1.3),
            distortion=rng.uniform(0.0, 0.15),
        ),
        seed,
    )
    noisy = _spread(add_noise(scene.clean, rng.uniform(3, 10), seed), 0.6)
    sharp = as_bytes(_sharpen(noisy, 1.0, rng.uniform(0.3, 1.2)))
    return Photograph(_jpeg(sharp, int(rng.integers(30, 75))), (scene.uv,))


def overexposed(seed: int) -> Photograph:
    """Much too bright: white is clipped and blooms over the dark squares."""
    scene, rng = _scene(seed)
    light = rng.uniform(1.5, 3.0) * (scene.clean - 20)
    bloom = _spread(np.maximum(light - 255, 0), rng.uniform(1.5, 4))
    return _finish(scene, np.minimum(light + rng.uniform(0.1, 0.6) * bloom, 255), seed)


def underexposed(seed: int) -> Photograph:
    """Much too dark: 8 to 25 grey levels, black is clipped, and noise by pixels and rows."""
    scene, rng = _scene(seed)
    contrast = rng.uniform(8, 25)
    levels = contrast * (scene.clean - 45) / 160 + rng.uniform(-1, 4)
    levels += 0.1 * contrast * rng.standard_normal(levels.shape)
    levels += 0.03 * contrast * rng.standard_normal((len(levels), 1))
    return Photograph(as_bytes(levels), (scene.uv,))


def shadow(seed: int) -> Photograph:
    """A hard shadow over a part of the board. What grey levels keep of the light is more than the
    light has, since cameras lift dark tones."""
    rng = np.random.default_rng([seed, 43])
    turn, place = rng.uniform(0, 2 * np.pi), rng.uniform(-2, 2)
    depth, soft, wave = rng.uniform(0.25, 0.6), rng.uniform(0.02, 0.3), rng.uniform(0, 1)
    conditions = vary(seed)
    rows, cols = conditions.grid_size

    def cast(paper: Array, x: Array, y: Array) -> Array:
        x, y = (np.clip(c, -50, 50) for c in (x - (cols - 1) / 2, y - (rows - 1) / 2))
        across = np.cos(turn) * x + np.sin(turn) * y - place
        across += wave * np.sin(np.cos(turn) * y - np.sin(turn) * x)
        return paper * (depth + (1 - depth) / (1 + np.exp(-np.clip(across / soft, -50, 50))))

    scene = draw(conditions, seed, cast)
    return Photograph(scene.photograph(seed), (scene.uv,))


def lamp(seed: int) -> Photograph:
    """A single lamp: a few times brighter at one end of the board than at the other."""
    scene, rng = _scene(seed, light=0.0)
    v, u = np.mgrid[: scene.clean.shape[0], : scene.clean.shape[1]]
    place = scene.uv.reshape(-1, 2)[rng.integers(scene.uv[..., 0].size)]
    r2 = ((u - place[0]) ** 2 + (v - place[1]) ** 2) / rng.uniform(120, 250) ** 2
    return _finish(scene, scene.clean * rng.uniform(1.0, 1.4) / (1 + r2), seed)


def shaken(seed: int) -> Photograph:
    """Motion of 3 to 8 px while the shutter was open."""
    rng = np.random.default_rng([seed, 44])
    grid_size = ((6, 9), (5, 8), (5, 7), (7, 10))[seed % 4]
    motion = rng.uniform(3, 8)
    square = max(rng.uniform(24, 36), 3.5 * motion)
    scene = draw(vary(seed, grid_size=grid_size, square=square, motion=motion), seed)
    return Photograph(scene.photograph(seed), (scene.uv,))


def defocused(seed: int) -> Photograph:
    """Out of focus through a round aperture: every point is a disc of 2.5 to 6 px radius."""
    rng = np.random.default_rng([seed, 45])
    radius = rng.uniform(2.5, 6)
    grid_size = ((6, 9), (5, 8), (5, 7))[seed % 3]
    square = max(rng.uniform(24, 36), 5 * radius)
    scene = draw(vary(seed, grid_size=grid_size, square=square), seed)
    reach = int(np.ceil(radius)) + 1
    grid = np.arange(-reach, reach + 1)
    disc = np.clip(radius + 0.5 - np.hypot(grid, grid[:, None]), 0, 1)
    levels = cv2.filter2D(scene.clean, -1, disc / disc.sum(), borderType=cv2.BORDER_REPLICATE)
    return _finish(scene, np.asarray(levels), seed)


def wobbling(seed: int) -> Photograph:
    """Rows read one after the other while the camera shakes: 1 to 4 px to the sides."""
    scene, rng = _scene(seed)
    size, wave, phase = rng.uniform(1, 4), rng.uniform(120, 400), rng.uniform(0, 6)

    def offset(u: Array, v: Array) -> tuple[Array, Array]:
        return size * np.sin(2 * np.pi * v / wave + phase) + 0 * u, 0 * v

    bent = bend_image(scene, offset)
    noisy = add_noise(bent.image, scene.conditions.noise, seed)
    return Photograph(as_bytes(noisy), bent.boards)


def equalised(seed: int) -> Photograph:
    """Local contrast stretched, as for a report, and sharpened or not."""
    scene, rng = _scene(seed)
    image = scene.photograph(seed)
    clip, tiles = rng.uniform(2, 10), int(rng.integers(4, 12))
    image = cv2.createCLAHE(clip, (tiles, tiles)).apply(image)
    if rng.random() < 0.5:
        image = as_bytes(_sharpen(image.astype(np.float64), 1.0, rng.uniform(0.5, 1.5)))
    return Photograph(image, (scene.uv,))


def two_levels(seed: int) -> Photograph:
    """Black and white and nothing between, as scanners and thresholds make it."""
    scene, rng = _scene(seed, light=0.0)
    noisy = add_noise(scene.clean, scene.conditions.noise, seed)
    level = np.quantile(scene.clean, (0.02, 0.98)).mean() + rng.uniform(-25, 25)
    return Photograph(as_bytes(255.0 * (noisy > level)), (scene.uv,))


def dead_pixels(seed: int) -> Photograph:
    """Pixels that are black or white whatever they see: 0.02 to 0.5 %."""
    scene, rng = _scene(seed)
    image = scene.photograph(seed)
    dead = rng.random(image.shape) < rng.uniform(0.0002, 0.005)
    image[dead] = rng.choice([0, 255], np.count_nonzero(dead))
    return Photograph(image, (scene.uv,))


def hot_pixels(seed: int) -> Photograph:
    """A dim picture of a cheap sensor: columns of levels of their own, and 0.05 to 0.4 % of pixels
    that are white whatever they see."""
    rng = np.random.default_rng([seed, 48])
    scene, _ = _scene(seed, noise=rng.uniform(3, 8), light=0.6)
    levels = add_noise(0.5 * scene.clean, scene.conditions.noise, seed)
    levels += rng.uniform(2, 8) * rng.standard_normal((1, levels.shape[1]))
    image = as_bytes(levels)
    image[rng.random(image.shape) < rng.uniform(0.0005, 0.004)] = 255
    return Photograph(image, (scene.uv,))


def steep(seed: int) -> Photograph:
    """A board seen from the side, at 60 to 70 degrees, in sharp focus where it is near."""
    rng = np.random.default_rng([seed, 46])
    grid_size = ((6, 9), (5, 8), (7, 10))[seed % 3]
    settings = {"tilt": rng.uniform(60, 70), "grid_size": grid_size, "square": rng.uniform(38, 46)}
    for pose in range(1000 * seed, 1000 * seed + 1000):
        scene_conditions = vary(seed, **settings)
        camera = Camera(scene_conditions, np.random.default_rng(pose))
        x, y = np.meshgrid(np.arange(-0.5, grid_size[1]), np.arange(-0.5, grid_size[0]))
        uv = camera.image_from_board(x, y)
        if (uv > 3).all() and (uv < np.array(scene_conditions.size) - 4).all():
            break
    scene = draw(scene_conditions, pose)
    return Photograph(scene.photograph(seed), (scene.uv,))


def image_circle(seed: int) -> Photograph:
    """A fisheye whose round image the board leaves."""
    rng = np.random.default_rng([seed, 47])
    conditions = vary(
        seed,
        fisheye=True,
        focal=rng.uniform(0.25, 0.35),
        square=rng.uniform(28, 40),
        grid_size=((6, 9), (7, 10))[seed % 2],
        centre=(rng.uniform(-90, 90), rng.uniform(-60, 60)),
    )
    scene = draw(conditions, seed)
    width, height = conditions.size
    v, u = np.mgrid[:height, :width]
    radius = rng.uniform(190, 235)
    beyond = np.hypot(u - width / 2, v - height / 2) - radius
    levels = 5 + (scene.clean - 5) * np.clip(0.5 - beyond / rng.uniform(1, 4), 0, 1)
    off = np.linalg.norm(scene.uv - np.array([width, height]) / 2, axis=2) - radius
    hidden = (off > -scene.spacing / 2 - 3) | ~scene.visible
    return _finish(scene, levels, seed, hidden=hidden)


CAMERAS: dict[str, Trouble] = {
    "glare": glare,
    "zoomed": zoomed,
    "repeated pixels": repeated,
    "webcam": webcam,
    "overexposed": overexposed,
    "underexposed": underexposed,
    "shadow": shadow,
    "lamp": lamp,
    "shaken": shaken,
    "defocused": defocused,
    "wobbling": wobbling,
    "equalised": equalised,
    "two levels": two_levels,
    "dead pixels": dead_pixels,
    "hot pixels": hot_pixels,
    "steep": steep,
    "image circle": image_circle,
}
"""What cameras do to boards, by name."""

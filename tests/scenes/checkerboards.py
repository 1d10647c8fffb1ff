"""Photographs of checkerboards with exact truth, drawn independently of the engine.

Each pixel is divided into parts, 4 x 4 by default, and each part is mapped to the board: through
the lens (from the distorted to the ideal point, in closed form), the perspective and the board's
own frame (`tests.scenes.camera`). A part is dark by the area that dark squares cover of it, exactly
for straight edges. What hides the board (`tests.scenes.occluders`), light, point spread, motion and
response follow in the order in which a camera applies them; noise and rounding last.

The grey levels around a corner are point symmetric but for perspective, curvature and shading,
whatever the blur and the response: `tests/scenes/test_checkerboards.py` holds the renderer
to that.

`Scene.bound` is the Cramer-Rao bound of every corner: noise^2 F^-1 with F = sum of
(grad I)(grad I)^T over the corner's own cell, half a square each way, the gradient taken before
the pixels integrate it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from tests.scenes.camera import Camera
from tests.scenes.conditions import Conditions
from tests.scenes.marks import marks
from tests.scenes.occluders import occluder

Array = NDArray[np.float64]
Dress = Callable[[Array, Array, Array], Array]
"""A function from the reflectance of parts of pixels, and their places (x, y) on the board in
squares, to what it is instead; all of them (h, w)."""
_PARTS_PER_BAND = 1 << 16
"""Number of parts of pixels that are worked on at a time: their arrays stay in the cache."""


@dataclass(frozen=True)
class Scene:
    conditions: Conditions
    clean: Array
    """(h, w) grey levels 0..255 before noise and rounding."""
    uv: Array
    """(rows, cols, 2) true corners."""
    covered: NDArray[np.bool_]
    """(h, w) pixels where something hides the board."""
    fisher: Array | None = None
    """(rows, cols, 2, 2) sum of (grad I)(grad I)^T, grey levels^2 per px^2, if asked for."""

    def photograph(self, seed: int) -> NDArray[np.uint8] | NDArray[np.uint16]:
        """(h, w) with noise, rounded and clipped."""
        noise = np.random.default_rng(seed).standard_normal(self.clean.shape)
        values = self.clean + self.conditions.noise * noise
        if self.conditions.deep:
            return np.clip(np.rint(values * 257), 0, 65535).astype(np.uint16)
        return np.clip(np.rint(values), 0, 255).astype(np.uint8)

    @property
    def bound(self) -> Array:
        """(rows, cols, 2, 2) least covariance of an unbiased estimate, px^2."""
        assert self.fisher is not None, "the scene was drawn without its bound"
        rounding = 0.0 if self.conditions.deep else 1 / 12
        return (self.conditions.noise**2 + rounding) * np.linalg.inv(self.fisher)

    @property
    def visible(self) -> NDArray[np.bool_]:
        """(rows, cols) corners with a third of a square all around in the image and uncovered."""
        margin = self.spacing / 3
        limit = np.array(self.conditions.size) - 1 - margin[..., None]
        inside = np.all((self.uv > margin[..., None]) & (self.uv < limit), axis=2)
        clear = cv2.distanceTransform((~self.covered).astype(np.uint8), cv2.DIST_L2, 5)
        last = np.array(self.conditions.size) - 1
        u, v = np.moveaxis(np.clip(np.rint(self.uv), 0, last).astype(int), -1, 0)
        return np.asarray(inside & (clear[v, u] > margin))

    @property
    def spacing(self) -> Array:
        """(rows, cols) distance from each corner to the nearest other, px."""
        around = np.pad(self.uv, ((1, 1), (1, 1), (0, 0)), constant_values=np.inf)
        steps = (around[:-2, 1:-1], around[2:, 1:-1], around[1:-1, :-2], around[1:-1, 2:])
        return np.asarray(np.min([np.linalg.norm(p - self.uv, axis=2) for p in steps], axis=0))


def draw(
    conditions: Conditions, seed: int, dress: Dress | None = None, with_bound: bool = False
) -> Scene:
    """A photograph's scene; the pose and what else is random follow from `seed`.

    Args:
        conditions: the photograph's.
        seed: of what is random.
        dress: what is changed of the reflectance, if anything is.
        with_bound: whether `Scene.bound` is wanted, which has its price.
    """
    rng = np.random.default_rng(seed)
    camera = Camera(conditions, rng)
    rows, cols = conditions.grid_size
    width, height = conditions.size
    parts = conditions.parts
    fine_u = (np.arange(width * parts) + 0.5) / parts - 0.5
    fine_v = (np.arange(height * parts) + 0.5) / parts - 0.5
    x, y = np.empty((2, len(fine_v), len(fine_u)))
    for band in _split_rows(x):
        x[band], y[band] = camera.board_from_image(fine_u[None], fine_v[band, None])
    irradiance = _paper(x, y, conditions, rng)
    if dress is not None:
        irradiance = dress(irradiance, x, y)
    if conditions.marks:
        irradiance[marks(x, y, conditions.grid_size, np.random.default_rng([seed, 2]))] = 0.0
    hidden = np.zeros((height, width), np.bool_)
    if conditions.occluder:
        covered, shade = occluder(conditions, camera, np.random.default_rng([seed, 1]))
        irradiance[covered] = shade[covered]
        hidden = _pixels(covered.astype(float), parts) > 0
    _light(irradiance, conditions, fine_u[None], fine_v[:, None], rng)
    irradiance = _blurred(irradiance, conditions, rng)
    ideal = _response(irradiance, conditions)

    n, m = np.meshgrid(np.arange(cols), np.arange(rows))
    uv = camera.image_from_board(n.astype(float), m.astype(float))
    fisher = _sum_information(ideal, x, y, conditions) if with_bound else None
    return Scene(conditions, _pixels(ideal, parts), uv, hidden, fisher)


def _split_rows(image: Array) -> list[slice]:
    """Bands of rows that hold `_PARTS_PER_BAND` or one row."""
    step = max(1, _PARTS_PER_BAND // image.shape[1])
    return [slice(k, min(k + step, len(image))) for k in range(0, len(image), step)]


def _sum_information(ideal: Array, x: Array, y: Array, conditions: Conditions) -> Array:
    """Sum of (grad I)(grad I)^T over each corner's cell, (rows, cols, 2, 2)."""
    (rows, cols), parts = conditions.grid_size, conditions.parts
    slope_v, slope_u = np.gradient(ideal, 1 / parts)
    gu, gv, at_x, at_y = (_pixels(fine, parts) for fine in (slope_u, slope_v, x, y))
    fisher = np.zeros((rows, cols, 2, 2))
    cell = np.stack([np.rint(at_y), np.rint(at_x)], axis=-1)
    inside = (cell >= 0).all(axis=-1) & (cell < np.array([rows, cols])).all(axis=-1)
    index = cell[inside].astype(int)
    g = np.stack([gu[inside], gv[inside]], axis=-1)
    np.add.at(fisher, (index[:, 0], index[:, 1]), g[:, :, None] * g[:, None, :])
    return fisher + 1e-12 * np.eye(2)


def _paper(x: Array, y: Array, conditions: Conditions, rng: np.random.Generator) -> Array:
    """Reflectance of what each part of a pixel sees, 0 dark to 1 bright."""
    rows, cols = conditions.grid_size
    paper = _background(x.shape, conditions, rng)
    for band in _split_rows(x):
        a, b = x[band], y[band]
        quiet = abs(a - (cols - 1) / 2) < (cols + 1) / 2 + conditions.quiet
        quiet &= abs(b - (rows - 1) / 2) < (rows + 1) / 2 + conditions.quiet
        paper[band][quiet] = 1.0
        on_board = (a > -1) & (a < cols) & (b > -1) & (b < rows)
        across = np.flatnonzero(on_board.any(axis=0))
        if len(across):
            part = slice(across[0], across[-1] + 1)
            share = _bright_share(x, y, band, part, conditions.ink)
            np.copyto(paper[band, part], share, where=on_board[:, part])
    return paper


def _bright_share(x: Array, y: Array, rows: slice, cols: slice, ink: float) -> Array:
    """How much of each part is paper without ink, in those rows and columns of parts."""
    with np.errstate(invalid="ignore"):
        (odd_x, even_x), (odd_y, even_y) = (_cover(c, rows, cols, abs(ink)) for c in (x, y))
    if ink < 0:
        return 1 - odd_x * odd_y - even_x * even_y
    return odd_x * even_y + even_x * odd_y


def _cover(c: Array, rows: slice, cols: slice, ink: float) -> tuple[Array, Array]:
    """How much of each part lies in odd, and in even, squares along one coordinate `c` of the
    board, these being `ink` narrower on both sides: exactly, for a straight edge.

    A half plane at the signed distance d covers a unit square with the normal (a, b) by
    (R(d + (a + b)/2) - R(d + (a - b)/2) - R(d - (a - b)/2) + R(d - (a + b)/2)) / (a b), R(t) =
    max(t, 0)^2 / 2.
    """
    around = tuple(slice(max(part.start - 1, 0), part.stop + 1) for part in (rows, cols))
    inner = tuple(
        slice(part.start - wide.start, part.stop - wide.start)
        for part, wide in zip((rows, cols), around, strict=True)
    )
    slopes = [slope[inner] for slope in np.gradient(c[around])]
    c = c[rows, cols]
    reach = (np.abs(slopes[0]) + np.abs(slopes[1])) / 2
    place = c - 2 * np.floor(c / 2)
    within = place - (place >= 1)
    to_edge = np.minimum(within, 1 - within)
    inside_odd = np.where(place >= 1, to_edge, -to_edge)

    def cover(distance: Array) -> Array:
        share = (distance > 0).astype(np.float64)
        cut = np.abs(distance) < reach  # no edge goes through the others
        normal = np.array([slope[cut] for slope in slopes])
        steep = np.hypot(*normal)
        d = distance[cut] / steep
        a, b = np.maximum(np.abs(normal) / steep, 1e-3)
        total = np.zeros_like(d)
        for sa, sb in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
            total += sa * sb * np.maximum(d + (sa * a + sb * b) / 2, 0) ** 2 / 2
        share[cut] = np.clip(total / (a * b), 0, 1)
        return share

    odd = cover(inside_odd - ink)
    return odd, (1 - odd if ink == 0 else cover(-inside_odd - ink))


def _background(shape: tuple[int, ...], conditions: Conditions, rng: np.random.Generator) -> Array:
    """Plain, or a litter of polygons and grids of the board's own size."""
    image = np.full(shape, 0.55, dtype=np.float64)
    if not conditions.clutter:
        return image
    scale = conditions.square * conditions.parts
    for _ in range(150):
        corners = rng.uniform(0, 1, 2) * np.array(shape[::-1])
        polygon = corners + rng.uniform(-2, 2, (rng.integers(3, 6), 2)) * scale
        cv2.fillPoly(image, [polygon.astype(np.int32)], float(rng.uniform(0, 1)))
    return image


def _light(
    irradiance: Array, conditions: Conditions, u: Array, v: Array, rng: np.random.Generator
) -> None:
    """Let less than all light fall on parts of pixels, which see `irradiance` of it."""
    width, height = conditions.size
    about = rng.uniform(0, 2 * np.pi)
    spot = rng.uniform(0.25, 0.75, 2) * np.array([width, height])
    if conditions.light == 0:
        return
    along_u, along_v = np.cos(about) * (u / width - 0.5), np.sin(about) * (v / height - 0.5)
    spot_u, spot_v = (
        np.exp(-(((c - middle) / (0.15 * width)) ** 2) / 2)
        for c, middle in zip((u, v), spot, strict=True)
    )
    for band in _split_rows(irradiance):
        ramp = 0.5 + (along_u + along_v[band]) / 1.5
        uneven = (1 / 3 + ramp * 2 / 3) * 0.8 + 0.2 * (spot_u * spot_v[band])
        irradiance[band] *= 1 - conditions.light + conditions.light * uneven


def _blurred(image: Array, conditions: Conditions, rng: np.random.Generator) -> Array:
    """Through point spread and motion."""

    def spread(sigma: float) -> Array:
        if sigma <= 0:
            return image
        return np.asarray(cv2.GaussianBlur(image, (0, 0), sigma * conditions.parts))

    result = spread(conditions.blur)
    if conditions.blur_end is not None:
        steps = np.linspace(conditions.blur, conditions.blur_end, 9)
        layers = [spread(s) for s in steps]
        place = np.linspace(0, len(steps) - 1, image.shape[1])
        low = np.minimum(place.astype(int), len(steps) - 2)
        result = np.empty_like(image)
        for k in range(len(steps) - 1):
            at = low == k
            weight = place[at] - k
            result[:, at] = (1 - weight) * layers[k][:, at] + weight * layers[k + 1][:, at]
    if conditions.motion > 0:
        about = rng.uniform(0, np.pi)
        half = conditions.motion * conditions.parts / 2
        reach = int(np.ceil(half)) + 1
        grid = np.arange(-reach, reach + 1)
        along = grid * np.cos(about) + grid[:, None] * np.sin(about)
        across = -grid * np.sin(about) + grid[:, None] * np.cos(about)
        kernel = np.clip(half + 0.5 - abs(along), 0, 1) * np.clip(1 - abs(across), 0, 1)
        result = cv2.filter2D(result, -1, kernel / kernel.sum(), borderType=cv2.BORDER_REFLECT)
    return np.asarray(result)


def _response(irradiance: Array, conditions: Conditions) -> Array:
    levels = conditions.dark + (conditions.bright - conditions.dark) * irradiance
    if conditions.gamma == 1:
        return np.asarray(levels)
    return np.asarray(255 * (levels / 255) ** (1 / conditions.gamma))


def _pixels(fine: Array, parts: int) -> Array:
    """Means over each pixel's parts."""
    size = fine.shape[1] // parts, fine.shape[0] // parts
    return np.asarray(cv2.resize(fine, size, interpolation=cv2.INTER_AREA))

"""Synthetic views of a target (paper 5.2), area-sampled.

A pixel integrates the light that falls on its unit square. The sheet and the ink on it give the
share of each that it sees (``targets/ink.py``), and its colour is

    background + (white - background) sheet - (white - black) ink.

Pixels that an edge crosses are divided into `_FINE`^2 parts first, for two
reasons: perspective and distortion bend the map by up to 1e-2 px within a pixel, and where edges
of X and of Y meet the mean of the product is not the product of the means. What is left
moves a corner by less than 1e-3 px in a hard case, 1e-4 in an ordinary one.

The map from pixel to plate is direct for the paper's model: measured pixel, psi (eq. 9),
ray, plate. Blur is a Gaussian on light, before the gamma curve and the noise. It acts on half
pixels, whose mean the pixel is: the weights of whole ones make a Gaussian of steps, which moves
corners of 20 px wide squares by 2e-3 px.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from calibgui.engine.arrays import Array
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.printed_pattern import Ink, Raster
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import rays_with_slope
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.frames import centre_of_array
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation
from calibgui.engine.images.sampling import mesh

_FINE = 4
"""Divisions along each side of a pixel that an edge crosses, a multiple of 2."""
_CHUNK = 1 << 17
"""Pixels mapped at once: bounds the memory for the derivatives."""


@dataclass(frozen=True, slots=True)
class Appearance:
    """Light and board of a synthetic view; grey levels are linear, from 0 to 255."""

    black: float = 30.0
    white: float = 220.0
    background: float = 120.0
    quiet_zone: float = 1.0
    """White margin around the pattern, pitches."""
    shading: tuple[float, float] = (0.0, 0.0)
    """Relative change of the light from the left to the right edge, and from top to bottom."""
    stretch: float = 1.0
    """Height over width of the board's squares."""
    gamma: float = 1.0
    """Levels are recorded as 255 (level / 255)^(1 / gamma)."""


def render(
    camera: Camera,
    pose: Pose,
    board: Board,
    *,
    blur: float = 0.0,
    noise: float = 0.0,
    seed: int = 0,
    appearance: Appearance | None = None,
) -> npt.NDArray[np.uint8]:
    """The view (h, w) that `camera` has of a target.

    Args:
        camera: intrinsics, any lens model; its size is the image's.
        pose: cam_from_plate, mm. A board seen from behind shows its pattern mirrored.
        target: the board, of any pattern.
        blur: standard deviation of the Gaussian blur, px.
        noise: standard deviation of the Gaussian noise, grey levels.
        seed: of the noise; the same seed gives the same image.
        appearance: grey levels, margin and light.

    Raises:
        CalibrationError: if the plate passes through the camera's centre, the pattern leaves
            something open, or the blur is negative or wider than the image.
    """
    levels = irradiance(camera, pose, board, blur=blur, appearance=appearance)
    if noise > 0:
        levels = levels + noise * np.random.default_rng(seed).standard_normal(levels.shape)
    return np.clip(np.rint(levels), 0, 255).astype(np.uint8)


def irradiance(
    camera: Camera,
    pose: Pose,
    board: Board,
    *,
    blur: float = 0.0,
    appearance: Appearance | None = None,
) -> Array:
    """The levels (h, w) of `render` before noise and rounding."""
    look = appearance or Appearance()
    if not 0 <= blur < min(camera.size):
        raise CalibrationError(
            f"A view cannot be blurred by {blur} px.", "Give a standard deviation of 0 or more."
        )
    (w, h), margin = camera.size, int(np.ceil(4 * blur))
    u = np.arange(-margin, w + margin, dtype=np.float64)
    rows = max(1, _CHUNK // len(u))
    scene = _Scene(camera, pose, board, board.pattern.ink(board.grid_size), look)
    bands = []
    for first in range(0, h, rows):
        v = np.arange(first - margin, min(first + rows, h) + margin, dtype=np.float64)
        halves = scene.halves(mesh(u, v))
        if blur > 0:
            halves = scipy.ndimage.gaussian_filter(halves, 2 * blur, truncate=4.0)
        seen = halves.reshape(len(v), 2, len(u), 2).mean(axis=(1, 3))
        bands.append(seen[margin : len(v) - margin, margin : w + margin])
    levels = np.concatenate(bands)
    centre = centre_of_array(camera.size)
    light = 1 + look.shading[0] * (np.arange(w) - centre[0]) / w
    light = light + (look.shading[1] * (np.arange(h) - centre[1]) / h)[:, None]
    levels = np.clip(levels * light, 0, 255)
    return np.asarray(255 * (levels / 255) ** (1 / look.gamma))


def _board_from_ray(pose: Pose, square: float, stretch: float) -> Array:
    """(3, 3) G: squares (X, Y, 1) = depth G (n, 1), the inverse of the planar pose's homography."""
    sides = square * np.array([1.0, stretch])
    homography = np.column_stack([rotation(pose.rvec)[:, :2] * sides, pose.tvec])
    # Its determinant is square^2 times the distance from the camera's centre to the plate.
    limit = 1e-9 * square**2 * np.linalg.norm(pose.tvec)
    if not (np.isfinite(homography).all() and abs(np.linalg.det(homography)) > limit):
        raise CalibrationError(
            "The plate to render is seen edge-on or from nowhere.",
            "Give a finite pose that holds the plate away from the camera's centre.",
        )
    return np.linalg.inv(homography)


@dataclass(frozen=True, slots=True)
class _Scene:
    camera: Camera
    pose: Pose
    board: Board
    ink: Ink
    look: Appearance

    def halves(self, uv: Array) -> Array:
        """Levels (2 rows, 2 cols) of the half pixels of the pixels centred at `uv` (rows, cols,
        2)."""
        rows, cols = uv.shape[:2]
        flat = uv.reshape(-1, 2)
        whole, mixed = self._sample(flat, 1.0)
        values = np.tile(whole[:, None, None], (1, 2, 2))
        parts = (np.arange(_FINE) + 0.5) / _FINE - 0.5
        offsets = mesh(parts, parts).reshape(-1, 2)
        which = np.flatnonzero(mixed)
        step = _CHUNK // len(offsets)
        for i in range(0, len(which), step):
            some = which[i : i + step]
            fine, _ = self._sample(flat[some, None] + offsets, 1 / _FINE)
            values[some] = fine.reshape(-1, 2, _FINE // 2, 2, _FINE // 2).mean(axis=(2, 4))
        return values.reshape(rows, cols, 2, 2).transpose(0, 2, 1, 3).reshape(2 * rows, 2 * cols)

    def _sample(self, uv: Array, width: float) -> tuple[Array, npt.NDArray[np.bool_]]:
        """Mean levels of squares of side `width` px at `uv`, and which of them edges may cross."""
        XY, gradient, visible = self._board_points(uv)
        look = self.look
        widths = gradient * width
        # The paper ends far from any point: that its edges are not divided does no harm.
        sheet, _ = _sheet(self.ink, look.quiet_zone).share(XY, widths)
        ink, mixed = self.ink.share(XY, widths)
        levels = look.background + (look.white - look.background) * sheet
        levels = np.where(visible, levels - (look.white - look.black) * ink, look.background)
        return levels, visible & mixed

    def _board_points(self, uv: Array) -> tuple[Array, Array, npt.NDArray[np.bool_]]:
        """Plate points (..., 2) in squares, their gradient (..., 2, 2), and where there are any."""
        n, by_uv = rays_with_slope(uv, self.camera)
        G = _board_from_ray(self.pose, self.board.square, self.look.stretch)
        with np.errstate(all="ignore"):  # points at infinity are not visible
            scaled = n @ G[:, :2].T + G[:, 2]
            inverse_depth = scaled[..., 2:]
            XY = scaled[..., :2] / inverse_depth
            by_n = (G[:2, :2] - XY[..., None] * G[2, :2]) / inverse_depth[..., None]
            gradient = by_n @ by_uv
            (a, b), (c, d) = np.moveaxis(by_uv, (-2, -1), (0, 1))
            one_to_one = a * d > b * c
            total = np.einsum("...ij->...", gradient)  # finite if all of it is
        visible = np.isfinite(total) & (inverse_depth[..., 0] > 0) & one_to_one
        XY[~visible], gradient[~visible] = 0.0, 1.0
        return XY, gradient, visible


def _sheet(ink: Ink, margin: float) -> Raster:
    """The paper: the pattern and the margin around it, pitches."""
    left, top, right, bottom = ink.extent
    x, y = np.array([left - margin, right + margin]), np.array([top - margin, bottom + margin])
    return Raster(x, y, np.ones((1, 1), dtype=np.bool_))

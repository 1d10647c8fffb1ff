"""Rendering of synthetic views of a board (paper 5.2), area-sampled.

A pixel integrates the light that falls on its unit square. The paper and the ink on it give the
share of each that it sees (``boards/printed_pattern.py``), and its level is

    background + (white - background) paper - (white - black) ink.

Pixels that an edge crosses are divided into `_DIVISIONS_PER_PIXEL`^2 parts first, for two
reasons: perspective and distortion bend the map by up to 1e-2 px within a pixel, and where edges
of X and of Y meet the mean of the product is not the product of the means. What is left
moves a corner by less than 1e-3 px in a hard case, 1e-4 in an ordinary one.

The map from pixel to board is direct for the paper's model: measured pixel, psi (eq. 9),
ray, board. It is computed at the centres of blocks of 2 x 2 pixels and expanded to the second order
within them, which is off by 1e-5 px. Blur is a Gaussian on light, before the gamma curve and the
noise. It acts on half pixels, whose mean the pixel is: the weights of whole ones make a Gaussian of
steps, which moves corners of 20 px wide squares by 2e-3 px.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from calibgui.engine.arrays import Array, BoolArray, IntArray
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.printed_pattern import PrintedPattern, PrintedRectangles
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import rays_and_slopes
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.frames import centre_of_array
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.images.sampling import make_mesh
from calibgui.engine.threads import with_one_blas_thread

_DIVISIONS_PER_PIXEL = 4
"""Number of parts of each side of a pixel that an edge crosses, a multiple of 2."""
_PIXELS_PER_CHUNK = 1 << 15
"""Number of pixels, or of their parts, worked on at once: their arrays stay in the cache."""


@dataclass(frozen=True, slots=True)
class Appearance:
    """Light and board of a synthetic view; grey levels are linear, from 0 to 255."""

    black: float = 30.0
    """Level of the ink."""
    white: float = 220.0
    """Level of the paper."""
    background: float = 120.0
    """Level of what surrounds the board."""
    quiet_zone: float = 1.0
    """Width of the white margin around the pattern, pitches."""
    shading: tuple[float, float] = (0.0, 0.0)
    """Relative change of the light from the left to the right edge, and from top to bottom."""
    stretch: float = 1.0
    """Height over width of the board's squares."""
    gamma: float = 1.0
    """Exponent with which levels are recorded, as 255 (level / 255)^(1 / gamma)."""


def render_view(
    camera: Camera,
    pose: Pose,
    board: Board,
    *,
    blur: float = 0.0,
    noise: float = 0.0,
    seed: int = 0,
    appearance: Appearance | None = None,
) -> npt.NDArray[np.uint8]:
    """Render the view (h, w) that `camera` has of a board.

    Args:
        camera: intrinsics, any lens model; its size is the image's.
        pose: cam_from_board, mm. A board seen from behind shows its pattern mirrored.
        board: of any pattern.
        blur: standard deviation of the Gaussian blur, px.
        noise: standard deviation of the Gaussian noise, grey levels.
        seed: of the noise; the same seed gives the same image.
        appearance: grey levels, margin and light.

    Raises:
        CalibrationError: if the board's plane passes through the camera's centre, the pattern
            leaves something open, or the blur is negative or wider than the image.
    """
    levels = compute_irradiance(camera, pose, board, blur=blur, appearance=appearance)
    if noise > 0:
        levels = levels + noise * np.random.default_rng(seed).standard_normal(levels.shape)
    return np.clip(np.rint(levels), 0, 255).astype(np.uint8)


@with_one_blas_thread
def compute_irradiance(
    camera: Camera,
    pose: Pose,
    board: Board,
    *,
    blur: float = 0.0,
    appearance: Appearance | None = None,
) -> Array:
    """Compute the levels (h, w) of `render_view` before noise and rounding.

    Raises:
        CalibrationError: as `render_view`.
    """
    look = appearance or Appearance()
    if not 0 <= blur < min(camera.size):
        raise CalibrationError(
            f"A view cannot be blurred by {blur} px.", "Give a standard deviation of 0 or more."
        )
    (w, h), margin = camera.size, int(np.ceil(4 * blur))
    u = np.arange(-margin, w + margin, dtype=np.float64)
    rows = 2 * max(1, _PIXELS_PER_CHUNK // (2 * len(u)))
    scene = _Scene(camera, pose, board, board.pattern.draw(board.grid_size), look)
    halves, bands = np.empty((0, 2 * len(u))), []
    for first in range(-margin, h + margin, rows):
        v = np.arange(first, min(first + rows, h + margin), dtype=np.float64)
        halves = np.concatenate([halves, scene.compute_half_pixels(u, v)])
        spread = scipy.ndimage.gaussian_filter(halves, 2 * blur, truncate=4.0) if blur else halves
        seen = spread.reshape(-1, 2, len(u), 2).mean(axis=(1, 3))
        bands.append(seen[margin : len(seen) - margin, margin : w + margin])
        halves = halves[max(0, len(halves) - 4 * margin) :]  # what the next rows are blurred with
    levels = np.concatenate(bands)
    centre = centre_of_array(camera.size)
    light = 1 + look.shading[0] * (np.arange(w) - centre[0]) / w
    light = light + (look.shading[1] * (np.arange(h) - centre[1]) / h)[:, None]
    levels = np.clip(levels * light, 0, 255)
    return np.asarray(255 * (levels / 255) ** (1 / look.gamma))


def _compute_board_from_ray(pose: Pose, square: float, stretch: float) -> Array:
    """Return G (3, 3) with (X, Y, 1) = s G b, the inverse of the planar pose's homography.

    X and Y are in squares, b is the ray and s the distance from the camera along it.
    """
    sides = square * np.array([1.0, stretch])
    homography = np.column_stack([rotation_from_vector(pose.rvec)[:, :2] * sides, pose.tvec])
    # Its determinant is square^2 times the distance from the camera's centre to the board.
    limit = 1e-9 * square**2 * np.linalg.norm(pose.tvec)
    if not (np.isfinite(homography).all() and abs(np.linalg.det(homography)) > limit):
        raise CalibrationError(
            "The board to render is seen edge-on or from nowhere.",
            "Give a finite pose that holds the board away from the camera's centre.",
        )
    return np.linalg.inv(homography)


@dataclass(frozen=True, eq=False, slots=True)
class _Blocks:
    """The places on the board that blocks of 2 x 2 pixels look at, and their change within them."""

    centres: Array
    """(n, 2) px."""
    coefficients: Array
    """(6, 2, n) for 1, u, v, u^2, u v and v^2 from the centre, px, of X and of Y, in squares."""
    smooth: BoolArray
    """(n,) True where the board's plane is seen here and in all neighbours, as the series needs."""

    def expand(self, which: IntArray | slice, offsets: Array) -> tuple[Array, Array]:
        """Return XY (k, m, 2) of m blocks at `offsets` (k, 2) from their centres, and its gradient
        (k, m, 2, 2) along u and v.

        In memory the blocks are next to each other, as all that follows is done on long rows.
        """
        u, v = offsets.T
        zero, one = np.zeros_like(u), np.ones_like(u)
        value = [one, u, v, u * u, u * v, v * v]
        by_u, by_v = [zero, one, zero, 2 * u, v, zero], [zero, zero, one, zero, u, 2 * v]
        terms = np.moveaxis(np.array([value, by_u, by_v]), 1, -1).reshape(-1, 6)
        found = terms @ self.coefficients[:, :, which].reshape(6, -1)
        found = found.reshape(3, len(u), 2, -1).transpose(1, 3, 2, 0)
        return found[..., 0], found[..., 1:]


@dataclass(frozen=True, slots=True)
class _Scene:
    """The camera, pose and board that are rendered."""

    camera: Camera
    pose: Pose
    board: Board
    ink: PrintedPattern
    look: Appearance

    def compute_half_pixels(self, u: Array, v: Array) -> Array:
        """Compute the levels (2 rows, 2 cols) of the half pixels of rows `v` and columns `u`."""
        blocks = self._map_blocks(u, v)
        parts = (np.arange(_DIVISIONS_PER_PIXEL) + 0.5) / _DIVISIONS_PER_PIXEL - 0.5
        offsets = make_mesh(parts, parts).reshape(-1, 2)
        step = _PIXELS_PER_CHUNK // len(offsets)
        values = np.full((2, 2, 2, 2, len(blocks.centres)), self.look.background)
        near = np.flatnonzero(self._may_see_paper(blocks))
        for row, col in np.ndindex(2, 2):
            pixel = np.array([col, row]) - 0.5
            nowhere = np.zeros(len(near), np.bool_)
            (levels,), (paper,), (mixed,) = self._compute_levels(
                blocks, near, pixel[None], 1.0, nowhere
            )
            values[row, :, col, :, near] = levels[:, None, None]
            on_paper, which = paper[mixed] == 1, near[mixed]
            for i in range(0, len(which), step):
                some, width = which[i : i + step], 1 / _DIVISIONS_PER_PIXEL
                fine, _, _ = self._compute_levels(
                    blocks, some, pixel + offsets, width, on_paper[i : i + step]
                )
                halves = fine.reshape(
                    2, _DIVISIONS_PER_PIXEL // 2, 2, _DIVISIONS_PER_PIXEL // 2, -1
                )
                values[row, :, col][..., some] = halves.mean(axis=(1, 3))
        rows, cols = -(-len(v) // 2), -(-len(u) // 2)
        ordered = values.reshape(4, 4, rows, cols).transpose(2, 0, 3, 1)
        return ordered.reshape(4 * rows, 4 * cols)[: 2 * len(v), : 2 * len(u)]

    def _may_see_paper(self, blocks: _Blocks) -> BoolArray:
        """Return (n,) whether a block may show the paper: what surrounds it is alike everywhere.

        No offset in a block is longer than 1 px along an axis, so that the terms' sizes bound how
        far its pixels look from its centre, and twice that how wide they are.
        """
        paper = _make_paper(self.ink, self.look.quiet_zone)
        x, y = blocks.coefficients[0]
        reach_x, reach_y = 3 * np.abs(blocks.coefficients[1:]).sum(axis=0)
        left, top, right, bottom = paper.extent
        is_beside = (np.abs(x - (left + right) / 2) < (right - left) / 2 + reach_x) & (
            np.abs(y - (top + bottom) / 2) < (bottom - top) / 2 + reach_y
        )
        return is_beside | ~blocks.smooth

    def _compute_levels(
        self,
        blocks: _Blocks,
        which: IntArray | slice,
        offsets: Array,
        width: float,
        on_paper: BoolArray,
    ) -> tuple[Array, Array, BoolArray]:
        """Compute mean levels (k, m) of squares of side `width` px at `offsets` (k, 2) from the
        centres of m blocks, the share of each that is paper, and where edges may cross them.

        Of blocks `on_paper` (m,) it is known that the paper does not end there.
        """
        XY, gradient = blocks.expand(which, offsets)
        visible = np.ones(XY.shape[:2], dtype=np.bool_)
        torn = ~blocks.smooth[which]
        if torn.any():
            exact = self._map_to_board(blocks.centres[which][torn] + offsets[:, None])
            XY[:, torn], gradient[:, torn], visible[:, torn] = exact
        look = self.look
        widths = gradient * width
        paper = np.ones(XY.shape[:2])
        # The paper ends far from any point: that its edges are not divided does no harm.
        paper[:, ~on_paper], _ = _make_paper(self.ink, look.quiet_zone).compute_ink_share(
            XY[:, ~on_paper], widths[:, ~on_paper]
        )
        ink, mixed = self.ink.compute_ink_share(XY, widths)
        levels = look.background + (look.white - look.background) * paper
        levels = np.where(visible, levels - (look.white - look.black) * ink, look.background)
        return levels, paper, visible & mixed

    def _map_blocks(self, u: Array, v: Array) -> _Blocks:
        """Map the blocks of 2 x 2 pixels that hold rows `v` and columns `u` of pixels."""
        around = make_mesh(*(np.arange(x[0] - 1.5, x[-1] + 3, 2) for x in (u, v)))
        XY, gradient, visible = self._map_to_board(around)
        by_u = (gradient[1:-1, 2:] - gradient[1:-1, :-2]) / 4
        by_v = (gradient[2:, 1:-1] - gradient[:-2, 1:-1]) / 4
        smooth = visible[1:-1, 2:] & visible[1:-1, :-2] & visible[2:, 1:-1] & visible[:-2, 1:-1]
        inner = (slice(1, -1), slice(1, -1))
        XY, gradient, centres = XY[inner], gradient[inner], around[inner]
        mixed = (by_u[..., 1] + by_v[..., 0]) / 2
        series = [XY, gradient[..., 0], gradient[..., 1], by_u[..., 0] / 2, mixed, by_v[..., 1] / 2]
        coefficients = np.moveaxis(np.stack(series), -1, 1).reshape(6, 2, -1)
        return _Blocks(centres.reshape(-1, 2), coefficients, (smooth & visible[inner]).ravel())

    def _map_to_board(self, uv: Array) -> tuple[Array, Array, BoolArray]:
        """Compute board points (..., 2) in squares, their slopes (..., 2, 2), and where any are."""
        rays, by_uv = rays_and_slopes(uv, self.camera)
        G = _compute_board_from_ray(self.pose, self.board.square, self.look.stretch)
        with np.errstate(all="ignore"):  # points at infinity are not visible
            scaled = rays @ G.T
            nearness = scaled[..., 2:]
            XY = scaled[..., :2] / nearness
            by_ray = (G[:2] - XY[..., None] * G[2]) / nearness[..., None]
            gradient = by_ray @ by_uv
            turning = np.cross(by_uv[..., 0], by_uv[..., 1])
            one_to_one = np.einsum("...i,...i->...", turning, rays) > 0
            total = np.einsum("...ij->...", gradient)  # finite if all of it is
        visible = np.isfinite(total) & (nearness[..., 0] > 0) & one_to_one
        XY[~visible], gradient[~visible] = 0.0, 1.0
        return XY, gradient, visible


def _make_paper(ink: PrintedPattern, margin: float) -> PrintedRectangles:
    """Return the area of the paper: the pattern and the margin around it, pitches."""
    left, top, right, bottom = ink.extent
    x, y = np.array([left - margin, right + margin]), np.array([top - margin, bottom + margin])
    return PrintedRectangles(x, y, np.ones((1, 1), dtype=np.bool_))

"""Discs much out of focus: their levels read where they are flat, and whether their size is told.

A lens out of focus spreads each point over a disc. The edges that it leaves have ends, unlike those
of the Gaussian blur that fits take for granted: these then explain a disc by more contrast and less
size than it has, the more so the more it is blurred, and by light that differs from disc to disc as
the size does. As long as the middle of a disc is flat, all that can be read instead.

A disc of radius r, spread over one of radius R, and one of radius R, spread over one of radius r,
look alike but for the contrast. The former is seen as an ellipse, as its place on the board makes
it, with r^2 J J^T for the image J of a unit of the board, the latter as a circle everywhere. What
is seen is described by both,

    S^-1 = a J J^T + b I,

and b tells how much of it is the lens's disc.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, BoolArray, GreyImage
from calibgui.engine.images.sampling import sample_image

_PAPER_HALF_SIDE, _INK_HALF_SIDE = 0.1, 0.02
"""Half sides of the squares over which paper and ink are averaged, steps of the board's unit."""
_RING = 0.1
"""Radius of a ring that is ink if the middle of the disc is flat, half distances of neighbours."""
_RING_SAMPLES = 16
"""Number of samples along it."""
_LIT_DISCS = 9
"""Number of discs, the one itself among them, by which the light is seen to rise."""
_LIGHT_DEVIATIONS = (0.3, 0.1, 0.05)
"""Deviations of the logarithm of the light beyond which a place counts less, in turn: something may
cover it."""
_MAX_LENS_SHARE = 0.08
"""Share of the lens's own disc in what is seen, beyond which a disc's size is not told: centres
were off by 1.8 times what they stated, and by less than 1.3 times below."""
_LENS_SHARE_SIGMAS = 2.0
"""Number of its standard deviations by which that share must exceed the limit."""
_MAX_CONDITION = 1e10
"""Greatest condition of its equations."""
_MAX_OVERLAP = 1.2
"""Greatest radius of the lens's disc over half the gap to the next discs: beyond it their light
draws centres aside, by 1.3 to 1.5 times what they stated."""


class SeenLevels(NamedTuple):
    """Levels at n discs, grey levels."""

    on_paper: Array
    """(n, k, 2) places of paper around, px."""
    around: Array
    """(n, k) there; NaN where not in the image."""
    ink: Array
    """(n,) in the disc's middle."""
    ring: Array
    """(n,) around that middle."""

    @property
    def paper(self) -> Array:
        """(n,) mean of the paper around; the median of all where none is in the image."""
        is_known = np.isfinite(self.around)
        count = np.count_nonzero(is_known, axis=1)
        total = np.where(is_known, self.around, 0.0).sum(axis=1)
        usual = np.nanmedian(self.around)
        return np.where(count > 0, total / np.maximum(count, 1), usual)

    @property
    def contrast(self) -> Array:
        """(n,) of disc and paper, negative if the disc is darker."""
        return self.ink - self.paper

    @property
    def unevenness(self) -> float:
        """Median of how much of its contrast a disc loses from the middle to the ring."""
        return float(np.median((self.ink - self.ring) / self.contrast))


def read_levels(
    image: GreyImage, uv: Array, steps: Array, reach: float, paper: Array
) -> SeenLevels:
    """Read the levels at discs; the arguments are those of ``ellipse_fit.fit_ellipses``."""
    side = float(np.sqrt(abs(np.linalg.det(steps)).min()))
    on_paper = uv[:, None] + (steps @ paper.T).transpose(0, 2, 1)
    angle = 2 * np.pi * np.arange(_RING_SAMPLES) / _RING_SAMPLES
    ring = _RING * reach * np.stack([np.cos(angle), np.sin(angle)])
    around = uv[:, None] + (steps @ ring).transpose(0, 2, 1)
    ink = _average(image, uv, _INK_HALF_SIDE * side)
    return SeenLevels(
        on_paper,
        _average(image, on_paper, _PAPER_HALF_SIDE * side),
        np.where(np.isfinite(ink), ink, np.nanmedian(ink)),
        sample_image(image, around).mean(axis=1),
    )


def estimate_rise(seen: SeenLevels, uv: Array) -> Array:
    """Estimate the gradient of the light at discs over the light there, (n, 2) 1/px.

    The logarithm of the light is taken to be a quadratic over a disc and those next to it. Paper
    and ink have as much of it, and count by what noise leaves of it.

    Args:
        seen: the levels.
        uv: (n, 2) the discs' centres, px.
    """
    n, k = seen.around.shape
    near = np.asarray(scipy.spatial.cKDTree(uv).query(uv, k=min(_LIT_DISCS, n))[1])
    levels = np.concatenate([seen.around, seen.ink[:, None]], axis=1)[near].reshape(n, -1)
    places = np.concatenate([seen.on_paper, uv[:, None]], axis=1)
    off = (places[near] - uv[:, None, None]).reshape(n, -1, 2)
    scale = np.sqrt(np.mean(off**2, axis=(1, 2)))
    x, y = np.moveaxis(off / scale[:, None, None], 2, 0)
    is_ink = np.arange(levels.shape[1]) % (k + 1) == k
    is_of = np.broadcast_to(np.stack([is_ink, ~is_ink], axis=1), (n, len(is_ink), 2))
    terms = np.concatenate([np.stack([x, y, x * x, x * y, y * y], axis=2), is_of], axis=2)
    is_known = levels > 0  # not of NaN
    light = np.log(np.where(is_known, levels, 1.0))
    sigma = np.where(is_ink, _PAPER_HALF_SIDE / _INK_HALF_SIDE, 1.0) / np.where(is_known, levels, 1)
    middle = [
        np.nanmedian(np.where(is_known, light, np.nan)[:, of], axis=1) for of in is_of[0].T > 0
    ]
    rest = light - np.where(is_ink, middle[0][:, None], middle[1][:, None])
    for most in _LIGHT_DEVIATIONS:
        w = (is_known / sigma / (1 + (rest / most) ** 2))[..., None]
        fit = np.linalg.pinv(w * terms) @ (w * light[..., None])
        rest = light - (terms @ fit)[..., 0]
    return np.asarray(fit[:, :2, 0] / scale[:, None])


def find_apart(blur: Array, spread: Array, radius: float, half_distance: float) -> BoolArray:
    """Find the discs (n,) True whose light does not flow into that of the next ones.

    Args:
        blur: (n,) of their edges, px: half the radius of the lens's disc.
        spread: (n, 2, 2) of their ellipses, px^2.
        radius: of the discs, in units of the board.
        half_distance: half the distance of neighbouring discs, in the same unit.
    """
    shorter = np.sqrt(np.maximum(np.linalg.eigvalsh(spread)[:, 0], 0.0))
    return np.asarray(2 * blur < _MAX_OVERLAP * (half_distance / radius - 1) * shorter)


def is_size_told(spread: Array, J: Array) -> bool:
    """Return whether ellipses are images of the board's discs rather than of the lens's.

    Args:
        spread: (n, 2, 2) of the ellipses, px^2.
        J: (n, 2, 2) columns: images of a unit of the board's X and Y there, px.
    """
    weight = 1 / np.sqrt(np.maximum(np.linalg.det(spread), 1e-12))[:, None, None]
    seen, on_board, of_lens = (
        (weight * each)[:, [0, 0, 1], [0, 1, 1]].ravel()
        for each in (spread, J @ J.transpose(0, 2, 1), np.eye(2))
    )
    A = np.column_stack([on_board, of_lens])
    N = A.T @ A
    # Seen at right angles both are circles, and the centres as they are.
    if np.linalg.cond(N / np.sqrt(np.outer(N.diagonal(), N.diagonal()))) > _MAX_CONDITION:
        return True
    fit = np.linalg.solve(N, A.T @ seen)
    variance = np.sum((seen - A @ fit) ** 2) / max(len(seen) - 2, 1)
    size = 1 / float(np.median(weight))
    sigma = float(np.sqrt(variance * np.linalg.inv(N)[1, 1]))
    return float(fit[1]) - _LENS_SHARE_SIGMAS * sigma < _MAX_LENS_SHARE * size


def _average(image: GreyImage, at: Array, half: float) -> Array:
    """Average an image over squares of half a side `half` px around places `at` (..., 2) px; NaN
    where they are not all in the image."""
    offset = np.arange(-round(half), round(half) + 1)
    limit = np.array(image.shape[::-1]) - 1 + offset[0]
    nearest = np.rint(at)
    is_inside = ((nearest >= offset[-1]) & (nearest <= limit)).all(axis=-1)
    u, v = np.moveaxis(np.where(is_inside[..., None], nearest, offset[-1]).astype(np.int64), -1, 0)
    level = image[v[..., None, None] + offset[:, None], u[..., None, None] + offset]
    return np.where(is_inside, level.mean(axis=(-2, -1), dtype=np.float64), np.nan)

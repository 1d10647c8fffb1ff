"""What is printed of a pattern, to be drawn or seen through a camera.

Lengths are pitches (sides of a square, distances of circles), X along the rows and Y down them,
from the pattern's first point. White paper is taken for granted; ink is black.

Seen by a camera, a pixel integrates the light that falls on its unit square. Within a pixel
the plate's X is affine: X + g . e, e in [-1/2, 1/2]^2. With H the unit step, the mean of
H(X + g . e) over the pixel is the distribution function of the sum of two uniform variables of
widths A = |g_u|, B = |g_v|,

    step(X) = [ (X + s)_+^2 - (X + m)_+^2 - (X - m)_+^2 + (X - s)_+^2 ] / (2 A B),

with s = (A + B) / 2, m = |A - B| / 2 and (z)_+ = max(z, 0). It is exact for a straight edge
at any angle. Of a raster, whose edges are lines of X and of Y, it takes the mean along each axis
and multiplies; of a disc it takes the distance from its circumference for X.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import scipy

from calibgui.engine.arrays import Array, BoolArray

Extent = tuple[float, float, float, float]
"""Left, top, right and bottom, pitches."""
_COARSE = 0.5
"""Width of a pixel beyond which the ink may vary within it otherwise than by one edge, over the
finest detail."""


class Ink(Protocol):
    """Black parts of a plate."""

    @property
    def extent(self) -> Extent:
        """The rectangle that holds the pattern, the outermost squares included."""

    def share(self, XY: Array, gradient: Array) -> tuple[Array, BoolArray]:
        """How much of each pixel is ink.

        Args:
            XY: (..., 2) plate points of the pixels' centres.
            gradient: (..., 2, 2) of X and of Y along u and v, per pixel.

        Returns:
            Share (...), and where it is better taken from parts of the pixel, since edges cross
            or bend in it.
        """


@dataclass(frozen=True, eq=False, slots=True)
class Raster:
    """Rectangles between lines of X and of Y."""

    x: Array
    """(w + 1,) rising."""
    y: Array
    """(h + 1,) rising."""
    dark: BoolArray
    """(h, w) which are ink."""

    @property
    def extent(self) -> Extent:
        return self.x[0], self.y[0], self.x[-1], self.y[-1]

    def rectangles(self) -> Array:
        """(n, 4) left, top, right and bottom of the ink, as few as runs along the rows allow."""
        padded = np.pad(self.dark, ((0, 0), (1, 1)))
        rows, starts = np.nonzero(padded[:, 1:] & ~padded[:, :-1])
        _, ends = np.nonzero(padded[:, :-1] & ~padded[:, 1:])
        # Runs below each other become one, lest a line of paper show between them.
        order = np.lexsort((rows, ends, starts))
        runs = np.column_stack([starts, ends, rows])[order]
        same = (np.diff(runs, axis=0) == (0, 0, 1)).all(axis=1)
        first, last = np.append(True, ~same), np.append(~same, True)
        left, right, top = runs[first].T
        return np.column_stack(
            [self.x[left], self.y[top], self.x[right], self.y[runs[last, 2] + 1]]
        )

    def share(self, XY: Array, gradient: Array) -> tuple[Array, BoolArray]:
        """See ``Ink``."""
        cells = np.pad(self.dark, 1).astype(np.float64)
        widths = np.abs(gradient)
        (i, below, cut_x), (j, right, cut_y) = (
            _nearest(lines, XY[..., axis], widths[..., axis, 0], widths[..., axis, 1])
            for axis, lines in ((0, self.x), (1, self.y))
        )
        share = (1 - right) * ((1 - below) * cells[j, i] + below * cells[j, i + 1])
        share += right * ((1 - below) * cells[j + 1, i] + below * cells[j + 1, i + 1])
        finest = min(np.diff(self.x).min(), np.diff(self.y).min())
        left, top, end_x, end_y = self.extent
        X, Y = np.moveaxis(XY, -1, 0)
        inside = (left - finest < X) & (end_x + finest > X) & (top - finest < Y)
        inside &= end_y + finest > Y
        width, height = np.moveaxis(widths[..., 0] + widths[..., 1], -1, 0)
        coarse = np.maximum(width, height) > _COARSE * finest
        return share, cut_x | cut_y | (coarse & inside)


@dataclass(frozen=True, eq=False, slots=True)
class Discs:
    """Discs of one size, apart from each other."""

    centres: Array
    """(n, 2)"""
    radius: float
    extent: Extent

    def share(self, XY: Array, gradient: Array) -> tuple[Array, BoolArray]:
        """See ``Ink``."""
        at = np.asarray(scipy.spatial.cKDTree(self.centres).query(XY)[1])
        out = XY - self.centres[at]
        distance = np.linalg.norm(out, axis=-1)
        normal = out / np.maximum(distance, 1e-12)[..., None]
        A, B = np.moveaxis(np.abs((normal[..., None, :] @ gradient)[..., 0, :]) + 1e-12, -1, 0)
        inside = self.radius - distance
        return step(inside, A, B), np.abs(inside) < (A + B) / 2


def step(X: Array, A: Array, B: Array) -> Array:
    """Mean of H(X + A e1 + B e2) over e in [-1/2, 1/2]^2."""
    s = (A + B) / 2
    # A width of a millionth of the other changes nothing and keeps the quotient defined.
    m = np.minimum(np.abs(A - B) / 2, s * (1 - 1e-6))
    inside = np.clip(X, -s, s)
    corner = np.maximum(inside - m, 0) ** 2 + np.maximum(inside + m, 0) ** 2
    return np.asarray(np.clip(((inside + s) ** 2 - corner) / (2 * (s * s - m * m)), 0.0, 1.0))


def _nearest(lines: Array, X: Array, A: Array, B: Array) -> tuple[np.ndarray, Array, BoolArray]:
    """Number of the line nearest to X, the share of the pixel beyond it, and whether it cuts."""
    k = np.searchsorted((lines[1:] + lines[:-1]) / 2, X)
    off = X - lines[k]
    return k, step(off, A, B), np.abs(off) < (A + B) / 2

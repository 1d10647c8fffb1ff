"""What is printed of a pattern, to be drawn or seen through a camera.

Lengths are pitches (sides of a square, distances of circles), X along the rows and Y down them,
from the pattern's first point. The paper is white and the ink black.

Seen by a camera, a pixel integrates the light that falls on its unit square. Within a pixel
the board's X is affine: X + g . e, e in [-1/2, 1/2]^2. With H the unit step, the mean of
H(X + g . e) over the pixel is the distribution function of the sum of two uniform variables of
widths A = |g_u|, B = |g_v|,

    step(X) = [ (X + s)_+^2 - (X + m)_+^2 - (X - m)_+^2 + (X - s)_+^2 ] / (2 A B),

with s = (A + B) / 2, m = |A - B| / 2 and (z)_+ = max(z, 0). It is exact for a straight edge
at any angle. For rectangles, whose edges are lines of X and of Y, the mean is taken along each axis
and multiplied; for a disc the distance from its circumference takes the place of X.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import scipy

from calibgui.engine.arrays import Array, BoolArray, IntArray

Extent = tuple[float, float, float, float]
"""Left, top, right and bottom, pitches."""
_MAX_PIXEL_WIDTH = 0.5
"""Greatest width of a pixel over the finest detail of the print at which a single edge crosses it;
wider pixels are divided."""


class PrintedPattern(Protocol):
    """The inked parts of a board."""

    @property
    def extent(self) -> Extent:
        """The rectangle that holds the pattern, the outermost squares included."""

    def compute_ink_share(self, XY: Array, gradient: Array) -> tuple[Array, BoolArray]:
        """Compute the share of each pixel that is ink.

        Args:
            XY: (..., 2) points of the board seen at the pixels' centres, pitches.
            gradient: (..., 2, 2) of X and of Y along u and v, pitches per pixel.

        Returns:
            The share (...), and a mask (...) of pixels that edges cross or that the pattern
            varies in, whose share is more accurate if taken as the mean over parts of the pixel.
        """


@dataclass(frozen=True, eq=False, slots=True)
class PrintedRectangles:
    """A print of rectangles between lines of X and of Y."""

    x: Array
    """(w + 1,) positions of the lines, rising, pitches."""
    y: Array
    """(h + 1,) positions of the lines, rising, pitches."""
    dark: BoolArray
    """(h, w) True for the rectangles that are ink."""

    @property
    def extent(self) -> Extent:
        return self.x[0], self.y[0], self.x[-1], self.y[-1]

    def list_rectangles(self) -> Array:
        """List left, top, right and bottom (n, 4) of the inked rectangles, pitches, after merging
        those that touch along a row or a column."""
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

    def compute_ink_share(self, XY: Array, gradient: Array) -> tuple[Array, BoolArray]:
        """See ``PrintedPattern``."""
        cells = np.pad(self.dark, 1).astype(np.float64)
        widths = np.abs(gradient)
        (i, below, cut_x), (j, right, cut_y) = (
            _find_nearest_line(lines, XY[..., axis], widths[..., axis, 0], widths[..., axis, 1])
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
        wide = np.maximum(width, height) > _MAX_PIXEL_WIDTH * finest
        return share, cut_x | cut_y | (wide & inside)


@dataclass(frozen=True, eq=False, slots=True)
class PrintedDiscs:
    """A print of discs of one size that do not touch."""

    centres: Array
    """(n, 2) pitches."""
    radius: float
    """Pitches."""
    extent: Extent
    """The rectangle that holds the pattern."""

    def compute_ink_share(self, XY: Array, gradient: Array) -> tuple[Array, BoolArray]:
        """See ``PrintedPattern``."""
        _, inside, widths = _measure_discs(self.centres, self.radius, XY, gradient)
        return average_unit_step(inside, *widths), np.abs(inside) < sum(widths) / 2


@dataclass(frozen=True, eq=False, slots=True)
class PrintedSquaresAndDots:
    """A print of rectangles with dots of ink and of paper over them, which do not touch."""

    rectangles: PrintedRectangles
    centres: Array
    """(n, 2) of the dots, pitches."""
    radius: float
    """Radius of the dots, in pitches."""
    dark: BoolArray
    """(n,) True for the dots that are ink."""

    @property
    def extent(self) -> Extent:
        return self.rectangles.extent

    def compute_ink_share(self, XY: Array, gradient: Array) -> tuple[Array, BoolArray]:
        """See ``PrintedPattern``."""
        share, crossed = self.rectangles.compute_ink_share(XY, gradient)
        if not len(self.centres):
            return share, crossed
        nearest, inside, widths = _measure_discs(self.centres, self.radius, XY, gradient)
        covered = average_unit_step(inside, *widths)
        cut = np.abs(inside) < sum(widths) / 2
        return share + covered * (self.dark[nearest] - share), np.asarray(crossed | cut)


def _measure_discs(
    centres: Array, radius: float, XY: Array, gradient: Array
) -> tuple[IntArray, Array, tuple[Array, Array]]:
    """Find the nearest of the discs to each of XY (..., 2), how far that lies within it, and the
    widths A and B of the pixel across its circumference, all (...)."""
    nearest = np.asarray(scipy.spatial.cKDTree(centres).query(XY)[1])
    out = XY - centres[nearest]
    distance = np.linalg.norm(out, axis=-1)
    normal = out / np.maximum(distance, 1e-12)[..., None]
    A, B = np.moveaxis(np.abs((normal[..., None, :] @ gradient)[..., 0, :]) + 1e-12, -1, 0)
    return nearest, radius - distance, (A, B)


def average_unit_step(X: Array, A: Array, B: Array) -> Array:
    """Compute the mean of H(X + A e1 + B e2) over e in [-1/2, 1/2]^2; all arrays of one shape."""
    s = (A + B) / 2
    # A width of a millionth of the other changes nothing and keeps the quotient defined.
    m = np.minimum(np.abs(A - B) / 2, s * (1 - 1e-6))
    inside = np.clip(X, -s, s)
    corner = np.maximum(inside - m, 0) ** 2 + np.maximum(inside + m, 0) ** 2
    return np.asarray(np.clip(((inside + s) ** 2 - corner) / (2 * (s * s - m * m)), 0.0, 1.0))


def _find_nearest_line(
    lines: Array, X: Array, A: Array, B: Array
) -> tuple[np.ndarray, Array, BoolArray]:
    """Return the number of the line nearest to X, the share of the pixel beyond it, and whether it
    cuts the pixel."""
    k = np.searchsorted((lines[1:] + lines[:-1]) / 2, X)
    off = X - lines[k]
    return k, average_unit_step(off, A, B), np.abs(off) < (A + B) / 2

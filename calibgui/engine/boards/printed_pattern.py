"""The print of a pattern is described here, to be drawn or seen through a camera.

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
        X, Y = np.ascontiguousarray(np.moveaxis(XY, -1, 0))
        widths = np.abs(gradient)
        width, height = np.moveaxis(widths[..., 0] + widths[..., 1], -1, 0)
        (i, off_x), (j, off_y) = (
            _find_nearest_line(lines, along) for lines, along in ((self.x, X), (self.y, Y))
        )
        share = cells.take((j + (off_y > 0)) * cells.shape[1] + i + (off_x > 0))
        cut = (np.abs(off_x) < width / 2) | (np.abs(off_y) < height / 2)
        i, j = i[cut], j[cut]
        beyond, below = (
            average_unit_step(off[cut], *widths[cut, axis].T)
            for axis, off in enumerate((off_x, off_y))
        )
        mean = (1 - below) * ((1 - beyond) * cells[j, i] + beyond * cells[j, i + 1])
        mean += below * ((1 - beyond) * cells[j + 1, i] + beyond * cells[j + 1, i + 1])
        share[cut] = mean
        finest = min(np.diff(self.x).min(), np.diff(self.y).min())
        wide = np.maximum(width, height) > _MAX_PIXEL_WIDTH * finest
        if wide.any():
            left, top, end_x, end_y = self.extent
            wide &= (left - finest < X) & (end_x + finest > X)
            wide &= (top - finest < Y) & (end_y + finest > Y)
        return share, cut | wide


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
        _, covered, cut = _cover_by_discs(self.centres, self.radius, XY, gradient)
        return covered, cut


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
        nearest, covered, cut = _cover_by_discs(self.centres, self.radius, XY, gradient)
        return share + covered * (self.dark[nearest] - share), np.asarray(crossed | cut)


def _cover_by_discs(
    centres: Array, radius: float, XY: Array, gradient: Array
) -> tuple[IntArray, Array, BoolArray]:
    """Find the disc that is nearest to each of XY (..., 2), if any covers some of the pixel, how
    much of that it covers, and whether its circumference cuts it, all (...)."""
    reach = radius + np.abs(gradient).sum(axis=(-2, -1)) / 2
    farthest = float(reach.max(initial=0.0))
    found = scipy.spatial.cKDTree(centres).query(XY, distance_upper_bound=farthest)
    distance = np.asarray(found[0])
    nearest = np.minimum(found[1], len(centres) - 1)  # where there is none
    covered = (distance < radius).astype(np.float64)
    cut = np.asarray((distance < reach) & (distance > 2 * radius - reach))
    out = XY[cut] - centres[nearest[cut]]
    normal = out / np.maximum(distance[cut], 1e-12)[:, None]
    A, B = np.abs((normal[:, None] @ gradient[cut])[:, 0]).T + 1e-12
    inside = radius - distance[cut]
    covered[cut] = average_unit_step(inside, A, B)
    cut[cut] = np.abs(inside) < (A + B) / 2
    return nearest, covered, cut


def average_unit_step(X: Array, A: Array, B: Array) -> Array:
    """Compute the mean of H(X + A e1 + B e2) over e in [-1/2, 1/2]^2; all arrays of one shape."""
    s = (A + B) / 2
    # A width of a millionth of the other changes nothing and keeps the quotient defined.
    m = np.minimum(np.abs(A - B) / 2, s * (1 - 1e-6))
    inside = np.clip(X, -s, s)
    corner = np.maximum(inside - m, 0) ** 2 + np.maximum(inside + m, 0) ** 2
    return np.asarray(np.clip(((inside + s) ** 2 - corner) / (2 * (s * s - m * m)), 0.0, 1.0))


def _find_nearest_line(lines: Array, X: Array) -> tuple[IntArray, Array]:
    """Return the number of the line nearest to each X, and how far X lies beyond it."""
    k = np.searchsorted((lines[1:] + lines[:-1]) / 2, X)
    return k, X - lines[k]

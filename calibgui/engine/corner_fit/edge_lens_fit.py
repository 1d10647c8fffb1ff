"""A plane seen through a radial lens, fitted to edges over all that was read of them.

**What was read.** An edge is read over an arm to both sides of its corner, but no farther than the
image: at its border one side is short. With the middle m and the half length h of what was read,
from the corner along the edge, an edge of curvature kappa passes the corner and is yet met there by
the straight line that lies nearest to what was read,

    kappa / 2 (h^2 / 3 - m^2),        that is kappa L^2 / 6 for both arms of length L,

off, on the side to which it bends: a fit that takes the edge for straight moves the corner so far.

**The map.** The fit of a corner tells of each of its edges the mean place and the direction: those
of the curve q(s) = c + s t + (kappa s^2 / 2 + kappa' s^3 / 6) n that lies nearest to it over what
was read, |s - m| <= h, whatever kappa and kappa' were taken to be. From the edge that a map of
cells to the image draws it is o(s) away, along n. For the mean and the slope of o Gauss's and
Legendre's four points suffice, up to polynomials of degree six; they tell its third derivative as
well, by which kappa' is off. The map is fitted to mean and slope by least squares,

    mean of o = 0,      S = sqrt(3) / h mean of (s - m) o = 0,

which are known equally well. It is a homography through a radial lens (``grid_map``), whose inverse
says at once how far a point is from a row's edge: its row less the edge's, over the gradient. To
the image's corners three coefficients of the lens do not reach where it bends by 20 %: three more,
by which the map varies linearly, are at choice. As the map draws the corner itself o(0) away from
c, where the line nearest to o is mean of o - sqrt(3) m / h S, it bends the edge aside by

    kappa / 2 (h^2 / 3 - m^2) - (mean of o - sqrt(3) m / h S) + o(0).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, IntArray, Size
from calibgui.engine.lattices import grid_map
from calibgui.engine.lattices.grid_map import InverseRadialHomography, RadialHomography

PLACES, _WEIGHTS = np.polynomial.legendre.leggauss(4)
"""(4,) places s - m on an edge, over h, and twice their weights."""
PRODUCTS = np.stack([_WEIGHTS, 3**0.5 * PLACES * _WEIGHTS]) / 2
"""(2, 4) weights in the mean and in the slope ..."""
_THIRD_DERIVATIVE = 105 / 4 * (5 * PLACES**3 - 3 * PLACES) * _WEIGHTS
"""(4,) ... and in the third derivative, times h^3."""
_MAX_STEPS = 30
"""Number of steps, tried ones included, from the lens that the corners show; two are usual."""
_LEAST_DAMPING, _FIRST_DAMPING, _DAMPING_FACTOR = 1e-13, 1e-11, 10.0
"""Dampings, which are added to the diagonal of a step's equations, over its sum: always, and once
a step has failed; and the factor by which it changes with each step that fails or does not."""
_CONVERGED_SHARE = 0.9
"""Share of the sum of squares that a step leaves at which it was the last."""
MIN_CORNERS = 16
"""Least number of corners that may tell more than three coefficients of a lens and a polynomial: of
3 x 3 it is chosen by chance now and then, and their error grows from 1.07 to 1.5 times the
bound."""
_MIN_CORNERS_OF_THREE = 12
"""Least number of corners that need not choose between two and three coefficients. Of 3 x 3
under 30 % barrel the outermost lie 1.25 times off the bound with three, and 1.16 times where they
choose; of 3 x 4 they lie 1.08 and 1.14 times off."""
LENS = -1
"""Stands for the degree of the lens's parameters. Those of the coefficients that follow are counted
from 0: all come before the polynomials'."""
MORE_COEFFICIENTS = 3
"""Number of these. With one the outermost of 54 corners lie up to 0.03 px off where the image cuts
the board, at 20 % barrel of r (1 + k1 r^2) = r': it is endless in powers of r'."""
_PARAMETERS = 14
"""Number of parameters of a homography through a lens of three coefficients."""
_BY_LAST_COLUMN = np.array([2, 5, 8])
"""Which of the derivatives by the parameters are those by the last column of A."""


class ReadEdges(NamedTuple):
    """The edges at n corners as they were fitted, given how their curvatures run."""

    uv: Array
    """(n, 2) the corners, px."""
    normals: Array
    """(n, 2, 2) unit normals of the row's edge towards the next row, and of the column's edge
    towards the next column."""
    curvature: Array
    """(n, 2) that they were taken to have at the corner, 1/px ..."""
    curvature_change: Array
    """(n, 2) ... and by how much it was taken to change along them, 1/px^2."""
    middle: Array
    """(n, 2) m, px."""
    half: Array
    """(n, 2) h, px."""

    def measure_bend(self, curvature: Array) -> Array:
        """Measure how far edges of `curvature` (n, 2) 1/px would be bent aside, (n, 2) px."""
        return curvature / 2 * (self.half**2 / 3 - self.middle**2)

    def compute_tangents(self) -> Array:
        """Compute the unit tangents (n, 2, 2), towards the next column and the next row."""
        n = self.normals
        return np.stack([n[..., 1], -n[..., 0]], axis=-1) * np.array([[1.0], [-1.0]])


class EdgeLens(NamedTuple):
    """The map fitted to the edges at n corners, and how it varies with k parameters."""

    first: Array
    """(n, 2, 2) derivatives of the position by column and by row, px."""
    stretch: Array
    """(n, 2) by how much steps grow from one column, and row, to the next, steps."""
    rest: Array
    """(2, 2, n) px, what is left of the means and of the slopes of edges 1 and 2."""
    columns: Array
    """(2, 2, n, k) how means and slopes vary."""
    degree: IntArray
    """(k,) order in which parameters are added: `LENS`, or that of a coefficient that follows."""
    bend: Array
    """(2, n) px, how far the map bends edges 1 and 2 aside."""
    bend_columns: Array
    """(2, n, k) how that varies."""
    curvature_change: Array
    """(n, 2) kappa' of edges 1 and 2, 1/px^2."""


def clip_arms(uv: Array, tangents: Array, arm: Array, size: Size) -> tuple[Array, Array]:
    """Clip arms to the image, whose outermost line of pixels is not read.

    Args:
        uv: (n, 2) the corners, px.
        tangents: (n, 2, 2) unit tangents of their edges.
        arm: (n, 2) how far the edges are read to both sides, px.
        size: width and height of the image, px.

    Returns:
        (n, 2) middles and (n, 2) half lengths, px, of what is left.
    """
    last = np.array(size) - 2.0
    to_border = np.minimum(uv - 1.0, last - uv)
    if (abs(tangents) * arm[..., None] <= to_border[:, None]).all():
        return np.zeros_like(arm), arm  # most boards lie in the image with all of their squares
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = np.stack([(1.0 - uv)[:, None] / tangents, (last - uv)[:, None] / tangents])
    ends = np.where(np.isfinite(ends), ends, np.array([-np.inf, np.inf]).reshape(2, 1, 1, 1))
    begin = np.maximum(np.minimum(ends.min(axis=0).max(axis=2), 0.0), -arm)
    end = np.minimum(np.maximum(ends.max(axis=0).min(axis=2), 0.0), arm)
    return (begin + end) / 2, (end - begin) / 2


def fit_lenses_to_edges(cells: Array, edges: ReadEdges) -> list[EdgeLens]:
    """Fit the map to the edges at corners: without a lens and, where the corners show one, with it.

    Without, three of the parameters stand for what a weak lens adds to a homography.

    Args:
        cells: (n, 2) = (col, row) of the corners.
        edges: what was read there.
    """
    scale, unit = float(np.std(cells)), float(np.std(edges.uv))
    x, u = (cells - cells.mean(axis=0)) / scale, (edges.uv - edges.uv.mean(axis=0)) / unit
    points = _sample_edges(u, edges, unit)
    corners = np.broadcast_to(u, (1, 2, *u.shape))
    to_corner = 3**0.5 * (edges.middle / edges.half).T
    start = grid_map.fit_radial_homography(x, u, are_exact=True, is_start=True)
    maps = [(start, inverse) for inverse in _fit_lenses(start, points, x)]
    if maps:
        start = grid_map.fit_plain_homography(x, u)
    maps.append((start, grid_map.invert_radial_homography(start)))
    taken = edges.measure_bend(edges.curvature).T
    fits = []
    for start, inverse in maps:
        offset, columns = _measure_offsets(inverse, points, x)
        (at_corner,), (by_parameters,) = _measure_offsets(inverse, corners, x)
        if not start.coefficients.any():
            columns = _add_weak_lens(columns, points)
            (by_parameters,) = _add_weak_lens(by_parameters[None], corners)
        first = np.asarray(np.linalg.inv(inverse.differentiate(u)[1]), dtype=np.float64)
        rest, varied = unit * _average(offset), -_average(columns)
        step, change = start.differentiate(x)
        stretch = np.sum(step * change, axis=2) / np.sum(step**2, axis=2) / scale
        bend = taken - (rest[0] - to_corner * rest[1]) + unit * at_corner
        by_line = varied[0] - to_corner[..., None] * varied[1]
        third = unit * np.tensordot(_THIRD_DERIVATIVE, offset, 1).T / edges.half**3
        degree = np.maximum(np.arange(varied.shape[-1]) - _PARAMETERS, LENS)
        fits.append(
            EdgeLens(
                unit / scale * first.transpose(0, 2, 1),
                stretch,
                rest,
                varied,
                degree,
                bend,
                by_line + by_parameters,
                edges.curvature_change - third,
            )
        )
    return fits


def _fit_lenses(
    start: RadialHomography, points: Array, cells: Array
) -> list[InverseRadialHomography]:
    """Fit maps through lenses of as many coefficients as there may be; none where `start` has no
    lens. Arguments as in `_refine_lens`."""
    if not start.coefficients.any():
        return []
    inverse = grid_map.invert_radial_homography(start)
    numbers = [3] if len(cells) >= _MIN_CORNERS_OF_THREE else [2, 3]
    lenses = []
    for k in numbers:
        bend = np.append(inverse.bend, np.zeros(k))[:k]
        inverse = inverse._replace(bend=bend)
        offset, columns = _measure_offsets(inverse, points, cells)
        inverse = _refine_lens(inverse, offset, columns, points, cells)
        lenses.append(inverse)
    if len(cells) >= MIN_CORNERS:
        more = np.zeros(MORE_COEFFICIENTS)
        lenses = [inverse._replace(bend=np.append(inverse.bend, more))]
    return lenses


def _add_weak_lens(columns: Array, points: Array) -> Array:
    """Return the derivatives (..., 12) of offsets at `points` (..., 2) by a homography and by what
    a weak lens adds to it, from those (..., k) by all parameters."""
    r = np.sum(points**2, axis=-1, keepdims=True)
    return np.concatenate([columns[..., :9], r * columns[..., _BY_LAST_COLUMN]], axis=-1)


def _refine_lens(
    inverse: InverseRadialHomography, offset: Array, columns: Array, points: Array, cells: Array
) -> InverseRadialHomography:
    """Refine a map by damped Gauss-Newton steps (Marquardt 1963) as long as that leaves less of the
    means and slopes.

    Under a strong lens the map of few corners is hardly determined along one direction, and an
    undamped step from the lens that the corners show leads far beyond.

    Args:
        inverse: the map.
        offset, columns: what `_measure_offsets` says of it.
        points: (4, 2, n, 2) the edges.
        cells: (n, 2) the corners' cells.
    """
    damping = 0.0
    for _ in range(_MAX_STEPS):
        rest, J = _average(offset).ravel(), _average(columns).reshape(-1, columns.shape[-1])
        try:
            stepped = inverse.take_step(J, rest, damping + _LEAST_DAMPING)
        except np.linalg.LinAlgError:
            break
        off, by_parameters = _measure_offsets(stepped, points, cells)
        before, after = rest @ rest, np.sum(_average(off) ** 2)
        if not after < before:
            damping = max(_DAMPING_FACTOR * damping, _FIRST_DAMPING)
            continue
        inverse, offset, columns = stepped, off, by_parameters
        if damping <= _FIRST_DAMPING and after > _CONVERGED_SHARE * before:
            break
        damping /= _DAMPING_FACTOR
    return inverse


def _average(values: Array) -> Array:
    """Return means and slopes (2, ...) of values (4, ...) at the `PLACES`."""
    return np.asarray(np.tensordot(PRODUCTS, values, 1))


def _sample_edges(uv: Array, edges: ReadEdges, unit: float) -> Array:
    """Sample the fitted edges at corners `uv` (n, 2), in units of px: (4, 2, n, 2) the points at
    `PLACES` of edges 1 and 2."""
    s = (edges.middle + PLACES[:, None, None] * edges.half) / unit
    bow = (edges.curvature + edges.curvature_change * unit * s / 3) * unit * s**2 / 2
    points = s[..., None] * edges.compute_tangents() + bow[..., None] * edges.normals
    return np.asarray((uv[:, None] + points).transpose(0, 2, 1, 3))


def _measure_offsets(
    inverse: InverseRadialHomography, points: Array, cells: Array
) -> tuple[Array, Array]:
    """Measure how far the points (k, 2, n, 2) of the edges at `cells` (n, 2) are from those that a
    map draws, (k, 2, n), and how that varies with its m parameters, (k, 2, n, m)."""
    row = np.arange(points[..., 0].size)
    axis = np.tile(np.repeat([1, 0], len(cells)), len(points))
    cell, by_u, by_parameters = inverse.differentiate(points.reshape(-1, 2))
    slope = np.linalg.norm(by_u[row, axis], axis=1)
    off = (cell[row, axis] - np.tile(cells[:, ::-1].T.ravel(), len(points))) / slope
    columns = by_parameters[row, axis] / slope[:, None]
    return off.reshape(points.shape[:3]), columns.reshape(*points.shape[:3], -1)

"""A plane seen through a radial lens, fitted to edges over all that was read of them.

The fit of a corner tells of each of its edges the mean place and the direction: those of the
parabola q(s) = c + s t + kappa s^2 / 2 n that lies nearest to it over the arm, |s| <= L, whatever
kappa was taken to be. From the edge that a map of cells to the image draws it is o(s) away, along
n. For the mean and the slope of o three points suffice,

    s = -sqrt(3/5) L, 0, sqrt(3/5) L    of weights 5/18, 8/18, 5/18

(Gauss and Legendre's), up to polynomials of degree five: under a strong lens edges are no
parabolas. The map is fitted to both by least squares,

    mean of o = 0,      sqrt(3) / L mean of s o = 0,

which are known equally well. It is a homography through a radial lens (``grid_map``), whose inverse
says at once how far a point is from a row's edge: its row less the edge's, over the gradient. And
as it draws the corner itself o(0) away from c, it bends the edge aside, over the arms, by

    kappa L^2 / 6 - mean of o + o(0).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.detection import grid_map
from calibgui.engine.detection.grid_map import InverseRadialHomography

_PLACES = np.array([-(0.6**0.5), 0.0, 0.6**0.5])
"""(3,) places s on an edge, over L."""
_WEIGHTS = np.array([5.0, 8.0, 5.0]) / 18
"""(3,) weights of these."""
_PRODUCTS = np.stack([_WEIGHTS, 3**0.5 * _PLACES * _WEIGHTS])
"""(2, 3) weights in the mean and in the slope."""
_MAX_STEPS = 30
"""Number of steps, tried ones included, from the lens that the corners show; two are usual."""
_LEAST_DAMPING, _FIRST_DAMPING, _DAMPING_FACTOR = 1e-13, 1e-11, 10.0
"""Dampings, which are added to the diagonal of a step's equations, over its sum: always, and once
a step has failed; and the factor by which it changes with each step that fails or does not."""
_CONVERGED_SHARE = 0.9
"""Share of the sum of squares that a step leaves at which it was the last."""
_BY_LAST_COLUMN = np.array([2, 5, 8])
"""Which of the derivatives by the parameters are those by the last column of A."""


class EdgeLens(NamedTuple):
    """The map fitted to the edges at n corners, and how it varies with k parameters."""

    first: Array
    """(n, 2, 2) derivatives of the position by column and by row, px."""
    rest: Array
    """(2, 2, n) px, what is left of the means and of the slopes of edges 1 and 2."""
    columns: Array
    """(2, 2, n, k) how means and slopes vary."""
    bend: Array
    """(2, n) px, how far the map bends edges 1 and 2 aside over their arms."""
    bend_columns: Array
    """(2, n, k) how that varies."""


def fit_edge_lenses(
    cells: Array, uv: Array, normals: Array, arm: Array, curvature: Array
) -> list[EdgeLens]:
    """Fit the map to the edges at corners: without a lens and, where the corners show one, with it.

    Without, three of the parameters stand for what a weak lens adds to a homography.

    Args:
        cells: (n, 2) = (col, row) of the corners.
        uv: (n, 2) where they are seen, px.
        normals: (n, 2, 2) unit normals of the row's edge towards the next row, and of the column's
            edge towards the next column.
        arm: (n, 2) how far the edges were read to both sides, px.
        curvature: (n, 2) that they were taken to have there, 1/px.
    """
    scale, unit = float(np.std(cells)), float(np.std(uv))
    x, u = (cells - cells.mean(axis=0)) / scale, (uv - uv.mean(axis=0)) / unit
    points = _sample_edges(u, normals, arm / unit, curvature * unit)
    starts = [grid_map.fit_radial_homography(x, u, are_exact=True)]
    if starts[0].coefficients.any():
        starts.append(grid_map.fit_plain_homography(x, u))
    third = (arm**2 / 6 * curvature).T
    fits = []
    for start in starts:
        inverse = grid_map.invert_radial_homography(start)
        offset, columns = _measure_offsets(inverse, points, x)
        if start.coefficients.any():
            inverse, offset, columns = _refine_lens(inverse, offset, columns, points, x)
        else:
            r = np.sum(points**2, axis=-1, keepdims=True)
            by_A, by_heights = columns[..., :9], columns[..., _BY_LAST_COLUMN]
            columns = np.concatenate([by_A, r * by_heights], axis=-1)
        first, _ = inverse.invert(u).differentiate(x)
        rest, varied = unit * _average(offset), -_average(columns)
        bend = third - rest[0] + unit * offset[1]
        fits.append(EdgeLens(unit / scale * first, rest, varied, bend, varied[0] + columns[1]))
    return fits


def _refine_lens(
    inverse: InverseRadialHomography, offset: Array, columns: Array, points: Array, cells: Array
) -> tuple[InverseRadialHomography, Array, Array]:
    """Refine a map by damped Gauss-Newton steps (Marquardt 1963) as long as that leaves less of the
    means and slopes.

    Under a strong lens the map of few corners is hardly determined along one direction, and an
    undamped step from the lens that the corners show leads far beyond.

    Args:
        inverse: the map.
        offset, columns: what `_measure_offsets` says of it.
        points: (3, 2, n, 2) the edges.
        cells: (n, 2) the corners' cells.

    Returns:
        The map, with its offsets and columns.
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
    return inverse, offset, columns


def _average(values: Array) -> Array:
    """Return means and slopes (2, ...) of values (3, ...) at the `_PLACES`."""
    return np.asarray(np.tensordot(_PRODUCTS, values, 1))


def _sample_edges(uv: Array, normals: Array, arm: Array, curvature: Array) -> Array:
    """Sample the parabolas: (3, 2, n, 2) the points at `_PLACES` of edges 1 and 2."""
    tangents = np.stack([normals[..., 1], -normals[..., 0]], axis=-1) * np.array([[1.0], [-1.0]])
    s = _PLACES[:, None, None] * arm
    points = s[..., None] * tangents + (curvature * s**2 / 2)[..., None] * normals
    return np.asarray((uv[:, None] + points).transpose(0, 2, 1, 3))


def _measure_offsets(
    inverse: InverseRadialHomography, points: Array, cells: Array
) -> tuple[Array, Array]:
    """Measure how far the points (3, 2, n, 2) of the edges at `cells` (n, 2) are from those that a
    map draws, (3, 2, n), and how that varies with its parameters, (3, 2, n, 14)."""
    row = np.arange(points[..., 0].size)
    axis = np.tile(np.repeat([1, 0], len(cells)), 3)
    cell, by_u, by_parameters = inverse.differentiate(points.reshape(-1, 2))
    slope = np.linalg.norm(by_u[row, axis], axis=1)
    off = (cell[row, axis] - np.tile(cells[:, ::-1].T.ravel(), 3)) / slope
    columns = by_parameters[row, axis] / slope[:, None]
    return off.reshape(points.shape[:3]), columns.reshape(*points.shape[:3], -1)

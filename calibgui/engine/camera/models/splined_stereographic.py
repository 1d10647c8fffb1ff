"""The splined model of mrcal: a stereographic projection, corrected by a surface of B-splines.

It is mrcal's LENSMODEL_SPLINED_STEREOGRAPHIC of order 3 in mrcal's own parametrisation
(https://mrcal.secretsauce.net/splined-models.html). A ray r = (X, Y, Z) at an angle theta from the
axis and an angle phi around it has the stereographic point

    u = 2 tan(theta / 2) (cos phi, sin phi) = 2 (X, Y) / (|r| + Z),

and its image point is d = u + c(u) with c a cubic B-spline surface over Nx by Ny control points,
whose values are the coefficients. The control points lie at

    u = ((ix - (Nx - 1) / 2) h, (iy - (Ny - 1) / 2) h),      h = 4 tan(fov / 4) / (Nx - 3),

and in each cell between four of them the surface depends on 4 by 4: with x from 0 to 1 the place
in a cell, one coordinate's weights are

    b = ((1 - x)^3, 3 x^3 - 6 x^2 + 4, -3 x^3 + 3 x^2 + 3 x + 1, x^3) / 6,

and the weight of a control point is w_ij = b_i(y) b_j(x).

The outermost cells have no control points around them: mrcal continues the polynomials of the
cells before. Up to there the surface covers the angle `fov` from left to right and (Ny - 3) h of u
from top to bottom. This model has images up to the outermost control points, so that a corner at
the edge does not block the solver, and none beyond: mrcal continues there as well, but cubic
polynomials soon bend back.

With m = |r| + Z the derivatives are

    du/dr = 2 [(I - p q^T) / m, -p / |r|],      p = (X, Y) / m,      q = (X, Y) / |r|,
    dd/dr = (I + dc/du) du/dr,          dd_x/dc_ij,x = dd_y/dc_ij,y = w_ij,

and on the way back, with e = 1 + |u|^2 / 4, the ray of length 1 is (u / e, 2 / e - 1), and
db/du = [I / e - u u^T / (2 e^2); -u / e^2]. u itself solves u + c(u) = d by Newton's method.

The surface also holds what focal lengths and centre do, and what a small rotation of the camera
does. So fx, fy, cx and cy are held, as mrcal holds them; the rotation is left to a weak pull of
the control points towards 0 (`compute_stiffness`), which at the same time keeps those where they
are that no corner touches.
"""

from __future__ import annotations

import re
from functools import cache
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, BoolArray, IntArray
from calibgui.engine.camera.inverse import solve_pairs
from calibgui.engine.camera.model import Lens, LensProjection, LensUnprojection
from calibgui.engine.errors import CalibrationError
from calibgui.engine.kernels import with_kernel

PREFIX = "splined-stereographic"
"""Beginning of the ids of all splined models; by itself it is the model with the defaults."""
DEFAULT_CONTROL_POINTS, DEFAULT_FOV = (16, 11), 120
"""Control points along x and y, and degrees from left to right, of the model named `PREFIX`."""
_MIN_ALONG_AXIS, _MAX_COUNT = 4, 3000
"""Least number of control points along an axis, and largest in all: the solver needs memory for
the square of twice their number."""
_PULL, _TANGENTIAL = 0.0625, 100.0
"""mrcal's pull of a control point towards 0, in squared residuals per corner and control point,
and how many times it is as strong across the direction to the centre."""
_EDGE = 1e-9
"""Part of the way to the outermost control points by which rounding errors may lead beyond."""
_NODES_PER_CELL = 2
"""Number of places along a cell's side, of which the nearest starts Newton's method."""
_MAX_ITERATIONS = 60
"""Number of Newton steps, at most; most points take 4."""
_MIN_SHARE = 1e-6
"""Share of a Newton step below which a point has no way on: the surface folds before it."""
_MAX_STEP = 4e-15
"""Length of the last Newton step, relative to 1 + |u|: a few units in the last place."""
_MAX_MISS = 1e-13
"""Residual, relative to 1 + |d|, up to which a point has converged although its steps have not."""

_MIN_COMPILED_POINTS = 1000
"""Number of points from which their images are computed by compiled code."""


class LocalProjection(NamedTuple):
    """Image points of rays, with the few control points that each depends on."""

    points: Array
    """(..., 2) d."""
    by_ray: Array
    """(..., 2, 3) derivative by the ray."""
    weights: Array
    """(..., 16) derivatives of d_x by dx, and of d_y by dy, of the control points, row by row."""
    first: IntArray
    """(...) index iy * Nx + ix of the first of these control points."""


class SplinedStereographic(Lens):
    """The splined model with Nx by Ny control points over `fov` degrees from left to right.

    The coefficients are dx and dy of the control points, row by row: ``dx_2_5`` is the shift to
    the right of the control point in row 2 from the top and column 5 from the left, counted from 0.
    """

    title = "Splined stereographic (mrcal)"
    held = ("fx", "fy", "cx", "cy")
    edge: Array
    """(2,) |u| of the outermost control points."""

    def __init__(self, Nx: int, Ny: int, fov: int) -> None:
        """Lay out the control points.

        Raises:
            CalibrationError: if there are fewer than 4 along an axis or too many in all, or if the
                angle is not between 0 and 360 degrees.
        """
        if min(Nx, Ny) < _MIN_ALONG_AXIS or Nx * Ny > _MAX_COUNT or not 0 < fov < 360:
            raise CalibrationError(
                f"There is no splined model of {Nx} x {Ny} control points over {fov} degrees.",
                f"Give at least {_MIN_ALONG_AXIS} x {_MIN_ALONG_AXIS} and at most {_MAX_COUNT} "
                "control points and an angle below 360 degrees.",
            )
        self.Nx, self.Ny, self.fov = Nx, Ny, fov
        self.id = f"{PREFIX}-{Nx}x{Ny}-{fov}"
        self.pitch = 4 * np.tan(np.deg2rad(fov) / 4) / (Nx - 3)
        self.control_points = (Nx, Ny)
        self.edge = self.pitch * np.array([Nx - 1, Ny - 1]) / 2
        self.limit = (1 + _EDGE) * self.edge
        """(2,) the same, and a little for rounding errors."""
        self.neighbours = (Nx * np.arange(4)[:, None] + np.arange(4)).ravel()
        """(16,) indices of the control points of a cell, relative to the first."""
        self.names = tuple(
            f"{axis}_{iy}_{ix}" for iy in range(Ny) for ix in range(Nx) for axis in ("dx", "dy")
        )
        self.powers = (0,) * len(self.names)
        self.asymmetric = self.names

    def project(self, rays: Array, k: Array) -> LensProjection:
        """Map rays to image points. NaN beyond the outermost control points.

        The derivatives by all coefficients are 2 C numbers a ray; `project_locally` returns those
        that are not 0, and `project_points` none.
        """
        points, by_ray, weights, first = self.project_locally(rays, k)
        return LensProjection(points, by_ray, self._spread_weights(weights, first))

    def project_points(self, rays: Array, k: Array) -> Array:
        """Map rays to image points (..., 2) without derivatives, as `project`."""
        u = stereographic_from_rays(rays)[0]
        return np.asarray(u + evaluate_surface(self, u, k)[0])

    def project_locally(self, rays: Array, k: Array) -> LocalProjection:
        """Map rays to image points, with the derivatives that are not 0, as `project`."""
        u, by_ray = stereographic_from_rays(rays)
        shift, by_u = evaluate_surface(self, u, k)
        weights, first = self._weigh_control_points(u)
        return LocalProjection(u + shift, (np.eye(2) + by_u) @ by_ray, weights, first)

    def unproject(self, d: Array, k: Array) -> LensUnprojection:
        """Map image points to rays of length 1, by Newton's method.

        NaN where no place between the control points is imaged at d, and where the surface folds.
        """
        u, by_d = self._invert(d, k)
        rays, by_u = rays_from_stereographic(u)
        by_d = by_u @ by_d
        return LensUnprojection(
            rays, by_d, -by_d @ self._spread_weights(*self._weigh_control_points(u))
        )

    def unproject_points(self, d: Array, k: Array) -> tuple[Array, Array]:
        """Map image points to rays of length 1, and return the derivatives (..., 3, 2) by d."""
        u, by_d = self._invert(d, k)
        rays, by_u = rays_from_stereographic(u)
        return rays, by_u @ by_d

    def locate_control_points(self) -> Array:
        """Return u (Ny, Nx, 2) of the control points."""
        ix, iy = np.meshgrid(np.arange(self.Nx), np.arange(self.Ny))
        centred = np.stack([ix - (self.Nx - 1) / 2, iy - (self.Ny - 1) / 2], axis=-1)
        return np.asarray(self.pitch * centred)

    def compute_stiffness(self, corners: int) -> Array:
        """Compute (C, C) the matrix Q of the pull k^T Q k that the solver adds to the cost.

        It is mrcal's default: each control point is pulled towards 0, a hundred times as strongly
        across its direction from the centre as along it, because lenses shift points along it. If
        the shifts along it have a root mean square of 0.2 in each coordinate, their cost is 1/400
        of that of residuals of 1 px, for any number of corners.

        Args:
            corners: number of corners in all views.
        """
        pull = self._compute_pull(corners)
        stiffness = np.zeros((len(pull), 2, len(pull), 2))
        each = np.arange(len(pull))
        stiffness[each, :, each] = pull
        return stiffness.reshape(2 * len(pull), -1)

    def _compute_pull(self, corners: int) -> Array:
        """Compute (Nx Ny, 2, 2) the blocks of `compute_stiffness` on its diagonal."""
        u = self.locate_control_points().reshape(-1, 2)
        across = u @ np.array([[0.0, 1.0], [-1.0, 0.0]])
        across /= np.maximum(np.hypot(*u.T), 1e-12 * self.pitch)[:, None]
        pull = np.eye(2) + (_TANGENTIAL - 1) * across[:, :, None] * across[:, None]
        return np.asarray(_PULL * corners / len(u) * pull)

    def mirror(self, k: Array, along: tuple[bool, bool]) -> Array:
        """Return the coefficients of the mirrored lens: its control points change places."""
        shifts = k.reshape(self.Ny, self.Nx, 2)
        if along[0]:
            shifts = shifts[:, ::-1] * [-1.0, 1.0]
        if along[1]:
            shifts = shifts[::-1] * [1.0, -1.0]
        return np.asarray(shifts.ravel())

    def fit_to_rays(self, rays: Array, d: Array) -> Array:
        """Fit the surface to image points of rays, by linear least squares.

        Rays beyond the outermost control points and points that are not finite do not count. Where
        there are none, the pull of `compute_stiffness` keeps the surface, for residuals in
        thousandths of d.

        Args:
            rays: (n, 3) rays of any length.
            d: (n, 2) their image points, dimensionless.

        Returns:
            (C,) the coefficients.
        """
        u = stereographic_from_rays(rays)[0]
        weights, first = self._weigh_control_points(u)
        good = np.isfinite(d).all(axis=1) & np.isfinite(weights[:, 0])
        index = (first[good][:, None] + self.neighbours).ravel()
        begin = np.arange(0, index.size + 1, 16)
        count = self.Nx * self.Ny
        basis = scipy.sparse.csr_array((weights[good].ravel(), index, begin), (good.sum(), count))
        target = basis.T @ (d - u)[good]
        pull = 1e-6 * self._compute_pull(max(int(good.sum()), 1))
        # Row k holds the k-th diagonal below the main one: corners couple control points of 4 rows.
        normal = np.zeros((2 * (3 * self.Nx + 3) + 1, 2 * count))
        products = (basis.T @ basis).tocoo()
        row, column = products.coords
        below = row >= column
        for axis in range(2):
            place = 2 * (row - column)[below], 2 * column[below] + axis
            normal[place] = products.data[below]
            normal[0, axis::2] += pull[:, axis, axis]
        normal[1, ::2] = pull[:, 1, 0]
        return np.asarray(scipy.linalg.solveh_banded(normal, target.ravel(), lower=True))

    def find_cells(self, u: Array) -> tuple[IntArray, Array]:
        """Return the first control point (...) of the cell of u, and the place (..., 2) in it.

        NaN beyond the outermost control points.
        """
        size = np.array([self.Nx, self.Ny])
        inside = (np.abs(u) <= self.limit).all(axis=-1, keepdims=True)
        place = np.where(inside, u, 0.0) / self.pitch + (size - 1) / 2
        cell = np.clip(np.floor(place), 1, size - 3).astype(np.intp)
        first = (cell[..., 1] - 1) * self.Nx + cell[..., 0] - 1
        return first, np.where(inside, place - cell, np.nan)

    def _weigh_control_points(self, u: Array) -> tuple[Array, IntArray]:
        """Return the weights (..., 16) of the control points of the cell of u, and the first."""
        first, place = self.find_cells(u)
        values = np.stack(_weigh_neighbours(place)[0], axis=-1)
        weights = values[..., 1, :, None] * values[..., 0, None, :]
        return weights.reshape(*first.shape, 16), first

    def _invert(self, d: Array, k: Array) -> tuple[Array, Array]:
        """Return u (..., 2) of image points and du/dd (..., 2, 2)."""
        target = d.reshape(-1, 2)
        limits = np.array([_MAX_ITERATIONS, _MIN_SHARE, _MAX_STEP, _MAX_MISS])
        u, miss, J = iterate_newton(self, self._find_starts(target, k), target, k, limits)
        det = J[:, 0, 0] * J[:, 1, 1] - J[:, 0, 1] * J[:, 1, 0]
        small = np.hypot(*miss.T) <= _MAX_MISS * (1 + np.hypot(*target.T))
        good = small & (det > 0) & (J[:, 0, 0] + J[:, 1, 1] > 0)
        inverse = np.full_like(J, np.nan)
        inverse[good] = np.linalg.inv(J[good])
        u[~good] = np.nan
        return u.reshape(d.shape), inverse.reshape(*d.shape, 2)

    def _find_starts(self, d: Array, k: Array) -> Array:
        """Return u (n, 2) of the place imaged nearest to each d, of a grid where nothing folds.

        A strong correction leaves Newton's method far away if it starts from d itself.
        """
        x, y = (
            np.linspace(-edge, edge, _NODES_PER_CELL * (count - 1) + 1)
            for edge, count in zip(self.edge, (self.Nx, self.Ny), strict=True)
        )
        nodes = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        images, J = self.measure_miss(nodes, np.zeros(2), k)
        rises = self._select_sheet(np.linalg.det(J).reshape(len(y), len(x)) > 0)
        starts = np.full_like(d, np.nan)
        good = np.isfinite(d).all(axis=1)
        if rises.any() and good.any():
            nearest = scipy.spatial.cKDTree(images[rises]).query(d[good])[1]
            starts[good] = nodes[rises][nearest]
        return starts

    @staticmethod
    def _select_sheet(rises: BoolArray) -> BoolArray:
        """Select the nodes (n,) where the surface rises (y, x) and has not folded since the axis.

        Where no corner keeps it, the surface may fold twice, and a second sheet lie over the first.
        """
        sheets, _ = scipy.ndimage.label(rises)
        own = sheets[rises.shape[0] // 2, rises.shape[1] // 2]
        return np.asarray((sheets == own if own else rises).ravel())

    def measure_miss(self, u: Array, d: Array, k: Array) -> tuple[Array, Array]:
        """Return u + c(u) - d (n, 2) and its derivative (n, 2, 2) by u."""
        shift, by_u = evaluate_surface(self, u, k)
        return u + shift - d, np.eye(2) + by_u

    def _spread_weights(self, weights: Array, first: IntArray) -> Array:
        """Return derivatives (..., 2, C) by all coefficients from those by a cell's."""
        weights, index = weights.reshape(-1, 16), first.reshape(-1, 1) + self.neighbours
        by_k = np.zeros((len(index), 2, self.Nx * self.Ny, 2))
        by_k[np.isnan(weights[:, 0])] = np.nan
        each = np.arange(len(index))[:, None]
        for axis in range(2):
            by_k[each, axis, index, axis] = weights
        return by_k.reshape(*first.shape, 2, len(self.names))


def stereographic_from_rays(rays: Array) -> tuple[Array, Array]:
    """Return u (..., 2) of rays (..., 3) of any length, and du/dr (..., 2, 3).

    NaN for a ray of length 0 and straight backwards.
    """
    xy, Z = rays[..., :2], rays[..., 2:]
    length = np.linalg.norm(rays, axis=-1, keepdims=True)
    with np.errstate(all="ignore"):
        # Behind the camera |r| + Z is a difference of numbers almost equal.
        m = np.where(Z < 0, np.sum(xy * xy, axis=-1, keepdims=True) / (length - Z), length + Z)
        m[~(m > 0)] = np.nan
        p, q = xy / m, xy / length
        by_xy = 2 * (np.eye(2) - p[..., None] * q[..., None, :]) / m[..., None]
        by_ray = np.concatenate([by_xy, -2 * (p / length)[..., None]], axis=-1)
    return 2 * p, by_ray


def rays_from_stereographic(u: Array) -> tuple[Array, Array]:
    """Return rays (..., 3) of length 1 of u (..., 2), and their derivatives (..., 3, 2) by u."""
    e = 1 + np.sum(u * u, axis=-1, keepdims=True) / 4
    rays = np.concatenate([u / e, 2 / e - 1], axis=-1)
    across = np.eye(2) / e[..., None] - u[..., None] * u[..., None, :] / (2 * e * e)[..., None]
    return rays, np.concatenate([across, -(u / e**2)[..., None, :]], axis=-2)


@cache
def find_splined_model(model: str) -> SplinedStereographic | None:
    """Return the splined model of an id such as ``splined-stereographic-30x20-150``.

    It is None if the id is none of a splined model.

    Raises:
        CalibrationError: if there is no model with these numbers.
    """
    numbers = re.fullmatch(PREFIX + r"-(\d{1,5})x(\d{1,5})-(\d{1,5})", model)
    return SplinedStereographic(*map(int, numbers.groups())) if numbers else None


def _are_many(_lens: SplinedStereographic, u: Array, *_: Array) -> bool:
    """Return whether there are so many points that loading their kernel is worth it."""
    return u.size >= 2 * _MIN_COMPILED_POINTS


@with_kernel("splined_lens", "evaluate_surface", _are_many)
def evaluate_surface(lens: SplinedStereographic, u: Array, k: Array) -> tuple[Array, Array]:
    """Return c(u) (..., 2) and dc/du (..., 2, 2), NaN beyond the outermost control points."""
    first, place = lens.find_cells(u)
    values, slopes = _weigh_neighbours(place)
    shift, by_u = np.zeros(u.shape), np.zeros((*u.shape, 2))
    for j in range(4):
        row, along = np.zeros(u.shape), np.zeros(u.shape)
        for i in range(4):
            control = k.reshape(-1, 2)[first + (j * lens.Nx + i)]
            row += values[i][..., :1] * control
            along += slopes[i][..., :1] * control
        shift += values[j][..., 1:] * row
        by_u[..., 0] += values[j][..., 1:] * along
        by_u[..., 1] += slopes[j][..., 1:] * row
    return shift, by_u / lens.pitch


@with_kernel("splined_lens", "iterate_newton", _are_many)
def iterate_newton(
    lens: SplinedStereographic, u: Array, d: Array, k: Array, limits: Array
) -> tuple[Array, Array, Array]:
    """Solve u + c(u) = d by Newton's method, with steps shortened until they lead nearer.

    Args:
        lens: the lens model.
        u: (n, 2) starts.
        d: (n, 2) image points.
        k: (C,) coefficients.
        limits: the values of _MAX_ITERATIONS, _MIN_SHARE, _MAX_STEP and _MAX_MISS.

    Returns:
        (n, 2) u where the iteration ended, (n, 2) u + c(u) - d there and (n, 2, 2) its derivatives;
        not finite where the start or d is not.
    """
    max_iterations, min_share, max_step, max_miss = limits
    u = u.copy()
    miss, J = lens.measure_miss(u, d, k)
    active = np.flatnonzero(np.isfinite(miss).all(axis=1))
    share = np.ones(len(u))
    for _ in range(int(max_iterations)):
        if not active.size:
            break
        with np.errstate(all="ignore"):  # a singular J gives no step
            step = solve_pairs(J[active], -miss[active])
        trial = np.clip(u[active] + share[active, None] * step, -lens.edge, lens.edge)
        there, slope = lens.measure_miss(trial, d[active], k)
        better = np.hypot(*there.T) < np.hypot(*miss[active].T)
        taken = active[better]
        u[taken], miss[taken], J[taken] = trial[better], there[better], slope[better]
        share[active] = np.where(better, np.minimum(2 * share[active], 1.0), share[active] / 4)
        size = 1 + np.hypot(*u[active].T)
        moving = np.hypot(*step.T) > max_step * size
        # Rounding errors leave nothing to gain, or a wall of folds stands in the way.
        moving &= better | (np.hypot(*miss[active].T) > 0.1 * max_miss * size)
        active = active[moving & (share[active] > min_share)]
    return u, miss, J


def _weigh_neighbours(x: Array) -> tuple[list[Array], list[Array]]:
    """Return the four weights of a cubic B-spline at x, mostly from 0 to 1, and their slopes."""
    y = 1 - x
    values = [y**3, 3 * x**3 - 6 * x**2 + 4, 3 * y**3 - 6 * y**2 + 4, x**3]
    slopes = [-(y**2), 3 * x**2 - 4 * x, 4 * y - 3 * y**2, x**2]
    return [value / 6 for value in values], [slope / 2 for slope in slopes]

"""Causes of systematic residuals that each view has of its own, as columns of derivatives.

A board that bends anew, a camera that moves while its rows are read: such causes add columns to
the derivatives in each view. How much they explain is measured by a fit (``cause_fits.py``), but
for that of any smooth displacement, whose many columns follow the camera's: there it is a score
test (``calibration/score_tests.py``) without the camera's parameters. The products of columns with
each other, after the views' poses are eliminated, serve to part views (``mixed_views.py``).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.assessment.residuals.cause_fits import MIN_EIGENVALUE, CauseFit, Columns
from calibgui.engine.calibration.observations import Observation, slice_views
from calibgui.engine.calibration.problem import (
    find_free_parameters,
    make_state,
    prepare_observations,
)
from calibgui.engine.calibration.refinement.residuals import Linearised
from calibgui.engine.calibration.result import Calibration, Cost
from calibgui.engine.calibration.score_tests import (
    Explanation,
    LinearisedFit,
    judge_explanation,
)

_KNOT_SPACING = 1 / 16
"""Distance of the knots between which rows are shifted, over the image's longer side."""
_KNOTS = np.arange(-16, 17)
"""Knots along the rows, counted from the board's mean row."""


class ViewProducts(NamedTuple):
    """Products of columns that each view has of its own, after its pose is eliminated."""

    N: Array
    """(K, m, m) products of the columns with each other."""
    b: Array
    """(K, m) products of the columns with the residuals."""
    shared: Array
    """(K, P, P) products of the camera's free columns with each other."""
    between: Array
    """(K, P, m) products of the camera's columns with those of the view's own."""
    gradient: Array
    """(K, P) products of the camera's columns with the residuals."""
    cost: float
    """The sum of squares r^T r."""
    freedom: int
    """Number of residual coordinates beyond that of the fitted unknowns."""


class OpenSteps(NamedTuple):
    """Steps to columns of each view's own that are so many that they follow nearly anything."""

    smooth: CauseFit
    """The step to smooth displacements of the image."""
    lines: CauseFit
    """The step to shifts from row to row."""
    dispersion: float
    """How much more than independent noise each further unknown of a view explains: the mean square
    that shifts from row to row explain of what smooth displacements leave, over the variance that
    both leave; at least 1. Rows that do not start evenly have errors that are alike along them, of
    which any cause with many unknowns takes more than its share."""


def prepare_fit(calibration: Calibration, views: Sequence[Observation]) -> LinearisedFit:
    """Prepare a calibration and the views that it was made from for the tests."""
    observations = prepare_observations(calibration, views)
    if calibration.cost is Cost.PAPER:  # its board is stretched, see ``refinement/residuals.py``
        fx, fy = calibration.camera.focal
        stretched = observations.xy * np.array([1.0, fx / fy])
        observations = replace(observations, xy=stretched)
    return LinearisedFit(
        calibration.camera,
        make_state(calibration.camera, calibration.poses),
        observations,
        find_free_parameters(calibration),
    )


def weigh_views(fit: LinearisedFit, sigma: Array) -> LinearisedFit:
    """Return a fit with every view's residuals divided by its standard deviation (K,)."""
    return fit.weigh(fit.get_weight(slice(0, len(sigma))) / sigma[:, None, None, None])


def take_open_steps(fit: LinearisedFit) -> OpenSteps:
    """Take a step to each kind of columns that follow nearly anything, beside the poses."""

    def make_columns(fit: LinearisedFit, linear: Linearised, views: slice) -> Array:
        parts = [make(fit, linear, views) for make in (make_cubic_displacements, make_line_columns)]
        return np.concatenate(parts, axis=-1)

    products = _multiply_own_columns(fit, make_columns)
    lines = products.N.shape[-1] - len(_KNOTS)
    smooth, both = (_take_step(products, part) for part in (slice(lines), slice(None)))
    further, rest = both.unknowns - smooth.unknowns, fit.degrees_of_freedom - both.unknowns
    dispersion = 1.0
    if further >= 1 and rest >= 1 and both.cost > 0:
        dispersion = max((smooth.cost - both.cost) / further / (both.cost / rest), 1.0)
    return OpenSteps(smooth, _take_step(products, slice(lines, None)), dispersion)


def _take_step(products: ViewProducts, columns: slice) -> CauseFit:
    """Take a step to some of the columns."""
    T, rank = compute_reductions(products.N[:, columns, columns], products.b[:, columns])
    return CauseFit(products.cost, 0).lower(float(T.sum()), int(rank.sum()))


def make_focus_columns(fit: LinearisedFit, _: Linearised, views: slice) -> Array:
    """Make the column of a focal length of each view's own."""
    from_centre = fit.predict_corners(views) - fit.camera.centre
    return np.asarray(fit.get_weight(views) @ from_centre[..., None])


def _make_distortion_columns(fit: LinearisedFit, _: Linearised, views: slice) -> Array:
    """Make the columns of displacements along the radius, as its third and its fifth power."""
    from_centre = fit.predict_corners(views) - fit.camera.centre
    r2 = np.sum(from_centre**2, axis=-1, keepdims=True) / max(fit.camera.size) ** 2
    columns = np.stack([r2 * from_centre, r2 * r2 * from_centre], axis=-1)
    return np.asarray(fit.get_weight(views) @ columns)


def make_centre_columns(_: LinearisedFit, linear: Linearised, __: slice) -> Array:
    """Make the columns of a principal point of each view's own.

    A rotation of the camera hides most of it; what is left is that of an image in perspective, so
    that an image that was straightened is explained as well as one that was shifted or cropped.
    """
    return linear.by_params[..., 2:4]


def make_bending_columns(fit: LinearisedFit, linear: Linearised, views: slice) -> Array:
    """Make the columns of a board that bends anew in each view, quadratically."""
    x, y = np.moveaxis(_scale_places(fit, views), -1, 0)
    by_height = linear.by_pose[..., 3:] @ fit.state.R[views, None, :, 2:]
    return np.asarray(by_height * np.stack([x * x, x * y, y * y], axis=-1)[..., None, :])


def make_row_columns(fit: LinearisedFit, linear: Linearised, views: slice) -> Array:
    """Make the columns of a steady motion while the rows are read: a rolling shutter's."""
    return np.asarray(linear.by_pose * _measure_rows(fit, views)[..., None, None])


def _make_roll_columns(fit: LinearisedFit, _: Linearised, views: slice) -> Array:
    """Make the column of a steady roll about the optical axis while rows are read, rad over the
    image's height."""
    x, y = np.moveaxis(fit.predict_corners(views) - fit.camera.centre, -1, 0)
    turned = np.stack([-y, x], axis=-1) * y[..., None] / fit.camera.size[1]
    return np.asarray(fit.get_weight(views) @ turned[..., None])


def _make_skew_columns(fit: LinearisedFit, _: Linearised, views: slice) -> Array:
    """Make the column of a shift of each row sideways, px, in proportion to its number."""
    row = fit.predict_corners(views)[..., 1] - fit.camera.centre[1]
    return np.asarray(fit.get_weight(views)[..., :1] * row[..., None, None])


def make_line_columns(fit: LinearisedFit, _: Linearised, views: slice) -> Array:
    """Make the columns of a shift along the rows that wanders from row to row in each view."""
    rows = _measure_rows(fit, views)[..., None]
    hats = np.maximum(1 - np.abs(rows / _KNOT_SPACING - _KNOTS), 0.0)
    return np.asarray(fit.get_weight(views)[..., :1] * hats[..., None, :])


def _measure_rows(fit: LinearisedFit, views: slice) -> Array:
    """Return the rows (k, N) of corners from their view's mean, over the image's longer side."""
    row = fit.predict_corners(views)[..., 1] / max(fit.camera.size)
    return np.asarray(row - row.mean(axis=1, keepdims=True))


def multiply_by_focus(fit: LinearisedFit) -> ViewProducts:
    """Multiply the column of a focal length of each view's own."""
    return _multiply_own_columns(fit, make_focus_columns)


def multiply_by_distortion(fit: LinearisedFit) -> ViewProducts:
    """Multiply the columns of a radial distortion of each view's own."""
    return _multiply_own_columns(fit, _make_distortion_columns)


def multiply_by_camera(fit: LinearisedFit) -> ViewProducts:
    """Multiply the columns of a camera (fx, fy, cx, cy, distortion) of each view's own."""

    def make_columns(fit: LinearisedFit, linear: Linearised, views: slice) -> Array:
        distortion = _make_distortion_columns(fit, linear, views)
        return np.concatenate([linear.by_params[..., :4], distortion], axis=-1)

    return _multiply_own_columns(fit, make_columns)


def multiply_by_board(fit: LinearisedFit) -> ViewProducts:
    """Multiply the columns of a board of each view's own, with unequal sides and shear."""
    y = fit.observations.xy[..., 1]
    y = y / np.abs(y).max()

    def make_columns(fit: LinearisedFit, linear: Linearised, views: slice) -> Array:
        by_place = linear.by_pose[..., 3:] @ fit.state.R[views, None, :, :2]
        return np.asarray(by_place * y[views, :, None, None])

    return _multiply_own_columns(fit, make_columns)


def multiply_by_roll(fit: LinearisedFit) -> ViewProducts:
    """Multiply the column of a steady roll of each view's own, rad over the image's height."""
    return _multiply_own_columns(fit, _make_roll_columns)


def multiply_by_skew(fit: LinearisedFit) -> ViewProducts:
    """Multiply the column of a skew of each view's own."""
    return _multiply_own_columns(fit, _make_skew_columns)


def judge_together(products: ViewProducts) -> Explanation:
    """Judge columns as the cause that all views share, beside the camera: by a score test."""
    S, B, N = (a.sum(axis=0) for a in (products.shared, products.between, products.N))
    gradient, b = products.gradient.sum(axis=0), products.b.sum(axis=0)
    unit = 1 / np.sqrt(np.maximum(np.diag(S), 1e-24))
    S = S * np.outer(unit, unit)
    taken = np.linalg.lstsq(S, unit[:, None] * np.column_stack([B, gradient]), rcond=None)[0]
    by_camera = (unit[:, None] * B).T @ taken
    left = N - by_camera[:, :-1]
    is_told = np.diag(left) > MIN_EIGENVALUE * np.diag(N)  # others have columns like it already
    left, b = left[np.ix_(is_told, is_told)], (b - by_camera[:, -1])[is_told]
    T, rank = compute_reductions(left[None], b[None])
    return judge_explanation(float(T[0]), int(rank[0]), products.cost, products.freedom)


def _multiply_own_columns(fit: LinearisedFit, columns: Columns) -> ViewProducts:
    """Multiply columns that each view has of its own, and the camera's, without the view's pose."""
    G, P = multiply_columns(fit, columns), len(fit.free)
    cost = float(sum(np.sum(fit.linearise(v).residual ** 2) for v in slice_views(len(G))))
    return ViewProducts(
        G[:, P:-1, P:-1], G[:, P:-1, -1], G[:, :P, :P], G[:, :P, P:-1], G[:, :P, -1], cost,
        fit.degrees_of_freedom,
    )  # fmt: skip


def multiply_columns(fit: LinearisedFit, columns: Columns) -> Array:
    """Multiply the P columns of the camera, m others and the residuals with each other.

    Returns:
        (K, P + m + 1, P + m + 1) products of what the views' poses leave of them.
    """
    parts = []
    for views in slice_views(len(fit.state.R)):
        linear = fit.linearise(views)
        k = len(linear.residual)
        X = columns(fit, linear, views)
        stacked = (linear.by_params[..., fit.free], X, linear.residual[..., None])
        whole = np.concatenate(stacked, axis=-1)
        whole = whole.reshape(k, -1, whole.shape[-1])
        # Columns that no corner depends on would be divided by 0.
        Jp = linear.by_pose.reshape(k, -1, 6)
        Jp = Jp / np.maximum(np.linalg.norm(Jp, axis=1, keepdims=True), 1e-12)
        Q = np.linalg.qr(Jp)[0]
        left = whole - Q @ (np.swapaxes(Q, 1, 2) @ whole)
        parts.append(np.swapaxes(left, 1, 2) @ left)
    return np.concatenate(parts)


def compute_reductions(N: Array, b: Array) -> tuple[Array, IntArray]:
    """Return b^T N^+ b (K,) and the ranks (K,) of K matrices N (m, m)."""
    # Columns may depend on no corner at all.
    unit = 1 / np.sqrt(np.maximum(np.diagonal(N, axis1=1, axis2=2), 1e-24))
    values, vectors = np.linalg.eigh(N * unit[:, :, None] * unit[:, None])
    good = values > MIN_EIGENVALUE
    along = ((unit * b)[:, None] @ vectors)[:, 0]
    return np.sum(np.where(good, along**2 / np.where(good, values, 1.0), 0.0), 1), good.sum(axis=1)


def make_smooth_columns(fit: LinearisedFit) -> Array:
    """Make orthonormal columns (K, 2N, m) of what a view may have of its own, poses among them.

    They are the pose's derivatives and cubic displacements of the image over the board, which
    follow a board that bends, a lens that breathes and a camera that moves. Columns that depend on
    each other, as in views of few corners, leave zeros at the end.
    """
    K = len(fit.observations.xy)
    linear = fit.linearise(slice(0, K))
    smooth = make_cubic_displacements(fit, linear, slice(0, K))
    smooth = smooth.reshape(K, -1, smooth.shape[-1])
    # Columns that no corner depends on would be divided by 0.
    smooth /= np.maximum(np.linalg.norm(smooth, axis=1, keepdims=True), 1e-300)
    pose = np.linalg.qr(linear.by_pose.reshape(K, -1, 6))[0]
    left, values, _ = np.linalg.svd(smooth - pose @ (np.swapaxes(pose, 1, 2) @ smooth), False)
    left *= (values > np.sqrt(MIN_EIGENVALUE))[:, None, :]
    return np.concatenate([pose, left], axis=-1)


def make_cubic_displacements(fit: LinearisedFit, _: Linearised, views: slice) -> Array:
    """Make columns (k, N, 2, 20): weighted displacements of the image, cubic over the board."""
    x, y = np.moveaxis(_scale_places(fit, views), -1, 0)
    terms = np.stack([x**i * y**j for i in range(4) for j in range(4 - i)], axis=-1)
    columns = fit.get_weight(views)[..., None] * terms[..., None, None, :]
    return np.asarray(columns.reshape(*terms.shape[:2], 2, -1))


def _scale_places(fit: LinearisedFit, views: slice) -> Array:
    """Return the places (k, N, 2) of corners on the board, from -1 to 1 over all that were seen."""
    low, high = fit.extent
    return np.asarray((2 * fit.observations.xy[views, :, :2] - low - high) / (high - low))

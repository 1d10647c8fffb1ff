"""Score tests: how much of the residuals a cause that all views share would explain.

Residuals that are not noise have a cause: another lens, a bent board. To calibrate with each of
them in turn would be slow, and for most there is no such calibration. A score test needs the
residuals and their derivatives at the solution only.

A cause adds columns X to the derivatives, with coefficients that are 0 if it is absent. At the
minimum, where J^T r = 0 for the parameters that were fitted, one Gauss-Newton step on all
parameters together lowers the cost by

    T = b^T N^+ b,     b = X^T r,     N = X^T X - X^T J (J^T J)^-1 J^T X

(Rao 1948). If the residuals are noise, T / sigma^2 is chi-squared with m = rank N
degrees of freedom, whatever the columns are; with sigma^2 taken from what X leaves,
F = (T / m) / ((r^T r - T) / (nu - m)) has Fisher's distribution. The share of
r^T r that the cause explains is counted beyond what noise gives to any m columns.

The test takes the errors of all corners for equally large. Where they are not, as in an image that
is blurred at its edges, columns that few corners depend on explain more than their share. But a
cause that all views share explains the same in different views. With b_k = X_k^T r_k of view k,
T is the sum of all entries of Q = B^T N^+ B, and those off its diagonal are what the views explain
together. If the views' errors are independent of each other, whatever they are, these have the mean
0 and their sum the variance 2 sum Q_jk^2; their sum over its standard deviation is the agreement of
the views.

The lens is a smooth displacement of the image, the same in all views: bilinear hats over
`LENS_CELLS` cells. The board is another shape of it: every corner by itself, or a model with few
unknowns. Both are further columns of the camera's in the arrow-shaped normal equations. A corner
depends on four hats and on its own three coordinates only, so that the columns are sparse. Several
causes stand side by side in one Schur complement; what one explains beyond another, which then
counts as fitted, follows from the rows and columns of the two.

What views have of their own (a board that bends anew, a camera that moves while its rows are read)
is eliminated with their poses.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, IntArray, Size
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.board_shape.parametrisation import index_board_points, make_basis
from calibgui.engine.calibration.observations import Observations, slice_views
from calibgui.engine.calibration.refinement.residuals import (
    Linearised,
    State,
    compute_image_residuals,
)
from calibgui.engine.camera.camera import Camera

LENS_CELLS = 8
"""Number of cells, along the image's longer side, of the displacement that a lens may cause. With
more of them the test would need more corners."""
LENS, CURVED = "lens", "curved"
"""Names among the causes of the lens, and of a board that is bowed or twisted; those of other
boards are `BoardShapeModel`'s."""
MAX_FREE_CORNERS = 600
"""Number of corners of a board up to which each moves by itself. The matrix of the products of n
free corners takes 72 n^2 bytes, several times over; a board with more of them, as screens have, is
tested for a shape that is smooth over as many nodes."""
MIN_AGREEMENT = 2.5
"""Agreement of the views below which no cause that all share is named. Noise that grew tenfold
towards the edges of the image had 0.3 with a standard deviation of 1, over 360 tests of sets of 6,
10 and 20 views, and 1 % beyond 2.5; lenses and boards that were off had 2.7 to 17."""
_MIN_PART_OF_AGREEMENT = 0.6
"""The same, as part of the agreement of views that all say the same: that of few is small."""
_MAX_KEPT_VIEWS = 512
"""Number of views whose derivatives are kept, 0.8 kB for each of their corners."""
_MIN_PIVOT = 1e-9
"""Part of a column's square that the others leave, below which it is one of their combinations."""


@dataclass(frozen=True, eq=False)
class LinearisedFit:
    """A calibration as the tests need it: residuals, and their derivatives at its solution.

    Every cause asks for them again; those of a few hundred views are kept.
    """

    camera: Camera
    state: State
    observations: Observations
    free: IntArray
    """(P,) indices of the camera's estimated parameters."""
    _kept: dict[tuple[int, int], Linearised] = field(init=False, repr=False, default_factory=dict)
    """Results of `linearise_unweighted`, by the ends of the slice."""
    _weighted: dict[tuple[int, int], Linearised] = field(
        init=False, repr=False, default_factory=dict
    )
    """Results of `linearise`, likewise."""

    def weigh(self, whitening: Array) -> LinearisedFit:
        """Return the fit with other matrices (K, N, 2, 2) that whiten the residuals."""
        weighed = replace(self, observations=replace(self.observations, whitening=whitening))
        weighed._kept.update(self._kept)
        return weighed

    def linearise_unweighted(self, views: slice) -> Linearised:
        """Compute residuals of the views in the image, px, with derivatives; padding counts too."""
        key = views.start, views.stop
        if key in self._kept:
            return self._kept[key]
        state, part = self.state.select_views(views), self.observations.select_views(views)
        found = compute_image_residuals(state, part, self.camera.model)
        if views.stop <= _MAX_KEPT_VIEWS:
            self._kept[key] = found
        return found

    def linearise(self, views: slice) -> Linearised:
        """Compute whitened residuals of the views in the image, with derivatives."""
        key = views.start, views.stop
        if key in self._weighted:
            return self._weighted[key]
        raw, weight = self.linearise_unweighted(views), self.get_weight(views)
        found = Linearised(
            (weight @ raw.residual[..., None])[..., 0], weight @ raw.by_params, weight @ raw.by_pose
        )
        if views.stop <= _MAX_KEPT_VIEWS:
            self._weighted[key] = found
        return found

    def get_weight(self, views: slice) -> Array:
        """Return the matrices (k, N, 2, 2) that whiten the views' residuals; zero for padding."""
        part = self.observations.select_views(views)
        if part.whitening is not None:
            return part.whitening
        return part.mask[..., None, None] * np.eye(2)

    def predict_corners(self, views: slice) -> Array:
        """Return the corners (k, N, 2) that the calibration predicts, px.

        Columns that depend on the place in the image must take it from here: the measured place
        holds the noise that the columns are tested against.
        """
        return self.observations.uv[views] + self.linearise_unweighted(views).residual

    @cached_property
    def extent(self) -> tuple[Array, Array]:
        """Least and largest X and Y, (2,) each, mm, of the board's corners that were seen."""
        xy = self.observations.xy[self.observations.mask > 0, :2]
        return xy.min(axis=0), xy.max(axis=0)

    @property
    def degrees_of_freedom(self) -> int:
        """Number nu of residual coordinates beyond that of the fitted unknowns."""
        return 2 * self.observations.count - len(self.free) - 6 * len(self.state.R)


class Explanation(NamedTuple):
    """The part of the residuals that a cause explains."""

    probability: float
    """Probability that noise explains as much; 1 where there are too few corners to tell."""
    share: float
    """Share of r^T r, beyond what noise gives to any columns."""


def judge_explanation(T: float, rank: int, cost: float, freedom: int) -> Explanation:
    """Judge the T of `rank` columns against r^T r = `cost` with `freedom` degrees of freedom."""
    rest = freedom - rank
    if rest < 1 or rank < 1 or not cost > 0:
        return Explanation(1.0, 0.0)
    variance = max(cost - T, 0.0) / rest
    ratio = T / rank / max(variance, 1e-300)
    probability = float(scipy.special.fdtrc(rank, rest, ratio))
    return Explanation(probability, max(T - rank * variance, 0.0) / cost)


class SharedCauses:
    """Causes that all views share, side by side.

    Args:
        fit: the calibration.
        causes: `LENS`, `CURVED`, or models of the board's shape.
        own: (K, 2N, m) orthonormal columns of each view's own, zero where there are fewer, which
            the poses' are among; those of the poses alone by default.
        cells: number of cells, along the image's longer side, of the lens's displacement.
    """

    def __init__(
        self,
        fit: LinearisedFit,
        causes: Sequence[str],
        own: Array | None = None,
        cells: int = LENS_CELLS,
    ) -> None:
        index = index_board_points(fit.observations)
        whole = left = np.zeros(())
        parts_by_view = []
        for views in slice_views(len(fit.state.R)):
            residual, by_camera, by_pose, predicted = _linearise(fit, views)
            columns = [
                _make_lens_columns(fit, views, predicted, cells)
                if cause == LENS
                else _make_board_columns(fit, views, by_pose, cause, *index)
                for cause in causes
            ]
            pose = by_pose.reshape(len(residual), -1, 6)
            none = scipy.sparse.csr_array((residual.size, 0))  # there may be no causes
            products = _multiply(
                scipy.sparse.hstack([none, *columns], format="csr"),
                np.concatenate([by_camera, residual[..., None]], axis=-1).reshape(
                    *pose.shape[:2], -1
                ),
                np.linalg.qr(pose)[0] if own is None else own[views],
            )
            whole, left = whole + products[0], left + products[1]
            parts_by_view.append(products[2])
            widths = [*(column.shape[1] for column in columns), len(fit.free)]
        by_view = np.concatenate(parts_by_view, axis=1)
        # Columns that no corner depends on would be divided by 0.
        square = np.diag(whole)[:-1]
        unit = 1 / np.sqrt(np.where(square > 0, square, np.inf))
        self._N, self._b = left[:-1, :-1] * np.outer(unit, unit), left[:-1, -1] * unit
        self._b_of_views = by_view[:-1] * unit[:, None]
        self._names = np.repeat([*causes, ""], widths)
        self.cost = float(whole[-1, -1])
        """The sum of squares r^T r."""
        self.cost_beside_views = float(left[-1, -1])
        """The sum of squares that the views' own columns leave."""
        self._reductions: dict[frozenset[str], tuple[float, int]] = {}
        self.freedom = fit.degrees_of_freedom
        """Number of residual coordinates beyond that of the fitted unknowns."""

    def reduce_cost(self, *causes: str) -> tuple[float, int]:
        """Return T of some causes together, and the rank of their columns."""
        if (key := frozenset(causes)) not in self._reductions:
            y, fitted = self._solve(["", *causes], self._b), self._solve([""], self._b)
            self._reductions[key] = float(y @ y - fitted @ fitted), len(y) - len(fitted)
        return self._reductions[key]

    def measure_agreement(self, cause: str, *after: str) -> float:
        """Measure how far the views agree about a cause, beyond other causes `after`.

        Returns:
            The sum of what pairs of views explain together over its standard deviation under
            independent errors; sqrt(K (K - 1) / 2) if all of K views say the same.
        """
        y, fitted = (
            self._solve(["", *names], self._b_of_views) for names in ((*after, cause), after)
        )
        # Views i and j explain Q_ij together, Q = y^T y - fitted^T fitted. Of all pairs, only the
        # sums are wanted, which follow from y and fitted without the pairs.
        own = np.sum(y**2, axis=0) - np.sum(fitted**2, axis=0)
        all_say = np.sum(y.sum(axis=1) ** 2) - np.sum(fitted.sum(axis=1) ** 2)
        squares = [
            float(np.sum((a @ b.T) ** 2)) for a, b in ((y, y), (fitted, fitted), (y, fitted))
        ]
        square = squares[0] + squares[1] - 2 * squares[2] - float(own @ own)
        if square <= np.finfo(float).eps * sum(squares):  # rounding errors are left
            return 0.0
        return float(all_say - own.sum()) / math.sqrt(2 * square)

    def do_views_agree(self, cause: str, *after: str) -> bool:
        """Return whether the views agree about a cause, so that they may share it."""
        K = self._b_of_views.shape[1]
        least = min(MIN_AGREEMENT, _MIN_PART_OF_AGREEMENT * np.sqrt(K * (K - 1) / 2))
        return self.measure_agreement(cause, *after) >= least

    def explain(self, cause: str, *after: str) -> Explanation:
        """Judge what a cause explains of the residuals, or of what other causes `after` leave."""
        T, rank = self.reduce_cost(*after, cause)
        T_after, rank_after = self.reduce_cost(*after)
        return judge_explanation(
            T - T_after, rank - rank_after, self.cost - T_after, self.freedom - rank_after
        )

    def _solve(self, names: Sequence[str], b: Array) -> Array:
        """Return y (rank, ...) with y^T y = b^T N^+ b for the columns of these names, "" the
        camera's, and products b (m, ...) of all columns with the residuals."""
        chosen = np.flatnonzero(np.isin(self._names, names))
        if not len(chosen):
            return b[:0]
        N, b = self._N[np.ix_(chosen, chosen)], b[chosen]
        # Pivots bring columns that are combinations of others to the end.
        factor, pivots, rank, _ = scipy.linalg.lapack.dpstrf(N.T, tol=_MIN_PIVOT)
        b = b[pivots[:rank] - 1]
        return (
            np.asarray(scipy.linalg.solve_triangular(factor[:rank, :rank], b, trans=1))
            if rank
            else b
        )


def _linearise(fit: LinearisedFit, views: slice) -> tuple[Array, Array, Array, Array]:
    """Linearise the fit in some views.

    Returns:
        Whitened residuals (k, N, 2) and their derivatives by the free parameters of the camera
        (k, N, 2, P) and by the poses (k, N, 2, 6), and the predicted corners (k, N, 2), px.
    """
    linear = fit.linearise(views)
    free = linear.by_params[..., fit.free]
    return linear.residual, free, linear.by_pose, fit.predict_corners(views)


def _multiply(
    sparse: scipy.sparse.csr_array, dense: Array, own: Array
) -> tuple[Array, Array, Array]:
    """Multiply the columns of some views with each other.

    Args:
        sparse: (k rows, M) columns that each corner has few entries in.
        dense: (k, rows, D) columns that follow, the residuals last.
        own: (k, rows, n) orthonormal columns of each view's own.

    Returns:
        Products (M + D, M + D) of the columns, and of what the views' own columns leave of them;
        and each view's part (M + D, k) of the latter's products with the residuals.
    """
    (k, rows, n), M, D = own.shape, sparse.shape[1], dense.shape[2]
    # In a matrix of blocks along the diagonal, one for each view, all are multiplied at once.
    block = np.repeat(np.repeat(np.arange(k), rows), np.diff(sparse.indptr))
    blocks = scipy.sparse.csr_array(
        (sparse.data, sparse.indices + M * block, sparse.indptr), shape=(k * rows, k * M)
    )
    right = np.concatenate([own, dense], axis=2)
    above = (blocks.T @ right.reshape(k * rows, -1)).reshape(k, M, n + D)
    below = dense.swapaxes(1, 2) @ right
    by_view = np.concatenate([above, below], axis=1)
    by_view, with_dense = by_view[..., :n], by_view[..., n:]
    by_own = by_view.swapaxes(0, 1).reshape(M + D, k * n)
    with_residuals = with_dense[..., -1] - (by_view @ by_view[:, -1, :, None])[..., 0]
    whole = np.empty((M + D, M + D))
    whole[:M, :M], whole[:, M:] = (sparse.T @ sparse).toarray(), with_dense.sum(axis=0)
    whole[M:, :M] = whole[:M, M:].T
    return whole, whole - by_own @ by_own.T, with_residuals.T


def _make_board_columns(
    fit: LinearisedFit,
    views: slice,
    by_pose: Array,
    cause: str,
    flat: Array,
    index: IntArray,
) -> scipy.sparse.csr_array:
    """Make the columns (2kN, Q) of the board's deviations from the shape that it has in the fit.

    `flat` (n, 2) are the board's corners, and `index` (K, N) says which of them are observed.
    """
    by_corner = (by_pose[..., 3:] @ fit.state.R[views, None]).reshape(-1, 2, 3)
    corner = index[views].reshape(-1, 1)
    columns = _make_sparse(by_corner, 3 * corner + np.arange(3), 3 * len(flat))
    if cause == BoardShapeModel.FREE:
        return columns if len(flat) <= MAX_FREE_CORNERS else columns @ _join_corners(flat)
    basis = _curve_board(flat) if cause == CURVED else make_basis(BoardShapeModel(cause), flat)
    return columns @ scipy.sparse.csr_array(basis.reshape(3 * len(flat), -1))


def _join_corners(flat: Array) -> scipy.sparse.csr_array:
    """Make a basis (3n, 3M) of smooth deviations: hats at M nodes over the board, for each axis."""
    low, high = flat.min(axis=0), flat.max(axis=0)
    cells = int(np.sqrt(MAX_FREE_CORNERS)) - 1
    nodes, values, M = _evaluate_hats(flat - low, high - low + 1, cells)
    hats = scipy.sparse.csr_array(
        (values.ravel(), nodes.ravel(), 4 * np.arange(len(flat) + 1)), shape=(len(flat), M)
    )
    return scipy.sparse.csr_array(scipy.sparse.kron(hats, np.eye(3)))


def _curve_board(flat: Array) -> Array:
    """Make the basis (n, 3, 3) of a board's quadratic deviations out of its plane."""
    low, high = flat.min(axis=0), flat.max(axis=0)
    x, y = ((2 * flat - low - high) / (high - low)).T
    basis = np.zeros((len(flat), 3, 3))
    basis[:, 2] = np.stack([x * x, x * y, y * y], axis=-1)
    return basis


def _make_lens_columns(
    fit: LinearisedFit, views: slice, predicted: Array, cells: int
) -> scipy.sparse.csr_array:
    """Make the columns (2kN, 2M) of displacements along u and v at the predicted corners."""
    nodes, values, M = _evaluate_hats(predicted.reshape(-1, 2), fit.camera.size, cells)
    weight = fit.get_weight(views).reshape(-1, 2, 2)
    entries = (weight[..., None] * values[:, None, None, :]).reshape(len(nodes), 2, -1)
    return _make_sparse(entries, np.concatenate([nodes, M + nodes], axis=1), 2 * M)


def _make_sparse(entries: Array, places: IntArray, count: int) -> scipy.sparse.csr_array:
    """Make a matrix (2n, count) from the entries (n, 2, m) of row pairs in columns (n, m)."""
    n, _, m = entries.shape
    places = np.repeat(places[:, None], 2, axis=1).ravel()
    matrix = scipy.sparse.csr_array(
        (entries.ravel(), places, np.arange(2 * n + 1) * m), shape=(2 * n, count)
    )
    matrix.eliminate_zeros()
    return matrix


def _evaluate_hats(uv: Array, size: Size | Array, along_longer: int) -> tuple[IntArray, Array, int]:
    """Evaluate bilinear hats at pixels (n, 2), on a mesh of so many cells along the longer side.

    Returns:
        (n, 4) numbers of the nodes around each pixel, (n, 4) values of their hats there, and the
        number of all nodes.
    """
    cells = np.array([max(1, round(along_longer * n / max(size))) for n in size])
    place = np.clip(np.nan_to_num(uv) / (np.array(size) - 1), 0, 1) * cells  # NaN beyond the lens
    first = np.minimum(place.astype(np.int64), cells - 1)
    far = place - first
    x, y = np.moveaxis(first[..., None] + np.arange(2), 1, 0)
    by_x, by_y = np.moveaxis(np.stack([1 - far, far], axis=-1), 1, 0)
    nodes = x[:, :, None] * (cells[1] + 1) + y[:, None, :]
    values = by_x[:, :, None] * by_y[:, None, :]
    return nodes.reshape(-1, 4), values.reshape(-1, 4), int(np.prod(cells + 1))

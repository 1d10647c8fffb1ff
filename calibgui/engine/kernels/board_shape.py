"""The board shape's part of the normal equations, compiled.

The readable references are ``calibration.board_shape.parametrisation.iterate_corner_products`` and
``calibration.refinement.residuals.compute_view_products``.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.kernels.cameras import PackedCamera, find_rows, pack_camera
from calibgui.engine.kernels.common import VIEWS_PER_BLOCK, make_contiguous
from calibgui.engine.kernels.normal_equations import NO_CORNERS, BoardCorners, sum_products
from calibgui.engine.kernels.views import CameraAndPoses, MeasuredViews, Views, pack_views

_CORNERS_TOGETHER = 5_000
"""Number of the board's corners, in all views, whose products with the poses are held at once;
0.7 MB, which stay in the processor's cache until they are used."""


class BoardMotion(Protocol):
    """The fields of ``calibration.refinement.residuals.BoardMotion``."""

    @property
    def motion(self) -> Array: ...
    @property
    def corner(self) -> IntArray: ...


def _arrange_by_corner(views: Views, index: IntArray, count: int) -> Views:
    """Arrange views by the board's corners: (K, ., n), those that a view does not show weigh 0."""
    K, N = index.shape
    if N == count and (index == index[0]).all() and len(np.unique(index[0])) == count:
        order = np.argsort(index[0])
        return Views(*(np.take(array, order[: array.shape[2]], axis=2) for array in views))
    uv, xyz = (np.repeat(array[..., :1], count, axis=2) for array in (views.uv, views.xyz))
    weight, given = np.zeros((K, 4, count)), views.weight
    if not given.size:
        given = np.broadcast_to(np.array([1.0, 0, 0, 1])[:, None], (K, 4, N))
    view, place = np.nonzero((given != 0).any(axis=1))
    for whole, array in ((uv, views.uv), (xyz, views.xyz), (weight, given)):
        whole[view, :, index[view, place]] = array[view, :, place]
    return Views(uv, xyz, weight)


def _sum_corner_products(
    lens: PackedCamera,
    R: Array,
    T: Array,
    views: Views,
    rows: IntArray,
    index: IntArray,
    D: Array,
) -> tuple[Array, Array]:
    """Return products of the columns [camera, pose, r] of some views and of the board's corners.

    Args:
        lens: the camera.
        R: (K, 3, 3) rotations.
        T: (K, 3) translations, mm.
        views: the measured corners.
        rows: (P,) places of the free parameters in ``lens.camera``.
        index: (K, N) number of the board's corner that each observation shows.
        D: (K, 3, 6, n) the products of the three columns of each corner with the pose's, which are
            filled in; none, (0, 3, 6, n), if they are not wanted.

    Returns:
        (K, P + 7, P + 7) of the first columns with each other; (n, 3, P + 4) of the corners'
        columns with the camera's, with r and with themselves, summed over the views.
    """
    count = D.shape[-1]
    totals = np.zeros((-(-len(R) // VIEWS_PER_BLOCK), 3, len(rows) + 4, count))
    corners = BoardCorners(by_pose=D, totals=totals)
    A = sum_products(lens, R, T, _arrange_by_corner(views, index, count), rows, corners)
    return A, np.moveaxis(totals.sum(axis=0), -1, 0)


def compute_view_products(
    state: CameraAndPoses,
    observations: MeasuredViews,
    model: str,
    free: IntArray,
    following: BoardMotion | None = None,
) -> Array:
    """Compute ``calibration.refinement.residuals.compute_view_products``."""
    lens, rows = pack_camera(model, state.params), find_rows(model, free)
    views = pack_views(observations)
    corners = NO_CORNERS
    if following is not None:
        corners = BoardCorners(following.corner, make_contiguous(following.motion))
    return sum_products(lens, state.R, state.T, views, rows, corners)


def iterate_corner_products(
    state: CameraAndPoses,
    observations: MeasuredViews,
    model: str,
    free: IntArray,
    index: IntArray,
    count: int,
    with_poses: bool = True,
) -> Iterator[tuple[slice, Array, Array, Array]]:
    """Compute ``calibration.board_shape.parametrisation.iterate_corner_products``."""
    lens, rows = pack_camera(model, state.params), find_rows(model, free)
    K, together = len(index), max(_CORNERS_TOGETHER // count, 1)
    # One array for all parts: new memory costs more than what is computed in it.
    held = np.empty((min(together, K) if with_poses else 0, 3, 6, count))
    for begin in range(0, K, together):
        part = slice(begin, min(begin + together, K))
        views, D = pack_views(observations.select_views(part)), held[: part.stop - begin]
        A, total = _sum_corner_products(
            lens, state.R[part], state.T[part], views, rows, index[part], D
        )
        yield part, A, np.moveaxis(D, -1, 1), total

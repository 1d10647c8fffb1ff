"""The errors of a held board shape add to the uncertainty of a calibration.

A shape that was estimated before has errors e of the corners' places, of covariance C
(``boards/shape.py``). Camera and poses theta that fit best for the held shape follow it: with the
derivatives J_theta and J_s of the residuals by these and by the places, the normal equations say

    d theta = G e,      G = -(J_theta^T J_theta)^-1 J_theta^T J_s,

and so the covariance of theta, sigma^2 (J_theta^T J_theta)^-1 for a board that is known exactly,
grows by G C G^T. With the poses eliminated (``refinement/schur.py``; D_k the products of view k's
poses with the places, X what is left of those of the camera, A the Schur complement)

    X = J_c^T J_s - sum_k Wk Vk^-1 D_k,      Gc = -A^-1 X,      G_k = -Vk^-1 (Wk^T Gc + D_k).

Is it honest if some views are those that the shape was estimated from? If all are, the camera is
that of the joint estimate again, and so is the sum: the inverse of a matrix in blocks is

    (J^T J)^-1 = [ T^-1 + G C' G^T  G C' ]      T = J_theta^T J_theta,      C' = C / sigma^2.
                 [ C' G^T           C'   ]

The errors of the held fit, T^-1 J_theta^T n for noise n, do not correlate with those of a shape
that has been estimated beside theta, C' (J_s^T + G^T J_theta^T) n. Of a part of the views, what
correlates are sums over that part of products whose sum over all views vanishes. So the ± hold
whether views are shared or not; but shared ones tell nothing new of the board, nor new ones of an
estimate that is held: `free` with all of them together is the better calibration.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.boards.shape import BoardShape
from calibgui.engine.calibration.board_shape.parametrisation import iterate_corner_products
from calibgui.engine.calibration.refinement import covariances
from calibgui.engine.calibration.refinement.covariances import Estimate
from calibgui.engine.calibration.refinement.schur import eliminate_poses


def add_held_shape_error(
    estimate: Estimate, shape: BoardShape, model: str, free: IntArray
) -> Estimate:
    """Widen an estimate's covariances by what the errors of the held board shape do to it.

    Args:
        estimate: the estimate with the image cost, its views on the held shape.
        shape: the shape.
        model: the lens model, a key of ``camera.models.MODELS``.
        free: (P,) indices of the camera's parameters that may move.
    """
    if not shape.sigma.any():
        return estimate
    observations, P, n = estimate.observations, len(free), len(shape.nominal)
    places = shape.deviation + np.column_stack([shape.nominal, np.zeros(n)])
    index = np.asarray(scipy.spatial.cKDTree(places).query(observations.xy)[1], dtype=np.int64)
    reduced = eliminate_poses(estimate.solution.normal)
    information = covariances.invert_information(reduced)[0]
    F, rest = (errors.reshape(3 * n, -1) for errors in shape.factor_errors())
    own = rest[:, 0]

    def multiply(by_place: Array) -> Array:
        """Multiply products (..., 3n) by the columns [F, diag(rest)] whose squares sum up to C."""
        return np.concatenate([by_place @ F, by_place * own], axis=-1)

    by_shape = np.empty((len(index), 6, F.shape[1] + 3 * n))
    pull = np.zeros((P, F.shape[1] + 3 * n))
    for views, _, D, total in iterate_corner_products(
        estimate.state, observations, model, free, index, n
    ):
        by_place = np.swapaxes(D.reshape(len(D), 3 * n, 6), 1, 2)
        by_shape[views] = multiply(by_place)
        pull += multiply(total[..., :P].reshape(3 * n, P).T)
    inverse = np.swapaxes(reduced.roots, 1, 2) @ reduced.roots  # Vk^-1
    alone = inverse @ by_shape
    pull -= np.einsum("kpi,kir->pr", reduced.W, alone)
    camera = -information @ pull
    poses = -alone - inverse @ (np.swapaxes(reduced.W, 1, 2) @ camera)
    return estimate._replace(
        camera_covariance=estimate.camera_covariance + camera @ camera.T,
        pose_covariances=estimate.pose_covariances + poses @ np.swapaxes(poses, 1, 2),
    )


def describe_held_shape(shape: BoardShape, views: Sequence[str]) -> tuple[str, ...]:
    """Describe what is unknown of a held shape's errors, and which views it was estimated from.

    Args:
        shape: the shape.
        views: digests of the views that are calibrated with it.
    """
    sentences = []
    if shape.covariance is None and shape.sigma.any():
        sentences.append(
            "The given board shape does not say how the errors of its corners are correlated, as "
            "files of earlier versions do not: every ± takes them for independent, and may be "
            "several times too small. Estimate the shape again and save it."
        )
    known = set(shape.views)
    if shared := sum(view in known for view in views):
        sentences.append(
            f"{shared} of {len(views)} photographs are those that the board's shape was estimated "
            "from, and tell nothing new of the board. Every ± allows for it. To estimate the shape "
            "from all photographs together takes one step, and is at least as good."
        )
    return tuple(sentences)

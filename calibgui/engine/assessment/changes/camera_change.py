"""The change of a camera that explains new views of a board, whatever its lens model.

A lens that was turned, refocused, knocked or screwed in again, and a sensor behind it, move the
image by

    uv - uv' = B(uv') c,    B = [ (1, 0), (0, 1), p, |p|^2 p, |p|^4 p ],

its shift, its scale and its radial distortion, where uv' is the pixel of the stored camera and p
the same, from the principal point, in half diagonals of the image. No lens model enters, and a
few pictures determine five numbers. (With B at the measured corner a smaller image would have
smaller residuals, and be preferred for that.)

With c are estimated, since all of them are uncertain,

- the errors of the stored parameters, e ~ N(0, P) with the calibration's covariance P;
- the board: bent along both sides or twisted, stretched or askew, q;
- all poses, of which nothing is known.

c and q are Gaussian beforehand with the wide standard deviations below, which weakly regularise
what the pictures leave open (the scale, if the board is parallel to the sensor). Gauss-Newton: the
poses are resected, all else follows from the residuals' derivatives less what poses explain, until
nothing changes. The noise is that of the residuals; where the calibration found its views to
disagree by more than noise explains (``calibration/overdispersion.py``), so will these.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, BoolArray
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.residuals import (
    Linearised,
    State,
    compute_image_residuals,
)
from calibgui.engine.calibration.resection import estimate_poses, refine_poses
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.camera import Camera

SHIFT, SCALE, RADIAL = slice(0, 2), 2, slice(3, 5)
"""Places of the patterns of B in c."""
MIN_NOISE = 0.01
"""Least standard deviation of a corner's coordinate that is believed, px."""
_SHIFT_AND_SCALE_SIGMA, _RADIAL_SIGMA = 0.02, 0.005
"""Standard deviations of the change before the pictures are seen, in half diagonals of the image
at its corners: of shift and scale, and of each term of the radial distortion."""
_BEND_SIGMA, _STRETCH_SIGMA = 0.005, 0.0005
"""Standard deviations of the board's deviations, in its diagonals: of its bends and twist at the
corners, and of its stretch and shear there."""
_MAX_STEPS, _MAX_STEP_PX = 20, 1e-4
"""Number of steps at most, and change of the displacement of the corners that ends them, px rms."""


def factor_covariance(covariance: Array | None) -> Array:
    """Return a root (P, E) of a covariance, less directions in which nothing is uncertain."""
    if covariance is None or not np.isfinite(covariance).all():
        return np.zeros((0, 0))
    scale = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    unit = np.where(scale > 0, scale, 1.0)
    values, axes = np.linalg.eigh(covariance / np.outer(unit, unit))
    some = values > 1e-12 * max(values.max(initial=0.0), 1e-300)
    return unit[:, None] * axes[:, some] * np.sqrt(values[some])


class CameraChange(NamedTuple):
    """The change that explains some views best."""

    c: Array
    """(M,) the change."""
    covariance: Array
    """(M, M) its covariance C."""
    patterns: Array
    """(K, N, 2, M) B at the corners, px."""
    poses_only: Array
    """(K, N, 2) residuals with only the poses free, px."""
    left: Array
    """(K, N, 2) residuals of the whole fit, px."""
    noise: float
    """Standard deviation of one coordinate of the latter, px."""
    bend: float
    """Largest deviation of the board from a plane, mm."""
    bend_sigma: float
    """Its standard deviation, mm."""


def fit_camera_change(
    camera: Camera, packed: Observations, root: Array, overdispersion: float
) -> CameraChange:
    """Fit the change of the camera, its stored error, the board and all poses to the corners.

    Args:
        camera: the stored camera.
        packed: the views.
        root: (P, E) root of the covariance of its parameters; (0, 0) if there is none.
        overdispersion: ratio, at least 1, by which views of this camera and board disagree more
            than the noise of their corners explains.
    """
    Z, prior_q = _make_board_patterns(packed)
    prior_c = np.array([_SHIFT_AND_SCALE_SIGMA] * 3 + [_RADIAL_SIGMA] * 2)
    root = root if root.size else np.zeros((len(camera.params), 0))
    M, Q = len(prior_c), len(prior_q)
    prior = np.concatenate([prior_c, prior_q, np.ones(root.shape[1])])
    x = np.zeros(len(prior))
    rows = packed.mask[..., None] > 0
    state = _refine(estimate_poses(camera, packed), packed, camera.model)
    poses_only = compute_image_residuals(state, packed, camera.model).residual
    predicted = packed.uv + poses_only
    for _ in range(_MAX_STEPS):
        B = _make_patterns(predicted, camera)
        moved = replace(
            packed, uv=packed.uv - B @ x[:M], xy=_bend_board(packed.xy, Z, x[M : M + Q])
        )
        state = _refine(
            state._replace(params=camera.params + root @ x[M + Q :]), moved, camera.model
        )
        found = compute_image_residuals(state, moved, camera.model)
        predicted = moved.uv + found.residual
        left = np.where(rows, found.residual, 0.0)
        freedom = max(2 * packed.count - 6 * len(left) - M - Q, 1)
        noise = max(float(np.sqrt(np.sum(left**2) / freedom)), MIN_NOISE)
        X, r = _eliminate_poses(_stack_columns(B, found, state, Z, root), found, left, rows)
        variance = (noise * overdispersion) ** 2
        H = X.T @ X / variance + np.diag(1 / prior**2)
        step = np.linalg.solve(H, X.T @ r / variance + x / prior**2)
        x = np.asarray(x - step, dtype=np.float64)
        if np.sqrt(np.sum((X @ step) ** 2) / packed.count) < _MAX_STEP_PX:
            break
    covariance = np.asarray(np.linalg.inv(H), dtype=np.float64)
    board = slice(M, M + Q)
    bend = _measure_bend(Z[packed.mask > 0], x[board], covariance[board, board])
    return CameraChange(x[:M], covariance[:M, :M], B, poses_only, left, noise, *bend)


def _refine(start: State, observations: Observations, model: str) -> State:
    """Refine the poses with the camera held."""
    return refine_poses(start, observations, model, Cost.IMAGE)


def _make_patterns(uv: Array, camera: Camera) -> Array:
    """Make B (..., 2, 5), px, at pixels (..., 2) of the stored camera."""
    half = float(np.hypot(*camera.size)) / 2
    p = (uv - camera.centre) / half
    square = np.sum(p**2, axis=-1, keepdims=True)
    ones = np.broadcast_to(np.eye(2), (*uv.shape[:-1], 2, 2))
    radial = np.stack([p, square * p, square**2 * p], axis=-1)
    return half * np.concatenate([ones, radial], axis=-1)


def _make_board_patterns(packed: Observations) -> tuple[Array, Array]:
    """Make the deviations (K, N, 3, 5) of the board, mm, and their standard deviations (5,).

    They are bends along both sides and a twist, a stretch and a shear.
    """
    seen = packed.xy[packed.mask > 0][:, :2]
    low, high = seen.min(axis=0), seen.max(axis=0)
    diagonal = float(np.linalg.norm(high - low))
    x, y = np.moveaxis((packed.xy[..., :2] - (low + high) / 2) / (diagonal / 2), -1, 0)
    none = np.zeros_like(x)
    out_of_plane = [np.stack([none, none, z], axis=-1) for z in (x**2, y**2, x * y)]
    in_plane = [np.stack(d, axis=-1) for d in ((x, -y, none), (y, x, none))]
    sigma = [_BEND_SIGMA] * 3 + [_STRETCH_SIGMA] * 2
    return diagonal * np.stack([*out_of_plane, *in_plane], axis=-1), np.array(sigma)


def _measure_bend(Z: Array, q: Array, covariance: Array) -> tuple[float, float]:
    """Measure the largest deviation of a board from a plane, mm, with its standard deviation.

    Args:
        Z: (n, 3, Q) deviations of all corners.
        q: (Q,) how much of each there is.
        covariance: (Q, Q) the covariance of q.
    """
    heights = Z[:, 2] - Z[:, 2].mean(axis=0)
    worst = heights[np.argmax(np.abs(heights @ q))]
    return float(abs(worst @ q)), float(np.sqrt(worst @ covariance @ worst))


def _bend_board(xy: Array, Z: Array, q: Array) -> Array:
    """Return the corners (K, N, 3) of a board that deviates from its drawing xy (K, N, 2), mm."""
    places = Z @ q
    places[..., :2] += xy[..., :2]
    return places


def _stack_columns(B: Array, found: Linearised, state: State, Z: Array, root: Array) -> Array:
    """Stack the derivatives (K, N, 2, M + Q + E) of the residuals by c, q and the stored error."""
    by_board = found.by_pose[..., 3:] @ (state.R[:, None] @ Z)
    return np.concatenate([B, by_board, found.by_params @ root], axis=-1)


def _eliminate_poses(
    columns: Array, found: Linearised, left: Array, rows: BoolArray
) -> tuple[Array, Array]:
    """Return columns (n, m) and residuals (n,) less what the poses of their views explain."""
    K = len(left)
    Jp = np.where(rows[..., None], found.by_pose, 0.0).reshape(K, -1, 6)
    X = np.where(rows[..., None], columns, 0.0).reshape(K, Jp.shape[1], -1)
    both = np.concatenate([X, left.reshape(K, -1, 1)], axis=-1)
    own = np.linalg.qr(Jp / np.linalg.norm(Jp, axis=1, keepdims=True))[0]
    both = both - own @ (np.swapaxes(own, 1, 2) @ both)
    both = both.reshape(-1, both.shape[-1])
    return both[:, :-1], both[:, -1]

"""Stage II: residuals and derivatives of the joint registration (paper 4.3).

Unknowns: the camera's parameters (``types.Camera``) and, for each view k, the pose
X_cam = R (X, Y, 0)^T + T. A pose is varied by a local rotation w and a translation tau,
R <- exp(w) R, T <- T + tau, which has no singularity anywhere; then
dX_cam = w x (R X) + tau. With n = X_cam[:2] / Z and Q = [1 0 -n1; 0 1 -n2],

    dn = Q dX_cam / Z.

Two costs.

`image`: the residual is predicted minus measured corner in the image. ``projection.project``
maps n to pixels, so r = project(n) - uv and dr follows by the chain rule.

`reference` (eq. 41-43): the residual is on the virtual reference image. The measured corner's
ray n = normalise(uv) meets the plate at (X, Y), where Q [r1 r2] (dX, dY)^T = Z dn - Q dX_cam|pose,
so that with G = Q [r1 r2] (2, 2)

    d(X, Y) = G^-1 (Z dn - Q (w x R X + tau)).

This is what appendices C to F write out through the homography's coefficients: eq. 15's
x' = H(psi(x) - xp) is that intersection. The reference image has s pixels per mm, and the
residual is s (X, Y) minus the nominal grid.

Printed to the letter (`Cost.PAPER`), the reference grid has dx' = dy' in pixels, while eq. 29
makes a square of the plate fy/fx times as high as wide in it. The plate (X, Y) seen by the
camera is then stretched along Y by fx/fy against the nominal one, which the residual undoes:
y' = s Y fy / fx. The printed lens measures its radius in pixels ("lucchese-pixels").
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, IntArray
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.model import Lens
from calibgui.engine.camera.projection import normalise, project
from calibgui.engine.geometry import rotations


class State(NamedTuple):
    """The unknowns."""

    params: Array
    """(P,) the camera's parameters."""
    R: Array
    """(K, 3, 3) rotations cam_from_plate."""
    T: Array
    """(K, 3) translations, mm."""

    def moved(
        self, by_params: Array, by_poses: Array, free: IntArray | slice = slice(None)
    ) -> State:
        """The state after a step of the `free` parameters and of the poses (K, 6) = (w, tau)."""
        params = self.params.copy()
        params[free] += by_params
        return State(
            params,
            rotations.rotation(by_poses[:, :3]) @ self.R,
            self.T + by_poses[:, 3:],
        )

    def part(self, views: slice | IntArray | BoolArray) -> State:
        """The same camera with some of the views."""
        return State(self.params, self.R[views], self.T[views])


class Linearised(NamedTuple):
    """Residuals of some views, with derivatives."""

    residual: Array
    """(K, N, 2)."""
    by_params: Array
    """(K, N, 2, P)."""
    by_pose: Array
    """(K, N, 2, 6) with respect to (w, tau)."""


def image_residual(state: State, views: Observations, lens: Lens) -> Linearised:
    """Predicted minus measured corners in the image, px; NaN where there is no prediction."""
    rotated, Z, n, Q = _seen(state, views.xy)
    predicted = project(n, state.params, lens)
    by_point = (predicted.by_point @ Q) / Z[..., None, None]
    return Linearised(predicted.points - views.uv, predicted.by_params, _by_pose(by_point, rotated))


def reference_residual(
    state: State, views: Observations, lens: Lens, scale: float, literal: bool
) -> Linearised:
    """Registered minus nominal corners on the reference plane (eq. 38), reference px.

    Args:
        state: camera and poses.
        views: what was measured.
        lens: the lens model.
        scale: s, reference px per mm.
        literal: the paper's grid, equal in px along both axes (`Cost.PAPER`).
    """
    measured = normalise(views.uv, state.params, lens)
    ray = np.concatenate([measured.points, np.ones((*measured.points.shape[:-1], 1))], axis=-1)
    M = np.concatenate([state.R[..., :2], state.T[..., None]], axis=-1)
    h = ray @ np.swapaxes(np.linalg.inv(M), 1, 2)
    points = h[..., :2] / h[..., 2:]
    rotated, Z, _, Q = _seen(state, points)
    inverse = np.linalg.inv(Q @ state.R[:, None, :, :2])  # G^-1
    by_params = inverse @ (Z[..., None, None] * measured.by_params)
    by_pose = _by_pose(-inverse @ Q, rotated)

    to_reference = np.array([scale, scale])
    if literal:
        fx, fy = state.params[:2]
        to_reference = scale * np.array([1.0, fy / fx])
    by_params *= to_reference[:, None]
    if literal:
        by_params[..., 1, 0] -= scale * points[..., 1] * fy / fx**2
        by_params[..., 1, 1] += scale * points[..., 1] / fx
    return Linearised(
        points * to_reference - scale * views.xy[..., :2],
        by_params,
        by_pose * to_reference[:, None],
    )


def predicted_corners(state: State, views: Observations, lens: Lens, cost: Cost) -> Array:
    """(K, N, 2) where the calibrated camera images the nominal plate, px."""
    points = views.xy
    if cost is Cost.PAPER:
        points = points * np.array([1.0, state.params[0] / state.params[1]])
    _, _, n, _ = _seen(state, points)
    return project(n, state.params, lens).points


def registration_error(state: State, views: Observations, lens: Lens, cost: Cost) -> Array:
    """(K, N, 2) registered minus nominal corners, mm: `reference_residual`, not scaled.

    A corner off the plate's plane is registered on the parallel plane through it. With the
    ray's direction and origin in the plate's frame, R^T (n, 1) and -R^T T, it is a matter of
    how far along the ray that is.
    """
    n = normalise(views.uv, state.params, lens).points
    along = np.concatenate([n, np.ones((*n.shape[:-1], 1))], axis=-1) @ state.R
    origin = np.swapaxes(state.R, 1, 2) @ -state.T[..., None]
    height = views.xy[..., 2:] if views.xy.shape[-1] == 3 else 0.0
    distance = (height - origin[:, None, 2]) / along[..., 2:]
    points = origin[:, None, :2, 0] + distance * along[..., :2]
    if cost is Cost.PAPER:
        points = points * np.array([1.0, state.params[1] / state.params[0]])
    return np.asarray(points - views.xy[..., :2])


def _seen(state: State, points: Array) -> tuple[Array, Array, Array, Array]:
    """R X (K, N, 3), depth Z (K, N), ray n (K, N, 2), Q (K, N, 2, 3) of points (K, N, 2 or 3)."""
    rotated = points @ np.swapaxes(state.R[..., : points.shape[-1]], 1, 2)
    point = rotated + state.T[:, None]
    Z = np.where(point[..., 2] > 0, point[..., 2], np.nan)  # behind the camera: no image
    n = point[..., :2] / Z[..., None]
    Q = np.zeros((*n.shape, 3))
    Q[..., 0, 0] = Q[..., 1, 1] = 1.0
    Q[..., 2] = -n
    return rotated, Z, n, Q


def _by_pose(by_point: Array, rotated: Array) -> Array:
    """(K, N, 2, 6) derivatives by (w, tau) from those by X_cam (K, N, 2, 3): w x RX = -[RX]x w."""
    by_rotation = np.cross(rotated[..., None, :], by_point)
    return np.concatenate([by_rotation, by_point], axis=-1)

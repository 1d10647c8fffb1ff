"""Stage II: residuals, their derivatives and normal equations (paper 4.3).

The joint registration adjusts one camera and the poses of all views together, so that the
residuals of all corners become least: bundle adjustment (Triggs et al. 2000) with a known board.
This module says what a residual is, how it changes with the unknowns, and adds up the normal
equations that ``levenberg_marquardt.py`` solves by way of ``schur.py``.

Unknowns: the camera's parameters (``camera.Camera``) and, for each view k, the pose
X_cam = R (X, Y, 0)^T + T. A pose is varied by a local rotation w and a translation tau,
R <- exp(w) R, T <- T + tau, which has no singularity anywhere; then
dX_cam = w x (R X) + tau.

There are two kinds of cost.

`image`: the residual is predicted minus measured corner in the image. ``projection.project``
maps the ray X_cam to pixels, so r = project(X_cam) - uv and dr follows by the chain rule.

`reference` (eq. 41-43): the residual is on the virtual reference image. The measured corner's
ray b = unproject(uv) of length 1 meets the board at (X, Y), at a distance s from the camera:
s b = R (X, Y, 0)^T + T. Across the ray, with B (3, 2) a basis there, both sides change alike,

    G d(X, Y) = B^T (s db - dX_cam|pose),      G = B^T [r1 r2] (2, 2),

so that d(X, Y) = G^-1 B^T (s db - (w x R X + tau)).

This is what appendices C to F write out through the homography's coefficients: eq. 15's
x' = H(psi(x) - xp) is that intersection. The reference image has s pixels per mm, and the
residual is s (X, Y) minus the nominal grid.

Printed to the letter (`Cost.PAPER`), the reference grid has dx' = dy' in pixels, while eq. 29
makes a square of the board fy/fx times as high as wide in it. The board (X, Y) seen by the
camera is then stretched along Y by fx/fy against the nominal one, which the residual undoes:
y' = s Y fy / fx. The printed lens measures its radius in pixels ("lucchese-pixels").

The sums over the views are made in chunks, so that memory does not grow with their number. The
image cost of `COMPILED_LENSES` has compiled kernels (``kernels.normal_equations`` and
``kernels.board_shape``); all other costs and models, and machines without numba, use the numpy
code below. Both give the same solution to rounding (``tests/engine/kernels``).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, IntArray
from calibgui.engine.calibration.observations import Observations, slice_views
from calibgui.engine.calibration.refinement.local_support import prepare_local_blocks
from calibgui.engine.calibration.refinement.prior import make_prior
from calibgui.engine.calibration.refinement.schur import NormalEquations, sum_costs
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.model import Lens
from calibgui.engine.camera.models import find_model
from calibgui.engine.camera.models.splined_stereographic import SplinedStereographic
from calibgui.engine.camera.projection import (
    project,
    project_points,
    unproject,
    unproject_points,
)
from calibgui.engine.geometry import rotations
from calibgui.engine.geometry.directions import make_tangent_basis
from calibgui.engine.kernels import COMPILED_LENSES, with_kernel


class State(NamedTuple):
    """The unknowns."""

    params: Array
    """(P,) the camera's parameters."""
    R: Array
    """(K, 3, 3) rotations cam_from_board."""
    T: Array
    """(K, 3) translations, mm."""

    def take_step(
        self, by_params: Array, by_poses: Array, free: IntArray | slice = slice(None)
    ) -> State:
        """Return the state after a step of the `free` parameters and of the poses.

        Args:
            by_params: (P,) change of the free parameters.
            by_poses: (K, 6) local rotations w, rad, and translations tau, mm.
            free: indices of the parameters that change.
        """
        params = self.params.copy()
        params[free] += by_params
        return State(
            params,
            rotations.rotation_from_vector(by_poses[:, :3]) @ self.R,
            self.T + by_poses[:, 3:],
        )

    def select_views(self, views: slice | IntArray | BoolArray) -> State:
        """Return the same camera with some of the views."""
        return State(self.params, self.R[views], self.T[views])


class Linearised(NamedTuple):
    """Residuals of some views, with derivatives."""

    residual: Array
    """(K, N, 2)."""
    by_params: Array
    """(K, N, 2, P)."""
    by_pose: Array
    """(K, N, 2, 6) with respect to (w, tau)."""


class BoardMotion(NamedTuple):
    """The motion of an estimated board's corners with the camera's parameters."""

    motion: Array
    """(n, 3, P) mm per unit of each parameter."""
    corner: IntArray
    """(K, N) number of the board's corner that each observation shows."""


Linearise = Callable[[State, slice], Linearised]
"""Whitened residuals of a slice of the views, zero (with zero derivatives) for padding."""
NormalAt = Callable[[State], NormalEquations]
"""The normal equations of the free parameters; infinite cost where a corner has no prediction."""
Blocks = tuple[Array, Array, Array, Array, Array, Array]
"""U, W, V, the shared gradient, the poses' gradients and the views' costs of `NormalEquations`."""


def compute_image_residuals(state: State, views: Observations, model: str) -> Linearised:
    """Compute predicted minus measured corners in the image, px; NaN without a prediction."""
    found = Linearised(*linearise_image_residuals(state, views, model))
    for view in _find_given_up(found.residual):
        readable = linearise_image_residuals.reference(
            state.select_views(view), views.select_views(view), model
        )
        for whole, part in zip(found, readable, strict=True):
            whole[view] = part
    return found


def _has_compiled_lens(_state: State, _views: Observations, model: str) -> bool:
    """Return whether `linearise_image_residuals` has a kernel for a lens model."""
    return model in COMPILED_LENSES


@with_kernel("normal_equations", "linearise_image_residuals", _has_compiled_lens)
def linearise_image_residuals(
    state: State, views: Observations, model: str
) -> tuple[Array, Array, Array]:
    """Compute the fields of `compute_image_residuals`; the kernel gives up whole views."""
    rotated, point = place_points(state, views.xy)
    predicted = project(point, state.params, find_model(model))
    by_pose = _differentiate_by_pose(predicted.by_ray, rotated)
    return predicted.points - views.uv, predicted.by_params, by_pose


def compute_reference_residuals(
    state: State, views: Observations, lens: Lens, scale: float, on_paper_grid: bool
) -> Linearised:
    """Compute registered minus nominal corners on the reference plane (eq. 38), reference px.

    Args:
        state: camera and poses.
        views: the measured corners.
        lens: the lens model.
        scale: s, reference px per mm.
        on_paper_grid: true for the paper's grid, equal in px along both axes (`Cost.PAPER`).
    """
    measured = unproject(views.uv, state.params, lens)
    M = np.concatenate([state.R[..., :2], state.T[..., None]], axis=-1)
    h = measured.rays @ np.swapaxes(np.linalg.inv(M), 1, 2)  # (X, Y, 1) / s
    distance = 1 / np.where(h[..., 2:] > 0, h[..., 2:], np.nan)  # the ray leads to the board
    points = h[..., :2] * distance
    rotated, _ = place_points(state, points)
    across = np.swapaxes(make_tangent_basis(measured.rays), -1, -2)
    inverse = np.linalg.inv(across @ state.R[:, None, :, :2])  # G^-1
    by_params = inverse @ (distance[..., None] * (across @ measured.by_params))
    by_pose = _differentiate_by_pose(-inverse @ across, rotated)

    to_reference = np.array([scale, scale])
    if on_paper_grid:
        fx, fy = state.params[:2]
        to_reference = scale * np.array([1.0, fy / fx])
    by_params *= to_reference[:, None]
    if on_paper_grid:
        by_params[..., 1, 0] -= scale * points[..., 1] * fy / fx**2
        by_params[..., 1, 1] += scale * points[..., 1] / fx
    return Linearised(
        points * to_reference - scale * views.xy[..., :2],
        by_params,
        by_pose * to_reference[:, None],
    )


def linearise_residuals(
    state: State, observations: Observations, views: slice, model: str, cost: Cost, scale: float
) -> Linearised:
    """Compute residuals of a slice of the views with derivatives, whitened; zero for padding."""
    part = observations.select_views(views)
    if cost is Cost.IMAGE:
        result = compute_image_residuals(state.select_views(views), part, model)
    else:
        result = compute_reference_residuals(
            state.select_views(views), part, find_model(model), scale, cost is Cost.PAPER
        )
    weight = part.whitening
    if weight is None:
        weight = part.mask[..., None, None] * np.eye(2)
    return Linearised(
        (weight @ result.residual[..., None])[..., 0],
        weight @ result.by_params,
        weight @ result.by_pose,
    )


def place_points(state: State, points: Array) -> tuple[Array, Array]:
    """Return R X and X_cam (K, N, 3), mm, of points (K, N, 2 or 3) on the board, mm."""
    rotated = points @ np.swapaxes(state.R[..., : points.shape[-1]], 1, 2)
    return rotated, rotated + state.T[:, None]


def _differentiate_by_pose(by_point: Array, rotated: Array) -> Array:
    """Return (K, N, 2, 6) derivatives by (w, tau) from those by X_cam (K, N, 2, 3).

    They follow from w x RX = -[RX]x w.
    """
    by_rotation = np.cross(rotated[..., None, :], by_point)
    return np.concatenate([by_rotation, by_point], axis=-1)


def build_stage_two(
    observations: Observations, model: str, cost: Cost, scale: float, free: IntArray
) -> NormalAt:
    """Return the problem that Stage II solves: its normal equations at any state.

    Args:
        observations: the views.
        model: the lens, a key of ``camera.models.MODELS``.
        cost: the cost that is minimised.
        scale: reference px per mm, for the costs on the reference plane.
        free: (P,) indices of the camera's parameters that may change.
    """
    blocks_at = prepare_blocks(observations, model, cost, scale, free)
    stiffness = find_model(model).compute_stiffness(observations.count)
    prior = None if stiffness is None else make_prior(stiffness, free)

    def normal_at(state: State) -> NormalEquations:
        normal = _assemble_normal_equations(blocks_at(state))
        return normal if prior is None else prior.add_to(normal, state.params)

    return normal_at


def _is_image_of_compiled_lens(
    _observations: Observations, model: str, cost: Cost, *_: object
) -> bool:
    """Return whether `prepare_blocks` has a kernel for these arguments."""
    return cost is Cost.IMAGE and model in COMPILED_LENSES


@with_kernel("normal_equations", "prepare_blocks", _is_image_of_compiled_lens)
def prepare_blocks(
    observations: Observations, model: str, cost: Cost, scale: float, free: IntArray
) -> Callable[[State], Blocks]:
    """Return a function from a state to the blocks of J^T J and J^T r; see `build_stage_two`."""
    lens = find_model(model)
    if cost is Cost.IMAGE and isinstance(lens, SplinedStereographic):
        return prepare_local_blocks(observations, lens, free)

    def linearise(state: State, views: slice) -> Linearised:
        return linearise_residuals(state, observations, views, model, cost, scale)

    return partial(_accumulate_blocks, linearise, free)


def accumulate_normal_equations(
    linearise: Linearise, state: State, free: IntArray
) -> NormalEquations:
    """Accumulate J^T J and J^T r over the views, chunk by chunk."""
    return _assemble_normal_equations(_accumulate_blocks(linearise, free, state))


def _assemble_normal_equations(blocks: Blocks) -> NormalEquations:
    U, W, V, shared, pose, costs = blocks
    return NormalEquations(U, W, V, shared, pose, *sum_costs(costs))


def _accumulate_blocks(linearise: Linearise, free: IntArray, state: State) -> Blocks:
    """Sum the blocks over the views, as many at a time as `slice_views` gives."""
    K, P = len(state.R), len(free)
    U, W, V = np.zeros((P, P)), np.empty((K, P, 6)), np.empty((K, 6, 6))
    shared, pose, costs = np.zeros(P), np.empty((K, 6)), np.empty(K)
    for views in slice_views(K):
        with np.errstate(all="ignore"):  # a wild trial overflows; its cost says so
            r, by_params, by_pose = linearise(state, views)
            k = len(r)
            r = r.reshape(k, -1, 1)
            Jc = by_params.reshape(k, -1, by_params.shape[-1])[..., free]
            Jp = by_pose.reshape(k, -1, 6)
            costs[views] = np.sum(r * r, axis=(1, 2))
            JcT, JpT = np.swapaxes(Jc, 1, 2), np.swapaxes(Jp, 1, 2)
            U += (JcT @ Jc).sum(axis=0)
            W[views], V[views] = JcT @ Jp, JpT @ Jp
            shared += (JcT @ r)[..., 0].sum(axis=0)
            pose[views] = (JpT @ r)[..., 0]
    return U, W, V, shared, pose, costs


def has_compiled_lens(
    _state: State, _observations: Observations, model: str, *_: object, **__: object
) -> bool:
    """Return whether the lens model has kernels of the image cost."""
    return model in COMPILED_LENSES


@with_kernel("board_shape", "compute_view_products", has_compiled_lens)
def compute_view_products(
    state: State,
    observations: Observations,
    model: str,
    free: IntArray,
    following: BoardMotion | None = None,
) -> Array:
    """Compute (K, P + 7, P + 7) products of each view's columns [camera, pose, r], image cost.

    Args:
        state: camera and poses.
        observations: the views, on the board as it is.
        model: the lens, a key of ``camera.models.MODELS``.
        free: (P,) indices of the camera's parameters that may change.
        following: the motion of an estimated board with the camera, which counts as the camera's
            part; None for a board that stays.
    """
    parts = []
    for views in slice_views(len(state.R)):
        r, by_params, by_pose = linearise_residuals(
            state, observations, views, model, Cost.IMAGE, 1.0
        )
        by_camera = by_params[..., free]
        if following is not None:
            by_corner = by_pose[..., 3:] @ state.R[views, None]
            by_camera = by_camera + by_corner @ following.motion[following.corner[views]]
        J = np.concatenate([by_camera, by_pose, r[..., None]], axis=-1)
        J = J.reshape(len(J), -1, J.shape[-1])
        parts.append(np.swapaxes(J, 1, 2) @ J)
    return np.concatenate(parts)


def compute_residuals(
    state: State, observations: Observations, model: str, cost: Cost
) -> tuple[Array, Array]:
    """Compute residuals in the image and on the board, not whitened; NaN without a prediction.

    Args:
        state: camera and poses.
        observations: the views.
        model: the lens, a key of ``camera.models.MODELS``.
        cost: the cost, which decides what the board is (see above).

    Returns:
        (K, N, 2) measured minus predicted corners, px, and registered minus nominal ones, mm.
    """
    seen, registered = _compute_residuals(state, observations, model, cost)
    for view in _find_given_up(seen, registered):
        seen[view], registered[view] = _compute_residuals.reference(
            state.select_views(view), observations.select_views(view), model, cost
        )
    return seen, registered


def compute_misses(state: State, observations: Observations, model: str, cost: Cost) -> Array:
    """Compute the first of `compute_residuals`, those in the image (K, N, 2), alone."""
    missed = _compute_misses(state, observations, model, cost)
    for view in _find_given_up(missed):
        missed[view] = _compute_misses.reference(
            state.select_views(view), observations.select_views(view), model, cost
        )
    return missed


def _find_given_up(*found: Array) -> list[slice]:
    """Find the views that a kernel gives up for one corner that its Newton's method does not
    reach."""
    if all(np.isfinite(np.vdot(part, part)) for part in found):
        return []
    given_up = ~np.isfinite(sum(found)).all(axis=(1, 2))
    return [slice(k, k + 1) for k in np.flatnonzero(given_up).tolist()]


def _is_image_residual_of_compiled_lens(
    _state: State, _observations: Observations, model: str, cost: Cost
) -> bool:
    """Return whether `_compute_residuals` and `_compute_misses` have a kernel for these."""
    return cost is Cost.IMAGE and model in COMPILED_LENSES


@with_kernel("normal_equations", "compute_residuals", _is_image_residual_of_compiled_lens)
def _compute_residuals(
    state: State, observations: Observations, model: str, cost: Cost
) -> tuple[Array, Array]:
    """Compute `compute_residuals`."""
    seen, registered = np.empty_like(observations.uv), np.empty_like(observations.uv)
    for views in slice_views(len(state.R)):
        part, own = observations.select_views(views), state.select_views(views)
        seen[views] = _compute_misses.reference(own, part, model, cost)
        there = compute_registration_errors(own, part, find_model(model), cost)
        registered[views] = np.where(np.isfinite(seen[views]), there, np.nan)
    return seen, registered


@with_kernel("normal_equations", "compute_misses", _is_image_residual_of_compiled_lens)
def _compute_misses(state: State, observations: Observations, model: str, cost: Cost) -> Array:
    """Compute `compute_misses`."""
    missed = np.empty_like(observations.uv)
    for views in slice_views(len(state.R)):
        part, own = observations.select_views(views), state.select_views(views)
        missed[views] = part.uv - predict_corners(own, part, find_model(model), cost)
    return missed


def predict_corners(state: State, views: Observations, lens: Lens, cost: Cost) -> Array:
    """Compute (K, N, 2) px where the camera images the nominal board."""
    points = views.xy
    if cost is Cost.PAPER:
        points = points * np.array([1.0, state.params[0] / state.params[1]])
    return project_points(place_points(state, points)[1], state.params, lens)


def compute_registration_errors(state: State, views: Observations, lens: Lens, cost: Cost) -> Array:
    """Compute (K, N, 2) registered minus nominal corners, mm.

    They are the residuals of `compute_reference_residuals`, not scaled. A corner off the board's
    plane is registered on the parallel plane through it: the ray, with its direction and origin
    R^T b and -R^T T in the board's frame, is followed to the corner's height.
    """
    along = unproject_points(views.uv, state.params, lens)[0] @ state.R
    origin = np.swapaxes(state.R, 1, 2) @ -state.T[..., None]
    height = views.xy[..., 2:] if views.xy.shape[-1] == 3 else 0.0
    distance = (height - origin[:, None, 2]) / along[..., 2:]
    distance = np.where(distance > 0, distance, np.nan)  # the ray leads to the board
    points = origin[:, None, :2, 0] + distance * along[..., :2]
    if cost is Cost.PAPER:
        points = points * np.array([1.0, state.params[1] / state.params[0]])
    return np.asarray(points - views.xy[..., :2])

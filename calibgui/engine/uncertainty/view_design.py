"""Design of a set of views: how well the camera would be known from it, without solving again.

Information adds up over views (``fisher_information.py``), so that a set of views, taken or only
imagined, gives

    cov(c) = sigma^2 (sum_k S_k + sigma^2 C_0^-1)^-1 + D,

where C_0 is a prior for any camera, far weaker than two good views, which keeps sets finite that
determine nothing. D is the systematic part of the reported covariance, beyond the corners' noise:
with a nominal board that is seen to deviate, and with one whose shape is held, the uncertainty of
its shape, which more views do not remove; otherwise an estimated shape's share and the views'
disagreement, taken to fall as the number of views rises.

A set is judged by the variance of projection of distant points (``projection_uncertainty.py``),
averaged over the image: a V-optimal design (Fedorov, Theory of Optimal Experiments, 1972).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.problem import find_free_parameters
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import find_model
from calibgui.engine.images.sampling import make_mesh
from calibgui.engine.uncertainty.fisher_information import FisherInformation, compute_information
from calibgui.engine.uncertainty.projection_uncertainty import (
    compute_sensitivity,
    compute_worst_sigma,
    propagate_covariance,
)

_MESH = (8, 6)
"""Numbers of columns and rows of pixels at which projection is judged."""
_ROUNDING = 1e-3
"""Excess over a reported variance, relative to it, below which prior and rounding explain it."""


@dataclass(frozen=True, eq=False, slots=True)
class ViewDesign:
    """A camera with the K views to choose from, and the pixels at which a choice is judged."""

    camera: Camera
    free: IntArray
    """(P,) indices of the camera's estimated parameters."""
    noise: float
    """Standard deviation of one residual coordinate."""
    views: FisherInformation
    """Information of the views to choose from."""
    systematic: Array
    """(P, P) D, the covariance beyond the corners' noise, for all views together."""
    is_systematic_averaged: bool
    """True if D falls as the number of views rises."""
    by_params: Array
    """(g, 2, P) derivative q_c at the g pixels that judge."""
    by_motion: Array
    """(g, 2, 6) derivative q_p B at these pixels."""

    def compute_covariance(self, chosen: Array) -> Array:
        """Return the covariance (..., P, P) of the free parameters.

        View k of K counts chosen[..., k] times.
        """
        prior = self.noise**2 / _make_prior_sigma(self.camera)[self.free] ** 2
        S = np.tensordot(chosen, self.views.camera, axes=1) + np.diag(prior)
        unit = 1 / np.sqrt(np.diagonal(S, axis1=-2, axis2=-1))
        unit = unit[..., :, None] * unit[..., None, :]
        systematic = self.systematic
        if self.is_systematic_averaged:
            systematic = (
                systematic * (len(self.views.camera) / chosen.sum(axis=-1))[..., None, None]
            )
        return np.asarray(self.noise**2 * np.linalg.inv(S * unit) * unit + systematic)

    def compute_projection_covariance(self, chosen: Array) -> Array:
        """Return the covariance (..., g, 2, 2) of the pixels of distant points, px^2."""
        count = chosen.sum(axis=-1)[..., None, None]
        A = np.tensordot(chosen, self.views.motion_by_camera, axes=1) / count
        e = self.noise**2 * np.tensordot(chosen, self.views.pose_covariance, axes=1) / count**2
        C = self.compute_covariance(chosen)
        return propagate_covariance(
            self.by_params, self.by_motion, C[..., None, :, :], A[..., None, :, :],
            e[..., None, :, :],
        )  # fmt: skip

    def compute_loss(self, chosen: Array) -> Array:
        """Return the mean variance (...) of projection over the image, px^2: what is minimised."""
        return np.asarray(self._compute_variances(chosen).mean(axis=-1))

    def compute_worst(self, chosen: Array) -> Array:
        """Return the largest variance (...) of projection in the image, px^2: what a G-optimal
        design minimises, for whom no pixel may be badly known.

        It is that in the worst direction, as ``ProjectionUncertainty.worst`` is.
        """
        sigma = compute_worst_sigma(self.compute_projection_covariance(chosen))
        return np.asarray(sigma.max(axis=-1) ** 2)

    def _compute_variances(self, chosen: Array) -> Array:
        """Return the mean variance (..., g) of a pixel's projection in both directions, px^2."""
        covariance = self.compute_projection_covariance(chosen)
        return np.asarray(np.trace(covariance, axis1=-2, axis2=-1) / 2)

    def compute_sigmas(self, chosen: Array) -> Array:
        """Return one sigma (..., 3) of centre, focal length and projection, px.

        Centre and focal length are root mean squares of x and y, projection over the image. A
        parameter that is held counts as known.
        """
        variance = np.zeros((*chosen.shape[:-1], len(self.camera.params)))
        variance[..., self.free] = np.diagonal(self.compute_covariance(chosen), axis1=-2, axis2=-1)
        focal, centre = variance[..., :2].mean(axis=-1), variance[..., 2:4].mean(axis=-1)
        return np.sqrt(np.stack([centre, focal, self.compute_loss(chosen)], axis=-1))


def build_design(calibration: Calibration, views: Sequence[Observation]) -> ViewDesign:
    """Build the design whose choice is the views of a calibration.

    Args:
        calibration: the calibration.
        views: the views that it was made from.
    """
    camera, free = calibration.camera, find_free_parameters(calibration)
    found = compute_information(calibration, views)
    w, h = camera.size
    u, v = (np.linspace(0.0, n - 1.0, count) for n, count in zip((w, h), _MESH, strict=True))
    uv = make_mesh(u, v).reshape(-1, 2)
    by_params, by_motion = compute_sensitivity(camera, uv, np.inf)
    good = np.isfinite(by_params).all(axis=(1, 2))
    is_shape_given = bool(calibration.settings.is_board_shape_held)
    has_common_error = calibration.board_shape_error > 0 or calibration.lens_error > 0
    noise_only = ViewDesign(
        camera=camera,
        free=free,
        noise=calibration.noise,
        views=found,
        systematic=np.zeros((len(free), len(free))),
        is_systematic_averaged=not (is_shape_given or has_common_error),
        by_params=by_params[good][..., free],
        by_motion=by_motion[good],
    )
    reported = calibration.covariance[np.ix_(free, free)]
    excess = reported - noise_only.compute_covariance(np.ones(len(found.camera)))
    return replace(noise_only, systematic=_take_positive_part(excess, reported))


def _take_positive_part(excess: Array, reported: Array) -> Array:
    """Return the positive semidefinite part of `excess` (P, P), beyond rounding of `reported`."""
    unit = np.sqrt(np.maximum(np.diag(reported), 1e-300))
    values, vectors = np.linalg.eigh(excess / np.outer(unit, unit))
    values = np.where(values > _ROUNDING, values, 0.0)
    return np.asarray((vectors * values) @ vectors.T * np.outer(unit, unit))


def _make_prior_sigma(camera: Camera) -> Array:
    """Return prior standard deviations (P,) of the parameters of any camera.

    They are half the focal length, a quarter of the image for the centre, and for a coefficient
    the value that moves the image's corner by its whole distance from the centre.
    """
    lens, half = find_model(camera.model), np.array(camera.size) / 2
    corner = np.linalg.norm(half / camera.focal)
    return np.concatenate([0.5 * camera.focal, 0.5 * half, corner ** -np.array(lens.powers, float)])

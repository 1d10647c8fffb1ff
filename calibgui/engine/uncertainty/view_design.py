"""How well the camera would be known from any set of views, taken or only imagined.

Information adds up over views (``information.py``), so that a set of them gives, without
solving anything,

    cov(c) = sigma^2 (sum_k S_k + sigma^2 C_0^-1)^-1 + D,

where C_0 is what is known of any camera beforehand, far weaker than two good views, and keeps
sets finite that determine nothing. D is the part of the reported covariance that is not the
corners' noise: with a nominal plate its doubt, which more views do not remove; otherwise an
estimated plate's share and the views' disagreement, taken to fall as the number of views rises.

A set is judged by the variance of projection of distant points (``projection_uncertainty.py``),
averaged over the image: what the user of the camera will suffer from.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.problem import free_parameters
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import MODELS
from calibgui.engine.images.sampling import mesh
from calibgui.engine.uncertainty.fisher_information import Information, information
from calibgui.engine.uncertainty.projection_uncertainty import propagated, sensitivity

_MESH = (8, 6)
"""Pixels at which projection is judged, columns and rows."""
_ROUNDING = 1e-3
"""Excess relative to a variance below which the prior and rounding explain it."""


@dataclass(frozen=True, eq=False, slots=True)
class Design:
    """A camera with the views that may be chosen, and what judges a choice."""

    camera: Camera
    free: IntArray
    """(P,) indices of its estimated parameters."""
    noise: float
    """Standard deviation of one residual coordinate."""
    views: Information
    """Of the views to choose from."""
    doubt: Array
    """(P, P) D for all views together."""
    doubt_falls: bool
    """Whether D falls as the number of views rises."""
    by_params: Array
    """(g, 2, P) q_c at the pixels that judge."""
    by_motion: Array
    """(g, 2, 6) q_p B there."""

    def covariance(self, chosen: Array) -> Array:
        """(..., P, P) of the free parameters from views counted (..., K) times each."""
        prior = self.noise**2 / _beforehand(self.camera)[self.free] ** 2
        S = np.tensordot(chosen, self.views.camera, axes=1) + np.diag(prior)
        unit = 1 / np.sqrt(np.diagonal(S, axis1=-2, axis2=-1))
        unit = unit[..., :, None] * unit[..., None, :]
        doubt = self.doubt
        if self.doubt_falls:
            doubt = doubt * (len(self.views.camera) / chosen.sum(axis=-1))[..., None, None]
        return np.asarray(self.noise**2 * np.linalg.inv(S * unit) * unit + doubt)

    def projection(self, chosen: Array) -> Array:
        """(..., g, 2, 2) covariance of the pixels of distant points from such views, px^2."""
        count = chosen.sum(axis=-1)[..., None, None]
        A = np.tensordot(chosen, self.views.answer, axes=1) / count
        e = self.noise**2 * np.tensordot(chosen, self.views.own, axes=1) / count**2
        C = self.covariance(chosen)
        return propagated(
            self.by_params, self.by_motion, C[..., None, :, :], A[..., None, :, :],
            e[..., None, :, :],
        )  # fmt: skip

    def loss(self, chosen: Array) -> Array:
        """(...) the mean variance of projection over the image, px^2, that a choice is to lower."""
        variance = np.trace(self.projection(chosen), axis1=-2, axis2=-1) / 2
        return np.asarray(variance.mean(axis=-1))

    def numbers(self, chosen: Array) -> Array:
        """(..., 3) one sigma of centre, focal length (rms of x and y) and projection (rms), px.

        A parameter that is held counts as known.
        """
        variance = np.zeros((*chosen.shape[:-1], len(self.camera.params)))
        variance[..., self.free] = np.diagonal(self.covariance(chosen), axis1=-2, axis2=-1)
        focal, centre = variance[..., :2].mean(axis=-1), variance[..., 2:4].mean(axis=-1)
        return np.sqrt(np.stack([centre, focal, self.loss(chosen)], axis=-1))


def design(calibration: Calibration, views: Sequence[Observation]) -> Design:
    """The views of a calibration to choose from.

    Args:
        calibration: of the camera.
        views: that it was made from.
    """
    camera, free = calibration.camera, free_parameters(calibration)
    found = information(calibration, views)
    w, h = camera.size
    u, v = (np.linspace(0.0, n - 1.0, count) for n, count in zip((w, h), _MESH, strict=True))
    uv = mesh(u, v).reshape(-1, 2)
    by_params, by_motion = sensitivity(camera, uv, np.inf)
    good = np.isfinite(by_params).all(axis=(1, 2))
    noise_only = Design(
        camera=camera,
        free=free,
        noise=calibration.noise,
        views=found,
        doubt=np.zeros((len(free), len(free))),
        doubt_falls=calibration.board_shape_error == 0,
        by_params=by_params[good][..., free],
        by_motion=by_motion[good],
    )
    reported = calibration.covariance[np.ix_(free, free)]
    excess = reported - noise_only.covariance(np.ones(len(found.camera)))
    return replace(noise_only, doubt=_positive(excess, reported))


def _positive(excess: Array, reported: Array) -> Array:
    """The part of a difference (P, P) from a covariance that is a covariance itself."""
    unit = np.sqrt(np.maximum(np.diag(reported), 1e-300))
    values, vectors = np.linalg.eigh(excess / np.outer(unit, unit))
    values = np.where(values > _ROUNDING, values, 0.0)
    return np.asarray((vectors * values) @ vectors.T * np.outer(unit, unit))


def _beforehand(camera: Camera) -> Array:
    """(P,) standard deviations of the parameters of any camera, before it is calibrated.

    Half the focal length, a quarter of the image for the centre, and for a coefficient the value
    that moves the image's corner by its whole distance from the centre.
    """
    lens, half = MODELS[camera.model], np.array(camera.size) / 2
    corner = np.linalg.norm(half / camera.focal)
    return np.concatenate([0.5 * camera.focal, 0.5 * half, corner ** -np.array(lens.powers, float)])

"""A lens model tried on views: how it fits them, what it predicts, and where its map holds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.residuals.residual_statistics import summarise_residuals
from calibgui.engine.calibration.leave_one_out import LeftOut
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.problem import find_free_parameters
from calibgui.engine.calibration.refinement.covariances import compute_correlations
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.models import find_model
from calibgui.engine.camera.validity import find_valid_pixels, measure_angles
from calibgui.engine.images.sampling import make_mesh

_MIN_STRONG_CORRELATION = 0.98
"""Correlation from which on two coefficients are exchangeable."""
_GRID_SAMPLES = 41
"""Number of pixels along either side of the image at which a map is examined."""


@dataclass(frozen=True, eq=False, slots=True)
class LensTrial:
    """A lens model tried on the views."""

    calibration: Calibration
    """Calibration from all views."""
    fixed: dict[str, float]
    """Coefficients that were held at 0: those that the views leave open, and those without which
    unseen views are predicted better."""
    bic: float
    """Bayesian information criterion, less for a better model: n ln(r^T r / n) + P ln n."""
    largest_angle: float
    """Largest angle off the axis at which a corner was seen, rad; NaN if one has no ray."""
    field_of_view: Array
    """(3,) horizontal, vertical and diagonal angle that the image spans, rad; NaN if undefined."""
    is_valid_at_corners: bool
    """True if the map is one-to-one within the circle, about the centre, through all corners."""
    valid_share: float
    """Share of the image where the map is one-to-one."""
    exchangeable: tuple[tuple[str, str], ...]
    """Pairs of coefficients of which the views determine only a combination."""
    validation: LeftOut | None = None
    """Its error on unseen views; None if it is ruled out without, by its residuals or because it is
    not sound where others are."""
    fuller: LensTrial | None = None
    """The trial of the same model with more coefficients, which predicts unseen views worse; None
    if there is none."""

    @property
    def model(self) -> str:
        """Id of the lens model."""
        return self.calibration.camera.model

    @property
    def rms(self) -> float:
        """RMS length of the residuals of all views, px."""
        return summarise_residuals(self.calibration.residuals).rms

    @property
    def parameters(self) -> int:
        """Number of estimated parameters of the camera."""
        return len(find_free_parameters(self.calibration))

    @property
    def is_sound(self) -> bool:
        """True if all parameters are determined, and the map is one-to-one at the corners."""
        return self.is_valid_at_corners and not self.calibration.undetermined

    @property
    def spared(self) -> tuple[str, ...]:
        """Names of the coefficients without which unseen views are predicted better."""
        if self.fuller is None:
            return ()
        return tuple(name for name in self.fixed if name not in self.fuller.fixed)

    @property
    def left_open(self) -> tuple[str, ...]:
        """Names of the coefficients that were held because the views leave them open."""
        return tuple(name for name in self.fixed if name not in self.spared)

    @property
    def held_out(self) -> float:
        """RMS length of the residuals of unseen views, px; infinite if they were not asked."""
        return np.inf if self.validation is None else self.validation.held_out


def assess_trial(
    calibration: Calibration, fixed: dict[str, float], views: Sequence[Observation]
) -> LensTrial:
    """Assess a calibration as a candidate, before it is asked about unseen views.

    Args:
        calibration: calibration from all views.
        fixed: lens coefficients that were held, with their values.
        views: the views.
    """
    camera = calibration.camera
    residuals = np.concatenate([view.image for view in calibration.residuals])
    n, P = residuals.size, len(find_free_parameters(calibration))
    w, h = camera.size
    seen = np.concatenate([view.uv for view in views])
    radius = np.linalg.norm(seen - camera.centre, axis=1).max()
    grid = make_mesh(np.linspace(0, w - 1, _GRID_SAMPLES), np.linspace(0, h - 1, _GRID_SAMPLES))
    is_valid = find_valid_pixels(grid, camera)
    is_within = np.linalg.norm(grid - camera.centre, axis=-1) <= radius
    return LensTrial(
        calibration,
        fixed,
        bic=float(n * np.log(np.sum(residuals**2) / n) + P * np.log(n)),
        largest_angle=float(measure_angles(seen, camera).max()),
        field_of_view=_measure_field_of_view(calibration),
        is_valid_at_corners=bool(
            is_valid[is_within].all() and find_valid_pixels(seen, camera).all()
        ),
        valid_share=float(is_valid.mean()),
        exchangeable=_find_exchangeable(calibration),
    )


def _measure_field_of_view(calibration: Calibration) -> Array:
    """Measure the horizontal, vertical and diagonal field of view (3,), rad."""
    camera = calibration.camera
    w, h = camera.size
    u, v = camera.centre
    ends = np.array(
        [
            [[-0.5, v], [w - 0.5, v]],
            [[u, -0.5], [u, h - 0.5]],
            [[-0.5, -0.5], [w - 0.5, h - 0.5]],
        ]
    )
    angles = measure_angles(ends, camera)
    return np.asarray(np.where(find_valid_pixels(ends, camera), angles, np.nan).sum(axis=1))


def _find_exchangeable(calibration: Calibration) -> tuple[tuple[str, str], ...]:
    """Find pairs of coefficients of which the views determine only a combination.

    Consecutive coefficients of a polynomial are always correlated, and do no harm; those that shape
    the projection as a whole are not.
    """
    lens, names = find_model(calibration.camera.model), calibration.camera.names
    shaping = [4 + i for i, power in enumerate(lens.powers) if power == 0]
    matrix = compute_correlations(calibration.covariance)
    return tuple(
        (names[i], names[j])
        for a, i in enumerate(shaping)
        for j in shaping[a + 1 :]
        if abs(matrix[i, j]) > _MIN_STRONG_CORRELATION
    )

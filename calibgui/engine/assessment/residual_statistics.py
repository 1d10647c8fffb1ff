"""Residual statistics and the distributions fitted to their histograms (figures 10 to 12, 16).

A residual with independent Gaussian components of equal standard deviation s has a Rayleigh
distributed length e, with density (e / s^2) exp(-e^2 / 2 s^2), mean s sqrt(pi / 2) and
maximum-likelihood estimate s^2 = mean(e^2) / 2.

A corner beyond the fold of a forward lens model has an image, but no place on the plate: its
residual there is NaN, and left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, freeze
from calibgui.engine.calibration.result import Calibration, ViewResiduals


@dataclass(frozen=True, slots=True)
class Summary:
    """The residuals of a calibration in figures; never quote one of them alone."""

    rms: float
    """Root mean square length in the image, px."""
    sigma_x: float
    sigma_y: float
    """Standard deviations of the image residual's components, px, of all corners alike."""
    typical_x: float
    typical_y: float
    """The same in the median view, which single poor views do not raise."""
    reference_mean: float
    reference_sd: float
    """Mean and standard deviation of the length e' on the reference plane, reference px."""
    count: int
    """Number of corners."""


def summarise(residuals: Sequence[ViewResiduals]) -> Summary:
    """Statistics of all views' residuals together."""
    image = np.concatenate([view.image for view in residuals])
    length = np.linalg.norm(np.concatenate([view.reference for view in residuals]), axis=1)
    sigma = image.std(axis=0)
    typical = np.median([view.image.std(axis=0) for view in residuals], axis=0)
    return Summary(
        rms=float(np.sqrt(np.mean(np.sum(image**2, axis=1)))),
        sigma_x=float(sigma[0]),
        sigma_y=float(sigma[1]),
        typical_x=float(typical[0]),
        typical_y=float(typical[1]),
        reference_mean=float(np.nanmean(length)),
        reference_sd=float(np.nanstd(length)),
        count=len(image),
    )


@dataclass(frozen=True, eq=False, slots=True)
class Histogram:
    """A normalised histogram with the density fitted to the same values."""

    edges: Array
    """(B + 1,)."""
    density: Array
    """(B,) with unit area."""
    mean: float
    sd: float
    """Of the values."""
    scale: float
    """Parameter s of the fitted density; for a Gaussian its standard deviation."""
    rayleigh: bool
    """Whether the fitted density is Rayleigh's (of lengths) or Gaussian (of components)."""

    def __post_init__(self) -> None:
        freeze(self, "edges", "density")

    def fitted(self, x: Array) -> Array:
        """(n,) the fitted density at x."""
        s = self.scale
        if self.rayleigh:
            return np.where(x > 0, x / s**2 * np.exp(-0.5 * (x / s) ** 2), 0.0)
        return np.exp(-0.5 * ((x - self.mean) / s) ** 2) / (s * np.sqrt(2 * np.pi))


def component_histogram(values: Array, bins: int = 50) -> Histogram:
    """Histogram of one residual component with a Gaussian (figures 11a, 11b), symmetric about 0."""
    values = values[np.isfinite(values)]
    limit = float(np.abs(values).max(initial=1e-12))
    density, edges = np.histogram(values, bins=bins, range=(-limit, limit), density=True)
    sd = float(values.std())
    return Histogram(edges, density, float(values.mean()), sd, sd, rayleigh=False)


def length_histogram(values: Array, bins: int = 50) -> Histogram:
    """Histogram of residual lengths with a Rayleigh density (figure 11c)."""
    values = values[np.isfinite(values)]
    limit = float(values.max(initial=1e-12))
    density, edges = np.histogram(values, bins=bins, range=(0.0, limit), density=True)
    scale = float(np.sqrt(np.mean(values**2) / 2))
    return Histogram(
        edges, density, float(values.mean()), float(values.std()), scale, rayleigh=True
    )


def stacked(calibration: Calibration, on_reference: bool) -> Array:
    """(n, 2) residuals of all views, reference px or image px."""
    return np.concatenate(
        [view.reference if on_reference else view.image for view in calibration.residuals]
    )
